//! A lobe: one event at a hit, with the directions that its rays may take.

use glam::{DVec3, Vec3};

use super::Event;
use super::ward;
use crate::color::Rgb;
use crate::math::{Frame, warp};

/// One way in which a surface passes light on: what spawns rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// What happens.
    pub event: Event,
    /// Where the rays go.
    pub spread: Spread,
    /// Radiance that arrives along the lobe is multiplied by this; the mean over the lobe, so not divided by a density.
    pub coefficient: Rgb,
    /// The extinction, per unit of length, of the medium that the rays enter (0: nothing absorbs); `None`: the medium
    /// that the incoming ray was in.
    pub medium: Option<Rgb>,
}

/// The distribution of a lobe's directions. Directions of spread lobes are random, so single precision describes them;
/// an ideal direction keeps all its digits, for chains of mirrors at large coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// One direction (a unit vector).
    Ideal(DVec3),
    /// Cosine-weighted hemisphere around a unit vector.
    Cosine(Vec3),
    /// Ward's reflection lobe around the mirror direction.
    RoughReflection {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the incoming ray.
        incoming: Vec3,
        /// Ward's alpha.
        roughness: f32,
    },
    /// Radiance's lobe around the transmitted direction.
    RoughTransmission {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the ray that would pass straight through.
        through: Vec3,
        /// Width of the lobe.
        roughness: f32,
    },
}

/// How a rough lobe is sampled: rpict's `-ss`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlossySampling {
    /// In [0, 1]: how much of the lobe's width is sampled; 0 gives the ideal direction.
    pub width: f64,
    /// Weigh each direction by 2/(1 + cos_in/cos_out) and count those below the surface as dark, as rpict does when it
    /// takes several samples of a lobe; otherwise each weighs 1 and those below the surface are drawn again.
    pub weighted: bool,
}

impl GlossySampling {
    /// Draws that may fall below the surface before the lobe is given up.
    const TRIALS: u32 = 10;
}

impl Spread {
    /// A direction of the lobe (a unit vector) with its weight, whose mean is 1 but for [`GlossySampling::weighted`];
    /// `None` if the direction drawn lies below the surface. `draw(trial)` gives a point of the unit square for each
    /// trial.
    #[must_use]
    pub fn direction(&self, glossy: GlossySampling, draw: impl Fn(u32) -> [f64; 2]) -> Option<(DVec3, f64)> {
        match *self {
            Self::Ideal(direction) => Some((direction, 1.0)),
            Self::Cosine(axis) => {
                let frame = Frame::around(axis.as_dvec3().normalize());
                Some((frame.to_world(warp::cosine_hemisphere(draw(0))), 1.0))
            }
            Self::RoughReflection { normal, incoming, roughness } => {
                let (normal, incoming) = (normal.as_dvec3().normalize(), incoming.as_dvec3().normalize());
                let sample = |trial| ward::reflect(incoming, normal, f64::from(roughness), glossy.width, draw(trial));
                if glossy.weighted {
                    let direction = sample(0)?;
                    let ratio = -incoming.dot(normal) / direction.dot(normal);
                    Some((direction, 2.0 / (1.0 + ratio)))
                } else {
                    (0..GlossySampling::TRIALS).find_map(sample).map(|direction| (direction, 1.0))
                }
            }
            Self::RoughTransmission { normal, through, roughness } => {
                let (normal, through) = (normal.as_dvec3().normalize(), through.as_dvec3().normalize());
                let sample = |trial| ward::transmit(through, normal, f64::from(roughness), glossy.width, draw(trial));
                let trials = if glossy.weighted { 1 } else { GlossySampling::TRIALS };
                (0..trials).find_map(sample).map(|direction| (direction, 1.0))
            }
        }
    }
}
