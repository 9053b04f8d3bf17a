//! `cone`, `cup`, `cylinder` and `tube`: open frusta.

use std::f64::consts::PI;

use glam::DVec3;

use super::ring::disc_reach;
use super::{Degenerate, Probe, within};
use crate::math::quadratic;

/// A frustum without caps; its front is outside (cone, cylinder) or inside (cup, tube).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    base: DVec3,
    axis: DVec3,
    length: f64,
    base_radius: f64,
    /// Change of the radius per unit of length along the axis.
    slope: f64,
    inward: bool,
}

/// Radius gained per unit of length from which on the ends of a frustum count as one.
const STEEPEST: f64 = 1e75;

impl Cone {
    /// The frustum between two points with a radius (not negative) at each; `inward` for cup and tube.
    pub fn new(ends: [DVec3; 2], radii: [f64; 2], inward: bool) -> Result<Self, Degenerate> {
        if radii == [0.0; 2] {
            return Err(Degenerate::NoRadius);
        }
        let span = ends[1] - ends[0];
        let scale = span.abs().max_element();
        if scale == 0.0 {
            return Err(Degenerate::NoLength);
        }
        let length = (span / scale).length() * scale;
        let axis = (span / scale).normalize();
        let slope = (radii[1] - radii[0]) / length;
        // Flatter than that it is a ring, and the slope's square would leave the range of numbers.
        if slope.abs() > STEEPEST || radii.iter().all(|radius| radius / length > STEEPEST) {
            return Err(Degenerate::NoLength);
        }
        Ok(Self { base: ends[0], axis, length, base_radius: radii[0], slope, inward })
    }

    /// The first end, and the unit vector from there to the other.
    #[must_use]
    pub fn axis(&self) -> (DVec3, DVec3) {
        (self.base, self.axis)
    }

    /// Distance between the ends.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Radius at each end.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        [self.base_radius, self.base_radius + self.slope * self.length]
    }

    /// Whether the front is inside.
    #[must_use]
    pub fn is_inward(&self) -> bool {
        self.inward
    }

    pub(super) fn meet(&self, probe: &Probe, leaving: bool, t_min: f64, t_max: f64) -> Option<f64> {
        // Solved from the point of the line nearest to the frustum's middle: from far away the squares would drown the radius.
        let middle = self.base + self.axis * (0.5 * self.length);
        let shift = if leaving { 0.0 } else { (middle - probe.origin).dot(probe.dir) };
        let from_base = probe.origin + probe.dir * shift - self.base;
        let (height, climb) = (from_base.dot(self.axis), probe.dir.dot(self.axis));
        let across = from_base - self.axis * height;
        let drift = probe.dir - self.axis * climb;
        let (radius, growth) = (self.base_radius + self.slope * height, self.slope * climb);
        let a = drift.length_squared() - growth * growth;
        let half_b = across.dot(drift) - radius * growth;
        let found = if leaving {
            // The ray starts on the surface: one root is zero, the other follows.
            [-2.0 * half_b / a, f64::NAN]
        } else {
            let distance = across.length();
            quadratic::roots(a, half_b, (distance - radius) * (distance + radius))
        };
        // A few roundings longer than drawn, so that no ray passes between a cylinder and its cap.
        let slack = 8.0 * f64::EPSILON * (self.base.abs().max_element() + self.length);
        found.into_iter().find_map(|root| {
            let at = height + climb * root;
            let on_surface = at >= -slack && at <= self.length + slack && self.base_radius + self.slope * at >= -slack;
            if on_surface { within(shift + root, t_min, t_max) } else { None }
        })
    }

    pub(super) fn settle(&self, point: DVec3) -> (DVec3, DVec3) {
        let from_base = point - self.base;
        let height = from_base.dot(self.axis);
        let outward = (from_base - self.axis * height).try_normalize();
        // At the apex every direction is as good as any other.
        let outward = outward.unwrap_or_else(|| self.axis.any_orthonormal_vector());
        let settled = self.base + self.axis * height + outward * (self.base_radius + self.slope * height);
        let normal = (outward - self.axis * self.slope).normalize();
        (settled, if self.inward { -normal } else { normal })
    }

    pub(super) fn bounds(&self) -> [DVec3; 2] {
        let ends = [self.base, self.base + self.axis * self.length];
        let reach = self.radii().map(|radius| disc_reach(self.axis, radius));
        [(ends[0] - reach[0]).min(ends[1] - reach[1]), (ends[0] + reach[0]).max(ends[1] + reach[1])]
    }

    pub(super) fn area(&self) -> f64 {
        let [base, top] = self.radii();
        PI * (base + top) * self.length * self.slope.hypot(1.0)
    }
}
