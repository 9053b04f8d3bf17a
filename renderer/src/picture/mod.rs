//! Pictures in and out: OpenEXR with layers, Radiance HDR, PNG, each with the provenance of what it holds; and measures of
//! how far two pictures lie apart.
//!
//! Files are written beside their final name and renamed when complete, so a reader never meets half a picture. The writers take
//! rows from the top in bands of any height, so a film larger than memory can stream into them. The same rows and header give
//! the same bytes on every run and for any thread count.
//!
//! This is the only module that names the crates `exr`, `png`, `flip_rs` and `colorvideovdp`.

pub mod compare;
pub mod display;
mod error;
mod exr;
pub mod grey;
mod hdr;
mod perceptual;
mod png;
mod provenance;
pub mod region;
mod rgbe;
mod write;

use std::path::Path;

use glam::Vec3;

use crate::color::srgb_encode;
use crate::raster::Raster;

pub use crate::atomic::AtomicFile;
pub use error::{Error, Kind};
pub use provenance::{Input, Provenance};
pub use write::{Band, Compression, Format, HdrStream, Header, PictureFile, write};

/// Linear red, green and blue of one pixel: radiance in W/(sr m2), or display intensity in [0, 1].
pub type Pixel = [f32; 3];

/// What the numbers of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Radiance in W/(sr m2) per channel, Radiance's colour space: EXR and HDR.
    Radiance,
    /// Linear light of a display as a fraction of its white: a PNG, decoded by the sRGB transfer curve.
    Display,
}

/// A whole picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// What the numbers are.
    pub quantity: Quantity,
    /// The picture itself.
    pub beauty: Raster<Pixel>,
    /// Parts of it by name (`direct`, `D`, ... `ambient`), each as large as the beauty. Absent parts are zero.
    pub layers: Vec<Layer>,
    /// How it was made, as far as the file says.
    pub provenance: Provenance,
}

/// One part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The part's name: `direct`, a component's letter or `ambient`.
    pub name: String,
    /// Its pixels.
    pub pixels: Raster<Pixel>,
}

impl Picture {
    /// A picture of radiance without layers, as the metrics take it.
    #[must_use]
    pub fn of_radiance(beauty: &Raster<Vec3>) -> Self {
        let pixels = beauty.values().iter().map(Vec3::to_array).collect();
        let beauty = Raster::from_values(beauty.width(), beauty.height(), pixels).expect("as many pixels");
        Self { quantity: Quantity::Radiance, beauty, layers: Vec::new(), provenance: Provenance::default() }
    }

    /// The layer of that name.
    #[must_use]
    pub fn layer(&self, name: &str) -> Option<&Raster<Pixel>> {
        self.layers.iter().find(|layer| layer.name == name).map(|layer| &layer.pixels)
    }

    /// The picture as linear display light in [0, 1]: radiance is scaled by `exposure` and clamped.
    #[must_use]
    pub fn display_light(&self, exposure: f64) -> Raster<Pixel> {
        self.shown(exposure, |light| light.clamp(0.0, 1.0))
    }

    /// The sRGB codes in [0, 1] that show the picture; radiance is scaled by `exposure` and clamped.
    #[must_use]
    pub fn codes(&self, exposure: f64) -> Raster<Pixel> {
        self.shown(exposure, srgb_encode)
    }

    fn shown(&self, exposure: f64, change: impl Fn(f64) -> f64) -> Raster<Pixel> {
        let factor = if self.quantity == Quantity::Radiance { exposure } else { 1.0 };
        let change = |value: f32| change(f64::from(value) * factor) as f32;
        let pixels = self.beauty.values().iter().map(|pixel| pixel.map(change)).collect();
        Raster::from_values(self.beauty.width(), self.beauty.height(), pixels).expect("as many pixels as the beauty")
    }
}

/// Reads an EXR, HDR or colour PNG file, known by its first bytes and not by its name.
///
/// # Errors
/// If the file cannot be read, is none of the three, or is damaged.
pub fn read(path: &Path) -> Result<Picture, Error> {
    let bytes = std::fs::read(path).map_err(|error| Error::new(path, Kind::Read(error)))?;
    read_bytes(&bytes).map_err(|kind| Error::new(path, kind))
}

/// Reads an EXR, HDR or colour PNG picture from the bytes of its file.
///
/// # Errors
/// If the bytes are none of the three, or damaged.
pub fn read_bytes(bytes: &[u8]) -> Result<Picture, Kind> {
    match Format::of_bytes(bytes) {
        Some(Format::Exr) => exr::read(bytes),
        Some(Format::Hdr) => hdr::read(bytes),
        Some(Format::Png) => png::read(bytes),
        None => Err(Kind::Unknown),
    }
}

#[cfg(test)]
mod tests;
