//! A scene with its meaning: surfaces, materials, lights, and the view of it.

mod far;
mod from_rad;
mod light;
mod names;
mod surface;
mod view;

use glam::DVec3;

use crate::component::ComponentSet;
use crate::geometry::{Aggregate, Item, Passage, Shape, SurfaceId};
use crate::material::{Alternate, EmitterKind, Interaction, Material, MaterialId};
use crate::rad;

pub use far::{FarId, FarSource};
pub use light::{Leg, Light, LightSample};
pub use names::NameId;
use names::Names;
pub use surface::Surface;
pub use view::{View, ViewError};

/// Reflections over which mirrors relay lights unless told otherwise: rpict's `-dr`.
pub const DEFAULT_RELAYS: u32 = 1;

/// Something that emits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SourceId {
    /// A surface.
    Surface(SurfaceId),
    /// A distant source.
    Far(FarId),
}

/// A scene, built from text by [`Scene::from_rad`].
#[derive(Debug, Default)]
pub struct Scene {
    /// Every surface, in the order of definition.
    pub surfaces: Vec<Surface>,
    /// The materials that surfaces use.
    pub materials: Vec<Material>,
    /// What shines on surfaces: surfaces and distant sources first, then their images in mirrors.
    pub lights: Vec<Light>,
    /// `source` primitives, in the order of definition.
    pub far: Vec<FarSource>,
    /// What was left out or looks like a mistake, with its place in the text.
    pub warnings: Vec<rad::Error>,
    names: Names,
}

impl Scene {
    /// A surface.
    #[must_use]
    pub fn surface(&self, id: SurfaceId) -> &Surface {
        &self.surfaces[id.index()]
    }

    /// What a surface is made of; `None` if it is invisible.
    #[must_use]
    pub fn material(&self, id: SurfaceId) -> Option<&Material> {
        self.surface(id).material.map(|material| &self.materials[material.index()])
    }

    /// The identifier of a primitive, or the name of a modifier, as in the scene text.
    #[must_use]
    pub fn name(&self, id: NameId) -> &str {
        self.names.text(id)
    }

    /// The components that the scene's materials can spawn when rpict's `-st` is `threshold`.
    #[must_use]
    pub fn components(&self, threshold: f64) -> ComponentSet {
        self.materials.iter().fold(ComponentSet::EMPTY, |set, material| set.union(material.components(threshold)))
    }

    /// Builds the hierarchy of all visible surfaces.
    #[must_use]
    pub fn aggregate(&self) -> Aggregate {
        Aggregate::new(self.surfaces.iter().enumerate().filter_map(|(index, surface)| {
            Some(Item {
                shape: surface.shape.clone(),
                surface: SurfaceId(u32::try_from(index).ok()?),
                passage: self.passage(surface.material?),
                precedence: surface.precedence,
            })
        }))
    }

    /// The distant source that shows in the unit direction `dir` to a ray that meets no surface: the first `light` or
    /// `illum` there, or else the last glow, so that a sun shows before its sky whatever their order.
    #[must_use]
    pub fn escaped(&self, dir: DVec3) -> Option<FarId> {
        let mut seen = None;
        for (index, far) in self.far.iter().enumerate() {
            if far.contains(dir) {
                let id = u32::try_from(index).ok().map(FarId);
                match &self.materials[far.material.index()] {
                    Material::Emitter(emitter) if !matches!(emitter.kind(), EmitterKind::Glow { .. }) => return id,
                    _ => seen = id,
                }
            }
        }
        seen
    }

    /// Sets over how many reflections flat mirrors relay lights (`rpict(1)`, `-dr`); 0 is none.
    pub fn set_relays(&mut self, levels: u32) {
        self.lights.retain(|light| light.relay().is_empty());
        let mirrors: Vec<(SurfaceId, &Shape)> = self
            .surfaces
            .iter()
            .enumerate()
            .filter(|(_, surface)| {
                let material = surface.material.map(|material| &self.materials[material.index()]);
                matches!(material, Some(Material::Mirror(_))) && surface.shape.is_flat()
            })
            .filter_map(|(index, surface)| Some((SurfaceId(u32::try_from(index).ok()?), &surface.shape)))
            .collect();
        let images = light::relayed(&self.lights, &mirrors, self, levels);
        self.lights.extend(images);
    }

    /// What a material does to shadow rays.
    fn passage(&self, material: MaterialId) -> Passage {
        // Whether a pane lets anything through does not depend on the angle.
        let head_on = Interaction::new(-DVec3::Z, DVec3::Z);
        let mut material = material;
        loop {
            let passes = match &self.materials[material.index()] {
                Material::Plastic(_) | Material::Metal(_) | Material::Mirror(_) => false,
                Material::Trans(trans) => trans.shadow(&head_on).max_element() > 0.0,
                Material::Glass(glass) => glass.shadow(&head_on).max_element() > 0.0,
                Material::Dielectric(_) => return Passage::Refracting,
                Material::Emitter(emitter) => match emitter.kind() {
                    EmitterKind::Illum(Alternate::Material(alternate)) => {
                        material = alternate;
                        continue;
                    }
                    EmitterKind::Illum(Alternate::None | Alternate::Void) => true,
                    EmitterKind::Light | EmitterKind::Glow { .. } | EmitterKind::Spot(_) => false,
                },
            };
            return if passes { Passage::Straight } else { Passage::Opaque };
        }
    }
}
