//! How much a smooth surface reflects.

/// Value subtracted from the exponential of `approximate`, so that it nearly vanishes at normal incidence.
///
/// This is the constant of Radiance releases from 2023-03 to 2026-06, with which the reference pictures in the tests
/// were made; other releases have [`FRESNEL_OFFSET_EXACT`]. Smooth plastic seen head on differs by .00085 between them.
pub const FRESNEL_OFFSET: f64 = 0.002_029_430_64;

/// exp(-5.85): the offset of Radiance releases before 2023-03 and after 2026-06.
pub const FRESNEL_OFFSET_EXACT: f64 = 0.002_879_899_16;

/// Specularity from which on plastic, metal and trans follow Fresnel (Radiance; before 2005 any that is not zero).
pub(super) const FRESNEL_LEAST_SPECULARITY: f64 = 0.017_999;

/// Radiance's approximation of Fresnel's reflectance for plastic and metal: exp(-5.85 cos) - K.
pub(super) fn approximate(cosine: f64) -> f64 {
    (-5.85 * cosine).exp() - FRESNEL_OFFSET
}

/// Reflectance of a boundary for each polarisation (perpendicular, parallel). `ratio` is the index on the ray's side
/// over the index beyond; `cosine` on the ray's side, `cosine_beyond` beyond it.
pub(super) fn boundary(ratio: f64, cosine: f64, cosine_beyond: f64) -> [f64; 2] {
    let perpendicular = (ratio * cosine - cosine_beyond) / (ratio * cosine + cosine_beyond);
    let parallel = (cosine - ratio * cosine_beyond) / (cosine + ratio * cosine_beyond);
    [perpendicular * perpendicular, parallel * parallel]
}
