//! Answers counted, one participant one count.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::counting::{Errors, counts_of};
use crate::proportion::Proportion;
use crate::sessions::Session;
use crate::trial_log::{Interval, Trial};

/// How often the second interval was chosen, by where the lower quality was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct OrderTable {
    /// The lower quality was second: choosing second was right.
    pub lower_second: Proportion,
    /// The lower quality was first: choosing second was wrong.
    pub lower_first: Proportion,
}

impl OrderTable {
    /// How many answers were right.
    #[must_use]
    pub fn correct(&self) -> Proportion {
        let k = self.lower_second.k + self.lower_first.n - self.lower_first.k;
        Proportion { k, n: self.lower_second.n + self.lower_first.n }
    }
}

/// The answers of one arm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmTally {
    /// Whether an answer can be right: the two pictures differ in quality.
    pub right_answer: bool,
    /// People.
    pub n: u64,
    /// Right answers, where an answer can be right.
    pub correct: Proportion,
    /// Right answers by order; none for counts that came without the trials.
    pub order: Option<OrderTable>,
    /// How often the second interval was chosen; none for a right-answer count that came without the trials.
    pub second_chosen: Option<Proportion>,
    /// For each pair of layouts, in order of name: how often the former was chosen as the worse.
    pub layouts: BTreeMap<[String; 2], Proportion>,
    /// Right answers by the layout that was of the lower quality.
    pub correct_by_layout: BTreeMap<String, Proportion>,
    /// The quality whose telling is right, by name.
    pub lower_quality: Option<String>,
    /// The quality that it was shown beside.
    pub reference: Option<String>,
    /// Right answers by stated confidence.
    pub confidence: BTreeMap<u8, Proportion>,
    /// Counting, by quality.
    pub counting: BTreeMap<String, Errors>,
    /// People who were shown the obvious pair, and how many of them told it.
    pub check: Proportion,
    /// People who had informed trials with a right answer, with the sum of their own shares of right answers.
    pub informed: (u64, f64),
}

impl ArmTally {
    /// `counts` of people who were right.
    #[must_use]
    pub fn of_correct(counts: Proportion) -> Self {
        Self { right_answer: true, n: counts.n, correct: counts, ..Self::default() }
    }

    /// `counts` of people who chose the second interval where no answer is right.
    #[must_use]
    pub fn of_second_chosen(counts: Proportion) -> Self {
        Self { n: counts.n, second_chosen: Some(counts), ..Self::default() }
    }

    /// Counts one participant's critical trial; one without an answer is not counted.
    pub fn add(&mut self, trial: &Trial) {
        let Some(answer) = trial.worse_answer else { return };
        let second = answer == Interval::Second;
        self.n += 1;
        self.second_chosen.get_or_insert_default().count(second);
        if trial.first_layout != trial.second_layout {
            let (a, b) = (&trial.first_layout, &trial.second_layout);
            let pair = if a < b { [a.clone(), b.clone()] } else { [b.clone(), a.clone()] };
            let former = trial.layout_chosen() == Some(&pair[0]);
            self.layouts.entry(pair).or_default().count(former);
        }
        if let (Some(correct), Some(lower)) = (trial.correct, trial.lower_quality()) {
            self.right_answer = true;
            self.correct.count(correct);
            let order = self.order.get_or_insert_default();
            let [former, latter] = [&trial.first_quality, &trial.second_quality];
            let (half, layout, quality, reference) = match lower {
                Interval::Second => (&mut order.lower_second, &trial.second_layout, latter, former),
                Interval::First => (&mut order.lower_first, &trial.first_layout, former, latter),
            };
            if self.lower_quality.is_none() {
                self.lower_quality = Some(quality.clone());
                self.reference = Some(reference.clone());
            }
            half.count(second);
            self.correct_by_layout.entry(layout.clone()).or_default().count(correct);
            if let Some(confidence) = trial.confidence {
                self.confidence.entry(confidence).or_default().count(correct);
            }
        }
        for (quality, truth, answer) in counts_of(trial) {
            match self.counting.get_mut(quality) {
                Some(errors) => errors.add(truth, answer),
                None => self.counting.entry(quality.to_owned()).or_default().add(truth, answer),
            }
        }
    }

    /// Counts a session: its critical trial, and what came after it.
    fn add_session(&mut self, session: &Session) {
        if let Some(trial) = &session.critical {
            self.add(trial);
        }
        if let Some(told) = session.check {
            self.check.count(told);
        }
        if let Some(share) = session.informed.value() {
            self.informed.0 += 1;
            self.informed.1 += share;
        }
    }
}

/// The answers of all arms, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// The arms.
    pub arms: BTreeMap<String, ArmTally>,
}

impl Tally {
    /// Counts a session, if it has an answered critical trial.
    pub fn add(&mut self, session: &Session) {
        if session.critical.is_some() {
            self.arm(&session.arm).add_session(session);
        }
    }

    fn arm(&mut self, name: &str) -> &mut ArmTally {
        if !self.arms.contains_key(name) {
            self.arms.insert(name.to_owned(), ArmTally::default());
        }
        self.arms.get_mut(name).expect("it was put there if it was not")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(answer: Interval, lower: Option<Interval>, layouts: [&str; 2]) -> Trial {
        Trial {
            worse_answer: Some(answer),
            correct: lower.map(|lower| lower == answer),
            first_layout: layouts[0].to_owned(),
            second_layout: layouts[1].to_owned(),
            ..Trial::default()
        }
    }

    #[test]
    fn right_answers_are_counted_by_order_and_layout() {
        use Interval::{First, Second};
        let mut arm = ArmTally::default();
        arm.add(&trial(Second, Some(Second), ["a", "b"])); // right, layout b lower and chosen
        arm.add(&trial(Second, Some(First), ["b", "a"])); // wrong, layout b lower, a chosen
        arm.add(&trial(First, Some(First), ["a", "b"])); // right, layout a lower and chosen
        assert!(arm.right_answer);
        assert_eq!((arm.n, arm.correct), (3, Proportion { k: 2, n: 3 }));
        let order = arm.order.unwrap();
        assert_eq!(order.lower_second, Proportion { k: 1, n: 1 });
        assert_eq!(order.lower_first, Proportion { k: 1, n: 2 });
        assert_eq!(order.correct(), arm.correct);
        assert_eq!(arm.second_chosen, Some(Proportion { k: 2, n: 3 }));
        assert_eq!(arm.layouts[&["a".to_owned(), "b".to_owned()]], Proportion { k: 2, n: 3 });
        assert_eq!(arm.correct_by_layout["b"], Proportion { k: 1, n: 2 });
    }

    #[test]
    fn where_no_answer_is_right_only_habits_are_counted() {
        let mut arm = ArmTally::default();
        arm.add(&trial(Interval::Second, None, ["a", "b"]));
        arm.add(&trial(Interval::First, None, ["b", "a"]));
        arm.add(&Trial::default());
        assert!(!arm.right_answer);
        assert_eq!((arm.n, arm.correct, arm.order), (2, Proportion::default(), None));
        assert_eq!(arm.second_chosen, Some(Proportion { k: 1, n: 2 }));
        assert_eq!(arm.layouts[&["a".to_owned(), "b".to_owned()]], Proportion { k: 0, n: 2 });
    }
}
