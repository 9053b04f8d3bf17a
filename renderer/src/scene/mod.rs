//! A scene with its meaning: surfaces, materials, lights, and the view of it.

mod antimatter;
mod dress;
mod far;
mod from_rad;
mod group;
mod holdings;
mod light;
mod mist;
mod names;
mod program;
mod surface;
mod view;
mod wgmd;

use std::collections::HashMap;

use glam::DVec3;

use crate::component::ComponentSet;
use crate::geometry::{Aggregate, Item, Passage, Shape, SurfaceId};
use crate::material::{Alternate, AntimatterId, EmitterKind, Interaction, Material, MaterialId, Mirror, ProgramId};
use crate::pattern::Library;
use crate::rad;

pub use dress::Worn;
pub use far::{FarId, FarSource};
pub use holdings::Holdings;
pub use light::{Leg, Light, LightSample};
pub use mist::{Haze, Mists};
pub use names::NameId;
use names::Names;
pub use program::reflection;
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
    /// Patterns, textures and mixtures that surfaces wear.
    dresses: Vec<dress::Dress>,
    /// What cuts solids away.
    antimatters: Vec<antimatter::Antimatter>,
    /// The antimatters that cut a surface away, for those that any does.
    cut_by: HashMap<SurfaceId, Vec<AntimatterId>>,
    /// Kinds of mist.
    mists: Vec<mist::Mist>,
    /// Instances and meshes, by falling number of their first surface.
    groups: Vec<group::Group>,
    /// Materials that functions decide.
    programs: Vec<program::Program>,
    /// The functions of those; absent where there are none.
    library: Option<Library>,
    /// Bytes of the data, pictures and fonts that its primitives name.
    table_bytes: usize,
}

impl Scene {
    /// A surface; of a mesh's triangle the mesh, of an instance's surface that one as its own file defines it.
    #[must_use]
    pub fn surface(&self, id: SurfaceId) -> &Surface {
        match self.surfaces.get(id.index()) {
            Some(surface) => surface,
            None => self.grouped_surface(id),
        }
    }

    /// What a surface is made of; `None` if it is invisible.
    #[must_use]
    pub fn material(&self, id: SurfaceId) -> Option<&Material> {
        let material = match self.surfaces.get(id.index()) {
            Some(surface) => surface.material,
            None => self.grouped_material(id),
        };
        material.map(|material| &self.materials[material.index()])
    }

    /// The identifier of a primitive, or the name of a modifier, as in the scene text.
    #[must_use]
    pub fn name(&self, id: NameId) -> &str {
        self.names.text(id)
    }

    /// The components that the scene's materials can spawn when rpict's `-st` is `threshold`.
    #[must_use]
    pub fn components(&self, threshold: f64) -> ComponentSet {
        self.materials.iter().fold(ComponentSet::EMPTY, |set, material| {
            set.union(match material {
                Material::Programmed(id) => self.program_components(*id, threshold),
                material => material.components(threshold),
            })
        })
    }

    /// Builds the hierarchy of all visible surfaces.
    #[must_use]
    pub fn aggregate(&self) -> Aggregate {
        let visible = self.items(&self.surfaces, &self.groups);
        Aggregate::new(visible.filter(|item| self.is_visible(&self.surfaces[item.surface.index()])))
    }

    fn is_visible(&self, surface: &Surface) -> bool {
        surface.material.is_some() || matches!(surface.shape, Shape::Placed(_))
    }

    /// Some surfaces, among which there are `groups`; those without a material let light through.
    fn items<'a>(&'a self, surfaces: &'a [Surface], groups: &'a [group::Group]) -> impl Iterator<Item = Item> + 'a {
        surfaces.iter().enumerate().filter_map(|(index, surface)| {
            let passage = match &surface.shape {
                Shape::Placed(placed) => self.group_passage(placed, groups),
                _ => surface.material.map_or(Passage::Straight, |material| self.passage(material)),
            };
            let id = SurfaceId(u32::try_from(index).ok()?);
            // Whether a surface that antimatter cuts away is there depends on the place.
            let cut = passage == Passage::Opaque && self.cut_by.contains_key(&id);
            Some(Item {
                shape: surface.shape.clone(),
                surface: id,
                passage: if cut { Passage::Straight } else { passage },
                precedence: surface.precedence,
            })
        })
    }

    /// The distant source that shows in the unit direction `dir` to a ray that meets no surface: the first `light` or
    /// `illum` there, or else the last glow, so that a sun shows before its sky whatever their order.
    #[must_use]
    pub fn escaped(&self, dir: DVec3) -> Option<FarId> {
        let mut seen = None;
        for (index, far) in self.far.iter().enumerate() {
            if far.contains(dir) {
                let id = u32::try_from(index).ok().map(FarId);
                match self.emitter(far.material) {
                    Some((emitter, _)) if !matches!(emitter.kind(), EmitterKind::Glow { .. }) => return id,
                    _ => seen = id,
                }
            }
        }
        seen
    }

    /// Sets over how many reflections and redirections flat mirrors and prisms relay lights (`rpict(1)`, `-dr`); 0 is none.
    pub fn set_relays(&mut self, levels: u32) {
        self.lights.retain(|light| light.relay().is_empty());
        let sheets: Vec<(SurfaceId, light::Sheet)> = self
            .surfaces
            .iter()
            .enumerate()
            .filter(|(_, surface)| surface.shape.is_flat())
            .filter_map(|(index, surface)| {
                let material = surface.material?;
                let sheet = match self.prism(material) {
                    Some(prism) => light::Sheet::Prism(prism),
                    None => self.mirror(material).map(|_| light::Sheet::Mirror)?,
                };
                Some((SurfaceId(u32::try_from(index).ok()?), sheet))
            })
            .collect();
        let images = light::relayed(&self.lights, &sheets, self, levels);
        self.lights.extend(images);
        self.find_scattered_lights();
    }

    /// The mirror that relays lights in a material; one in a mixture does not, as in Radiance.
    #[must_use]
    pub fn mirror(&self, material: MaterialId) -> Option<&Mirror> {
        match &self.materials[material.index()] {
            Material::Mirror(mirror) => Some(mirror),
            Material::Dressed(id) => self.base(*id).and_then(|base| self.mirror(base)),
            _ => None,
        }
    }

    /// The prism that relays lights in a material.
    fn prism(&self, material: MaterialId) -> Option<ProgramId> {
        match &self.materials[material.index()] {
            Material::Programmed(id) => (self.ways(*id) > 0).then_some(*id),
            Material::Dressed(id) => self.base(*id).and_then(|base| self.prism(base)),
            _ => None,
        }
    }

    /// Whether Radiance counts a material as transparent: some light goes through it.
    #[must_use]
    pub fn is_transparent(&self, material: MaterialId) -> bool {
        match &self.materials[material.index()] {
            Material::Dressed(id) => {
                self.bases(*id).into_iter().any(|base| base.is_none_or(|base| self.is_transparent(base)))
            }
            material => material.is_transparent(),
        }
    }

    /// What a material does to shadow rays.
    fn passage(&self, material: MaterialId) -> Passage {
        // Whether a pane lets anything through does not depend on the angle.
        let head_on = Interaction::new(-DVec3::Z, DVec3::Z);
        let mut material = material;
        loop {
            let passes = match &self.materials[material.index()] {
                Material::Plastic(_)
                | Material::Metal(_)
                | Material::Mirror(_)
                | Material::Anisotropic(_)
                | Material::Ashikhmin(_)
                | Material::Functional(..)
                // Lights shine through a prism by their images alone.
                | Material::Prism(_)
                | Material::Wgmd(_) => false,
                Material::Programmed(id) => self.passes(*id),
                Material::Antimatter(_) | Material::Mist(_) => true,
                Material::Trans(trans) => trans.shadow(&head_on).max_element() > 0.0,
                Material::Glass(glass) => glass.shadow(&head_on).max_element() > 0.0,
                Material::Dielectric(_) => return Passage::Refracting,
                Material::Dressed(id) => {
                    let passages =
                        self.bases(*id).map(|base| base.map_or(Passage::Straight, |base| self.passage(base)));
                    let any = |passage| passages.contains(&passage);
                    return if any(Passage::Refracting) {
                        Passage::Refracting
                    } else if any(Passage::Straight) {
                        Passage::Straight
                    } else {
                        Passage::Opaque
                    };
                }
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
