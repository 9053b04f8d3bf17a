//! Bayes factors of "everybody guesses" against "some proportion", and the posterior of the proportion.

use serde::Serialize;

use crate::proportion::Proportion;
use crate::special::{beta, to_log10};
use std::f64::consts::{LN_2, PI};

/// A Bayes factor in favour of one half. Above 1 the data are likelier under one half, below 1 under the alternative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BayesFactor {
    /// P(data | one half) / P(data | the prior).
    pub bf01: f64,
    /// Its logarithm to the base 10, for values beyond the range of f64.
    pub log10_bf01: f64,
}

/// The factor under three priors of the proportion, since one prior alone can be chosen to please.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BayesFactors {
    /// Every proportion from 0 to 1 alike, Beta(1, 1).
    pub uniform: BayesFactor,
    /// Every proportion from 1/2 to 1 alike: nobody is right less often than by guessing.
    pub above_half: BayesFactor,
    /// Jeffreys' prior, Beta(1/2, 1/2).
    pub jeffreys: BayesFactor,
}

impl BayesFactors {
    /// The factors of `counts`; without data they are 1.
    #[must_use]
    pub fn new(counts: Proportion) -> Self {
        let (k, n) = counts.as_f64();
        let misses = n - k;
        // (1/2)^n / B(a, b) = 2^(a + b - n) (1/2)^a (1/2)^b / B(a, b): the prefactor of the incomplete beta function.
        let ln_uniform = beta::ln_prefix(k + 1.0, misses + 1.0, 0.5, 0.5) + 2.0 * LN_2;
        let ln_above = ln_uniform - LN_2 - beta::ln_upper(k + 1.0, misses + 1.0, 0.5, 0.5);
        let ln_jeffreys = beta::ln_prefix(k + 0.5, misses + 0.5, 0.5, 0.5) + LN_2 + PI.ln();
        let factor = |ln: f64| BayesFactor { bf01: ln.exp(), log10_bf01: to_log10(ln) };
        Self { uniform: factor(ln_uniform), above_half: factor(ln_above), jeffreys: factor(ln_jeffreys) }
    }
}

/// The probability, after `counts` and under the uniform prior, that the proportion lies within `bound` of one half.
#[must_use]
pub fn posterior_within(counts: Proportion, bound: f64) -> f64 {
    let (k, n) = counts.as_f64();
    let (a, b) = (k + 1.0, n - k + 1.0);
    let (low, high) = (0.5 - bound, 0.5 + bound);
    let mean = a / (a + b);
    // The difference of the two tails on the side where both are small, so that a tiny mass keeps its digits.
    if mean < low {
        beta::ln_upper(a, b, low, high).exp() - beta::ln_upper(a, b, high, low).exp()
    } else if mean > high {
        beta::ln_lower(a, b, high, low).exp() - beta::ln_lower(a, b, low, high).exp()
    } else {
        1.0 - beta::ln_lower(a, b, low, high).exp() - beta::ln_upper(a, b, high, low).exp()
    }
}

/// The posterior's density at `x` in (0, 1), after `counts` and under the uniform prior.
#[must_use]
pub fn posterior_density(counts: Proportion, x: f64) -> f64 {
    let (k, n) = counts.as_f64();
    let y = 1.0 - x;
    (beta::ln_prefix(k + 1.0, n - k + 1.0, x, y) - x.ln() - y.ln()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_s_three_factors() {
        let found = BayesFactors::new(Proportion { k: 9, n: 16 });
        // C(16, 9) 17 / 2^16.
        assert!((found.uniform.bf01 - 11_440.0 * 17.0 / 65_536.0).abs() < 1e-13);
        for (factor, value) in [(found.uniform, 2.97), (found.above_half, 2.16), (found.jeffreys, 4.49)] {
            assert!((factor.bf01 - value).abs() < 5e-3, "{}", factor.bf01);
        }
        let tie = BayesFactors::new(Proportion { k: 8, n: 16 });
        assert!((tie.uniform.bf01 - 3.34).abs() < 5e-3, "the most that 16 people can say");
    }

    #[test]
    fn the_posterior_s_mass() {
        let counts = Proportion { k: 9, n: 16 };
        for (bound, mass) in [(0.10, 0.549), (0.15, 0.749), (0.25, 0.957)] {
            assert!((posterior_within(counts, bound) - mass).abs() < 5e-4);
        }
        let steps = 2000;
        let sum: f64 = (0..steps).map(|i| posterior_density(counts, (f64::from(i) + 0.5) / f64::from(steps))).sum();
        assert!((sum / f64::from(steps) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn extremes() {
        let none = BayesFactors::new(Proportion { k: 0, n: 0 });
        for factor in [none.uniform, none.above_half, none.jeffreys] {
            assert!((factor.bf01 - 1.0).abs() < 1e-14);
        }
        let all = BayesFactors::new(Proportion { k: 1_000_000_000, n: 1_000_000_000 });
        assert_eq!(all.uniform.bf01, 0.0);
        // (n + 1) / 2^n.
        let exact = (1e9_f64 + 1.0).log10() - 1e9 * 2.0_f64.log10();
        assert!((all.uniform.log10_bf01 / exact - 1.0).abs() < 1e-12);
        assert!((all.above_half.log10_bf01 - all.uniform.log10_bf01 + 2.0_f64.log10()).abs() < 1e-6);
    }
}
