//! One arm: its counts, its tests, its sentences.

use std::collections::BTreeMap;

use serde::Serialize;

use super::equivalence::Equivalence;
use super::words::{self, Verdict};
use crate::bayes::{self, BayesFactors};
use crate::binomial::ExactBinomial;
use crate::chi_square::{self, ChiSquare};
use crate::contrast;
use crate::counting::Accuracy;
use crate::effect::Effect;
use crate::equivalence::Tost;
use crate::interval::Intervals;
use crate::order::Order;
use crate::plan::PlannedBound;
use crate::power::{Question, Reach, sample_size};
use crate::proportion::Proportion;
use crate::tally::{ArmTally, OrderTable};

/// The bounds that papers use, as distances of the proportion from one half.
pub const USUAL_BOUNDS: [f64; 4] = [0.10, 0.15, 0.20, 0.25];

/// The one-sample tests of a proportion against one half. All are none without data.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Tests {
    /// Pearson's chi-square, as in 2005.
    pub chi_square: Option<ChiSquare>,
    /// The probability that "chi-square above its critical value" rejects at this n when everybody guesses.
    pub chi_square_true_size: Option<f64>,
    /// The smaller expected count; under 5 the chi-square approximation is poor.
    pub least_expected: Option<f64>,
    /// The exact test, which decides.
    pub binomial: Option<ExactBinomial>,
    /// Intervals of the proportion.
    pub intervals: Option<Intervals>,
    /// Effect sizes.
    pub effect: Option<Effect>,
    /// Bayes factors of one half against three priors.
    pub bayes: Option<BayesFactors>,
}

/// A proportion with its tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OneSample {
    /// How many.
    pub k: u64,
    /// Of how many.
    pub n: u64,
    /// `k / n`.
    pub proportion: Option<f64>,
    /// The tests against one half.
    #[serde(flatten)]
    pub tests: Tests,
    /// What they say.
    pub sentence: String,
}

/// How often one layout of a pair was chosen as the worse: the scene preference test of 2005.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayoutChosen {
    /// The layout whose choices `k` counts.
    pub layout: String,
    /// The other one.
    pub other: String,
    /// The tests against one half.
    #[serde(flatten)]
    pub chosen: OneSample,
}

/// Right answers by the order of the two qualities.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OrderReport {
    /// How often the second interval was chosen, by where the lower quality was.
    pub second_chosen: OrderTable,
    /// Sensitivity and bias; none where one order was never shown.
    pub signal_detection: Option<Order>,
    /// Fisher's exact test of right answers by order.
    pub fisher_p: Option<f64>,
}

/// Right answers by the layout that was of the lower quality.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayoutEffect {
    /// Right answers of each layout.
    pub by_layout: Vec<(String, Proportion)>,
    /// Fisher's exact test, for two layouts.
    pub fisher_p: Option<f64>,
}

/// One arm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArmReport {
    /// Its name.
    pub arm: String,
    /// Whether an answer can be right.
    pub right_answer: bool,
    /// The quality whose telling is right; none where that is not known.
    pub lower_quality: Option<String>,
    /// The quality that it was shown beside; none where that is not known.
    pub reference: Option<String>,
    /// Participants.
    pub n: u64,
    /// Participants whose answer was right; none where no answer is.
    pub correct: Option<u64>,
    /// `correct / n`.
    pub proportion: Option<f64>,
    /// The tests of `correct` against one half.
    #[serde(flatten)]
    pub tests: Tests,
    /// The equivalence tests; none without a planned bound or a right answer.
    pub equivalence: Option<Equivalence>,
    /// The exact equivalence test at bounds that were not planned, for comparison with other studies.
    pub usual_bounds: Vec<Tost>,
    /// The posterior probability, from a uniform prior, of lying within the planned bound.
    pub posterior_within_bound: Option<f64>,
    /// What this many people can and cannot show.
    pub reach: Option<Reach>,
    /// The number of people that 90 % power at a probability of .75 takes.
    pub needed: Option<u64>,
    /// Right answers by order.
    pub order: Option<OrderReport>,
    /// Right answers by layout.
    pub layout_effect: Option<LayoutEffect>,
    /// How often the second interval was chosen.
    pub second_chosen: Option<OneSample>,
    /// Which layout was chosen.
    pub layout_chosen: Vec<LayoutChosen>,
    /// Right answers by stated confidence.
    pub confidence: BTreeMap<u8, Proportion>,
    /// How well people counted, by quality.
    pub counting: BTreeMap<String, Accuracy>,
    /// The obvious pair.
    pub check: Proportion,
    /// People with informed trials, and the mean of their own shares of right answers.
    pub informed: Option<(u64, f64)>,
    /// The verdict, which comes from interval and equivalence test alone.
    pub verdict: Verdict,
    /// What else there is to say.
    pub sentences: Vec<Sentence>,
}

/// A sentence and what it is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Sentence {
    /// What it is about, in a word or two.
    pub about: &'static str,
    /// The sentence.
    pub sentence: String,
}

impl Tests {
    /// All tests of `counts` against one half at `alpha`.
    #[must_use]
    pub fn new(counts: Proportion, alpha: f64) -> Self {
        if counts.n == 0 {
            return Self::default();
        }
        let intervals = Intervals::new(counts, 1.0 - alpha);
        Self {
            chi_square: ChiSquare::against_half(counts),
            chi_square_true_size: chi_square::true_size(counts.n, alpha),
            least_expected: Some(chi_square::least_expected(counts.n)),
            binomial: Some(ExactBinomial::against_half(counts)),
            effect: Effect::new(counts, intervals.clopper_pearson),
            bayes: Some(BayesFactors::new(counts)),
            intervals: Some(intervals),
        }
    }
}

impl OneSample {
    fn new(counts: Proportion, alpha: f64, what: &str) -> Self {
        let tests = Tests::new(counts, alpha);
        let sentence = words::preference(what, counts, tests.intervals.as_ref());
        Self { k: counts.k, n: counts.n, proportion: counts.value(), tests, sentence }
    }
}

impl OrderReport {
    fn new(table: &OrderTable) -> Self {
        // Right where the lower quality came second: the second was chosen; where it came first: the first was.
        let fisher_p = contrast::fisher(table.lower_second, table.lower_first.complement());
        let shown_both = table.lower_second.n > 0 && table.lower_first.n > 0;
        Self { second_chosen: *table, signal_detection: Order::new(table), fisher_p: fisher_p.filter(|_| shown_both) }
    }
}

impl LayoutEffect {
    fn new(by_layout: &BTreeMap<String, Proportion>) -> Option<Self> {
        let by_layout: Vec<_> = by_layout.iter().map(|(layout, counts)| (layout.clone(), *counts)).collect();
        let fisher_p = match by_layout.as_slice() {
            [] | [_] => return None,
            [(_, first), (_, second)] => contrast::fisher(*first, *second),
            _ => None,
        };
        Some(Self { by_layout, fisher_p })
    }
}

impl ArmReport {
    /// The report of an arm at `alpha`, with the planned bound, if there is one. `published`: the counts came without
    /// the trials.
    #[must_use]
    pub fn new(name: &str, tally: &ArmTally, alpha: f64, planned: Option<PlannedBound>, published: bool) -> Self {
        let right = tally.right_answer && tally.n > 0;
        let tests = if right { Tests::new(tally.correct, alpha) } else { Tests::default() };
        let equivalence = planned.and_then(|planned| Equivalence::new(tally, planned, alpha));
        let usual = |bound: &f64| Tost::new(tally.correct, *bound, alpha);
        let layout_chosen = tally.layouts.iter().map(|([layout, other], counts)| LayoutChosen {
            layout: layout.clone(),
            other: other.clone(),
            chosen: OneSample::new(*counts, alpha, &format!("Layout {layout}, not {other},")),
        });
        let mut report = Self {
            arm: name.to_owned(),
            right_answer: tally.right_answer,
            lower_quality: tally.lower_quality.clone(),
            reference: tally.reference.clone(),
            n: tally.n,
            correct: tally.right_answer.then_some(tally.correct.k),
            proportion: if right { tally.correct.value() } else { None },
            verdict: words::verdict(tally, tests.intervals.as_ref(), equivalence.as_ref()),
            usual_bounds: if right { USUAL_BOUNDS.iter().filter_map(usual).collect() } else { Vec::new() },
            posterior_within_bound: planned
                .filter(|_| right)
                .map(|planned| bayes::posterior_within(tally.correct, planned.bound.proportion)),
            reach: if right { Reach::new(tally.n, alpha) } else { None },
            needed: sample_size(Question::Superiority { truth: 0.75 }, 0.9, alpha)
                .filter(|_| right)
                .map(|size| size.held_from),
            order: tally.order.as_ref().filter(|_| right).map(OrderReport::new),
            layout_effect: LayoutEffect::new(&tally.correct_by_layout),
            second_chosen: tally.second_chosen.map(|counts| OneSample::new(counts, alpha, "The picture shown second")),
            layout_chosen: layout_chosen.collect(),
            confidence: tally.confidence.clone(),
            counting: tally
                .counting
                .iter()
                .filter_map(|(quality, errors)| Some((quality.clone(), errors.accuracy()?)))
                .collect(),
            check: tally.check,
            informed: (tally.informed.0 > 0).then(|| (tally.informed.0, tally.informed.1 / tally.informed.0 as f64)),
            sentences: Vec::new(),
            equivalence,
            tests,
        };
        report.sentences = report.say(alpha, published);
        report
    }

    /// The counts of right answers.
    #[must_use]
    pub fn counts(&self) -> Option<Proportion> {
        self.correct.map(|k| Proportion { k, n: self.n })
    }

    fn say(&self, alpha: f64, published: bool) -> Vec<Sentence> {
        let mut said = Vec::new();
        let mut say = |about: &'static str, sentence: String| said.push(Sentence { about, sentence });
        if let (Some(counts), Some(chi), Some(exact)) = (self.counts(), &self.tests.chi_square, &self.tests.binomial) {
            say("test", words::chi_square(chi, exact.p, exact.log10_p));
            if published && let Some(open) = words::published(counts, chi) {
                say("direction", open);
            }
        }
        for note in words::notes(self.n, self.tests.least_expected, self.tests.chi_square_true_size, alpha) {
            say("true size", note);
        }
        if !self.usual_bounds.is_empty() && self.equivalence.is_none() {
            say("equivalence", words::usual_bounds(&self.usual_bounds));
        }
        if let Some(factors) = &self.tests.bayes {
            let tie = BayesFactors::new(Proportion { k: self.n / 2, n: self.n }).uniform.bf01;
            say("Bayes factors", words::bayes(factors, tie));
        }
        if let (Some(equivalence), Some(mass)) = (&self.equivalence, self.posterior_within_bound) {
            say("posterior", words::posterior(equivalence.bound, mass));
        }
        if let Some(reach) = &self.reach {
            say("power", words::reach(reach, alpha, self.needed));
        }
        if let Some(order) = &self.order {
            say("order", words::order(&order.second_chosen, order.signal_detection.as_ref(), order.fisher_p));
        }
        if let Some(effect) = &self.layout_effect {
            say("layout", words::layout_effect(&effect.by_layout, effect.fisher_p));
        }
        if let Some(chosen) = &self.second_chosen {
            say("interval chosen", chosen.sentence.clone());
        }
        for chosen in &self.layout_chosen {
            say("layout chosen", chosen.chosen.sentence.clone());
        }
        if self.check.n > 0 {
            say("obvious pair", words::check(self.check));
        }
        if let Some((people, share)) = self.informed {
            say("informed trials", words::informed(people, share));
        }
        said
    }
}
