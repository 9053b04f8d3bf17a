//! The one door through which child rays come into being: ripple, weight, limits, roulette, bin.

use glam::DVec3;

use crate::color::Rgb;
use crate::component::{Component, PerComponent};
use crate::film::{Plane, Planes};
use crate::geometry::SurfaceId;
use crate::material::{GlossySampling, Lobe};
use crate::sample::Sampler;

use super::air::Medium;
use super::bins::{RayBins, SpawnRecord};
use super::dimension;
use super::ray::RayPath;

/// Where a ripple saturates. Surfaces that reflect more than they receive (colours are not clamped) would else take it
/// beyond `f64`, and the first black surface behind them would make NaN of infinity times zero.
const LARGEST_RIPPLE: f64 = 1e60;

/// Where paths end and how many rays a hit spawns: rpict's options of the same letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// `-lr`: most reflections of a path. If 0 or negative, rays below `least_weight` play Russian roulette instead of
    /// ending, with at most the magnitude of reflections (0: any number).
    pub reflections: i32,
    /// `-lw`: rays of less weight end.
    pub least_weight: f64,
    /// `-ab`: most diffuse events of a path; `None` leaves that to the crex.
    pub diffuse: Option<u32>,
    /// `-st`: rough lobes of at most this specular fraction are not traced but scattered diffusely.
    pub glossy_threshold: f64,
    /// `-ad`: diffuse rays for each lobe at a primary hit.
    pub diffuse_rays: u32,
    /// `-ss`: glossy rays for each lobe at a primary hit; up to 1.5 means one, and below 1 narrows the lobe. From 2 on
    /// directions are weighted ([`GlossySampling::weighted`]).
    pub glossy_rays: f64,
}

impl Default for Limits {
    /// Radiance's defaults but for the diffuse limit and the glossy threshold, which the crex takes over.
    fn default() -> Self {
        Self {
            reflections: 7,
            least_weight: 1e-4,
            diffuse: None,
            glossy_threshold: 0.0,
            diffuse_rays: 1,
            glossy_rays: 1.0,
        }
    }
}

impl Limits {
    /// How rough lobes are sampled.
    #[must_use]
    pub fn glossy_sampling(&self) -> GlossySampling {
        GlossySampling { width: self.glossy_rays.clamp(0.0, 1.0), weighted: self.glossy_rays > SEVERAL }
    }

    /// Most rays that a lobe of a primary hit spawns.
    #[must_use]
    pub fn most_rays(&self) -> u32 {
        self.diffuse_rays.max(self.rays(Component::Glossy)).max(1)
    }

    /// Rays that a lobe of a primary hit spawns.
    fn rays(&self, component: Component) -> u32 {
        match component {
            Component::Diffuse => self.diffuse_rays,
            // Saturates: a number of rays beyond 2^32 is refused with the settings.
            Component::Glossy if self.glossy_rays > SEVERAL => self.glossy_rays.round() as u32,
            _ => 1,
        }
    }
}

/// `-ss` up to which a lobe gets one ray (`rpict(1)`).
const SEVERAL: f64 = 1.5;

/// A hit as the door needs it: what arrives there, and where it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure<'a> {
    /// The path of the ray that arrived.
    pub(super) path: &'a RayPath,
    /// Its ripple, weakened by the way to the hit.
    pub(super) ripple: Rgb,
    /// Its weight, weakened likewise.
    pub(super) weight: f32,
    /// Length of that way.
    pub(super) length: f64,
    /// What it went through last.
    pub(super) medium: Medium,
    /// The hit.
    pub(super) point: DVec3,
    /// What was hit.
    pub(super) surface: SurfaceId,
}

/// The door, and what it opens to.
pub(super) struct Spawner<'a> {
    pub(super) limits: &'a Limits,
    /// `-av`: radiance that stands for diffuse light that is not traced.
    pub(super) ambient: Rgb,
    pub(super) bins: &'a mut RayBins,
    /// Where refused diffuse rays leave their ambient estimate.
    pub(super) planes: &'a mut Planes,
    /// Whether new rays stay hidden until the group ends.
    pub(super) held: bool,
    /// Rays spawned, by component.
    pub(super) spawned: PerComponent<u64>,
}

impl Spawner<'_> {
    /// Spawns the rays of one lobe, unless a limit refuses them.
    pub(super) fn spawn(&mut self, from: &Departure<'_>, lobe: &Lobe, sampler: &Sampler) {
        let parent = from.path;
        let component = Component::of(lobe.event);
        let mut ripple = (from.ripple * lobe.coefficient).min(Rgb::splat(LARGEST_RIPPLE));
        // Faded out altogether, or a blue filter behind a red one: nothing that it meets can show.
        if ripple == Rgb::ZERO {
            return;
        }
        let mut weight = from.weight * (lobe.coefficient.max_element().min(1.0) as f32);
        let reflections = parent.reflections + u32::from(lobe.event.counts_as_reflection());
        let diffuse = parent.diffuse + u32::from(component == Component::Diffuse);
        let count = if parent.last.is_none() { self.limits.rays(component) } else { 1 };

        let most = self.limits.reflections.unsigned_abs();
        let too_deep = reflections > most && self.limits.reflections != 0;
        let too_diffuse = component == Component::Diffuse && self.limits.diffuse.is_some_and(|most| diffuse > most);
        let mut refused = too_deep || too_diffuse || count == 0;
        let step = 2 * component as u32 + u32::from(lobe.event.is_transmission());
        let least = self.limits.least_weight as f32;
        if !refused && weight < least {
            if self.limits.reflections > 0 {
                refused = true;
            } else {
                let survival = weight / least;
                if sampler.single(dimension::ROULETTE + step) >= f64::from(survival) {
                    return;
                }
                ripple /= f64::from(survival);
                weight = least;
            }
        }
        if refused {
            self.estimate(component, parent.pixel, ripple);
            return;
        }
        self.spawned[component] += u64::from(count);
        if !self.bins.stores(component) {
            self.estimate(component, parent.pixel, ripple);
            self.bins.count_dropped(component, count);
            return;
        }

        let path = RayPath {
            key: parent.key.then(step),
            last: Some(component),
            first: parent.first.or(Some(component)),
            reflections,
            diffuse,
            weight,
            blind: parent.blind || lobe.event.is_spread(),
            blind_distance: if parent.blind && !lobe.event.is_spread() {
                parent.blind_distance + from.length as f32
            } else {
                0.0
            },
            medium: lobe.medium.map_or(from.medium, Medium::solid),
            ..*parent
        };
        let record = SpawnRecord {
            origin: from.point,
            leaving: from.surface,
            count,
            spread: lobe.spread,
            ripple: ripple / f64::from(count),
            path,
        };
        self.bins.push(component, record, self.held);
    }

    /// Lets the ambient value stand for diffuse rays that will not be traced.
    fn estimate(&mut self, component: Component, pixel: u32, ripple: Rgb) {
        if component == Component::Diffuse && self.ambient != Rgb::ZERO {
            self.planes.add(pixel, Plane::Ambient, ripple * self.ambient);
        }
    }
}
