//! The importance maps of a study: made before the pictures that they modulate.
//!
//! A map of a study is exactly what `crex importance` makes of the words that [`words`] gives.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ::stimuli::{Manifest, MapRecord, MapRequest, PictureStatus, Sha256, Study};
use renderer::schedule::MonotonicClock;

use super::{failure, inputs, parsed, version, word};
use crate::console::{self, Failure};
use crate::{Command, importance};

/// A map that a picture needs.
pub(super) struct Map {
    pub(super) file: PathBuf,
    request: MapRequest,
    pub(super) status: PictureStatus,
}

/// The maps of the layouts in `needed`, given by their files.
pub(super) fn maps(study: &Study, manifest: &Manifest, needed: &[PathBuf]) -> Result<Vec<Map>, Failure> {
    let all = study.maps().into_iter().filter(|(file, _)| needed.contains(file));
    all.map(|(file, request)| {
        let status = manifest.map_status(&study.folder, &file, &request, &version()).map_err(failure)?;
        Ok(Map { file, request, status })
    })
    .collect()
}

/// Makes those that are not what would be made, or all if `force`.
pub(super) fn make(
    study: &Study,
    maps: &[Map],
    manifest: &mut Manifest,
    force: bool,
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    let made_here = study.maps();
    manifest.maps.retain(|file, _| made_here.iter().any(|(known, _)| known == file));
    for map in maps.iter().filter(|map| force || map.status != PictureStatus::Fresh) {
        console::say("note", &format!("{}: {}", map.file.display(), word(&map.status)));
        let path = study.folder.join(&map.file);
        // Only what was made here is ours to overwrite: a map may have been drawn by hand.
        let written = manifest.maps.get(&map.file).map(|record| record.sha256);
        if !force && path.exists() && Sha256::of_file(&path).ok() != written {
            return Err(Failure::input(format!(
                "{}: this map was not made by `crex stimuli`, or was altered since: rename it, take [importance] out of the \
                 study file to use it as it is, or say --force",
                path.display()
            )));
        }
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|error| Failure::Cannot(format!("{}: {error}", folder.display())))?;
        }
        let (Command::Importance(args), radiance) = parsed(words(&map.request, &study.folder, &path))? else {
            unreachable!("the words begin with `crex importance`")
        };
        let made = importance::run(&args, &radiance, clock).map_err(|failure| match failure {
            Failure::Input(message) => Failure::Input(format!("{}: {message}", map.file.display())),
            other => other,
        })?;
        let record = MapRecord {
            sha256: Sha256::of_file(&path).map_err(failure)?,
            request: map.request.clone(),
            inputs: inputs(study, [&map.request.view], &made.files)?,
            version: version(),
        };
        if manifest.study.is_empty() {
            manifest.study.clone_from(&study.id);
        }
        manifest.maps.insert(map.file.clone(), record);
        manifest.save(&study.folder).map_err(failure)?;
    }
    Ok(())
}

/// The words behind `crex` that make a map.
fn words(request: &MapRequest, folder: &Path, map: &Path) -> Vec<OsString> {
    let mut words: Vec<OsString> = vec!["crex".into(), "importance".into()];
    words.extend(request.scene.iter().map(|file| folder.join(file).into()));
    words.extend(["-vf".into(), folder.join(&request.view).into()]);
    words.extend(["-x".into(), request.width_px.to_string().into()]);
    words.extend(["-y".into(), request.height_px.to_string().into()]);
    words.push("-av".into());
    words.extend(request.ambient.iter().map(|channel| channel.to_string().into()));
    let (task, salient) = (request.saliency_weight < 1.0, request.saliency_weight > 0.0);
    if task {
        words.extend(["--task".into(), request.objects.join(",").into()]);
        words.extend(["--fovea".into(), request.fovea_deg.to_string().into()]);
        words.extend(["--falloff".into(), request.falloff.name().into()]);
        words.extend(["--px-per-deg".into(), request.px_per_deg.to_string().into()]);
    }
    if salient {
        words.extend(["--saliency".into(), "--exposure".into(), request.exposure.to_string().into()]);
    }
    if task && salient {
        words.extend(["--weight".into(), request.saliency_weight.to_string().into()]);
    }
    words.extend(["-o".into(), map.into()]);
    words
}
