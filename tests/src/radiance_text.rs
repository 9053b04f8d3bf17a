//! Scenes, function files and views of Radiance's distribution, as far as they lie beside the project: every one is read.

use std::fs;
use std::path::{Path, PathBuf};

use libtest_mimic::{Failed, Trial};
use renderer::cal::{Dialect, Functions};
use renderer::rad::{self, DiskFiles, Files, Options, Rif, Source, ViewSpec};

/// Scenes that ask for files or programs that are not there: a compressed file, a program that writes BSDFs, octrees that
/// are made beforehand.
const IMPOSSIBLE: &[&str] = &[];

/// Input files of rad(1) that name no scene of their own.
const WITHOUT_SCENE: &[&str] = &[];

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes")
}

fn below(folder: &Path, wanted: &dyn Fn(&Path) -> bool) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if wanted(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

fn text(path: &Path) -> Result<String, Failed> {
    Ok(fs::read(path)?.iter().copied().map(char::from).collect())
}

fn source(path: &Path) -> Result<Source, Failed> {
    Ok(DiskFiles::default().find(&path.to_string_lossy(), "")?.into())
}

/// Every scene that a rad input file names is read whole: its commands run, its names bound.
fn rif(path: &Path) -> Result<(), Failed> {
    let source = source(path)?;
    let rif = Rif::read(&source).map_err(|errors| errors[0].to_string())?;
    let files = DiskFiles::new(vec![scenes().join("lib")]);
    let texts = rif.scene(&files, &source.folder).map_err(|errors| errors[0].to_string())?;
    if texts.is_empty() {
        return Err("names no scene".into());
    }
    let document = rad::read(&texts, &files, &Options::default()).map_err(|errors| errors[0].to_string())?;
    if document.primitives.is_empty() {
        return Err("holds no primitives".into());
    }
    for view in rif.views() {
        let mut spec = ViewSpec::default();
        let mut left = view.options.as_slice();
        while !left.is_empty() {
            left = &left[spec.take_option(left)?.max(1)..];
        }
    }
    Ok(())
}

fn function_file(path: &Path) -> Result<(), Failed> {
    let mut functions = Functions::new(Dialect::Ray);
    functions.define_file(&path.to_string_lossy(), &text(path)?).map_err(|errors| errors[0].to_string().into())
}

fn view_file(path: &Path) -> Result<(), Failed> {
    let mut view = ViewSpec::default();
    match view.take_header(&path.to_string_lossy(), &text(path)?) {
        Ok(0) => Err("holds no view".into()),
        Ok(_) => Ok(()),
        Err(errors) => Err(errors[0].to_string().into()),
    }
}

fn trials_of(sort: &str, paths: Vec<PathBuf>, read: fn(&Path) -> Result<(), Failed>) -> Vec<Trial> {
    let root = scenes();
    paths
        .into_iter()
        .map(|path| {
            let name = path.strip_prefix(&root).unwrap_or(&path).display().to_string();
            let skipped = IMPOSSIBLE.contains(&name.as_str()) || WITHOUT_SCENE.contains(&name.as_str());
            Trial::test(format!("radiance_text::{sort}::{name}"), move || read(&path)).with_ignored_flag(skipped)
        })
        .collect()
}

/// One trial a file; one that is ignored where Radiance's files are absent.
pub(crate) fn trials() -> Vec<Trial> {
    let root = scenes();
    if !root.is_dir() {
        return vec![Trial::test("radiance_text", || Ok(())).with_ignored_flag(true)];
    }
    let mut trials = trials_of("rif", below(&root, &|path| has_extension(path, "rif")), rif);
    trials.extend(trials_of("cal", below(&root, &|path| has_extension(path, "cal")), function_file));
    let views = |path: &Path| {
        has_extension(path, "vf") || has_extension(path, "vp") || path.parent().is_some_and(|folder| folder.ends_with("vf"))
    };
    trials.extend(trials_of("view", below(&root, &views), view_file));
    trials
}
