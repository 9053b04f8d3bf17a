//! Lights, dim and bright, small and large, none and very many.

use std::f64::consts::PI;

use crate::look::{EVERYTHING, Look, PAINT, first_bad, square};
use crate::table::{Case, Row, group};

/// The floor of reflectance 1/2 at the foot of a ball 1 above it.
fn floor(material: &str, radius: f64) -> f64 {
    let lamp = format!("{material}\nbulb sphere ball 0 0 4 0 0 1 {radius:e}\n");
    under(&lamp).red()
}

/// The floor under some lamp.
fn under(lamp: &str) -> Look {
    let text = [PAINT, &square("paint", "floor", [0.0; 3], 10.0), lamp].concat();
    Look::new(text, [0.0, -0.5, 0.5], [0.0, 1.0, -1.0])
}

/// A lamp of radius 1e-3 whose radiance is `radiance`: L rho (r/h)^2.
fn shines(radiance: f64) -> Row {
    let material = format!("void light bulb 0 0 3 {radiance:e} {radiance:e} {radiance:e}");
    Row::near(0.5e-6 * radiance, floor(&material, 1e-3), 2e-6)
}

/// A lamp of some radius whose radiance makes up for it.
fn small(radius: f64) -> Row {
    let radiance = 1.0 / (radius * radius);
    let material = format!("void light bulb 0 0 3 {radiance:e} {radiance:e} {radiance:e}");
    Row::near(0.5, floor(&material, radius), 2e-6)
}

/// A distant source of radiance 1/sin^2: its irradiance is pi L sin^2 of the half angle.
fn sun(degrees: f64, samples: u32, bound: f64) -> Row {
    let radiance = (degrees.to_radians() / 2.0).sin().powi(-2);
    let lamp = format!(
        "void light bulb 0 0 3 {radiance:e} {radiance:e} {radiance:e}\nbulb source sun 0 0 4 0 0 1 {degrees:e}\n"
    );
    Row::near(0.5, under(&lamp).samples(samples).red(), bound)
}

/// 10^6 lamps in a square lattice, `height` above the floor.
fn many() -> Row {
    let (edge, height, radius, pitch) = (1000, 100.0, 0.01, 1.0);
    let mut lamps = String::from("void light dot 0 0 3 1e6 1e6 1e6\n");
    let mut expected = 0.0;
    for i in 0..edge {
        for j in 0..edge {
            let [x, y] = [i, j].map(|at| (f64::from(at) - f64::from(edge) / 2.0 + 0.5) * pitch);
            lamps += &format!("dot sphere d 0 0 4 {x} {y} {height} {radius}\n");
            let distance = (x * x + y * y + height * height).sqrt();
            expected += 0.5e6 * (radius / distance).powi(2) * height / distance;
        }
    }
    let floor = square("paint", "floor", [0.0; 3], 10.0);
    let look = Look::new([PAINT, &floor, &lamps].concat(), [0.0, -0.5, 0.5], [0.0, 1.0, -1.0]);
    Row::near(expected, look.red(), 1e-5)
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "lights",
        &[
            ("radiance 1e-30", || shines(1e-30)),
            ("radiance 1e-12", || shines(1e-12)),
            ("radiance 1e-6, Radiance's threshold", || shines(1e-6)),
            ("radiance 1", || shines(1.0)),
            ("radiance 1e12", || shines(1e12)),
            ("radiance 1e30", || shines(1e30)),
            ("radiance 1e-45: below single precision", || {
                Row::same(0.0, floor("void light bulb 0 0 3 1e-45 1e-45 1e-45", 1e-3))
            }),
            ("radiance 0", || Row::same(0.0, floor("void light bulb 0 0 3 0 0 0", 1e-3))),
            ("radius 1e-2", || Row::near(0.5, floor("void light bulb 0 0 3 1e4 1e4 1e4", 1e-2), 1e-4)),
            ("radius 1e-9", || small(1e-9)),
            ("radius 1e-14", || small(1e-14)),
            ("two lamps of 1e-12 and 1e12", || {
                let lamps = "void light dim 0 0 3 1e-12 0 0\nvoid light bulb 0 0 3 0 0 1e12\n\
                             dim sphere a 0 0 4 -.1 0 1 1e-3\nbulb sphere b 0 0 4 .1 0 1 1e-3\n";
                let seen = under(lamps).pixel();
                // The points drawn on the two differ by 1e-3, askew by .1.
                Row::near(1e24, seen.z / seen.x, 2e-4)
            }),
            ("a sun of .533 degrees", || sun(0.533, 1, 1e-4)),
            ("a sun of 1e-5 degrees", || sun(1e-5, 1, 1e-6)),
            // Stratified: the mean of 4096 cosines errs by less than 1/4096^(3/4) = 2e-3.
            ("a sky of 180 degrees as a light", || sun(180.0, 4096, 2e-3)),
            ("a spotlight of 1e-3 degrees, inside", || {
                Row::near(0.5, floor("void spotlight bulb 0 0 7 1e6 1e6 1e6 1e-3 0 0 -1e-9", 1e-9) * 1e12, 3e-6)
            }),
            ("a glow just within its radius", || {
                Row::near(0.5, floor("void glow bulb 0 0 4 1e6 1e6 1e6 1.001", 1e-3), 2e-6)
            }),
            ("a glow just beyond its radius", || Row::same(0.0, floor("void glow bulb 0 0 4 1e6 1e6 1e6 .998", 1e-3))),
            ("beside a lamp's edge: finite", || {
                let lamp =
                    "void light wall 0 0 3 1 1 1\nwall polygon w 0 0 12 -1 1e-12 0 1 1e-12 0 1 1e-12 2 -1 1e-12 2\n";
                Row::same(None, first_bad(&under(lamp).samples(256).render()))
            }),
            ("no light", || {
                let text = [PAINT, &square("paint", "floor", [0.0; 3], 1.0)].concat();
                Row::same(0.0, Look::new(text, [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]).crex(EVERYTHING).red())
            }),
            ("an empty scene", || Row::same(0.0, Look::new("", [0.0; 3], [0.0, 1.0, 0.0]).crex(EVERYTHING).red())),
            ("nothing but a sky", || {
                let sky = "void glow sky 0 0 4 1 1 1 0\nsky source all 0 0 4 0 0 1 360\n";
                Row::same(1.0, Look::new(sky, [0.0; 3], [0.0, 1.0, 0.0]).crex(EVERYTHING).red())
            }),
            ("a room of glow: pi L, every way the same", || {
                let room = "void glow all 0 0 4 1 1 1 0\nall bubble room 0 0 4 0 0 0 1e4\n";
                let text = [PAINT, "paint sphere b 0 0 4 0 0 0 1\n", room].concat();
                Row::near(0.5, Look::new(text, [0.0, -3.0, 0.0], [0.0, 1.0, 0.0]).crex("D").samples(16).red(), 1e-6)
            }),
            ("the inside of a lamp", || {
                // Irradiance pi L; noise of the uniform directions of a bubble: 1.3/sqrt(4096) at most, stratified far less.
                let room = "void light all 0 0 3 1 1 1\nall bubble room 0 0 4 0 0 0 1e4\n";
                let text = [PAINT, &square("paint", "floor", [0.0; 3], 1.0), room].concat();
                let seen = Look::new(text, [0.0, -0.5, 0.5], [0.0, 1.0, -1.0]).samples(4096).red();
                Row::near(0.5, seen, 5e-3)
            }),
            ("10^6 lamps", many),
            ("a lamp of area 1e-16 and one of 1e16 alike", || {
                let lamp = |half: f64, height: f64, radiance: f64| {
                    let lamp = format!("void light far 0 0 3 {radiance:e} {radiance:e} {radiance:e}\n");
                    let corners = [[-half, -half], [-half, half], [half, half], [half, -half]];
                    let corners: Vec<String> = corners.iter().map(|[x, y]| format!("{x:e} {y:e} {height:e}")).collect();
                    under(&format!("{lamp}far polygon p 0 0 12 {}\n", corners.join(" "))).red()
                };
                // L A / h^2 is 1 for both.
                let pair = [lamp(0.5e-8, 1.0, 1e16), lamp(0.5e8, 1e14, 1e12)];
                Row::near(0.5 / PI, pair[0].max(pair[1]) * f64::from(pair[0].min(pair[1]) > 0.499_999 / PI), 1e-5)
            }),
        ],
    )
}
