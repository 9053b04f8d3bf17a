//! Ten thousand simulated experiments under a true null, for every test that is offered: the share that rejects must agree
//! with the test's own exact size.
//!
//! The seed is fixed. Each comparison uses a Clopper-Pearson interval of the simulated share at 99.9 %, so a correct test
//! would fail one in a thousand of them for a seed chosen at random.

use std::collections::HashMap;

use analysis::binomial::{self, ExactBinomial};
use analysis::chi_square::{self, ChiSquare};
use analysis::contrast::{self, Contrast};
use analysis::equivalence::{self, Tost};
use analysis::interval::{Intervals, clopper_pearson};
use analysis::order::{CorrectedTost, power_of_both};
use analysis::plan::{Bound, PlannedBound};
use analysis::proportion::Proportion;
use analysis::psychometric::{Curve, Family, Level, likeliest};
use analysis::report::equivalence::Equivalence;
use analysis::report::words::{self, Finding};
use analysis::special::normal;
use analysis::tally::{ArmTally, OrderTable};

const EXPERIMENTS: u64 = 10_000;
const ALPHA: f64 = 0.05;

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Draws(u64);

impl Draws {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// `n` people who are each right (or choose the second) with probability `p`.
    fn people(&mut self, n: u64, p: f64) -> Proportion {
        let mut counts = Proportion::default();
        (0..n).for_each(|_| counts.count(self.uniform() < p));
        counts
    }
}

/// Runs the experiments and holds the share of rejections against `size`; returns the share.
#[track_caller]
fn agrees(what: &str, seed: u64, size: f64, mut rejects: impl FnMut(&mut Draws) -> bool) -> f64 {
    let mut draws = Draws(seed);
    let mut found = Proportion::default();
    (0..EXPERIMENTS).for_each(|_| found.count(rejects(&mut draws)));
    let [low, high] = clopper_pearson(found, 0.999);
    println!("{what}: {found} simulated, 99.9 % interval {low:.4} to {high:.4}, exact {size:.4}");
    assert!(low <= size && size <= high, "{what}: {found} simulated, size {size}");
    found.value().unwrap()
}

/// The exact probability that two independent binomial counts fall where `rejects` says.
fn exact(m: u64, p: f64, n: u64, q: f64, rejects: impl Fn(u64, u64) -> bool) -> f64 {
    let all = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
    all.filter(|&(i, j)| rejects(i, j))
        .map(|(i, j)| (binomial::ln_exactly(i, m, p) + binomial::ln_exactly(j, n, q)).exp())
        .sum()
}

/// The same decision for the same two counts, computed once.
fn remembered(decide: impl Fn(u64, u64) -> bool) -> impl FnMut(u64, u64) -> bool {
    let mut known = HashMap::new();
    move |i, j| *known.entry((i, j)).or_insert_with(|| decide(i, j))
}

#[test]
fn chi_square_has_its_true_size_not_its_nominal_one() {
    let size = chi_square::true_size(16, ALPHA).unwrap();
    let share =
        agrees("chi-square", 1, size, |draws| ChiSquare::against_half(draws.people(16, 0.5)).unwrap().p < ALPHA);
    assert!(share > 0.06, "at 16 people the rule rejects too often: {share}");
}

#[test]
fn exact_binomial_and_the_verdict() {
    // The right answers, the interval chosen and the layout chosen all go through this test.
    let size = binomial::power(16, 0.5, ALPHA);
    assert!(size <= ALPHA);
    agrees("exact binomial", 2, size, |draws| ExactBinomial::against_half(draws.people(16, 0.5)).p <= ALPHA);
    agrees("the verdict \"notice\"", 3, size, |draws| {
        let counts = draws.people(16, 0.5);
        let intervals = Intervals::new(counts, 1.0 - ALPHA);
        let finding = words::verdict(&ArmTally::of_correct(counts), Some(&intervals), None).finding;
        matches!(finding, Finding::Noticed | Finding::Reversed)
    });
}

#[test]
fn raw_equivalence_on_its_bound() {
    let (n, bound) = (44, 0.25);
    let size = equivalence::power(n, 0.5 + bound, bound, ALPHA);
    assert!(size <= ALPHA);
    agrees("TOST", 4, size, |draws| Tost::new(draws.people(n, 0.5 + bound), bound, ALPHA).unwrap().passes);
}

/// The truth on the bound, for leans from none to strong: what the report calls equivalent keeps its level.
#[test]
fn claimed_equivalence_on_its_bound_whatever_the_lean() {
    let (half, bound) = (22, Bound::from_proportion(0.25).unwrap());
    let table =
        |x, y| OrderTable { lower_second: Proportion { k: x, n: half }, lower_first: Proportion { k: y, n: half } };
    let claims = |x, y| {
        let order = table(x, y);
        let tally = ArmTally { order: Some(order), ..ArmTally::of_correct(order.correct()) };
        Equivalence::new(&tally, PlannedBound { bound, recorded: true }, ALPHA).unwrap().claimed
    };
    let known: Vec<Vec<bool>> = (0..=half).map(|x| (0..=half).map(|y| claims(x, y)).collect()).collect();
    let d = normal::quantile(0.75);
    for (seed, lean) in [(5, 0.0), (6, 0.5), (7, 1.0), (8, 1.5)] {
        let (hit, false_alarm) = (normal::cdf(lean + d), normal::cdf(lean - d));
        let claimed = |x: u64, y: u64| known[x as usize][y as usize];
        let size = exact(half, hit, half, false_alarm, claimed);
        assert!(size <= ALPHA, "lean {lean}: {size}");
        agrees(&format!("equivalence, lean {lean}"), seed, size, |draws| {
            claimed(draws.people(half, hit).k, draws.people(half, false_alarm).k)
        });
    }
}

/// The order-corrected test alone is a likelihood-ratio test: its size is near its level, not below it.
#[test]
fn order_corrected_equivalence_on_its_bound() {
    let (half, bound) = (22, 0.25);
    let passes = |x, y| {
        let table =
            OrderTable { lower_second: Proportion { k: x, n: half }, lower_first: Proportion { k: y, n: half } };
        CorrectedTost::new(&table, bound, ALPHA).unwrap().passes
    };
    let d = normal::quantile(0.75);
    let (hit, false_alarm) = (normal::cdf(0.5 + d), normal::cdf(0.5 - d));
    let size = exact(half, hit, half, false_alarm, passes);
    assert!(size < 1.3 * ALPHA, "{size}");
    let mut passes = remembered(passes);
    agrees("order-corrected TOST", 9, size, |draws| {
        passes(draws.people(half, hit).k, draws.people(half, false_alarm).k)
    });
}

#[test]
fn two_arms_alike() {
    let n = 16;
    let of = |x, y| (Proportion { k: x, n }, Proportion { k: y, n });
    let fisher = |x, y| contrast::fisher(of(x, y).0, of(x, y).1).unwrap() <= ALPHA;
    let barnard = |x, y| contrast::barnard(of(x, y).0, of(x, y).1).unwrap() <= ALPHA;
    let newcombe = |x, y| {
        let [low, high] = Contrast::new(of(x, y).0, of(x, y).1, 1.0 - ALPHA).unwrap().newcombe;
        low > 0.0 || high < 0.0
    };
    let mut share = Vec::new();
    type Rejects<'a> = &'a dyn Fn(u64, u64) -> bool;
    let tests: [(&str, Rejects<'_>, f64); 3] =
        [("Fisher", &fisher, ALPHA), ("Barnard", &barnard, ALPHA), ("Newcombe", &newcombe, 1.2 * ALPHA)];
    for (seed, (name, rejects, most)) in (10..).zip(tests) {
        for p in [0.5, 0.75] {
            let size = exact(n, p, n, p, rejects);
            assert!(size <= most, "{name} at {p}: {size}");
            let mut rejects = remembered(rejects);
            share.push(agrees(name, seed, size, |draws| rejects(draws.people(n, p).k, draws.people(n, p).k)));
        }
    }
    assert!(share[2] > share[0], "Barnard's test is less timid than Fisher's");
}

/// Right answers by order and by layout: Fisher's test in halves of 8.
#[test]
fn orders_and_layouts_alike() {
    let n = 8;
    let rejects = |x, y| contrast::fisher(Proportion { k: x, n }, Proportion { k: y, n }).unwrap() <= ALPHA;
    let size = exact(n, 0.6, n, 0.6, rejects);
    assert!(size <= ALPHA);
    let mut rejects = remembered(rejects);
    agrees("order effect", 20, size, |draws| rejects(draws.people(n, 0.6).k, draws.people(n, 0.6).k));
}

/// Three arms of guessers: the chance that any Holm-adjusted p is at most the level. Exactly one less the chance that the
/// smallest of three exact p values is above a third of it.
#[test]
fn several_arms_of_guessers() {
    let n = 44;
    let below_third = binomial::power(n, 0.5, ALPHA / 3.0);
    let size = 1.0 - (1.0 - below_third).powi(3);
    assert!(size <= ALPHA);
    agrees("Holm", 21, size, |draws| {
        let p: Vec<f64> = (0..3).map(|_| ExactBinomial::against_half(draws.people(n, 0.5)).p).collect();
        contrast::holm(&p).iter().any(|p| *p <= ALPHA)
    });
}

/// The fit of a ladder: five steps, 44 people each, a curve that is true. The p value of the deviance is asymptotic and
/// three parameters are free within limits, so its size is not known exactly: it must not lie above the level's 99.9 %
/// interval.
#[test]
fn a_true_curve_is_rarely_said_not_to_fit() {
    let truth = Curve { family: Family::Logistic, threshold: 0.2, width: 3.0, lapse: 0.02 };
    let mut draws = Draws(30);
    let mut rejected = Proportion::default();
    for _ in 0..EXPERIMENTS {
        let levels: Vec<Level> = (0..5)
            .map(|i| {
                let x = f64::from(i) - 2.0;
                Level { x, counts: draws.people(44, truth.at(x)) }
            })
            .collect();
        let (_, deviance, df) = likeliest(&levels, Family::Logistic).unwrap();
        rejected.count(ChiSquare::from_statistic(deviance, df).p < ALPHA);
    }
    let [low, high] = clopper_pearson(rejected, 0.999);
    println!("deviance of a true curve: {rejected} simulated, 99.9 % interval {low:.4} to {high:.4}, stated {ALPHA}");
    assert!(low <= ALPHA, "{rejected}");
    // Nor is it a test that never rejects: a quarter of its level would be that.
    assert!(high > 0.5 * ALPHA, "{rejected}");
}

/// What is said of habits: a preference for an interval or a layout, where nobody has one.
#[test]
fn preferences_that_nobody_has() {
    let n = 16;
    let size = binomial::power(n, 0.5, ALPHA);
    agrees("preference", 26, size, |draws| {
        let counts = draws.people(n, 0.5);
        let said = words::preference("It", counts, Some(&Intervals::new(counts, 1.0 - ALPHA)));
        said.contains("lies above 50 %") || said.contains("lies below 50 %")
    });
}

/// Power, too, is what it is said to be.
#[test]
fn power_is_what_it_is_said_to_be() {
    let (n, truth) = (42, 0.75);
    let power = binomial::power(n, truth, ALPHA);
    assert!(power >= 0.9);
    agrees("power", 22, power, |draws| ExactBinomial::against_half(draws.people(n, truth)).p <= ALPHA);
    let rule = chi_square::power(16, truth, ALPHA).unwrap();
    agrees("power of the chi-square rule", 24, rule, |draws| {
        ChiSquare::against_half(draws.people(16, truth)).unwrap().p < ALPHA
    });
    let both = power_of_both(22, 0.5, 0.5, 0.25, ALPHA);
    let mut passes = remembered(|x, y| {
        let half = |k| Proportion { k, n: 22 };
        let order = OrderTable { lower_second: half(x), lower_first: half(y) };
        Tost::new(order.correct(), 0.25, ALPHA).unwrap().passes
            && CorrectedTost::new(&order, 0.25, ALPHA).unwrap().passes
    });
    agrees("power of both equivalence tests", 25, both, |draws| {
        passes(draws.people(22, normal::cdf(0.5)).k, draws.people(22, normal::cdf(0.5)).k)
    });
    let power = equivalence::power(44, 0.5, 0.25, ALPHA);
    agrees("power of equivalence", 23, power, |draws| Tost::new(draws.people(44, 0.5), 0.25, ALPHA).unwrap().passes);
}
