//! The arrows that ARCHITECTURE.md forbids, the files that alone may name a library, and the size of files.

use std::fs;
use std::path::{Path, PathBuf};

use libtest_mimic::{Failed, Trial};

/// Which modules of the renderer each module may name. A module that is missing here may name none.
const RENDERER_ARROWS: &[(&str, &[&str])] = &[
    ("color", &[]),
    ("component", &[]),
    ("work", &["component"]),
    ("raster", &[]),
    ("math", &[]),
    ("sample", &["math"]),
    ("diagnostic", &[]),
    ("cal", &["diagnostic"]),
    ("rad", &["cal", "diagnostic"]),
    ("crex", &["component", "work"]),
    ("pattern", &["cal", "color", "diagnostic", "math"]),
    ("material", &["component", "color", "math", "pattern", "sample"]),
    ("geometry", &["math"]),
    ("scene", &["rad", "material", "geometry", "color", "component", "math", "pattern", "picture", "cal", "sample"]),
    ("film", &["component", "raster", "color"]),
    ("features", &["raster", "geometry"]),
    (
        "transport",
        &[
            "component",
            "color",
            "math",
            "sample",
            "pattern",
            "material",
            "scene",
            "geometry",
            "film",
            "features",
            "raster",
            "work",
        ],
    ),
    ("reconstruct", &["film", "features", "raster", "color", "component"]),
    ("importance", &["raster", "film", "features", "color", "component", "math"]),
    ("atomic", &[]),
    ("schedule", &["atomic", "component", "crex", "work", "importance"]),
    ("picture", &["atomic", "raster", "color", "component"]),
    ("part", &["component", "crex", "film", "picture", "render", "schedule", "work"]),
    ("trade", &[]),
    ("propose", &["component", "color", "crex", "geometry", "picture", "raster", "render", "scene", "schedule"]),
];

/// A word of code and the only places (path prefixes below the project's root) that may say it.
const ONLY_IN: &[(&str, &[&str])] = &[
    ("obvhs::", &["renderer/src/geometry/aggregate.rs"]),
    ("pulp::", &["renderer/src/geometry/lanes.rs"]),
    ("exr::", &["renderer/src/picture/"]),
    ("image::", &["renderer/src/picture/", "experiment/src/"]),
    ("egui::", &["experiment/src/app", "experiment/src/main.rs", "experiment/tests/"]),
    ("eframe::", &["experiment/src/app", "experiment/src/main.rs", "experiment/tests/"]),
    ("Instant::now", &["renderer/src/schedule/clock.rs", "experiment/src/clock.rs", "experiment/src/main.rs"]),
    ("env::var", &["renderer/src/bin/", "experiment/src/main.rs", "analysis/src/main.rs"]),
    ("process::exit", &["renderer/src/bin/", "experiment/src/main.rs", "analysis/src/main.rs"]),
    ("println!", &["renderer/src/bin/", "experiment/src/main.rs", "analysis/src/main.rs"]),
    ("print!(", &["renderer/src/bin/", "experiment/src/main.rs", "analysis/src/main.rs"]),
    ("thread_rng", &[]),
    ("static mut", &[]),
];

/// Longest source file, in lines: what one can hold in the head.
const LONGEST: usize = 500;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the member lies in the workspace").to_path_buf()
}

fn sources(below: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(below) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// The project's Rust files with their paths from its root, comments and inline test modules left out.
fn code() -> Vec<(String, String)> {
    let root = root();
    let mut paths = Vec::new();
    for member in ["renderer/src", "experiment/src", "analysis/src", "stimuli/src"] {
        sources(&root.join(member), &mut paths);
    }
    paths.sort();
    paths
        .into_iter()
        .map(|path| {
            let text = fs::read_to_string(&path).expect("a source file is readable text");
            let text = text.split("#[cfg(test)]").next().unwrap_or_default();
            let bare: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
            let name = path.strip_prefix(&root).expect("found below the root").to_string_lossy().into_owned();
            (name, bare.join("\n"))
        })
        .collect()
}

fn verdict(broken: Vec<String>) -> Result<(), Failed> {
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n").into()) }
}

fn renderer_arrows() -> Result<(), Failed> {
    let mut broken = Vec::new();
    for (path, text) in code() {
        let Some(inside) = path.strip_prefix("renderer/src/") else { continue };
        let module = inside.split('/').next().unwrap_or(inside).trim_end_matches(".rs");
        if matches!(module, "lib" | "bin" | "render" | "stimuli") {
            continue;
        }
        let allowed = RENDERER_ARROWS.iter().find(|(name, _)| *name == module).map_or(&[][..], |(_, names)| names);
        for named in text.split("crate::").skip(1) {
            let named: String = named.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let known = RENDERER_ARROWS.iter().any(|(name, _)| *name == named) || named == "render";
            if known && named != module && !allowed.contains(&named.as_str()) {
                broken.push(format!("{path}: {module} may not name {named}"));
            }
        }
        if text.contains("use crate::{") {
            broken.push(format!("{path}: write one `use crate::module::..` a module, so that arrows can be read"));
        }
    }
    verdict(broken)
}

fn libraries_in_their_places() -> Result<(), Failed> {
    let mut broken = Vec::new();
    for (path, text) in code() {
        for (word, places) in ONLY_IN {
            let said = text.match_indices(word).any(|(at, _)| {
                !text[..at]
                    .chars()
                    .next_back()
                    .is_some_and(|before| before.is_alphanumeric() || before == '_' || before == ':')
            });
            if said && !places.iter().any(|place| path.starts_with(place)) {
                broken.push(format!("{path}: only {places:?} may say `{word}`"));
            }
        }
    }
    verdict(broken)
}

fn crates_meet_in_files() -> Result<(), Failed> {
    let forbidden: [(&str, &[&str]); 4] = [
        ("stimuli", &["renderer", "experiment", "analysis"]),
        ("analysis", &["renderer", "experiment"]),
        ("experiment", &["renderer"]),
        ("renderer", &["experiment", "analysis"]),
    ];
    let mut broken = Vec::new();
    for (member, others) in forbidden {
        let manifest = fs::read_to_string(root().join(member).join("Cargo.toml")).expect("every member has a manifest");
        for other in others {
            if manifest
                .lines()
                .any(|line| line.starts_with(&format!("{other}.")) || line.starts_with(&format!("{other} =")))
            {
                broken.push(format!("{member} links {other}"));
            }
        }
    }
    verdict(broken)
}

fn files_fit_in_the_head() -> Result<(), Failed> {
    let root = root();
    let mut paths = Vec::new();
    for member in ["renderer", "experiment", "analysis", "stimuli", "tests"] {
        sources(&root.join(member), &mut paths);
    }
    let broken = paths
        .iter()
        .filter(|path| !path.components().any(|part| part.as_os_str() == "target"))
        .filter_map(|path| {
            let lines = fs::read_to_string(path).ok()?.lines().count();
            (lines > LONGEST).then(|| format!("{}: {lines} lines, more than {LONGEST}", path.display()))
        })
        .collect();
    verdict(broken)
}

/// The tests of the house's order.
pub(crate) fn trials() -> Vec<Trial> {
    vec![
        Trial::test("house::renderer_arrows", renderer_arrows),
        Trial::test("house::libraries_in_their_places", libraries_in_their_places),
        Trial::test("house::crates_meet_in_files", crates_meet_in_files),
        Trial::test("house::files_fit_in_the_head", files_fit_in_the_head),
    ]
}
