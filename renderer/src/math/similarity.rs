//! Transforms that keep shapes.

use glam::{DAffine3, DVec3};

/// A transform made of translation, rotation, mirroring and uniform scaling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// Maps points.
    pub affine: DAffine3,
    /// By what lengths are multiplied; positive.
    pub scale: f64,
}

impl Similarity {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self { affine: DAffine3::IDENTITY, scale: 1.0 };

    /// This transform, then another.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self { affine: next.affine * self.affine, scale: self.scale * next.scale }
    }

    /// The transform that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { affine: self.affine.inverse(), scale: 1.0 / self.scale }
    }

    /// Where a point goes.
    #[must_use]
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.affine.transform_point3(point)
    }

    /// Where a unit vector points afterwards; a unit vector.
    #[must_use]
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.affine.transform_vector3(direction) / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undone_and_joined() {
        let turn = DAffine3::from_rotation_z(0.3) * DAffine3::from_scale(DVec3::splat(2.0));
        let there = Similarity { affine: DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0)) * turn, scale: 2.0 };
        let back = there.then(&there.inverse());
        let point = DVec3::new(0.3, -4.0, 9.0);
        assert!((back.point(point) - point).length() < 1e-14 && (back.scale - 1.0).abs() < 1e-15);
        assert!((there.direction(DVec3::X).length() - 1.0).abs() < 1e-15);
    }
}
