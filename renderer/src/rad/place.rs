//! Puts a primitive elsewhere: what xform(1) does to the arguments of each type.

use glam::DVec3;

use super::kind::Kind;
use super::statement::Draft;
use super::transform::Transform;

/// One application of xform: where to, and what else changes.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    pub(super) transform: Transform,
    /// The transform's words: function files, instances and meshes get them appended.
    pub(super) words: Vec<String>,
    /// `-n`: put before the names of surfaces, with a dot.
    pub(super) prefix: Option<String>,
    /// `-m`: the surfaces' new modifier.
    pub(super) modifier: Option<String>,
    /// `-I`: turn surfaces inside out.
    pub(super) invert: bool,
}

impl Placement {
    /// Moves a primitive; false if a number left the range of numbers.
    pub(super) fn apply(&self, draft: &mut Draft) -> bool {
        let kind = draft.kind;
        if !kind.is_modifier() {
            if let Some(modifier) = &self.modifier {
                draft.modifier.clone_from(modifier);
            }
            if let Some(prefix) = &self.prefix {
                draft.name = format!("{prefix}.{}", draft.name);
            }
        }
        self.arguments(draft);
        if self.invert {
            draft.kind = inside_out(kind);
        }
        draft.as_written = false;
        draft.reals.iter().all(|value| value.is_finite())
    }

    fn arguments(&self, draft: &mut Draft) {
        let scale = self.transform.scale.abs();
        let reals = &mut draft.reals;
        match draft.kind {
            Kind::Polygon => {
                for vertex in reals.as_chunks_mut::<3>().0 {
                    self.point(vertex);
                }
                // A mirrored loop runs the other way around, so its front would become its back.
                if (self.transform.scale < 0.0) != self.invert {
                    reals.reverse();
                    reals.as_chunks_mut::<3>().0.iter_mut().for_each(|vertex| vertex.reverse());
                }
            }
            Kind::Sphere | Kind::Bubble => {
                self.point_at(reals, 0);
                scale_at(reals, 3, 4, scale);
            }
            Kind::Cone | Kind::Cup | Kind::Cylinder | Kind::Tube => {
                self.point_at(reals, 0);
                self.point_at(reals, 3);
                scale_at(reals, 6, 8, scale);
            }
            Kind::Ring => {
                self.point_at(reals, 0);
                self.vector_at(reals, 3);
                if self.invert {
                    scale_at(reals, 3, 6, -1.0);
                }
                scale_at(reals, 6, 8, scale);
            }
            Kind::Source => self.vector_at(reals, 0),
            Kind::Glow => scale_at(reals, 3, 4, scale),
            Kind::Spotlight => self.vector_at(reals, 4),
            // Optical depth over a length that has grown is kept: extinction is per length,
            Kind::Mist => {
                scale_at(reals, 0, 3, 1.0 / scale);
                if let Some(prefix) = &self.prefix {
                    for name in &mut draft.strings {
                        *name = prefixed_path(prefix, name);
                    }
                }
            }
            // and so is transmission.
            Kind::Dielectric => per_length(reals, 0, scale),
            Kind::Interface => {
                per_length(reals, 0, scale);
                per_length(reals, 4, scale);
            }
            Kind::Brighttext | Kind::Colortext | Kind::Mixtext => {
                self.point_at(reals, 0);
                self.vector_at(reals, 3);
                self.vector_at(reals, 6);
            }
            kind if kind.takes_transform() => {
                // `-i 1` ends the reach of an `-i` that the arguments hold already.
                if self.words.first().is_some_and(|first| first != "-i") {
                    draft.strings.extend(["-i".to_owned(), "1".to_owned()]);
                }
                draft.strings.extend(self.words.iter().cloned());
            }
            _ => {}
        }
    }

    fn point(&self, values: &mut [f64; 3]) {
        *values = self.transform.affine.transform_point3(DVec3::from(*values)).into();
    }

    fn point_at(&self, reals: &mut [f64], at: usize) {
        if let Some(values) = reals.get_mut(at..).and_then(|values| values.first_chunk_mut()) {
            self.point(values);
        }
    }

    fn vector_at(&self, reals: &mut [f64], at: usize) {
        if let Some(values) = reals.get_mut(at..).and_then(|values| values.first_chunk_mut::<3>()) {
            *values = self.transform.affine.transform_vector3(DVec3::from(*values)).into();
        }
    }
}

fn scale_at(reals: &mut [f64], from: usize, to: usize, factor: f64) {
    let to = to.min(reals.len());
    if let Some(values) = reals.get_mut(from..to) {
        values.iter_mut().for_each(|value| *value *= factor);
    }
}

/// Transmissions over a unit of length, `t`, when that unit has become `scale` long: `t^(1/scale)`.
fn per_length(reals: &mut [f64], at: usize, scale: f64) {
    if let Some(values) = reals.get_mut(at..at + 3) {
        values.iter_mut().for_each(|value| *value = value.powf(1.0 / scale));
    }
}

/// A mist names light sources as `a>b>c`, from the relaying surfaces to the light; all are surfaces.
fn prefixed_path(prefix: &str, path: &str) -> String {
    let names: Vec<String> = path.split('>').map(|name| format!("{prefix}.{name}")).collect();
    names.join(">")
}

fn inside_out(kind: Kind) -> Kind {
    match kind {
        Kind::Sphere => Kind::Bubble,
        Kind::Bubble => Kind::Sphere,
        Kind::Cone => Kind::Cup,
        Kind::Cup => Kind::Cone,
        Kind::Cylinder => Kind::Tube,
        Kind::Tube => Kind::Cylinder,
        other => other,
    }
}
