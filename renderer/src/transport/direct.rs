//! Direct light at a hit: one point of each light, and what is left of its radiance on the way.
//!
//! Every light proposes a point. What a proposal would bring if nothing were in the way costs little to know, so where
//! there are more proposals than the hit has shadow rays, those that would bring much are tested more often, and what
//! they bring counts the less: an unbiased estimate (resampling in the sense of J. Talbot, D. Cline and P. Egbert,
//! "Importance Resampling for Global Illumination", EGSR 2005).

use glam::{DVec3, Vec3};

use crate::color::Rgb;
use crate::geometry::{Aggregate, Hit, Ray, Shadow};
use crate::material::{Interaction, Material};
use crate::pattern::{Memory, Place};
use crate::sample::Sampler;
use crate::scene::{Leg, Light, LightSample, Scene, SourceId};

use super::air::{Medium, Piece, mist_at};
use super::dimension;
use super::look::{far_away, passed, place};
use super::ray::transmittance;

/// Vectors that shadow rays need, kept so that a hit allocates nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    crossings: Vec<Hit>,
    legs: Vec<Leg>,
    pub(super) pieces: Vec<Piece>,
    proposals: Vec<Proposal>,
    pub(super) memory: Memory,
    /// Of the hit's material, while those of what lies on the way use the other.
    pub(super) own_memory: Memory,
}

/// What a light would bring from one of its points.
#[derive(Clone, Copy, Debug)]
struct Proposal {
    /// Its number in the scene.
    light: u32,
    sample: LightSample,
    /// Radiance sent back along the ray if nothing is in the way.
    unshadowed: Rgb,
}

impl Proposal {
    /// What decides how often it is tested.
    fn size(&self) -> f64 {
        self.unshadowed.element_sum()
    }
}

/// Crossings of refracting surfaces after which a shadow ray is given up. Rays that are only refracted leave a solid
/// after a few; no light is lost by this but in rings of lenses.
const MOST_CROSSINGS: usize = 256;

/// Coefficient below which a refracted shadow ray is given up, as in rpict.
const LEAST_COEFFICIENT: f64 = 1e-6;

/// Where the fraction that a row of panes lets through saturates (their transmissivities are not clamped).
const MOST_PASSED: f64 = 1e30;

/// Where direct light is asked for.
pub(super) struct Lit<'a> {
    pub(super) scene: &'a Scene,
    pub(super) aggregate: &'a Aggregate,
    /// Starts at the hit and names its surface; direction and end do not count.
    pub(super) start: Ray,
    /// What is around the hit.
    pub(super) medium: Medium,
    /// About how many shadow rays may be spent.
    pub(super) tests: usize,
}

impl Lit<'_> {
    /// Radiance that a surface sends back along the ray, of the light that all sources send it; `direct` gives the fraction
    /// for a light's direction and solid angle. At most about `tests` shadow rays are spent on it.
    pub(super) fn light(
        &self,
        mut direct: impl FnMut(DVec3, f64) -> Rgb,
        sampler: &Sampler,
        scratch: &mut Scratch,
    ) -> Rgb {
        let tests = self.tests;
        let mut proposals = std::mem::take(&mut scratch.proposals);
        proposals.clear();
        // Where few of many lights are tested, it does no harm that their points have the same place on each.
        let one = 4 * tests <= self.scene.lights.len();
        let shared = if one { sampler.pair(dimension::LIGHT) } else { [0.0; 2] };
        for (light, number) in self.scene.lights.iter().zip(0_u32..) {
            let u = if one { shared } else { sampler.pair(dimension::LIGHT + number) };
            let Some(sample) = light.sample(self.start.origin, u) else { continue };
            let unshadowed = direct(sample.dir, sample.solid_angle) * sample.radiance;
            if unshadowed != Rgb::ZERO {
                proposals.push(Proposal { light: number, sample, unshadowed });
            }
        }
        let mut sum = Rgb::ZERO;
        if proposals.len() <= tests {
            for proposal in &proposals {
                sum += proposal.unshadowed * self.arriving(proposal, scratch);
            }
        } else {
            let sizes = proposals.iter().map(Proposal::size);
            choose(sizes, tests, sampler.single(dimension::CHOICE), |index, probability| {
                let proposal = &proposals[index];
                sum += proposal.unshadowed * self.arriving(proposal, scratch) / probability;
            });
        }
        scratch.proposals = proposals;
        sum
    }

    /// Of one light, the unit direction from which it arrives and its radiance times its solid angle there, for a point of
    /// it that `u` chooses.
    pub(super) fn one(&self, light: u32, u: [f64; 2], scratch: &mut Scratch) -> Option<(DVec3, Rgb)> {
        let sample = self.scene.lights.get(light as usize)?.sample(self.start.origin, u)?;
        let unshadowed = sample.radiance * sample.solid_angle;
        let arriving = self.arriving(&Proposal { light, sample, unshadowed }, scratch);
        (arriving != Rgb::ZERO).then(|| (sample.dir, unshadowed * arriving))
    }

    /// The fraction of a proposal's light that arrives.
    fn arriving(&self, proposal: &Proposal, scratch: &mut Scratch) -> Rgb {
        let light = &self.scene.lights[proposal.light as usize];
        let sample = &proposal.sample;
        let start = Ray { dir: sample.dir, t_max: sample.distance, ..self.start };
        if !light.relay().is_empty() {
            if light.legs(self.scene, start, sample, &mut scratch.memory, &mut scratch.legs).is_none() {
                return Rgb::ZERO;
            }
            return self.visible(light, &start, &scratch.legs, &mut scratch.crossings, &mut scratch.memory);
        }
        let target = match light.source() {
            SourceId::Surface(surface) => Some(surface),
            SourceId::Far(_) => None,
        };
        let leg = Leg { ray: start, target, left: Rgb::ONE };
        self.visible(light, &start, std::slice::from_ref(&leg), &mut scratch.crossings, &mut scratch.memory)
    }

    /// The fraction of a light's radiance that is left at the hit, which sees it along `legs`.
    fn visible(&self, light: &Light, start: &Ray, legs: &[Leg], crossings: &mut Vec<Hit>, memory: &mut Memory) -> Rgb {
        let mut fraction = Rgb::ONE;
        let mut medium = self.medium;
        let misty = self.scene.has_mist();
        for leg in legs {
            match self.aggregate.shadow(&leg.ray, leg.target, crossings) {
                Shadow::Blocked => return Rgb::ZERO,
                Shadow::Refracted => return self.refracted(light, *start, memory),
                Shadow::Clear => {}
            }
            let mut from = 0.0;
            for hit in crossings.iter() {
                if misty && let Some(mist) = mist_at(self.scene, hit) {
                    let front = hit.is_front(leg.ray.dir);
                    fraction *= medium.before(self.scene, mist, front).dims(self.scene, hit.t - from);
                    medium = medium.beyond(self.scene, mist, front);
                    from = hit.t;
                    continue;
                }
                match self.straight(light, hit, &leg.ray, memory) {
                    Some(passed) => fraction = (fraction * passed).min(Rgb::splat(MOST_PASSED)),
                    None => return Rgb::ZERO,
                }
            }
            if misty {
                fraction *= medium.dims(self.scene, leg.ray.t_max - from);
            }
            fraction *= leg.left;
        }
        if !misty && self.medium.extinction != Vec3::ZERO {
            // Nothing bent the ray, so it did not leave the medium that the hit lies in.
            fraction *= transmittance(self.medium.extinction, legs.iter().map(|leg| leg.ray.t_max).sum());
        }
        if let (Some(dress), Some(last)) = (light.dress(), legs.last())
            && fraction != Rgb::ZERO
        {
            fraction *= self.scene.tint(dress, &self.on_light(light, &last.ray), memory);
        }
        fraction
    }

    /// The fraction that a surface lets through without bending the ray; `None` if it stops it.
    fn straight(&self, light: &Light, hit: &Hit, ray: &Ray, memory: &mut Memory) -> Option<Rgb> {
        // In an instance, what its file gives no material is there for the instance's own, if it has one.
        let Some(material) = self.scene.material(hit.surface) else { return Some(Rgb::ONE) };
        let passed = passed(self.scene, light, material, hit, ray, memory);
        (passed != Rgb::ZERO).then_some(passed)
    }

    /// Where a ray that is aimed at a light meets it.
    fn on_light(&self, light: &Light, ray: &Ray) -> Place<'_> {
        match light.source() {
            SourceId::Surface(surface) => {
                let (point, normal) = self.scene.surface(surface).shape.settle(ray.at(ray.t_max));
                place(self.scene, &Hit { t: ray.t_max, point, normal, surface }, ray)
            }
            SourceId::Far(_) => far_away(ray),
        }
    }

    /// The fraction of a light's radiance that arrives by a ray which refracting solids bend: it counts if it comes to
    /// the light after all, over the mirrors and prisms that relay it.
    fn refracted(&self, light: &Light, start: Ray, memory: &mut Memory) -> Rgb {
        let mut ray = Ray { t_max: f64::INFINITY, ..start };
        let mut medium = self.medium;
        let mut fraction = Rgb::ONE;
        let mut relay = light.relay().iter().enumerate();
        let mut next = relay.next();
        for _ in 0..MOST_CROSSINGS {
            let Some(hit) = self.aggregate.closest(&ray) else {
                let arrives = match light.source() {
                    SourceId::Far(far) => self.scene.far[far.index()].contains(ray.dir),
                    SourceId::Surface(_) => false,
                };
                if !arrives || next.is_some() {
                    return Rgb::ZERO;
                }
                let tint = light.dress().map_or(Rgb::ONE, |dress| self.scene.tint(dress, &far_away(&ray), memory));
                return fraction * tint * medium.dims(self.scene, f64::INFINITY);
            };
            let front = hit.is_front(ray.dir);
            let material = self.scene.material(hit.surface);
            if let Some(Material::Dielectric(dielectric)) = material
                && let Some(extinction) = dielectric.medium(front)
            {
                medium = Medium::solid(extinction);
            }
            let mist = mist_at(self.scene, &hit);
            if let Some(mist) = mist {
                medium = medium.before(self.scene, mist, front);
            }
            fraction *= medium.dims(self.scene, hit.t);
            let mut dir = ray.dir;
            if let Some((index, _)) = next.filter(|(_, surface)| **surface == hit.surface) {
                let Some((turned, left)) = light.turn(index, self.scene, &ray, &hit, memory) else {
                    return Rgb::ZERO;
                };
                fraction *= left;
                dir = turned;
                next = relay.next();
            } else if next.is_none() && light.source() == SourceId::Surface(hit.surface) {
                if !front {
                    return Rgb::ZERO;
                }
                let place = place(self.scene, &hit, &ray);
                return fraction * light.dress().map_or(Rgb::ONE, |dress| self.scene.tint(dress, &place, memory));
            } else if let Some(Material::Dielectric(dielectric)) = material {
                let Some((bent, coefficient, beyond)) = dielectric.shadow(&Interaction::new(ray.dir, hit.normal))
                else {
                    return Rgb::ZERO;
                };
                (dir, medium) = (bent, Medium::solid(beyond));
                fraction *= coefficient;
            } else if let Some(mist) = mist {
                medium = medium.beyond(self.scene, mist, front);
            } else {
                match self.straight(light, &hit, &ray, memory) {
                    Some(passed) => fraction *= passed,
                    None => return Rgb::ZERO,
                }
            }
            if fraction.max_element() < LEAST_COEFFICIENT {
                return Rgb::ZERO;
            }
            fraction = fraction.min(Rgb::splat(MOST_PASSED));
            ray = Ray::new(hit.point, dir).leaving(hit.surface);
        }
        Rgb::ZERO
    }
}

/// Picks about `picks` of some things, each with a probability in proportion to its size, at most 1 (systematic
/// sampling by one number `u` in [0, 1), so neighbours in the order are rarely picked together); `take` gets each with
/// its probability.
fn choose(sizes: impl Iterator<Item = f64> + Clone, picks: usize, u: f64, mut take: impl FnMut(usize, f64)) {
    let step = sizes.clone().sum::<f64>() / picks as f64;
    let (mut passed, mut next) = (0.0, u * step);
    for (index, size) in sizes.enumerate() {
        passed += size;
        if size >= step {
            take(index, 1.0);
        } else if passed > next && size / step > 0.0 {
            take(index, size / step);
        }
        if next < passed {
            next += step * ((passed - next) / step).ceil();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Over a grid of `u` each thing is picked as often as its probability says, and the sum of what is picked,
        /// over its probability, has the mean of the whole sum.
        #[test]
        fn choices_are_unbiased(sizes in prop::collection::vec(1e-3..1.0_f64, 2..12), picks in 1..5_usize) {
            prop_assume!(sizes.len() > picks);
            let total: f64 = sizes.iter().sum();
            let steps = 4_000;
            let (mut mean, mut most) = (0.0, 0);
            for i in 0..steps {
                let mut count = 0;
                choose(sizes.iter().copied(), picks, (f64::from(i) + 0.5) / f64::from(steps), |index, probability| {
                    mean += sizes[index] / probability / f64::from(steps);
                    count += 1;
                });
                most = most.max(count);
            }
            // Each thing's share of the grid is off by at most one of its steps at either end.
            let largest_quotient = total / picks as f64;
            let rounding = 2.0 * sizes.len() as f64 * largest_quotient / f64::from(steps);
            prop_assert!((mean - total).abs() <= rounding, "{mean} {total}");
            prop_assert!(most <= picks + 1);
        }
    }

    #[test]
    fn nothing_is_picked_of_nothing_and_things_of_any_size_can_be() {
        choose([0.0; 0].into_iter(), 1, 0.5, |_, _| unreachable!());
        let mut picked = Vec::new();
        choose([1e-300, 1e300, 1e-300].into_iter(), 1, 0.0, |index, probability| picked.push((index, probability)));
        assert_eq!(picked, [(1, 1.0)]);
    }
}
