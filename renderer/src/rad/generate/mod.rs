//! Programs that write scene text, as functions: each makes the primitives that its namesake of Radiance prints, in
//! full precision.

mod arguments;
mod genbox;
mod genprism;

use glam::DVec3;

use super::command::Word;
use super::document::Span;
use super::kind::Kind;
use super::statement::Draft;
use super::xform::BadWords;

/// The generators' names.
pub(super) const NAMES: [&str; 2] = ["genbox", "genprism"];

/// Runs the generator `program`; `span` is the command, `read` gives the text of a file that the words name.
pub(super) fn run(
    program: &str,
    words: &[Word],
    span: Span,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Draft>, BadWords> {
    match program {
        "genbox" => genbox::run(words, span),
        "genprism" => genprism::run(words, span, read),
        _ => Err(BadWords::at(None, "is no generator")),
    }
}

/// Collects what a generator makes.
struct Output<'a> {
    modifier: &'a str,
    name: &'a str,
    span: Span,
    made: Vec<Draft>,
}

impl<'a> Output<'a> {
    fn new(modifier: &'a str, name: &'a str, span: Span) -> Self {
        Self { modifier, name, span, made: Vec::new() }
    }

    /// Adds a surface named `name.suffix`.
    fn surface(&mut self, kind: Kind, suffix: &str, reals: Vec<f64>) {
        self.made.push(Draft {
            modifier: self.modifier.to_owned(),
            kind,
            name: format!("{}.{suffix}", self.name),
            strings: Vec::new(),
            reals,
            span: self.span,
            as_written: false,
        });
    }

    fn polygon(&mut self, suffix: &str, vertices: &[DVec3]) {
        let reals = vertices.iter().flat_map(DVec3::to_array).collect();
        self.surface(Kind::Polygon, suffix, reals);
    }

    fn sphere(&mut self, suffix: &str, centre: DVec3, radius: f64) {
        self.surface(Kind::Sphere, suffix, vec![centre.x, centre.y, centre.z, radius]);
    }

    fn cylinder(&mut self, suffix: &str, from: DVec3, to: DVec3, radius: f64) {
        self.surface(Kind::Cylinder, suffix, vec![from.x, from.y, from.z, to.x, to.y, to.z, radius]);
    }

    /// What was made, if all of it is finite (sums of large arguments may not be).
    fn finish(self) -> Result<Vec<Draft>, BadWords> {
        if self.made.iter().all(|draft| draft.reals.iter().all(|value| value.is_finite())) {
            Ok(self.made)
        } else {
            Err(BadWords::at(None, "the sizes leave the range of numbers"))
        }
    }
}
