//! A ladder of qualities: how the share of people who notice falls as the time spent on a picture grows.
//!
//! The function is `1/2 + (1/2 - lapse) F(x)`: guessing gives one half, and even the obvious is missed with probability
//! `lapse`. `x` is larger where noticing is easier. Parameters are those of Schuett and others (2016): `threshold`, where
//! F is one half, and `width`, from F = .05 to F = .95.
//!
//! Every person gives one answer, so the counts of a level are binomial whatever differs between people: there is no
//! over-dispersion to be estimated. What can fail is the curve, and the deviance shows that.

use serde::Serialize;

use crate::proportion::Proportion;
use crate::special::{gamma, normal};

/// The shape of F.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Cumulative Gaussian.
    Gaussian,
    /// Logistic.
    Logistic,
    /// Weibull of the exponential of x (Gumbel of x).
    Weibull,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Gaussian, Self::Logistic, Self::Weibull];

    /// F at `u` widths above the threshold.
    fn shape(self, u: f64) -> f64 {
        match self {
            // z(.95), ln(.95 / .05), and ln ln 20 - ln ln (20/19): what spans F = .05 to .95.
            Self::Gaussian => normal::cdf(2.0 * 1.644_853_626_951_472_7 * u),
            Self::Logistic => 1.0 / (1.0 + (-2.0 * 19.0_f64.ln() * u).exp()),
            Self::Weibull => {
                let span = 20.0_f64.ln().ln() - (20.0_f64 / 19.0).ln().ln();
                -(-std::f64::consts::LN_2 * (span * u).exp()).exp_m1()
            }
        }
    }
}

/// One level of a ladder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Its position; larger is easier to notice.
    pub x: f64,
    /// Right answers.
    pub counts: Proportion,
}

/// The curve's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// The shape.
    pub family: Family,
    /// Where F is one half.
    pub threshold: f64,
    /// From F = .05 to F = .95.
    pub width: f64,
    /// Probability of missing the obvious.
    pub lapse: f64,
}

impl Curve {
    /// Probability of a right answer at `x`.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        0.5 + (0.5 - self.lapse) * self.family.shape((x - self.threshold) / self.width)
    }

    fn ln_likelihood(&self, levels: &[Level]) -> f64 {
        levels.iter().map(|level| ln_binomial(level.counts, self.at(level.x))).sum()
    }
}

/// A fitted ladder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// The curve of largest likelihood.
    pub curve: Curve,
    /// Equal tails of the threshold's posterior (flat in threshold, in the logarithm of the width, and in the lapse from 0
    /// to .1).
    pub threshold_interval: [f64; 2],
    /// True where the interval ends within the levels shown: outside, the prior's limits speak.
    pub bracketed: bool,
    /// Deviance of the curve against a share of its own for each level.
    pub deviance: f64,
    /// The deviance's degrees of freedom: levels less three parameters; none where that is not positive.
    pub df: Option<u32>,
    /// Tail probability of the deviance: small where the curve does not fit.
    pub p: Option<f64>,
}

const THRESHOLDS: usize = 121;
const WIDTHS: usize = 41;
const LAPSES: usize = 11;
const MOST_LAPSE: f64 = 0.1;

/// Fits a ladder; none with fewer than three levels with people at different positions. `level` is the interval's.
#[must_use]
pub fn fit(levels: &[Level], family: Family, level: f64) -> Option<Fit> {
    let shown = |fold: fn(f64, f64) -> f64, from: f64| {
        levels.iter().filter(|level| level.counts.n > 0).map(|level| level.x).fold(from, fold)
    };
    let (low, high) = (shown(f64::min, f64::INFINITY), shown(f64::max, f64::NEG_INFINITY));
    let span = high - low;
    let mut positions: Vec<f64> = levels.iter().filter(|level| level.counts.n > 0).map(|level| level.x).collect();
    positions.sort_by(f64::total_cmp);
    positions.dedup();
    if positions.len() < 3 || !span.is_finite() {
        return None;
    }
    let share = |i: usize, of: usize| i as f64 / (of - 1) as f64;
    let curve_at = |i: usize, j: usize, k: usize| Curve {
        family,
        threshold: low - 0.5 * span + 2.0 * span * share(i, THRESHOLDS),
        width: span * 0.1 * 50.0_f64.powf(share(j, WIDTHS)),
        lapse: MOST_LAPSE * share(k, LAPSES),
    };
    let mut best = (f64::NEG_INFINITY, curve_at(0, 0, 0));
    let mut marginal = vec![Vec::new(); THRESHOLDS];
    for (i, column) in marginal.iter_mut().enumerate() {
        for j in 0..WIDTHS {
            for k in 0..LAPSES {
                let curve = curve_at(i, j, k);
                let ln = curve.ln_likelihood(levels);
                column.push(ln);
                if ln > best.0 {
                    best = (ln, curve);
                }
            }
        }
    }
    let masses: Vec<f64> = marginal.iter().map(|column| column.iter().map(|ln| (ln - best.0).exp()).sum()).collect();
    let tail = (1.0 - level) / 2.0;
    let at = |q: f64| curve_at(0, 0, 0).threshold + 2.0 * span * quantile(&masses, q);
    let threshold_interval = [at(tail), at(1.0 - tail)];
    let curve = climb(levels, best.1, span);
    let saturated: f64 =
        levels.iter().map(|level| ln_binomial(level.counts, level.counts.value().unwrap_or(0.5))).sum();
    let deviance = (2.0 * (saturated - curve.ln_likelihood(levels))).max(0.0);
    let df = u32::try_from(positions.len()).ok().and_then(|n| n.checked_sub(3)).filter(|df| *df > 0);
    Some(Fit {
        curve,
        threshold_interval,
        bracketed: low < threshold_interval[0] && threshold_interval[1] < high,
        deviance,
        df,
        p: df.map(|df| gamma::ln_upper(f64::from(df) / 2.0, deviance / 2.0).exp()),
    })
}

/// Improves a curve by steps along each parameter that halve when none helps.
fn climb(levels: &[Level], start: Curve, span: f64) -> Curve {
    let mut best = (start.ln_likelihood(levels), start);
    let mut step = 0.5;
    while step > 1e-7 {
        let mut moved = false;
        for direction in [-1.0, 1.0] {
            let here = best.1;
            let candidates = [
                Curve { threshold: here.threshold + direction * step * 0.05 * span, ..here },
                Curve { width: here.width * (direction * step * 0.2).exp(), ..here },
                Curve { lapse: (here.lapse + direction * step * 0.02).clamp(0.0, MOST_LAPSE), ..here },
            ];
            for curve in candidates {
                let ln = curve.ln_likelihood(levels);
                if ln > best.0 {
                    best = (ln, curve);
                    moved = true;
                }
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    best.1
}

/// `ln(p^k q^(n-k))`, 0 to the power 0 being 1.
fn ln_binomial(counts: Proportion, p: f64) -> f64 {
    let part = |count: u64, ln: f64| if count == 0 { 0.0 } else { count as f64 * ln };
    part(counts.k, p.ln()) + part(counts.n - counts.k, (-p).ln_1p())
}

/// Where the running sum of masses on an even grid over [0, 1] reaches `q`, between grid points in proportion.
fn quantile(masses: &[f64], q: f64) -> f64 {
    let total: f64 = masses.iter().sum();
    let mut sum = 0.0;
    for (i, mass) in masses.iter().enumerate() {
        let next = sum + mass / total;
        if next >= q && *mass > 0.0 {
            let inside = (q - sum) / (next - sum);
            return ((i as f64 - 0.5 + inside) / (masses.len() - 1) as f64).clamp(0.0, 1.0);
        }
        sum = next;
    }
    1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts as a curve would give them without chance, many people a level.
    fn ladder(curve: Curve, people: u64) -> Vec<Level> {
        (0..6)
            .map(|i| {
                let x = f64::from(i) - 2.5;
                let k = (curve.at(x) * people as f64).round() as u64;
                Level { x, counts: Proportion { k, n: people } }
            })
            .collect()
    }

    #[test]
    fn shapes_span_their_width() {
        for family in Family::ALL {
            let f = |u: f64| family.shape(u);
            assert!((f(0.0) - 0.5).abs() < 1e-12, "{family:?}");
            let ends = |low: f64| (f(low + 1.0) - 0.95).abs() < 1e-9 && (f(low) - 0.05).abs() < 1e-9;
            // Only the Weibull is not symmetric: its lower end lies farther from the threshold.
            let low = match family {
                Family::Weibull => {
                    let span = 20.0_f64.ln().ln() - (20.0_f64 / 19.0).ln().ln();
                    ((20.0_f64 / 19.0).ln().ln() - 2.0_f64.ln().ln()) / span
                }
                _ => -0.5,
            };
            assert!(ends(low), "{family:?}");
        }
    }

    #[test]
    fn a_curve_is_found_again() {
        for family in Family::ALL {
            let truth = Curve { family, threshold: 0.3, width: 2.0, lapse: 0.02 };
            let found = fit(&ladder(truth, 1_000_000), family, 0.95).unwrap();
            assert!((found.curve.threshold - 0.3).abs() < 0.01, "{family:?} {found:?}");
            assert!((found.curve.width - 2.0).abs() < 0.03 && (found.curve.lapse - 0.02).abs() < 2e-3, "{found:?}");
            assert!(found.bracketed && found.p.unwrap() > 0.5 && found.df == Some(3));
        }
    }

    #[test]
    fn few_people_give_a_wide_interval_about_the_truth() {
        let truth = Curve { family: Family::Logistic, threshold: 0.0, width: 2.0, lapse: 0.0 };
        let many = fit(&ladder(truth, 400), Family::Logistic, 0.95).unwrap().threshold_interval;
        let few = fit(&ladder(truth, 20), Family::Logistic, 0.95).unwrap().threshold_interval;
        for [low, high] in [many, few] {
            assert!(low < 0.0 && 0.0 < high);
        }
        assert!(few[1] - few[0] > 2.0 * (many[1] - many[0]));
    }

    #[test]
    fn a_ladder_that_nobody_notices_is_not_bracketed() {
        let levels: Vec<Level> =
            (0..5).map(|i| Level { x: f64::from(i), counts: Proportion { k: 20, n: 40 } }).collect();
        let found = fit(&levels, Family::Gaussian, 0.95).unwrap();
        assert!(!found.bracketed, "{found:?}");
    }

    #[test]
    fn a_curve_that_does_not_fit_is_told() {
        let shares = [0.95, 0.5, 0.95, 0.5, 0.95, 0.5];
        let levels: Vec<Level> = (0..6)
            .zip(shares)
            .map(|(i, share)| Level { x: f64::from(i), counts: Proportion { k: (share * 100.0) as u64, n: 100 } })
            .collect();
        assert!(fit(&levels, Family::Gaussian, 0.95).unwrap().p.unwrap() < 1e-6);
    }

    #[test]
    fn two_levels_are_no_ladder() {
        let level = |x| Level { x, counts: Proportion { k: 3, n: 4 } };
        assert_eq!(fit(&[level(0.0), level(1.0)], Family::Gaussian, 0.95), None);
        assert_eq!(fit(&[level(0.0), level(1.0), level(1.0)], Family::Gaussian, 0.95), None);
        assert_eq!(fit(&[], Family::Gaussian, 0.95), None);
    }
}
