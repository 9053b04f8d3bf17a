//! Right-handed orthonormal frames.

use glam::DVec3;

/// A right-handed orthonormal frame: `u` x `v` = `w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First axis.
    pub u: DVec3,
    /// Second axis.
    pub v: DVec3,
    /// Third axis, the one that the frame was built around.
    pub w: DVec3,
}

impl Frame {
    /// A frame whose third axis is the unit vector `w`; continuous except at `w` = -z.
    ///
    /// Formula: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    #[must_use]
    pub fn around(w: DVec3) -> Self {
        let sign = 1.0_f64.copysign(w.z);
        let a = -1.0 / (sign + w.z);
        let b = w.x * w.y * a;
        Self {
            u: DVec3::new(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x),
            v: DVec3::new(b, sign + w.y * w.y * a, -w.y),
            w,
        }
    }

    /// A vector given in this frame's axes, in the world's.
    #[must_use]
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        self.u * local.x + self.v * local.y + self.w * local.z
    }

    /// A vector of the world in this frame's axes.
    #[must_use]
    pub fn to_local(&self, world: DVec3) -> DVec3 {
        DVec3::new(self.u.dot(world), self.v.dot(world), self.w.dot(world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(z in -1.0..=1.0_f64, phi in 0.0..std::f64::consts::TAU) {
            let r = (1.0 - z * z).max(0.0).sqrt();
            let w = DVec3::new(r * phi.cos(), r * phi.sin(), z).normalize();
            let frame = Frame::around(w);
            prop_assert!((frame.u.cross(frame.v) - frame.w).length() < 1e-14);
            prop_assert!((frame.u.length() - 1.0).abs() < 1e-14);
            prop_assert!(frame.u.dot(frame.v).abs() < 1e-14);
            let p = DVec3::new(0.3, -2.0, 5.0);
            prop_assert!((frame.to_local(frame.to_world(p)) - p).length() < 1e-13);
        }
    }

    #[test]
    fn the_poles_have_frames() {
        for w in [DVec3::Z, -DVec3::Z, DVec3::new(0.0, -0.0, -1.0)] {
            let frame = Frame::around(w);
            assert!((frame.u.cross(frame.v) - w).length() < 1e-15);
        }
    }
}
