//! The pictures of a study: found through the manifest, checked against their digests, decoded to the bytes that are shown.

use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat};
use stimuli::{Manifest, PictureRecord, Sha256, Stimulus, Study};

use crate::error::{Error, Result};

/// A decoded picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Which.
    pub stimulus: Stimulus,
    /// The digest of its file.
    pub sha256: Sha256,
    /// Pixels across.
    pub width_px: u32,
    /// Pixels down.
    pub height_px: u32,
    /// Red, green, blue, 255 for each pixel; row 0 at the top: the bytes of the file, changed in no way.
    pub rgba: Vec<u8>,
}

/// The pictures of a study, as its manifest has them.
#[derive(Debug)]
pub struct Pictures<'a> {
    study: &'a Study,
    manifest: Manifest,
}

impl<'a> Pictures<'a> {
    /// Reads the manifest of a study's folder.
    ///
    /// # Errors
    /// If there is none, or it is not a manifest.
    pub fn of(study: &'a Study) -> Result<Self> {
        let manifest = Manifest::load(&study.folder)?;
        if manifest.pictures.is_empty() {
            let folder = study.folder.display();
            let message = format!("{folder}: the study has no pictures yet; render them with `cargo stimuli {folder}`");
            return Err(Error::Input(message));
        }
        Ok(Self { study, manifest })
    }

    /// The digest of the manifest: of every picture and of what it was made from.
    ///
    /// # Errors
    /// If a path in it is not Unicode.
    pub fn hash(&self) -> Result<Sha256> {
        Ok(self.manifest.hash()?)
    }

    /// Reads and checks every picture that the study shows and hands each to `with`.
    ///
    /// # Errors
    /// If one is missing, altered, rendered for other words than the study file's, of another size than the study's display, or not 8 bits a channel without
    /// transparency: all of them are named.
    pub fn each(&self, mut with: impl FnMut(Picture)) -> Result<()> {
        let mut wrong = Vec::new();
        for stimulus in self.study.stimuli() {
            match self.read(&stimulus) {
                Ok(picture) => with(picture),
                Err(error) if error.is_input() => wrong.push(error.to_string()),
                Err(error) => return Err(error),
            }
        }
        if wrong.is_empty() { Ok(()) } else { Err(Error::Input(wrong.join("\n"))) }
    }

    /// Reads and checks one picture.
    ///
    /// # Errors
    /// As [`Pictures::each`].
    pub fn read(&self, stimulus: &Stimulus) -> Result<Picture> {
        let folder = self.study.folder.display();
        let record = self.manifest.pictures.get(&stimulus.id()).ok_or_else(|| {
            let id = stimulus.id();
            Error::Input(format!(
                "{folder}: the manifest has no picture `{id}`; render it with `cargo stimuli {folder}`"
            ))
        })?;
        // What is on disk may be older than the study file: it would be shown as what it is not.
        if self.study.request(stimulus).as_ref() != Some(&record.request) {
            let id = stimulus.id();
            return Err(Error::Input(format!(
                "{folder}: the picture `{id}` was rendered for other words than the study file's; render it again with \
                 `cargo stimuli {folder}`"
            )));
        }
        let path = self.study.folder.join(&record.file);
        let bytes = read_file(&path)?;
        check_digest(&path, &bytes, record)?;
        let decoded = image::load_from_memory_with_format(&bytes, ImageFormat::Png)
            .map_err(|error| Error::Input(format!("{}: not a PNG picture: {error}", path.display())))?;
        let rgba = to_rgba(decoded, &path)?;
        let (width_px, height_px) = rgba.dimensions();
        let display = &self.study.display;
        if (width_px, height_px) != (display.width_px, display.height_px) {
            let (width, height) = (display.width_px, display.height_px);
            let path = path.display();
            let message = format!("{path}: {width_px} x {height_px} pixels, expected the study's {width} x {height}");
            return Err(Error::Input(message));
        }
        Ok(Picture { stimulus: stimulus.clone(), sha256: record.sha256, width_px, height_px, rgba: rgba.into_raw() })
    }
}

fn read_file(path: &PathBuf) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            Error::Input(format!("{}: the picture is missing; `cargo stimuli` renders it again", path.display()))
        }
        _ => Error::io("read", path)(error),
    })
}

fn check_digest(path: &Path, bytes: &[u8], record: &PictureRecord) -> Result<()> {
    let found = Sha256::of(bytes);
    if found == record.sha256 {
        return Ok(());
    }
    let (path, made) = (path.display(), record.sha256);
    Err(Error::Input(format!(
        "{path}: the file is not the picture that was rendered (SHA-256 {found}, the manifest has {made}); \
         restore it, or render it again with `cargo stimuli`"
    )))
}

/// Only conversions that keep every byte: grey or colour of 8 bits, opaque.
fn to_rgba(picture: DynamicImage, path: &Path) -> Result<image::RgbaImage> {
    let wrong = |what: &str| {
        let message = format!("{}: {what}; a stimulus is a PNG of 8 bits a channel without alpha", path.display());
        Err(Error::Input(message))
    };
    match picture {
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageRgb8(_) => Ok(picture.into_rgba8()),
        DynamicImage::ImageRgba8(rgba) if rgba.pixels().all(|pixel| pixel.0[3] == 255) => Ok(rgba),
        DynamicImage::ImageRgba8(_) | DynamicImage::ImageLumaA8(_) => wrong("some of it is transparent"),
        _ => wrong("it has more than 8 bits a channel"),
    }
}
