//! Light transport against closed forms, against itself in other orders, and against a plain recursive tracer.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

mod closed_forms;
mod continuous;
mod estimated;
mod execution;
mod first_hits;
mod furnace;
mod limited;
mod media;
mod modulated;
mod recursive;

use renderer::color::Rgb;
use renderer::crex::{self, Program};
use renderer::geometry::Aggregate;
use renderer::rad::{self, MemoryFiles, Source, ViewSpec};
use renderer::raster::Raster;
use renderer::render::{Renderer, Rendering, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::ManualClock;

/// A scene with its view, ready to be rendered by any crex.
struct Stage {
    scene: Scene,
    aggregate: Aggregate,
    view: View,
}

impl Stage {
    /// A scene from its text, seen from `eye` along `direction` in a square of `degrees`.
    fn new(text: &str, eye: [f64; 3], direction: [f64; 3], degrees: f64) -> Self {
        let document =
            rad::read(&[Source::new("test.rad", text)], &MemoryFiles::new(), &rad::Options::default()).unwrap();
        let scene = Scene::from_rad(&document).unwrap();
        let up = if direction[0] == 0.0 && direction[1] == 0.0 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let spec =
            ViewSpec { point: eye, direction, up, horizontal: degrees, vertical: degrees, ..ViewSpec::default() };
        Self { aggregate: scene.aggregate(), view: View::new(spec).unwrap(), scene }
    }

    fn render(&self, crex: &str, settings: Settings) -> Rendering {
        self.with(crex, settings, |renderer| renderer.render().unwrap())
    }

    fn with<T>(&self, crex: &str, settings: Settings, work: impl FnOnce(Renderer<'_>) -> T) -> T {
        let program = Program::new(&crex::parse(crex).unwrap());
        let clock = ManualClock::default();
        work(Renderer::new(&self.scene, &self.aggregate, &self.view, &program, &clock, settings).unwrap())
    }

    /// The one pixel of a picture of one pixel.
    fn pixel(&self, crex: &str, settings: Settings) -> Rgb {
        beauty(&self.render(crex, settings)).values()[0]
    }
}

/// One pixel of this many samples, without the limits that cut paths short.
fn endless(samples: u32) -> Settings {
    let mut settings = Settings::new(1, 1);
    settings.samples = samples;
    settings.limits.reflections = 200;
    settings.limits.least_weight = 0.0;
    settings
}

fn beauty(rendering: &Rendering) -> Raster<Rgb> {
    let film = rendering.film.beauty();
    let pixels = film.values().iter().map(|pixel| pixel.as_dvec3()).collect();
    Raster::from_values(film.width(), film.height(), pixels).unwrap()
}

fn assert_close(found: Rgb, expected: Rgb, relative: f64) {
    let error = (found - expected).abs().max_element();
    assert!(error <= relative * expected.max_element(), "found {found}, expected {expected}");
}
