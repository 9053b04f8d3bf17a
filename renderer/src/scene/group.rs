//! Instances and meshes: whose surfaces have numbers beyond those of the scene's own.

use std::sync::Arc;

use glam::DVec3;

use super::{Scene, Surface};
use crate::geometry::shape::Placed;
use crate::geometry::{Hit, Passage, Shape, SurfaceId};
use crate::material::MaterialId;
use crate::math::Similarity;
use crate::pattern::Inside;

/// What is placed, once however often that is.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// The scene of an octree.
    Scene(Inner),
    /// A triangle mesh.
    Mesh(Triangles),
}

/// What an instance holds: surfaces, and instances and meshes, whose surfaces' numbers follow those.
#[derive(Clone, Debug)]
pub(super) struct Inner {
    pub(super) surfaces: Vec<Surface>,
    /// By falling number of their first surface.
    pub(super) groups: Vec<Group>,
    /// Whether all of it stops light.
    pub(super) is_opaque: bool,
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
    /// The way to the coordinates in which its modifiers are defined, if those are not the scene's.
    pub object: Option<Inside<'a>>,
    /// What the vertices' normals add to the triangle's.
    pub bend: DVec3,
    /// Coordinates on the mesh.
    pub uv: Option<[f64; 2]>,
}

/// Where a surface's number leads: through instances within instances to what holds the surface itself.
struct Place<'a> {
    group: &'a Group,
    /// The surfaces among which the group is placed.
    beside: &'a [Surface],
    /// Of the surface, in the group.
    index: usize,
    way: Inside<'a>,
    /// The material of the outermost instance that has one, and the way to the coordinates in which that is defined, if
    /// they are not the scene's.
    over: Option<(MaterialId, Option<Inside<'a>>)>,
}

/// The group that a number belongs to, and its place there.
fn find(groups: &[Group], number: usize) -> Option<(&Group, usize)> {
    let at = groups.partition_point(|group| group.first as usize > number);
    let group = groups.get(at)?;
    Some((group, number - group.first as usize))
}

impl Scene {
    fn group(&self, id: SurfaceId) -> Option<Place<'_>> {
        let (group, index) = find(&self.groups, id.index())?;
        let over = group.over.map(|over| (over, None));
        let way = Inside { around: None, own: &group.to_group };
        let mut place = Place { group, beside: &self.surfaces, index, way, over };
        while let Content::Scene(inner) = &*place.group.content
            && place.index >= inner.surfaces.len()
        {
            let (group, index) = find(&inner.groups, place.index)?;
            let over = place.over.or_else(|| group.over.map(|over| (over, Some(place.way))));
            let way = Inside { around: Some(place.way.whole()), own: &group.to_group };
            place = Place { group, beside: &inner.surfaces, index, way, over };
        }
        Some(place)
    }

    pub(super) fn grouped_surface(&self, id: SurfaceId) -> &Surface {
        match self.group(id) {
            Some(place) => match &*place.group.content {
                Content::Scene(inner) => &inner.surfaces[place.index],
                Content::Mesh(_) => &place.beside[place.group.surface.index()],
            },
            // Numbers come from hits, and those from surfaces.
            None => &self.surfaces[id.index()],
        }
    }

    pub(super) fn grouped_material(&self, id: SurfaceId) -> Option<MaterialId> {
        let place = self.group(id)?;
        place.over.map(|(over, _)| over).or_else(|| match &*place.group.content {
            Content::Scene(inner) => inner.surfaces[place.index].material,
            Content::Mesh(mesh) => mesh.materials[place.index],
        })
    }

    /// What an instance or a mesh among `groups` does to shadow rays.
    pub(super) fn group_passage(&self, placed: &Placed, groups: &[Group]) -> Passage {
        let Some((group, _)) = find(groups, placed.first() as usize) else { return Passage::Opaque };
        let all = match (&group.over, &*group.content) {
            (Some(over), _) => self.is_opaque(Some(*over)),
            (None, Content::Scene(inner)) => inner.is_opaque,
            (None, Content::Mesh(mesh)) => {
                let mut seen: Vec<Option<MaterialId>> = mesh.materials.clone();
                seen.sort_unstable();
                seen.dedup();
                seen.into_iter().all(|material| self.is_opaque(material))
            }
        };
        // What is not opaque throughout is followed hit by hit.
        if all { Passage::Opaque } else { Passage::Refracting }
    }

    /// Whether all that an instance is to hold stops light.
    pub(super) fn are_opaque(&self, surfaces: &[Surface], groups: &[Group]) -> bool {
        surfaces.iter().all(|surface| match &surface.shape {
            Shape::Placed(placed) => self.group_passage(placed, groups) == Passage::Opaque,
            _ => self.is_opaque(surface.material),
        })
    }

    fn is_opaque(&self, material: Option<MaterialId>) -> bool {
        material.is_some_and(|material| self.passage(material) == Passage::Opaque)
    }

    /// What a hit on an instance or a mesh knows besides; `None` for the scene's own surfaces.
    #[must_use]
    pub fn grouped(&self, hit: &Hit) -> Option<Grouped<'_>> {
        if self.groups.is_empty() || hit.surface.index() < self.surfaces.len() {
            return None;
        }
        let Place { group, index, way, over, .. } = self.group(hit.surface)?;
        let object = over.map_or(Some(way), |(_, way)| way);
        let mut grouped = Grouped { object, bend: DVec3::ZERO, uv: None };
        if let Content::Mesh(mesh) = &*group.content {
            let to_group = way.whole();
            let corners = mesh.triangles[index].map(|vertex| vertex as usize);
            let weights = barycentric(corners.map(|corner| mesh.positions[corner]), to_group.point(hit.point));
            if let [Some(a), Some(b), Some(c)] = corners.map(|corner| mesh.normals[corner]) {
                let normal = a * weights[0] + b * weights[1] + c * weights[2];
                let turned = to_group.affine.matrix3.transpose() * normal;
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
