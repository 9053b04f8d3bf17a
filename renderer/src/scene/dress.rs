//! What a surface wears: patterns and textures over its material, or a mixture of two materials.

use std::sync::Arc;

use super::Scene;
use crate::color::Rgb;
use crate::material::{DressId, Material, MaterialId};
use crate::pattern::{self, Field, Finish, Memory, Place, Step};

/// A chain of modifiers with at least one pattern, texture or mixture.
#[derive(Clone, Debug)]
pub(super) struct Dress {
    /// What comes before the material, and what comes after it.
    pub(super) steps: Arc<[Step]>,
    pub(super) base: Base,
}

/// What a chain ends in.
#[derive(Clone, Debug)]
pub(super) enum Base {
    Material(MaterialId),
    /// The material of the first for a part of the rays, of the second for the others; `None` is invisible.
    Mixture {
        part: Box<Field>,
        fore: Option<MaterialId>,
        back: Option<MaterialId>,
    },
}

/// Dresses within dresses, as mixtures of mixtures have them, at most.
pub(super) const MOST_LAYERS: usize = 8;

/// The dresses on the way to a material.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worn {
    ids: [Option<DressId>; MOST_LAYERS],
    count: usize,
}

impl Worn {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn put(&mut self, id: DressId) {
        // The scene's builder lets no more than these through.
        if let Some(slot) = self.ids.get_mut(self.count) {
            *slot = Some(id);
            self.count += 1;
        }
    }
}

impl Scene {
    /// Whether any surface wears patterns, textures or a mixture.
    #[must_use]
    pub fn has_dresses(&self) -> bool {
        !self.dresses.is_empty()
    }

    /// Takes one dress off: the material below it, of a mixture the one that `u` in [0,1) chooses; what is left of `u` is
    /// uniform again. `None` is invisible. The dress goes to `worn`.
    #[must_use]
    pub fn undress(
        &self,
        id: DressId,
        u: &mut f64,
        place: &Place<'_>,
        memory: &mut Memory,
        worn: &mut Worn,
    ) -> Option<&Material> {
        let dress = &self.dresses[id.index()];
        worn.put(id);
        let material = match &dress.base {
            Base::Material(material) => Some(*material),
            Base::Mixture { part, fore, back } => {
                let part = self.part(part, place, memory);
                if *u < part {
                    *u /= part;
                    *fore
                } else {
                    *u = ((*u - part) / (1.0 - part)).min(1.0_f64.next_down());
                    *back
                }
            }
        };
        material.map(|material| &self.materials[material.index()])
    }

    /// The part of a mixture that its first material has at a hit.
    fn part(&self, part: &Field, place: &Place<'_>, memory: &mut Memory) -> f64 {
        let Some(library) = &self.library else { return 0.0 };
        let mut evaluator = library.evaluator(std::mem::take(memory));
        let values = part.values(place, &mut evaluator);
        *memory = evaluator.into_memory();
        values.map_or(0.0, |[part, ..]| part.clamp(0.0, 1.0))
    }

    /// What the dresses do to a hit's colour and normal.
    #[must_use]
    pub fn finish(&self, worn: &Worn, place: &Place<'_>, memory: &mut Memory) -> Finish {
        let mut finish = Finish::default();
        if let Some(library) = self.library.as_ref().filter(|_| worn.count > 0) {
            let mut evaluator = library.evaluator(std::mem::take(memory));
            for id in worn.ids[..worn.count].iter().flatten() {
                pattern::apply(&self.dresses[id.index()].steps, place, &mut evaluator, &mut finish);
            }
            *memory = evaluator.into_memory();
        }
        finish
    }

    /// What a light's patterns leave of its radiance where and as `place` meets it.
    #[must_use]
    pub fn tint(&self, dress: DressId, place: &Place<'_>, memory: &mut Memory) -> Rgb {
        let mut worn = Worn::default();
        worn.put(dress);
        self.finish(&worn, place, memory).tint
    }

    /// The materials that a dressed one may show, with the part that each has at a hit.
    pub fn shown(&self, id: DressId, place: &Place<'_>, memory: &mut Memory) -> [(f64, Option<&Material>); 2] {
        let material = |id: Option<MaterialId>| id.map(|id| &self.materials[id.index()]);
        match &self.dresses[id.index()].base {
            Base::Material(base) => [(1.0, material(Some(*base))), (0.0, None)],
            Base::Mixture { part, fore, back } => {
                let part = self.part(part, place, memory);
                [(part, material(*fore)), (1.0 - part, material(*back))]
            }
        }
    }

    /// The materials that a dressed one may show anywhere; `None` is invisible.
    pub(super) fn bases(&self, id: DressId) -> [Option<MaterialId>; 2] {
        match &self.dresses[id.index()].base {
            Base::Material(base) => [Some(*base), Some(*base)],
            Base::Mixture { fore, back, .. } => [*fore, *back],
        }
    }

    /// The material under a dress; a mixture has none that is its own.
    pub(super) fn base(&self, id: DressId) -> Option<MaterialId> {
        match &self.dresses[id.index()].base {
            Base::Material(base) => Some(*base),
            Base::Mixture { .. } => None,
        }
    }

    /// The emitter under a dress; a mixture is none.
    #[must_use]
    pub fn emitter(&self, material: MaterialId) -> Option<(&crate::material::Emitter, Option<DressId>)> {
        match &self.materials[material.index()] {
            Material::Emitter(emitter) => Some((emitter, None)),
            Material::Dressed(id) => match &self.dresses[id.index()].base {
                // Patterns above and below an emitter are one dress.
                Base::Material(base) => match &self.materials[base.index()] {
                    Material::Emitter(emitter) => Some((emitter, Some(*id))),
                    _ => None,
                },
                Base::Mixture { .. } => None,
            },
            _ => None,
        }
    }
}
