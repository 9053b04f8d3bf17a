//! The report: one value, written as HTML, Markdown or JSON.

mod html;
mod markdown;
pub mod numbers;
pub mod words;

use std::path::PathBuf;

use serde::Serialize;

use crate::binomial::ExactBinomial;
use crate::chi_square::{self, ChiSquare};
use crate::exclude::{Excluded, Reason, Times, judge};
use crate::interval::Intervals;
use crate::plan::{Plan, Rules};
use crate::proportion::Proportion;
use crate::provenance::Provenance;
use crate::sessions::{self, Session, Visitor};
use crate::tally::{ArmTally, Tally};
use crate::trial_log::{Error, Trial};
use words::Verdict;

/// Exclusions that are listed one by one; beyond, they are only counted.
pub const LISTED: usize = 10_000;

/// What to report on and how.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The analysis plan; without one the level is .05, there is no equivalence bound, and only interrupted trials and
    /// those who knew the purpose are left out.
    pub plan: Option<Plan>,
}

/// Everything that a report says.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// True when simulated observers answered, and nobody else.
    pub simulated: bool,
    /// True when the data are a demonstration's.
    pub demo: bool,
    /// Level of every test.
    pub alpha: f64,
    /// The arms, in order of name, without the excluded trials.
    pub arms: Vec<ArmReport>,
    /// The same with every answered critical trial.
    pub without_exclusions: Vec<ArmReport>,
    /// Sessions whose critical trial is left out, the first [`LISTED`] of them.
    pub exclusions: Vec<Excluded>,
    /// From sessions to analysed trials.
    pub flow: Flow,
    /// The analysis plan.
    pub plan: Option<Plan>,
    /// What departs from the plan, or cannot be held against one.
    pub deviations: Vec<String>,
    /// Where the numbers come from.
    pub provenance: Provenance,
}

/// How many came, how many were left out and why, how many remain.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Flow {
    /// Sessions begun.
    pub sessions: u64,
    /// Sessions left out, by reason, in the order in which reasons are looked for.
    pub excluded: Vec<(Reason, u64)>,
    /// Participants analysed.
    pub analysed: u64,
}

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

/// How often one layout of a pair was chosen as the worse.
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

/// One arm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArmReport {
    /// Its name.
    pub arm: String,
    /// Whether an answer can be right.
    pub right_answer: bool,
    /// Participants.
    pub n: u64,
    /// Participants whose answer was right; none where no answer is.
    pub correct: Option<u64>,
    /// `correct / n`.
    pub proportion: Option<f64>,
    /// The tests of `correct` against one half.
    #[serde(flatten)]
    pub tests: Tests,
    /// How often the second interval was chosen.
    pub second_chosen: Option<OneSample>,
    /// Which layout was chosen.
    pub layout_chosen: Vec<LayoutChosen>,
    /// The verdict, which comes from interval and equivalence test alone.
    pub verdict: Verdict,
    /// Cautions that belong to the numbers.
    pub notes: Vec<String>,
}

/// Reads logs and reports on them.
///
/// # Errors
/// When a log cannot be read or is wrong, with file, line and column.
pub fn of_logs(logs: &[PathBuf], options: &Options) -> Result<Report, Error> {
    let mut gather = Gather::new(options);
    let provenance = sessions::read(logs, &mut gather)?;
    Ok(gather.report(provenance, options))
}

/// Reports on published counts: each arm with its count of right answers, or, where none is right, of the second
/// interval. `typed` is kept as the numbers' source.
#[must_use]
pub fn of_counts(arms: &[(String, ArmTally)], typed: Vec<String>, options: &Options) -> Report {
    let mut gather = Gather::new(options);
    for (name, arm) in arms {
        gather.kept.arms.insert(name.clone(), arm.clone());
        gather.all.arms.insert(name.clone(), arm.clone());
        gather.analysed += arm.n;
    }
    gather.report(Provenance { counts: typed, ..Provenance::default() }, options)
}

/// What is gathered while logs are read.
struct Gather {
    rules: Rules,
    times: Option<Times>,
    kept: Tally,
    all: Tally,
    excluded: Vec<Excluded>,
    reasons: std::collections::BTreeMap<Reason, u64>,
    sessions: u64,
    analysed: u64,
    simulated: bool,
    demo: bool,
}

impl Gather {
    fn new(options: &Options) -> Self {
        let plan = options.plan.as_ref();
        Self {
            rules: plan.map(|plan| plan.rules.clone()).unwrap_or_default(),
            times: plan.map(|plan| Times { picture_s: plan.picture_s, gap_s: plan.gap_s }),
            kept: Tally::default(),
            all: Tally::default(),
            excluded: Vec::new(),
            reasons: std::collections::BTreeMap::new(),
            sessions: 0,
            analysed: 0,
            simulated: false,
            demo: false,
        }
    }

    fn leave_out(&mut self, session: &Session, reason: Reason, detail: String) {
        *self.reasons.entry(reason).or_default() += 1;
        if self.excluded.len() < LISTED {
            self.excluded.push(Excluded {
                session_id: session.id.clone(),
                participant: session.participant.clone(),
                arm: session.arm.clone(),
                reason,
                detail,
                file: session.file.display().to_string(),
                line: session.line,
            });
        }
    }

    fn report(self, mut provenance: Provenance, options: &Options) -> Report {
        provenance.report_version = env!("CARGO_PKG_VERSION").to_owned();
        provenance.analysis_plan_hash = options.plan.as_ref().map(|plan| plan.hash().to_string());
        let alpha = options.plan.as_ref().map_or(0.05, |plan| plan.alpha);
        let arms = |tally: &Tally| tally.arms.iter().map(|(name, arm)| ArmReport::new(name, arm, alpha)).collect();
        Report {
            simulated: self.simulated,
            demo: self.demo,
            alpha,
            arms: arms(&self.kept),
            without_exclusions: arms(&self.all),
            exclusions: self.excluded,
            flow: Flow {
                sessions: self.sessions,
                excluded: self.reasons.into_iter().collect(),
                analysed: self.analysed,
            },
            deviations: words::deviations(options.plan.as_ref(), &provenance),
            plan: options.plan.clone(),
            provenance,
        }
    }
}

impl Visitor for Gather {
    fn trial(&mut self, trial: &Trial) {
        self.simulated = trial.simulated;
        self.demo = trial.demo;
    }

    fn session(&mut self, session: &Session) {
        self.sessions += 1;
        let Some(trial) = &session.critical else {
            self.leave_out(session, Reason::NoCriticalAnswer, String::new());
            return;
        };
        self.all.add(session);
        let conduct = crate::exclude::Conduct::of(trial, session.knew_task, session.repeated);
        match judge(&conduct, &self.rules, self.times) {
            Some((reason, detail)) => self.leave_out(session, reason, detail),
            None => {
                self.kept.add(session);
                self.analysed += 1;
            }
        }
    }
}

impl Tests {
    /// All tests of `counts` against one half at `alpha`.
    #[must_use]
    pub fn new(counts: Proportion, alpha: f64) -> Self {
        if counts.n == 0 {
            return Self::default();
        }
        Self {
            chi_square: ChiSquare::against_half(counts),
            chi_square_true_size: chi_square::true_size(counts.n, alpha),
            least_expected: Some(chi_square::least_expected(counts.n)),
            binomial: Some(ExactBinomial::against_half(counts)),
            intervals: Some(Intervals::new(counts, 1.0 - alpha)),
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

impl ArmReport {
    fn new(name: &str, tally: &ArmTally, alpha: f64) -> Self {
        let tests = if tally.right_answer { Tests::new(tally.correct, alpha) } else { Tests::default() };
        let layout_chosen = tally
            .layouts
            .iter()
            .map(|([layout, other], counts)| {
                let chosen = OneSample::new(*counts, alpha, &format!("Layout {layout}, not {other},"));
                LayoutChosen { layout: layout.clone(), other: other.clone(), chosen }
            })
            .collect();
        Self {
            arm: name.to_owned(),
            right_answer: tally.right_answer,
            n: tally.n,
            correct: tally.right_answer.then_some(tally.correct.k),
            proportion: if tally.right_answer { tally.correct.value() } else { None },
            second_chosen: tally.second_chosen.map(|counts| OneSample::new(counts, alpha, "The second interval")),
            layout_chosen,
            verdict: words::verdict(tally, tests.intervals.as_ref()),
            notes: words::notes(tally, &tests, alpha),
            tests,
        }
    }
}

impl Report {
    /// The report as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a report is names and numbers") + "\n"
    }

    /// The report as Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        markdown::write(self)
    }

    /// The report as one HTML page that needs nothing else.
    #[must_use]
    pub fn to_html(&self) -> String {
        html::write(self)
    }

    /// The report's heading.
    #[must_use]
    pub fn title(&self) -> String {
        match &self.provenance.study {
            Some(study) => format!("Study {study}"),
            None => "Published counts".to_owned(),
        }
    }
}
