//! The same light in other orders: threads, modes, splits, roulette, layers, maps.

use std::collections::BTreeMap;

use renderer::color::Rgb;
use renderer::component::Component;
use renderer::film::Layers;
use renderer::raster::Raster;
use renderer::render::{RenderError, Rendering, Settings};

use crate::{Stage, beauty};

/// A room in which every component occurs.
const ROOM: &str = "\
void light lamp 0 0 3 20 20 20
void plastic white 0 0 5 .6 .6 .6 0 0
void plastic gloss 0 0 5 .5 .4 .3 .1 .1
void metal smooth 0 0 5 .8 .7 .5 .9 0
void metal rough 0 0 5 .8 .7 .5 .8 .2
void glass pane 0 0 3 .9 .9 .9
void dielectric solid 0 0 5 .8 .9 .9 1.5 0
void trans sheet 0 0 7 .8 .8 .7 .05 0 .6 .5
void mirror silver 0 0 3 .8 .8 .8
gloss polygon floor 0 0 12 -2 -2 0 2 -2 0 2 2 0 -2 2 0
white polygon ceiling 0 0 12 -2 -2 3 -2 2 3 2 2 3 2 -2 3
white polygon back 0 0 12 -2 2 0 2 2 0 2 2 3 -2 2 3
white polygon right 0 0 12 2 -2 0 2 -2 3 2 2 3 2 2 0
silver polygon left 0 0 12 -1.9 -1 .2 -1.9 1.5 .2 -1.9 1.5 2 -1.9 -1 2
lamp polygon l 0 0 12 -.5 0 2.9 -.5 1 2.9 .5 1 2.9 .5 0 2.9
smooth sphere a 0 0 4 -.9 1 .5 .5
rough sphere b 0 0 4 .3 1.2 .5 .5
solid sphere c 0 0 4 1.2 .4 .4 .4
sheet polygon s 0 0 12 .2 .2 .8 1 .2 .8 1 .2 1.6 .2 .2 1.6
pane polygon p 0 0 12 -.9 0 .1 0 0 .1 0 0 1.5 -.9 0 1.5
";

pub(crate) fn room() -> Stage {
    Stage::new(ROOM, [0.0, -1.9, 1.3], [0.0, 1.0, -0.15], 75.0)
}

pub(crate) fn settings(samples: u32) -> Settings {
    let mut settings = Settings::new(40, 40);
    settings.samples = samples;
    settings.threads = Some(1);
    settings
}

/// What two renderings must share to be the same: pictures, rays, what is left; not seconds.
pub(crate) fn assert_same(a: &Rendering, b: &Rendering) {
    assert_eq!(a.film, b.film);
    assert_eq!((a.primary.rays, a.primary.spawned, a.left), (b.primary.rays, b.primary.spawned, b.left));
    let rows = |rendering: &Rendering| -> Vec<_> {
        rendering.stages.iter().map(|row| (row.stage.clone(), row.report.rays, row.report.spawned)).collect()
    };
    assert_eq!(rows(a), rows(b));
}

#[test]
fn any_number_of_threads_and_either_mode_give_the_same_bits() {
    let room = room();
    let map = Raster::from_values(40, 40, (0..1600).map(|i| (i % 40) as f32 / 39.0).collect()).unwrap();
    for crex in ["(TRSGMD)*", "(<MRSGD>T*)2", "T{RSGMD}2[SG]"] {
        let render = |threads, staged| {
            // 37 samples: several parcels for a tile, the last one smaller.
            let mut settings = settings(37);
            settings.threads = Some(threads);
            settings.ambient = Rgb::new(0.3, 0.2, 0.1);
            settings.limits.reflections = 3;
            room.with(crex, settings, |renderer| {
                let renderer = renderer.with_importance(&map).unwrap();
                if staged { renderer.render_stages(&mut |_| {}).unwrap() } else { renderer.render().unwrap() }
            })
        };
        let one = render(1, false);
        assert_same(&one, &render(2, false));
        assert_same(&one, &render(5, false));
        assert_same(&one, &render(1, true));
        assert_same(&one, &render(3, true));
    }
}

#[test]
fn snapshots_grow_into_the_picture() {
    let room = room();
    let mut settings = settings(4);
    settings.ambient = Rgb::splat(0.1);
    let mut pictures = Vec::new();
    let rendering = room.with("TD2", settings.clone(), |renderer| {
        renderer
            .render_stages(&mut |snapshot| {
                pictures.push((snapshot.stage.map(|stage| stage.component.letter()), snapshot.film.beauty()));
            })
            .unwrap()
    });
    let stages: Vec<_> = pictures.iter().map(|(stage, _)| *stage).collect();
    assert_eq!(stages, [None, Some('T'), Some('D'), Some('D')]);
    assert_eq!(pictures.last().unwrap().1, rendering.film.beauty());
    // Each is the picture of the crex up to there.
    for ((_, picture), crex) in pictures.iter().zip(["", "T", "TD", "TD2"]) {
        assert_eq!(*picture, room.render(crex, settings.clone()).film.beauty(), "{crex}");
    }
}

#[test]
fn equal_words_have_equal_light_in_different_crexes() {
    // The random numbers of a path depend on its word, not on when it runs: so layers of one event agree to the last
    // digit but rounding.
    let room = room();
    let whole = room.render("(TRSGMD)*", settings(4));
    assert_eq!(whole.film.direct(), room.render("", settings(4)).film.direct());
    let held = room.render("<TRSGMD>", settings(4));
    for component in Component::ALL {
        let alone = room.render(&component.to_string(), settings(4));
        assert_eq!(alone.film.layer(component), held.film.layer(component), "{component}");
        assert!(alone.film.layer(component).is_some(), "{component}");
    }
}

#[test]
fn layers_by_first_event_hold_the_same_light() {
    let room = room();
    let last = room.render("(TRSGMD)*", settings(4));
    let first = room.render("(TRSGMD)*", Settings { layers: Layers::First, ..settings(4) });
    for (a, b) in beauty(&last).values().iter().zip(beauty(&first).values()) {
        assert!((*a - *b).abs().max_element() <= 1e-5 * a.max_element(), "{a} {b}");
    }
    assert_eq!(first.film.direct(), last.film.direct());
    // Under the first event a word's own layer holds all that follows it: more than the word alone.
    let mean =
        |film: &renderer::film::Film| film.layer(Component::Diffuse).unwrap().values().iter().map(|p| p.y).sum::<f32>();
    assert!(mean(&first.film) < mean(&last.film));
}

#[test]
fn every_ray_is_traced_or_left() {
    let room = room();
    for crex in ["", "T", "D2", "(TRS)*", "<MRSGD>T*", "(TRSGMD)*"] {
        let rendering = room.render(crex, settings(4));
        let mut balance: BTreeMap<Component, i64> = BTreeMap::new();
        for (component, &count) in rendering.primary.spawned.iter() {
            *balance.entry(component).or_default() += count as i64;
        }
        for row in &rendering.stages {
            *balance.entry(row.stage.component).or_default() -= row.report.rays as i64;
            for (component, &count) in row.report.spawned.iter() {
                *balance.entry(component).or_default() += count as i64;
            }
        }
        for (component, &left) in rendering.left.iter() {
            assert_eq!(balance[&component], left as i64, "{crex}: {component}");
        }
    }
}

/// Mean over a picture of the sum of its channels, and what its seeds say of its error.
fn mean_and_error_by(room: &Stage, crex: &str, seeds: u64, change: impl Fn(&mut Settings)) -> (f64, f64) {
    mean_and_error_of(seeds, |seed| {
        let mut settings = settings(2);
        settings.seed = seed;
        change(&mut settings);
        room.render(crex, settings)
    })
}

/// The same for the renderings of any kind, by seed.
pub(crate) fn mean_and_error_of(seeds: u64, render: impl Fn(u64) -> Rendering) -> (f64, f64) {
    mean_and_error(seeds, |seed| {
        let picture = beauty(&render(seed));
        picture.values().iter().map(|pixel| pixel.element_sum()).sum::<f64>() / picture.values().len() as f64
    })
}

/// Mean of a number over seeds, and its standard error.
pub(crate) fn mean_and_error(seeds: u64, number: impl Fn(u64) -> f64) -> (f64, f64) {
    let means: Vec<f64> = (0..seeds).map(number).collect();
    let n = seeds as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Two estimates with 24 seeds each; 5 standard errors: a false alarm in some 1e5 comparisons (Student, 23 degrees of
/// freedom). Seeds are fixed.
pub(crate) fn assert_unbiased(a: (f64, f64), b: (f64, f64)) {
    let error = (a.1 * a.1 + b.1 * b.1).sqrt();
    assert!((a.0 - b.0).abs() < 5.0 * error, "{a:?} {b:?}");
    assert!(error < 0.02 * a.0, "the comparison says little: {a:?} {b:?}");
}

#[test]
fn splitting_changes_noise_and_not_light() {
    let room = room();
    let plain = mean_and_error_by(&room, "GD2", 24, |_| {});
    let split = mean_and_error_by(&room, "GD2", 24, |settings| {
        settings.samples = 1;
        settings.limits.diffuse_rays = 4;
    });
    assert_unbiased(plain, split);
    // Only primary hits split.
    let mut several = settings(1);
    several.limits.diffuse_rays = 4;
    let rendering = room.render("D2", several);
    let first = rendering.stages[0].report.rays;
    assert_eq!(first, rendering.primary.spawned[Component::Diffuse]);
    assert_eq!(first % 4, 0);
    assert!(rendering.stages[1].report.rays <= 2 * first);
}

#[test]
fn roulette_is_unbiased() {
    let room = room();
    let long = mean_and_error_by(&room, "(TRSGMD)*", 24, |settings| {
        settings.samples = 1;
        settings.limits.least_weight = 1e-4;
        settings.limits.reflections = 30;
    });
    let roulette = mean_and_error_by(&room, "(TRSGMD)*", 24, |settings| {
        settings.samples = 1;
        settings.limits.least_weight = 0.2;
        settings.limits.reflections = 0;
    });
    assert_unbiased(long, roulette);
    // With a positive `-lr` the same least weight ends the paths instead, and light is missing.
    let cut = mean_and_error_by(&room, "(TRSGMD)*", 4, |settings| settings.limits.least_weight = 0.2);
    assert!(cut.0 < long.0 - 5.0 * long.1);
}

#[test]
fn reflections_are_counted_and_transmissions_are_not() {
    // A stack of ten panes: T* goes through all of them even with `-lr` 1; of reflections one is left.
    let mut text =
        String::from("void glass pane 0 0 3 1 1 1\nvoid glow white 0 0 4 1 1 1 0\nwhite source sky 0 0 4 0 1 0 360\n");
    for i in 0..10 {
        text += &format!("pane polygon p{i} 0 0 12 -9 {i} -9 9 {i} -9 9 {i} 9 -9 {i} 9\n");
    }
    let stack = Stage::new(&text, [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 1.0);
    let render = |crex: &str, reflections| {
        let mut settings = settings(1);
        settings.limits.reflections = reflections;
        stack.render(crex, settings)
    };
    let through = render("T*", 1);
    let ran: Vec<u64> = through.stages.iter().map(|row| row.report.rays).collect();
    assert_eq!(ran, [[1600; 10].as_slice(), &[0]].concat());
    assert_eq!(render("R*", 1).stages.iter().filter(|row| row.report.rays > 0).count(), 1);
    // Reflected at the first pane, the way back is free; at the second, a ray comes back to the first: nothing more
    // without T.
    assert_eq!(render("(TR)*", 1).left[Component::Reflected], 0);
}

#[test]
fn bad_settings_are_refused_by_name() {
    let room = room();
    let refused = |change: &dyn Fn(&mut Settings)| {
        let mut settings = settings(1);
        change(&mut settings);
        let program = renderer::crex::Program::new(&renderer::crex::parse("T{RS}").unwrap());
        let clock = renderer::schedule::ManualClock::default();
        let made =
            renderer::render::Renderer::new(&room.scene, &room.aggregate, &room.view, &program, &clock, settings);
        made.err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(refused(&|settings| settings.width = 0).contains("size"));
    assert!(refused(&|settings| settings.samples = 0).contains("samples"));
    assert!(refused(&|settings| settings.jitter = f64::NAN).contains("-pj"));
    assert!(refused(&|settings| settings.limits.least_weight = -1.0).contains("-lw"));
    assert!(refused(&|settings| settings.ambient = Rgb::new(0.0, f64::INFINITY, 0.0)).contains("-av"));
    assert!(refused(&|settings| (settings.samples, settings.limits.diffuse_rays) = (1 << 20, 1 << 20)).contains("-ad"));
    assert_eq!(refused(&|_| {}), "");
    room.with("T{RS}", settings(1), |renderer| {
        let small = Raster::filled(4, 4, 1.0);
        assert!(matches!(renderer.with_importance(&small), Err(RenderError::ImportanceSize { .. })));
    });
    room.with("T{RS}", settings(1), |renderer| {
        let wild = Raster::filled(40, 40, 1.5);
        assert!(matches!(renderer.with_importance(&wild), Err(RenderError::Setting { .. })));
    });
    room.with("T{RS}", settings(1), |renderer| {
        assert!(matches!(renderer.with_thresholds(&[0.5]), Err(RenderError::Thresholds(_))));
    });
}
