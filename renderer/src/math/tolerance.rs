//! The numerical policy of rays: where a hit begins to count, and when two hits are one.
//!
//! Geometry is computed in `f64`, with a relative rounding of 1.1e-16. A hit point is projected back onto its surface, so it
//! is off by a few roundings of its coordinates, whatever the ray's length. From that follow two rules, both
//! relative, so that a scene in micrometres and one at coordinates of 1e8 behave alike:
//!
//! - A ray never meets the surface that it leaves at distance zero. This needs no tolerance: [`crate::geometry::Ray`] names
//!   that surface, a flat surface is skipped, and of a quadric's two roots the one that belongs to the starting
//!   point is taken to be exactly zero.
//! - Other surfaces count from [`least_distance`] on. That matters only for surfaces that touch or coincide there. The
//!   same length is the window in which two hits are taken as coincident. Radiance uses 1e-6 for both, in
//!   whatever unit the scene has; the length here equals that for coordinates of 1e5.

use glam::DVec3;

/// Distance tolerance per unit of coordinate: 1e5 roundings, so that it also covers surfaces that were written with
/// twelve digits (as `xform` does) and rays that graze at 1e-5.
const PER_COORDINATE: f64 = 1e-11;

/// The least distance at which a ray from `origin` meets another surface, and the distance within which
/// two hits of it coincide; `scene_radius` is half the diagonal of the scene's bounds.
#[must_use]
pub fn least_distance(origin: DVec3, scene_radius: f64) -> f64 {
    PER_COORDINATE * (origin.abs().max_element() + scene_radius)
}
