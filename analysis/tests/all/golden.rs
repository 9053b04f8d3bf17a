//! Every statistic against tables of 40-digit arithmetic (`analysis/tests/data/golden.py` makes them with mpmath).

use std::collections::HashMap;
use std::io::Read;

use analysis::bayes::{self, BayesFactors};
use analysis::binomial::{self, ExactBinomial};
use analysis::chi_square::{self, ChiSquare};
use analysis::contrast::Contrast;
use analysis::effect::Effect;
use analysis::equivalence::{self, Tost};
use analysis::interval::Intervals;
use analysis::order::{CorrectedTost, Order};
use analysis::power::Reach;
use analysis::proportion::Proportion;
use analysis::psychometric::{Curve, Family, Level, fit};
use analysis::tally::OrderTable;

const BOUNDS: [f64; 4] = [0.1, 0.15, 0.2, 0.25];

type Row<'a> = HashMap<&'a str, &'a str>;

/// A table: every row by column.
fn table(text: &str) -> impl Iterator<Item = Row<'_>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(move |line| names.iter().copied().zip(line.split(',')).collect())
}

fn number(row: &Row<'_>, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name}: {}", row[name]))
}

fn whole(row: &Row<'_>, name: &str) -> u64 {
    row[name].parse().unwrap_or_else(|_| panic!("{name}: {}", row[name]))
}

/// Relative agreement of 1e-10; the tables have thirteen digits.
#[track_caller]
fn same(found: f64, expected: f64, what: impl std::fmt::Display) {
    let fine = found == expected || (found - expected).abs() <= 1e-10 * expected.abs();
    assert!(fine, "{what}: found {found:e}, expected {expected:e}");
}

#[test]
fn one_sample_statistics_of_all_counts_up_to_200() {
    let mut text = String::new();
    flate2::read::GzDecoder::new(&include_bytes!("../data/one_sample.csv.gz")[..]).read_to_string(&mut text).unwrap();
    let mut rows = 0;
    for row in table(&text) {
        rows += 1;
        let half = Proportion { k: whole(&row, "k"), n: whole(&row, "n") };
        one_sample(half, &row, false);
        one_sample(half.complement(), &row, true);
    }
    // Every k up to n / 2, for every n from 1 to 200.
    assert_eq!(rows, (1..=200).map(|n| n / 2 + 1).sum::<u64>());
}

/// `counts` against the row, or against its mirror image.
fn one_sample(counts: Proportion, row: &Row<'_>, mirrored: bool) {
    let check = |found: f64, name: &str| same(found, number(row, name), format_args!("{name} of {counts}"));
    let sign = if mirrored { -1.0 } else { 1.0 };
    // Both ends of an interval; a mirrored one ends where one less the other begins.
    let ends = |[low, high]: [f64; 2], name: &str| {
        let [low_name, high_name] = [format!("{name}_lo"), format!("{name}_hi")];
        if mirrored {
            same(low, 1.0 - number(row, &high_name), format_args!("{low_name} of {counts}"));
            same(high, 1.0 - number(row, &low_name), format_args!("{high_name} of {counts}"));
        } else {
            check(low, &low_name);
            check(high, &high_name);
        }
    };
    let (k, n) = (counts.k as f64, counts.n as f64);
    let chi = ChiSquare::against_half(counts).unwrap();
    same(chi.statistic, (2.0 * k - n).powi(2) / n, format_args!("chi-square of {counts}"));
    check(chi.p, "chi_p");
    check(10.0_f64.powf(chi.log10_p), "chi_p");
    let exact = ExactBinomial::against_half(counts);
    check(exact.p, "exact_p");
    check(10.0_f64.powf(exact.log10_p), "exact_p");
    let found = Intervals::new(counts, 0.95);
    ends(found.clopper_pearson, "cp");
    ends(found.wilson, "wilson");
    ends(found.jeffreys, "jeffreys");
    let effect = Effect::new(counts, found.clopper_pearson).unwrap();
    check(sign * effect.h, "h");
    same(effect.w, (2.0 * k - n).abs() / n, format_args!("w of {counts}"));
    same(effect.g, (2.0 * k - n) / (2.0 * n), format_args!("g of {counts}"));
    check(sign * effect.d_prime, "d_prime");
    let [low, high] = effect.d_prime_interval;
    check(if mirrored { -high } else { low }, "d_prime_lo");
    check(if mirrored { -low } else { high }, "d_prime_hi");
    check(sign * effect.jod, "jod");
    let factors = BayesFactors::new(counts);
    for (factor, name) in [
        (factors.uniform, "bf01_uniform"),
        (factors.above_half, if mirrored { "bf01_below" } else { "bf01_above" }),
        (factors.jeffreys, "bf01_jeffreys"),
    ] {
        check(factor.bf01, name);
        check(10.0_f64.powf(factor.log10_bf01), name);
    }
    for bound in BOUNDS {
        let test = Tost::new(counts, bound, 0.05).unwrap();
        let (lower, upper) = if mirrored { (test.p_upper, test.p_lower) } else { (test.p_lower, test.p_upper) };
        check(lower, &format!("tost_lower_{bound}"));
        check(upper, &format!("tost_upper_{bound}"));
        // Below one half the lower bound is the nearer one.
        check(test.p, &format!("tost_lower_{bound}"));
        check(10.0_f64.powf(test.log10_p), &format!("tost_lower_{bound}"));
        check(bayes::posterior_within(counts, bound), &format!("posterior_{bound}"));
    }
}

#[test]
fn sizes_powers_and_reach_of_all_n_up_to_200() {
    let mut rows = 0;
    for row in table(include_str!("../data/by_n.csv")) {
        rows += 1;
        let n = whole(&row, "n");
        let check = |found: f64, name: &str| same(found, number(&row, name), format_args!("{name} at n = {n}"));
        check(chi_square::true_size(n, 0.05).unwrap(), "chi_size");
        check(binomial::power(n, 0.5, 0.05), "exact_size");
        for truth in [0.6, 0.75, 0.9] {
            check(chi_square::power(n, truth, 0.05).unwrap(), &format!("chi_power_{truth}"));
            check(binomial::power(n, truth, 0.05), &format!("exact_power_{truth}"));
        }
        for bound in BOUNDS {
            for truth in [0.5, 0.6, 0.99] {
                check(equivalence::power(n, truth, bound, 0.05), &format!("tost_power_{truth}_{bound}"));
            }
        }
        let reach = Reach::new(n, 0.05).unwrap();
        for (found, name) in [(reach.smallest_bound, "smallest_bound"), (reach.detectable, "detectable")] {
            let expected = number(&row, name);
            assert_eq!(found.is_none(), expected.is_nan(), "{name} at n = {n}");
            if let Some(found) = found {
                check(found, name);
            }
        }
    }
    assert_eq!(rows, 200);
}

#[test]
fn chi_square_from_1e_minus_300_to_1e300() {
    let mut rows = 0;
    for row in table(include_str!("../data/chi_square.csv")) {
        rows += 1;
        let (statistic, df, expected) =
            (number(&row, "statistic"), row["df"].parse().unwrap(), number(&row, "log10_p"));
        let found = ChiSquare::from_statistic(statistic, df);
        // Below f64's range the logarithm of a p that is 1 is 0.
        same(
            found.log10_p,
            if expected.abs() < 1e-307 { found.log10_p } else { expected },
            format_args!("df {df} {statistic:e}"),
        );
        assert!(found.log10_p.abs() <= 1.1 * expected.abs() + f64::MIN_POSITIVE);
        if expected > -300.0 {
            same(found.p, 10.0_f64.powf(expected), format_args!("p of {statistic:e}, df {df}"));
        } else {
            assert!(found.p < 1e-299 && found.log10_p < -299.0);
        }
    }
    assert_eq!(rows, 6 * 42);
}

#[test]
fn two_sample_statistics_of_whole_families_of_tables() {
    let mut rows = 0;
    for row in table(include_str!("../data/two_sample.csv")) {
        rows += 1;
        let first = Proportion { k: whole(&row, "a"), n: whole(&row, "m") };
        let second = Proportion { k: whole(&row, "b"), n: whole(&row, "n") };
        let found = Contrast::new(first, second, 0.95).unwrap();
        let check = |found: f64, name: &str| same(found, number(&row, name), format_args!("{name}, {first}, {second}"));
        // A difference that is small because two shares are alike has the rounding of the shares.
        let near = |found: f64, name: &str| {
            let expected = number(&row, name);
            assert!((found - expected).abs() <= 1e-10 * expected.abs() + 1e-15, "{name}, {first}, {second}: {found:e}");
        };
        near(found.difference, "difference");
        near(found.newcombe[0], "newcombe_lo");
        near(found.newcombe[1], "newcombe_hi");
        near(found.h, "h");
        check(found.fisher_p.unwrap(), "fisher_p");
        check(found.barnard_p.unwrap(), "barnard_p");
    }
    assert_eq!(rows, 4 + 16 + 35 + 81 + 289 + 150);
}

#[test]
fn sensitivity_bias_and_order_corrected_equivalence() {
    let mut rows = 0;
    for row in table(include_str!("../data/order.csv")) {
        rows += 1;
        let order = OrderTable {
            lower_second: Proportion { k: whole(&row, "x"), n: whole(&row, "n") },
            lower_first: Proportion { k: whole(&row, "y"), n: whole(&row, "m") },
        };
        let check = |found: f64, name: &str| {
            let expected = number(&row, name);
            // Around 0 a difference of quantiles has the quantiles' rounding.
            let fine = (found - expected).abs() <= 1e-10 * expected.abs() + 1e-15;
            assert!(fine, "{name} of {order:?}: {found:e} {expected:e}");
        };
        let found = Order::new(&order).unwrap();
        check(found.d_prime, "d_prime");
        check(found.c, "c");
        for bound in [0.1, 0.25] {
            let test = CorrectedTost::new(&order, bound, 0.05).unwrap();
            check(test.proportion, "proportion");
            check(test.p, &format!("p_{bound}"));
            check(test.interval[0], "low");
            check(test.interval[1], "high");
        }
    }
    assert_eq!(rows, 175);
}

/// Fits by another optimiser, and the posterior's quantiles on a finer grid by another rule.
#[test]
fn ladders_fitted_by_another_optimiser() {
    let mut ladders: HashMap<&str, Vec<Level>> = HashMap::new();
    for row in table(include_str!("../data/ladder_steps.csv")) {
        let counts = Proportion { k: whole(&row, "k"), n: whole(&row, "n") };
        ladders.entry(row["ladder"]).or_default().push(Level { x: number(&row, "x"), counts });
    }
    let mut rows = 0;
    for row in table(include_str!("../data/ladder.csv")) {
        rows += 1;
        let family = match row["family"] {
            "gaussian" => Family::Gaussian,
            "logistic" => Family::Logistic,
            _ => Family::Weibull,
        };
        let found = fit(&ladders[row["ladder"]], family, 0.95).unwrap();
        let near = |found: f64, name: &str, tolerance: f64| {
            let expected = number(&row, name);
            assert!((found - expected).abs() < tolerance, "{name} of {row:?}: {found} {expected}");
        };
        // The likelihood is flat along a valley of thresholds, widths and lapses: its height is known far better than its
        // place: the curves agree where they were looked at.
        near(found.deviance, "deviance", 1e-7);
        near(found.curve.threshold, "threshold", 5e-3);
        let curve = |name: &str| number(&row, name);
        let expected = Curve { family, threshold: curve("threshold"), width: curve("width"), lapse: curve("lapse") };
        for level in &ladders[row["ladder"]] {
            let (here, there) = (found.curve.at(level.x), expected.at(level.x));
            assert!((here - there).abs() < 1e-4, "{row:?} at {}: {here} {there}", level.x);
        }
        // Steps lie 1 apart, the program's grid 1/24.
        near(found.threshold_interval[0], "low", 0.02);
        near(found.threshold_interval[1], "high", 0.02);
    }
    assert_eq!(rows, 18);
}
