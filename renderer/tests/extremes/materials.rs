//! Roughness, refraction, absorption at the ends of their ranges.

use renderer::color::Rgb;
use renderer::material::{Dielectric, Event, Glass, Interaction, Lobe, Material};

use crate::look::{EVERYTHING, Look};
use crate::table::{Case, Row, group};

/// The middle of a ball in a white sky: what it does not absorb comes back, so a white one shows 1. After 1000 reflections
/// inside a solid of index 100 some .96^1000 are left.
fn furnace(material: &str, shape: &str) -> f64 {
    let sky = "void glow sky 0 0 4 1 1 1 0\nsky source all 0 0 4 0 0 1 360\n";
    let text = format!("{material}\n{sky}{shape}\n");
    Look::new(text, [0.0, -5.0, 0.0], [0.0, 1.0, 0.0]).crex(EVERYTHING).samples(4).reflections(1000).red()
}

fn white(material: &str) -> Row {
    Row::near(1.0, furnace(material, "stuff sphere ball 0 0 4 0 0 0 1"), 1e-6)
}

/// The same of a sheet: a translucent ball would split each ray inside it again and again.
fn sheet(material: &str) -> Row {
    Row::near(1.0, furnace(material, "stuff polygon sheet 0 0 12 -9 0 -9 9 0 -9 9 0 9 -9 0 9"), 1e-6)
}

/// The lobes of a ray that meets a surface at an angle to its normal, in degrees.
fn lobes(material: Material, degrees: f64, front: bool) -> Vec<Lobe> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let up = if front { 1.0 } else { -1.0 };
    let mut lobes = Vec::new();
    let interaction = Interaction::new(Rgb::new(sin, 0.0, -cos * up), Rgb::new(0.0, 0.0, 1.0));
    material.scatter(interaction, 0.0, |lobe| lobes.push(lobe));
    lobes
}

fn dielectric(index: f64, degrees: f64, front: bool) -> Vec<Lobe> {
    lobes(Material::Dielectric(Dielectric::from_reals(&[1.0, 1.0, 1.0, index, 0.0]).unwrap()), degrees, front)
}

fn coefficient(lobes: &[Lobe], event: Event) -> f64 {
    lobes.iter().filter(|lobe| lobe.event == event).map(|lobe| lobe.coefficient.x).sum()
}

/// A ball that absorbs, of some radius, seen along its diameter through its clear surface (index 1).
fn absorbing(transmission: &str, radius: f64) -> f64 {
    let sky = "void glow sky 0 0 4 1 1 1 0\nsky source all 0 0 4 0 0 1 360\n";
    let t = transmission;
    let text = format!("void dielectric ink 0 0 5 {t} {t} {t} 1 0\n{sky}ink sphere ball 0 0 4 0 0 0 {radius:e}\n");
    Look::new(text, [0.0, -5.0 * radius, 0.0], [0.0, 1.0, 0.0]).crex(EVERYTHING).red()
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "materials",
        &[
            ("white metal, roughness 0", || white("void metal stuff 0 0 5 1 1 1 1 0")),
            ("white metal, roughness 1e-7", || white("void metal stuff 0 0 5 1 1 1 1 1e-7")),
            ("white metal, roughness .001, the last smooth one", || white("void metal stuff 0 0 5 1 1 1 1 .001")),
            ("white metal, roughness .0010001", || white("void metal stuff 0 0 5 1 1 1 1 .0010001")),
            ("white metal, roughness .3", || white("void metal stuff 0 0 5 1 1 1 1 .3")),
            ("white metal, roughness 1", || white("void metal stuff 0 0 5 1 1 1 1 1")),
            ("white plastic, specular .5, roughness 1e-7", || white("void plastic stuff 0 0 5 1 1 1 .5 1e-7")),
            ("white trans, roughness 1e-7", || sheet("void trans stuff 0 0 7 1 1 1 .1 1e-7 .5 .5")),
            ("white trans, roughness .2", || sheet("void trans stuff 0 0 7 1 1 1 .1 .2 .5 .5")),
            ("a clear solid, index 1", || white("void dielectric stuff 0 0 5 1 1 1 1 0")),
            ("a clear solid, index 1 + 1e-9", || white("void dielectric stuff 0 0 5 1 1 1 1.000000001 0")),
            ("a clear solid, index 1.5", || white("void dielectric stuff 0 0 5 1 1 1 1.5 0")),
            ("a clear solid, index 100", || white("void dielectric stuff 0 0 5 1 1 1 100 0")),
            ("a clear solid, index .5: thinner than outside", || white("void dielectric stuff 0 0 5 1 1 1 .5 0")),
            ("a clear pane, index 100", || white("void glass stuff 0 0 4 1 1 1 100")),
            ("index 1 reflects nothing", || {
                Row::same(0.0, coefficient(&dielectric(1.0, 70.0, true), Event::BoundaryReflection))
            }),
            // (n - 1)^2/4 with n - 1 = 1e-9: n itself has 7 digits of that left.
            ("index 1 + 1e-9 reflects 2.5e-19", || {
                Row::near(2.5e-19, coefficient(&dielectric(1.0 + 1e-9, 0.0, true), Event::BoundaryReflection), 1e-6)
            }),
            ("index 100 reflects (99/101)^2 head on", || {
                let found = coefficient(&dielectric(100.0, 0.0, true), Event::BoundaryReflection);
                Row::near((99.0_f64 / 101.0).powi(2), found, 1e-14)
            }),
            ("inside index 1.5, at 41.80 degrees some leaves", || Row::same(2, dielectric(1.5, 41.80, false).len())),
            ("inside index 1.5, at 41.82 degrees nothing does", || {
                let lobes = dielectric(1.5, 41.82, false);
                Row::same((1, 1.0), (lobes.len(), coefficient(&lobes, Event::BoundaryReflection)))
            }),
            ("inside index 100, at 0.58 degrees nothing leaves", || {
                Row::near(1.0, coefficient(&dielectric(100.0, 0.58, false), Event::BoundaryReflection), 0.0)
            }),
            ("Brewster's angle: half of what is not polarised along", || {
                // At tan a = n the parallel part is not reflected; the other is ((n^2 - 1)/(n^2 + 1))^2.
                let found = coefficient(&dielectric(1.5, 1.5_f64.atan().to_degrees(), true), Event::BoundaryReflection);
                Row::near(0.5 * (1.25_f64 / 3.25).powi(2), found, 1e-12)
            }),
            ("grazing at 89.99999 degrees: all but a little is reflected", || {
                // The cosine is bounded at .001, where 1 - R is 4 x .001 x (n/sqrt(n^2-1) + 1/(n sqrt(n^2-1)))/2 x 1/n ..
                let found = coefficient(&dielectric(1.5, 89.999_99, true), Event::BoundaryReflection);
                Row::says("above .99, below 1", format!("{found}"), (0.99..1.0).contains(&found))
            }),
            ("a black pane passes nothing", || {
                let pane = Material::Glass(Glass::from_reals(&[0.0; 3]).unwrap());
                Row::same(0.0, coefficient(&lobes(pane, 30.0, true), Event::PaneTransmission))
            }),
            ("a pane of transmissivity 1e-300", || {
                let pane = Material::Glass(Glass::from_reals(&[1e-300; 3]).unwrap());
                let found = coefficient(&lobes(pane, 30.0, true), Event::PaneTransmission);
                Row::says("0 to 1e-14", format!("{found:e}"), (0.0..1e-14).contains(&found))
            }),
            ("a pane that amplifies stays finite", || {
                let pane = Material::Glass(Glass::from_reals(&[25.0; 3]).unwrap());
                let lobes = lobes(pane, 0.0, true);
                let good =
                    lobes.iter().all(|lobe| lobe.coefficient.is_finite() && lobe.coefficient.min_element() >= 0.0);
                Row::same((2, true), (lobes.len(), good))
            }),
            ("ink of .5 a metre, 2 km deep", || Row::same(0.0, absorbing(".5", 1e3))),
            ("ink of .5 a metre, 2 micrometres deep", || Row::near(0.5_f64.powf(2e-6), absorbing(".5", 1e-6), 1e-7)),
            ("ink that passes nothing, 2 micrometres deep", || {
                // Radiance's extinction of a medium that passes nothing is 100 a metre.
                Row::near((-2e-4_f64).exp(), absorbing("0", 1e-6), 1e-7)
            }),
            ("clear water 2e8 deep", || Row::same(1.0, absorbing("1", 1e8))),
        ],
    )
}
