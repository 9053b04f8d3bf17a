//! `mirror`: an ideal mirror, which also relays the light sources (virtual lights).

use super::arguments::{ArgumentError, Arguments};
use super::lobe::{Lobe, Spread};
use super::{Alternate, Event, Interaction};
use crate::color::Rgb;

/// A mirror, black behind unless it has an alternate material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    reflectance: Rgb,
    alternate: Alternate,
}

impl Mirror {
    /// From `R G B`, and the material that stands for the mirror where light is not relayed.
    ///
    /// # Errors
    /// If their number is not 3 or a reflectance is negative.
    pub fn from_reals(reals: &[f64], alternate: Alternate) -> Result<Self, ArgumentError> {
        let mut arguments = Arguments::new(reals, &[3], "3", "red green blue")?;
        Ok(Self { reflectance: arguments.color()?, alternate })
    }

    /// The same under a pattern.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        Self { reflectance: self.reflectance * tint, ..self }
    }

    /// The fraction that it reflects, at every angle.
    #[must_use]
    pub fn reflectance(&self) -> Rgb {
        self.reflectance
    }

    /// What stands for the mirror where light is not relayed.
    #[must_use]
    pub fn alternate(&self) -> Alternate {
        self.alternate
    }

    /// Gives the lobe to `spawn`: none behind.
    pub fn scatter(&self, interaction: &Interaction, mut spawn: impl FnMut(Lobe)) {
        if interaction.front && self.reflectance.max_element() > 0.0 {
            spawn(Lobe {
                event: Event::MirrorReflection,
                spread: Spread::Ideal(interaction.reflected()),
                coefficient: self.reflectance,
                medium: None,
            });
        }
    }
}
