//! The manifest: which picture was made from what, and whether it still is what would be made.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Mistake, Result};
use crate::hash::Sha256;
use crate::study::{MapRequest, Request, Study};

/// The name of the manifest in a study's folder.
pub const FILE_NAME: &str = "manifest.json";

/// What was rendered for a study. `pictures` is the same on every machine; `timings` is not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The study's id.
    pub study: String,
    /// The pictures by id ([`crate::Stimulus::id`]).
    pub pictures: BTreeMap<String, PictureRecord>,
    /// The importance maps that were made, by their files.
    #[serde(default)]
    pub maps: BTreeMap<PathBuf, MapRecord>,
    /// What making them took, by the same ids.
    #[serde(default)]
    pub timings: BTreeMap<String, Timing>,
}

/// One picture: how it was asked for, what was read, what came out. Nothing here depends on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureRecord {
    /// The layout's id.
    pub layout: String,
    /// The quality's name.
    pub quality: String,
    /// The picture's file, relative to the study's folder.
    pub file: PathBuf,
    /// The digest of that file.
    pub sha256: Sha256,
    /// What was asked for.
    pub request: Request,
    /// Digests of all files that were read: scenes and what they include, view, importance map; relative to the study's
    /// folder.
    pub inputs: BTreeMap<PathBuf, Sha256>,
    /// Rays traced: `primary`, and each component's letter.
    pub rays: BTreeMap<String, u64>,
    /// Mean luminance of the picture before the display transfer, cd/m2.
    pub mean_luminance_cd_m2: f64,
    /// The renderer that made it: name and version.
    pub version: String,
}

/// One importance map: how it was asked for, what was read, what came out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapRecord {
    /// The digest of its file.
    pub sha256: Sha256,
    /// What was asked for.
    pub request: MapRequest,
    /// Digests of all files that were read; relative to the study's folder.
    pub inputs: BTreeMap<PathBuf, Sha256>,
    /// The renderer that made it: name and version.
    pub version: String,
}

/// What making a picture took, on the machine that made it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Wall-clock time from reading the scene to the written picture, seconds.
    pub seconds: f64,
    /// Threads that traced.
    pub threads: usize,
}

/// Whether a picture is what would be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureStatus {
    /// Made from these inputs by this request, and unaltered.
    Fresh,
    /// There is no picture, or the manifest does not know it.
    Missing,
    /// The file is not the one that was written.
    Altered,
    /// It was made from something else: what has changed since, one word or path each.
    Stale(Vec<String>),
}

impl Manifest {
    /// Reads the manifest of a study's folder; an empty one if there is none.
    ///
    /// # Errors
    /// If the file cannot be read or is not a manifest.
    pub fn load(folder: &Path) -> Result<Self> {
        let file = folder.join(FILE_NAME);
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => return Err(Error::io("read", &file, error)),
        };
        serde_json::from_str(&text).map_err(|error| {
            let help = "It is written by `crex stimuli`; remove it and run that again.".to_owned();
            let (line, column) = (error.line(), error.column().max(1));
            Error::Wrong(vec![Mistake { file, line, column, message: error.to_string(), help }])
        })
    }

    /// Writes the manifest into a study's folder: beside it first, then renamed, so that no half of it is ever there.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, folder: &Path) -> Result<()> {
        let file = folder.join(FILE_NAME);
        let beside = folder.join(format!(".{FILE_NAME}.part"));
        let mut text = serde_json::to_string_pretty(self)
            .map_err(|error| Error::io("write", &file, std::io::Error::other(error)))?;
        text.push('\n');
        std::fs::write(&beside, text).map_err(|error| Error::io("write", &beside, error))?;
        std::fs::rename(&beside, &file).map_err(|error| Error::io("write", &file, error))
    }

    /// The digest of everything but the timings: the same wherever the same pictures were made.
    ///
    /// # Errors
    /// If a path is not Unicode.
    pub fn hash(&self) -> Result<Sha256> {
        let text = serde_json::to_string(&(&self.study, &self.pictures))
            .map_err(|error| Error::io("hash", Path::new(FILE_NAME), std::io::Error::other(error)))?;
        Ok(Sha256::of(text.as_bytes()))
    }

    /// Compares every picture that the study shows with what would be made by `version`, in the order of
    /// [`Study::stimuli`].
    ///
    /// # Errors
    /// If a file that is there cannot be read.
    pub fn check(&self, study: &Study, version: &str) -> Result<Vec<(String, PictureStatus)>> {
        study
            .stimuli()
            .into_iter()
            .filter_map(|stimulus| Some((stimulus.id(), study.request(&stimulus)?)))
            .map(|(id, request)| {
                let status = self.status(&study.folder, &id, &request, version)?;
                Ok((id, status))
            })
            .collect()
    }

    /// Whether the picture `id` is what `request` would make.
    ///
    /// # Errors
    /// If a file that is there cannot be read.
    pub fn status(&self, folder: &Path, id: &str, request: &Request, version: &str) -> Result<PictureStatus> {
        let Some(record) = self.pictures.get(id) else { return Ok(PictureStatus::Missing) };
        let changed = request_changes(&record.request, request);
        status(folder, &record.file, record.sha256, changed, (&record.version, version), &record.inputs)
    }

    /// Whether the importance map in `file` is what `request` would make.
    ///
    /// # Errors
    /// If a file that is there cannot be read.
    pub fn map_status(&self, folder: &Path, file: &Path, request: &MapRequest, version: &str) -> Result<PictureStatus> {
        let Some(record) = self.maps.get(file) else { return Ok(PictureStatus::Missing) };
        let changed = if record.request == *request { Vec::new() } else { vec!["the plan of the map".to_owned()] };
        status(folder, file, record.sha256, changed, (&record.version, version), &record.inputs)
    }
}

/// Whether a file is what would be made, given what has `changed` in how it is asked for.
fn status(
    folder: &Path,
    file: &Path,
    written: Sha256,
    mut changed: Vec<String>,
    (was, now): (&str, &str),
    inputs: &BTreeMap<PathBuf, Sha256>,
) -> Result<PictureStatus> {
    let Some(found) = digest_if_there(&folder.join(file))? else { return Ok(PictureStatus::Missing) };
    if was != now {
        changed.push(format!("version ({was}, now {now})"));
    }
    for (input, digest) in inputs {
        if digest_if_there(&folder.join(input))? != Some(*digest) {
            changed.push(input.display().to_string());
        }
    }
    Ok(if !changed.is_empty() {
        PictureStatus::Stale(changed)
    } else if found != written {
        PictureStatus::Altered
    } else {
        PictureStatus::Fresh
    })
}

fn digest_if_there(path: &Path) -> Result<Option<Sha256>> {
    match Sha256::of_file(path) {
        Ok(digest) => Ok(Some(digest)),
        Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// The names of the fields in which two requests differ.
fn request_changes(was: &Request, is: &Request) -> Vec<String> {
    let fields = [
        ("scene", was.scene == is.scene),
        ("view", was.view == is.view),
        ("size", (was.width_px, was.height_px) == (is.width_px, is.height_px)),
        ("crex", was.crex == is.crex),
        ("spp", was.spp == is.spp),
        ("seed", was.seed == is.seed),
        ("exposure", was.exposure == is.exposure),
        ("ambient", was.ambient == is.ambient),
        ("importance", was.importance == is.importance),
        ("thresholds", was.thresholds == is.thresholds),
        ("options", was.options == is.options),
    ];
    fields.into_iter().filter(|(_, same)| !same).map(|(name, _)| name.to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str = include_str!("../corridor/study.toml");

    /// A folder with a study, its inputs, one picture and the manifest that knows it.
    fn made() -> (tempfile::TempDir, Study, Manifest) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("pictures")).unwrap();
        std::fs::write(folder.path().join("study.toml"), STUDY).unwrap();
        std::fs::write(folder.path().join("layout_a.rad"), "void light l 0 0 3 1 1 1").unwrap();
        std::fs::write(folder.path().join("pictures/a_hq.png"), "a picture").unwrap();
        let study = Study::load(folder.path()).unwrap();
        let stimulus = study.stimuli().remove(0);
        let record = PictureRecord {
            layout: stimulus.layout.clone(),
            quality: stimulus.quality.clone(),
            file: stimulus.file(),
            sha256: Sha256::of(b"a picture"),
            request: study.request(&stimulus).unwrap(),
            inputs: BTreeMap::from([("layout_a.rad".into(), Sha256::of(b"void light l 0 0 3 1 1 1"))]),
            rays: BTreeMap::from([("primary".to_owned(), 1)]),
            mean_luminance_cd_m2: 1.5,
            version: "v".to_owned(),
        };
        let timing = Timing { seconds: 2.0, threads: 1 };
        let manifest = Manifest {
            study: study.id.clone(),
            pictures: BTreeMap::from([(stimulus.id(), record)]),
            maps: BTreeMap::new(),
            timings: BTreeMap::from([(stimulus.id(), timing)]),
        };
        (folder, study, manifest)
    }

    fn first_status(manifest: &Manifest, study: &Study) -> PictureStatus {
        manifest.check(study, "v").unwrap().remove(0).1
    }

    #[test]
    fn a_picture_is_fresh_until_something_changes() {
        let (folder, study, manifest) = made();
        assert_eq!(first_status(&manifest, &study), PictureStatus::Fresh);

        std::fs::write(folder.path().join("pictures/a_hq.png"), "painted over").unwrap();
        assert_eq!(first_status(&manifest, &study), PictureStatus::Altered);

        std::fs::remove_file(folder.path().join("pictures/a_hq.png")).unwrap();
        assert_eq!(first_status(&manifest, &study), PictureStatus::Missing);
        assert_eq!(first_status(&Manifest::default(), &study), PictureStatus::Missing);
    }

    #[test]
    fn every_change_of_what_a_picture_was_made_from_is_named() {
        let (folder, mut study, manifest) = made();
        std::fs::write(folder.path().join("layout_a.rad"), "void light l 0 0 3 9 9 9").unwrap();
        study.layouts[0].exposure *= 2.0;
        study.qualities[0].crex = "D".to_owned();
        let changed = ["crex", "exposure", "layout_a.rad"].map(str::to_owned).to_vec();
        assert_eq!(first_status(&manifest, &study), PictureStatus::Stale(changed));
        assert_eq!(
            made().2.check(&study, "w").unwrap()[0].1,
            PictureStatus::Stale(
                ["crex", "exposure", "version (v, now w)", "layout_a.rad"].map(str::to_owned).to_vec()
            )
        );
        std::fs::remove_file(folder.path().join("layout_a.rad")).unwrap();
        assert!(matches!(first_status(&manifest, &study), PictureStatus::Stale(changed) if changed.len() == 3));
    }

    #[test]
    fn a_change_of_words_makes_no_picture_stale() {
        let (_folder, mut study, manifest) = made();
        study.wording.worse = "Which?".to_owned();
        study.arms[0].n = 20;
        assert_eq!(first_status(&manifest, &study), PictureStatus::Fresh);
    }

    #[test]
    fn a_manifest_comes_back_as_it_was_saved_and_its_hash_ignores_timings() {
        let (folder, _, mut manifest) = made();
        manifest.save(folder.path()).unwrap();
        assert_eq!(Manifest::load(folder.path()).unwrap(), manifest);
        let hash = manifest.hash().unwrap();
        manifest.timings.clear();
        assert_eq!(manifest.hash().unwrap(), hash);
        manifest.pictures.clear();
        assert_ne!(manifest.hash().unwrap(), hash);
    }

    #[test]
    fn what_is_no_manifest_is_reported_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(FILE_NAME), "{\n\"study\": 3}").unwrap();
        let error = Manifest::load(folder.path()).unwrap_err();
        assert!(error.is_input());
        assert!(error.to_string().contains("manifest.json:2:"), "{error}");
    }
}
