//! `metal`: like plastic, but its gloss has the metal's colour.

use super::Interaction;
use super::arguments::{ArgumentError, Arguments};
use super::response::{Finish, Response, significant};
use crate::color::Rgb;

/// A surface whose diffuse and specular reflection are both coloured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metal {
    color: Rgb,
    finish: Finish,
}

impl Metal {
    /// From `R G B specularity roughness`.
    ///
    /// # Errors
    /// If their number is not 5, a colour is negative, the specularity lies outside [0, 1] or the roughness is negative.
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let mut arguments = Arguments::new(reals, &[5], "5", "red green blue specularity roughness")?;
        let color = arguments.color()?;
        let finish =
            Finish { specularity: arguments.fraction("specularity")?, roughness: arguments.non_negative("roughness")? };
        Ok(Self { color, finish })
    }

    /// The same under a pattern.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        Self { color: self.color * tint, ..self }
    }

    /// How the surface answers a ray. What Fresnel adds at grazing angles is white: metals lose their colour there.
    #[must_use]
    pub fn respond(&self, interaction: Interaction) -> Response {
        let fresnel = self.finish.fresnel(interaction.cosine);
        let diffuse = significant(1.0 - self.finish.reflectance(interaction.cosine));
        let colored = significant(self.finish.specularity) * (1.0 - fresnel);
        let specular = self.color * colored + Rgb::splat(fresnel);
        Response::opaque(interaction, self.finish, self.color * diffuse, specular)
    }
}
