//! `plastic2`, `metal2`, `trans2`: plastic, metal and trans whose gloss is wider along one direction than across it.
//!
//! Formulas: Ward 1992 and its normalisation of 2010, as in [`super::ward`], with a roughness for each of two directions.

use std::f64::consts::PI;

use glam::DVec3;

use super::arguments::{ArgumentError, Arguments};
use super::lobe::{Lobe, Spread};
use super::response::significant;
use super::{Event, Interaction};
use crate::color::Rgb;
use crate::math::Frame;

/// What the gloss reflects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gloss {
    /// Light as it is: plastic2, trans2.
    White,
    /// Light of the material's colour: metal2.
    Colored,
}

/// An anisotropic surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anisotropic {
    color: Rgb,
    gloss: Gloss,
    specularity: f64,
    /// Along the axis and across it.
    roughness: [f64; 2],
    passed_specular: f64,
    passed_diffuse: f64,
    /// The direction along which the first roughness counts, not yet perpendicular to the normal.
    axis: DVec3,
}

/// The directions of the gloss at a hit.
pub(super) struct Axes {
    along: DVec3,
    across: DVec3,
    roughness: [f64; 2],
}

impl Axes {
    /// Around a normal, the first along `axis` as far as that is perpendicular.
    pub(super) fn of(normal: DVec3, axis: DVec3, roughness: [f64; 2]) -> Self {
        match normal.cross(axis).try_normalize() {
            Some(across) => Self { along: across.cross(normal), across, roughness },
            // An axis along the normal: as rough in all directions, by the mean of both.
            None => {
                let frame = Frame::around(normal);
                let [along, across] = roughness;
                let mean = (0.5 * (along * along + across * across)).sqrt();
                Self { along: frame.u, across: frame.v, roughness: [mean; 2] }
            }
        }
    }

    fn slopes2(&self, half: DVec3) -> f64 {
        let [along, across] = [half.dot(self.along) / self.roughness[0], half.dot(self.across) / self.roughness[1]];
        along * along + across * across
    }

    fn scale(&self) -> f64 {
        PI * self.roughness[0] * self.roughness[1]
    }

    /// Value of the reflection lobe, 1/sr.
    pub(super) fn reflected(&self, incoming: DVec3, normal: DVec3, to_light: DVec3) -> f64 {
        let half = to_light - incoming;
        let height = half.dot(normal);
        if height <= 0.0 {
            return 0.0;
        }
        let height2 = height * height;
        (-self.slopes2(half) / height2).exp() * half.length_squared() / (self.scale() * height2 * height2)
    }

    /// The fraction passed per solid angle, with the light's cosine in it; `cosine` is that of the incoming ray.
    pub(super) fn passed(&self, through: DVec3, normal: DVec3, cosine: f64, to_light: DVec3) -> f64 {
        let off = to_light - through;
        let length2 = off.length_squared();
        let height = off.dot(normal);
        let sine2 = if length2 > 1e-12 { 1.0 - height * height / length2 } else { 0.0 };
        let exponent = if sine2 > 1e-12 { self.slopes2(off) / sine2 } else { 0.0 };
        (-exponent).exp() * (-to_light.dot(normal) / cosine).sqrt() / self.scale()
    }

    /// The first direction, as long as its roughness, and the other's roughness.
    pub(super) fn scaled(&self) -> (glam::Vec3, f32) {
        let [along, across] = self.roughness.map(|roughness| roughness as f32);
        (self.along.as_vec3() * along, across)
    }
}

impl Anisotropic {
    /// From `R G B specularity along across [transmissivity transmitted-specularity]`.
    ///
    /// # Errors
    /// If their number is neither 6 nor 8, a colour is negative, a fraction lies outside [0, 1] or a roughness is not above
    /// 0.
    pub fn from_reals(reals: &[f64], gloss: Gloss, passes: bool) -> Result<Self, ArgumentError> {
        let (counts, expected, names): (&[usize], _, _) = if passes {
            (&[8], "8", "red green blue specularity u-roughness v-roughness transmissivity transmitted-specularity")
        } else {
            (&[6], "6", "red green blue specularity u-roughness v-roughness")
        };
        let mut arguments = Arguments::new(reals, counts, expected, names)?;
        let color = arguments.color()?;
        let specularity = significant(arguments.fraction("specularity")?);
        let mut rough = |name| arguments.take(name, "a finite number above 0", |x| x > 0.0 && x < f64::INFINITY);
        let roughness = [rough("u-roughness")?, rough("v-roughness")?];
        let (transmissivity, share) = if passes {
            (arguments.fraction("transmissivity")?, arguments.fraction("transmitted specularity")?)
        } else {
            (0.0, 0.0)
        };
        let passed = transmissivity * (1.0 - specularity);
        let passed_specular = significant(passed * share);
        Ok(Self {
            color,
            gloss,
            specularity,
            roughness,
            passed_specular,
            passed_diffuse: significant(passed - passed_specular),
            axis: DVec3::X,
        })
    }

    /// The same with patterns and with the axis at a hit.
    #[must_use]
    pub fn at(self, tint: Rgb, axis: DVec3) -> Self {
        Self { color: self.color * tint, axis, ..self }
    }

    fn diffuse(&self) -> Rgb {
        let passed = self.passed_specular + self.passed_diffuse;
        self.color * significant(1.0 - passed - self.specularity)
    }

    fn specular(&self) -> Rgb {
        match self.gloss {
            Gloss::White => Rgb::splat(self.specularity),
            Gloss::Colored => self.color * self.specularity,
        }
    }

    fn axes(&self, normal: DVec3) -> Axes {
        Axes::of(normal, self.axis, self.roughness)
    }

    /// The fraction of a light's radiance that the surface sends back along the ray; see
    /// [`super::Response::direct`].
    #[must_use]
    pub fn direct(&self, interaction: &Interaction, to_light: DVec3, solid_angle: f64) -> Rgb {
        let Interaction { incoming, normal, .. } = *interaction;
        let cosine = normal.dot(to_light);
        let axes = self.axes(normal);
        if cosine > 0.0 {
            let mut coefficient = self.diffuse() * (cosine * solid_angle / PI);
            if self.specularity > 0.0 {
                let lobe = axes.reflected(incoming, normal, to_light);
                coefficient += self.specular() * (lobe * cosine * solid_angle);
            }
            coefficient
        } else if cosine < 0.0 {
            let mut coefficient = self.color * (self.passed_diffuse * -cosine * solid_angle / PI);
            if self.passed_specular > 0.0 {
                let lobe = axes.passed(incoming, normal, interaction.cosine, to_light);
                coefficient += self.color * (self.passed_specular * lobe * solid_angle);
            }
            coefficient
        } else {
            Rgb::ZERO
        }
    }

    /// Gives each lobe to `spawn`, in a fixed order; see [`super::Response::scatter`].
    pub fn scatter(&self, interaction: &Interaction, threshold: f64, mut spawn: impl FnMut(Lobe)) {
        let Interaction { incoming, normal, .. } = *interaction;
        let axes = self.axes(normal);
        let (mut diffuse, mut through) = (self.diffuse(), self.color * self.passed_diffuse);
        let mut lobe = |event, spread, coefficient: Rgb| {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread, coefficient, medium: None });
            }
        };
        let (axis, across) = axes.scaled();
        let (normal32, incoming32) = (normal.as_vec3(), incoming.as_vec3());
        if self.specularity > threshold {
            let spread = Spread::EllipticReflection { normal: normal32, incoming: incoming32, axis, across };
            lobe(Event::RoughReflection, spread, self.specular());
        } else {
            diffuse += self.specular();
        }
        if self.passed_specular > threshold {
            let spread = Spread::EllipticTransmission { normal: normal32, through: incoming32, axis, across };
            lobe(Event::RoughTransmission, spread, self.color * self.passed_specular);
        } else {
            through += self.color * self.passed_specular;
        }
        lobe(Event::DiffuseReflection, Spread::Cosine(normal32), diffuse);
        lobe(Event::DiffuseTransmission, Spread::Cosine(-normal32), through);
    }
}
