//! What rays travel through: absorbing solids, and mist, which also scatters the light of some sources into them.
//!
//! Crossing mist is no event. What it scatters into a ray is direct light of that ray, so it is filed where the light of
//! whatever the ray meets is filed: under the event that spawned the ray.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use crate::color::Rgb;
use crate::film::Plane;
use crate::geometry::{Hit, Ray};
use crate::material::{Material, MistId};
use crate::sample::Sampler;
use crate::scene::{Mists, Scene};

use super::dimension;
use super::direct::{Lit, Scratch};
use super::ray::{PathRay, transmittance};
use super::spawn::Spawner;
use super::trace::Tracer;

/// What a ray travels through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Medium {
    /// Extinction per unit of length.
    pub extinction: Vec3,
    /// The mists among it.
    pub mists: Mists,
}

impl Medium {
    /// The inside of a solid.
    #[must_use]
    pub fn solid(extinction: Rgb) -> Self {
        Self { extinction: extinction.as_vec3(), mists: Mists::NONE }
    }

    /// What lies behind a mist's boundary, which a ray crosses inwards or outwards.
    pub(super) fn beyond(self, scene: &Scene, mist: MistId, inwards: bool) -> Self {
        let mists = if inwards { self.mists.with(mist) } else { self.mists.without(mist) };
        self.replaced(scene, mists)
    }

    /// What lies before a mist's boundary: who leaves a mist was in it, even if nothing has told so (the eye).
    pub(super) fn before(self, scene: &Scene, mist: MistId, inwards: bool) -> Self {
        if inwards { self } else { self.replaced(scene, self.mists.with(mist)) }
    }

    fn replaced(self, scene: &Scene, mists: Mists) -> Self {
        if mists == self.mists {
            return self;
        }
        let around = self.extinction - scene.extinction(self.mists);
        Self { extinction: around.max(Vec3::ZERO) + scene.extinction(mists), mists }
    }

    /// What it leaves of a light over a length: what mist scatters counts as going on (rpict).
    pub(super) fn dims(self, scene: &Scene, length: f64) -> Rgb {
        if self.mists.is_empty() {
            return transmittance(self.extinction, length);
        }
        let absorbed = Rgb::ONE - scene.haze(self.mists).albedo;
        transmittance(self.extinction * absorbed.as_vec3(), length)
    }
}

/// A piece of a ray's way in one medium.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Where it starts; a unit vector says where it goes.
    pub(super) origin: DVec3,
    pub(super) dir: DVec3,
    pub(super) length: f64,
    pub(super) medium: Medium,
}

/// Whether a ray through a surface crosses a mist's boundary there.
pub(super) fn mist_at(scene: &Scene, hit: &Hit) -> Option<MistId> {
    if let Some(Material::Mist(mist)) = scene.material(hit.surface) { Some(*mist) } else { None }
}

/// A ray that leaves a mist which it has not entered was in it from its start.
pub(super) fn was_in(pieces: &mut [Piece], scene: &Scene, mist: MistId) {
    for piece in pieces {
        piece.medium = piece.medium.before(scene, mist, false);
    }
}

/// Henyey and Greenstein's phase function times 4 pi, for the cosine between the ways before and after.
fn phase(eccentricity: f64, cosine: f64) -> f64 {
    let squared = eccentricity * eccentricity;
    (1.0 - squared) / (1.0 + squared - 2.0 * eccentricity * cosine).max(f64::MIN_POSITIVE).powf(1.5)
}

/// Eccentricity from which on nothing is scattered aside (rpict).
const ALL_AHEAD: f64 = 1.0 - 1e-6;

/// Dimensions of random numbers that the lights of a piece take.
const PIECE_DIMENSIONS: u32 = 64;

impl Tracer<'_> {
    /// Files what mists scatter into a ray along its way, and gives what is left of radiance from the start of `last`, the
    /// last piece.
    pub(super) fn cross_air(
        &self,
        ray: &PathRay,
        last: &Piece,
        sampler: &Sampler,
        scratch: &mut Scratch,
        spawner: &mut Spawner<'_>,
    ) -> Rgb {
        let pieces = std::mem::take(&mut scratch.pieces);
        let mut left = Rgb::ONE;
        let mut before_last = Rgb::ONE;
        for (number, piece) in (0_u32..).zip(pieces.iter().chain([last])) {
            before_last = left;
            let passed = transmittance(piece.medium.extinction, piece.length);
            if !piece.medium.mists.is_empty() && piece.length.is_finite() {
                let haze = self.scene.haze(piece.medium.mists);
                if haze.albedo != Rgb::ZERO {
                    let ripple = ray.ripple * left;
                    let scattered = self.scattered(piece, number, sampler, scratch);
                    self.file(ray, ripple * scattered, spawner);
                    if self.ambient != Rgb::ZERO {
                        // What is scattered more than once no ray looks for: the estimate stays.
                        let estimate = ripple * haze.albedo * self.ambient * (Rgb::ONE - passed);
                        spawner.planes.add(ray.path.pixel, Plane::Ambient, estimate);
                    }
                }
            }
            left *= passed;
        }
        scratch.pieces = pieces;
        before_last
    }

    /// Radiance that mists scatter into a piece, once, from the lights that they list: one point of the piece for each light.
    fn scattered(&self, piece: &Piece, number: u32, sampler: &Sampler, scratch: &mut Scratch) -> Rgb {
        let haze = self.scene.haze(piece.medium.mists);
        if haze.eccentricity >= ALL_AHEAD {
            return Rgb::ZERO;
        }
        let extinction: Rgb = piece.medium.extinction.as_dvec3().to_array().into();
        let mut sum = Rgb::ZERO;
        for (index, light) in (0_u32..).zip(self.scene.scattered_lights(piece.medium.mists)) {
            let dimension = dimension::MIST + number.wrapping_mul(PIECE_DIMENSIONS).wrapping_add(2 * index);
            let along = piece.length * sampler.single(dimension);
            let start = Ray::new(piece.origin + piece.dir * along, piece.dir);
            let lit = Lit { scene: self.scene, aggregate: self.aggregate, start, medium: piece.medium, tests: 1 };
            let Some((to_light, arriving)) = lit.one(light, sampler.pair(dimension + 1), scratch) else { continue };
            let passed = transmittance(piece.medium.extinction, along);
            let part = phase(haze.eccentricity, piece.dir.dot(to_light)) * piece.length / (4.0 * PI);
            sum += extinction * haze.albedo * passed * arriving * part;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The phase function's mean over all directions is 1, and its mean cosine the eccentricity (L. Henyey and J.
    /// Greenstein, 1941), by Simpson's rule.
    #[test]
    fn scattering_keeps_light_and_goes_ahead() {
        for eccentricity in [0.0, 0.3, 0.7] {
            let steps = 2000;
            let (mut mean, mut ahead) = (0.0, 0.0);
            for i in 0..=steps {
                let cosine = 2.0 * f64::from(i) / f64::from(steps) - 1.0;
                let weight = if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
                let part = weight / (3.0 * f64::from(steps)) * phase(eccentricity, cosine);
                mean += part;
                ahead += part * cosine;
            }
            assert!((mean - 1.0).abs() < 1e-8 && (ahead - eccentricity).abs() < 1e-8, "{eccentricity} {mean} {ahead}");
        }
    }
}
