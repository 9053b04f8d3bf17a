//! `ashik2`: the anisotropic Phong model of Ashikhmin and Shirley (Journal of Graphics Tools 5(2), 2000), as Radiance has
//! it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::arguments::{ArgumentError, Arguments};
use super::lobe::{Lobe, Spread};
use super::{Event, Interaction};
use crate::color::{Rgb, brightness};
use crate::math::Frame;

/// An anisotropic Phong surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ashikhmin {
    color: Rgb,
    specular: Rgb,
    /// Phong's exponents along the axis and across it.
    powers: [f64; 2],
    axis: DVec3,
}

/// Schlick's approximation: what is left to grow of a reflectance at an angle.
fn schlick(cosine: f64) -> f64 {
    (1.0 - cosine).powi(5)
}

impl Ashikhmin {
    /// From `dR dG dB sR sG sB u-power v-power`.
    ///
    /// # Errors
    /// If their number is not 8, or one is negative.
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let names = "diffuse-red -green -blue specular-red -green -blue u-power v-power";
        let mut arguments = Arguments::new(reals, &[8], "8", names)?;
        let (color, specular) = (arguments.color()?, arguments.color()?);
        let powers = [arguments.non_negative("u-power")?, arguments.non_negative("v-power")?];
        Ok(Self { color, specular, powers, axis: DVec3::X })
    }

    /// The same with patterns, which colour what is diffuse, and with the axis at a hit.
    #[must_use]
    pub fn at(self, tint: Rgb, axis: DVec3) -> Self {
        Self { color: self.color * tint, axis, ..self }
    }

    fn shiny(&self) -> bool {
        self.specular.max_element() > 1e-6
    }

    /// What the gloss reflects at an angle.
    fn gloss(&self, cosine: f64) -> Rgb {
        self.specular + (Rgb::ONE - self.specular) * schlick(cosine)
    }

    fn axes(&self, normal: DVec3) -> (Frame, [f64; 2]) {
        match normal.cross(self.axis).try_normalize() {
            Some(v) => (Frame { u: v.cross(normal), v, w: normal }, self.powers),
            None => {
                let [u, v] = self.powers;
                (Frame::around(normal), [2.0 / (1.0 / (u + 1e-5) + 1.0 / (v + 1e-5)); 2])
            }
        }
    }

    /// The fraction of a light's radiance that the surface sends back along the ray; see
    /// [`super::Response::direct`].
    #[must_use]
    pub fn direct(&self, interaction: &Interaction, to_light: DVec3, solid_angle: f64) -> Rgb {
        let Interaction { incoming, normal, .. } = *interaction;
        let cosine = normal.dot(to_light);
        if cosine <= 1e-6 {
            return Rgb::ZERO;
        }
        let mut coefficient = self.color * (cosine * solid_angle / PI * (1.0 - schlick(cosine)));
        if self.shiny()
            && let Some(half) = (to_light - incoming).try_normalize()
        {
            let (frame, [power_u, power_v]) = self.axes(normal);
            let (along, across, height) = (frame.u.dot(half), frame.v.dot(half), normal.dot(half));
            let spread = along * along * power_u + across * across * power_v;
            let flat = 1.0 - height * height;
            let exponent = if flat > 0.0 { spread / flat } else { 0.0 };
            let lobe = height.max(0.0).powf(exponent) * ((power_u + 1.0) * (power_v + 1.0)).sqrt()
                / (8.0 * PI * to_light.dot(half) * cosine.max(interaction.cosine));
            coefficient += self.gloss(interaction.cosine) * (lobe * cosine * solid_angle);
        }
        coefficient
    }

    /// Gives each lobe to `spawn`, in a fixed order; see [`super::Response::scatter`].
    pub fn scatter(&self, interaction: &Interaction, threshold: f64, mut spawn: impl FnMut(Lobe)) {
        let Interaction { incoming, normal, .. } = *interaction;
        let mut diffuse = self.color;
        let mut lobe = |event, spread, coefficient: Rgb| {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread, coefficient, medium: None });
            }
        };
        if self.shiny() {
            let gloss = self.gloss(interaction.cosine);
            if brightness(self.specular) > threshold {
                let (frame, powers) = self.axes(normal);
                let spread = Spread::Phong {
                    normal: normal.as_vec3(),
                    incoming: incoming.as_vec3(),
                    axis: frame.u.as_vec3() * (powers[0] as f32 + 1.0),
                    across: powers[1] as f32 + 1.0,
                };
                lobe(Event::RoughReflection, spread, gloss);
            } else {
                diffuse += gloss;
            }
        }
        // Radiance leaves the hemisphere out where there is no diffuse colour of the surface's own.
        if self.color.max_element() > 1e-6 {
            lobe(Event::DiffuseReflection, Spread::Cosine(normal.as_vec3()), diffuse);
        }
    }
}

/// A direction of the lobe of powers `powers` along the frame's first two axes; `None` if it lies below the surface.
pub(super) fn reflect(incoming: DVec3, frame: &Frame, powers: [f64; 2], u: [f64; 2]) -> Option<DVec3> {
    let (sin, cos) = (TAU * u[0]).sin_cos();
    let (x, y) = ((powers[1] + 1.0).sqrt() * cos, (powers[0] + 1.0).sqrt() * sin);
    let length = x.hypot(y);
    let (x, y) = (x / length, y / length);
    // Of two random numbers one is above 0: 1 - u.
    let height = (1.0 - u[1]).powf(1.0 / (powers[0] * x * x + powers[1] * y * y + 1.0));
    if height <= 1e-6 {
        return None;
    }
    let sine = (1.0 - height * height).max(0.0).sqrt();
    let half = frame.u * (x * sine) + frame.v * (y * sine) + frame.w * height;
    let direction = incoming - half * (2.0 * half.dot(incoming));
    (direction.dot(frame.w) > 1e-6).then(|| direction.normalize())
}
