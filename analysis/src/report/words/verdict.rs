//! The verdict on an arm.

use serde::Serialize;

use super::{bound_words, counted, percent_level};
use crate::interval::Intervals;
use crate::report::equivalence::Equivalence;
use crate::report::numbers::{p_equals, percent_range};
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
    /// The whole interval is above one half, and equivalence within the planned bound is shown: a small effect.
    NoticedWithinBound,
    /// The whole interval is below one half.
    Reversed,
    /// The whole interval is below one half, and equivalence within the planned bound is shown.
    ReversedWithinBound,
    /// The interval holds one half, and equivalence within the planned bound is shown.
    Equivalent,
    /// The interval holds one half, and equivalence is not shown.
    Undecided,
}

/// A finding and the sentences that say it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Verdict {
    /// For programs.
    pub finding: Finding,
    /// For people.
    pub sentence: String,
}

/// The verdict on an arm. `intervals` are those of the right answers, `equivalence` the test at the planned bound.
#[must_use]
pub fn verdict(tally: &ArmTally, intervals: Option<&Intervals>, equivalence: Option<&Equivalence>) -> Verdict {
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
    let told = format!("{} told the lower quality", counted(tally.correct));
    let level = percent_level(intervals.level);
    let [low, high] = intervals.clopper_pearson;
    let range = percent_range(intervals.clopper_pearson);
    let shown = equivalence.filter(|equivalence| equivalence.claimed);
    let within = shown.map(|equivalence| {
        format!(
            "Yet the departure from 50 % is shown to be smaller than the planned bound of {}: {}.",
            bound_words(equivalence.bound),
            both(equivalence)
        )
    });
    let (finding, sentence) = if low > 0.5 {
        let finding = if shown.is_some() { Finding::NoticedWithinBound } else { Finding::Noticed };
        (finding, format!("People notice: {told}, and the whole {level} interval, {range}, lies above 50 %."))
    } else if high < 0.5 {
        let finding = if shown.is_some() { Finding::ReversedWithinBound } else { Finding::Reversed };
        let what = "People take the higher quality for the worse one";
        (finding, format!("{what}: {told}, and the whole {level} interval, {range}, lies below 50 %."))
    } else if let Some(equivalence) = shown {
        let sentence = format!(
            "Equivalent within the planned bound of {}: {told}, {level} interval {range}; {}.",
            bound_words(equivalence.bound),
            both(equivalence)
        );
        return Verdict { finding: Finding::Equivalent, sentence };
    } else {
        let sentence = format!(
            "Undecided: {told}, and the {level} interval, {range}, holds 50 %. That neither shows that people notice nor \
             that they do not. {}",
            not_shown(equivalence)
        );
        return Verdict { finding: Finding::Undecided, sentence };
    };
    Verdict { finding, sentence: within.map_or(sentence.clone(), |within| format!("{sentence} {within}")) }
}

fn both(equivalence: &Equivalence) -> String {
    let raw = p_equals(equivalence.raw.p, equivalence.raw.log10_p);
    let corrected = equivalence.corrected.map(|test| p_equals(test.p, test.p.log10())).unwrap_or_default();
    format!(
        "the exact equivalence test passes on the raw proportion ({raw}) and with a lean towards one interval allowed for \
         ({corrected})"
    )
}

/// Why equivalence is not claimed.
fn not_shown(equivalence: Option<&Equivalence>) -> String {
    let Some(equivalence) = equivalence else {
        return "No equivalence bound was planned, so equivalence cannot be claimed.".to_owned();
    };
    let planned = if equivalence.recorded { "planned bound" } else { "bound" };
    let bound = bound_words(equivalence.bound);
    let raw = p_equals(equivalence.raw.p, equivalence.raw.log10_p);
    match (equivalence.raw.passes, equivalence.corrected) {
        (false, _) => format!("Equivalence within the {planned} of {bound} is not shown either ({raw})."),
        (true, None) => format!(
            "The equivalence test at the {planned} of {bound} passes on the raw proportion ({raw}), but the answers by \
             order are not known and a lean towards one interval can fake that: equivalence is not claimed."
        ),
        (true, Some(test)) if test.passes => format!(
            "Both equivalence tests at a bound of {bound} pass, but the logs do not show that this bound was fixed before \
             the first participant: equivalence is not claimed."
        ),
        (true, Some(test)) => format!(
            "The equivalence test at the {planned} of {bound} passes on the raw proportion ({raw}), but not with a lean \
             towards one interval allowed for ({}): equivalence is not claimed.",
            p_equals(test.p, test.p.log10())
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Bound, PlannedBound};
    use crate::proportion::Proportion;
    use crate::tally::OrderTable;

    fn say(tally: &ArmTally, bound: Option<f64>) -> Verdict {
        say_of(tally, bound, true)
    }

    fn say_of(tally: &ArmTally, bound: Option<f64>, recorded: bool) -> Verdict {
        let intervals = (tally.n > 0).then(|| Intervals::new(tally.correct, 0.95));
        let bound = bound.map(|bound| PlannedBound { bound: Bound::from_proportion(bound).unwrap(), recorded });
        let equivalence = bound.and_then(|bound| Equivalence::new(tally, bound, 0.05));
        verdict(tally, intervals.as_ref(), equivalence.as_ref())
    }

    fn counts(k: u64, n: u64) -> ArmTally {
        ArmTally::of_correct(Proportion { k, n })
    }

    /// `x` of `half` right with the lower quality second, `y` of `half` right with it first.
    fn ordered(x: u64, y: u64, half: u64) -> ArmTally {
        let order =
            OrderTable { lower_second: Proportion { k: x, n: half }, lower_first: Proportion { k: half - y, n: half } };
        ArmTally { order: Some(order), ..ArmTally::of_correct(order.correct()) }
    }

    #[test]
    fn the_paper_s_case() {
        let found = say(&counts(9, 16), None);
        assert_eq!(found.finding, Finding::Undecided);
        assert_eq!(
            found.sentence,
            "Undecided: 9 of 16 (56.2 %) told the lower quality, and the 95 % interval, 29.9 % to 80.2 %, holds 50 %. That \
             neither shows that people notice nor that they do not. No equivalence bound was planned, so equivalence cannot \
             be claimed."
        );
        assert!(
            say(&counts(9, 16), Some(0.2)).sentence.ends_with(
                "Equivalence within the planned bound of ±20 % (0.78 JOD) is not shown either (p = 0.1753)."
            )
        );
    }

    #[test]
    fn clear_cases() {
        let found = say(&counts(15, 16), None);
        assert_eq!(found.finding, Finding::Noticed);
        assert_eq!(
            found.sentence,
            "People notice: 15 of 16 (93.8 %) told the lower quality, and the whole 95 % interval, 69.8 % to 99.8 %, lies \
             above 50 %."
        );
        let found = say(&counts(1, 16), Some(0.2));
        assert_eq!(found.finding, Finding::Reversed);
        assert_eq!(
            found.sentence,
            "People take the higher quality for the worse one: 1 of 16 (6.2 %) told the lower quality, and the whole 95 % \
             interval, 0.2 % to 30.2 %, lies below 50 %."
        );
        assert_eq!(say(&counts(0, 0), Some(0.2)).finding, Finding::NoData);
        assert_eq!(say(&counts(0, 0), Some(0.2)).sentence, "No answer was counted in this arm.");
    }

    #[test]
    fn equivalent_only_when_both_tests_pass() {
        let found = say(&ordered(50, 50, 100), Some(0.2));
        assert_eq!(found.finding, Finding::Equivalent);
        assert_eq!(
            found.sentence,
            "Equivalent within the planned bound of ±20 % (0.78 JOD): 100 of 200 (50.0 %) told the lower quality, 95 % \
             interval 42.9 % to 57.1 %; the exact equivalence test passes on the raw proportion (p = 2.60e-9) and with a \
             lean towards one interval allowed for (p = 1.76e-9)."
        );
    }

    /// A bound that is chosen after the answers were seen can always be wide enough.
    #[test]
    fn a_bound_that_was_not_fixed_beforehand_shows_nothing() {
        let found = say_of(&ordered(50, 50, 100), Some(0.2), false);
        assert_eq!(found.finding, Finding::Undecided);
        assert!(
            found.sentence.ends_with(
                "Both equivalence tests at a bound of ±20 % (0.78 JOD) pass, but the logs do not show that this bound was \
                 fixed before the first participant: equivalence is not claimed."
            ),
            "{}",
            found.sentence
        );
        let found = say_of(&counts(9, 16), Some(0.2), false);
        assert!(
            found
                .sentence
                .ends_with("Equivalence within the bound of ±20 % (0.78 JOD) is not shown either (p = 0.1753).")
        );
        assert_eq!(say_of(&ordered(550, 550, 1000), Some(0.2), false).finding, Finding::Noticed);
    }

    #[test]
    fn a_lean_is_not_equivalence() {
        // Nearly everybody answers "second": raw 52 of 100, but H = 1 and F = .96 say little about d.
        let found = say(&ordered(50, 2, 50), Some(0.2));
        assert_eq!(found.finding, Finding::Undecided);
        assert!(found.sentence.contains("passes on the raw proportion (p = "), "{}", found.sentence);
        assert!(found.sentence.contains("but not with a lean towards one interval allowed for (p = "));
        assert!(found.sentence.ends_with("equivalence is not claimed."));
        let found = say(&counts(50, 100), Some(0.2));
        assert_eq!(found.finding, Finding::Undecided);
        assert!(found.sentence.contains("the answers by order are not known"));
        assert!(found.sentence.ends_with("equivalence is not claimed."));
    }

    #[test]
    fn small_effects_are_both_noticed_and_within_the_bound() {
        let found = say(&ordered(550, 550, 1000), Some(0.2));
        assert_eq!(found.finding, Finding::NoticedWithinBound);
        assert!(found.sentence.starts_with("People notice: 1100 of 2000 (55.0 %)"));
        assert!(
            found
                .sentence
                .contains("Yet the departure from 50 % is shown to be smaller than the planned bound of ±20 %")
        );
        let found = say(&ordered(450, 450, 1000), Some(0.2));
        assert_eq!(found.finding, Finding::ReversedWithinBound);
        assert!(found.sentence.starts_with("People take the higher quality for the worse one: 900 of 2000"));
    }

    #[test]
    fn an_arm_without_a_right_answer_is_about_habits() {
        let found = say(&ArmTally::of_second_chosen(Proportion { k: 8, n: 16 }), Some(0.2));
        assert_eq!(found.finding, Finding::NoRightAnswer);
        assert_eq!(
            found.sentence,
            "Both pictures have the same quality, so no answer is right: this arm shows habits of answering, not what \
             people see."
        );
    }

    /// Whatever the counts, and with or without a bound: insignificance is never said to be absence, and "equivalent" is
    /// never said unless both tests pass.
    #[test]
    fn insignificance_is_never_absence() {
        for n in 1..60 {
            for k in 0..=n {
                for bound in [None, Some(0.1), Some(0.25), Some(0.4)] {
                    let sentence = say(&counts(k, n), bound).sentence.to_lowercase();
                    for forbidden in
                        ["no difference", "not significant", "cannot see", "identical", "equal", "equivalent"]
                    {
                        assert!(!sentence.contains(forbidden), "{k} of {n}: {sentence}");
                    }
                }
            }
        }
    }
}
