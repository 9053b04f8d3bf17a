//! The incomplete beta function, its inverse, and with them the binomial distribution's tails.
//!
//! The continued fraction is DLMF 8.17.22. Its prefactor is written with Stirling's remainders and deviances (Loader,
//! "Fast and accurate computation of binomial probabilities", 2000), so that it keeps its digits at n = 10^9, where the
//! difference of three log-gammas would have lost seven of them.

use super::gamma::nonzero;
use super::ln_one_minus_exp;
use std::f64::consts::PI;

/// `ln I_x(a, b)`, the logarithm of the lower tail of Beta(a, b) at `x`; `y` must be `1 - x` (given apart so that neither
/// end loses digits). `a`, `b` > 0.
#[must_use]
pub fn ln_lower(a: f64, b: f64, x: f64, y: f64) -> f64 {
    if x <= 0.0 {
        f64::NEG_INFINITY
    } else if y <= 0.0 {
        0.0
    } else if x < (a + 1.0) / (a + b + 2.0) {
        ln_direct(a, b, x, y)
    } else {
        ln_one_minus_exp(ln_direct(b, a, y, x).min(0.0))
    }
}

/// `ln(1 - I_x(a, b))`, the upper tail.
#[must_use]
pub fn ln_upper(a: f64, b: f64, x: f64, y: f64) -> f64 {
    ln_lower(b, a, y, x)
}

/// `ln(x^a y^b / B(a, b))`.
#[must_use]
pub fn ln_prefix(a: f64, b: f64, x: f64, y: f64) -> f64 {
    let n = a + b;
    let half = 0.5 * (a.ln() + b.ln() - n.ln() - (2.0 * PI).ln());
    // a - n x, from whichever of x and y has more digits after its leading ones.
    let excess = if x < y { a - n * x } else { n * y - b };
    half + stirling(n) - stirling(a) - stirling(b) - deviance(a, n * x, excess) - deviance(b, n * y, -excess)
}

/// `ln B(a, b)`.
#[must_use]
pub fn ln_beta(a: f64, b: f64) -> f64 {
    let n = a + b;
    let (x, y) = (a / n, b / n);
    a * x.ln() + b * y.ln() - ln_prefix(a, b, x, y)
}

/// The `x` with `I_x(a, b) = q`, and `1 - x`.
///
/// Newton's method on the logit of `x` for the logarithm of the smaller tail, kept inside a bracket; relative accuracy
/// near 1e-14 in the smaller of `x` and `1 - x`.
#[must_use]
pub fn quantile(a: f64, b: f64, q: f64) -> (f64, f64) {
    if q <= 0.0 {
        return (0.0, 1.0);
    }
    if q >= 1.0 {
        return (1.0, 0.0);
    }
    if q > 0.5 {
        let (y, x) = solve(b, a, (1.0 - q).ln());
        (x, y)
    } else {
        solve(a, b, q.ln())
    }
}

fn solve(a: f64, b: f64, target: f64) -> (f64, f64) {
    let pair = |t: f64| {
        let small = (-t.abs()).exp();
        let (small, large) = (small / (1.0 + small), 1.0 / (1.0 + small));
        if t < 0.0 { (small, large) } else { (large, small) }
    };
    let (mut low, mut high) = (-745.0_f64, 745.0_f64);
    let mut t = (a / b).ln();
    for _ in 0..400 {
        let (x, y) = pair(t);
        let ln_tail = ln_lower(a, b, x, y);
        let error = ln_tail - target;
        if error > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let slope = (ln_prefix(a, b, x, y) - ln_tail).exp();
        let newton = t - error / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let step = (next - t).abs();
        t = next;
        if step <= 1e-15 * t.abs().max(1.0) {
            break;
        }
    }
    pair(t)
}

/// `ln I_x(a, b)` by the continued fraction, which converges fast for `x` below the mean.
fn ln_direct(a: f64, b: f64, x: f64, y: f64) -> f64 {
    let n = a + b;
    let mut c = 1.0;
    // 1 - n x / (a + 1), again from the better of x and y.
    let first = if x < y { a + 1.0 - n * x } else { 1.0 - b + n * y };
    let mut d = 1.0 / nonzero(first / (a + 1.0));
    let mut h = d;
    // Near the mean the number of steps grows with the square root of the larger parameter.
    let most = 1e4 + 40.0 * n.sqrt();
    let mut m = 0.0;
    while m < most {
        m += 1.0;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / nonzero(1.0 + even * d);
        c = nonzero(1.0 + even / c);
        h *= d * c;
        let odd = -(a + m) * (n + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / nonzero(1.0 + odd * d);
        c = nonzero(1.0 + odd / c);
        let step = d * c;
        h *= step;
        if (step - 1.0).abs() < 2e-16 {
            break;
        }
    }
    ln_prefix(a, b, x, y) + h.ln() - a.ln()
}

/// What Stirling's formula for `ln Gamma(z)` leaves over: `ln Gamma(z) - (z - 1/2) ln z + z - ln(2 pi) / 2`.
fn stirling(z: f64) -> f64 {
    // Below 16 the recurrence ln Gamma(z) = ln Gamma(z + 1) - ln z leads upwards:
    // s(z) = s(z + 1) + (z + 1/2) ln(1 + 1/z) - 1.
    let mut z = z;
    let mut carried = 0.0;
    while z < 16.0 {
        carried += (z + 0.5) * (1.0 / z).ln_1p() - 1.0;
        z += 1.0;
    }
    let w = 1.0 / (z * z);
    let series = 1.0 / 12.0 - w * (1.0 / 360.0 - w * (1.0 / 1260.0 - w * (1.0 / 1680.0 - w / 1188.0)));
    carried + series / z
}

/// `x ln(x / m) + m - x`, which is small and never negative, without cancellation where `x` is close to `m`;
/// `difference` is `x - m`.
fn deviance(x: f64, m: f64, difference: f64) -> f64 {
    if difference.abs() < 0.1 * (x + m) {
        // With v = (x - m) / (x + m): ln(x / m) = 2 (v + v^3/3 + v^5/5 + ...).
        let v = difference / (x + m);
        let mut sum = difference * v;
        let mut power = 2.0 * x * v;
        let squared = v * v;
        let mut j = 1.0;
        loop {
            power *= squared;
            j += 2.0;
            let next = sum + power / j;
            if next == sum {
                return next;
            }
            sum = next;
        }
    }
    if x == 0.0 { m } else { x * (x / m).ln() - difference }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// For whole parameters the tail is a finite binomial sum: I_x(a, b) = sum over j >= a of C(n, j) x^j y^(n-j).
    #[test]
    fn whole_parameters_are_binomial_sums() {
        for n in 1..40_u32 {
            for a in 1..=n {
                for x in [0.001, 0.2, 0.5, 0.75, 0.99_f64] {
                    let y = 1.0 - x;
                    let mut sum = 0.0;
                    let mut choose = 1.0;
                    for j in 0..=n {
                        if j >= a {
                            sum += choose * x.powi(j as i32) * y.powi((n - j) as i32);
                        }
                        choose *= f64::from(n - j) / f64::from(j + 1);
                    }
                    let found = ln_lower(f64::from(a), f64::from(n - a + 1), x, y).exp();
                    assert!((found / sum - 1.0).abs() < 1e-12, "n {n} a {a} x {x}: {found} {sum}");
                }
            }
        }
    }

    #[test]
    fn beta_is_the_ratio_of_gammas() {
        assert!((ln_beta(1.0, 1.0)).abs() < 1e-15);
        assert!((ln_beta(0.5, 0.5).exp() - PI).abs() < 1e-14);
        assert!((ln_beta(10.0, 8.0).exp() * 194_480.0 - 1.0).abs() < 1e-13); // 9! 7! / 17! = 1 / 194480
    }

    #[test]
    fn a_thousand_million_keeps_its_digits() {
        // mpmath, 50 digits: P(X <= 499_990_000), n = 10^9, p = 1/2.
        let (n, k) = (1e9, 499_990_000.0);
        let found = ln_lower(n - k, k + 1.0, 0.5, 0.5).exp();
        assert!((found / 0.263_554_957_377_334_87 - 1.0).abs() < 1e-9, "{found:.17}");
    }

    proptest! {
        #[test]
        fn quantile_undoes_the_tail(a in 0.5..500.0_f64, b in 0.5..500.0_f64, q in 1e-12..1.0_f64) {
            let (x, y) = quantile(a, b, q);
            prop_assert!((x + y - 1.0).abs() < 1e-15);
            let back = if q < 0.5 { ln_lower(a, b, x, y).exp() / q } else { ln_upper(a, b, x, y).exp() / (1.0 - q) };
            prop_assert!((back - 1.0).abs() < 1e-10, "I({}, {}, {}) off by {}", x, a, b, back - 1.0);
        }

        #[test]
        fn reflection_swaps_the_ends(a in 0.5..500.0_f64, b in 0.5..500.0_f64, x in 0.0..1.0_f64) {
            prop_assert_eq!(ln_lower(a, b, x, 1.0 - x), ln_upper(b, a, 1.0 - x, x));
        }
    }
}
