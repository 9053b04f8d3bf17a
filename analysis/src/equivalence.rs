//! Whether a proportion is shown to be close to one half: two one-sided exact tests.

use serde::Serialize;

use crate::binomial;
use crate::proportion::Proportion;
use crate::special::to_log10;

/// Two one-sided tests (Schuirmann 1987), each exact: that the proportion is above `1/2 - bound`, and that it is below
/// `1/2 + bound`. Both must reject.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tost {
    /// Distance of the bounds from one half.
    pub bound: f64,
    /// P(X >= k) at the lower bound.
    pub p_lower: f64,
    /// P(X <= k) at the upper bound.
    pub p_upper: f64,
    /// The larger of the two.
    pub p: f64,
    /// The logarithm of `p` to the base 10.
    pub log10_p: f64,
    /// Whether `p` is at most the level.
    pub passes: bool,
}

impl Tost {
    /// The test of `counts` at `bound` in (0, 1/2); none without data.
    #[must_use]
    pub fn new(counts: Proportion, bound: f64, alpha: f64) -> Option<Self> {
        if counts.n == 0 {
            return None;
        }
        let lower = binomial::ln_at_least(counts.k, counts.n, 0.5 - bound);
        let upper = binomial::ln_at_most(counts.k, counts.n, 0.5 + bound);
        let ln_p = lower.max(upper);
        let p = ln_p.exp();
        Some(Self { bound, p_lower: lower.exp(), p_upper: upper.exp(), p, log10_p: to_log10(ln_p), passes: p <= alpha })
    }
}

/// The counts that pass with `n` people, first and last; none where no outcome can.
#[must_use]
pub fn passing(n: u64, bound: f64, alpha: f64) -> Option<(u64, u64)> {
    // P(X >= k) at the lower bound falls with k: the first k that passes, by bisection; the last by symmetry.
    let limit = alpha.ln();
    if n == 0 || binomial::ln_at_least(n, n, 0.5 - bound) > limit {
        return None;
    }
    let (mut low, mut high) = (0, n);
    while low < high {
        let middle = low + (high - low) / 2;
        if binomial::ln_at_least(middle, n, 0.5 - bound) <= limit { high = middle } else { low = middle + 1 }
    }
    (2 * low <= n).then_some((low, n - low))
}

/// The exact probability that the test passes with `n` people who are right with probability `truth`; 0, not less, where
/// no outcome can pass.
#[must_use]
pub fn power(n: u64, truth: f64, bound: f64, alpha: f64) -> f64 {
    passing(n, bound, alpha).map_or(0.0, |(first, last)| binomial::between(first, last, n, truth).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::clopper_pearson;
    use proptest::prelude::*;

    fn p(bound: f64) -> f64 {
        Tost::new(Proportion { k: 9, n: 16 }, bound, 0.05).unwrap().p
    }

    #[test]
    fn the_paper_s_case_fails_at_every_usual_bound() {
        for (bound, value) in [(0.25, 0.0796), (0.20, 0.175), (0.15, 0.312), (0.10, 0.473)] {
            assert!((p(bound) - value).abs() < 5e-4, "{bound}: {}", p(bound));
        }
    }

    #[test]
    fn the_smallest_numbers_that_can_pass() {
        for (bound, smallest) in [(0.25, 14), (0.20, 20), (0.15, 36), (0.10, 76)] {
            let first = (1..).find(|&n| passing(n, bound, 0.05).is_some()).unwrap();
            assert_eq!(first, smallest);
            assert_eq!(power(smallest - 1, 0.5, bound, 0.05), 0.0);
        }
    }

    #[test]
    fn nothing_is_shown_without_data() {
        assert_eq!(Tost::new(Proportion { k: 0, n: 0 }, 0.2, 0.05), None);
        let one = Tost::new(Proportion { k: 1, n: 1 }, 0.2, 0.05).unwrap();
        assert_eq!((one.p, one.passes), (1.0, false));
    }

    proptest! {
        /// The test passes exactly where the Clopper-Pearson interval at 1 - 2 alpha lies within the bounds.
        #[test]
        fn the_test_and_the_interval_agree(k in 0..400_u64, more in 0..400_u64, bound in 0.02..0.48_f64) {
            let counts = Proportion { k, n: k + more };
            prop_assume!(counts.n > 0);
            let [low, high] = clopper_pearson(counts, 0.9);
            let inside = 0.5 - bound < low && high < 0.5 + bound;
            prop_assert_eq!(Tost::new(counts, bound, 0.05).unwrap().passes, inside);
            let within = passing(counts.n, bound, 0.05).is_some_and(|(first, last)| (first..=last).contains(&k));
            prop_assert_eq!(within, inside);
        }

        #[test]
        fn a_wider_bound_is_easier(k in 0..200_u64, more in 1..200_u64, bound in 0.02..0.4_f64) {
            let counts = Proportion { k, n: k + more };
            let test = |bound| Tost::new(counts, bound, 0.05).unwrap().p;
            prop_assert!(test(bound + 0.05) <= test(bound));
            let mirrored = Tost::new(counts.complement(), bound, 0.05).unwrap().p;
            prop_assert!((test(bound) - mirrored).abs() <= 1e-12 * mirrored);
        }
    }
}
