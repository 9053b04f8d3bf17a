//! The order of the two intervals: sensitivity and bias apart, and equivalence that bias cannot fake.
//!
//! With H and F the probabilities of answering "second" where the lower quality is second and first, the model is
//! H = Phi(b + d), F = Phi(b - d): `d` is what people see, `b` a lean towards an interval (Macmillan and Creelman 2005,
//! chapter 7). Without bias the proportion correct is Phi(d). A lean pulls the raw proportion towards one half, so that a
//! raw equivalence test can pass though people see the difference.

use serde::Serialize;

use crate::binomial;
use crate::equivalence::Tost;
use crate::proportion::Proportion;
use crate::special::normal;
use crate::tally::OrderTable;

/// Sensitivity and bias.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Order {
    /// Share answering "second" where the lower quality is second.
    pub hit_rate: f64,
    /// Share answering "second" where the lower quality is first.
    pub false_alarm_rate: f64,
    /// True where a share of 0 or 1 made the log-linear correction needed: one half added to every cell (Hautus 1995).
    pub corrected: bool,
    /// Sensitivity d' of two-interval forced choice, `(z(H) - z(F)) / sqrt 2`.
    pub d_prime: f64,
    /// Bias c, `-(z(H) + z(F)) / 2`: negative leans towards the second interval.
    pub c: f64,
}

impl Order {
    /// Sensitivity and bias of a table; none where an order was never shown.
    #[must_use]
    pub fn new(table: &OrderTable) -> Option<Self> {
        let (hits, false_alarms) = (table.lower_second, table.lower_first);
        if hits.n == 0 || false_alarms.n == 0 {
            return None;
        }
        let extreme = |counts: Proportion| counts.k == 0 || counts.k == counts.n;
        let corrected = extreme(hits) || extreme(false_alarms);
        let rate = |counts: Proportion| {
            let (k, n) = counts.as_f64();
            if corrected { (k + 0.5) / (n + 1.0) } else { k / n }
        };
        let (h, f) = (normal::quantile(rate(hits)), normal::quantile(rate(false_alarms)));
        Some(Self {
            hit_rate: hits.value()?,
            false_alarm_rate: false_alarms.value()?,
            corrected,
            d_prime: (h - f) / std::f64::consts::SQRT_2,
            c: -0.5 * (h + f),
        })
    }
}

/// Two one-sided tests on the order-corrected proportion correct, Phi(d), by profile likelihood with the bias free.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CorrectedTost {
    /// Distance of the bounds from one half.
    pub bound: f64,
    /// The corrected proportion, Phi((z(H) - z(F)) / 2); `null` in JSON where every answer was the same interval.
    pub proportion: f64,
    /// Its profile-likelihood interval at 1 - 2 alpha, which lies within the bounds exactly where the test passes.
    pub interval: [f64; 2],
    /// The larger of the two one-sided p values, each from the signed root of the likelihood ratio.
    pub p: f64,
    /// Whether `p` is at most the level.
    pub passes: bool,
}

impl CorrectedTost {
    /// The test of a table at `bound` in (0, 1/2); none where an order was never shown.
    #[must_use]
    pub fn new(table: &OrderTable, bound: f64, alpha: f64) -> Option<Self> {
        let likelihood = Likelihood::new(table)?;
        let limit = normal::quantile(0.5 + bound);
        let p = likelihood.p(limit);
        let z = normal::quantile(1.0 - alpha);
        let low = likelihood.where_root_is(z);
        let high = likelihood.where_root_is(-z);
        Some(Self {
            bound,
            proportion: normal::cdf(likelihood.best),
            interval: [normal::cdf(low), normal::cdf(high)],
            p,
            passes: p <= alpha,
        })
    }
}

/// The exact probability that raw and order-corrected test both pass with `half` people an order, when a person without a
/// lean would be right with probability `truth` and the lean is `bias` (0: none).
#[must_use]
pub fn power_of_both(half: u64, truth: f64, bias: f64, bound: f64, alpha: f64) -> f64 {
    let d = normal::quantile(truth);
    let chances = |z: f64| -> Vec<f64> {
        let p = normal::cdf(z);
        (0..=half).map(|k| binomial::ln_exactly(k, half, p).exp()).collect()
    };
    let (hits, false_alarms) = (chances(bias + d), chances(bias - d));
    let limit = normal::quantile(0.5 + bound);
    let mut sum = 0.0;
    for (x, hit) in (0..).zip(&hits) {
        for (y, false_alarm) in (0..).zip(&false_alarms) {
            let chance = hit * false_alarm;
            if chance < 1e-14 {
                continue;
            }
            let table =
                OrderTable { lower_second: Proportion { k: x, n: half }, lower_first: Proportion { k: y, n: half } };
            let raw = Tost::new(table.correct(), bound, alpha).is_some_and(|test| test.passes);
            if raw && Likelihood::new(&table).is_some_and(|likelihood| likelihood.p(limit) <= alpha) {
                sum += chance;
            }
        }
    }
    sum
}

/// Beyond this many standard deviations Phi is 0 or 1 for any number of people.
const FAR: f64 = 38.0;

struct Likelihood {
    /// Answers "second" and "first" where the lower quality is second, then where it is first.
    counts: [f64; 4],
    /// The logarithm of the likelihood at its maximum over both parameters.
    most: f64,
    /// The maximum's `d`: infinite where it is reached only in the limit, not a number where every `d` does as well.
    best: f64,
}

impl Likelihood {
    fn new(table: &OrderTable) -> Option<Self> {
        let (hits, false_alarms) = (table.lower_second, table.lower_first);
        if hits.n == 0 || false_alarms.n == 0 {
            return None;
        }
        let saturated = |counts: Proportion| {
            let (k, n) = counts.as_f64();
            let part = |count: f64| if count == 0.0 { 0.0 } else { count * (count / n).ln() };
            part(k) + part(n - k)
        };
        let z = |counts: Proportion| counts.value().map_or(f64::NAN, normal::quantile);
        let ((x, n), (y, m)) = (hits.as_f64(), false_alarms.as_f64());
        Some(Self {
            counts: [x, n - x, y, m - y],
            most: saturated(hits) + saturated(false_alarms),
            best: 0.5 * (z(hits) - z(false_alarms)),
        })
    }

    fn at(&self, d: f64, b: f64) -> f64 {
        let arguments = [b + d, -b - d, b - d, d - b];
        self.counts
            .iter()
            .zip(arguments)
            .map(|(&count, at)| if count == 0.0 { 0.0 } else { count * normal::ln_cdf(at) })
            .sum()
    }

    /// The slope along the bias. It falls with `b`: the likelihood is log-concave.
    fn slope(&self, d: f64, b: f64) -> f64 {
        let arguments = [b + d, -b - d, b - d, d - b];
        let signs = [1.0, -1.0, 1.0, -1.0];
        // phi / Phi, by logarithms so that far tails divide.
        let ratio = |at: f64| (-0.5 * at * at - 0.5 * (2.0 * std::f64::consts::PI).ln() - normal::ln_cdf(at)).exp();
        (0..4).filter(|&i| self.counts[i] > 0.0).map(|i| signs[i] * self.counts[i] * ratio(arguments[i])).sum()
    }

    /// The logarithm of the likelihood at `d`, with the bias that suits it best.
    fn profile(&self, d: f64) -> f64 {
        let (mut low, mut high) = (-FAR - d.abs(), FAR + d.abs());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.slope(d, middle) > 0.0 { low = middle } else { high = middle }
        }
        self.at(d, 0.5 * (low + high))
    }

    /// The signed root of twice the log-likelihood ratio: positive where `d` lies below the maximum. Standard normal for
    /// large numbers of people if `d` is the truth.
    fn root(&self, d: f64) -> f64 {
        if self.best.is_nan() {
            return 0.0;
        }
        let size = (2.0 * (self.most - self.profile(d))).max(0.0).sqrt();
        if d <= self.best { size } else { -size }
    }

    /// The larger of the two one-sided p values of `d` lying beyond either bound.
    fn p(&self, limit: f64) -> f64 {
        normal::sf(self.root(-limit)).max(normal::cdf(self.root(limit)))
    }

    /// The `d` at which the root is `z`, or the end of the line on that side.
    fn where_root_is(&self, z: f64) -> f64 {
        let (mut low, mut high) = (-8.0, 8.0);
        if self.root(low) <= z {
            return f64::NEG_INFINITY;
        }
        if self.root(high) >= z {
            return f64::INFINITY;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.root(middle) > z { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(x: u64, n: u64, y: u64, m: u64) -> OrderTable {
        OrderTable { lower_second: Proportion { k: x, n }, lower_first: Proportion { k: y, n: m } }
    }

    #[test]
    fn without_a_lean_the_correction_changes_nothing() {
        // 6 of 8 right in both orders: H = 3/4, F = 1/4.
        let found = Order::new(&table(6, 8, 2, 8)).unwrap();
        assert!((found.d_prime - std::f64::consts::SQRT_2 * normal::quantile(0.75)).abs() < 1e-14);
        assert!(found.c.abs() < 1e-15 && !found.corrected);
        let test = CorrectedTost::new(&table(6, 8, 2, 8), 0.2, 0.05).unwrap();
        assert!((test.proportion - 0.75).abs() < 1e-14);
    }

    #[test]
    fn everybody_who_leans_is_corrected_for() {
        // Phi(b + d) and Phi(b - d) with d = z(.75), b = 1, in 10^6 people an order.
        let d = normal::quantile(0.75);
        let count = |z: f64| (normal::cdf(z) * 1e6).round() as u64;
        let table = table(count(1.0 + d), 1_000_000, count(1.0 - d), 1_000_000);
        assert!((table.correct().value().unwrap() - 0.663).abs() < 1e-3, "the raw proportion is pulled to one half");
        let test = CorrectedTost::new(&table, 0.2, 0.05).unwrap();
        assert!((test.proportion - 0.75).abs() < 1e-5);
        assert!((Order::new(&table).unwrap().c + 1.0).abs() < 1e-5);
        assert!(!test.passes && Tost::new(table.correct(), 0.2, 0.05).unwrap().passes);
    }

    #[test]
    fn the_interval_lies_within_the_bounds_where_the_test_passes() {
        for x in 0..=22 {
            for y in (0..=22).step_by(3) {
                let test = CorrectedTost::new(&table(x, 22, y, 22), 0.2, 0.05).unwrap();
                let inside = test.interval[0] >= 0.3 && test.interval[1] <= 0.7;
                assert!((test.p - 0.05).abs() < 1e-6 || test.passes == inside, "{x} {y} {test:?}");
                assert!(test.interval[0] < test.interval[1]);
            }
        }
    }

    /// p values by an independent optimiser (scipy 1.17, `minimize_scalar` over the bias).
    #[test]
    fn p_values_agree_with_another_optimiser() {
        for (table, p) in [
            (table(5, 8, 4, 8), 0.125_534_497_778_503),
            (table(20, 22, 18, 22), 0.106_305_316_745_976),
            (table(50, 100, 50, 100), 1.761_737_909_433e-9),
        ] {
            let found = CorrectedTost::new(&table, 0.2, 0.05).unwrap().p;
            assert!((found / p - 1.0).abs() < 1e-8, "{found} {p}");
        }
    }

    #[test]
    fn one_interval_always_chosen_shows_nothing() {
        for table in [table(8, 8, 8, 8), table(0, 8, 0, 8)] {
            let test = CorrectedTost::new(&table, 0.2, 0.05).unwrap();
            assert_eq!((test.p, test.passes, test.interval), (0.5, false, [0.0, 1.0]));
            assert!(test.proportion.is_nan());
            assert!(Tost::new(table.correct(), 0.25, 0.05).is_some());
        }
        assert_eq!(CorrectedTost::new(&table(3, 8, 0, 0), 0.2, 0.05), None);
        assert_eq!(Order::new(&table(0, 0, 3, 8)), None);
    }

    #[test]
    fn a_perfect_observer_is_not_equivalent() {
        let test = CorrectedTost::new(&table(8, 8, 0, 8), 0.2, 0.05).unwrap();
        assert_eq!(test.proportion, 1.0);
        assert!(!test.passes && test.interval[1] == 1.0);
        assert!(Order::new(&table(8, 8, 0, 8)).unwrap().corrected);
    }

    /// The exact probability that each test passes, with 22 people an order and the truth on the bound: the figures that
    /// show why the raw test alone must not decide.
    #[test]
    fn a_lean_fakes_raw_equivalence_but_not_both() {
        let bound = 0.25;
        let d = normal::quantile(0.75);
        // The raw test alone, by the distribution of the two counts.
        let raw_alone = |c: f64| -> f64 {
            let mass =
                |z: f64| -> Vec<f64> { (0..=22).map(|k| binomial::ln_exactly(k, 22, normal::cdf(z)).exp()).collect() };
            let (hits, false_alarms) = (mass(c + d), mass(c - d));
            let passes = |x: usize, y: usize| {
                Tost::new(table(x as u64, 22, y as u64, 22).correct(), bound, 0.05).unwrap().passes
            };
            let all = (0..=22).flat_map(|x| (0..=22).map(move |y| (x, y)));
            all.filter(|&(x, y)| passes(x, y)).map(|(x, y)| hits[x] * false_alarms[y]).sum()
        };
        for (c, raw) in [(0.0, 0.03), (1.0, 0.25), (1.5, 0.76)] {
            let found = raw_alone(c);
            assert!((found - raw).abs() < 0.01, "raw at c = {c}: {found}");
        }
        for halves in 0..=6 {
            let c = f64::from(halves) / 2.0;
            let found = power_of_both(22, 0.75, c, bound, 0.05);
            assert!(found <= 0.05, "both at c = {c}: {found}");
        }
    }
}
