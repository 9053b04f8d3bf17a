//! The one-sample chi-square test, as the 2005 study used it: counts against equal shares.

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::binomial;
use crate::proportion::Proportion;
use crate::special::{gamma, to_log10};

/// A chi-square statistic with its tail probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ChiSquare {
    /// Pearson's sum of (observed - expected)^2 / expected.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: u32,
    /// P(chi-square >= statistic) by the survival function; 0 where it is below the range of f64.
    pub p: f64,
    /// The logarithm of `p` to the base 10, which has no such limit.
    pub log10_p: f64,
}

impl ChiSquare {
    /// The tail probability of a statistic. `statistic` >= 0, `df` >= 1.
    #[must_use]
    pub fn from_statistic(statistic: f64, df: u32) -> Self {
        let ln_p = gamma::ln_upper(f64::from(df) / 2.0, statistic / 2.0);
        let p = ChiSquared::new(f64::from(df)).map_or(f64::NAN, |distribution| distribution.sf(statistic));
        Self { statistic, df, p, log10_p: to_log10(ln_p) }
    }

    /// `k` of `n` against one half; none where `n` is 0.
    #[must_use]
    pub fn against_half(counts: Proportion) -> Option<Self> {
        if counts.n == 0 {
            return None;
        }
        // sum of (o - n/2)^2 / (n/2) over both cells is (k - (n - k))^2 / n.
        let difference = counts.k.abs_diff(counts.n - counts.k) as f64;
        Some(Self::from_statistic(difference * (difference / counts.n as f64), 1))
    }
}

/// The smallest expected count of `k` of `n` against one half. Under 5 the approximation is usually distrusted.
#[must_use]
pub fn least_expected(n: u64) -> f64 {
    n as f64 / 2.0
}

/// The critical value: where the tail of `df` degrees of freedom is `alpha`. By bisection on the survival function.
#[must_use]
pub fn critical(df: u32, alpha: f64) -> f64 {
    let target = alpha.ln();
    let tail = |x: f64| gamma::ln_upper(f64::from(df) / 2.0, x / 2.0);
    let (mut low, mut high) = (0.0, 1.0);
    while tail(high) > target {
        high *= 2.0;
    }
    while high - low > 1e-14 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if tail(middle) > target { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The smallest distance |k - n/2|, doubled, at which chi-square against one half exceeds its critical value.
fn rejects_from(n: u64, alpha: f64) -> u64 {
    // (2k - n)^2 / n > critical; 2k - n has the parity of n.
    let mut distance = (critical(1, alpha) * n as f64).sqrt() as u64;
    distance = distance.saturating_sub(2);
    distance += (distance ^ n) & 1;
    while (distance as f64) * (distance as f64) / n as f64 <= critical(1, alpha) {
        distance += 2;
    }
    distance
}

/// The true size of the rule "chi-square above its critical value at `alpha`" with `n` people answering by chance: the
/// exact probability of rejecting. None at `n` = 0.
#[must_use]
pub fn true_size(n: u64, alpha: f64) -> Option<f64> {
    power(n, 0.5, alpha)
}

/// The exact probability that the rule rejects when a person is right with probability `truth`.
#[must_use]
pub fn power(n: u64, truth: f64, alpha: f64) -> Option<f64> {
    if n == 0 {
        return None;
    }
    let distance = rejects_from(n, alpha);
    if distance > n {
        return Some(0.0);
    }
    let (low, high) = ((n - distance) / 2, (n + distance) / 2);
    Some((binomial::ln_at_most(low, n, truth).exp() + binomial::ln_at_least(high, n, truth).exp()).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn test(k: u64, n: u64) -> ChiSquare {
        ChiSquare::against_half(Proportion { k, n }).expect("n is not 0")
    }

    #[test]
    fn the_paper_s_value() {
        let found = test(9, 16);
        assert_eq!((found.statistic, found.df), (0.25, 1));
        assert!((found.p - 0.617_075_077_451_973_9).abs() < 1e-14, "{}", found.p);
        assert_eq!(test(7, 16), found);
    }

    #[test]
    fn two_degrees_of_freedom_have_a_closed_form() {
        for x in [1e-300, 0.1, 5.991_464_547_107_98, 1400.0] {
            let found = ChiSquare::from_statistic(x, 2);
            assert!((found.p - (-x / 2.0).exp()).abs() <= 1e-12 * found.p);
            assert!((found.log10_p + x / 2.0 / std::f64::consts::LN_10).abs() <= 1e-12 * x.max(1.0));
        }
    }

    #[test]
    fn statistics_of_any_size_have_a_p() {
        let tiny = ChiSquare::from_statistic(1e-300, 1);
        assert_eq!(tiny.p, 1.0);
        // 1 - p is sqrt(2 x / pi) there.
        let exact = -(2e-300 / std::f64::consts::PI).sqrt() / std::f64::consts::LN_10;
        assert!((tiny.log10_p / exact - 1.0).abs() < 1e-12);
        let huge = ChiSquare::from_statistic(1e300, 1);
        assert_eq!(huge.p, 0.0);
        assert!((huge.log10_p / (-0.5e300 / std::f64::consts::LN_10) - 1.0).abs() < 1e-14);
        let far = ChiSquare::from_statistic(2000.0, 1);
        assert_eq!(far.p, 0.0);
        // mpmath, 50 digits: log10 erfc(sqrt(1000)).
        assert!((far.log10_p - -436.043_273_716_073).abs() < 1e-9, "{}", far.log10_p);
    }

    #[test]
    fn a_thousand_million_of_a_thousand_million() {
        let all = test(1_000_000_000, 1_000_000_000);
        assert_eq!((all.statistic, all.p), (1e9, 0.0));
        assert!(all.log10_p < -2e8);
        assert_eq!(ChiSquare::against_half(Proportion { k: 0, n: 0 }), None);
    }

    #[test]
    fn critical_values_are_the_tables() {
        for (df, alpha, value) in
            [(1, 0.05, 3.841_458_820_694_124), (1, 0.01, 6.634_896_601_021_213), (2, 0.05, 5.991_464_547_107_98)]
        {
            assert!((critical(df, alpha) - value).abs() < 1e-12);
        }
    }

    #[test]
    fn the_rule_s_true_size_at_sixteen() {
        // 12:4 has chi-square 4 > 3.84: P(X <= 4) + P(X >= 12) = 2 * 2517 / 65536.
        assert!((true_size(16, 0.05).unwrap() - 2.0 * 2517.0 / 65_536.0).abs() < 1e-15);
        assert!((power(16, 0.75, 0.05).unwrap() - 0.630).abs() < 5e-4);
        assert_eq!(true_size(3, 0.05), Some(0.0));
        assert_eq!(true_size(0, 0.05), None);
    }
}
