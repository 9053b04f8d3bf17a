//! `WGMDfunc`: diffuse and glossy reflection and transmission, each with patterns, textures and roughness of its own
//! (Radiance reference manual; the model is that of [`super::Anisotropic`]).

use std::f64::consts::PI;

use glam::DVec3;

use super::anisotropic::Axes;
use super::fresnel::{self, FRESNEL_LEAST_SPECULARITY};
use super::lobe::{Lobe, Spread};
use super::{Event, Interaction};
use crate::color::{Rgb, brightness};

/// One of the parts of such a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facet {
    /// What it reflects or passes.
    pub color: Rgb,
    /// Unit normal, bent by its textures, on the side that the ray comes from.
    pub normal: DVec3,
}

/// A gloss at a hit: a facet, and the roughness along the axis and across it; one of 0 makes it ideal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheen {
    /// Colour and normal.
    pub facet: Facet,
    /// Along the axis and across it.
    pub roughness: [f64; 2],
}

/// Roughness of at most this is none (rpict).
const SMOOTH: f64 = 1e-6;

impl Sheen {
    fn is_smooth(&self) -> bool {
        self.roughness.iter().any(|&roughness| roughness <= SMOOTH)
    }
}

/// Such a surface at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wgmd {
    /// The surface's own unit normal on the side that the ray comes from.
    flat: DVec3,
    diffuse: Facet,
    diffuse_through: Facet,
    reflected: Sheen,
    passed: Sheen,
    /// The direction along which the first roughnesses count.
    axis: DVec3,
    /// The direction of ideal transmission.
    through: DVec3,
}

impl Wgmd {
    /// From its parts, as a ray of direction `incoming` meets a surface whose front has the normal `front_normal`.
    #[must_use]
    pub fn new(
        (incoming, front_normal): (DVec3, DVec3),
        [diffuse, diffuse_through]: [Facet; 2],
        [reflected, passed]: [Sheen; 2],
        axis: DVec3,
    ) -> Self {
        let front = incoming.dot(front_normal) < 0.0;
        let flat = if front { front_normal } else { -front_normal };
        // A texture turns what passes the same way, whichever side the ray comes from.
        let turn = (passed.facet.normal - flat) * if front { -1.0 } else { 1.0 };
        let through = (incoming + turn).normalize_or(incoming);
        let through = if through.dot(flat) < 0.0 { through } else { incoming };
        let mut surface = Self { flat, diffuse, diffuse_through, reflected, passed, axis, through };
        if surface.follows_fresnel() {
            let cosine = (-incoming.dot(reflected.facet.normal)).max(Interaction::LEAST_COSINE);
            let more = fresnel::approximate(cosine);
            let color = &mut surface.reflected.facet.color;
            *color += (Rgb::ONE - *color) * more;
            surface.diffuse.color *= 1.0 - more;
            surface.diffuse_through.color *= 1.0 - more;
            surface.passed.facet.color *= 1.0 - more;
        }
        surface
    }

    fn follows_fresnel(&self) -> bool {
        self.reflected.is_smooth() && brightness(self.reflected.facet.color) >= FRESNEL_LEAST_SPECULARITY
    }

    /// Whether light sources show on it.
    #[must_use]
    pub fn takes_direct_light(&self) -> bool {
        let rough = |sheen: &Sheen| if sheen.is_smooth() { Rgb::ZERO } else { sheen.facet.color };
        let parts = [self.diffuse.color, self.diffuse_through.color, rough(&self.reflected), rough(&self.passed)];
        parts.iter().any(|part| *part != Rgb::ZERO)
    }

    /// What it lets a shadow ray bring through.
    #[must_use]
    pub fn shadow(&self) -> Rgb {
        if self.passed.is_smooth() { self.passed.facet.color } else { Rgb::ZERO }
    }

    fn axes(&self, sheen: &Sheen) -> Axes {
        Axes::of(sheen.facet.normal, self.axis, sheen.roughness)
    }

    /// The fraction of a light's radiance that the surface sends back along a ray of direction `incoming`; see
    /// [`super::Response::direct`].
    #[must_use]
    pub fn direct(&self, incoming: DVec3, to_light: DVec3, solid_angle: f64) -> Rgb {
        let entering = if self.follows_fresnel() {
            1.0 - fresnel::approximate(self.reflected.facet.normal.dot(to_light).abs())
        } else {
            1.0
        };
        let mut coefficient = Rgb::ZERO;
        let cosine = self.diffuse.normal.dot(to_light);
        if cosine > 0.0 {
            coefficient += self.diffuse.color * (entering * cosine * solid_angle / PI);
        }
        let cosine = self.diffuse_through.normal.dot(to_light);
        if cosine < 0.0 {
            coefficient += self.diffuse_through.color * (entering * -cosine * solid_angle / PI);
        }
        let Facet { color, normal } = self.reflected.facet;
        let cosine = normal.dot(to_light);
        if color != Rgb::ZERO && !self.reflected.is_smooth() && cosine > 0.0 {
            let lobe = self.axes(&self.reflected).reflected(incoming, normal, to_light);
            coefficient += color * (lobe * cosine * solid_angle);
        }
        let Facet { color, normal } = self.passed.facet;
        let cosine = normal.dot(to_light);
        if color != Rgb::ZERO && !self.passed.is_smooth() && cosine < 0.0 {
            let arriving = (-incoming.dot(normal)).max(Interaction::LEAST_COSINE);
            let lobe = self.axes(&self.passed).passed(self.through, normal, arriving, to_light);
            coefficient += color * (lobe * solid_angle);
        }
        coefficient
    }

    /// Gives each lobe to `spawn`, in a fixed order; see [`super::Response::scatter`].
    pub fn scatter(&self, incoming: DVec3, threshold: f64, mut spawn: impl FnMut(Lobe)) {
        let mut lobe = |event, spread, coefficient: Rgb| {
            if coefficient.max_element() > 0.0 {
                spawn(Lobe { event, spread, coefficient, medium: None });
            }
        };
        let (mut diffuse, mut through) = (self.diffuse.color, self.diffuse_through.color);
        let Facet { color, normal } = self.passed.facet;
        if self.passed.is_smooth() {
            lobe(Event::SmoothTransmission, Spread::Ideal(self.through), color);
        } else if brightness(color) > threshold {
            let (axis, across) = self.axes(&self.passed).scaled();
            let (normal, through) = (normal.as_vec3(), self.through.as_vec3());
            lobe(Event::RoughTransmission, Spread::EllipticTransmission { normal, through, axis, across }, color);
        } else if through != Rgb::ZERO {
            through += color;
        }
        let Facet { color, normal } = self.reflected.facet;
        if self.reflected.is_smooth() {
            let mirrored = |normal: DVec3| (incoming - normal * (2.0 * incoming.dot(normal))).normalize();
            let direction = mirrored(normal);
            // One that a texture bends below the surface falls back to the surface's own.
            let direction = if direction.dot(self.flat) > 0.0 { direction } else { mirrored(self.flat) };
            lobe(Event::SmoothReflection, Spread::Ideal(direction), color);
        } else if brightness(color) > threshold {
            let (axis, across) = self.axes(&self.reflected).scaled();
            let (normal, incoming) = (normal.as_vec3(), incoming.as_vec3());
            lobe(Event::RoughReflection, Spread::EllipticReflection { normal, incoming, axis, across }, color);
        } else if diffuse != Rgb::ZERO {
            diffuse += color;
        }
        let side = |facet: Facet, sense: f64| {
            let (axis, above) = ((facet.normal * sense).as_vec3(), (self.flat * sense).as_vec3());
            if facet.normal == self.flat { Spread::Cosine(axis) } else { Spread::CosineAbove { axis, above } }
        };
        lobe(Event::DiffuseReflection, side(self.diffuse, 1.0), diffuse);
        lobe(Event::DiffuseTransmission, side(self.diffuse_through, -1.0), through);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Anisotropic, Gloss};

    /// Without textures, and with what is left of the specular parts diffuse, it is trans2.
    #[test]
    fn it_is_trans2_where_that_can_say_the_same() {
        let other = Anisotropic::from_reals(&[1.0, 1.0, 1.0, 0.1, 0.2, 0.05, 0.5, 0.3], Gloss::White, true).unwrap();
        let axis = DVec3::new(0.3, 1.0, 0.2);
        let incoming = DVec3::new(0.5, 0.2, -0.7).normalize();
        let facet = |color: f64| Facet { color: Rgb::splat(color), normal: DVec3::Z };
        let sheen = |color| Sheen { facet: facet(color), roughness: [0.2, 0.05] };
        let passed = 0.5 * 0.9;
        let diffuse = [facet(1.0 - passed - 0.1), facet(passed * 0.7)];
        let surface = Wgmd::new((incoming, DVec3::Z), diffuse, [sheen(0.1), sheen(passed * 0.3)], axis);
        let interaction = Interaction::new(incoming, DVec3::Z);
        for to_light in [[0.5, 0.2, 0.7], [0.6, 0.1, 0.5], [0.4, 0.3, -0.8], [0.5, 0.2, -0.6]] {
            let to_light = DVec3::from(to_light).normalize();
            let (found, expected) = (
                surface.direct(incoming, to_light, 0.01),
                other.at(Rgb::ONE, axis).direct(&interaction, to_light, 0.01),
            );
            assert!((found - expected).length() < 1e-12, "{to_light}: {found}, not {expected}");
        }
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        surface.scatter(incoming, 0.0, |lobe| ours.push((lobe.event, lobe.coefficient)));
        other.scatter(&interaction, 0.0, |lobe| theirs.push((lobe.event, lobe.coefficient)));
        for (event, coefficient) in theirs {
            assert!(ours.iter().any(|(other, found)| *other == event && (*found - coefficient).length() < 1e-12));
        }
    }
}
