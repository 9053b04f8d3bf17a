//! Makes the task maps of a study: for every layout with an importance map, a grey PNG that is 1 on and around the items that
//! count, and falls off from there as sight does (paper, section 4.1 and Figure 5, left and middle).
//!
//! `cargo run --release -p renderer --example task_map -- stimuli/corridor`
//!
//! A pixel shows an item if one of 4 x 4 rays through it meets one of the item's surfaces first; a pane hides what is behind.
//! Around them the map is 1 within the fovea (2 degrees across) and then the relative resolution of Guenter and others 2012.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use renderer::geometry::Aggregate;
use renderer::importance::fovea::{Falloff, Fovea};
use renderer::importance::map::ImportanceMap;
use renderer::picture::{Provenance, grey};
use renderer::rad::{self, DiskFiles, Files, ViewSpec};
use renderer::raster::Raster;
use renderer::scene::{Scene, View};
use stimuli::{Layout, Study};

/// Rays through a pixel are a grid of this many a side.
const RAYS_A_SIDE: usize = 4;

fn main() -> ExitCode {
    let Some(study) = std::env::args_os().nth(1) else {
        eprintln!("usage: task_map STUDY");
        return ExitCode::from(2);
    };
    match make_maps(Path::new(&study)) {
        Ok(made) => {
            made.iter().for_each(|file| println!("{}", file.display()));
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn make_maps(study: &Path) -> Result<Vec<PathBuf>, String> {
    let study = Study::load(study).map_err(|error| error.to_string())?;
    let fovea =
        Fovea { diameter_deg: 2.0, falloff: Falloff::MinimumAngle, px_per_deg: study.display.pixels_per_degree() };
    let mut made = Vec::new();
    for layout in &study.layouts {
        let Some(file) = layout.importance.as_ref().map(|file| study.folder.join(file)) else { continue };
        let items = items(&study, layout)?;
        let map = ImportanceMap::of_task(&items, &fovea);
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        let provenance = Provenance {
            software: concat!("crex task_map ", env!("CARGO_PKG_VERSION")).to_owned(),
            options: Some(format!("{fovea:?}")),
            ..Provenance::default()
        };
        grey::write(&file, map.values(), &provenance).map_err(|error| error.to_string())?;
        made.push(file);
    }
    Ok(made)
}

/// The pixels that show an item that counts.
fn items(study: &Study, layout: &Layout) -> Result<Raster<bool>, String> {
    let (scene, view) = (read_scene(study, layout)?, read_view(study, layout)?);
    let aggregate = scene.aggregate();
    let counts: Vec<bool> = scene
        .surfaces
        .iter()
        .map(|surface| {
            let name = scene.name(surface.name);
            let kind = name.split('.').next().unwrap_or(name);
            study.task.kinds.iter().any(|known| known.objects == kind)
        })
        .collect();
    let (width, height) = (study.display.width_px as usize, study.display.height_px as usize);
    let mut shown = Raster::filled(width, height, false);
    for y in 0..height {
        for x in 0..width {
            *shown.at_mut(x, y) = shows_item(&view, &aggregate, &counts, (x, y), (width, height));
        }
    }
    Ok(shown)
}

fn shows_item(
    view: &View,
    aggregate: &Aggregate,
    counts: &[bool],
    (x, y): (usize, usize),
    (width, height): (usize, usize),
) -> bool {
    let offset = |i: usize| (i as f64 + 0.5) / RAYS_A_SIDE as f64;
    (0..RAYS_A_SIDE * RAYS_A_SIDE).any(|i| {
        let (u, v) = (x as f64 + offset(i % RAYS_A_SIDE), y as f64 + offset(i / RAYS_A_SIDE));
        let hit = view.ray(u / width as f64, v / height as f64).and_then(|ray| aggregate.closest(&ray));
        hit.is_some_and(|hit| counts[hit.surface.index()])
    })
}

fn read_scene(study: &Study, layout: &Layout) -> Result<Scene, String> {
    let files = DiskFiles::default();
    let sources: Result<Vec<rad::Source>, String> = layout
        .scene
        .iter()
        .map(|file| {
            let path = study.folder.join(file).display().to_string();
            files.find(&path, "").map(rad::Source::from).map_err(|why| format!("{path} {why}"))
        })
        .collect();
    let document = rad::read(&sources?, &files, &rad::Options::default()).map_err(|errors| all(&errors))?;
    Scene::from_rad(&document).map_err(|errors| all(&errors))
}

fn read_view(study: &Study, layout: &Layout) -> Result<View, String> {
    let path = study.folder.join(&layout.view);
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut spec = ViewSpec::default();
    spec.take_header(&path.display().to_string(), &text).map_err(|errors| all(&errors))?;
    View::new(spec).map_err(|error| format!("{}: {error}", path.display()))
}

fn all(errors: &[rad::Error]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
