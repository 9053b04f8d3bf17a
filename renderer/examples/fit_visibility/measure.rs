//! Renders the scenes of a fit.

use std::fs;
use std::path::Path;

use renderer::color::Rgb;
use renderer::component::Component;
use renderer::crex::{self, Program};
use renderer::geometry::Aggregate;
use renderer::picture::Picture;
use renderer::picture::compare;
use renderer::picture::display::Display;
use renderer::propose::{Level, Levels, Profile, Question};
use renderer::rad::{self, DiskFiles, Files, Source, ViewSpec};
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::ManualClock;

use crate::predictors::Predictors;
use crate::rows::{self, Row};

/// Columns, and at most as many rows, of the pictures in which losses are measured.
const WIDTH: usize = 160;

/// Samples of each of their pixels.
const SAMPLES: u32 = 16;

/// A scene with its view and how it is rendered.
struct Stage {
    scene: Scene,
    aggregate: Aggregate,
    view: View,
    settings: Settings,
}

/// Measures every scene of a list, and writes the rows when all are done.
pub(crate) fn measure(list: &Path, to: &Path) -> Result<(), String> {
    let text = fs::read_to_string(list).map_err(|error| format!("{}: {error}", list.display()))?;
    let folder = list.parent().unwrap_or(Path::new(""));
    let mut table = rows::header();
    for line in text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [group, view, ambient, scenes @ ..] = words.as_slice() else {
            return Err(format!("`{line}`: expected a group, a view file, an ambient value and scene files"));
        };
        eprintln!("{line}");
        let stage = load(folder, view, ambient, scenes)?;
        let name = Path::new(scenes.last().unwrap_or(&"")).file_stem().unwrap_or_default().to_string_lossy();
        let measured = measure_scene(&stage, group, &name)?;
        measured.iter().for_each(|row| table.push_str(&row.line()));
        // What is done is kept: the next scene may not load.
        fs::write(to, &table).map_err(|error| format!("{}: {error}", to.display()))?;
    }
    Ok(())
}

fn load(folder: &Path, view: &str, ambient: &str, scenes: &[&str]) -> Result<Stage, String> {
    let told = |errors: Vec<rad::Error>| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let sources = scenes.iter().map(|scene| {
        let name = folder.join(scene).to_string_lossy().into_owned();
        DiskFiles::default().find(&name, "").map(Source::from).map_err(|error| format!("{name}: {error}"))
    });
    let sources = sources.collect::<Result<Vec<_>, String>>()?;
    let document = rad::read(&sources, &DiskFiles::default(), &rad::Options::default()).map_err(told)?;
    let scene = Scene::from_rad(&document).map_err(told)?;
    let text = fs::read_to_string(folder.join(view)).map_err(|error| format!("{view}: {error}"))?;
    let mut spec = ViewSpec::default();
    spec.take_header(view, &text).map_err(told)?;
    let view = View::new(spec).map_err(|error| error.to_string())?;
    let (width, height) = view.resolution(WIDTH, WIDTH, 1.0);
    let mut settings = Settings::new(width, height);
    // Roulette, so that `*` means all of the light.
    (settings.limits.reflections, settings.limits.least_weight) = (-12, 0.2);
    (settings.samples, settings.seed) = (SAMPLES, 1);
    let channels = ambient.split(',').map(|value| value.parse().map_err(|_| format!("`{ambient}`: three numbers")));
    let channels = channels.collect::<Result<Vec<f64>, String>>()?;
    settings.ambient = Rgb::from_slice(&channels);
    Ok(Stage { aggregate: scene.aggregate(), scene, view, settings })
}

/// The crexes of a scene, the full solution left out.
fn candidates(profile: &Profile<'_>) -> Vec<Levels> {
    let components = profile.components();
    let full = Levels::full(components);
    let mut made = vec![Levels::default()];
    for component in components.iter() {
        made.push(Levels::default().with(component, Level::All));
        made.push(full.with(component, Level::Absent));
    }
    if components.contains(Component::Diffuse) {
        made.extend([1, 2].map(|times| full.with(Component::Diffuse, Level::Times(times))));
    }
    let mut known = vec![full.crex()];
    made.retain(|levels| {
        let text = levels.crex();
        let new = !known.contains(&text);
        known.push(text);
        new
    });
    made
}

fn measure_scene(stage: &Stage, group: &str, name: &str) -> Result<Vec<Row>, String> {
    let screen = Display::of_the_paper();
    // A picture as wide as the screen, and so its small copies.
    let display = screen.with_larger_pixels(f64::from(screen.width_px) / WIDTH as f64);
    // Costs have no part in the fit.
    let clock = ManualClock::default();
    let small = Settings { seed: 0, ..stage.settings.clone() };
    let Stage { scene, aggregate, view, .. } = stage;
    let question =
        Question { scene, aggregate, view, settings: &small, display: &display, exposure: None, clock: &clock };
    let profile = Profile::new(question).map_err(|error| error.to_string())?;
    let full = render(stage, &Levels::full(profile.components()).crex())?;
    let mut rows = Vec::new();
    for levels in candidates(&profile) {
        let (small, small_full, small_display) = profile.small(&levels).map_err(|error| error.to_string())?;
        let predictors = Predictors::measure(small_full, &small, small_display, profile.exposure())
            .map_err(|error| error.to_string())?;
        let fewer = render(stage, &levels.crex())?;
        let exposure = profile.exposure();
        let loss_jod = 10.0 - compare::jod(&full, &fewer, &display, exposure).map_err(|error| error.to_string())?.jod;
        eprintln!("  {:<24} JOD loss {loss_jod:.3}, foreseen {:.3}", levels.crex(), predictors.jod);
        rows.push(Row {
            group: group.to_owned(),
            scene: name.to_owned(),
            crex: levels.crex(),
            predictors: predictors.values(),
            loss_jod: loss_jod.max(0.0),
        });
    }
    Ok(rows)
}

fn render(stage: &Stage, crex: &str) -> Result<Picture, String> {
    let program = Program::new(&crex::parse(crex).map_err(|_| format!("`{crex}` is no crex"))?);
    let clock = ManualClock::default();
    let Stage { scene, aggregate, view, settings } = stage;
    let renderer = Renderer::new(scene, aggregate, view, &program, &clock, settings.clone());
    let rendering = renderer.and_then(|renderer| renderer.render()).map_err(|error| error.to_string())?;
    Ok(Picture::of_radiance(&rendering.film.beauty()))
}
