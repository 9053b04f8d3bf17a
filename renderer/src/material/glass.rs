//! `glass`: a pane thin enough to have one surface, without offset of what is seen through it.

use super::arguments::{ArgumentError, Arguments};
use super::fresnel;
use super::lobe::{Lobe, Spread};
use super::{Event, Interaction};
use crate::color::Rgb;

/// Refractive index unless given.
const GLASS_INDEX: f64 = 1.52;

/// Least transmissivity; black panes would otherwise give 0/0. Radiance has the same floor.
const LEAST_TRANSMISSIVITY: f64 = 1e-15;

/// Least fraction lost to each round of reflections inside a pane. Panes that do not amplify lose more.
const LEAST_LOSS: f64 = 1e-9;

/// A thin pane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Transmissivity at normal incidence: the fraction left after one passage through the pane, without reflections.
    transmissivity: Rgb,
    index: f64,
    /// The colour of a pattern, which filters what passes.
    tint: Rgb,
}

/// What a pane passes and reflects, interreflections inside it included.
struct Pane {
    transmitted: Rgb,
    reflected: Rgb,
}

impl Glass {
    /// From `R G B` or `R G B index`: transmissivities, not transmittances (88 % transmittance is .96).
    ///
    /// # Errors
    /// If their number is not 3 or 4, a transmissivity is negative or the index lies outside [1, 1000].
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let mut arguments = Arguments::new(reals, &[3, 4], "3 or 4", "red green blue [refractive-index]")?;
        let transmissivity = arguments.color()?;
        let index = if reals.len() == 4 {
            arguments.take("refractive index", "a number from 1 to 1000", |x| (1.0..=1e3).contains(&x))?
        } else {
            GLASS_INDEX
        };
        Ok(Self { transmissivity, index, tint: Rgb::ONE })
    }

    /// The same under a pattern.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        Self { tint: self.tint * tint, ..self }
    }

    /// Refractive index.
    pub(super) fn index(&self) -> f64 {
        self.index
    }

    /// Transmittance and reflectance of a pane, the mean of both polarisations (Radiance reference manual, `glass`).
    fn pane(&self, cosine: f64) -> Pane {
        let cosine_inside = (1.0 - (1.0 - cosine * cosine) / (self.index * self.index)).sqrt();
        let once = self.transmissivity.max(Rgb::splat(LEAST_TRANSMISSIVITY)).powf(1.0 / cosine_inside);
        let once2 = once * once;
        let mut pane = Pane { transmitted: Rgb::ZERO, reflected: Rgb::ZERO };
        for r in fresnel::boundary(1.0 / self.index, cosine, cosine_inside) {
            // A pane that amplifies (a transmissivity above 1) may have no finite sum.
            let series = (Rgb::ONE - once2 * (r * r)).max(Rgb::splat(LEAST_LOSS));
            pane.transmitted += once * (0.5 * (1.0 - r) * (1.0 - r)) / series;
            pane.reflected += (Rgb::ONE + once2 * (1.0 - 2.0 * r)) * (0.5 * r) / series;
        }
        pane.reflected = pane.reflected.max(Rgb::ZERO);
        if self.transmissivity == Rgb::ZERO {
            pane.transmitted = Rgb::ZERO;
        }
        pane.transmitted *= self.tint;
        pane
    }

    /// Gives each lobe to `spawn`, in a fixed order.
    pub fn scatter(&self, interaction: &Interaction, mut spawn: impl FnMut(Lobe)) {
        let pane = self.pane(interaction.cosine);
        let lobes = [
            (Event::PaneTransmission, interaction.incoming, pane.transmitted),
            (Event::PaneReflection, interaction.reflected(), pane.reflected),
        ];
        for (event, direction, coefficient) in lobes {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread: Spread::Ideal(direction), coefficient, medium: None });
            }
        }
    }

    /// The fraction of a light that a shadow ray brings through, per channel.
    #[must_use]
    pub fn shadow(&self, interaction: &Interaction) -> Rgb {
        self.pane(interaction.cosine).transmitted
    }
}
