//! `ring`: a flat annulus or disc.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Degenerate, Probe, within};

/// An annulus, or a disc if the inner radius is zero, that faces its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    centre: DVec3,
    normal: DVec3,
    inner: f64,
    outer: f64,
}

impl Ring {
    /// The ring between two radii in either order; `normal` of any length.
    pub fn new(centre: DVec3, normal: DVec3, radii: [f64; 2]) -> Result<Self, Degenerate> {
        let [inner, outer] = [radii[0].min(radii[1]), radii[0].max(radii[1])];
        let normal = (normal / normal.abs().max_element()).try_normalize().ok_or(Degenerate::NoNormal)?;
        if outer > inner { Ok(Self { centre, normal, inner, outer }) } else { Err(Degenerate::NoArea) }
    }

    /// The centre.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Unit normal of the front.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Inner and outer radius.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        [self.inner, self.outer]
    }

    pub(super) fn meet(&self, probe: &Probe, t_min: f64, t_max: f64) -> Option<f64> {
        let to_centre = self.centre - probe.origin;
        // A ray within the plane divides by zero and fails the next test.
        let t = within(to_centre.dot(self.normal) / probe.dir.dot(self.normal), t_min, t_max)?;
        let squared = (probe.dir * t - to_centre).length_squared();
        // A few roundings wider than drawn, so that no ray passes between a cylinder and its cap.
        let slack = 1.0 + 16.0 * f64::EPSILON;
        (squared <= self.outer * self.outer * slack && squared * slack >= self.inner * self.inner).then_some(t)
    }

    pub(super) fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        (point - self.normal * (point - self.centre).dot(self.normal), self.normal)
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let reach = disc_reach(self.normal, self.outer);
        [self.centre - reach, self.centre + reach]
    }

    pub(super) fn area(&self) -> f64 {
        PI * (self.outer - self.inner) * (self.outer + self.inner)
    }
}

/// Half the extent of a disc along each axis.
pub(super) fn disc_reach(normal: DVec3, radius: f64) -> DVec3 {
    DVec3::from_array(normal.to_array().map(|along| radius * (1.0 - along * along).max(0.0).sqrt()))
}
