//! The standard normal distribution, its far tails by their logarithms.

use super::gamma;
use std::f64::consts::{FRAC_1_SQRT_2, LN_2, PI};

/// `ln P(Z > z)`.
#[must_use]
pub fn ln_sf(z: f64) -> f64 {
    // P(Z > z) = Q(1/2, z^2 / 2) / 2 for z >= 0.
    let squared = 0.5 * z * z;
    if z >= 0.0 {
        gamma::ln_upper(0.5, squared) - LN_2
    } else {
        (0.5 * gamma::ln_lower(0.5, squared).exp() - 0.5).ln_1p()
    }
}

/// `P(Z > z)`.
#[must_use]
pub fn sf(z: f64) -> f64 {
    ln_sf(z).exp()
}

/// `ln P(Z <= z)`.
#[must_use]
pub fn ln_cdf(z: f64) -> f64 {
    ln_sf(-z)
}

/// `P(Z <= z)`.
#[must_use]
pub fn cdf(z: f64) -> f64 {
    ln_sf(-z).exp()
}

/// The density at `z`.
#[must_use]
pub fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() * FRAC_1_SQRT_2 / PI.sqrt()
}

/// The quantile: the `z` with `P(Z <= z) = p`; infinite at 0 and 1.
///
/// Newton's method on the logarithm of the smaller tail, which is concave, from a coarse start.
#[must_use]
pub fn quantile(p: f64) -> f64 {
    if p <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if p >= 1.0 {
        return f64::INFINITY;
    }
    if p == 0.5 {
        return 0.0;
    }
    let (tail, sign) = if p < 0.5 { (p, -1.0) } else { (1.0 - p, 1.0) };
    let target = tail.ln();
    // The tail is close to exp(-z^2/2) / (z sqrt(2 pi)) far out; a start below the root is all that Newton needs.
    let mut z = (-2.0 * target - (1.0 - 2.0 * target).ln() - 1.2).max(0.0).sqrt();
    for _ in 0..60 {
        let ln_tail = ln_sf(z);
        let slope = -(-0.5 * z * z - 0.5 * (2.0 * PI).ln() - ln_tail).exp();
        let step = (target - ln_tail) / slope;
        z += step;
        if step.abs() <= 1e-15 * z.abs() {
            break;
        }
    }
    sign * z
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values to 16 digits by mpmath (`mp.ncdf`, `mp.erfc`, 50 digits).
    #[test]
    fn known_values() {
        let known = [
            (0.0, 0.5),
            (0.125, 0.450_261_775_169_886_9),
            (1.0, 0.158_655_253_931_457_05),
            (1.959_963_984_540_054, 0.025),
            (5.0, 2.866_515_718_791_939e-7),
            (37.5, 4.605_353_009_581_955e-308),
            (-1.0, 0.841_344_746_068_542_9),
            (-6.0, 0.999_999_999_013_412_3),
        ];
        for (z, tail) in known {
            assert!((sf(z) / tail - 1.0).abs() < 3e-13, "{z}: {} {tail}", sf(z));
        }
    }

    #[test]
    fn the_logarithm_goes_on_where_the_tail_is_zero() {
        assert_eq!(sf(50.0), 0.0);
        // ln(1 / (z sqrt(2 pi))) - z^2 / 2, less 1/z^2: the first terms of the asymptotic series.
        let z: f64 = 1e6;
        let series = -0.5 * z * z - (z * (2.0 * PI).sqrt()).ln() - 1.0 / (z * z);
        assert!((ln_sf(z) / series - 1.0).abs() < 1e-15);
    }

    #[test]
    fn quantile_undoes_cdf() {
        for p in [1e-300, 1e-20, 0.001, 0.025, 0.31, 0.49999, 0.5, 0.51, 0.75, 0.975, 0.999_999] {
            let z = quantile(p);
            assert!((cdf(z) / p - 1.0).abs() < 1e-12, "{p}: {z}");
        }
        assert!((quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert!((quantile(0.75) - 0.674_489_750_196_081_7).abs() < 1e-15);
    }
}
