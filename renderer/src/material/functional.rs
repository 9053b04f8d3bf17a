//! `plasfunc`, `metfunc`, `transfunc`, their kin of tables, and `BRTDfunc`: materials whose answer to lights is a function
//! of the scene. Other light they scatter diffusely; `BRTDfunc` also mirrors and passes some.

use std::f64::consts::PI;

use glam::DVec3;

use super::lobe::{Lobe, Spread};
use super::{Event, Interaction};
use crate::color::Rgb;

/// Such a surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Functional {
    /// The material's colour, patterns included.
    pub color: Rgb,
    /// Diffuse reflection of lights.
    pub diffuse: Rgb,
    /// Diffuse transmission of lights.
    pub diffuse_through: Rgb,
    /// Times the function's value on the side of the ray.
    pub lobe: Rgb,
    /// Times the function's value on the other side.
    pub lobe_through: Rgb,
    /// Diffuse reflection of all other light.
    pub ambient: Rgb,
    /// Diffuse transmission of all other light.
    pub ambient_through: Rgb,
    /// Ideal reflection.
    pub mirrored: Rgb,
    /// Ideal transmission.
    pub passed: Rgb,
}

impl Functional {
    /// The fraction of a light's radiance that the surface sends back along the ray; `function` gives the value of the
    /// scene's own function for the direction to the light.
    pub fn direct(
        &self,
        interaction: &Interaction,
        to_light: DVec3,
        solid_angle: f64,
        function: impl FnOnce() -> Option<Rgb>,
    ) -> Rgb {
        let cosine = interaction.normal.dot(to_light);
        let (diffuse, lobe) =
            if cosine > 0.0 { (self.diffuse, self.lobe) } else { (self.diffuse_through, self.lobe_through) };
        let mut coefficient = diffuse / PI;
        if lobe != Rgb::ZERO
            && let Some(value) = function()
        {
            coefficient += lobe * value.max(Rgb::ZERO);
        }
        coefficient * (cosine.abs() * solid_angle)
    }

    /// Whether light sources show on it.
    #[must_use]
    pub fn takes_direct_light(&self) -> bool {
        [self.diffuse, self.diffuse_through, self.lobe, self.lobe_through].iter().any(|part| *part != Rgb::ZERO)
    }

    /// Gives each lobe to `spawn`, in a fixed order.
    pub fn scatter(&self, interaction: &Interaction, mut spawn: impl FnMut(Lobe)) {
        let normal = interaction.normal.as_vec3();
        let lobes = [
            (Event::SmoothTransmission, Spread::Ideal(interaction.incoming), self.passed),
            (Event::SmoothReflection, Spread::Ideal(interaction.reflected()), self.mirrored),
            (Event::DiffuseReflection, Spread::Cosine(normal), self.ambient),
            (Event::DiffuseTransmission, Spread::Cosine(-normal), self.ambient_through),
        ];
        for (event, spread, coefficient) in lobes {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread, coefficient, medium: None });
            }
        }
    }
}
