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
