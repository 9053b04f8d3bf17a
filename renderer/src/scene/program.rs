//! Materials that functions of the scene make what they are at a hit.

use glam::DVec3;

use super::{Scene, wgmd};
use crate::color::Rgb;
use crate::component::{Component, ComponentSet};
use crate::material::{Anisotropic, Ashikhmin, Event, Functional, Interaction, Material, Prism, ProgramId};
use crate::pattern::{Evaluator, Field, Law, Memory, Place, Reflection};

/// A material before its functions have been asked.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "a scene has few of them")]
pub(super) enum Program {
    /// With the axis of its gloss.
    Anisotropic(Anisotropic, Field),
    /// With the axis of its gloss.
    Ashikhmin(Ashikhmin, Field),
    /// `plasfunc` and kin: colour, and the parts in which light is reflected and passed.
    Parts { color: Rgb, specular: f64, transmitted: f64, transmitted_specular: f64, metallic: bool, law: Law },
    /// `BRTDfunc`: diffuse parts in front, behind and through; what is mirrored and passed.
    Free { diffuse: [Rgb; 3], mirrored: Field, passed: Field, law: Option<Law> },
    /// `WGMDfunc`.
    Wgmd(Box<wgmd::Parts>),
    /// `prism1`, `prism2`: the ways that light takes.
    Prism(Vec<Way>),
}

/// A way that a prism sends light.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// The fraction of radiance that takes it.
    pub(super) coefficient: Field,
    /// Where to, of any length.
    pub(super) direction: Field,
}

/// Where a prism's coefficient saturates; Radiance clamps none either.
const MOST_COEFFICIENT: f64 = 1e30;

impl Way {
    /// The unit direction and the fraction for a ray that meets the prism at `place`; `None` where functions fail or
    /// nothing passes. `to_light`: unit direction to the light that is asked for, 0 if none is.
    fn at(&self, place: &Place<'_>, to_light: DVec3, evaluator: &mut Evaluator<'_>) -> Option<(DVec3, f64)> {
        let mut reflection = reflection(place, DVec3::ZERO, Rgb::ONE);
        reflection.to_light = Some(to_light);
        let [coefficient, ..] = self.coefficient.reflected(place, Some(&reflection), evaluator)?;
        if coefficient <= 0.0 {
            return None;
        }
        let direction = self.direction.reflected(place, Some(&reflection), evaluator)?;
        let direction = place.turned_back(&self.direction.to_local, DVec3::from(direction));
        // Of any length, even one whose square overflows.
        let direction = (direction / direction.abs().max_element()).try_normalize()?;
        Some((direction, coefficient.min(MOST_COEFFICIENT)))
    }
}

impl Scene {
    /// Where way `way` of a prism leads a ray that meets it at `place`, a unit vector, and the fraction of radiance that
    /// comes from there; `None` if none does. `to_light` is the unit direction to the light that is asked for.
    pub(super) fn redirected(
        &self,
        (id, way): (ProgramId, usize),
        place: &Place<'_>,
        to_light: DVec3,
        memory: &mut Memory,
    ) -> Option<(DVec3, f64)> {
        let Program::Prism(ways) = &self.programs[id.index()] else { return None };
        let mut evaluator = self.library.as_ref()?.evaluator(std::mem::take(memory));
        let redirected = ways.get(way).and_then(|way| way.at(place, to_light, &mut evaluator));
        *memory = evaluator.into_memory();
        redirected
    }

    /// The ways of a prism, by their number; 0 if the program is none.
    pub(super) fn ways(&self, id: ProgramId) -> usize {
        if let Program::Prism(ways) = &self.programs[id.index()] { ways.len() } else { 0 }
    }

    /// The material that a program is at a hit, under a pattern of colour `tint`.
    #[must_use]
    pub fn programmed(
        &self,
        id: ProgramId,
        place: &Place<'_>,
        tint: Rgb,
        bend: DVec3,
        memory: &mut Memory,
    ) -> Option<Material> {
        let mut evaluator = self.library.as_ref()?.evaluator(std::mem::take(memory));
        let material = self.run(id, place, tint, bend, &mut evaluator);
        *memory = evaluator.into_memory();
        material
    }

    fn run(
        &self,
        id: ProgramId,
        place: &Place<'_>,
        tint: Rgb,
        bend: DVec3,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Material> {
        let axis = |field: &Field, evaluator: &mut Evaluator<'_>| {
            let local = field.values(place, evaluator).map_or(DVec3::ZERO, DVec3::from);
            place.turned_back(&field.to_local, local)
        };
        Some(match &self.programs[id.index()] {
            Program::Anisotropic(material, field) => Material::Anisotropic(material.at(tint, axis(field, evaluator))),
            Program::Ashikhmin(material, field) => Material::Ashikhmin(material.at(tint, axis(field, evaluator))),
            Program::Parts { color, specular, transmitted, transmitted_specular, metallic, .. } => {
                let color = *color * tint;
                let passed = transmitted * (1.0 - specular);
                let passed_specular = passed * transmitted_specular;
                let lobe = if *metallic { color } else { Rgb::ONE };
                Material::Functional(
                    Functional {
                        color,
                        diffuse: color * (1.0 - passed - specular),
                        diffuse_through: color * (passed - passed_specular),
                        lobe: lobe * *specular,
                        lobe_through: color * passed_specular,
                        ambient: color * (1.0 - passed),
                        ambient_through: color * passed,
                        mirrored: Rgb::ZERO,
                        passed: Rgb::ZERO,
                    },
                    id,
                )
            }
            Program::Free { diffuse: [front, behind, through], mirrored, passed, law } => {
                let reflection = reflection(place, bend, tint);
                let mut color = |field: &Field| {
                    let values = field.reflected(place, Some(&reflection), evaluator);
                    values.map_or(Rgb::ZERO, |values| Rgb::from(values).max(Rgb::ZERO))
                };
                let (mirrored, passed) = (color(mirrored), color(passed));
                let side = if place.dir.dot(place.normal) < 0.0 { *front } else { *behind };
                let lobe = if law.is_some() { Rgb::ONE } else { Rgb::ZERO };
                Material::Functional(
                    Functional {
                        color: tint,
                        diffuse: side * tint,
                        diffuse_through: *through * tint,
                        lobe,
                        lobe_through: lobe,
                        ambient: side * tint,
                        ambient_through: *through * tint,
                        mirrored,
                        passed,
                    },
                    id,
                )
            }
            Program::Wgmd(parts) => Material::Wgmd(parts.at(place, (tint, bend), evaluator)?),
            Program::Prism(ways) => {
                let mut prism = Prism::default();
                for (slot, way) in prism.ways.iter_mut().zip(ways) {
                    *slot = way.at(place, DVec3::ZERO, evaluator).unwrap_or_default();
                }
                Material::Prism(prism)
            }
        })
    }

    /// What evaluates functions, with the memory of an earlier one; `None` if the scene has none.
    #[must_use]
    pub fn evaluator(&self, memory: Memory) -> Option<Evaluator<'_>> {
        self.library.as_ref().map(|library| library.evaluator(memory))
    }

    /// The value of a material's own function for a light, 1/sr per channel.
    #[must_use]
    pub fn law(
        &self,
        id: ProgramId,
        light: (DVec3, f64),
        place: &Place<'_>,
        reflection: &Reflection,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Rgb> {
        match &self.programs[id.index()] {
            Program::Parts { law, .. } | Program::Free { law: Some(law), .. } => {
                law.value(light, place, reflection, evaluator)
            }
            _ => None,
        }
    }

    /// The components that a program can spawn.
    pub(super) fn program_components(&self, id: ProgramId, threshold: f64) -> ComponentSet {
        let of = |events: &[Event]| events.iter().map(|&event| Component::of(event)).collect();
        match &self.programs[id.index()] {
            Program::Anisotropic(material, _) => Material::Anisotropic(*material).components(threshold),
            Program::Ashikhmin(material, _) => Material::Ashikhmin(*material).components(threshold),
            Program::Parts { .. } => of(&[Event::DiffuseReflection]),
            Program::Wgmd(parts) => of(&parts.events()),
            Program::Prism(_) => of(&[Event::PrismTransmission]),
            Program::Free { .. } => of(&[Event::DiffuseReflection, Event::SmoothReflection, Event::SmoothTransmission]),
        }
    }

    /// Whether a program lets shadow rays through.
    pub(super) fn passes(&self, id: ProgramId) -> bool {
        match &self.programs[id.index()] {
            Program::Free { .. } => true,
            Program::Wgmd(parts) => parts.passed.is_some(),
            _ => false,
        }
    }
}

/// What functions of reflection can ask of a hit.
#[must_use]
pub fn reflection(place: &Place<'_>, bend: DVec3, color: Rgb) -> Reflection {
    let interaction = if bend == DVec3::ZERO {
        Interaction::new(place.dir, place.normal)
    } else {
        Interaction::bent(place.dir, place.normal, bend)
    };
    Reflection { normal: interaction.normal, cosine: interaction.cosine, color, to_light: None }
}
