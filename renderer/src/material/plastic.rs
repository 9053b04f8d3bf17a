//! `plastic`: coloured diffuse reflection under an uncoloured gloss.

use super::Interaction;
use super::arguments::{ArgumentError, Arguments};
use super::response::{Finish, Response, significant};
use crate::color::Rgb;

/// A surface that reflects its colour diffusely, and white light specularly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    color: Rgb,
    finish: Finish,
}

impl Plastic {
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

    /// How the surface answers a ray.
    #[must_use]
    pub fn respond(&self, interaction: Interaction) -> Response {
        let specular = significant(self.finish.reflectance(interaction.cosine));
        let diffuse = significant(1.0 - specular);
        Response::opaque(interaction, self.finish, self.color * diffuse, Rgb::splat(specular))
    }
}
