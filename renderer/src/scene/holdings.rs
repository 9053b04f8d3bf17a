//! What a scene holds, in numbers: to see that what its text does not use is not there.

use std::collections::HashSet;
use std::sync::Arc;

use serde::Serialize;

use super::Scene;
use super::group::{Content, Group};

/// Things that a scene holds once it is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Holdings {
    /// Surfaces of its own; an instance or a mesh is one.
    pub surfaces: usize,
    /// Materials that surfaces use, those under patterns counted beside what wears them.
    pub materials: usize,
    /// Lights, and their images in mirrors.
    pub lights: usize,
    /// Chains of patterns, textures and mixtures.
    pub dresses: usize,
    /// Materials that functions decide.
    pub programs: usize,
    /// Texts of functions: the library that Radiance takes for granted, and files.
    pub function_texts: usize,
    /// Bytes of data, pictures and fonts.
    pub table_bytes: usize,
    /// Antimatters.
    pub antimatters: usize,
    /// Instances and meshes, as often as they are placed in the scene itself.
    pub instances: usize,
    /// Surfaces and triangles in those, each file's once.
    pub instanced: usize,
}

impl Scene {
    /// What the scene holds.
    #[must_use]
    pub fn holdings(&self) -> Holdings {
        let mut seen = HashSet::new();
        Holdings {
            surfaces: self.surfaces.len(),
            materials: self.materials.len(),
            lights: self.lights.len(),
            dresses: self.dresses.len(),
            programs: self.programs.len(),
            function_texts: self.library.as_ref().map_or(0, crate::pattern::Library::texts),
            table_bytes: self.table_bytes,
            antimatters: self.antimatters.len(),
            instances: self.groups.len(),
            instanced: instanced(&self.groups, &mut seen),
        }
    }
}

fn instanced(groups: &[Group], seen: &mut HashSet<*const Content>) -> usize {
    let mut count = 0;
    for group in groups {
        if seen.insert(Arc::as_ptr(&group.content)) {
            count += match &*group.content {
                Content::Scene(inner) => inner.surfaces.len() + instanced(&inner.groups, seen),
                Content::Mesh(mesh) => mesh.triangles.len(),
            };
        }
    }
    count
}
