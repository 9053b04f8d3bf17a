//! `instance` and `mesh`: files that are read once and placed.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::{Builder, Reporter};
use crate::geometry::shape::{Placed, Triangle};
use crate::geometry::{Aggregate, Item, Passage, Shape, SurfaceId};
use crate::material::MaterialId;
use crate::math::{Frame, Similarity};
use crate::rad::{self, Argument, Class, Document, Kind, Primitive, Transform};
use crate::scene::group::{Content, Group, Inner, Triangles};
use crate::scene::light::clip_ears;

/// Instances within instances, at most: a ray's way into them takes time in proportion to 2^depth.
const MOST_NESTED: usize = 8;

/// What files hold, by the name under which each was found; `None` is wrong (and has been told).
#[derive(Default)]
pub(super) struct Groups {
    known: HashMap<String, Option<Ready>>,
    /// The octrees that are being read, from the scene's own inwards.
    open: Vec<String>,
    /// Numbers of surfaces that groups have taken, from the last downwards.
    taken: u32,
}

/// A file's content, ready to be placed.
#[derive(Clone)]
pub(super) struct Ready {
    content: Arc<Content>,
    aggregate: Arc<Aggregate>,
    bounds: [DVec3; 2],
    count: u32,
}

impl Builder<'_> {
    /// Adds an instance or a mesh.
    pub(super) fn add_group(&mut self, index: usize, primitive: &Primitive, over: Option<MaterialId>) {
        let Some((file, words)) = primitive.strings.split_first() else {
            let message = format!("{} `{}` names no file", primitive.kind, primitive.name);
            self.reporter.error(primitive, Argument::Kind, message);
            return;
        };
        let transform = match Transform::take(words) {
            Ok((transform, taken)) if taken == words.len() => transform,
            Ok((_, taken)) => {
                let message = format!("`{}` is no transform option: expected -t, -rx, -s and the like", words[taken]);
                self.reporter.error(primitive, Argument::String(1 + taken), message);
                return;
            }
            Err(bad) => {
                self.reporter.error(primitive, Argument::String(1 + bad.word), bad.message);
                return;
            }
        };
        // The materials that an object names are the scene's; one of the mesh's own replaces them all.
        let named = primitive.kind == Kind::Mesh && file.ends_with(".obj");
        let ready =
            if named { self.object_ready(index, primitive, file, over.is_none()) } else { self.ready(primitive, file) };
        let Some(ready) = ready else { return };
        let room = u32::MAX - self.groups.taken;
        let own = u32::try_from(self.scene.surfaces.len()).unwrap_or(u32::MAX);
        if ready.count > room.saturating_sub(own) {
            self.reporter.error(primitive, Argument::Kind, "the scene has more than 2^32 surfaces");
            return;
        }
        self.groups.taken += ready.count;
        let first = u32::MAX - self.groups.taken;
        let to_scene = Similarity { affine: transform.affine, scale: transform.scale.abs() };
        self.scene.groups.push(Group {
            first,
            surface: SurfaceId(own),
            to_group: to_scene.inverse(),
            over,
            content: ready.content,
        });
        let shape = Shape::Placed(Placed::new(ready.aggregate, to_scene, first, ready.bounds));
        let surface = self.surface(primitive, None, shape);
        self.scene.surfaces.push(surface);
    }

    /// What a Wavefront object holds, with the scene's materials or without any.
    fn object_ready(&mut self, index: usize, primitive: &Primitive, file: &str, named: bool) -> Option<Ready> {
        let key = format!("{file}\n{named}");
        if let Some(known) = self.named.get(&key) {
            return known.clone();
        }
        let ready = match self.materials.shelf.find(file, &self.document.folders) {
            Ok(found) => match rad::read_obj(&rad::Source::from(found)) {
                Ok(obj) => self.object(index, primitive, &obj, named),
                Err(error) => self.told(vec![error]),
            },
            Err(why) => {
                self.reporter.error(primitive, Argument::String(0), format!("the file `{file}` {why}"));
                None
            }
        };
        self.named.insert(key, ready.clone());
        ready
    }

    /// What a file holds, read when it is first needed.
    fn ready(&mut self, primitive: &Primitive, file: &str) -> Option<Ready> {
        if let Some(known) = self.named.get(file) {
            return known.clone();
        }
        let ready = self.find_group(primitive, file);
        self.named.insert(file.to_owned(), ready.clone());
        ready
    }

    fn find_group(&mut self, primitive: &Primitive, file: &str) -> Option<Ready> {
        let found = match self.materials.shelf.find(file, &self.document.folders) {
            Ok(found) => found,
            Err(why) => {
                self.reporter.error(primitive, Argument::String(0), format!("the file `{file}` {why}"));
                return None;
            }
        };
        if let Some(known) = self.groups.known.get(&found.name) {
            return known.clone();
        }
        let open = &self.groups.open;
        let wrong = if open.contains(&found.name) {
            let way: Vec<&str> = open.iter().map(String::as_str).chain([found.name.as_str()]).collect();
            Some(format!("{}: an octree cannot hold an instance of itself", way.join(" -> ")))
        } else {
            (open.len() >= MOST_NESTED).then(|| format!("instances lie more than {MOST_NESTED} deep in each other"))
        };
        if let Some(message) = wrong {
            self.reporter.error(primitive, Argument::String(0), message);
            return None;
        }
        let name = found.name.clone();
        let ready = self.read_group(primitive, rad::Source::from(found));
        self.groups.known.insert(name, ready.clone());
        ready
    }

    fn read_group(&mut self, primitive: &Primitive, source: rad::Source) -> Option<Ready> {
        if primitive.kind == Kind::Mesh {
            return match rad::read_mesh(&source) {
                Ok(mesh) => self.mesh(&mesh),
                Err(error) => self.told(vec![error]),
            };
        }
        let (options, name) = (rad::Options::default(), source.name.clone());
        let document = if name.ends_with(".rad") {
            rad::read(&[source], self.materials.shelf.files(), &options)
        } else {
            rad::read_octree(&source, self.materials.shelf.files(), &options)
        };
        match document {
            Ok(document) => {
                self.groups.open.push(name);
                let ready = self.instance(&document);
                self.groups.open.pop();
                ready
            }
            Err(errors) => self.told(errors),
        }
    }

    fn told(&mut self, errors: Vec<rad::Error>) -> Option<Ready> {
        let room = rad::MAX_ERRORS.saturating_sub(self.reporter.errors.len());
        self.reporter.errors.extend(errors.into_iter().take(room));
        None
    }

    /// Builds another document's surfaces into this scene's materials. Lights in it do not shine, as in Radiance.
    fn instance(&mut self, document: &Document) -> Option<Ready> {
        let outside = std::mem::take(&mut self.scene.surfaces);
        let groups = std::mem::take(&mut self.scene.groups);
        let (lights, far) = (std::mem::take(&mut self.scene.lights), std::mem::take(&mut self.scene.far));
        let taken = std::mem::take(&mut self.groups.taken);
        let mut inner = Builder {
            document,
            reporter: Reporter::new(document),
            scene: std::mem::take(&mut self.scene),
            materials: self.materials.another(),
            groups: std::mem::take(&mut self.groups),
            named: HashMap::new(),
            placed_by: Vec::new(),
        };
        for (index, primitive) in document.primitives.iter().enumerate() {
            if primitive.kind.class() == Class::Surface && !inner.reporter.full() {
                inner.add_surface(index, primitive);
            }
        }
        let Builder { reporter, scene, groups: known, materials, .. } = inner;
        let Reporter { errors, warnings, .. } = reporter;
        (self.scene, self.groups) = (scene, known);
        self.scene.table_bytes += materials.shelf.bytes();
        let used = std::mem::replace(&mut self.groups.taken, taken);
        let mut surfaces = std::mem::replace(&mut self.scene.surfaces, outside);
        let mut groups = std::mem::replace(&mut self.scene.groups, groups);
        (self.scene.lights, self.scene.far) = (lights, far);
        let room = rad::MAX_ERRORS.saturating_sub(self.reporter.warnings.len());
        self.reporter.warnings.extend(warnings.into_iter().take(room));
        if !errors.is_empty() {
            return self.told(errors);
        }
        // Within an instance, the surfaces of groups follow its own.
        let own = u32::try_from(surfaces.len()).ok()?;
        let count = own.checked_add(used)?;
        let renumbered = |first: u32| own + (first - (u32::MAX - used));
        for surface in &mut surfaces {
            if let Shape::Placed(placed) = &mut surface.shape {
                *placed = placed.clone().numbered(renumbered(placed.first()));
            }
        }
        for group in &mut groups {
            group.first = renumbered(group.first);
        }
        let aggregate = Aggregate::new(self.scene.items(&surfaces, &groups));
        let bounds = bounds(surfaces.iter().map(|surface| surface.shape.bounds()));
        let is_opaque = self.scene.are_opaque(&surfaces, &groups);
        let content = Content::Scene(Inner { surfaces, groups, is_opaque });
        Some(Ready { content: Arc::new(content), aggregate: Arc::new(aggregate), bounds, count })
    }

    /// A Wavefront object: faces of more than three vertices are cut into triangles.
    fn object(&mut self, index: usize, primitive: &Primitive, obj: &rad::Obj, named: bool) -> Option<Ready> {
        let mut materials = vec![None; obj.materials.len()];
        for (material, name) in materials.iter_mut().zip(&obj.materials).filter(|_| named) {
            let Some(modifier) = self.document.modifier_named(name, index) else {
                let message = format!(
                    "the mesh `{}` is made of `{name}`: expected a material of that name before it, or one of its own in place \
                     of `void`",
                    primitive.name
                );
                self.reporter.error(primitive, Argument::String(0), message);
                return None;
            };
            *material = self.materials.of_modifier(modifier, index, &mut self.scene, &mut self.reporter);
        }
        let content = empty(&obj.vertices);
        let mut mesh = Meshed { content, items: Vec::new() };
        for face in &obj.faces {
            let material = face.material.and_then(|index| materials[index]);
            let corners: Vec<DVec3> =
                face.vertices.iter().map(|&vertex| mesh.content.positions[vertex as usize]).collect();
            for triangle in cut(&corners) {
                mesh.add(triangle.map(|corner| face.vertices[corner]), material)?;
            }
        }
        mesh.ready()
    }

    fn mesh(&mut self, mesh: &rad::Mesh) -> Option<Ready> {
        let mut reporter = Reporter::new(&mesh.materials);
        let mut materials = self.materials.another();
        let mut built =
            |index: usize, scene: &mut crate::scene::Scene| materials.of_modifier(index, index, scene, &mut reporter);
        let mut meshed = Meshed { content: empty(&mesh.vertices), items: Vec::new() };
        for triangle in &mesh.triangles {
            let material = triangle.material.and_then(|index| built(index, &mut self.scene));
            meshed.add(triangle.vertices, material)?;
        }
        self.scene.table_bytes += materials.shelf.bytes();
        let errors = reporter.errors;
        if !errors.is_empty() {
            return self.told(errors);
        }
        meshed.ready()
    }
}

/// A mesh of these vertices, without triangles yet.
fn empty(vertices: &[rad::MeshVertex]) -> Triangles {
    Triangles {
        positions: vertices.iter().map(|vertex| DVec3::from(vertex.position)).collect(),
        normals: vertices.iter().map(|vertex| vertex.normal.map(DVec3::from)).collect(),
        uvs: vertices.iter().map(|vertex| vertex.uv).collect(),
        triangles: Vec::new(),
        materials: Vec::new(),
    }
}

/// A mesh that is being put together.
struct Meshed {
    content: Triangles,
    items: Vec<Item>,
}

impl Meshed {
    /// Adds a triangle; `None` if there are too many.
    fn add(&mut self, vertices: [u32; 3], material: Option<MaterialId>) -> Option<()> {
        let corners = vertices.map(|vertex| self.content.positions[vertex as usize]);
        // Triangles without area are not there.
        let Ok(shape) = Triangle::new(corners) else { return Some(()) };
        let surface = SurfaceId(u32::try_from(self.items.len()).ok()?);
        let (shape, passage) = (Shape::Triangle(shape), Passage::Opaque);
        self.items.push(Item { shape, surface, passage, precedence: 0 });
        self.content.triangles.push(vertices);
        self.content.materials.push(material);
        Some(())
    }

    fn ready(self) -> Option<Ready> {
        let count = u32::try_from(self.items.len()).ok()?;
        let bounds = bounds(self.items.iter().map(|item| item.shape.bounds()));
        let aggregate = Arc::new(Aggregate::new(self.items));
        Some(Ready { content: Arc::new(Content::Mesh(self.content)), aggregate, bounds, count })
    }
}

/// The triangles of a face. One that crosses itself, or has very many corners, is a fan around its first corner.
fn cut(corners: &[DVec3]) -> Vec<[usize; 3]> {
    if corners.len() == 3 {
        return vec![[0, 1, 2]];
    }
    // Newell's normal, as long as twice the area.
    let next = corners.iter().cycle().skip(1);
    let normal: DVec3 = corners.iter().zip(next).map(|(a, b)| (*a - corners[0]).cross(*b - corners[0])).sum();
    let fan = || (2..corners.len()).map(|last| [0, last - 1, last]).collect();
    let Some(normal) = normal.try_normalize() else { return fan() };
    let frame = Frame::around(normal);
    let outline: Vec<_> = corners.iter().map(|&corner| frame.to_local(corner - corners[0]).truncate()).collect();
    clip_ears(&outline).unwrap_or_else(fan)
}

fn bounds(all: impl Iterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    let around = all.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)]);
    around.unwrap_or_default()
}
