//! A ray made ready for many shape tests.

use glam::{DVec2, DVec3};

/// A ray with the shear that turns its direction into the axis along which it travels furthest.
///
/// Seen along that axis, a polygon test becomes a test in the plane whose only inputs are vertices that every neighbouring
/// polygon rounds alike (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013).
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    /// Where the ray starts.
    pub origin: DVec3,
    /// Its unit direction.
    pub dir: DVec3,
    axes: [usize; 3],
    shear: DVec2,
    inverse_depth: f64,
}

impl Probe {
    /// Prepares the ray from `origin` along the unit vector `dir`.
    #[must_use]
    pub fn new(origin: DVec3, dir: DVec3) -> Self {
        let size = dir.abs();
        let axes = if size.x >= size.y && size.x >= size.z {
            [1, 2, 0]
        } else if size.y >= size.z {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let inverse_depth = 1.0 / dir[axes[2]];
        let shear = DVec2::new(dir[axes[0]], dir[axes[1]]) * inverse_depth;
        Self { origin, dir, axes, shear, inverse_depth }
    }

    /// The axis along which the ray travels furthest: 0, 1 or 2.
    #[inline]
    #[must_use]
    pub fn axis(&self) -> usize {
        self.axes[2]
    }

    /// The two axes across the ray and the one along which it travels furthest; and what it moves along the first two for each
    /// unit of the third.
    #[inline]
    #[must_use]
    pub(crate) fn shear(&self) -> ([usize; 3], [f64; 2]) {
        (self.axes, self.shear.to_array())
    }

    /// A point as the ray sees it: its two coordinates across, the ray passing through zero. `AXIS` is the ray's
    /// [`Self::axis`].
    #[inline]
    #[must_use]
    pub(super) fn across<const AXIS: usize>(&self, point: DVec3) -> DVec2 {
        let from_origin = (point - self.origin).to_array();
        let across = DVec2::new(from_origin[(AXIS + 1) % 3], from_origin[(AXIS + 2) % 3]);
        across - self.shear * from_origin[AXIS]
    }

    /// A point's depth as the ray sees it: for a point on the ray, its distance.
    #[inline]
    #[must_use]
    pub(super) fn depth(&self, point: DVec3) -> f64 {
        let axis = self.axes[2];
        (point[axis] - self.origin[axis]) * self.inverse_depth
    }
}
