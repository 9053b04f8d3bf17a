//! Instances and meshes: whose surfaces have numbers beyond those of the scene's own.

use std::sync::Arc;

use glam::DVec3;

use super::{Scene, Surface};
use crate::geometry::shape::Placed;
use crate::geometry::{Hit, Passage, SurfaceId};
use crate::material::MaterialId;
use crate::math::Similarity;

/// What is placed, once however often that is.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// The scene of an octree.
    Surfaces(Vec<Surface>),
    /// A triangle mesh.
    Mesh(Triangles),
}

/// A mesh.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    pub(super) positions: Vec<DVec3>,
    /// Unit normals of vertices, if the mesh has any.
    pub(super) normals: Vec<Option<DVec3>>,
    /// Coordinates of vertices, if the mesh has any.
    pub(super) uvs: Vec<Option<[f64; 2]>>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// By triangle.
    pub(super) materials: Vec<Option<MaterialId>>,
}

/// An instance or a mesh in the scene.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Number of its first surface.
    pub(super) first: u32,
    /// The surface that stands for it in the scene.
    pub(super) surface: SurfaceId,
    pub(super) to_group: Similarity,
    /// Its own material, which overrides all others.
    pub(super) over: Option<MaterialId>,
    pub(super) content: Arc<Content>,
}

/// What a hit on an instance or a mesh knows besides.
#[derive(Clone, Copy, Debug)]
pub struct Grouped<'a> {
    /// From the scene's coordinates to those in which its modifiers are defined, if not the scene's.
    pub object: Option<&'a Similarity>,
    /// What the vertices' normals add to the triangle's.
    pub bend: DVec3,
    /// Coordinates on the mesh.
    pub uv: Option<[f64; 2]>,
}

impl Scene {
    fn group(&self, id: SurfaceId) -> Option<(&Group, usize)> {
        let at = self.groups.partition_point(|group| group.first > id.0);
        let group = self.groups.get(at)?;
        Some((group, (id.0 - group.first) as usize))
    }

    pub(super) fn grouped_surface(&self, id: SurfaceId) -> &Surface {
        match self.group(id) {
            Some((group, index)) => match &*group.content {
                Content::Surfaces(surfaces) => &surfaces[index],
                Content::Mesh(_) => &self.surfaces[group.surface.index()],
            },
            // Numbers come from hits, and those from surfaces.
            None => &self.surfaces[id.index()],
        }
    }

    pub(super) fn grouped_material(&self, id: SurfaceId) -> Option<MaterialId> {
        let (group, index) = self.group(id)?;
        group.over.or_else(|| match &*group.content {
            Content::Surfaces(surfaces) => surfaces[index].material,
            Content::Mesh(mesh) => mesh.materials[index],
        })
    }

    /// What an instance or a mesh does to shadow rays.
    pub(super) fn group_passage(&self, placed: &Placed) -> Passage {
        let Some((group, _)) = self.group(SurfaceId(placed.first())) else { return Passage::Opaque };
        let opaque =
            |material: Option<MaterialId>| material.is_some_and(|material| self.passage(material) == Passage::Opaque);
        let all = match (&group.over, &*group.content) {
            (Some(over), _) => opaque(Some(*over)),
            (None, Content::Surfaces(surfaces)) => surfaces.iter().all(|surface| opaque(surface.material)),
            (None, Content::Mesh(mesh)) => {
                let mut seen: Vec<Option<MaterialId>> = mesh.materials.clone();
                seen.sort_unstable();
                seen.dedup();
                seen.into_iter().all(opaque)
            }
        };
        // What is not opaque throughout is followed hit by hit.
        if all { Passage::Opaque } else { Passage::Refracting }
    }

    /// What a hit on an instance or a mesh knows besides; `None` for the scene's own surfaces.
    #[must_use]
    pub fn grouped(&self, hit: &Hit) -> Option<Grouped<'_>> {
        if self.groups.is_empty() || hit.surface.index() < self.surfaces.len() {
            return None;
        }
        let (group, index) = self.group(hit.surface)?;
        let object = group.over.is_none().then_some(&group.to_group);
        let mut grouped = Grouped { object, bend: DVec3::ZERO, uv: None };
        if let Content::Mesh(mesh) = &*group.content {
            let corners = mesh.triangles[index].map(|vertex| vertex as usize);
            let weights = barycentric(corners.map(|corner| mesh.positions[corner]), group.to_group.point(hit.point));
            if let [Some(a), Some(b), Some(c)] = corners.map(|corner| mesh.normals[corner]) {
                let normal = a * weights[0] + b * weights[1] + c * weights[2];
                let turned = group.to_group.affine.matrix3.transpose() * normal;
                if let Some(normal) = turned.try_normalize() {
                    grouped.bend = normal - hit.normal;
                }
            }
            if let [Some(a), Some(b), Some(c)] = corners.map(|corner| mesh.uvs[corner]) {
                grouped.uv = Some([0, 1].map(|at| a[at] * weights[0] + b[at] * weights[1] + c[at] * weights[2]));
            }
        }
        Some(grouped)
    }
}

/// The weights of a triangle's corners at a point of it.
fn barycentric([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let (along, up, from_a) = (b - a, c - a, point - a);
    let normal = along.cross(up);
    let scale = normal.length_squared();
    if scale == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let second = from_a.cross(up).dot(normal) / scale;
    let third = along.cross(from_a).dot(normal) / scale;
    [1.0 - second - third, second, third]
}
