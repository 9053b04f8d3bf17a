//! Every statistic against tables of 40-digit arithmetic (`analysis/tests/data/golden.py` makes them with mpmath).

use std::collections::HashMap;

use analysis::bayes::BayesFactors;
use analysis::binomial::{self, ExactBinomial};
use analysis::chi_square::{self, ChiSquare};
use analysis::contrast::{Contrast, barnard};
use analysis::effect::Effect;
use analysis::equivalence::{self, Tost};
use analysis::interval::Intervals;
use analysis::proportion::Proportion;

/// A table: every row as numbers by column.
fn table(text: &str) -> impl Iterator<Item = HashMap<&str, f64>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(move |line| names.iter().copied().zip(line.split(',').map(|field| field.parse().unwrap())).collect())
}

/// Relative agreement of 1e-10; the tables have twelve digits.
#[track_caller]
fn same(found: f64, expected: f64, what: impl std::fmt::Display) {
    let fine = found == expected || (found - expected).abs() <= 1e-10 * expected.abs();
    assert!(fine, "{what}: found {found:e}, expected {expected:e}");
}

fn whole(row: &HashMap<&str, f64>, name: &str) -> u64 {
    row[name] as u64
}

#[test]
fn one_sample_statistics_of_all_counts_up_to_200() {
    let mut rows = 0;
    for row in table(include_str!("../data/one_sample.csv")) {
        rows += 1;
        let half = Proportion { k: whole(&row, "k"), n: whole(&row, "n") };
        for counts in [half, half.complement()] {
            let mirrored = counts != half;
            let check = |found: f64, name: &str| same(found, row[name], format_args!("{name} of {counts}"));
            let chi = ChiSquare::against_half(counts).unwrap();
            check(chi.statistic, "statistic");
            check(chi.p, "chi_p");
            same(10.0_f64.powf(chi.log10_p), row["chi_p"], "log10 p");
            check(ExactBinomial::against_half(counts).p, "exact_p");
            let found = Intervals::new(counts, 0.95);
            for (name, [low, high]) in
                [("cp", found.clopper_pearson), ("wilson", found.wilson), ("jeffreys", found.jeffreys)]
            {
                let (low_name, high_name) = (format!("{name}_lo"), format!("{name}_hi"));
                if mirrored {
                    same(low, 1.0 - row[high_name.as_str()], format_args!("{low_name} of {counts}"));
                    same(high, 1.0 - row[low_name.as_str()], format_args!("{high_name} of {counts}"));
                } else {
                    check(low, &low_name);
                    check(high, &high_name);
                }
            }
            let effect = Effect::new(counts, found.clopper_pearson).unwrap();
            let sign = if mirrored { -1.0 } else { 1.0 };
            check(sign * effect.h, "h");
            check(sign * effect.d_prime, "d_prime");
            let factors = BayesFactors::new(counts);
            check(factors.uniform.bf01, "bf01_uniform");
            check(factors.above_half.bf01, if mirrored { "bf01_below" } else { "bf01_above" });
            check(factors.jeffreys.bf01, "bf01_jeffreys");
            for (bound, name) in [(0.1, "tost_0.1"), (0.15, "tost_0.15"), (0.2, "tost_0.2"), (0.25, "tost_0.25")] {
                check(Tost::new(counts, bound, 0.05).unwrap().p, name);
            }
        }
    }
    // Every k up to n / 2, for every n from 1 to 200.
    assert_eq!(rows, (1..=200).map(|n| n / 2 + 1).sum::<u64>());
}

#[test]
fn sizes_and_powers_of_all_n_up_to_200() {
    for row in table(include_str!("../data/by_n.csv")) {
        let n = whole(&row, "n");
        let check = |found: f64, name: &str| same(found, row[name], format_args!("{name} at n = {n}"));
        check(chi_square::true_size(n, 0.05).unwrap(), "chi_size");
        check(chi_square::power(n, 0.75, 0.05).unwrap(), "chi_power_75");
        check(binomial::power(n, 0.5, 0.05), "exact_size");
        check(binomial::power(n, 0.75, 0.05), "exact_power_75");
        for (bound, name) in
            [(0.1, "tost_power_0.1"), (0.15, "tost_power_0.15"), (0.2, "tost_power_0.2"), (0.25, "tost_power_0.25")]
        {
            check(equivalence::power(n, 0.5, bound, 0.05), name);
        }
    }
}

#[test]
fn chi_square_from_1e_minus_300_to_1e300() {
    for row in table(include_str!("../data/chi_square.csv")) {
        let found = ChiSquare::from_statistic(row["statistic"], whole(&row, "df") as u32);
        let expected = row["log10_p"];
        // Where p is 1 but for what 40 digits cannot hold, the table says 0.
        let fine = (found.log10_p - expected).abs() <= 1e-10 * expected.abs() + 1e-15;
        assert!(fine, "df {} statistic {:e}: {} {expected}", row["df"], row["statistic"], found.log10_p);
        if expected > -300.0 {
            same(found.p, 10.0_f64.powf(found.log10_p), format_args!("p of {:e}", row["statistic"]));
        } else {
            assert!(found.p < 1e-299);
        }
    }
}

#[test]
fn two_sample_tests_of_whole_families_of_tables() {
    for row in table(include_str!("../data/two_sample.csv")) {
        let first = Proportion { k: whole(&row, "a"), n: whole(&row, "m") };
        let second = Proportion { k: whole(&row, "b"), n: whole(&row, "n") };
        let found = Contrast::new(first, second, 0.95).unwrap();
        let what = format!("{first} and {second}");
        let [low, high] = found.newcombe;
        assert!((low - row["newcombe_lo"]).abs() < 1e-11 && (high - row["newcombe_hi"]).abs() < 1e-11, "{what}");
        same(found.fisher_p.unwrap(), row["fisher_p"], format_args!("Fisher {what}"));
        same(barnard(first, second).unwrap(), row["barnard_p"], format_args!("Barnard {what}"));
    }
}
