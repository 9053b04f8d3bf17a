//! Degenerate, coincident, concave and very detailed surfaces.

use std::f64::consts::PI;

use crate::look::{Look, PAINT, scene, square};
use crate::table::{Case, Row, group};

/// Seen from above at (x, y), before a glow of radiance 1 below.
fn above(text: &str, x: f64, y: f64) -> f64 {
    let sky = "void glow sky 0 0 4 1 1 1 0\nsky source below 0 0 4 0 0 -1 180\n";
    let paper = "void glow paper 0 0 4 2 2 2 0\nvoid glow later 0 0 4 3 3 3 0\nvoid glass pane 0 0 4 .5 .5 .5 1\n";
    Look::new([paper, sky, text].concat(), [x, y, 1.0], [0.0, 0.0, -1.0]).crex("T*").red()
}

/// A polygon in the plane z = 0 from its corners.
fn polygon(corners: impl Iterator<Item = [f64; 2]>) -> String {
    let corners: Vec<String> = corners.map(|[x, y]| format!("{x:e} {y:e} 0")).collect();
    format!("paper polygon outline 0 0 {} {}\n", 3 * corners.len(), corners.join(" "))
}

/// Warned about and left out: what is behind shows.
fn left_out(surface: &str) -> Row {
    let paper = "void glow paper 0 0 4 2 2 2 0\n";
    let warnings = scene(&[paper, surface].concat()).unwrap().warnings;
    let told = warnings.first().map_or("no warning", |warning| warning.message.as_str());
    let told = format!("{}, and {}", told, above(surface, 0.0, 0.0));
    Row::says("a warning, and 1", &told, told.contains("left out") && told.ends_with(", and 1"))
}

fn ell() -> String {
    polygon([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].into_iter())
}

fn holed() -> String {
    let outer = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0]];
    let hole = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    polygon(outer.into_iter().chain(hole))
}

fn circle(corners: u32) -> impl Iterator<Item = [f64; 2]> {
    (0..corners).map(move |i| {
        let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(corners)).sin_cos();
        [cos, sin]
    })
}

/// A disc of radius 1 and radiance 1, cut into a polygon of many corners, 1 above a floor of reflectance 1/2: the
/// irradiance under its middle is pi r^2/(r^2 + h^2).
fn lamp_of(corners: u32, samples: u32) -> f64 {
    let outline: Vec<String> = circle(corners).map(|[x, y]| format!("{y:e} {x:e} 1")).collect();
    let disc = format!("soft polygon disc 0 0 {} {}\n", 3 * corners, outline.join(" "));
    let text = [PAINT, "void light soft 0 0 3 1 1 1\n", &square("paint", "floor", [0.0; 3], 5.0), &disc].concat();
    Look::new(text, [0.0, -0.5, 0.5], [0.0, 1.0, -1.0]).samples(samples).red()
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "shapes",
        &[
            ("coincident: the later modifier shows", || {
                let text = square("paper", "a", [0.0; 3], 1.0) + &square("later", "b", [0.0; 3], 1.0);
                Row::same(3.0, above(&text, 0.1, 0.2))
            }),
            ("coincident: whatever the order of surfaces", || {
                let text = square("later", "b", [0.0; 3], 1.0) + &square("paper", "a", [0.0; 3], 1.0);
                Row::same(3.0, above(&text, 0.1, 0.2))
            }),
            ("coincident: opaque before transparent", || {
                let text = square("paper", "a", [0.0; 3], 1.0) + &square("pane", "b", [0.0; 3], 1.0);
                Row::same(2.0, above(&text, 0.1, 0.2))
            }),
            ("1000 coincident panes are one", || {
                let text: String = (0..1000).map(|_| square("pane", "p", [0.0; 3], 1.0)).collect();
                Row::near(0.5, above(&text, 0.1, 0.2), 1e-6)
            }),
            ("10^5 coincident sheets are one", || {
                let text: String = (0..100_000).map(|_| square("paper", "p", [0.0; 3], 1.0)).collect();
                Row::same(2.0, above(&text, 0.1, 0.2))
            }),
            ("a polygon of no area", || left_out("paper polygon flat 0 0 9 -1 0 0 1 0 0 0 0 0\n")),
            ("a polygon of one point", || left_out("paper polygon point 0 0 9 0 0 0 0 0 0 0 0 0\n")),
            ("a sphere of no radius", || left_out("paper sphere dot 0 0 4 0 0 0 0\n")),
            ("a cylinder of no length", || left_out("paper cylinder coin 0 0 7 0 0 0 0 0 0 1\n")),
            ("a cone of no radius", || left_out("paper cone line 0 0 8 0 0 0 0 1 0 0 0\n")),
            ("a ring of equal radii", || left_out("paper ring wire 0 0 8 0 0 0 0 0 1 1 1\n")),
            ("a ring of no normal", || left_out("paper ring lost 0 0 8 0 0 0 0 0 0 0 1\n")),
            ("the only surface is smaller than a digit", || {
                Row::same(
                    None,
                    crate::look::first_bad(
                        &Look::new(
                            "void plastic p 0 0 5 .5 .5 .5 0 0\np sphere dust 0 0 4 1e8 1e8 1e8 1e-12\n",
                            [1e8, 0.0, 1e8],
                            [0.0, 1.0, 0.0],
                        )
                        .crex(crate::look::EVERYTHING)
                        .render(),
                    ),
                )
            }),
            ("slivers of aspect 1e6 leave no gap", || {
                let n = 1000;
                let corner = |i: usize| format!("{:e} {:e} 0", (i as f64 * 1e-6).cos(), (i as f64 * 1e-6).sin());
                let fan: String =
                    (0..n).map(|i| format!("paper polygon s 0 0 9 0 0 0 {} {}\n", corner(i), corner(i + 1))).collect();
                let sum: f64 = (1..n).step_by(50).map(|i| above(&fan, 0.7, 0.7 * (i as f64 * 1e-6).tan())).sum();
                Row::same(2.0 * 20.0, sum)
            }),
            ("a concave polygon, in its notch", || Row::same(1.0, above(&ell(), 1.5, 1.5))),
            ("a concave polygon, beside its notch", || Row::same(2.0, above(&ell(), 0.5, 1.5))),
            ("a polygon with a hole, in the hole", || Row::same(1.0, above(&holed(), 0.5, 0.5))),
            ("a polygon with a hole, on its seam", || Row::same(2.0, above(&holed(), -1.5, -1.5))),
            ("a polygon of 1e5 corners", || {
                let circle = polygon(circle(100_000));
                Row::same([2.0, 1.0], [above(&circle, 0.9999, 0.0), above(&circle, 1.0001, 0.0)])
            }),
            // 1e4 samples of at most twice the mean are off by less than 5 x 1e-2 x 0.6; false alarm 1e-6, fixed seed.
            ("a lamp of 1000 corners", || Row::near(0.25, lamp_of(1000, 10_000), 1e-2)),
            ("a lamp of 20000 corners", || Row::near(0.25, lamp_of(20_000, 10_000), 1e-2)),
        ],
    )
}
