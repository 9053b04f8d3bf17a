//! `light`, `glow`, `spotlight` and `illum`: materials that emit, from their front only.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Alternate;
use super::arguments::{ArgumentError, Arguments};
use crate::color::Rgb;

/// A surface that emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    radiance: Rgb,
    kind: EmitterKind,
}

/// How an emitter lights its surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmitterKind {
    /// `light`: a source for every point.
    Light,
    /// `glow`: a source for points nearer than `radius`. Beyond it, and everywhere if it is 0, diffuse and glossy rays
    /// find the glow by chance; if it is negative it lights nothing.
    Glow {
        /// In the scene's units of length.
        radius: f64,
    },
    /// `spotlight`: a source inside a cone.
    Spot(Spot),
    /// `illum`: a source for direct light that other rays see as another material, or not at all.
    Illum(Alternate),
}

/// The cone of a spotlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    aim: DVec3,
    focal_length: f64,
    /// 1 - cosine of the half angle.
    versine: f64,
}

impl Spot {
    /// Where it shines; a unit vector.
    #[must_use]
    pub fn aim(&self) -> DVec3 {
        self.aim
    }

    /// How far behind the surface its light seems to come from, in units of length.
    #[must_use]
    pub fn focal_length(&self) -> f64 {
        self.focal_length
    }

    /// The solid angle of the cone, sr.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        TAU * self.versine
    }

    /// Whether light that travels along the unit vector `direction` lies in the cone.
    #[must_use]
    pub fn contains(&self, direction: DVec3) -> bool {
        1.0 - self.aim.dot(direction) <= self.versine
    }
}

impl Emitter {
    /// `light` from `R G B`, radiance in W/(sr m2).
    ///
    /// # Errors
    /// If their number is not 3 or a radiance is negative.
    pub fn light(reals: &[f64]) -> Result<Self, ArgumentError> {
        let radiance = Arguments::new(reals, &[3], "3", "red green blue")?.color()?;
        Ok(Self { radiance, kind: EmitterKind::Light })
    }

    /// `glow` from `R G B radius`.
    ///
    /// # Errors
    /// If their number is not 4, a radiance is negative or the radius is not finite.
    pub fn glow(reals: &[f64]) -> Result<Self, ArgumentError> {
        let mut arguments = Arguments::new(reals, &[4], "4", "red green blue radius")?;
        Ok(Self { radiance: arguments.color()?, kind: EmitterKind::Glow { radius: arguments.finite("radius")? } })
    }

    /// `spotlight` from `R G B angle dx dy dz`: full angle of the cone in degrees, and the direction in which it
    /// shines, whose length is the focal length.
    ///
    /// # Errors
    /// If their number is not 7, a radiance is negative, the angle is not in (0,360] or the direction has no length.
    pub fn spotlight(reals: &[f64]) -> Result<Self, ArgumentError> {
        let mut arguments = Arguments::new(reals, &[7], "7", "red green blue angle dx dy dz")?;
        let radiance = arguments.color()?;
        let angle_deg = arguments.take("angle", "degrees above 0, at most 360", |x| x > 0.0 && x <= 360.0)?;
        let vector = DVec3::new(arguments.finite("dx")?, arguments.finite("dy")?, arguments.finite("dz")?);
        // By its largest part first: the squares of small numbers are 0.
        let Some(aim) = (vector / vector.abs().max_element()).try_normalize() else {
            let expected = "a direction that is not 0 0 0";
            return Err(ArgumentError::Range { position: 7, name: "dz", value: vector.z, expected });
        };
        // 1 - cos(a/2) = 2 sin^2(a/4) keeps narrow cones exact.
        let sine = (angle_deg.to_radians() / 4.0).sin();
        let spot = Spot { aim, focal_length: vector.length(), versine: 2.0 * sine * sine };
        Ok(Self { radiance, kind: EmitterKind::Spot(spot) })
    }

    /// `illum` from `R G B`, and what rays see that are not aimed at it.
    ///
    /// # Errors
    /// If their number is not 3 or a radiance is negative.
    pub fn illum(reals: &[f64], alternate: Alternate) -> Result<Self, ArgumentError> {
        let radiance = Arguments::new(reals, &[3], "3", "red green blue")?.color()?;
        Ok(Self { radiance, kind: EmitterKind::Illum(alternate) })
    }

    /// The same under a pattern.
    #[must_use]
    pub fn tinted(self, tint: Rgb) -> Self {
        Self { radiance: self.radiance * tint, ..self }
    }

    /// Radiance of its front, W/(sr m2) per channel.
    #[must_use]
    pub fn radiance(&self) -> Rgb {
        self.radiance
    }

    /// How it lights its surroundings.
    #[must_use]
    pub fn kind(&self) -> EmitterKind {
        self.kind
    }

    /// Whether it is a source of direct light to any point: whatever emits at all, so that a picture scales with its
    /// lights. Radiance leaves out those of 1e-6 and less.
    #[must_use]
    pub fn illuminates(&self) -> bool {
        let reaches = !matches!(self.kind, EmitterKind::Glow { radius } if radius <= 0.0);
        reaches && self.radiance.max_element() > 0.0
    }

    /// Radiance that a ray sees which meets the front, travelling along the unit vector `direction`. `blind` rays,
    /// which descend from a diffuse or glossy event, see only what direct lighting left out: glow farther off than its
    /// radius, `distance` being the length of the way since that event (Radiance's rule against counting light twice).
    #[must_use]
    pub fn seen(&self, direction: DVec3, blind: bool, distance: f64) -> Rgb {
        match self.kind {
            EmitterKind::Glow { radius } if blind => {
                if radius >= 0.0 && distance > radius {
                    self.radiance
                } else {
                    Rgb::ZERO
                }
            }
            EmitterKind::Spot(spot) if !blind && !spot.contains(-direction) => Rgb::ZERO,
            _ if blind => Rgb::ZERO,
            _ => self.radiance,
        }
    }
}
