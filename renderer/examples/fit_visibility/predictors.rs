//! What small pictures tell of how visible it is that components are missing: the measures that the fit chooses from.

use renderer::color::{Rgb, brightness};
use renderer::picture::Picture;
use renderer::picture::compare::{self, CompareError};
use renderer::picture::display::Display;
use renderer::raster::Raster;

/// Differences of log luminance from this on count as seen in [`Predictors::coverage`]: 2 %, about the threshold contrast of
/// large patches (Weber's law; Radiance's own -lw and RESOLUTION defaults are of this order).
const SEEN: f64 = 0.02;

/// Edge of the blocks, in pixels of the small picture, over which [`Predictors::contrast`] averages.
const BLOCK: usize = 4;

/// Measures of a small picture that lacks something against the full one, on luminance as the display shows it. All are 0 if
/// and only if nothing that is shown differs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Predictors {
    /// Mean absolute difference / mean of the full picture: the missing energy relative to what the eye is adapted to.
    pub(crate) energy: f64,
    /// Root mean square over blocks of 4 x 4 pixels of the difference of mean log luminance: contrast of smooth light.
    pub(crate) contrast: f64,
    /// Root mean square of what is left of the difference of log luminance within the blocks: contrast of details (and noise).
    pub(crate) detail: f64,
    /// Part of the pixels, in [0, 1], whose luminance differs by 2 % or more.
    pub(crate) coverage: f64,
    /// Loss in JOD that ColorVideoVDP finds between the small pictures, shown as large as the picture that is asked for.
    pub(crate) jod: f64,
}

impl Predictors {
    /// Their names, in the order of [`Self::values`].
    pub(crate) const NAMES: [&'static str; 5] = ["energy", "contrast", "detail", "coverage", "jod"];

    /// Measures what a picture lacks; radiance times `exposure` is shown on `display`, each pixel as large as the display's.
    ///
    /// # Errors
    /// If the pictures differ in size, hold values that are not finite, or the metrics refuse the display.
    pub(crate) fn measure(
        full: &Picture,
        fewer: &Picture,
        display: &Display,
        exposure: f64,
    ) -> Result<Self, CompareError> {
        let jod = 10.0 - compare::jod(full, fewer, display, exposure)?.jod;
        let shown = [full, fewer].map(|picture| luminance(picture, display, exposure));
        let count = shown[0].values().len() as f64;
        let (mut absolute, mut sum) = (0.0, 0.0);
        let mut logs = Vec::with_capacity(shown[0].values().len());
        for (full, fewer) in shown[0].values().iter().zip(shown[1].values()) {
            absolute += (full - fewer).abs();
            sum += full;
            logs.push((fewer / full).ln());
        }
        let logs = Raster::from_values(shown[0].width(), shown[0].height(), logs).expect("one for each pixel");
        let (contrast, detail) = blocks(&logs);
        let seen = logs.values().iter().filter(|log| log.abs() >= SEEN.ln_1p()).count() as f64;
        Ok(Self { energy: absolute / sum, contrast, detail, coverage: seen / count, jod: jod.max(0.0) })
    }

    /// The numbers in a row.
    pub(crate) fn values(&self) -> [f64; 5] {
        [self.energy, self.contrast, self.detail, self.coverage, self.jod]
    }
}

/// Luminance on the display, cd/m2, with its black and the light that it reflects: never 0.
fn luminance(picture: &Picture, display: &Display, exposure: f64) -> Raster<f64> {
    let reflected = display.ambient_lux * display.reflectivity / std::f64::consts::PI;
    let least = display.black_cd_m2 + reflected;
    let shown = |pixel: &[f32; 3]| {
        let light = Rgb::from(pixel.map(|value| (f64::from(value) * exposure).clamp(0.0, 1.0)));
        (display.peak_cd_m2 - display.black_cd_m2) * brightness(light) + least
    };
    let values = picture.beauty.values().iter().map(shown).collect();
    Raster::from_values(picture.beauty.width(), picture.beauty.height(), values).expect("as many pixels")
}

/// Root mean square over blocks of their means, and of the deviations from these.
fn blocks(values: &Raster<f64>) -> (f64, f64) {
    let (width, height) = (values.width(), values.height());
    let (mut between, mut within) = (0.0, 0.0);
    for top in (0..height).step_by(BLOCK) {
        for left in (0..width).step_by(BLOCK) {
            let (bottom, right) = (height.min(top + BLOCK), width.min(left + BLOCK));
            let pixels =
                || (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))).map(|(x, y)| *values.at(x, y));
            let count = ((bottom - top) * (right - left)) as f64;
            let mean = pixels().sum::<f64>() / count;
            between += count * mean * mean;
            within += pixels().map(|value| (value - mean).powi(2)).sum::<f64>();
        }
    }
    let all = (width * height) as f64;
    ((between / all).sqrt(), (within / all).sqrt())
}
