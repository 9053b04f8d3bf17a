//! A ray on its way, and what it remembers of the path from the eye.

use glam::Vec3;

use crate::color::Rgb;
use crate::component::Component;
use crate::film::{Layers, Plane};
use crate::geometry;
use crate::sample::PathKey;

use super::air::Medium;
use super::modulation::Choice;

/// What a ray remembers of its path from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayPath {
    /// The pixel that it contributes to: its place in the parcel's block, row by row.
    pub pixel: u32,
    /// Number of the sample of that pixel.
    pub sample: u32,
    /// What tells its random numbers from those of other paths.
    pub key: PathKey,
    /// The component that spawned it; `None` for a primary ray.
    pub last: Option<Component>,
    /// The first component of its path; `None` for a primary ray.
    pub first: Option<Component>,
    /// Reflections so far, as `-lr` counts them.
    pub reflections: u32,
    /// Diffuse events so far, as `-ab` counts them.
    pub diffuse: u32,
    /// Radiance's ray weight, at most 1; it decides where paths end and scales nothing.
    pub weight: f32,
    /// Whether a diffuse or glossy event is among its ancestors: then it does not see the light sources, whose light
    /// was already taken into account where the event happened.
    pub blind: bool,
    /// Whether it runs the members of `{ }` where importance is continuous.
    pub choice: Choice,
    /// Length of the way since the last such event, up to the ray's origin.
    pub blind_distance: f32,
    /// What the ray travels through at its start.
    pub medium: Medium,
}

impl RayPath {
    /// The path of a primary ray.
    #[must_use]
    pub fn primary(pixel: u32, sample: u32) -> Self {
        Self {
            pixel,
            sample,
            key: PathKey::EYE,
            last: None,
            first: None,
            reflections: 0,
            diffuse: 0,
            weight: 1.0,
            blind: false,
            choice: Choice::Chosen,
            blind_distance: 0.0,
            medium: Medium::default(),
        }
    }

    /// The plane that its light is filed in.
    #[must_use]
    pub fn plane(&self, layers: Layers) -> Plane {
        let component = match layers {
            Layers::Last => self.last,
            Layers::First => self.first,
        };
        component.map_or(Plane::Direct, Plane::Layer)
    }
}

/// A ray ready to be traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathRay {
    /// Where it runs.
    pub ray: geometry::Ray,
    /// The paper's T_ripple: radiance that it meets times this is its share of the pixel.
    pub ripple: Rgb,
    /// Where it comes from.
    pub path: RayPath,
}

/// The fraction of radiance that is left after `length` in a medium, per channel.
#[must_use]
pub fn transmittance(extinction: Vec3, length: f64) -> Rgb {
    if extinction == Vec3::ZERO {
        return Rgb::ONE;
    }
    // A channel without extinction passes whole even an endless way: 0 times infinity must not arise.
    extinction.to_array().map(|e| if e > 0.0 { (-f64::from(e) * length).exp() } else { 1.0 }).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn media_absorb_by_beer_and_lambert() {
        let passed = transmittance(Vec3::new(0.0, 1.0, 2.0), 0.5);
        assert!((passed - Rgb::new(1.0, (-0.5_f64).exp(), (-1.0_f64).exp())).length() < 1e-15);
        assert_eq!(transmittance(Vec3::ZERO, f64::INFINITY), Rgb::ONE);
        assert_eq!(transmittance(Vec3::X, f64::INFINITY), Rgb::new(0.0, 1.0, 1.0));
    }
}
