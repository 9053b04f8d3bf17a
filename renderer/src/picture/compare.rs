//! How far a picture lies from a reference.

use serde::Serialize;

use super::display::Display;
pub use super::perceptual::Jod;
use super::{Picture, perceptual};
use crate::color::{Rgb, brightness};
use crate::raster::Raster;

/// Numbers without a model of seeing. Luminance is Radiance's brightness of the linear values, in the pictures' own unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Root of the mean squared difference of luminance.
    pub rmse: f64,
    /// Mean over pixels of (x - r)^2 / (r^2 + .01 mean(r)^2) on luminance; none where the reference is black throughout.
    pub rel_mse: Option<f64>,
    /// Mean luminance of the picture / that of the reference; none where the reference is black throughout.
    pub mean_ratio: Option<f64>,
    /// The largest difference of any channel of any pixel.
    pub max_abs: f64,
    /// Whether every channel of every pixel has the same bits.
    pub identical: bool,
}

/// Two pictures that cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// They differ in size.
    #[error("the reference is {0} x {1} pixels, the picture {2} x {3}: render both at one size")]
    Size(usize, usize, usize, usize),
    /// A region has another size.
    #[error("the region is {0} x {1} pixels, the pictures {2} x {3}: resize the map")]
    Region(usize, usize, usize, usize),
    /// One is radiance, the other display light.
    #[error("one picture holds radiance (EXR, HDR), the other display light (PNG): compare two of a kind")]
    Quantity,
    /// A value is not a number.
    #[error("a pixel of the {0} is not finite")]
    NotFinite(&'static str),
    /// FLIP refused.
    #[error("FLIP: {0}")]
    Flip(#[from] flip_rs::FlipError),
    /// ColorVideoVDP refused.
    #[error("ColorVideoVDP: {0}")]
    Jod(#[from] colorvideovdp::Error),
}

/// Compares linear values.
///
/// # Errors
/// If the pictures differ in size or kind, or hold values that are not finite.
pub fn difference(reference: &Picture, picture: &Picture) -> Result<Difference, CompareError> {
    check(reference, picture)?;
    let luminance = |pixel: &[f32; 3]| brightness(Rgb::from(pixel.map(f64::from)));
    let pairs = || reference.beauty.values().iter().zip(picture.beauty.values());
    let count = reference.beauty.values().len() as f64;
    let (mut sum_reference, mut sum_picture, mut squares) = (0.0, 0.0, 0.0);
    let mut max_abs = 0.0f64;
    for (r, x) in pairs() {
        let (luminance_r, luminance_x) = (luminance(r), luminance(x));
        sum_reference += luminance_r;
        sum_picture += luminance_x;
        squares += (luminance_x - luminance_r).powi(2);
        for (r, x) in r.iter().zip(x) {
            max_abs = max_abs.max((f64::from(*x) - f64::from(*r)).abs());
        }
    }
    let mean_reference = sum_reference / count;
    let lit = mean_reference > 0.0;
    let floor = 0.01 * mean_reference * mean_reference;
    let relative = |(r, x): (&[f32; 3], &[f32; 3])| {
        let (r, x) = (luminance(r), luminance(x));
        (x - r).powi(2) / (r * r + floor)
    };
    Ok(Difference {
        rmse: (squares / count).sqrt(),
        rel_mse: lit.then(|| pairs().map(relative).sum::<f64>() / count),
        mean_ratio: lit.then_some(sum_picture / sum_reference),
        max_abs,
        identical: pairs().all(|(r, x)| r.map(f32::to_bits) == x.map(f32::to_bits)),
    })
}

/// LDR-FLIP per pixel in [0, 1] (Andersson et al. 2020) as the display shows the pictures; its mean is the usual single number.
/// Radiance is shown as sRGB(clamp(radiance x `exposure`)).
///
/// # Errors
/// If the pictures differ in size or kind, or are too large for the method.
pub fn flip(
    reference: &Picture,
    picture: &Picture,
    display: &Display,
    exposure: f64,
) -> Result<Raster<f32>, CompareError> {
    check(reference, picture)?;
    Ok(perceptual::flip(reference, picture, display, exposure)?)
}

/// ColorVideoVDP (Mantiuk et al. 2024) in just-objectionable differences, as the display shows the pictures, free viewing.
/// Radiance is shown as sRGB(clamp(radiance x `exposure`)).
///
/// # Errors
/// If the pictures differ in size or kind, or the display is outside the method's range.
pub fn jod(reference: &Picture, picture: &Picture, display: &Display, exposure: f64) -> Result<Jod, CompareError> {
    check(reference, picture)?;
    Ok(perceptual::jod(reference, picture, display, exposure)?)
}

/// The mean of a map.
#[must_use]
pub fn mean(map: &Raster<f32>) -> f64 {
    map.values().iter().map(|&value| f64::from(value)).sum::<f64>() / map.values().len() as f64
}

fn check(reference: &Picture, picture: &Picture) -> Result<(), CompareError> {
    let size = |picture: &Picture| (picture.beauty.width(), picture.beauty.height());
    let ((rw, rh), (w, h)) = (size(reference), size(picture));
    if (rw, rh) != (w, h) {
        return Err(CompareError::Size(rw, rh, w, h));
    }
    if reference.quantity != picture.quantity {
        return Err(CompareError::Quantity);
    }
    for (name, picture) in [("reference", reference), ("picture", picture)] {
        if picture.beauty.values().iter().flatten().any(|value| !value.is_finite()) {
            return Err(CompareError::NotFinite(name));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{Provenance, Quantity};

    fn grey(values: &[f32]) -> Picture {
        let pixels = values.iter().map(|&value| [value; 3]).collect();
        let beauty = Raster::from_values(values.len(), 1, pixels).unwrap();
        Picture { quantity: Quantity::Radiance, beauty, layers: vec![], provenance: Provenance::default() }
    }

    #[test]
    fn the_formulas_on_two_pixels() {
        let difference = difference(&grey(&[1.0, 3.0]), &grey(&[2.0, 3.0])).unwrap();
        // Luminance weights sum to 1; mean(r) = 2, so the floor is 0.04.
        assert!((difference.rmse - 0.5f64.sqrt()).abs() < 1e-8);
        assert!((difference.rel_mse.unwrap() - 0.5 / 1.04).abs() < 1e-8);
        assert!((difference.mean_ratio.unwrap() - 1.25).abs() < 1e-8);
        assert_eq!(difference.max_abs, 1.0);
        assert!(!difference.identical);
    }

    #[test]
    fn a_picture_is_identical_to_itself() {
        let picture = grey(&[0.0, 1e-30, 5.0]);
        let difference = difference(&picture, &picture).unwrap();
        assert!(difference.identical);
        assert_eq!((difference.rmse, difference.rel_mse, difference.max_abs), (0.0, Some(0.0), 0.0));
        assert!((difference.mean_ratio.unwrap() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_black_reference_has_no_ratio() {
        let difference = difference(&grey(&[0.0, 0.0]), &grey(&[1.0, 0.0])).unwrap();
        assert_eq!((difference.rel_mse, difference.mean_ratio), (None, None));
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        assert!(matches!(difference(&grey(&[1.0]), &grey(&[1.0, 1.0])), Err(CompareError::Size(1, 1, 2, 1))));
        assert!(matches!(difference(&grey(&[1.0]), &grey(&[f32::NAN])), Err(CompareError::NotFinite("picture"))));
        let shown = Picture { quantity: Quantity::Display, ..grey(&[1.0]) };
        assert!(matches!(difference(&grey(&[1.0]), &shown), Err(CompareError::Quantity)));
    }
}
