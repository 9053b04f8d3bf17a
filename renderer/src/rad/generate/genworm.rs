//! genworm(1): a string of varying thickness along x(t), y(t), z(t), with radius r(t), t from 0 to 1: spheres joined by
//! cylinders or cones.

use glam::DVec3;

use super::super::command::Word;
use super::super::document::Span;
use super::super::kind::Kind;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::curves::Curves;

/// Differences of radius below this are none (the program's own bound).
const TINY: f64 = 1e-6;

/// `genworm material name x(t) y(t) z(t) r(t) segments [-e definitions] [-f file]`
pub(super) fn run(
    words: &[Word],
    span: Span,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let functions =
        [arguments.word("x(t)")?, arguments.word("y(t)")?, arguments.word("z(t)")?, arguments.word("r(t)")?];
    let segments = arguments.word("the number of segments")?;
    let mut curves = Curves::new();
    while let Some(option) = arguments.next() {
        if !curves.take_option(option, &mut arguments, read)? {
            return Err(arguments.unknown("-e definitions, -f file"));
        }
    }
    let mut compiled = Vec::with_capacity(functions.len());
    for function in functions {
        compiled.push(curves.function(function, &["t"])?);
    }
    let segments = curves.segments(segments)?;
    let mut evaluator = curves.evaluator();
    let mut out = Output::new(&modifier.text, &name.text, span);
    let mut last = None;
    for step in 0..=segments {
        let t = [step as f64 / segments as f64];
        let mut values = [0.0; 4];
        for (value, curve) in values.iter_mut().zip(&compiled) {
            *value = curve.at(&mut evaluator, &t)?;
        }
        let [x, y, z, radius] = values;
        let centre = DVec3::new(x, y, z);
        if let Some((from, from_radius)) = last {
            join(&mut out, &format!("c{step}"), (from, from_radius), (centre, radius));
        }
        out.sphere(&format!("s{step}"), centre, radius);
        last = Some((centre, radius));
    }
    out.finish()
}

/// The cone that touches two spheres, or a cylinder where they are alike.
fn join(out: &mut Output<'_>, suffix: &str, (from, r0): (DVec3, f64), (to, r1): (DVec3, f64)) {
    if (r0 - r1).abs() <= TINY {
        out.cylinder(suffix, from, to, r1);
        return;
    }
    let way = to - from;
    // A sphere is touched where the line along the cone meets its radius at a right angle: the sine of the cone's
    // half angle times the radius towards the thinner end.
    let shift = (r0 - r1) / way.length_squared();
    let cosine = (1.0 - (r0 - r1) * shift).max(0.0).sqrt();
    let (p0, p1) = (from + shift * r0 * way, to + shift * r1 * way);
    out.surface(Kind::Cone, suffix, vec![p0.x, p0.y, p0.z, p1.x, p1.y, p1.z, cosine * r0, cosine * r1]);
}
