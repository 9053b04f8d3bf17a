//! Laws that hold for any scene, tried on random ones: seeds are fixed, and a law with a share of exceptions says why.

use renderer::color::Rgb;
use renderer::material::{Dielectric, Event, Interaction, Material};

use crate::look::{Look, PAINT, first_bad, square};
use crate::random::{Move, Numbers, any_scene, wild_scene};
use crate::table::{Case, Row, group};

/// Paths of up to four events: longer ones would branch beyond counting between translucent sheets.
const FOUR_EVENTS: &str = "<TRSGMD>4";

/// The shapes of [`any_scene`] is seen from here.
const EYE: Rgb = Rgb::new(0.5, -6.0, 1.0);

fn look(text: String, to: &Move, crex: &'static str) -> Look {
    let eye = to.point(EYE);
    let mut look = Look::new(text, eye.to_array(), to.vector(-EYE).to_array()).crex(crex).degrees(40.0).size(4, 4);
    look.view.up = to.vector(Rgb::Z).to_array();
    look
}

/// Tries a law so many times; it gives the share of pixels that break it, or why it is broken at once.
fn tried(expected: &str, times: u64, exceptions: f64, law: impl Fn(&mut Numbers) -> Result<f64, String>) -> Row {
    let mut broken = 0.0;
    for seed in 0..times {
        match law(&mut Numbers::new(seed)) {
            Ok(share) => broken += share / times as f64,
            Err(why) => return Row::says(expected, format!("seed {seed}: {why}"), false),
        }
    }
    let got =
        if exceptions == 0.0 { format!("{times} hold") } else { format!("{times}; {broken:.1e} of the pixels differ") };
    Row::says(expected, got, broken <= exceptions)
}

/// The share of values that differ by more than a relative bound after division by `factor`.
fn differing(a: &Look, b: &Look, factor: f64, bound: f64) -> Result<f64, String> {
    let (a, b) = (a.picture(), b.picture());
    let pairs = a.values().iter().zip(b.values());
    let broken = pairs.filter(|&(&a, &b)| (a * factor - b).abs().max_element() > bound * (a * factor).max_element());
    Ok(broken.count() as f64 / a.values().len() as f64)
}

fn finite() -> Row {
    tried("no NaN, no infinity, nothing negative", 4000, 0.0, |numbers| {
        let text = wild_scene(numbers);
        let mut look = look(text.clone(), &Move::STAY, FOUR_EVENTS).reflections(6);
        look.settings.ambient = Rgb::splat(numbers.extreme(1e6).abs());
        first_bad(&look.render()).map_or(Ok(0.0), |bad| Err(format!("{bad} in\n{text}")))
    })
}

fn scales_with_the_light() -> Row {
    tried("2^k x the light: 2^k x each pixel, to the bit", 1500, 0.0, |numbers| {
        let factor = 2_f64.powi(numbers.below(81) as i32 - 40);
        let scene = any_scene(numbers);
        let [one, other] =
            [1.0, factor].map(|light| look(scene.text(&Move::STAY, light), &Move::STAY, FOUR_EVENTS).reflections(5));
        match differing(&one, &other, factor, 0.0)? {
            0.0 => Ok(0.0),
            share => Err(format!("{share} of the pixels differ at {factor:e}")),
        }
    })
}

fn scales_with_the_scene() -> Row {
    tried("the scene x 2^k, k in -20 .. 26: the same picture, to the bit", 1500, 0.0, |numbers| {
        let to = Move { scale: 2_f64.powi(numbers.below(47) as i32 - 20), ..Move::STAY };
        let scene = any_scene(numbers);
        let [one, other] = [Move::STAY, to].map(|to| look(scene.text(&to, 1.0), &to, FOUR_EVENTS).reflections(5));
        match differing(&one, &other, 1.0, 0.0)? {
            0.0 => Ok(0.0),
            share => Err(format!("{share} of the pixels differ at {:e}", to.scale)),
        }
    })
}

/// A shift or turn rounds every coordinate: rays that pass an edge within the rounding, or a chain of curved mirrors that
/// magnifies it, may go another way.
fn moves(expected: &'static str, to: impl Fn(&mut Numbers) -> Move) -> Row {
    tried(expected, 1500, 2e-3, |numbers| {
        let to = to(numbers);
        let scene = any_scene(numbers);
        // Directions of diffuse and rough rays are drawn in frames that do not turn with the scene.
        let [one, other] = [Move::STAY, to].map(|to| look(scene.text(&to, 1.0), &to, "<STRM>2").reflections(5));
        differing(&one, &other, 1.0, 1e-4)
    })
}

fn energy() -> Row {
    tried("in a white sky nothing shows more than 1", 2000, 0.0, |numbers| {
        let material = numbers.material("stuff");
        // The inside of a solid needs a closed boundary: an open one would not take back what refraction gathered.
        let solid = material.contains("dielectric");
        let ball = "stuff sphere s 0 0 4 0 0 0 1.5\n".to_owned();
        let shape = if solid { ball } else { numbers.shape().text("stuff", &Move::STAY) };
        let sky = "void glow sky 0 0 4 1 1 1 0\nsky source all 0 0 4 0 0 1 360\n";
        let text = format!("{material}{sky}{shape}");
        let look = look(text.clone(), &Move::STAY, FOUR_EVENTS).reflections(0);
        let most = look.picture().values().iter().map(|pixel| pixel.max_element()).fold(0.0, f64::max);
        if most <= 1.0 + 1e-6 { Ok(0.0) } else { Err(format!("{most} in\n{text}")) }
    })
}

fn boundaries() -> Row {
    tried("R + T/n^2 = 1 within 1e-12, or R = 1", 10_000, 0.0, |numbers| {
        let index = 10_f64.powf(numbers.within(-3.0, 3.0));
        let solid = Material::Dielectric(Dielectric::from_reals(&[1.0, 1.0, 1.0, index, 0.0]).unwrap());
        let normal = numbers.direction();
        let interaction = Interaction::new(numbers.direction(), normal);
        let ratio = if interaction.front { 1.0 / index } else { index };
        let mut sum = 0.0;
        solid.scatter(interaction, 0.0, |lobe| {
            let refracted = lobe.event == Event::Refraction;
            sum += if refracted { lobe.coefficient.x / (ratio * ratio) } else { lobe.coefficient.x };
        });
        if (sum - 1.0).abs() <= 1e-12 { Ok(0.0) } else { Err(format!("index {index}, {interaction:?}: {sum}")) }
    })
}

/// The floor of `places`, of any size at any place.
fn anywhere() -> Row {
    tried("a matt floor at a lamp's foot shows 1/2 within 2e-6 + 1e-13 coordinate/size", 3000, 0.0, |numbers| {
        let size = 10_f64.powf(numbers.within(-6.0, 8.0));
        let place = numbers.direction() * size * 10_f64.powf(numbers.within(-2.0, 6.0));
        let lamp = place + Rgb::Z * size;
        let text = [
            PAINT,
            &square("paint", "floor", place.to_array(), size),
            &format!("lamp sphere ball 0 0 4 {:e} {:e} {:e} {:e}\n", lamp.x, lamp.y, lamp.z, 1e-3 * size),
        ];
        let eye = place + Rgb::new(0.0, -0.5, 0.5) * size;
        let found = Look::new(text.concat(), eye.to_array(), [0.0, 1.0, -1.0]).red();
        let bound = 2e-6 + 1e-13 * place.abs().max_element() / size;
        if (found - 0.5).abs() <= 0.5 * bound { Ok(0.0) } else { Err(format!("{size:e} {place}: {found}")) }
    })
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "laws",
        &[
            ("scenes of extreme numbers", finite),
            ("light times a factor", scales_with_the_light),
            ("lengths times a factor", scales_with_the_scene),
            ("a shift by up to 1e4 sizes", || {
                moves("the same picture", |numbers| {
                    let length = 10_f64.powf(numbers.within(0.0, 4.0));
                    Move { shift: numbers.direction() * length, ..Move::STAY }
                })
            }),
            ("a turn about any axis", || {
                moves("the same picture, turned", |numbers| Move::turn(numbers.direction(), numbers.within(0.0, 6.3)))
            }),
            ("any material in a white sky", energy),
            ("any boundary of a solid", boundaries),
            ("any size at any place", anywhere),
        ],
    )
}
