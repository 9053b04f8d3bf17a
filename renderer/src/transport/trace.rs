//! One ray: what it meets, what that sends back at once, and what it spawns.

use glam::DVec3;

use crate::color::Rgb;
use crate::film::Layers;
use crate::geometry::{Aggregate, Hit, Ray};
use crate::material::{Bend, Interaction, Material};
use crate::pattern::Memory;
use crate::sample::Sampler;
use crate::scene::Scene;

use super::air::{Medium, Piece, was_in};
use super::dimension;
use super::direct::{Lit, Scratch};
use super::look::{Look, Looker, Made, far_away, place};
use super::modulation::Modulation;
use super::ray::{PathRay, transmittance};
use super::spawn::{Departure, Limits, Spawner};

/// Extinction times length from which on absorption lowers a ray's weight (rpict).
const WEIGHTY_ABSORPTION: f64 = 0.1;

/// Shadow rays for each hit that the eye sees, directly or by ideal events; for each behind one diffuse event or only
/// glossy ones; and for each further on. The noise of long paths comes from where they go, so there one is enough. In a
/// corridor of five lights and their images in a mirror, 4, 2 and 1 gave the least error for the time; 8 costs a twentieth
/// more and leaves seen shadows, which no filter smooths, less than half the noise.
const SEEN_TESTS: usize = 8;
const NEAR_TESTS: usize = 2;
const FAR_TESTS: usize = 1;

/// Everything that the tracing of a ray depends on but the ray.
pub struct Tracer<'a> {
    /// What there is.
    pub scene: &'a Scene,
    /// Its shapes.
    pub aggregate: &'a Aggregate,
    /// Where paths end.
    pub limits: Limits,
    /// `-av`: radiance that stands for diffuse light that is not traced, W/(sr m2).
    pub ambient: Rgb,
    /// `-dv`: whether rays other than shadow rays see light sources.
    pub lights_visible: bool,
    /// How light is filed.
    pub layers: Layers,
    /// Seed of all random numbers.
    pub seed: u64,
    /// The importance of pixels, which `{ }` heeds; `None` is 1 everywhere.
    pub modulation: Option<Modulation<'a>>,
}

impl<'a> Tracer<'a> {
    /// A tracer with the default settings: all that the low-level pass needs.
    #[must_use]
    pub fn new(scene: &'a Scene, aggregate: &'a Aggregate) -> Self {
        let (ambient, layers) = (Rgb::ZERO, Layers::Last);
        let (limits, modulation) = (Limits::default(), None);
        Self { scene, aggregate, limits, ambient, lights_visible: true, layers, seed: 0, modulation }
    }
}

impl Tracer<'_> {
    /// Traces a ray: adds what it brings to the planes, and puts what it spawns into the bins.
    pub(super) fn trace(&self, ray: &PathRay, sampler: &Sampler, scratch: &mut Scratch, spawner: &mut Spawner<'_>) {
        let Scratch { memory, pieces, .. } = scratch;
        let mut made = None;
        let Some(meeting) = self.meet(ray, self.mixing(sampler), memory, pieces, &mut made) else { return };
        let Meeting { hit, ray: last, length, piece } = meeting;
        let path = &ray.path;
        let before =
            if self.scene.has_mist() { self.cross_air(ray, &piece, sampler, scratch, spawner) } else { Rgb::ONE };
        let Some((hit, look)) = hit else {
            let ripple = ray.ripple * before * transmittance(piece.medium.extinction, f64::INFINITY);
            return self.file(ray, ripple * self.escaped(ray, &last, scratch), spawner);
        };
        let Some(material) = look.material(&made) else { return };
        let bend = if let Look::Dressed(bend) = look { bend } else { DVec3::ZERO };

        let front = hit.is_front(last.dir);
        // A ray that meets a solid's boundary from inside was in the solid, even if it started there (the eye).
        let medium = match material {
            Material::Dielectric(dielectric) => dielectric.medium(front).map_or(piece.medium, Medium::solid),
            _ => piece.medium,
        };
        let ripple = ray.ripple * before * transmittance(medium.extinction, piece.length);
        if ripple == Rgb::ZERO {
            return;
        }
        if let Material::Emitter(emitter) = material {
            if front && (self.lights_visible || !emitter.illuminates()) {
                let distance = f64::from(path.blind_distance) + length;
                self.file(ray, ripple * emitter.seen(last.dir, path.blind, distance), spawner);
            }
            return;
        }

        let absorbed = f64::from(medium.extinction.min_element()) * piece.length;
        let weight = if absorbed > WEIGHTY_ABSORPTION { path.weight * (-absorbed).exp() as f32 } else { path.weight };
        let departure = Departure { path, ripple, weight, length, medium, point: hit.point, surface: hit.surface };
        let bent = (bend != DVec3::ZERO).then(|| Bend::new(last.dir, hit.normal, bend));
        let interaction = match bent {
            None => Interaction::new(last.dir, hit.normal),
            Some(_) => Interaction::bent(last.dir, hit.normal, bend),
        };
        let mut spawn = |lobe| {
            let lobe = bent.map_or(lobe, |bent| bent.adjust(lobe, material));
            spawner.spawn(&departure, &lobe, sampler);
        };
        let lit = || {
            let start = Ray::new(hit.point, last.dir).leaving(hit.surface);
            let tests = match (path.blind, path.diffuse) {
                (false, _) => SEEN_TESTS,
                (true, 0 | 1) => NEAR_TESTS,
                _ => FAR_TESTS,
            };
            Lit { scene: self.scene, aggregate: self.aggregate, start, medium, tests }
        };
        match material.respond(interaction) {
            None => {
                material.scatter(interaction, self.limits.glossy_threshold, &mut spawn);
                let place = place(self.scene, &hit, &last);
                if let Some(light) = lit().own(material, (&interaction, &place, bend), sampler, scratch) {
                    self.file(ray, ripple * light, spawner);
                }
            }
            Some(response) => {
                response.scatter(self.limits.glossy_threshold, &mut spawn);
                if !self.scene.lights.is_empty() && response.takes_direct_light() {
                    let direct = |dir, solid_angle| response.direct(dir, solid_angle);
                    self.file(ray, ripple * lit().light(direct, sampler, scratch), spawner);
                }
            }
        }
    }

    /// Adds light to the plane that a ray's light belongs to.
    pub(super) fn file(&self, ray: &PathRay, light: Rgb, spawner: &mut Spawner<'_>) {
        // What every factor is bounded for (`docs/numerics.md`); should one not be, black is the lesser evil.
        debug_assert!(light.is_finite(), "{light} along {ray:?}");
        if light != Rgb::ZERO && light.is_finite() {
            spawner.planes.add(ray.path.pixel, ray.path.plane(self.layers), light);
        }
    }

    /// What chooses among the materials of mixtures.
    fn mixing(&self, sampler: &Sampler) -> f64 {
        if self.scene.has_dresses() { sampler.single(dimension::MIXTURE) } else { 0.0 }
    }

    /// Follows a ray through surfaces that are not there for it; `u` in [0,1) chooses among mixed materials. `None` if nothing comes from where it ends.
    /// `pieces` is cleared, and filled with the pieces of the way but the last if it crosses boundaries of mist; `made` gets the
    /// material where patterns or textures make one.
    #[inline(always)]
    pub(super) fn meet(
        &self,
        from: &PathRay,
        u: f64,
        memory: &mut Memory,
        pieces: &mut Vec<Piece>,
        made: &mut Made,
    ) -> Option<Meeting<'_>> {
        pieces.clear();
        let mut ray = from.ray;
        let mut length = 0.0;
        let mut piece = Piece { origin: ray.origin, dir: ray.dir, length: 0.0, medium: from.path.medium };
        // A straight line meets no shape more than twice.
        for _ in 0..=2 * self.aggregate.len() {
            let Some(hit) = self.aggregate.closest(&ray) else {
                // A ray that an aft plane ends sees nothing behind it.
                piece.length = f64::INFINITY;
                return ray.t_max.is_infinite().then_some(Meeting { hit: None, ray, length, piece });
            };
            length += hit.t;
            piece.length += hit.t;
            let looker = Looker { scene: self.scene, ray, blind: from.path.blind, u };
            match looker.look(&hit, memory, made) {
                Look::Black if pieces.is_empty() && piece.medium.mists.is_empty() => return None,
                Look::Mist(mist) => {
                    let inwards = hit.is_front(ray.dir);
                    if !inwards && !piece.medium.mists.contains(mist) {
                        was_in(pieces, self.scene, mist);
                        piece.medium = piece.medium.before(self.scene, mist, inwards);
                    }
                    pieces.push(piece);
                    let medium = piece.medium.beyond(self.scene, mist, inwards);
                    piece = Piece { origin: hit.point, dir: ray.dir, length: 0.0, medium };
                    ray = Ray::new(hit.point, ray.dir).leaving(hit.surface).up_to(ray.t_max - hit.t);
                }
                Look::Through => {
                    ray = Ray::new(hit.point, ray.dir).leaving(hit.surface).up_to(ray.t_max - hit.t);
                }
                look => return Some(Meeting { hit: Some((hit, look)), ray, length, piece }),
            }
        }
        None
    }

    /// Radiance that a ray sees which meets nothing.
    fn escaped(&self, from: &PathRay, ray: &Ray, scratch: &mut Scratch) -> Rgb {
        if self.scene.far.is_empty() {
            return Rgb::ZERO;
        }
        let Some(far) = self.scene.escaped(ray.dir) else { return Rgb::ZERO };
        let Some((emitter, dress)) = self.scene.emitter(self.scene.far[far.index()].material) else {
            return Rgb::ZERO;
        };
        if emitter.illuminates() && !self.lights_visible {
            return Rgb::ZERO;
        }
        let seen = emitter.seen(ray.dir, from.path.blind, f64::INFINITY);
        match dress {
            Some(dress) if seen != Rgb::ZERO => seen * self.scene.tint(dress, &far_away(ray), &mut scratch.memory),
            _ => seen,
        }
    }
}

/// Where a ray ends.
pub(super) struct Meeting<'a> {
    /// The surface and what it is to this ray; `None`: nothing was met.
    pub(super) hit: Option<(Hit, Look<'a>)>,
    /// The last piece of the ray.
    pub(super) ray: Ray,
    /// Length of the whole way.
    pub(super) length: f64,
    /// The part of it in the last medium.
    pub(super) piece: Piece,
}
