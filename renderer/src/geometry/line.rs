//! A ray as the hierarchy sees it: in `f32`, in a frame where the scene fills [-1, 1]^3.

use glam::DVec3;

use super::block::CORNER_ERROR;
use super::shape::Probe;

/// The ray, ready to be tested against boxes and blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Where it starts.
    pub(super) origin: [f32; 3],
    /// One over its direction, finite.
    pub(super) inverse: [f32; 3],
    /// The axes across it, and the one along which it travels furthest.
    pub(super) axes: [usize; 3],
    /// What it moves across for each unit of that axis.
    pub(super) shear: [f32; 2],
    /// How far a corner may seem to be from where it is, across the ray: [`super::block::CORNER_ERROR`] or more.
    pub(super) corner_error: f32,
    /// Where it ends.
    pub(super) t_max: f32,
}

impl Line {
    /// The line from `origin` in the hierarchy's frame along `dir`, which is that of `probe`, with an `origin` that is known but for
    /// `rounding`. `None` if that is no ray.
    #[inline]
    pub(super) fn new(origin: DVec3, dir: DVec3, probe: &Probe, rounding: f64) -> Option<Self> {
        let (axes, shear) = probe.shear();
        let (origin, inverse) = (origin.as_vec3().to_array(), dir.as_vec3().to_array().map(inverse));
        let is_ray = (origin.iter().sum::<f32>() + inverse.iter().sum::<f32>()).is_finite();
        let corner_error = CORNER_ERROR + rounding as f32;
        is_ray.then_some(Self { origin, inverse, axes, shear: shear.map(|x| x as f32), corner_error, t_max: 0.0 })
    }
}

/// One over a part of a direction. A part near zero counts as a tiny one: the ray then is off by less than the boxes' padding.
fn inverse(x: f32) -> f32 {
    if x.abs() <= f32::EPSILON { (1.0 / f32::EPSILON).copysign(x) } else { x.recip() }
}
