//! How to render, and which settings do not render.

use crate::color::Rgb;
use crate::crex::ThresholdError;
use crate::film::Layers;
use crate::scene::View;
use crate::transport::Limits;

/// How to render. Same settings, same bits, for any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples for each pixel, at least 1.
    pub samples: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// `-pj`: how much of a pixel's extent its samples cover, in [0, 1].
    pub jitter: f64,
    /// `-pd`: diameter of the lens, in the scene's unit; 0 is a point. Perspective views only.
    pub aperture: f64,
    /// Where paths end and how they branch.
    pub limits: Limits,
    /// `-av`: radiance that stands for diffuse light that is not traced, W/(sr m2).
    pub ambient: Rgb,
    /// `-dv`: whether light sources are seen.
    pub lights_visible: bool,
    /// Under which component light is filed.
    pub layers: Layers,
    /// Threads to use; `None` is one for each processor.
    pub threads: Option<usize>,
}

impl Settings {
    /// The defaults for a picture of this size: one sample for each pixel over its whole extent, Radiance's limits.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            samples: 1,
            seed: 0,
            jitter: 1.0,
            aperture: 0.0,
            limits: Limits::default(),
            ambient: Rgb::ZERO,
            lights_visible: true,
            layers: Layers::Last,
            threads: None,
        }
    }
}

/// Why settings do not render.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The thresholds do not fit the crex.
    #[error(transparent)]
    Thresholds(#[from] ThresholdError),
    /// A setting is out of its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// Which.
        name: &'static str,
        /// What it is.
        value: String,
        /// Its range, in words.
        expected: &'static str,
    },
    /// The importance map has not the size of the picture.
    #[error(
        "the importance map has {found_width} x {found_height} pixels, the picture {width} x {height}; scale the map"
    )]
    ImportanceSize {
        /// Pixels in a row of the map.
        found_width: usize,
        /// Rows of the map.
        found_height: usize,
        /// Pixels in a row of the picture.
        width: usize,
        /// Rows of the picture.
        height: usize,
    },
    /// The machine refused.
    #[error("could not start {threads} threads: {reason}")]
    Threads {
        /// How many.
        threads: usize,
        /// Why.
        reason: String,
    },
}

pub(super) fn out_of_range(name: &'static str, value: impl std::fmt::Display, expected: &'static str) -> RenderError {
    RenderError::Setting { name, value: value.to_string(), expected }
}

/// Lengths beyond this are refused, as in scenes.
const LARGEST: f64 = 1e75;

pub(super) fn check(settings: &Settings, view: &View) -> Result<(), RenderError> {
    let Limits { least_weight, glossy_threshold, glossy_rays, .. } = settings.limits;
    let within =
        |holds: bool, name, value: f64, expected| if holds { Ok(()) } else { Err(out_of_range(name, value, expected)) };
    if settings.width == 0 || settings.height == 0 || u32::try_from(settings.width.max(settings.height)).is_err() {
        let value = format!("{} x {}", settings.width, settings.height);
        return Err(out_of_range("the picture's size", value, "at least 1 x 1 pixel"));
    }
    within(settings.samples > 0, "the number of samples", 0.0, "at least 1")?;
    within((0.0..=1.0).contains(&settings.jitter), "the pixel jitter (-pj)", settings.jitter, "a number from 0 to 1")?;
    if settings.aperture != 0.0 {
        let (aperture, perspective) = (settings.aperture, view.takes_lens());
        within((0.0..=LARGEST).contains(&aperture), "the lens (-pd)", aperture, "a diameter from 0 to 1e75")?;
        within(perspective, "the lens (-pd)", aperture, "0, since only perspective views (-vtv) have one")?;
    }
    let positive = |x: f64| (0.0..f64::INFINITY).contains(&x);
    within(positive(least_weight), "the least weight (-lw)", least_weight, "a number, 0 or more")?;
    within(positive(glossy_threshold), "the specular threshold (-st)", glossy_threshold, "a number, 0 or more")?;
    within(positive(glossy_rays), "the number of glossy rays (-ss)", glossy_rays, "a number, 0 or more")?;
    for value in settings.ambient.to_array() {
        within(positive(value), "the ambient value (-av)", value, "three numbers, 0 or more")?;
    }
    let all = f64::from(settings.samples) * f64::from(settings.limits.diffuse_rays).max(glossy_rays).max(1.0);
    within(all < 4_294_967_296.0, "samples times rays for each hit (-ad, -ss)", all, "less than 2^32")
}
