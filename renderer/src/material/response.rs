//! What plastic, metal and trans have in common: diffuse and specular parts on both sides of an opaque or translucent
//! sheet.
//!
//! Formulas: Radiance's `normal` shader as its reference manual ("The RADIANCE 5.1 Synthetic Imaging System", materials
//! plastic, metal, trans) and the paper of [`super::ward`] describe it.

use std::f64::consts::PI;

use glam::DVec3;

use super::fresnel::{self, FRESNEL_LEAST_SPECULARITY};
use super::lobe::{Lobe, Spread};
use super::{Event, Interaction, ward};
use crate::color::Rgb;

/// Roughness up to which a surface counts as smooth: its reflection is ideal.
const SMOOTH: f64 = 0.001;

/// A fraction of at most this is nothing; Radiance's FTINY. It also removes what rounding leaves of 1 - 1.
const TINY: f64 = 1e-6;

/// `fraction`, or 0 where it is nothing.
pub(super) fn significant(fraction: f64) -> f64 {
    if fraction > TINY { fraction } else { 0.0 }
}

/// The finish of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Finish {
    /// Specular fraction, in [0, 1].
    pub(super) specularity: f64,
    /// Ward's alpha, 0 or more.
    pub(super) roughness: f64,
}

impl Finish {
    /// Whether reflection is ideal.
    pub(super) fn is_smooth(self) -> bool {
        self.roughness <= SMOOTH
    }

    /// Whether reflection rises towards grazing angles; only smooth surfaces of some specularity do in Radiance.
    fn follows_fresnel(self) -> bool {
        self.is_smooth() && self.specularity >= FRESNEL_LEAST_SPECULARITY
    }

    /// What Fresnel adds at an angle, as a fraction of what the specularity leaves.
    pub(super) fn fresnel(self, cosine: f64) -> f64 {
        if self.follows_fresnel() { fresnel::approximate(cosine) } else { 0.0 }
    }

    /// The specular fraction at an angle.
    pub(super) fn reflectance(self, cosine: f64) -> f64 {
        self.specularity + self.fresnel(cosine) * (1.0 - self.specularity)
    }
}

/// How a surface answers one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    pub(super) interaction: Interaction,
    pub(super) finish: Finish,
    /// Coefficients of the diffuse parts, by side.
    pub(super) diffuse: Rgb,
    pub(super) diffuse_through: Rgb,
    /// Coefficients of the specular parts, by side.
    pub(super) specular: Rgb,
    pub(super) specular_through: Rgb,
    /// The colourless factor of `specular_through`, which `-st` looks at.
    pub(super) through_fraction: f64,
}

impl Response {
    /// A surface that only reflects.
    pub(super) fn opaque(interaction: Interaction, finish: Finish, diffuse: Rgb, specular: Rgb) -> Self {
        let diffuse_through = Rgb::ZERO;
        let specular_through = Rgb::ZERO;
        Self { interaction, finish, diffuse, diffuse_through, specular, specular_through, through_fraction: 0.0 }
    }

    /// Whether direct light can reach the eye by this surface: not off an ideal mirror or through a clear sheet.
    #[must_use]
    pub fn takes_direct_light(&self) -> bool {
        let diffuse = self.diffuse.max_element().max(self.diffuse_through.max_element());
        diffuse > 0.0 || !self.finish.is_smooth()
    }

    /// The fraction of a light's radiance that the surface sends back along the ray, per channel. `to_light` is the
    /// unit direction towards the light, which subtends `solid_angle` steradians.
    #[must_use]
    pub fn direct(&self, to_light: DVec3, solid_angle: f64) -> Rgb {
        let cosine = self.interaction.normal.dot(to_light);
        // A smooth surface that reflects more of the light leaves less of it to be scattered.
        let entering = 1.0 - self.finish.fresnel(cosine.abs());
        if cosine > 0.0 {
            let mut coefficient = self.diffuse * (entering * cosine * solid_angle / PI);
            if !self.finish.is_smooth() && self.specular != Rgb::ZERO {
                let variance = self.finish.roughness * self.finish.roughness;
                let lobe = ward::reflection(self.interaction.incoming, self.interaction.normal, variance, to_light);
                coefficient += self.specular * (lobe * cosine * solid_angle);
            }
            coefficient
        } else if cosine < 0.0 {
            let mut coefficient = self.diffuse_through * (entering * -cosine * solid_angle / PI);
            if !self.finish.is_smooth() && self.specular_through != Rgb::ZERO {
                let variance = self.finish.roughness * self.finish.roughness;
                let Interaction { incoming, normal, cosine, .. } = self.interaction;
                let lobe = ward::transmission(incoming, normal, cosine, variance, to_light);
                coefficient += self.specular_through * (lobe * solid_angle);
            }
            coefficient
        } else {
            Rgb::ZERO
        }
    }

    /// Gives each lobe to `spawn`, in a fixed order. A rough lobe whose specular fraction does not exceed
    /// `threshold` (rpict's `-st`) joins the diffuse coefficient of its side instead.
    pub fn scatter(&self, threshold: f64, mut spawn: impl FnMut(Lobe)) {
        let Interaction { incoming, normal, .. } = self.interaction;
        let (mut diffuse, mut diffuse_through) = (self.diffuse, self.diffuse_through);
        let mut lobe = |event, spread, coefficient: Rgb| {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread, coefficient, medium: None });
            }
        };
        if self.finish.is_smooth() {
            lobe(Event::SmoothTransmission, Spread::Ideal(incoming), self.specular_through);
            lobe(Event::SmoothReflection, Spread::Ideal(self.interaction.reflected()), self.specular);
        } else {
            let roughness = self.finish.roughness as f32;
            let single = normal.as_vec3();
            let incoming = incoming.as_vec3();
            if self.finish.specularity > threshold {
                let spread = Spread::RoughReflection { normal: single, incoming, roughness };
                lobe(Event::RoughReflection, spread, self.specular);
            } else {
                diffuse += self.specular;
            }
            if self.through_fraction > threshold {
                let spread = Spread::RoughTransmission { normal: single, through: incoming, roughness };
                lobe(Event::RoughTransmission, spread, self.specular_through);
            } else {
                diffuse_through += self.specular_through;
            }
        }
        lobe(Event::DiffuseReflection, Spread::Cosine(normal.as_vec3()), diffuse);
        lobe(Event::DiffuseTransmission, Spread::Cosine(-normal.as_vec3()), diffuse_through);
    }
}
