//! genblinds(1): venetian blinds, their slats flat or curved.

use glam::DVec3;

use super::super::command::Word;
use super::super::document::Span;
use super::super::statement::Draft;
use super::super::xform::BadWords;
use super::Output;
use super::arguments::Arguments;
use super::curves::MAX_SURFACES;

/// A curved slat is made of flat strips of at most this angle, degrees.
const STRIP_DEG: f64 = 3.0;

/// `genblinds material name depth width height slats angle [-r|+r radius]`: `-r` bulges upwards, `+r` downwards.
pub(super) fn run(words: &[Word], span: Span) -> Result<Vec<Draft>, BadWords> {
    let mut arguments = Arguments::new(words);
    let modifier = arguments.word("the material")?;
    let name = arguments.word("the name")?;
    let (depth, width) = (arguments.real("the depth")?, arguments.real("the width")?);
    let height = arguments.real("the height")?;
    let slats = arguments.count("the number of slats", 0, MAX_SURFACES)?;
    let angle = arguments.real("the angle in degrees")?.to_radians();
    let mut curvature = 0.0;
    while let Some(option) = arguments.next() {
        let sign = match option.text.as_str() {
            "-r" => 1.0,
            "+r" => -1.0,
            _ => return Err(arguments.unknown("-r radius, +r radius")),
        };
        curvature = sign * arguments.real("the radius of curvature")?;
        if depth.abs() > 2.0 * f64::abs(curvature) {
            return Err(BadWords::at(arguments.last(), "a slat is deeper than the circle that it is to follow"));
        }
    }
    // The outline of one slat in the plane of depth and height, from the origin.
    let mut outline = vec![(0.0, 0.0)];
    if curvature == 0.0 {
        outline.push((depth * angle.cos(), depth * angle.sin()));
    } else {
        let opening = 2.0 * (depth / (2.0 * curvature.abs())).asin();
        let strips = ((opening / STRIP_DEG.to_radians() + 0.99999) as usize).max(1);
        if strips.saturating_mul(slats) > MAX_SURFACES {
            return Err(BadWords::at(None, format!("the slats need more than {MAX_SURFACES} strips")));
        }
        // Chords of a circle, whose mean direction is that of the flat slat.
        let step = opening / strips as f64;
        let chord = 2.0 * curvature.abs() * (step / 2.0).sin();
        let (mut x, mut z) = (0.0, 0.0);
        for strip in 0..strips {
            let turned = (strip as f64 + 0.5) * step - opening / 2.0;
            let slope: f64 = angle + turned * curvature.signum();
            x += chord * slope.cos();
            z += chord * slope.sin();
            outline.push((x, z));
        }
    }
    let mut out = Output::new(&modifier.text, &name.text, span);
    for slat in 1..=slats {
        let lift = height * (slat as f64 - 0.5) / slats as f64;
        for (strip, pair) in outline.windows(2).enumerate() {
            let [(x0, z0), (x1, z1)] = [pair[0], pair[1]];
            let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z + lift);
            let strip_name = format!("{slat}.{strip}");
            out.polygon(
                &strip_name,
                &[corner(x0, 0.0, z0), corner(x0, width, z0), corner(x1, width, z1), corner(x1, 0.0, z1)],
            );
        }
    }
    out.finish()
}
