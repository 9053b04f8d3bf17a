//! genrev(1): a surface of revolution about z, from z(t) and the radius r(t), t from 0 to 1.

use super::super::command::Word;
use super::super::document::Span;
use super::super::kind::Kind;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::curves::Curves;

/// Differences of z or r below this are none (the program's own bound).
const TINY: f64 = 1e-9;

/// Function file of the interpolated normals.
const NORMALS: &str = "rev.cal";

/// A point of the outline.
#[derive(Clone, Copy)]
struct Point {
    z: f64,
    r: f64,
}

/// `genrev material name z(t) r(t) segments [-e definitions] [-f file] [-s]`
pub(super) fn run(
    words: &[Word],
    span: Span,
    read: &mut dyn FnMut(&Word) -> Result<String, BadWords>,
) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let (z, r) = (arguments.word("z(t)")?, arguments.word("r(t)")?);
    let segments = arguments.word("the number of segments")?;
    let (mut curves, mut smooth) = (Curves::new(), false);
    while let Some(option) = arguments.next() {
        if option.text == "-s" {
            smooth = true;
        } else if !curves.take_option(option, &mut arguments, read)? {
            return Err(arguments.unknown("-e definitions, -f file, -s"));
        }
    }
    let (z, r) = (curves.function(z, &["t"])?, curves.function(r, &["t"])?);
    let segments = curves.segments(segments)?;
    let mut evaluator = curves.evaluator();
    let mut outline = Vec::with_capacity(segments + 1);
    for step in 0..=segments {
        let t = [step as f64 / segments as f64];
        outline.push(Point { z: z.at(&mut evaluator, &t)?, r: r.at(&mut evaluator, &t)? });
    }
    // The normal of each segment in (z, r); none beyond the ends.
    let normals: Vec<Point> = outline.windows(2).map(|pair| normal(pair[0], pair[1])).collect();
    let none = Point { z: 0.0, r: 0.0 };
    let mut out = Output::new(&modifier.text, &name.text, span);
    for (index, pair) in outline.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        let (along, across) = (direction(to.z - from.z), direction(to.r - from.r));
        if along == 0 && across == 0 {
            continue;
        }
        if smooth {
            let before = index.checked_sub(1).map_or(none, |before| normals[before]);
            let after = normals.get(index + 1).copied().unwrap_or(none);
            // Perturbations that make the normals of neighbours meet, linear in z and in r.
            let line = |from: f64, to: f64, before: f64, after: f64| {
                let slope = (after - before) / (to - from);
                [slope, before - slope * from]
            };
            let [mz, bz] = match along {
                0 => [0.0, f64::from(-across)],
                _ => line(from.z, to.z, before.z, after.z),
            };
            let [mr, br] = match across {
                0 => [0.0, f64::from(along)],
                _ => line(from.r, to.r, before.r, after.r),
            };
            out.texture(["rev_dx", "rev_dy", "rev_dz", NORMALS], vec![mz, bz, mr, br]);
        }
        let suffix = (index + 1).to_string();
        // The front is to the outside where z grows, upwards where a ring narrows.
        let (kind, reals) = match (along, across) {
            (_, 0) => {
                let kind = if along < 0 { Kind::Tube } else { Kind::Cylinder };
                (kind, vec![0.0, 0.0, from.z, 0.0, 0.0, to.z, to.r])
            }
            (0, _) => (Kind::Ring, vec![0.0, 0.0, to.z, 0.0, 0.0, f64::from(-across), from.r, to.r]),
            _ => {
                let kind = if along < 0 { Kind::Cup } else { Kind::Cone };
                (kind, vec![0.0, 0.0, from.z, 0.0, 0.0, to.z, from.r, to.r])
            }
        };
        out.surface(kind, &suffix, reals);
    }
    out.finish()
}

/// -1, 0 or 1: which way a coordinate goes.
fn direction(difference: f64) -> i32 {
    i32::from(difference > TINY) - i32::from(difference < -TINY)
}

/// Unit, to the left of the way from one point to the next (outwards where z grows).
fn normal(from: Point, to: Point) -> Point {
    let (dz, dr) = (to.z - from.z, to.r - from.r);
    let length = dz.hypot(dr);
    if length > 0.0 { Point { z: -dr / length, r: dz / length } } else { Point { z: 0.0, r: 0.0 } }
}
