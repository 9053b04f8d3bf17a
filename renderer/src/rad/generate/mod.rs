//! Programs that write scene text, as functions: each makes the primitives that its namesake of Radiance prints, in
//! full precision.

mod arguments;
mod curves;
mod genblinds;
mod genbox;
mod genprism;
mod genrev;
mod gensky;
mod gensurf;
mod genworm;
mod height_data;
mod smooth;
mod sun;

use glam::DVec3;

use super::command::Word;
use super::document::Span;
use super::kind::Kind;
use super::statement::Draft;
use super::xform::BadWords;

/// The generators' names.
pub(super) const NAMES: [&str; 7] = ["genbox", "genprism", "genrev", "gensurf", "genworm", "gensky", "genblinds"];

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
        "genrev" => genrev::run(words, span, read),
        "gensurf" => gensurf::run(words, span, read),
        "genworm" => genworm::run(words, span, read),
        "gensky" => gensky::run(words, span),
        "genblinds" => genblinds::run(words, span),
        _ => Err(BadWords::at(None, "is no generator")),
    }
}

/// The name of the textures that bend normals.
const SMOOTHING: &str = "Phong";

/// Collects what a generator makes.
struct Output<'a> {
    modifier: &'a str,
    name: &'a str,
    span: Span,
    made: Vec<Draft>,
    /// Whether the next surface has the last texture as its modifier.
    textured: bool,
}

impl<'a> Output<'a> {
    fn new(modifier: &'a str, name: &'a str, span: Span) -> Self {
        Self { modifier, name, span, made: Vec::new(), textured: false }
    }

    /// Adds a primitive.
    fn named(&mut self, modifier: &str, kind: Kind, name: &str, strings: &[&str], reals: Vec<f64>) {
        self.made.push(Draft {
            modifier: modifier.to_owned(),
            kind,
            name: name.to_owned(),
            strings: strings.iter().map(|&text| text.to_owned()).collect(),
            reals,
            span: self.span,
            as_written: false,
        });
    }

    /// Adds a surface named `name.suffix`.
    fn surface(&mut self, kind: Kind, suffix: &str, reals: Vec<f64>) {
        let modifier = if self.textured { SMOOTHING } else { self.modifier };
        self.named(modifier, kind, &format!("{}.{suffix}", self.name), &[], reals);
    }

    /// Adds a texture: three functions and their file. The surfaces that follow have it.
    fn texture(&mut self, strings: [&str; 4], reals: Vec<f64>) {
        self.named(self.modifier, Kind::Texfunc, SMOOTHING, &strings, reals);
        self.textured = true;
    }

    /// The surfaces that follow have no texture.
    fn plain(&mut self) {
        self.textured = false;
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
