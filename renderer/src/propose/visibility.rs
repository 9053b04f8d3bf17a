//! From the loss that a small picture shows to the loss that people would see in the large one.
//!
//! The coefficients are fitted by `renderer/examples/fit_visibility` to the rows in `tests/data/visibility/rows.csv`; a test
//! fits them again. `docs/auto.md` says how well they predict scenes that had no part in the fit, and which other predictors
//! were tried and left out because they add nothing.

/// Added to a loss of the large picture before its logarithm is taken, JOD: losses below are of no consequence and count as
/// alike.
pub const LEAST_LOSS_JOD: f64 = 0.01;

/// Added to a loss of the small picture before its logarithm is taken, JOD.
pub const LEAST_PREDICTOR: f64 = 1e-3;

/// ln(loss + .01) = `CONSTANT` + `EXPONENT` x ln(small loss + .001), losses in JOD.
pub const CONSTANT: f64 = 0.4660;

/// See [`CONSTANT`].
pub const EXPONENT: f64 = 0.7836;

/// The loss predicted for a large picture, JOD, from 0 (nothing visible) to 9 (the scale's lower end is 1), from the one that
/// ColorVideoVDP finds between small ones.
#[must_use]
pub fn loss_jod(small_loss_jod: f64) -> f64 {
    let log = CONSTANT + EXPONENT * (small_loss_jod + LEAST_PREDICTOR).ln();
    (log.exp() - LEAST_LOSS_JOD).clamp(0.0, 9.0)
}
