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

    /// A point as the ray sees it: the two coordinates across (the ray passes through zero) and the depth, which for a
    /// point on the ray is its distance.
    #[inline]
    #[must_use]
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let from_origin = point - self.origin;
        let along = from_origin[self.axes[2]];
        let across = DVec2::new(from_origin[self.axes[0]], from_origin[self.axes[1]]) - self.shear * along;
        (across, along * self.inverse_depth)
    }
}
