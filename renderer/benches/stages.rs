//! What the stages of a picture cost, on one thread: `cargo bench -p renderer --bench stages`. The scene is the corridor of
//! the shipped study, at 96 x 77 pixels.

use std::path::Path;
use std::sync::LazyLock;

use divan::Bencher;
use divan::counter::ItemsCount;
use renderer::component::{Component, ComponentSet};
use renderer::crex;
use renderer::geometry::Aggregate;
use renderer::rad::{self, DiskFiles, Source, ViewSpec};
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::MonotonicClock;
use renderer::transport::Limits;

struct Corridor {
    scene: Scene,
    aggregate: Aggregate,
    view: View,
}

static CORRIDOR: LazyLock<Corridor> = LazyLock::new(|| {
    let scene = read();
    let mut spec = ViewSpec::default();
    spec.take_header("view", &text("corridor.vf")).expect("the study's view is right");
    Corridor { aggregate: scene.aggregate(), view: View::new(spec).expect("the study's view is right"), scene }
});

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../stimuli/corridor")
}

fn text(name: &str) -> String {
    std::fs::read_to_string(folder().join(name)).expect("the study is in the project")
}

fn read() -> Scene {
    let files = ["materials.rad", "shell.rad", "layout_a.rad"];
    let sources = files.map(|name| Source::new(folder().join(name).display().to_string(), text(name)));
    let document = rad::read(&sources, &DiskFiles::new(Vec::new()), &rad::Options::default());
    Scene::from_rad(&document.expect("the study's scene is right")).expect("the study's scene is right")
}

fn main() {
    divan::main();
}

#[divan::bench]
fn read_scene() -> Scene {
    read()
}

#[divan::bench]
fn build_hierarchy() -> Aggregate {
    CORRIDOR.scene.aggregate()
}

fn settings() -> Settings {
    let limits = Limits { reflections: -12, least_weight: 0.2, ..Limits::default() };
    Settings { samples: 4, limits, threads: Some(1), ..Settings::new(96, 77) }
}

fn renderer(run: impl FnOnce(&Renderer<'_>), expression: &str) {
    let program = crex::compile(expression).expect("a crex");
    let clock = MonotonicClock::start();
    let Corridor { scene, aggregate, view } = &*CORRIDOR;
    run(&Renderer::new(scene, aggregate, view, &program, &clock, settings()).expect("settings in range"));
}

/// A picture, counted in samples of pixels.
#[divan::bench(args = ["", "(TRSM)*", "(TRSGM)*", "(TRSGM)*D", "(TRSGMD)*"], sample_count = 10)]
fn picture(bencher: Bencher, expression: &str) {
    let samples = 96 * 77 * 4_usize;
    renderer(
        |renderer| {
            bencher.counter(ItemsCount::new(samples)).bench_local(|| renderer.render().map(|it| it.primary.rays))
        },
        expression,
    );
}

/// The same, smoothed: what that costs is the difference.
#[divan::bench(sample_count = 10)]
fn smoothed_picture(bencher: Bencher) {
    let planes = ComponentSet::EMPTY.with(Component::Diffuse).with(Component::Glossy);
    renderer(|renderer| bencher.bench_local(|| renderer.render_smoothed(planes).map(|it| it.1)), "(TRSGMD)*");
}
