//! `mist`: what a participating medium takes away and scatters.

use super::arguments::{ArgumentError, Arguments};
use crate::color::Rgb;

/// Index of a mist in `Scene::mists`, less than 32.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MistId(pub u32);

/// The real arguments of `mist`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MistArguments {
    /// Absorption and scattering, per unit of length.
    pub extinction: Rgb,
    /// The part of that which is scattering, if the mist says.
    pub albedo: Option<Rgb>,
    /// Henyey and Greenstein's eccentricity, in [0, 1], if the mist says.
    pub eccentricity: Option<f64>,
}

impl MistArguments {
    /// From none, `R G B`, `R G B R G B` or `R G B R G B g`: extinction, albedo, eccentricity.
    ///
    /// # Errors
    /// If their number is another, an extinction is negative, an albedo or the eccentricity lies outside [0, 1].
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let names = "[extinction red green blue [albedo red green blue [eccentricity]]]";
        let mut arguments = Arguments::new(reals, &[0, 3, 6, 7], "0, 3, 6 or 7", names)?;
        let mut mist = Self::default();
        if reals.len() >= 3 {
            mist.extinction = arguments.color()?;
        }
        if reals.len() >= 6 {
            let mut part = || arguments.fraction("albedo");
            mist.albedo = Some(Rgb::new(part()?, part()?, part()?));
        }
        if reals.len() == 7 {
            mist.eccentricity = Some(arguments.fraction("eccentricity")?);
        }
        Ok(mist)
    }
}
