//! What a person would see of a difference, by published metrics, each computed by its own library.

use super::display::Display;
use super::{Picture, Quantity};
use crate::color::srgb_encode;
use crate::raster::Raster;

/// The sRGB codes in [0, 1] that show a picture, three per pixel. Radiance is scaled by `exposure` and clamped.
fn codes(picture: &Picture, exposure: f64) -> Vec<f32> {
    let factor = if picture.quantity == Quantity::Radiance { exposure } else { 1.0 };
    picture.beauty.values().iter().flatten().map(|&value| srgb_encode(f64::from(value) * factor) as f32).collect()
}

/// LDR-FLIP of Andersson et al. 2020 ("FLIP: A Difference Evaluator for Alternating Images"), one value in [0, 1] per pixel.
pub(super) fn flip(
    reference: &Picture,
    picture: &Picture,
    display: &Display,
    exposure: f64,
) -> Result<Raster<f32>, flip_rs::FlipError> {
    let (width, height) = (reference.beauty.width(), reference.beauty.height());
    // FLIP assumes an sRGB screen: codes for another one are brought to the codes that show the same light.
    let image = |picture| {
        let codes = codes(picture, exposure).into_iter();
        let shown = codes.map(|code| srgb_encode(display.decode(f64::from(code))) as f32);
        flip_rs::RgbImage::new(width, height, shown.collect())
    };
    let map = flip_rs::ldr_flip(&image(reference)?, &image(picture)?, display.pixels_per_degree() as f32)?;
    Ok(Raster::from_values(width, height, map.into_pixels()).expect("a map has one value per pixel"))
}

/// A prediction in just-objectionable differences.
#[derive(Clone, Debug, PartialEq)]
pub struct Jod {
    /// 10 for no visible difference; 1 lower is preferred by one person in four.
    pub jod: f64,
    /// 1 - JOD/10 per pixel: where the difference is seen.
    pub map: Raster<f32>,
}

/// ColorVideoVDP of Mantiuk et al. 2024, free viewing, for still pictures.
pub(super) fn jod(
    reference: &Picture,
    picture: &Picture,
    display: &Display,
    exposure: f64,
) -> Result<Jod, colorvideovdp::Error> {
    use colorvideovdp::{Color, Cvvdp, DisplayModel, Geometry, Image, Options, Photometry};

    let (width, height) = (reference.beauty.width(), reference.beauty.height());
    let photometry = Photometry::new(
        display.peak_cd_m2,
        display.peak_cd_m2 / display.black_cd_m2,
        display.ambient_lux,
        display.reflectivity,
        1.0,
    )?;
    let resolution = [display.width_px as usize, display.height_px as usize];
    let geometry = Geometry::from_ppd(resolution, display.pixels_per_degree())?;
    let model = DisplayModel::new("display file", photometry, geometry, "sRGB")?;
    let image = |picture| {
        let codes = codes(picture, exposure).into_iter();
        // The library decodes sRGB; a screen with another curve is described by the sRGB codes of the light that it shows.
        let shown = codes.map(|code| srgb_encode(display.decode(f64::from(code))) as f32);
        Image::new(width, height, 3, shown.collect())
    };
    // Its own limit of 1 GiB is passed by a 4K picture; memory is bounded by the pictures, which are in memory already.
    let options = Options::default().with_distortion_map(true).with_memory_limit_bytes(usize::MAX / 4);
    let prediction = Cvvdp::new(model, options)?.predict_image(&image(picture)?, &image(reference)?, Color::Srgb)?;
    let map = prediction.distortion_map.map(|map| map.data).unwrap_or_default();
    let map = Raster::from_values(width, height, map).unwrap_or_else(|| Raster::filled(width, height, 0.0));
    Ok(Jod { jod: f64::from(prediction.jod), map })
}
