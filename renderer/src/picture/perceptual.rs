//! What a person would see of a difference, by published metrics, each computed by its own library.

use super::Picture;
use super::display::Display;
use crate::color::srgb_encode;
use crate::raster::Raster;

/// The sRGB codes in [0, 1] of a picture, three per pixel.
fn codes(picture: &Picture, exposure: f64) -> impl Iterator<Item = f32> {
    let codes = picture.codes(exposure);
    codes.values().iter().flatten().copied().collect::<Vec<_>>().into_iter()
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
        let codes = codes(picture, exposure);
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

/// ColorVideoVDP's last step, from pooled difference to JOD (its parameters of version 0.5.7).
const JOD_SCALE: f64 = 0.043_956_939_131_021_5;
const JOD_EXPONENT: f64 = 0.930_204_272_270_202_6;
/// Below this difference JOD falls along a straight line.
const STRAIGHT_UP_TO: f64 = 0.1;

/// The JOD of a pooled difference, 0 or more.
pub(super) fn jod_of(pooled: f64) -> f64 {
    let straight = STRAIGHT_UP_TO.powf(JOD_EXPONENT - 1.0) * pooled;
    10.0 - JOD_SCALE * if pooled <= STRAIGHT_UP_TO { straight } else { pooled.powf(JOD_EXPONENT) }
}

/// The pooled difference behind a JOD.
pub(super) fn pooled_difference(jod: f64) -> f64 {
    let scaled = (10.0 - jod).max(0.0) / JOD_SCALE;
    let straight = scaled * STRAIGHT_UP_TO.powf(1.0 - JOD_EXPONENT);
    if straight <= STRAIGHT_UP_TO { straight } else { scaled.powf(1.0 / JOD_EXPONENT) }
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
        let codes = codes(picture, exposure);
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

/// Agreement with the authors' own programs. The numbers were made once with PyPI's `flip-evaluator` 1.7 (`evaluate(reference,
/// test, "LDR", parameters={"ppd": 39.75127})`) and `cvvdp` 0.5.7 (250 cd/m2, contrast 500, 50 lux, 1 % reflected, the geometry
/// below) on the pictures that [`pictures`](tests::pictures) makes by the same whole-number formulas.
#[cfg(test)]
mod tests {
    use super::super::{Provenance, Quantity};
    use super::*;
    use crate::color::srgb_decode;
    use crate::picture::compare;

    const DISPLAY: Display = Display::of_the_paper();

    fn picture(code: impl Fn(i32, i32) -> [i32; 3]) -> Picture {
        let linear = |code: i32| srgb_decode(f64::from(code.clamp(0, 255)) / 255.0) as f32;
        let pixels = (0..64 * 96).map(|index| code(index % 96, index / 96).map(linear)).collect();
        let beauty = Raster::from_values(96, 64, pixels).unwrap();
        Picture { quantity: Quantity::Display, beauty, layers: vec![], provenance: Provenance::default() }
    }

    /// A reference, a much and a slightly changed picture.
    fn pictures() -> [Picture; 3] {
        let reference = |x: i32, y: i32| [x * 255 / 95, y * 255 / 63, (x / 8 + y / 8) % 2 * 180 + 30];
        let strong = |x: i32, y: i32| {
            let [red, green, blue] = reference(x, y);
            let red = red + ((x * 7 + y * 13) % 11 - 5) * 4;
            let green = if x > 70 { green * 9 / 10 } else { green };
            let inside = (20..40).contains(&y) && (30..60).contains(&x);
            [red, green, if inside { blue / 2 } else { blue }]
        };
        let weak = |x: i32, y: i32| reference(x, y).map(|code| code + ((x + y) % 3 - 1) * 3);
        [picture(reference), picture(strong), picture(weak)]
    }

    #[test]
    fn flip_is_that_of_its_authors() {
        let [reference, strong, weak] = pictures();
        let map = flip(&reference, &strong, &DISPLAY, 1.0).unwrap();
        assert!((compare::mean(&map) - 0.154_078_7).abs() < 1e-5, "{}", compare::mean(&map));
        for ((x, y), value) in [((45, 30), 0.448_066), ((80, 5), 0.087_180)] {
            assert!((map.at(x, y) - value).abs() < 1e-4, "{} at {x} {y}", map.at(x, y));
        }
        let map = flip(&reference, &weak, &DISPLAY, 1.0).unwrap();
        assert!((compare::mean(&map) - 0.021_917_6).abs() < 1e-5, "{}", compare::mean(&map));
        assert_eq!(compare::mean(&flip(&weak, &weak, &DISPLAY, 1.0).unwrap()), 0.0);
    }

    #[test]
    fn jod_is_that_of_its_authors() {
        let [reference, strong, weak] = pictures();
        let score = |picture: &Picture| jod(&reference, picture, &DISPLAY, 1.0).unwrap().jod;
        assert!((score(&strong) - 8.414_714).abs() < 1e-4, "{}", score(&strong));
        assert!((score(&weak) - 9.983_167).abs() < 1e-4, "{}", score(&weak));
        assert_eq!(score(&reference), 10.0);
    }

    #[test]
    fn jod_and_pooled_difference_are_inverse() {
        for pooled in [0.0, 1e-6, 0.05, 0.1, 0.100_001, 1.0, 30.0] {
            let back = pooled_difference(jod_of(pooled));
            assert!((back - pooled).abs() <= 1e-9 * pooled.max(1e-3), "{pooled} {back}");
        }
        assert_eq!(jod_of(0.0), 10.0);
        assert_eq!(pooled_difference(10.5), 0.0);
    }

    /// Radiance is judged as it would be shown.
    #[test]
    fn radiance_is_exposed_before_it_is_judged() {
        let [reference, strong, _] = pictures();
        let dimmed = |picture: &Picture| {
            let mut dim = Picture { quantity: Quantity::Radiance, ..picture.clone() };
            dim.beauty.values_mut().iter_mut().for_each(|pixel| *pixel = pixel.map(|value| value / 8.0));
            dim
        };
        let shown = jod(&reference, &strong, &DISPLAY, 1.0).unwrap().jod;
        let exposed = jod(&dimmed(&reference), &dimmed(&strong), &DISPLAY, 8.0).unwrap().jod;
        assert!((shown - exposed).abs() < 1e-4, "{shown} {exposed}");
    }
}
