//! Maps of one value in [0, 1] per pixel: grey PNG of 8 or 16 bits (code / maximum, no transfer curve) or EXR as it is.

use std::path::Path;

use super::{AtomicFile, Band, Error, Format, Header, Kind, PictureFile, Provenance, exr, png};
use crate::raster::Raster;

/// A value in [0, 1] per pixel, row 0 at the top.
pub type GreyMap = Raster<f32>;

/// Bits of a grey PNG's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bits {
    /// 256 steps.
    Eight,
    /// 65536 steps.
    Sixteen,
}

/// Reads a map from a grey PNG or an EXR whose channels agree.
///
/// # Errors
/// If the file cannot be read, has colours, or holds a value outside [0, 1].
pub fn read(path: &Path) -> Result<GreyMap, Error> {
    let bytes = std::fs::read(path).map_err(|error| Error::new(path, Kind::Read(error)))?;
    let map = match Format::of_bytes(&bytes) {
        Some(Format::Exr) => exr::read_grey(&bytes),
        Some(Format::Png) => png::read_grey(&bytes),
        Some(Format::Hdr) => Err(Kind::Damaged("a map is a grey PNG or an EXR, not Radiance HDR".into())),
        None => Err(Kind::Unknown),
    };
    map.and_then(checked).map_err(|kind| Error::new(path, kind))
}

/// Writes a map: `.png` with codes of `bits`, or `.exr` with three equal channels, which knows no steps.
///
/// # Errors
/// If the name says neither, a value lies outside [0, 1], or the disk refuses.
pub fn write(path: &Path, map: &GreyMap, bits: Bits, provenance: &Provenance) -> Result<(), Error> {
    let result = checked(map.clone()).and_then(|map| match Format::of_name(path) {
        Some(Format::Png) => {
            AtomicFile::write_all(path, &png::encode_grey(&map, bits, provenance)?).map_err(Kind::Write)
        }
        Some(Format::Exr) => return_exr(path, &map, provenance),
        _ => Err(Kind::Damaged("a map is written as .png or .exr".into())),
    });
    result.map_err(|kind| Error::new(path, kind))
}

fn return_exr(path: &Path, map: &GreyMap, provenance: &Provenance) -> Result<(), Kind> {
    let header = Header::new(map.width(), map.height(), provenance.clone());
    let pixels: Vec<_> = map.values().iter().map(|&value| [value; 3]).collect();
    let write = || {
        let mut file = PictureFile::create(path, &header)?;
        file.write(Band { beauty: &pixels, layers: &[] })?;
        file.finish()
    };
    write().map_err(|error: Error| error.kind)
}

fn checked(map: GreyMap) -> Result<GreyMap, Kind> {
    match map.values().iter().position(|value| !(0.0..=1.0).contains(value)) {
        None => Ok(map),
        Some(index) => {
            let (x, y) = (index % map.width(), index / map.width());
            Err(Kind::Range { x, y, value: map.values()[index] })
        }
    }
}
