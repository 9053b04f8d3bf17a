//! Continuous importance: the expected picture is that without a map, for as many rays as the map says.

use proptest::prelude::*;
use renderer::color::Rgb;
use renderer::component::Component;
use renderer::raster::Raster;
use renderer::render::{Rendering, Settings};

use crate::Stage;
use crate::execution::{assert_same, assert_unbiased, mean_and_error_of, room, settings};

/// What the renderings of the room by a map, continuous importance and a crex are.
fn render(room: &Stage, crex: &str, settings: Settings, map: &Raster<f32>) -> Rendering {
    let continuous = |renderer: renderer::render::Renderer<'_>| {
        renderer.with_importance(map).unwrap().with_continuous_importance().render().unwrap()
    };
    room.with(crex, settings, continuous)
}

/// Importance from 0.05 at the left to 1 at the right: with few samples both sides of "one sample expected" occur.
fn ramp() -> Raster<f32> {
    Raster::from_values(40, 40, (0..1600).map(|i| 0.05 + 0.95 * (i % 40) as f32 / 39.0).collect()).unwrap()
}

/// 64 seeds, 5 standard errors: a false alarm in some 1e5 comparisons (Student, 63 degrees of freedom: 5e-6 each), six here.
#[test]
fn the_expected_picture_is_the_one_without_a_map() {
    let room = room();
    let map = ramp();
    // Modulated components in turn, within each other, and among others.
    for (crex, plain) in [("{GD2}", "GD2"), ("T{RSG}2D", "T(RSG)2D"), ("D{D}{G}", "DDG")] {
        for samples in [1, 4] {
            let change = |settings: &mut Settings| settings.samples = samples;
            let whole = mean_and_error_of(64, |seed| room.render(plain, changed(seed, change)));
            let part = mean_and_error_of(64, |seed| render(&room, crex, changed(seed, change), &map));
            assert_unbiased(whole, part);
        }
    }
}

/// What the pixels of an important place bring must not depend on what the others bring: the mean of the left half alone. 192 seeds, 5 standard
/// errors: false alarm 1.3e-6.
#[test]
fn each_part_of_the_picture_keeps_its_light() {
    let room = room();
    let map = ramp();
    let left = |rendering: Rendering| {
        let layer = rendering.film.layer(Component::Diffuse).unwrap();
        let columns = layer.values().chunks_exact(40).flat_map(|row| &row[..20]);
        columns.map(|pixel| f64::from(pixel.y)).sum::<f64>() / 800.0
    };
    let change = |settings: &mut Settings| settings.samples = 3;
    let whole = crate::execution::mean_and_error(192, |seed| left(room.render("D", changed(seed, change))));
    let part = crate::execution::mean_and_error(192, |seed| left(render(&room, "{D}", changed(seed, change), &map)));
    assert_unbiased(whole, part);
}

fn changed(seed: u64, change: impl Fn(&mut Settings)) -> Settings {
    let mut settings = settings(2);
    settings.seed = seed;
    change(&mut settings);
    settings
}

#[test]
fn a_map_of_ones_changes_no_bit() {
    let room = room();
    let ones = Raster::filled(40, 40, 1.0);
    for crex in ["T{RSGM}", "{D3}{G}T", "(T{RSD})*"] {
        let mut settings = settings(5);
        settings.ambient = Rgb::splat(0.1);
        settings.limits.reflections = 3;
        assert_same(&room.render(crex, settings.clone()), &render(&room, crex, settings, &ones));
    }
}

#[test]
fn threads_and_stages_change_no_bit() {
    let room = room();
    let map = ramp();
    let render = |threads, staged| {
        let mut settings = settings(37);
        settings.threads = Some(threads);
        settings.limits.reflections = 3;
        room.with("T{RSGMD}2[SG]", settings, |renderer| {
            let renderer = renderer.with_importance(&map).unwrap().with_continuous_importance();
            if staged { renderer.render_stages(&mut |_| {}).unwrap() } else { renderer.render().unwrap() }
        })
    };
    let one = render(1, false);
    assert_same(&one, &render(3, false));
    assert_same(&one, &render(2, true));
}

#[test]
fn one_event_is_weighted_once() {
    // A furnace: walls that reflect half and glow 1. Directly and by n diffuse bounces a pixel sees 1 + 1/2 + .. + 2^-n,
    // whatever its directions: with p N whole, continuous importance must give just that and not a power of the weight.
    let text = "void plastic wall 0 0 5 .5 .5 .5 0 0\nvoid glow shine 0 0 4 1 1 1 0\nwall sphere inner 0 0 4 0 0 0 1\n";
    let stage =
        Stage::new(&format!("{text}shine sphere core 0 0 4 0 0 0 .5\n"), [0.0, 0.0, 0.9], [0.0, 1.0, 0.0], 90.0);
    let mut settings = Settings::new(8, 8);
    settings.samples = 8;
    let quarter = Raster::filled(8, 8, 0.25);
    let all = stage.render("D3", settings.clone());
    let some = render(&stage, "{D3}", settings.clone(), &quarter);
    // Two of eight samples, and the same two for every bounce.
    assert_eq!(4 * some.stages[0].report.rays, all.stages[0].report.rays);
    for row in &some.stages[1..] {
        assert!(row.report.rays <= some.stages[0].report.rays);
    }
    // The first two samples rendered alone are those two.
    settings.samples = 2;
    let alone = stage.render("D3", settings);
    assert_eq!(some.film.layer(Component::Diffuse), alone.film.layer(Component::Diffuse));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Where the map is 0 no member traces a ray, and what was spawned stays; elsewhere rays number pN rounded up or down.
    #[test]
    fn rays_follow_the_map(
        values in prop::collection::vec(prop_oneof![Just(0.0_f32), 0.01_f32..1.0, Just(1.0)], 64),
        samples in 1_u32..9,
        seed: u64,
    ) {
        // A closed diffuse box: each primary ray spawns one diffuse ray.
        let stage = Stage::new(
            "void light lamp 0 0 3 9 9 9\nvoid plastic white 0 0 5 .5 .5 .5 0 0\nwhite bubble box 0 0 4 0 0 0 2\n\
             lamp sphere l 0 0 4 0 -1.5 0 .1\n",
            [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], 60.0,
        );
        let mut settings = Settings::new(8, 8);
        (settings.samples, settings.seed, settings.threads) = (samples, seed, Some(1));
        let map = Raster::from_values(8, 8, values.clone()).unwrap();
        let rendering = render(&stage, "{D2}", settings.clone(), &map);
        let rays = rendering.stages[0].report.rays as f64;
        let expected = |round: fn(f64) -> f64| -> f64 {
            values.iter().map(|&p| round(f64::from(p) * f64::from(samples))).sum()
        };
        prop_assert!(rays >= expected(f64::floor) && rays <= expected(f64::ceil), "{rays}");
        let zeros = values.iter().filter(|&&p| p == 0.0).count() as u64;
        let layer = rendering.film.layer(Component::Diffuse);
        for (&p, index) in values.iter().zip(0..) {
            let light = layer.map_or(0.0, |layer| layer.values()[index].max_element());
            prop_assert!(p > 0.0 || light == 0.0);
        }
        // Left: the rays of pixels of no importance, and what the second bounce spawned.
        let last = rendering.stages[1].report.spawned[Component::Diffuse];
        prop_assert_eq!(rendering.left[Component::Diffuse], zeros * u64::from(samples) + last);
        // No map, no modulation: zeros and nothing else traces nothing.
        let none = render(&stage, "{D2}", settings, &Raster::filled(8, 8, 0.0));
        prop_assert!(none.stages.iter().all(|row| row.report.rays == 0));
    }
}
