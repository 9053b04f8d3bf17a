//! `instance` and `mesh`: files that are read once and placed.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::{Builder, Reporter};
use crate::geometry::shape::{Placed, Triangle};
use crate::geometry::{Aggregate, Item, Passage, Shape, SurfaceId};
use crate::material::MaterialId;
use crate::math::Similarity;
use crate::rad::{self, Argument, Class, Document, Kind, Primitive, Transform};
use crate::scene::group::{Content, Group, Inner, Triangles};

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
    pub(super) fn add_group(&mut self, primitive: &Primitive, over: Option<MaterialId>) {
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
        let Some(ready) = self.ready(primitive, file) else { return };
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

    fn mesh(&mut self, mesh: &rad::Mesh) -> Option<Ready> {
        let mut reporter = Reporter::new(&mesh.materials);
        let mut materials = self.materials.another();
        let mut built =
            |index: usize, scene: &mut crate::scene::Scene| materials.of_modifier(index, index, scene, &mut reporter);
        let positions: Vec<DVec3> = mesh.vertices.iter().map(|vertex| DVec3::from(vertex.position)).collect();
        let mut content = Triangles {
            normals: mesh.vertices.iter().map(|vertex| vertex.normal.map(DVec3::from)).collect(),
            uvs: mesh.vertices.iter().map(|vertex| vertex.uv).collect(),
            positions,
            triangles: Vec::new(),
            materials: Vec::new(),
        };
        let mut items = Vec::new();
        for triangle in &mesh.triangles {
            let corners = triangle.vertices.map(|vertex| content.positions[vertex as usize]);
            // Triangles without area are not there.
            let Ok(shape) = Triangle::new(corners) else { continue };
            let surface = SurfaceId(u32::try_from(items.len()).ok()?);
            let (shape, passage) = (Shape::Triangle(shape), Passage::Opaque);
            items.push(Item { shape, surface, passage, precedence: 0 });
            content.triangles.push(triangle.vertices);
            content.materials.push(triangle.material.and_then(|index| built(index, &mut self.scene)));
        }
        self.scene.table_bytes += materials.shelf.bytes();
        let errors = reporter.errors;
        if !errors.is_empty() {
            return self.told(errors);
        }
        let count = u32::try_from(items.len()).ok()?;
        let bounds = bounds(items.iter().map(|item| item.shape.bounds()));
        let aggregate = Arc::new(Aggregate::new(items));
        Some(Ready { content: Arc::new(Content::Mesh(content)), aggregate, bounds, count })
    }
}

fn bounds(all: impl Iterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    let around = all.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)]);
    around.unwrap_or_default()
}
