//! `trans`: plastic that also passes light, straight and scattered.

use super::Interaction;
use super::arguments::{ArgumentError, Arguments};
use super::response::{Finish, Response, significant};
use crate::color::Rgb;

/// A translucent sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trans {
    color: Rgb,
    finish: Finish,
    transmissivity: f64,
    specular_share: f64,
}

/// How the light that meets a trans divides, per unit of it and but for the colour.
struct Shares {
    reflected_specular: f64,
    reflected_diffuse: f64,
    passed_specular: f64,
    passed_diffuse: f64,
}

impl Trans {
    /// From `R G B specularity roughness transmissivity transmitted-specularity`.
    ///
    /// # Errors
    /// If their number is not 7, a colour or the roughness is negative, or one of the fractions lies outside [0, 1].
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let names = "red green blue specularity roughness transmissivity transmitted-specularity";
        let mut arguments = Arguments::new(reals, &[7], "7", names)?;
        let color = arguments.color()?;
        let finish =
            Finish { specularity: arguments.fraction("specularity")?, roughness: arguments.non_negative("roughness")? };
        let transmissivity = arguments.fraction("transmissivity")?;
        let specular_share = arguments.fraction("transmitted specularity")?;
        Ok(Self { color, finish, transmissivity, specular_share })
    }

    /// The same under a pattern.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        Self { color: self.color * tint, ..self }
    }

    fn shares(&self, cosine: f64) -> Shares {
        let reflected_specular = significant(self.finish.reflectance(cosine));
        let passed = self.transmissivity * (1.0 - reflected_specular);
        let passed_specular = significant(passed * self.specular_share);
        Shares {
            reflected_specular,
            reflected_diffuse: significant(1.0 - passed - reflected_specular),
            passed_specular,
            passed_diffuse: significant(passed - passed_specular),
        }
    }

    /// How the sheet answers a ray.
    #[must_use]
    pub fn respond(&self, interaction: Interaction) -> Response {
        let shares = self.shares(interaction.cosine);
        Response {
            interaction,
            finish: self.finish,
            diffuse: self.color * shares.reflected_diffuse,
            diffuse_through: self.color * shares.passed_diffuse,
            specular: Rgb::splat(shares.reflected_specular),
            specular_through: self.color * shares.passed_specular,
            through_fraction: shares.passed_specular,
        }
    }

    /// The fraction of a light that a shadow ray brings through, per channel: a rough sheet scatters all of it, so
    /// none.
    #[must_use]
    pub fn shadow(&self, interaction: &Interaction) -> Rgb {
        if self.finish.is_smooth() { self.color * self.shares(interaction.cosine).passed_specular } else { Rgb::ZERO }
    }
}
