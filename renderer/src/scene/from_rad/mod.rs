//! Scene text gets its meaning: the only reader of [`rad::Document`].
//!
//! Only what surfaces use is built; a modifier that nothing uses may be of any type. What the renderer cannot draw is an error at
//! the primitive's place, never left out silently.

mod chain;
mod cut;
mod fields;
mod files;
mod groups;
mod materials;
mod programs;
mod shapes;
mod spectra;
mod wgmd;

use std::collections::HashMap;

use super::light::Light;
use super::{DEFAULT_RELAYS, FarId, FarSource, Scene, SourceId, Surface};
use crate::geometry::{Shape, SurfaceId};
use crate::material::{EmitterKind, MaterialId};
use crate::rad::{self, Argument, Class, Document, Files, Kind, MemoryFiles, Primitive};
use groups::{Groups, Ready};
use materials::Materials;

/// Errors and warnings with their places, as many of each as one reads.
struct Reporter<'a> {
    document: &'a Document,
    errors: Vec<rad::Error>,
    warnings: Vec<rad::Error>,
    unlisted_warnings: usize,
}

impl<'a> Reporter<'a> {
    fn new(document: &'a Document) -> Self {
        Self { document, errors: Vec::new(), warnings: Vec::new(), unlisted_warnings: 0 }
    }

    fn error(&mut self, primitive: &Primitive, argument: Argument, message: impl Into<String>) {
        if !self.full() {
            self.errors.push(self.document.argument_error(primitive, argument, message));
        }
    }

    fn warn(&mut self, primitive: &Primitive, argument: Argument, message: impl Into<String>) {
        if self.warnings.len() < rad::MAX_ERRORS {
            self.warnings.push(self.document.argument_error(primitive, argument, message));
        } else {
            self.unlisted_warnings += 1;
        }
    }

    /// Whether enough errors are known.
    fn full(&self) -> bool {
        self.errors.len() >= rad::MAX_ERRORS
    }
}

impl Scene {
    /// Gives a document its meaning. Mirrors relay lights over [`DEFAULT_RELAYS`] reflections; see [`Self::set_relays`].
    ///
    /// # Errors
    /// Every primitive that is not supported yet or has an argument out of range, with its place; at most
    /// [`rad::MAX_ERRORS`].
    pub fn from_rad(document: &Document) -> Result<Self, Vec<rad::Error>> {
        Self::from_rad_with(document, &MemoryFiles::new())
    }

    /// As [`Self::from_rad`]; `files` finds the function files, data, pictures, fonts and texts that primitives name.
    ///
    /// # Errors
    /// Files that are missing or wrong besides.
    pub fn from_rad_with(document: &Document, files: &dyn Files) -> Result<Self, Vec<rad::Error>> {
        let mut builder = Builder {
            document,
            reporter: Reporter::new(document),
            scene: Self::default(),
            materials: Materials::new(files),
            groups: Groups::default(),
            named: HashMap::new(),
            placed_by: Vec::new(),
        };
        for (index, primitive) in document.primitives.iter().enumerate() {
            if primitive.kind.class() == Class::Surface && !builder.reporter.full() {
                builder.add_surface(index, primitive);
            }
        }
        builder.cut();
        builder.name_scattered_lights();
        let Builder { reporter, mut scene, materials, .. } = builder;
        if !reporter.errors.is_empty() {
            return Err(reporter.errors);
        }
        scene.warnings = reporter.warnings;
        if reporter.unlisted_warnings > 0 {
            let message = format!("{} more warnings like these", reporter.unlisted_warnings);
            scene.warnings.push(rad::Error::of_file("scene", message));
        }
        scene.table_bytes += materials.shelf.bytes();
        scene.set_relays(DEFAULT_RELAYS);
        Ok(scene)
    }
}

struct Builder<'a> {
    document: &'a Document,
    reporter: Reporter<'a>,
    scene: Scene,
    materials: Materials<'a>,
    groups: Groups,
    /// What the files hold that the document names.
    named: HashMap<String, Option<Ready>>,
    /// The surfaces with their modifiers' places in the document.
    placed_by: Vec<(SurfaceId, usize)>,
}

impl Builder<'_> {
    fn add_surface(&mut self, index: usize, primitive: &Primitive) {
        let material = match primitive.modifier {
            Some(modifier) => self.materials.of_modifier(modifier, index, &mut self.scene, &mut self.reporter),
            None => None,
        };
        match primitive.kind {
            Kind::Source => self.add_far(primitive, material),
            Kind::Instance | Kind::Mesh => self.add_group(index, primitive, material),
            _ => {
                if let Some(shape) = shapes::read(primitive, &mut self.reporter) {
                    self.add_shape(primitive, material, shape);
                }
            }
        }
    }

    fn add_shape(&mut self, primitive: &Primitive, material: Option<MaterialId>, shape: Shape) {
        let Ok(id) = u32::try_from(self.scene.surfaces.len()) else {
            self.reporter.error(primitive, Argument::Kind, "the scene has more than 2^32 surfaces");
            return;
        };
        let id = SurfaceId(id);
        if let Some((emitter, dress)) = material.and_then(|id| self.scene.emitter(id))
            && emitter.illuminates()
        {
            let light = Light::of_surface(id, &shape, *emitter).dressed(dress);
            self.scene.lights.push(light);
        }
        let relays = material.is_some_and(|id| self.scene.mirror(id).is_some() || self.scene.prism(id).is_some());
        if relays && !shape.is_flat() {
            let message = format!(
                "mirror or prism `{}` is curved, so it shows what is behind it but relays no light; only polygons and rings do",
                primitive.name
            );
            self.reporter.warn(primitive, Argument::Kind, message);
        }
        let surface = self.surface(primitive, material, shape);
        self.scene.surfaces.push(surface);
        self.placed_by.extend(primitive.modifier.map(|modifier| (id, modifier)));
    }

    fn surface(&mut self, primitive: &Primitive, material: Option<MaterialId>, shape: Shape) -> Surface {
        Surface {
            shape,
            material,
            name: self.scene.names.id(&primitive.name),
            modifier: primitive.modifier.map(|index| self.scene.names.id(&self.document.primitives[index].name)),
            precedence: primitive.modifier.and_then(|index| u32::try_from(index + 1).ok()).unwrap_or(0),
        }
    }

    /// Warns of lights that mists name and that are not there.
    fn name_scattered_lights(&mut self) {
        for index in std::mem::take(&mut self.materials.mists) {
            let primitive = &self.document.primitives[index];
            for (at, path) in primitive.strings.iter().enumerate() {
                if !self.scene.is_light(path) {
                    let message =
                        format!("mist `{}` scatters no light of `{path}`: there is no such light", primitive.name);
                    self.reporter.warn(primitive, Argument::String(at), message);
                }
            }
        }
    }

    fn add_far(&mut self, primitive: &Primitive, material: Option<MaterialId>) {
        let Some((axis, angle_deg)) = shapes::read_source(primitive, &mut self.reporter) else { return };
        let Some(material) = material else { return };
        let Some((&emitter, dress)) = self.scene.emitter(material) else {
            let message = format!(
                "source `{}` does not show: its material does not emit; use light, glow or illum",
                primitive.name
            );
            self.reporter.warn(primitive, Argument::Modifier, message);
            return;
        };
        if matches!(emitter.kind(), EmitterKind::Spot(_)) {
            let message =
                format!("source `{}`: a spotlight that is infinitely far away has no focal length", primitive.name);
            self.reporter.warn(primitive, Argument::Modifier, message);
        }
        let Ok(id) = u32::try_from(self.scene.far.len()) else {
            self.reporter.error(primitive, Argument::Kind, "the scene has more than 2^32 sources");
            return;
        };
        let far = FarSource::new(material, self.scene.names.id(&primitive.name), axis, angle_deg);
        // A distant glow is sky: found by diffuse rays, not aimed at, whatever its radius.
        if emitter.illuminates() && !matches!(emitter.kind(), EmitterKind::Glow { .. }) {
            self.scene
                .lights
                .push(Light::distant(SourceId::Far(FarId(id)), axis, far.versine(), emitter).dressed(dress));
        }
        self.scene.far.push(far);
    }
}

#[cfg(test)]
mod tests;
