//! Patterns, textures, mixtures and materials that functions decide, against what Radiance's rtrace shows of each.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use libtest_mimic::{Failed, Trial};
use renderer::crex;
use renderer::rad::{self, DiskFiles, Source, ViewSpec};
use renderer::raster::Raster;
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::MonotonicClock;

use crate::reference::tables::data;

/// Pixels a tile.
const TILE: usize = 6;

/// rtrace writes 7 digits, computes colours in `f32`, and a sun of 1e-3 degrees is a point of it or all of it.
const RELATIVE: f64 = 2e-4;

/// Of values up to 1.
const ABSOLUTE: f64 = 2e-6;

/// What a crex without a letter shows of a scene in `tests/data/patterns` from (4, 3, 9) down, through the pixels' centres.
fn rendered(scene: &str, [width, height]: [usize; 2]) -> Result<Raster<Vec3>, Failed> {
    let folder = data().join("patterns");
    let path = folder.join(scene);
    let text = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let source = Source { folder: folder.display().to_string(), ..Source::new(scene, text) };
    let files = DiskFiles::new(Vec::new());
    let document = rad::read(&[source], &files, &rad::Options::default()).map_err(|errors| format!("{errors:?}"))?;
    let scene = Scene::from_rad_with(&document, &files).map_err(|errors| format!("{errors:?}"))?;
    let field = |pixels: usize| 2.0 * (pixels as f64 / TILE as f64 / 2.0 / 9.0).atan().to_degrees();
    let view = ViewSpec {
        point: [4.0, 3.0, 9.0],
        direction: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        horizontal: field(width),
        vertical: field(height),
        ..ViewSpec::default()
    };
    let view = View::new(view).map_err(|error| error.to_string())?;
    let program = crex::compile("").map_err(|errors| format!("{errors:?}"))?;
    let settings = Settings { jitter: 0.0, ..Settings::new(width, height) };
    let aggregate = scene.aggregate();
    let clock = MonotonicClock::start();
    let renderer = Renderer::new(&scene, &aggregate, &view, &program, &clock, settings)?;
    Ok(renderer.render()?.film.beauty())
}

/// Compares a picture with the table of that name; says of every tile how much of it differs, and by how much.
fn compare(name: &str, size: [usize; 2], tiles: usize) -> Result<(), Failed> {
    let picture = rendered(&format!("{name}.rad"), size)?;
    let path = data().join("patterns").join(format!("{name}.csv"));
    let table = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut wrong: BTreeMap<&str, (usize, String)> = BTreeMap::new();
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for line in table.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let [tile, x, y, red, green, blue] = words[..] else { return Err(format!("{name}.csv: {line}").into()) };
        let (x, y): (usize, usize) = (x.parse()?, y.parse()?);
        let expected = DVec3::new(red.parse()?, green.parse()?, blue.parse()?);
        let found = picture.values()[(size[1] - 1 - y) * size[0] + x].as_dvec3();
        *seen.entry(tile).or_default() += 1;
        if ((found - expected).abs() - expected.abs() * RELATIVE).max_element() > ABSOLUTE {
            let entry = wrong.entry(tile).or_default();
            entry.0 += 1;
            entry.1 = format!("at {x} {y}: {found}, rtrace {expected}");
        }
    }
    if seen.len() != tiles || seen.values().any(|&count| count != TILE * TILE) {
        return Err(format!("{name}.csv holds {} tiles, not all of them whole", seen.len()).into());
    }
    if wrong.is_empty() { Ok(()) } else { Err(format!("{wrong:#?}").into()) }
}

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        Trial::test("patterns::tiles_show_what_rtrace_shows", || compare("tiles", [48, 36], 43)),
        Trial::test("patterns::mirrors_send_on_what_rtrace_shows", || compare("relay", [48, 36], 48)),
        Trial::test("patterns::nested_instances_show_what_rtrace_shows", || compare("nested", [48, 36], 48)),
    ]
}
