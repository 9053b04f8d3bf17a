//! Every sentence that a report can say about its numbers.
//!
//! A p value above the level is never read as absence of a difference: what is said comes from the interval and from the
//! equivalence test alone.

use serde::Serialize;

use super::Tests;
use super::numbers::{percent, percent_range};
use crate::interval::Intervals;
use crate::plan::Plan;
use crate::proportion::Proportion;
use crate::provenance::Provenance;
use crate::tally::ArmTally;

/// What an arm's data show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Finding {
    /// Nothing was counted.
    NoData,
    /// No answer is right in this arm.
    NoRightAnswer,
    /// The whole interval is above one half.
    Noticed,
    /// The whole interval is below one half.
    Reversed,
    /// The interval holds one half, and equivalence is not shown.
    Undecided,
}

/// A finding and the sentence that says it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Verdict {
    /// For programs.
    pub finding: Finding,
    /// For people.
    pub sentence: String,
}

/// The verdict on an arm.
#[must_use]
pub fn verdict(tally: &ArmTally, intervals: Option<&Intervals>) -> Verdict {
    if tally.n == 0 {
        return Verdict { finding: Finding::NoData, sentence: "No answer was counted in this arm.".to_owned() };
    }
    let Some(intervals) = intervals.filter(|_| tally.right_answer) else {
        let sentence =
            "Both pictures have the same quality, so no answer is right: this arm shows habits of answering, \
                        not what people see."
                .to_owned();
        return Verdict { finding: Finding::NoRightAnswer, sentence };
    };
    let told = told(tally.correct);
    let level = percent_level(intervals.level);
    let [low, high] = intervals.clopper_pearson;
    let range = percent_range(intervals.clopper_pearson);
    let (finding, sentence) = if low > 0.5 {
        (Finding::Noticed, format!("People notice: {told}, and the whole {level} interval, {range}, lies above 50 %."))
    } else if high < 0.5 {
        let sentence = format!(
            "People take the higher quality for the worse one: {told}, and the whole {level} interval, {range}, lies below 50 %."
        );
        (Finding::Reversed, sentence)
    } else {
        let sentence = format!(
            "Undecided: {told}, and the {level} interval, {range}, holds 50 %. That neither shows that people notice nor \
             that they do not."
        );
        (Finding::Undecided, sentence)
    };
    Verdict { finding, sentence }
}

/// What is said of a count for which neither answer is right.
#[must_use]
pub fn preference(what: &str, counts: Proportion, intervals: Option<&Intervals>) -> String {
    let Some(intervals) = intervals else { return format!("{what} was never asked about.") };
    let [low, high] = intervals.clopper_pearson;
    let share = counts.value().map(percent).unwrap_or_default();
    let side = if low > 0.5 {
        "lies above 50 %: a preference"
    } else if high < 0.5 {
        "lies below 50 %: a preference for the other"
    } else {
        "holds 50 %: a preference is not shown, nor is it ruled out"
    };
    let (level, range) = (percent_level(intervals.level), percent_range(intervals.clopper_pearson));
    format!("{what} was called the worse by {counts} ({share}); the {level} interval, {range}, {side}.")
}

/// Cautions about an arm's numbers.
#[must_use]
pub fn notes(tally: &ArmTally, tests: &Tests, alpha: f64) -> Vec<String> {
    let mut notes = Vec::new();
    let n = tally.n;
    if let Some(expected) = tests.least_expected.filter(|expected| *expected < 5.0) {
        notes.push(format!(
            "With n = {n} the expected count of each answer is {expected}, under 5: the chi-square approximation is poor, \
             read the exact test."
        ));
    }
    if let Some(size) = tests.chi_square_true_size {
        notes.push(format!(
            "With n = {n} the rule \"chi-square beyond its critical value at {alpha}\" rejects in {} of experiments in which \
             everybody guesses.",
            percent(size)
        ));
    }
    notes
}

/// What departs from the plan.
#[must_use]
pub fn deviations(plan: Option<&Plan>, provenance: &Provenance) -> Vec<String> {
    let mut found = Vec::new();
    let Some(plan) = plan else {
        found.push(
            "No analysis plan was given: the level is .05, no equivalence bound is tested, and only interrupted trials and \
             participants who knew the purpose are left out."
                .to_owned(),
        );
        return found;
    };
    if let Some(study) = provenance.study.as_ref().filter(|study| **study != plan.study) {
        found.push(format!("The analysis plan is of study {}, the logs are of study {study}.", plan.study));
    }
    let hash = plan.hash().to_string();
    for log in &provenance.logs {
        match &log.analysis_plan_hash {
            Some(recorded) if *recorded == hash => {}
            Some(recorded) => found.push(format!(
                "The analysis plan ({}) is not the one that {} recorded before its first trial ({}).",
                head(&hash),
                log.file,
                head(recorded)
            )),
            None => found.push(format!(
                "{} records no analysis plan, so it cannot be shown that the plan was fixed beforehand.",
                log.file
            )),
        }
    }
    found
}

/// The first digits of a hash, enough to compare by eye.
fn head(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn told(counts: Proportion) -> String {
    let share = counts.value().map(percent).unwrap_or_default();
    format!("{counts} ({share}) told the lower quality")
}

fn percent_level(level: f64) -> String {
    format!("{} %", super::numbers::short(100.0 * level))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm(k: u64, n: u64) -> Verdict {
        let counts = Proportion { k, n };
        let intervals = Intervals::new(counts, 0.95);
        verdict(&ArmTally::of_correct(counts), (n > 0).then_some(&intervals))
    }

    #[test]
    fn the_paper_s_case_is_undecided() {
        let found = arm(9, 16);
        assert_eq!(found.finding, Finding::Undecided);
        assert_eq!(
            found.sentence,
            "Undecided: 9 of 16 (56.2 %) told the lower quality, and the 95 % interval, 29.9 % to 80.2 %, holds 50 %. That \
             neither shows that people notice nor that they do not."
        );
    }

    #[test]
    fn clear_cases_say_so() {
        let found = arm(15, 16);
        assert_eq!(found.finding, Finding::Noticed);
        assert!(
            found.sentence.starts_with("People notice: 15 of 16 (93.8 %) told the lower quality, and the whole 95 %")
        );
        let found = arm(1, 16);
        assert_eq!(found.finding, Finding::Reversed);
        assert!(found.sentence.starts_with("People take the higher quality for the worse one: 1 of 16 (6.2 %)"));
        let found = arm(0, 0);
        assert_eq!((found.finding, found.sentence.as_str()), (Finding::NoData, "No answer was counted in this arm."));
    }

    #[test]
    fn an_arm_without_a_right_answer_is_about_habits() {
        let tally = ArmTally::of_second_chosen(Proportion { k: 8, n: 16 });
        let found = verdict(&tally, None);
        assert_eq!(found.finding, Finding::NoRightAnswer);
        assert!(found.sentence.contains("no answer is right"));
    }

    /// Whatever the counts, insignificance is never said to be absence.
    #[test]
    fn insignificance_is_never_absence() {
        for n in 1..60 {
            for k in 0..=n {
                let sentence = arm(k, n).sentence.to_lowercase();
                for forbidden in ["no difference", "not significant", "cannot see", "same", "equal"] {
                    assert!(!sentence.contains(forbidden), "{k} of {n}: {sentence}");
                }
            }
        }
    }

    #[test]
    fn preferences_have_three_sentences() {
        let say = |k, n| {
            let counts = Proportion { k, n };
            preference("The second interval", counts, Some(&Intervals::new(counts, 0.95)))
        };
        assert_eq!(
            say(8, 16),
            "The second interval was called the worse by 8 of 16 (50.0 %); the 95 % interval, 24.7 % to 75.3 %, holds 50 %: \
             a preference is not shown, nor is it ruled out."
        );
        assert!(say(15, 16).ends_with("lies above 50 %: a preference."));
        assert!(say(1, 16).ends_with("lies below 50 %: a preference for the other."));
        assert_eq!(preference("Layout a", Proportion::default(), None), "Layout a was never asked about.");
    }

    #[test]
    fn small_expected_counts_are_said() {
        let note =
            |n| notes(&ArmTally::of_correct(Proportion { k: 1, n }), &Tests::new(Proportion { k: 1, n }, 0.05), 0.05);
        assert!(note(9)[0].starts_with("With n = 9 the expected count of each answer is 4.5, under 5"));
        assert_eq!(
            note(16),
            [
                "With n = 16 the rule \"chi-square beyond its critical value at 0.05\" rejects in 7.7 % of experiments in which \
              everybody guesses."
            ]
        );
    }

    #[test]
    fn a_missing_plan_is_a_deviation() {
        let found = deviations(None, &Provenance::default());
        assert!(found[0].starts_with("No analysis plan was given"));
    }
}
