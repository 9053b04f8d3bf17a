//! Light sources for direct light: points of them, chosen at random, and how large they look.
//!
//! One sample of a light is an unbiased estimate of its direct light: contribution = f(l) x radiance x solid angle, where f(l) is
//! reflectance with the cosine. Points are uniform over the true shape, where rpict approximates: it samples triangles and polygons of
//! more than four vertices as a square of equal area around the centroid, and gives every sample of a sphere the
//! solid angle pi r^2/d^2 instead of 2 pi (1 - cos).

mod patch;
mod relay;
mod sampler;
mod turn;

use glam::DVec3;

use super::SourceId;
use crate::color::Rgb;
use crate::geometry::{Shape, SurfaceId};
use crate::material::{DressId, Emitter, EmitterKind};

pub(super) use patch::clip_ears;
pub use relay::Leg;
pub(super) use relay::{Sheet, relayed};
use sampler::Sampler;
use turn::Turn;

/// Where a sample's solid angle saturates, sr.
const MOST_SOLID_ANGLE: f64 = 1e30;

/// A light source, or the image of one in mirrors and prisms.
#[derive(Clone, Debug)]
pub struct Light {
    source: SourceId,
    emitter: Emitter,
    /// Its patterns.
    dress: Option<DressId>,
    sampler: Sampler,
    /// The mirrors and prisms between a lit point and the source, nearest to the point first.
    relay: Vec<SurfaceId>,
    turns: Vec<Turn>,
}

/// A direction from which a light shines on a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector from the point towards the light (towards its image, if mirrors or prisms relay it).
    pub dir: DVec3,
    /// Length of the way to the light, over all mirrors (through prisms: to its image); infinite for distant sources.
    pub distance: f64,
    /// Steradians for which the sample stands: one over its density, with a spotlight's loss over its focal length.
    pub solid_angle: f64,
    /// Radiance that arrives if nothing is in the way.
    pub radiance: Rgb,
}

impl Light {
    /// A light of a surface's shape.
    pub(super) fn of_surface(surface: SurfaceId, shape: &Shape, emitter: Emitter) -> Self {
        let sampler = Sampler::of_shape(shape);
        Self { source: SourceId::Surface(surface), emitter, dress: None, sampler, relay: Vec::new(), turns: Vec::new() }
    }

    /// A distant light, `versine` being 1 - cosine of its half angle.
    pub(super) fn distant(source: SourceId, axis: DVec3, versine: f64, emitter: Emitter) -> Self {
        let sampler = Sampler::Distant { axis, versine };
        Self { source, emitter, dress: None, sampler, relay: Vec::new(), turns: Vec::new() }
    }

    /// The same light with patterns.
    pub(super) fn dressed(self, dress: Option<DressId>) -> Self {
        Self { dress, ..self }
    }

    /// The patterns that its radiance is multiplied by.
    #[must_use]
    pub fn dress(&self) -> Option<DressId> {
        self.dress
    }

    /// What shines.
    #[must_use]
    pub fn source(&self) -> SourceId {
        self.source
    }

    /// The mirrors and prisms that light meets on its way, the one nearest to the lit point first; empty for the source itself.
    #[must_use]
    pub fn relay(&self) -> &[SurfaceId] {
        &self.relay
    }

    /// How it emits.
    #[must_use]
    pub fn emitter(&self) -> &Emitter {
        &self.emitter
    }

    /// Chooses a point of the light by `u` in [0,1)^2, as seen from the point `from`. `None` if that point of it does not shine
    /// this way: it faces away, lies out of a spotlight's cone or beyond a glow's radius.
    #[must_use]
    pub fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<LightSample> {
        // What mirrors show at `from` is what is there at its image behind them.
        let mut image = from;
        for turn in &self.turns {
            image = turn.unturned(image)?;
        }
        let mut sample = self.sampler.sample(image, u)?;
        let towards_light = sample.dir;
        self.relay_sample(&mut sample, from, image)?;
        match self.emitter.kind() {
            EmitterKind::Glow { radius } if self.sampler.reach(image, &sample) > radius => return None,
            EmitterKind::Spot(spot) => {
                if !spot.contains(-towards_light) {
                    return None;
                }
                if sample.distance.is_finite() {
                    let falloff = sample.distance / (sample.distance + spot.focal_length());
                    sample.solid_angle *= falloff * falloff;
                }
            }
            _ => {}
        }
        (sample.solid_angle > 0.0 && sample.solid_angle.is_finite()).then_some(LightSample {
            dir: sample.dir,
            distance: sample.distance,
            // Next to a light's edge an estimate by area may be any number; a product with it must not overflow.
            solid_angle: sample.solid_angle.min(MOST_SOLID_ANGLE),
            radiance: self.emitter.radiance(),
        })
    }
}

#[cfg(test)]
mod tests;
