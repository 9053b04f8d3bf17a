//! `sphere` and `bubble`.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Degenerate, Probe, within};

/// A sphere, whose front is outside, or a bubble, whose front is inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    centre: DVec3,
    /// Negative for a bubble.
    radius: f64,
}

impl Sphere {
    /// A sphere (`radius` > 0) or bubble (`radius` < 0).
    pub fn new(centre: DVec3, radius: f64) -> Result<Self, Degenerate> {
        if radius == 0.0 { Err(Degenerate::NoRadius) } else { Ok(Self { centre, radius }) }
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius.abs()
    }

    /// Whether the front is inside.
    #[must_use]
    pub fn is_bubble(&self) -> bool {
        self.radius < 0.0
    }

    pub(super) fn meet(&self, probe: &Probe, leaving: bool, t_min: f64, t_max: f64) -> Option<f64> {
        let to_centre = self.centre - probe.origin;
        let middle = to_centre.dot(probe.dir);
        if leaving {
            return within(2.0 * middle, t_min, t_max);
        }
        // Distance of the line from the centre as a vector: from far away its square keeps digits that
        // |to_centre|^2 - middle^2 has lost (Haines et al., Ray Tracing Gems, chapter 7).
        let aside = to_centre - probe.dir * middle;
        let half_chord_squared = self.radius * self.radius - aside.length_squared();
        if half_chord_squared < 0.0 {
            return None;
        }
        let half_chord = half_chord_squared.sqrt();
        // The root nearer to zero as the product of roots over the larger one.
        let larger = middle + half_chord.copysign(middle);
        let distance = to_centre.length();
        let smaller =
            if larger == 0.0 { 0.0 } else { (distance - self.radius()) * (distance + self.radius()) / larger };
        let (near, far) = if smaller <= larger { (smaller, larger) } else { (larger, smaller) };
        within(near, t_min, t_max).or_else(|| within(far, t_min, t_max))
    }

    pub(super) fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        let from_centre = point - self.centre;
        // Divided, not multiplied by a reciprocal: the normal of a point on an axis is that axis.
        let length = from_centre.length();
        // A sphere smaller than the last digit of its coordinates has no better normal.
        let outward = if length > 0.0 { from_centre / length } else { DVec3::Z };
        (self.centre + outward * self.radius(), outward * self.radius.signum())
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        [self.centre - self.radius(), self.centre + self.radius()]
    }

    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }
}
