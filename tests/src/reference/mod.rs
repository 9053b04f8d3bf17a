//! Pictures of the reference scenes against Radiance's converged ones, and crexes against an independent tracer's
//! pictures of every path word.
//!
//! rpict's own settings for these pictures: -st 0 (every rough lobe is traced), -dj 1 (lights sampled over their whole
//! extent), -pj 1 (pixels over theirs), -lr 12 -lw 1e-5 (where paths end), -aa 0 (no irradiance cache). Ours are the
//! same by default but for the ends of paths, which are set here.

pub(crate) mod tables;

use std::path::{Path, PathBuf};

use libtest_mimic::{Failed, Trial};
use regex_lite::Regex;
use renderer::color::brightness;
use renderer::crex;
use renderer::geometry::Aggregate;
use renderer::rad::{self, DiskFiles, Source, ViewSpec};
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::MonotonicClock;
use renderer::transport::Limits;
use tables::{GRID, difference};

/// Pixels on a side of the pictures made here: four times the grid of the tables.
const SIZE: usize = 128;

/// A scene of the reference set, ready to be rendered.
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    pub(crate) aggregate: Aggregate,
    pub(crate) view: View,
}

/// The folder that holds a reference scene: our own are in the project, the Cornell boxes are Radiance's.
fn folder(scene: &str) -> PathBuf {
    if scene.starts_with("cornell") {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/reference/scenes")
    } else {
        tables::data().join("scenes")
    }
}

pub(crate) fn load(scene: &str) -> Result<Loaded, Failed> {
    let path = folder(scene).join(format!("{scene}.rad"));
    let text = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut source = Source::new(path.display().to_string(), text);
    source.folder = folder(scene).display().to_string();
    let files = DiskFiles::new(Vec::new());
    let document = rad::read(&[source], &files, &rad::Options::default()).map_err(|errors| format!("{errors:?}"))?;
    let scene_path = path.with_extension("vf");
    let scene = Scene::from_rad_with(&document, &files).map_err(|errors| format!("{errors:?}"))?;
    let text = std::fs::read_to_string(&scene_path).map_err(|error| format!("{}: {error}", scene_path.display()))?;
    let mut spec = ViewSpec::default();
    spec.take_header("view", &text).map_err(|errors| format!("{errors:?}"))?;
    let view = View::new(spec).map_err(|error| error.to_string())?;
    let aggregate = scene.aggregate();
    Ok(Loaded { scene, aggregate, view })
}

/// Luminance means of the grid's blocks of a picture of a crex.
fn blocks(loaded: &Loaded, expression: &str, samples: u32, diffuse: Option<u32>) -> Result<Vec<f64>, Failed> {
    let program = crex::compile(expression).map_err(|errors| format!("{errors:?}"))?;
    let limits = Limits { reflections: 12, least_weight: 1e-5, diffuse, ..Limits::default() };
    let settings = Settings { samples, seed: 1, limits, ..Settings::new(SIZE, SIZE) };
    let clock = MonotonicClock::start();
    let renderer = Renderer::new(&loaded.scene, &loaded.aggregate, &loaded.view, &program, &clock, settings)?;
    let beauty = renderer.render()?.film.beauty();
    let edge = SIZE / GRID;
    let mut blocks = vec![0.0; GRID * GRID];
    for (index, pixel) in beauty.values().iter().enumerate() {
        let (x, y) = (index % SIZE, index / SIZE);
        blocks[y / edge * GRID + x / edge] += brightness(pixel.as_dvec3()) / (edge * edge) as f64;
    }
    Ok(blocks)
}

/// Mean luminance within 1 %, and 95 % of the blocks within 3 %, or within three times the converged picture's own
/// noise where that is larger.
fn judge(name: &str, (found, expected): (&[f64], &[f64]), noise: f64, absolute: f64) -> Result<(), Failed> {
    let lies = difference(found, expected, f64::max(0.03, 3.0 * noise), absolute);
    println!(
        "{name}: mean {:+.3} %, {:.1} % of blocks agree, worst {:.1} %",
        100.0 * lies.mean,
        100.0 * lies.agreeing,
        100.0 * lies.worst
    );
    if lies.mean.abs() > 0.01 || lies.agreeing < 0.95 {
        return Err(format!(
            "{name}: mean {:+.3} %, {:.1} % of blocks agree, worst {:.1} %",
            100.0 * lies.mean,
            100.0 * lies.agreeing,
            100.0 * lies.worst
        )
        .into());
    }
    Ok(())
}

/// Converged pictures of rpict: name, scene, the crex that traces the same light, `-ab`, samples.
const PICTURES: &[(&str, &str, &str, Option<u32>, u32)] = &[
    ("cornell_direct", "cornell", "", None, 64),
    ("cornell_ab0", "cornell", "(TRSGM)*", None, 64),
    ("cornell_ab1", "cornell", "(TRSGMD)*", Some(1), 256),
    ("cornell_ab2", "cornell", "(TRSGMD)*", Some(2), 256),
    ("room_a_direct", "room_a", "", None, 64),
    ("room_a_ab0", "room_a", "(TRSGM)*", None, 64),
    ("room_a_ab2", "room_a", "(TRSGMD)*", Some(2), 256),
    ("trans_c_ab0", "trans_c", "(TRSGM)*", None, 64),
    ("trans_c_ab2", "trans_c", "(TRSGMD)*", Some(2), 256),
    ("glow_b_ab1", "glow_b", "(TRSGMD)*", Some(1), 256),
    ("extreme_d_ab0", "extreme_d", "(TRSGM)*", None, 64),
    ("extreme_d_ab1", "extreme_d", "(TRSGMD)*", Some(1), 256),
];

/// A picture that rpict made of a scene of this project, with its noise over the blocks themselves (`render.py`).
struct Rendered {
    name: &'static str,
    scene: &'static str,
    crex: &'static str,
    diffuse: Option<u32>,
    samples: u32,
    /// `-dr`.
    relays: u32,
    /// Whether blocks must agree within 3 %, however noisy some are.
    strict: bool,
}

const RENDERED: &[Rendered] = &[
    rendered("relay_e_dr1", "relay_e", 1),
    rendered("relay_e_dr2", "relay_e", 2),
    rendered("mist_f_ab0", "mist_f", 1),
    rendered("fabric_g_ab0", "fabric_g", 1),
    Rendered { crex: "(TRSGMD)*", diffuse: Some(1), samples: 256, ..rendered("fabric_g_ab1", "fabric_g", 1) },
    Rendered { samples: 256, strict: true, ..rendered("glow_b_ab0", "glow_b", 1) },
];

const fn rendered(name: &'static str, scene: &'static str, relays: u32) -> Rendered {
    Rendered { name, scene, crex: "(TRSGM)*", diffuse: None, samples: 128, relays, strict: false }
}

fn against_rendered(rendered: &Rendered) -> Result<(), Failed> {
    let picture = tables::rendered(rendered.name);
    let mut loaded = load(rendered.scene)?;
    loaded.scene.set_relays(rendered.relays);
    let found = blocks(&loaded, rendered.crex, rendered.samples, rendered.diffuse)?;
    let noise = if rendered.strict { 0.0 } else { picture.block_noise };
    judge(rendered.name, (&found, &picture.blocks), noise, 0.0)
}

/// Crexes with the words that they trace: the table to add up, and a pattern that a word must match whole.
const LANGUAGES: &[(&str, &str, &str)] = &[
    ("room_a", "T*", "T*"),
    ("room_a", "(TR)*", "[TR]*"),
    ("room_a", "(TRSM)*", "[TRSM]*"),
    ("room_a_D2", "<MRSGD>T*", "[MRSGD]?T*"),
    ("room_a_D2", "D", "D?"),
    ("room_a_D2", "DD", "D?D?"),
    ("room_a", "(SG)2", "S?G?S?G?"),
    ("room_a", "(TRSGM)*", "[TRSGM]*"),
    ("room_a", "S", "S?"),
    ("room_a", "G", "G?"),
    ("room_a", "M", "M?"),
    ("room_a", "TT<RS>G", "T?T?[RS]?G?"),
    ("room_a", "TTMRG", "T?T?M?R?G?"),
    ("room_a", "(MG)G", "M?G?G?"),
    ("room_a", "<MG>G", "[MG]?G?"),
    ("room_a_D2", "(DG)G", "D?G?G?"),
    ("room_a_D2", "<DG>G", "[DG]?G?"),
    ("room_a_D2", "<D2>M", "D?M?"),
    ("room_a", "(<MRSG>T*)2", "[MRSG]?T*[MRSG]?T*"),
    ("trans_c", "T*", "T*"),
    ("trans_c", "(TSG)2", "T?S?G?T?S?G?"),
    ("trans_c_D2", "D", "D?"),
    ("trans_c_D2", "<SGTD>D", "[SGTD]?D?"),
    ("cornell", "(TR)*", "[TR]*"),
    ("cornell_D2", "D", "D?"),
    ("cornell_D2", "(DT)T", "D?T?T?"),
];

/// What the dim lamps of `extreme_d` light while another of 1e8 shines elsewhere: two panels of 5e-6 and 1e-6, and the
/// walls of two niches at 1e-8, of which no bright light comes. The walls agree within 3 %; a panel
/// shows its own radiance (rpict's picture has 8 bits of it).
fn dim_blocks() -> Result<(), Failed> {
    let found = blocks(&load("extreme_d")?, "(TRSGM)*", 64, None)?;
    let expected = tables::picture("extreme_d_ab0").blocks;
    let dim: Vec<(f64, f64)> = found.into_iter().zip(expected).filter(|&(_, expected)| expected < 1e-5).collect();
    let off = |&(found, expected): &(f64, f64)| (found / expected - 1.0).abs();
    let walls = dim.iter().filter(|(_, expected)| *expected < 5e-7).map(off).fold(0.0, f64::max);
    let panel = |found: f64| f64::min((found / 5e-6 - 1.0).abs(), (found / 1e-6 - 1.0).abs());
    let panels =
        dim.iter().filter(|(_, expected)| *expected > 5e-7).map(|&(found, _)| panel(found)).fold(0.0, f64::max);
    println!("extreme_d: {} dim blocks, walls off by at most {walls:.1e}, panels by {panels:.1e}", dim.len());
    if dim.len() == 8 && walls <= 0.03 && panels <= 1e-6 { Ok(()) } else { Err(format!("{dim:?}").into()) }
}

/// Noise of the word tables, over 8x8 pixel blocks, relative to the picture's mean: the largest that their makers give
/// for a sum of words without and with D.
const WORD_NOISE: [f64; 2] = [0.0048, 0.0175];

fn against_words(table: &str, expression: &str, pattern: &str) -> Result<(), Failed> {
    let loaded = load(table.trim_end_matches("_D2"))?;
    let language = Regex::new(&format!("^({pattern})$"))?;
    let mut expected = vec![0.0; GRID * GRID];
    for (_, picture) in tables::words(table).iter().filter(|(word, _)| language.is_match(word)) {
        expected.iter_mut().zip(picture).for_each(|(sum, block)| *sum += block);
    }
    let mean = expected.iter().sum::<f64>() / expected.len() as f64;
    let noise = WORD_NOISE[usize::from(table.ends_with("_D2"))];
    let samples = if expression.contains('D') { 256 } else { 64 };
    let found = blocks(&loaded, expression, samples, None)?;
    judge(&format!("{table} {expression}"), (&found, &expected), 0.0, 3.0 * noise * mean)
}

pub(crate) fn trials() -> Vec<Trial> {
    let absent = |scene: &str| !folder(scene).join(format!("{}.rad", scene.trim_end_matches("_D2"))).exists();
    let pictures = PICTURES.iter().map(|&(name, scene, expression, diffuse, samples)| {
        Trial::test(format!("reference::picture::{name}"), move || {
            let picture = tables::picture(name);
            let found = blocks(&load(scene)?, expression, samples, diffuse)?;
            judge(name, (&found, &picture.blocks), picture.block_noise, 0.0)
        })
        .with_ignored_flag(absent(scene))
    });
    let languages = LANGUAGES.iter().map(|&(table, expression, pattern)| {
        Trial::test(format!("reference::words::{table}::{expression}"), move || {
            against_words(table, expression, pattern)
        })
        .with_ignored_flag(absent(table))
    });
    let dim = Trial::test("reference::extreme_d_dim", dim_blocks);
    let rendered = RENDERED.iter().map(|rendered| {
        Trial::test(format!("reference::rendered::{}", rendered.name), move || against_rendered(rendered))
    });
    pictures.chain(rendered).chain(languages).chain([dim]).collect()
}
