//! `dielectric`: the boundary of a solid that refracts and absorbs, such as glass, water or crystal.

use glam::DVec3;

use super::arguments::{ArgumentError, Arguments};
use super::fresnel;
use super::lobe::{Lobe, Spread};
use super::{Event, Interaction};
use crate::color::Rgb;

/// Extinction of a medium that passes nothing (Radiance: -ln of anything below 1e-40).
const OPAQUE_EXTINCTION: f64 = 100.0;

/// Least squared cosine of refraction; below, all is reflected.
const LEAST_COSINE2: f64 = 1e-6;

/// Indices for which Fresnel's equations keep their digits; no matter has others.
fn is_index(index: f64) -> bool {
    (1e-3..=1e3).contains(&index)
}

/// The boundary of a solid whose inside is where its surface's normal points away from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    extinction: Rgb,
    /// Of the medium outside: empty space, but for an interface.
    outside: Rgb,
    /// Index inside over index outside.
    index: f64,
}

/// Where light goes at a boundary, and how much of it.
struct Boundary {
    reflectance: f64,
    /// Direction of refraction and its radiance coefficient; `None` under total internal reflection.
    refracted: Option<(DVec3, f64)>,
}

impl Dielectric {
    /// From `R G B index Hartmann`: transmission per unit of length inside, refractive index and Hartmann's constant.
    /// Of the last only its part of the index counts, as in a Radiance built without dispersion.
    ///
    /// # Errors
    /// If their number is not 5, a transmission is negative, or the index, with Hartmann's part or without, lies outside [0.001, 1000].
    pub fn from_reals(reals: &[f64]) -> Result<Self, ArgumentError> {
        let names = "red green blue refractive-index Hartmann-constant";
        let mut arguments = Arguments::new(reals, &[5], "5", names)?;
        let transmission = arguments.color()?;
        let index = arguments.take("refractive index", "a number from 0.001 to 1000", is_index)?;
        let dispersion =
            arguments.take("Hartmann constant", "a number that leaves the index from 0.001 to 1000", |x| {
                is_index(index + x / HARTMANN_NM)
            })?;
        Ok(Self {
            extinction: transmission.to_array().map(extinction).into(),
            outside: Rgb::ZERO,
            index: index + dispersion / HARTMANN_NM,
        })
    }

    /// `interface` from `R G B index R G B index`: transmission per unit of length and refractive index, inside and
    /// outside.
    ///
    /// # Errors
    /// If their number is not 8, a transmission is negative or an index outside [0.001, 1000].
    pub fn interface(reals: &[f64]) -> Result<Self, ArgumentError> {
        let names = "red green blue refractive-index, inside and outside";
        let mut arguments = Arguments::new(reals, &[8], "8", names)?;
        let mut medium = || {
            let transmission = arguments.color()?;
            let index = arguments.take("refractive index", "a number from 0.001 to 1000", is_index)?;
            Ok((Rgb::from(transmission.to_array().map(extinction)), index))
        };
        let ((inside, index), (outside, index_outside)) = (medium()?, medium()?);
        Ok(Self { extinction: inside, outside, index: index / index_outside })
    }

    /// Absorption on the ray's side, per unit of length, where the boundary knows it: inside, and of an interface
    /// outside.
    #[must_use]
    pub fn medium(&self, front: bool) -> Option<Rgb> {
        if !front { Some(self.extinction) } else { (self.outside != Rgb::ZERO).then_some(self.outside) }
    }

    /// Absorption inside, per unit of length: radiance falls as exp(-extinction x length).
    #[must_use]
    pub fn extinction(&self) -> Rgb {
        self.extinction
    }

    /// Fresnel's equations for unpolarised light, and Snell's law. Refraction concentrates light by the square of the
    /// index ratio, so the coefficient exceeds 1 when light leaves for the thinner medium (Radiance reference manual,
    /// `dielectric`).
    fn boundary(&self, interaction: &Interaction) -> Boundary {
        let ratio = if interaction.front { 1.0 / self.index } else { self.index };
        let cosine = interaction.cosine;
        let cosine_beyond2 = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        if cosine_beyond2 < LEAST_COSINE2 {
            return Boundary { reflectance: 1.0, refracted: None };
        }
        let cosine_beyond = cosine_beyond2.sqrt();
        let reflectance = fresnel::boundary(ratio, cosine, cosine_beyond).iter().sum::<f64>() * 0.5;
        let direction = interaction.incoming * ratio + interaction.normal * (ratio * cosine - cosine_beyond);
        Boundary { reflectance, refracted: Some((direction.normalize(), (1.0 - reflectance) * ratio * ratio)) }
    }

    /// The medium that a ray is in on the far side of the boundary.
    fn beyond(&self, interaction: &Interaction) -> Rgb {
        if interaction.front { self.extinction } else { self.outside }
    }

    /// Gives each lobe to `spawn`, in a fixed order.
    pub fn scatter(&self, interaction: &Interaction, mut spawn: impl FnMut(Lobe)) {
        let boundary = self.boundary(interaction);
        if let Some((direction, coefficient)) = boundary.refracted {
            spawn(Lobe {
                event: Event::Refraction,
                spread: Spread::Ideal(direction),
                coefficient: Rgb::splat(coefficient),
                medium: Some(self.beyond(interaction)),
            });
        }
        if boundary.reflectance > 0.0 {
            spawn(Lobe {
                event: Event::BoundaryReflection,
                spread: Spread::Ideal(interaction.reflected()),
                coefficient: Rgb::splat(boundary.reflectance),
                medium: self.medium(interaction.front),
            });
        }
    }

    /// How a shadow ray goes on: direction, coefficient and the extinction of what it then travels through; `None` if
    /// nothing passes.
    #[must_use]
    pub fn shadow(&self, interaction: &Interaction) -> Option<(DVec3, f64, Rgb)> {
        let (direction, coefficient) = self.boundary(interaction).refracted?;
        Some((direction, coefficient, self.beyond(interaction)))
    }
}

/// Wavelength, nm, by which Radiance divides Hartmann's constant.
const HARTMANN_NM: f64 = 500.0;

/// Extinction of a medium that passes `transmission` per unit of length; no medium amplifies.
fn extinction(transmission: f64) -> f64 {
    if transmission < 1e-40 { OPAQUE_EXTINCTION } else { (-transmission.ln()).max(0.0) }
}
