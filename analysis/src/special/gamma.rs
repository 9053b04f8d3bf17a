//! The incomplete gamma function, for chi-square and normal tails.
//!
//! Series and continued fraction: NIST Digital Library of Mathematical Functions 8.7.1 and 8.9.2.

use statrs::function::gamma::ln_gamma;

use super::ln_one_minus_exp;

/// `ln Q(a, x)`, the logarithm of the upper tail of the gamma distribution of shape `a` beyond `x`.
///
/// `a` > 0, `x` >= 0; at `x` = 0 it is 0, at infinity minus infinity.
#[must_use]
pub fn ln_upper(a: f64, x: f64) -> f64 {
    if x.is_nan() {
        x
    } else if x <= 0.0 {
        0.0
    } else if x.is_infinite() {
        f64::NEG_INFINITY
    } else if x < a + 1.0 {
        ln_one_minus_exp(ln_series(a, x).min(0.0))
    } else {
        ln_fraction(a, x)
    }
}

/// `ln P(a, x)`, the logarithm of the lower tail.
#[must_use]
pub fn ln_lower(a: f64, x: f64) -> f64 {
    if x.is_nan() {
        x
    } else if x <= 0.0 {
        f64::NEG_INFINITY
    } else if x.is_infinite() {
        0.0
    } else if x < a + 1.0 {
        ln_series(a, x)
    } else {
        ln_one_minus_exp(ln_fraction(a, x).min(0.0))
    }
}

/// `ln(x^a e^-x / Gamma(a))`.
fn ln_prefix(a: f64, x: f64) -> f64 {
    a * x.ln() - x - ln_gamma(a)
}

/// The lower tail's power series, DLMF 8.7.1.
fn ln_series(a: f64, x: f64) -> f64 {
    let mut term = 1.0 / a;
    let mut sum = term;
    let mut at = a;
    while term > sum * 1e-17 {
        at += 1.0;
        term *= x / at;
        sum += term;
    }
    ln_prefix(a, x) + sum.ln()
}

/// The upper tail's continued fraction, DLMF 8.9.2, by Lentz's method.
fn ln_fraction(a: f64, x: f64) -> f64 {
    let tiny = 1e-300;
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / tiny;
    let mut d = 1.0 / b;
    let mut h = d;
    let mut i = 0.0;
    while i < 1e6 {
        i += 1.0;
        let numerator = -i * (i - a);
        b += 2.0;
        d = 1.0 / nonzero(numerator * d + b);
        c = nonzero(b + numerator / c);
        let step = c * d;
        h *= step;
        if (step - 1.0).abs() < 1e-16 {
            break;
        }
    }
    ln_prefix(a, x) + h.ln()
}

/// Lentz's guard: a denominator that is never zero.
pub(super) fn nonzero(value: f64) -> f64 {
    if value.abs() < 1e-300 { 1e-300 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole shapes have a closed form: Q(m, x) = e^-x sum x^j / j!, j < m.
    #[test]
    fn whole_shapes_have_a_closed_form() {
        for m in 1..12_u32 {
            for x in [1e-8, 0.1, 1.0, 3.5, 10.0, 60.0, 300.0_f64] {
                let mut term = 1.0_f64;
                let mut sum = 1.0;
                for j in 1..m {
                    term *= x / f64::from(j);
                    sum += term;
                }
                let exact = -x + sum.ln();
                let found = ln_upper(f64::from(m), x);
                assert!((found - exact).abs() <= 1e-12 * exact.abs().max(1.0), "Q({m}, {x}): {found} {exact}");
            }
        }
    }

    #[test]
    fn tails_add_up_to_one() {
        for a in [0.5, 1.0, 2.5, 40.0] {
            for x in [0.01, 0.4, 1.0, 2.4, 39.0, 60.0] {
                assert!((ln_upper(a, x).exp() + ln_lower(a, x).exp() - 1.0).abs() < 1e-13, "a {a} x {x}");
            }
        }
    }

    #[test]
    fn ends_are_ends() {
        assert_eq!(ln_upper(0.5, 0.0), 0.0);
        assert_eq!(ln_lower(0.5, 0.0), f64::NEG_INFINITY);
        assert_eq!(ln_upper(0.5, f64::INFINITY), f64::NEG_INFINITY);
        assert!((ln_upper(0.5, 1e300) / -1e300 - 1.0).abs() < 1e-15);
    }
}
