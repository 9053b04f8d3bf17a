//! Confidence intervals of one proportion.

use serde::Serialize;

use crate::proportion::Proportion;
use crate::special::{beta, normal};

/// The intervals of one proportion, each `[low, high]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Intervals {
    /// Confidence level, such as 0.95.
    pub level: f64,
    /// Clopper and Pearson 1934: never covers less than its level.
    pub clopper_pearson: [f64; 2],
    /// Wilson 1927: the score test turned round, close to its level on average.
    pub wilson: [f64; 2],
    /// Equal tails of the posterior under Jeffreys' prior Beta(1/2, 1/2), with 0 at k = 0 and 1 at k = n (Brown, Cai and
    /// DasGupta 2001).
    pub jeffreys: [f64; 2],
}

impl Intervals {
    /// All intervals of `counts` at `level` in (0, 1).
    #[must_use]
    pub fn new(counts: Proportion, level: f64) -> Self {
        Self {
            level,
            clopper_pearson: clopper_pearson(counts, level),
            wilson: wilson(counts, level),
            jeffreys: jeffreys(counts, level),
        }
    }
}

/// Clopper and Pearson's interval, by the incomplete beta function's inverse. Without data it is `[0, 1]`.
#[must_use]
pub fn clopper_pearson(counts: Proportion, level: f64) -> [f64; 2] {
    let tail = (1.0 - level) / 2.0;
    let (k, n) = counts.as_f64();
    let low = if counts.k == 0 { 0.0 } else { beta::quantile(k, n - k + 1.0, tail).0 };
    // The upper limit is one less the lower limit of the misses: `quantile` gives both parts without a subtraction.
    let high = if counts.k == counts.n { 1.0 } else { beta::quantile(n - k, k + 1.0, tail).1 };
    [low, high]
}

/// Wilson's score interval. Without data it is `[0, 1]`.
#[must_use]
pub fn wilson(counts: Proportion, level: f64) -> [f64; 2] {
    let (k, n) = counts.as_f64();
    if counts.n == 0 {
        return [0.0, 1.0];
    }
    let z = -normal::quantile((1.0 - level) / 2.0);
    let squared = z * z;
    let root = z * (squared + 4.0 * k * ((n - k) / n)).sqrt();
    // The textbook lower limit (2k + z^2 - root) / (2 (n + z^2)) cancels for small k; the product of both limits is
    // k^2 / (n (n + z^2)), which does not.
    let low = if counts.k == 0 { 0.0 } else { 2.0 * k * (k / n) / (2.0 * k + squared + root) };
    let misses = n - k;
    let rest = if counts.k == counts.n { 0.0 } else { 2.0 * misses * (misses / n) / (2.0 * misses + squared + root) };
    [low, 1.0 - rest]
}

/// Jeffreys' interval. Without data it is `[0, 1]`.
#[must_use]
pub fn jeffreys(counts: Proportion, level: f64) -> [f64; 2] {
    let tail = (1.0 - level) / 2.0;
    let (k, n) = counts.as_f64();
    let low = if counts.k == 0 { 0.0 } else { beta::quantile(k + 0.5, n - k + 0.5, tail).0 };
    let high = if counts.k == counts.n { 1.0 } else { beta::quantile(n - k + 0.5, k + 0.5, tail).1 };
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::binomial::ExactBinomial;
    use proptest::prelude::*;

    fn near(found: [f64; 2], low: f64, high: f64) {
        assert!((found[0] - low).abs() < 5e-4 && (found[1] - high).abs() < 5e-4, "{found:?}");
    }

    #[test]
    fn the_paper_s_intervals() {
        let found = Intervals::new(Proportion { k: 9, n: 16 }, 0.95);
        near(found.clopper_pearson, 0.299, 0.802);
        near(found.wilson, 0.332, 0.769);
        near(found.jeffreys, 0.326, 0.778);
        near(clopper_pearson(Proportion { k: 9, n: 16 }, 0.9), 0.333, 0.773);
    }

    #[test]
    fn none_and_all_have_closed_forms() {
        // (1 - high)^n = alpha / 2 at k = 0.
        for n in [1, 16, 1000, 1_000_000_000] {
            let exact = -(0.025_f64.ln() / n as f64).exp_m1();
            let found = clopper_pearson(Proportion { k: 0, n }, 0.95);
            assert_eq!(found[0], 0.0);
            assert!((found[1] / exact - 1.0).abs() < 1e-12, "{n}");
            assert_eq!(clopper_pearson(Proportion { k: n, n }, 0.95)[1], 1.0);
        }
        assert_eq!(clopper_pearson(Proportion { k: 0, n: 0 }, 0.95), [0.0, 1.0]);
        assert_eq!(wilson(Proportion { k: 0, n: 0 }, 0.95), [0.0, 1.0]);
        assert_eq!(jeffreys(Proportion { k: 0, n: 0 }, 0.95), [0.0, 1.0]);
    }

    #[test]
    fn wilson_s_limits_are_where_the_score_test_turns() {
        let counts = Proportion { k: 3, n: 50 };
        let z = normal::quantile(0.975);
        for limit in wilson(counts, 0.95) {
            let score = (0.06 - limit) / (limit * (1.0 - limit) / 50.0).sqrt();
            assert!((score.abs() / z - 1.0).abs() < 1e-12);
        }
    }

    proptest! {
        #[test]
        fn the_exact_interval_and_the_exact_test_agree(k in 0..300_u64, more in 0..300_u64) {
            let counts = Proportion { k, n: k + more };
            prop_assume!(counts.n > 0);
            let [low, high] = clopper_pearson(counts, 0.95);
            let p = ExactBinomial::against_half(counts).p;
            prop_assert_eq!(low <= 0.5 && 0.5 <= high, p > 0.05);
        }

        #[test]
        fn intervals_mirror_and_hold_the_proportion(k in 0..300_u64, more in 0..300_u64, level in 0.5..0.999_f64) {
            let counts = Proportion { k, n: k + more };
            prop_assume!(counts.n > 0);
            let value = counts.value().unwrap();
            for of in [clopper_pearson, wilson, jeffreys] {
                let [low, high] = of(counts, level);
                let [mirrored_low, mirrored_high] = of(counts.complement(), level);
                prop_assert!(low <= value && value <= high);
                prop_assert!((low - (1.0 - mirrored_high)).abs() < 1e-13);
                prop_assert!((high - (1.0 - mirrored_low)).abs() < 1e-13);
            }
        }

        #[test]
        fn limits_grow_with_the_count(n in 1..300_u64, k in 0..300_u64) {
            prop_assume!(k < n);
            for of in [clopper_pearson, wilson, jeffreys] {
                let (here, next) = (of(Proportion { k, n }, 0.95), of(Proportion { k: k + 1, n }, 0.95));
                prop_assert!(here[0] < next[0] && here[1] < next[1] || next[1] == 1.0);
            }
        }
    }
}
