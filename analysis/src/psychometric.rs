//! A ladder of qualities: how the share of people who notice falls as the time spent on a picture grows.
//!
//! The function is `1/2 + (1/2 - lapse) F(x)`: guessing gives one half, and even the obvious is missed with probability
//! `lapse`. `x` is larger where noticing is easier. Parameters are those of Schuett and others (2016): `threshold`, where
//! F is one half, and `width`, from F = .05 to F = .95.
//!
//! Every person gives one answer at one level, so the counts of a level are binomial whatever differs between people.
//! What can scatter more is the levels about the curve, by their pictures or because the curve has another shape: the
//! dispersion says how much, and the deviance whether it is more than chance.

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
    /// The deviance's degrees of freedom: levels less the parameters that are free at the maximum; none where that is not
    /// positive.
    pub df: Option<u32>,
    /// Pearson's chi-square of the levels over the degrees of freedom: near 1 where the counts scatter about the curve as
    /// binomial counts do, above it where they scatter more.
    pub dispersion: Option<f64>,
    /// Tail probability of the deviance: small where the curve does not fit.
    pub p: Option<f64>,
}

const THRESHOLDS: usize = 241;
const WIDTHS: usize = 41;
const LAPSES: usize = 11;
const MOST_LAPSE: f64 = 0.1;

/// Fits a ladder; none with fewer than three levels with people at different positions. `level` is the interval's.
#[must_use]
pub fn fit(levels: &[Level], family: Family, level: f64) -> Option<Fit> {
    let (range, _) = Range::of(levels, family)?;
    let (curve, deviance, df) = likeliest(levels, family)?;
    let most = curve.ln_likelihood(levels);
    let share = |i: usize, of: usize| i as f64 / (of - 1) as f64;
    // The trapezoid rule: the ends of a range count half.
    let weight = |i: usize, of: usize| if i == 0 || i == of - 1 { 0.5 } else { 1.0 };
    let mass = |i: usize| -> f64 {
        let mut sum = 0.0;
        for j in 0..WIDTHS {
            for k in 0..LAPSES {
                let curve = range.curve([share(i, THRESHOLDS), share(j, WIDTHS), share(k, LAPSES)]);
                sum += weight(j, WIDTHS) * weight(k, LAPSES) * (curve.ln_likelihood(levels) - most).exp();
            }
        }
        sum
    };
    let masses: Vec<f64> = (0..THRESHOLDS).map(mass).collect();
    let tail = (1.0 - level) / 2.0;
    let threshold_interval = [tail, 1.0 - tail].map(|q| range.curve([quantile(&masses, q), 0.0, 0.0]).threshold);
    let high = range.low + range.span;
    let expected = |level: &Level| curve.at(level.x);
    let pearson: f64 = levels
        .iter()
        .filter(|level| level.counts.n > 0)
        .map(|level| {
            let ((k, n), p) = (level.counts.as_f64(), expected(level));
            (k - n * p).powi(2) / (n * p * (1.0 - p))
        })
        .sum();
    let df = Some(df).filter(|df| *df > 0);
    Some(Fit {
        curve,
        threshold_interval,
        bracketed: range.low < threshold_interval[0] && threshold_interval[1] < high,
        deviance,
        df,
        dispersion: df.map(|df| pearson / f64::from(df)).filter(|dispersion| dispersion.is_finite()),
        p: df.map(|df| gamma::ln_upper(f64::from(df) / 2.0, deviance / 2.0).exp()),
    })
}

impl Range {
    /// The range for levels, with the number of different positions; none with fewer than three.
    fn of(levels: &[Level], family: Family) -> Option<(Self, u32)> {
        let mut positions: Vec<f64> = levels.iter().filter(|level| level.counts.n > 0).map(|level| level.x).collect();
        positions.sort_by(f64::total_cmp);
        positions.dedup();
        let (low, high) = (*positions.first()?, *positions.last()?);
        let number = u32::try_from(positions.len()).ok()?;
        (number >= 3 && (high - low).is_finite()).then_some((Self { family, low, span: high - low }, number))
    }
}

/// What curves are considered: thresholds from half a span below the levels to half a span above, widths from a tenth of
/// the span to five spans, lapses from 0 to a tenth.
#[derive(Clone, Copy)]
struct Range {
    family: Family,
    low: f64,
    span: f64,
}

impl Range {
    /// The curve at a place in the unit cube: threshold, logarithm of the width, lapse.
    fn curve(&self, [threshold, width, lapse]: [f64; 3]) -> Curve {
        Curve {
            family: self.family,
            threshold: self.low - 0.5 * self.span + 2.0 * self.span * threshold,
            width: self.span * 0.1 * 50.0_f64.powf(width),
            lapse: MOST_LAPSE * lapse,
        }
    }

    /// The curve of largest likelihood: the best of a coarse grid, improved by Hooke and Jeeves' pattern search (1961)
    /// inside the range.
    ///
    /// Beside the curve, how many of its parameters lie on a limit of the range and so are not free.
    fn likeliest(&self, levels: &[Level]) -> (Curve, u32) {
        let value = |place: [f64; 3]| self.curve(place).ln_likelihood(levels);
        let mut base = (f64::NEG_INFINITY, [0.0; 3]);
        for i in 0..=12 {
            for j in 0..=6 {
                for k in 0..=1 {
                    let place = [f64::from(i) / 12.0, f64::from(j) / 6.0, f64::from(k) / 2.0];
                    let found = value(place);
                    if found > base.0 {
                        base = (found, place);
                    }
                }
            }
        }
        let explore = |from: (f64, [f64; 3]), step: f64| {
            let mut best = from;
            for axis in 0..3 {
                for direction in [step, -step] {
                    let mut place = best.1;
                    place[axis] = (place[axis] + direction).clamp(0.0, 1.0);
                    let found = value(place);
                    if found > best.0 {
                        best = (found, place);
                        break;
                    }
                }
            }
            best
        };
        let mut step = 0.05;
        while step > 1e-9 {
            let mut better = explore(base, step);
            if better.0 <= base.0 {
                step *= 0.5;
            }
            while better.0 > base.0 {
                // On in the direction that has just helped.
                let ahead = std::array::from_fn(|i| (2.0 * better.1[i] - base.1[i]).clamp(0.0, 1.0));
                base = better;
                better = explore((value(ahead), ahead), step);
            }
        }
        let on_a_limit = base.1.iter().filter(|part| **part < 1e-6 || **part > 1.0 - 1e-6).count();
        (self.curve(base.1), on_a_limit as u32)
    }
}

/// The curve of largest likelihood with its deviance against a share of its own for each level, and the deviance's degrees
/// of freedom, levels less free parameters: one that lies on a limit of its range fits nothing. None with fewer than three levels with people at different positions.
#[must_use]
pub fn likeliest(levels: &[Level], family: Family) -> Option<(Curve, f64, u32)> {
    let (range, positions) = Range::of(levels, family)?;
    let (curve, on_a_limit) = range.likeliest(levels);
    let saturated: f64 =
        levels.iter().map(|level| ln_binomial(level.counts, level.counts.value().unwrap_or(0.5))).sum();
    Some((curve, (2.0 * (saturated - curve.ln_likelihood(levels))).max(0.0), positions - 3 + on_a_limit))
}

/// `ln(p^k q^(n-k))`, 0 to the power 0 being 1.
fn ln_binomial(counts: Proportion, p: f64) -> f64 {
    let part = |count: u64, ln: f64| if count == 0 { 0.0 } else { count as f64 * ln };
    part(counts.k, p.ln()) + part(counts.n - counts.k, (-p).ln_1p())
}

/// Where the integral of masses on an even grid over [0, 1] reaches `q`, by the trapezoid rule.
fn quantile(masses: &[f64], q: f64) -> f64 {
    let pieces: Vec<f64> = masses.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let total: f64 = pieces.iter().sum();
    let mut sum = 0.0;
    for (i, piece) in pieces.iter().enumerate() {
        let next = sum + piece / total;
        if next >= q && *piece > 0.0 {
            return (i as f64 + ((q - sum) / (next - sum)).clamp(0.0, 1.0)) / pieces.len() as f64;
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
