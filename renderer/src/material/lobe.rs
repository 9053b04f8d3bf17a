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
    /// Cosine-weighted hemisphere around one unit vector, of which only what lies above the plane of another counts.
    CosineAbove {
        /// The bent normal.
        axis: Vec3,
        /// The surface's own.
        above: Vec3,
    },
    /// Ward's reflection lobe around the mirror direction.
    RoughReflection {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the incoming ray.
        incoming: Vec3,
        /// Ward's alpha.
        roughness: f32,
    },
    /// Ward's reflection lobe, wider one way than the other.
    EllipticReflection {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the incoming ray.
        incoming: Vec3,
        /// The direction of the first roughness, as long as that.
        axis: Vec3,
        /// The roughness across it.
        across: f32,
    },
    /// The transmission lobe, wider one way than the other.
    EllipticTransmission {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the ray that would pass straight through.
        through: Vec3,
        /// The direction of the first roughness, as long as that.
        axis: Vec3,
        /// The roughness across it.
        across: f32,
    },
    /// The lobe of [`super::Ashikhmin`].
    Phong {
        /// Unit normal on the side of the incoming ray.
        normal: Vec3,
        /// Direction of the incoming ray.
        incoming: Vec3,
        /// The direction of the first power, that and 1 long.
        axis: Vec3,
        /// The power across it, and 1.
        across: f32,
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
            Self::CosineAbove { axis, above } => {
                let frame = Frame::around(axis.as_dvec3().normalize());
                let direction = frame.to_world(warp::cosine_hemisphere(draw(0)));
                (direction.dot(above.as_dvec3()) > 0.0).then_some((direction, 1.0))
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
            Self::EllipticReflection { normal, incoming, axis, across } => {
                let (frame, along) = elliptic(normal, axis);
                let incoming = incoming.as_dvec3().normalize();
                let sample = |trial| {
                    let slopes = ward::slopes([along, f64::from(across)], glossy.width, draw(trial));
                    ward::reflect_about(incoming, &frame, slopes)
                };
                if glossy.weighted {
                    let direction = sample(0)?;
                    let ratio = -incoming.dot(frame.w) / direction.dot(frame.w);
                    Some((direction, 2.0 / (1.0 + ratio)))
                } else {
                    (0..GlossySampling::TRIALS).find_map(sample).map(|direction| (direction, 1.0))
                }
            }
            Self::EllipticTransmission { normal, through, axis, across } => {
                let (frame, along) = elliptic(normal, axis);
                let through = through.as_dvec3().normalize();
                let sample = |trial| {
                    let slopes = ward::slopes([along, f64::from(across)], glossy.width, draw(trial));
                    ward::transmit_about(through, &frame, slopes)
                };
                let trials = if glossy.weighted { 1 } else { GlossySampling::TRIALS };
                (0..trials).find_map(sample).map(|direction| (direction, 1.0))
            }
            Self::Phong { normal, incoming, axis, across } => {
                let (frame, along) = elliptic(normal, axis);
                let incoming = incoming.as_dvec3().normalize();
                let powers = [along - 1.0, f64::from(across) - 1.0];
                let sample = |trial| super::ashikhmin::reflect(incoming, &frame, powers, draw(trial));
                (0..GlossySampling::TRIALS).find_map(sample).map(|direction| (direction, 1.0))
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

/// The frame around a normal whose first axis is along `axis`, and that vector's length.
fn elliptic(normal: Vec3, axis: Vec3) -> (Frame, f64) {
    let (w, axis) = (normal.as_dvec3().normalize(), axis.as_dvec3());
    // Both were unit vectors at right angles before they were rounded.
    let v = w.cross(axis).normalize_or(Frame::around(w).v);
    (Frame { u: v.cross(w), v, w }, axis.length())
}
