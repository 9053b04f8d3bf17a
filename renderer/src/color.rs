//! Linear radiance in Radiance's RGB (W/(sr m2) per channel) and what is derived from it.

use glam::DVec3;

/// Radiance, reflectance or transmittance per channel: x red, y green, z blue. Linear, unclamped.
pub type Rgb = DVec3;

/// Radiance's luminance weights for its default primaries (`bright()` of color.h).
pub const LUMINANCE_WEIGHTS: Rgb = Rgb::new(0.265_074_126, 0.670_114_631, 0.064_811_243);

/// Lumens per watt that Radiance takes for white light: cd/m2 = 179 x brightness.
pub const WHITE_EFFICACY: f64 = 179.0;

/// Brightness of a radiance in W/(sr m2).
#[must_use]
pub fn brightness(radiance: Rgb) -> f64 {
    radiance.dot(LUMINANCE_WEIGHTS)
}

/// Luminance in cd/m2.
#[must_use]
pub fn luminance_cd_m2(radiance: Rgb) -> f64 {
    WHITE_EFFICACY * brightness(radiance)
}

/// The sRGB code in [0, 1] (IEC 61966-2-1) that shows a linear intensity; intensities outside [0, 1] are clamped.
#[must_use]
pub fn srgb_encode(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The linear intensity in [0, 1] of an sRGB code in [0, 1] (IEC 61966-2-1); codes outside are clamped.
#[must_use]
pub fn srgb_decode(code: f64) -> f64 {
    let code = code.clamp(0.0, 1.0);
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}
