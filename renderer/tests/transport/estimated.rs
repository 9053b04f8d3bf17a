//! Estimates of whole crexes from a few complete paths, against the rays that the rendering then traces.

use std::path::Path;

use renderer::component::Component;
use renderer::rad::{self, DiskFiles, Source, ViewSpec};
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::{Budget, ProfileCache, estimate};
use renderer::transport::Limits;

use crate::Stage;
use crate::limited::Ticking;

/// A shipped scene.
fn shipped(folder: &str, files: &[&str], view: &str) -> Stage {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../stimuli").join(folder);
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let place = folder.display().to_string();
    let source = |name: &&str| Source { folder: place.clone(), ..Source::new(*name, text(name)) };
    let sources: Vec<Source> = files.iter().map(source).collect();
    let document = rad::read(&sources, &DiskFiles::new(Vec::new()), &rad::Options::default()).unwrap();
    let scene = Scene::from_rad(&document).unwrap();
    let mut spec = ViewSpec::default();
    text(view).lines().for_each(|line| _ = spec.take_header("view", line).unwrap());
    Stage { aggregate: scene.aggregate(), view: View::new(spec).unwrap(), scene }
}

/// With Radiance's default limits diffuse paths run on for dozens of generations, of which the late ones spawn less: what
/// rounds teach that are cut short after the first ones must not be taken for all.
#[test]
fn the_rays_of_a_crex_are_those_of_complete_paths() {
    let corridor = || shipped("corridor", &["materials.rad", "shell.rad", "layout_a.rad"], "corridor.vf");
    let scenes = [
        ("corridor", corridor()),
        ("cornell", shipped("cornell", &["cornell.rad"], "cornell.vf")),
        ("library", shipped("library", &["library.rad"], "library.vf")),
    ];
    let study = Limits { reflections: -12, least_weight: 0.2, ..Limits::default() };
    for (name, stage) in scenes {
        for (limits, crex) in
            [(Limits::default(), "(TRSGMD)*"), (study, "(TRSGMD)*"), (Limits::default(), "T[RS](GM)D2")]
        {
            // One thread, so that the ticking clock gives the same number of paths each time.
            let settings = Settings { limits, threads: Some(1), ..Settings::new(32, 26) };
            let program = renderer::crex::compile(crex).unwrap();
            let clock = Ticking::default();
            let Stage { scene, aggregate, view } = &stage;
            let renderer = Renderer::new(scene, aggregate, view, &program, &clock, settings.clone()).unwrap();
            let mut profile = ProfileCache::new("scene", "machine");
            // Looks at the clock for a sprinkle, a round that is cut short, and some hundred paths.
            renderer.render_within(Budget::new(&clock, 8.0, 0.0), &mut profile).unwrap();
            let paths = renderer::render::paths(&program, &settings.limits);
            let primary = (settings.width * settings.height) as u64;
            let estimate = estimate(&program, None, primary, |_| 1.0, (&profile, &paths)).unwrap();
            assert!(!estimate.endless, "{name} {crex}");
            let truth = renderer.render().unwrap();
            for component in Component::ALL {
                let rows = truth.stages.iter().filter(|row| row.stage.component == component);
                let traced = rows.map(|row| row.report.rays).sum::<u64>() as f64;
                let found = estimate.components[component].rays;
                println!(
                    "{name} {crex} {component}: {found:.0} estimated, {traced} traced, {} paths",
                    profile.paths_seen(&paths)
                );
                if traced >= 1000.0 {
                    assert!(
                        (traced / 2.0..=traced * 2.0).contains(&found),
                        "{name} {crex} {component}: {found} of {traced}"
                    );
                }
            }
        }
    }
}
