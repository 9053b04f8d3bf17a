//! The exact binomial test, and the binomial distribution's tails that exact tests are made of.

use serde::Serialize;

use crate::proportion::Proportion;
use crate::special::{beta, to_log10};

/// `ln P(X <= k)` for `X` binomial of `n` trials with success probability `p`.
#[must_use]
pub fn ln_at_most(k: u64, n: u64, p: f64) -> f64 {
    if k >= n {
        return 0.0;
    }
    beta::ln_lower((n - k) as f64, k as f64 + 1.0, 1.0 - p, p)
}

/// `ln P(X >= k)`.
#[must_use]
pub fn ln_at_least(k: u64, n: u64, p: f64) -> f64 {
    if k == 0 {
        return 0.0;
    }
    if k > n {
        return f64::NEG_INFINITY;
    }
    beta::ln_lower(k as f64, (n - k) as f64 + 1.0, p, 1.0 - p)
}

/// `ln P(X = k)`.
#[must_use]
pub fn ln_exactly(k: u64, n: u64, p: f64) -> f64 {
    if k > n {
        return f64::NEG_INFINITY;
    }
    let (hits, misses) = (k as f64, (n - k) as f64);
    let ends = |count: f64, ln: f64| if count == 0.0 { 0.0 } else { count * ln };
    if k == 0 || k == n {
        return ends(hits, p.ln()) + ends(misses, (-p).ln_1p());
    }
    // The density of Beta(k, n - k) at p, scaled: C(n, k) p^k q^(n-k) = prefix(k, n - k) n / (k (n - k)).
    beta::ln_prefix(hits, misses, p, 1.0 - p) + (n as f64).ln() - hits.ln() - misses.ln()
}

/// `P(first <= X <= last)`.
#[must_use]
pub fn between(first: u64, last: u64, n: u64, p: f64) -> f64 {
    let below = |k: u64| ln_at_most(k, n, p).exp();
    let beyond = |k: u64| ln_at_least(k, n, p).exp();
    let mean = n as f64 * p;
    // The difference of the two tails on the side where both are small, so that a tiny probability keeps its digits.
    if first > last {
        0.0
    } else if mean < first as f64 {
        beyond(first) - beyond(last + 1)
    } else if first == 0 {
        below(last)
    } else if mean > last as f64 {
        below(last) - below(first - 1)
    } else {
        1.0 - below(first - 1) - beyond(last + 1)
    }
}

/// The two-sided exact test of one half.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExactBinomial {
    /// Twice the smaller tail, at most 1 (at one half this equals the sum of the outcomes no likelier than this one).
    pub p: f64,
    /// The logarithm of `p` to the base 10.
    pub log10_p: f64,
}

impl ExactBinomial {
    /// `k` of `n` against one half. With `n` = 0 there is nothing to doubt: 1.
    #[must_use]
    pub fn against_half(counts: Proportion) -> Self {
        let k = counts.k.min(counts.n - counts.k);
        // In the middle both tails together hold everything.
        let middle = counts.n - 2 * k <= 1;
        let ln_p = if middle { 0.0 } else { (ln_at_most(k, counts.n, 0.5) + std::f64::consts::LN_2).min(0.0) };
        Self { p: ln_p.exp(), log10_p: to_log10(ln_p) }
    }
}

/// The largest `k` that the two-sided exact test of one half rejects at `alpha` with `n` people, and by symmetry
/// `n - k` and beyond; none where no outcome is rejected.
#[must_use]
pub fn rejects_up_to(n: u64, alpha: f64) -> Option<u64> {
    let limit = (alpha / 2.0).ln();
    if n == 0 || ln_at_most(0, n, 0.5) > limit {
        return None;
    }
    let (mut low, mut high) = (0, n / 2);
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        if ln_at_most(middle, n, 0.5) <= limit { low = middle } else { high = middle - 1 }
    }
    Some(low)
}

/// The exact power of the two-sided exact test when a person is right with probability `truth`; at one half its size.
#[must_use]
pub fn power(n: u64, truth: f64, alpha: f64) -> f64 {
    rejects_up_to(n, alpha)
        .map_or(0.0, |k| (ln_at_most(k, n, truth).exp() + ln_at_least(n - k, n, truth).exp()).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn p(k: u64, n: u64) -> f64 {
        ExactBinomial::against_half(Proportion { k, n }).p
    }

    #[test]
    fn the_paper_s_value() {
        // 2 P(X >= 9), X of 16: 2 * 26333 / 65536.
        assert!((p(9, 16) - 2.0 * 26_333.0 / 65_536.0).abs() < 1e-15);
        assert_eq!(p(8, 16), 1.0);
        assert_eq!(p(0, 0), 1.0);
        assert_eq!(p(1, 1), 1.0);
    }

    #[test]
    fn the_test_of_sixteen() {
        assert_eq!(rejects_up_to(16, 0.05), Some(3));
        assert!((power(16, 0.5, 0.05) - 2.0 * 697.0 / 65_536.0).abs() < 1e-15);
        assert!((power(16, 0.75, 0.05) - 0.405).abs() < 5e-4);
        assert_eq!(rejects_up_to(5, 0.05), None);
        assert_eq!(power(5, 0.9, 0.05), 0.0);
    }

    #[test]
    fn extremes_stay_numbers() {
        let all = ExactBinomial::against_half(Proportion { k: 1_000_000_000, n: 1_000_000_000 });
        assert_eq!(all.p, 0.0);
        // All alike: 2^(1 - n).
        assert!((all.log10_p / (-999_999_999.0 * 2.0_f64.log10()) - 1.0).abs() < 1e-12);
        assert!(p(500_000_000, 1_000_000_000) == 1.0);
        assert!(p(500_000_001, 1_000_000_000) < 1.0);
    }

    #[test]
    fn single_outcomes_add_up() {
        for (n, chance) in [(1, 0.3), (16, 0.5), (200, 0.75)] {
            let sum: f64 = (0..=n).map(|k| ln_exactly(k, n, chance).exp()).sum();
            assert!((sum - 1.0).abs() < 1e-13);
        }
        assert_eq!(ln_exactly(0, 0, 0.5), 0.0);
    }

    #[test]
    fn what_lies_between_adds_up_wherever_it_lies() {
        let sum =
            |first: u64, last: u64, n: u64, p: f64| -> f64 { (first..=last).map(|k| ln_exactly(k, n, p).exp()).sum() };
        for (first, last, n, p) in [
            (10, 30, 200, 0.9),
            (150, 190, 200, 0.1),
            (80, 120, 200, 0.5),
            (0, 16, 16, 0.3),
            (0, 2, 16, 0.9),
            (7, 7, 9, 0.5),
        ] {
            let exact = sum(first, last, n, p);
            assert!((between(first, last, n, p) / exact - 1.0).abs() < 1e-11, "{first} {last} {n} {p}");
        }
        assert_eq!(between(3, 2, 16, 0.5), 0.0);
    }

    proptest! {
        #[test]
        fn right_and_wrong_are_alike(k in 0..400_u64, more in 0..400_u64) {
            prop_assert_eq!(p(k, k + more), p(more, k + more));
        }

        #[test]
        fn farther_from_half_is_less_likely(n in 1..500_u64, k in 0..250_u64) {
            prop_assume!(2 * k + 2 <= n);
            prop_assert!(p(k, n) < p(k + 1, n));
        }

        #[test]
        fn tails_add_up(n in 1..1000_u64, share in 0.0..1.0_f64, chance in 0.01..0.99_f64) {
            let k = (share * n as f64) as u64;
            let sum = ln_at_most(k, n, chance).exp() + ln_at_least(k + 1, n, chance).exp();
            prop_assert!((sum - 1.0).abs() < 1e-12);
        }
    }
}
