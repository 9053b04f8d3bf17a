//! What a bent normal does to where rays go.

use glam::DVec3;

use super::lobe::{Lobe, Spread};
use super::{Event, Material};

/// A texture's effect on a hit, on the side that the ray comes from.
#[derive(Clone, Copy, Debug)]
pub struct Bend {
    incoming: DVec3,
    /// The surface's own unit normal.
    flat: DVec3,
    /// What the texture added to it.
    shift: DVec3,
}

impl Bend {
    /// For a ray of direction `incoming` at a surface whose front has the normal `front_normal`, to which a texture
    /// adds `shift`.
    #[must_use]
    pub fn new(incoming: DVec3, front_normal: DVec3, shift: DVec3) -> Self {
        if incoming.dot(front_normal) < 0.0 {
            Self { incoming, flat: front_normal, shift }
        } else {
            Self { incoming, flat: -front_normal, shift: -shift }
        }
    }

    /// Rays stay on their side of the surface, and what passes is turned aside by as much as Radiance does.
    #[must_use]
    pub fn adjust(&self, lobe: Lobe, material: &Material) -> Lobe {
        let incoming = self.incoming;
        let aside = |direction: DVec3| {
            let direction = direction.normalize_or(incoming);
            if direction.dot(self.flat) < 0.0 { direction } else { incoming }
        };
        let spread = match (lobe.event, lobe.spread) {
            (Event::DiffuseReflection, Spread::Cosine(axis)) => {
                Spread::CosineAbove { axis, above: self.flat.as_vec3() }
            }
            (Event::DiffuseTransmission, Spread::Cosine(axis)) => {
                Spread::CosineAbove { axis, above: -self.flat.as_vec3() }
            }
            (Event::SmoothTransmission, Spread::Ideal(_)) => Spread::Ideal(aside(incoming - self.shift)),
            (Event::RoughTransmission, Spread::RoughTransmission { normal, roughness, .. }) => {
                Spread::RoughTransmission { normal, through: aside(incoming - self.shift).as_vec3(), roughness }
            }
            (Event::PaneTransmission, Spread::Ideal(_)) => match material {
                Material::Glass(glass) => Spread::Ideal(aside(incoming + self.shift * (2.0 * (1.0 - glass.index())))),
                _ => lobe.spread,
            },
            (Event::Refraction, Spread::Ideal(direction)) => Spread::Ideal(aside(direction)),
            // Where a prism sends light its functions alone say.
            (Event::PrismTransmission, spread) => spread,
            (_, Spread::Ideal(direction)) if direction.dot(self.flat) <= 0.0 => {
                Spread::Ideal((incoming - self.flat * (2.0 * incoming.dot(self.flat))).normalize())
            }
            (_, spread) => spread,
        };
        Lobe { spread, ..lobe }
    }
}
