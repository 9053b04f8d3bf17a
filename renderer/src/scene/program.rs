//! Materials that functions of the scene make what they are at a hit.

use glam::DVec3;

use super::Scene;
use crate::color::Rgb;
use crate::component::{Component, ComponentSet};
use crate::material::{Anisotropic, Ashikhmin, Event, Functional, Interaction, Material, ProgramId};
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
}

impl Scene {
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
            Program::Free { .. } => of(&[Event::DiffuseReflection, Event::SmoothReflection, Event::SmoothTransmission]),
        }
    }

    /// Whether a program lets shadow rays through.
    pub(super) fn passes(&self, id: ProgramId) -> bool {
        matches!(self.programs[id.index()], Program::Free { .. })
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
