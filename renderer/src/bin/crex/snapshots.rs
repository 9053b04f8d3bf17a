//! `--snapshots`: the picture after the primary rays and after each stage.

use std::path::{Path, PathBuf};

use renderer::picture::Provenance;
use renderer::render::Snapshot;

use crate::console::Failure;
use crate::{output, render};

/// Writes snapshots as they come; the first failure is kept for the end, since a rendering cannot stop between stages.
pub(crate) struct Writer<'a> {
    folder: PathBuf,
    extension: &'static str,
    exposure: f64,
    provenance: &'a Provenance,
    written: usize,
    failure: Option<Failure>,
}

impl<'a> Writer<'a> {
    /// Makes the folder; pictures are of the same format as `main`.
    pub(crate) fn new(
        folder: &Path,
        main: Option<&Path>,
        exposure: f64,
        provenance: &'a Provenance,
    ) -> Result<Self, Failure> {
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::Cannot(format!("--snapshots {}: {error}", folder.display())))?;
        let extension = render::format_beside(main);
        Ok(Self { folder: folder.to_owned(), extension, exposure, provenance, written: 0, failure: None })
    }

    /// Writes `000_primary`, `001_D` and so on.
    pub(crate) fn write(&mut self, snapshot: &Snapshot<'_>) {
        let stage = snapshot.stage.map_or_else(|| "primary".to_owned(), |stage| stage.component.to_string());
        let path = self.folder.join(format!("{:03}_{stage}.{}", self.written, self.extension));
        self.written += 1;
        if self.failure.is_none() {
            self.failure = output::write_film(&path, snapshot.film, self.exposure, self.provenance).err();
        }
    }

    /// Says whether all were written.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        self.failure.map_or(Ok(()), Err)
    }
}
