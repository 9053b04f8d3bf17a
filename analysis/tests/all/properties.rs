//! What must hold of every statistic whatever the counts: mirror images, and growth in the direction in which it must grow.

use analysis::bayes::{self, BayesFactors};
use analysis::binomial::{self, ExactBinomial};
use analysis::chi_square::{self, ChiSquare};
use analysis::contrast::{self, Contrast};
use analysis::effect::Effect;
use analysis::equivalence::{self, Tost};
use analysis::interval::{Intervals, clopper_pearson};
use analysis::order::{CorrectedTost, Order, power_of_both};
use analysis::proportion::Proportion;
use analysis::psychometric::{Curve, Family};
use analysis::tally::OrderTable;
use proptest::prelude::*;

fn effect(counts: Proportion) -> Effect {
    Effect::new(counts, clopper_pearson(counts, 0.95)).unwrap()
}

fn table(x: u64, n: u64, y: u64, m: u64) -> OrderTable {
    OrderTable { lower_second: Proportion { k: x, n }, lower_first: Proportion { k: y, n: m } }
}

fn near(found: f64, expected: f64) -> bool {
    found == expected || (found - expected).abs() <= 1e-11 * expected.abs().max(1e-290)
}

proptest! {
    /// Right and wrong, or first and second, change names.
    #[test]
    fn a_count_and_its_mirror_image(n in 1..2000_u64, share in 0.0..=1.0_f64, bound in 0.02..0.48_f64) {
        let counts = Proportion { k: (share * n as f64) as u64, n };
        let mirror = counts.complement();
        let chi = |counts| ChiSquare::against_half(counts).unwrap();
        prop_assert_eq!(chi(counts), chi(mirror));
        prop_assert_eq!(ExactBinomial::against_half(counts), ExactBinomial::against_half(mirror));
        let (here, there) = (effect(counts), effect(mirror));
        prop_assert!(near(here.h, -there.h) && near(here.g, -there.g) && near(here.w, there.w));
        prop_assert!((here.d_prime + there.d_prime).abs() < 1e-12 || here.d_prime == -there.d_prime);
        let (here, there) = (BayesFactors::new(counts), BayesFactors::new(mirror));
        prop_assert!(near(here.uniform.log10_bf01, there.uniform.log10_bf01) || here.uniform.log10_bf01.abs() < 1e-12);
        prop_assert!((here.jeffreys.log10_bf01 - there.jeffreys.log10_bf01).abs() < 1e-11 * n as f64);
        let (here, there) = (Tost::new(counts, bound, 0.05).unwrap(), Tost::new(mirror, bound, 0.05).unwrap());
        prop_assert!((here.log10_p - there.log10_p).abs() <= 1e-11 * n as f64);
        let (here, there) = (bayes::posterior_within(counts, bound), bayes::posterior_within(mirror, bound));
        prop_assert!((here - there).abs() <= 1e-10 * here.max(there));
    }

    /// One answer farther from the tie: less likely if everybody guesses, by every measure.
    #[test]
    fn one_answer_farther_from_the_tie(n in 2..2000_u64, share in 0.0..1.0_f64, bound in 0.02..0.48_f64) {
        let near_tie = Proportion { k: n.div_ceil(2) + (share * (n / 2) as f64) as u64, n };
        prop_assume!(near_tie.k < n);
        let far = Proportion { k: near_tie.k + 1, n };
        let chi = |counts| ChiSquare::against_half(counts).unwrap();
        prop_assert!(chi(far).statistic > chi(near_tie).statistic && chi(far).log10_p < chi(near_tie).log10_p);
        prop_assert!(ExactBinomial::against_half(far).log10_p < ExactBinomial::against_half(near_tie).log10_p);
        let (close, away) = (BayesFactors::new(near_tie), BayesFactors::new(far));
        prop_assert!(away.uniform.log10_bf01 < close.uniform.log10_bf01);
        prop_assert!(away.above_half.log10_bf01 < close.above_half.log10_bf01);
        prop_assert!(away.jeffreys.log10_bf01 < close.jeffreys.log10_bf01);
        let (close, away) = (effect(near_tie), effect(far));
        prop_assert!(away.h > close.h && away.w > close.w && away.g > close.g);
        prop_assert!(away.d_prime > close.d_prime && away.jod > close.jod);
        let (close, away) = (Tost::new(near_tie, bound, 0.05).unwrap(), Tost::new(far, bound, 0.05).unwrap());
        prop_assert!(away.log10_p >= close.log10_p && (close.passes || !away.passes));
        prop_assert!(bayes::posterior_within(far, bound) <= bayes::posterior_within(near_tie, bound) * (1.0 + 1e-12));
    }

    /// More confidence asks for a wider interval.
    #[test]
    fn a_higher_level_is_a_wider_interval(k in 0..500_u64, more in 0..500_u64, level in 0.5..0.99_f64) {
        let counts = Proportion { k, n: k + more };
        prop_assume!(counts.n > 0);
        let (narrow, wide) = (Intervals::new(counts, level), Intervals::new(counts, level + 0.009));
        for (narrow, wide) in [
            (narrow.clopper_pearson, wide.clopper_pearson),
            (narrow.wilson, wide.wilson),
            (narrow.jeffreys, wide.jeffreys),
        ] {
            prop_assert!(wide[0] <= narrow[0] && narrow[1] <= wide[1]);
        }
    }

    #[test]
    fn power_grows_with_the_effect(n in 6..400_u64, truth in 0.5..0.97_f64, alpha in 0.01..0.2_f64, bound in 0.05..0.45_f64) {
        let more = truth + 0.02;
        prop_assert!(binomial::power(n, more, alpha) >= binomial::power(n, truth, alpha) * (1.0 - 1e-12));
        prop_assert!(near(binomial::power(n, truth, alpha), binomial::power(n, 1.0 - truth, alpha))
            || (binomial::power(n, truth, alpha) - binomial::power(n, 1.0 - truth, alpha)).abs() < 1e-10);
        let chi = |truth| chi_square::power(n, truth, alpha).unwrap();
        prop_assert!(chi(more) >= chi(truth) * (1.0 - 1e-12));
        prop_assert!(binomial::power(n, 0.5, alpha) <= alpha);
        let alike = |truth| equivalence::power(n, truth, bound, alpha);
        prop_assert!(alike(more) <= alike(truth) * (1.0 + 1e-9) + 1e-300);
        prop_assert!(alike(0.5 + bound) <= alpha * (1.0 + 1e-9));
    }

    /// Two symmetries of the order table: the intervals change names (the lean turns), or every answer is turned round
    /// (what people see turns).
    #[test]
    fn orders_mirrored(n in 1..60_u64, m in 1..60_u64, u in 0.0..=1.0_f64, v in 0.0..=1.0_f64, bound in 0.05..0.45_f64) {
        let (x, y) = ((u * n as f64) as u64, (v * m as f64) as u64);
        let here = Order::new(&table(x, n, y, m)).unwrap();
        let renamed = table(m - y, m, n - x, n);
        let turned = table(n - x, n, m - y, m);
        let (other, back) = (Order::new(&renamed).unwrap(), Order::new(&turned).unwrap());
        prop_assert!((here.d_prime - other.d_prime).abs() < 1e-12 && (here.c + other.c).abs() < 1e-12);
        prop_assert!((here.d_prime + back.d_prime).abs() < 1e-12 && (here.c + back.c).abs() < 1e-12);
        let test = |table: &OrderTable| CorrectedTost::new(table, bound, 0.05).unwrap();
        for other in [renamed, turned] {
            prop_assert!((test(&table(x, n, y, m)).p - test(&other).p).abs() < 1e-7);
        }
        prop_assert!(test(&table(x, n, y, m)).p >= CorrectedTost::new(&table(x, n, y, m), 0.46, 0.05).unwrap().p - 1e-9);
    }

    /// One more right answer in the first arm.
    #[test]
    fn one_more_in_the_first_arm(m in 1..80_u64, n in 1..80_u64, u in 0.0..1.0_f64, v in 0.0..=1.0_f64) {
        let (a, b) = ((u * m as f64) as u64, (v * n as f64) as u64);
        let of = |a| Contrast::new(Proportion { k: a, n: m }, Proportion { k: b, n }, 0.95).unwrap();
        let (here, more) = (of(a), of(a + 1));
        prop_assert!(more.difference > here.difference && more.h > here.h);
        prop_assert!(more.newcombe[0] > here.newcombe[0] && more.newcombe[1] > here.newcombe[1]);
        for p in [here.fisher_p, here.barnard_p] {
            prop_assert!(p.unwrap() > 0.0 && p.unwrap() <= 1.0 + 1e-12);
        }
    }

    /// Holm's adjustment keeps the order, never helps, and lies below Bonferroni's.
    #[test]
    fn adjusted_p_values(p in proptest::collection::vec(0.0..=1.0_f64, 1..8)) {
        let adjusted = contrast::holm(&p);
        for (i, a) in adjusted.iter().enumerate() {
            prop_assert!(*a >= p[i] && *a <= (p[i] * p.len() as f64).min(1.0) + 1e-15);
            prop_assert!((0..p.len()).all(|j| p[i] > p[j] || adjusted[i] <= adjusted[j]));
        }
    }

    /// A psychometric function rises from one half to one less the lapse.
    #[test]
    fn curves_rise(threshold in -3.0..3.0_f64, width in 0.2..5.0_f64, lapse in 0.0..0.1_f64, x in -6.0..6.0_f64) {
        for family in Family::ALL {
            let curve = Curve { family, threshold, width, lapse };
            prop_assert!(curve.at(x) >= 0.5 && curve.at(x) <= 1.0 - lapse + 1e-12);
            prop_assert!(curve.at(x + 0.1) >= curve.at(x));
            prop_assert!((curve.at(threshold) - (0.5 + 0.5 * (0.5 - lapse))).abs() < 1e-12);
        }
    }
}

/// Both equivalence tests together: the lean takes power away, never the level.
#[test]
fn a_lean_costs_power() {
    let power: Vec<f64> = [0.0, 0.5, 1.0, 1.5].iter().map(|lean| power_of_both(22, 0.5, *lean, 0.25, 0.05)).collect();
    assert!(power.windows(2).all(|pair| pair[1] < pair[0]), "{power:?}");
}
