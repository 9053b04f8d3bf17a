//! Sentences about numbers of people.

use crate::power::Question;
use crate::report::numbers::{percent, short};
use crate::report::target::Target;

/// The heading.
#[must_use]
pub fn title(question: Question) -> String {
    match question {
        Question::Superiority { .. } => "How many people to find that they notice".to_owned(),
        Question::Equivalence { .. } => "How many people to show that they hardly notice".to_owned(),
    }
}

fn aim(question: Question) -> String {
    match question {
        Question::Superiority { truth } => {
            format!("to find that people notice, where a person is right with probability {}", short(truth))
        }
        Question::Equivalence { truth, bound } => format!(
            "to show equivalence within ±{} %, where a person is right with probability {}",
            short(100.0 * bound),
            short(truth)
        ),
    }
}

/// The people that a target takes.
#[must_use]
pub fn size(question: Question, target: &Target) -> String {
    let aim = format!("For {} power {}", percent(target.power), aim(question));
    let (Some(people), Some(balanced)) = (target.people, target.balanced) else {
        return format!("{aim}, a million people in an arm are too few, or the question has no answer.");
    };
    let held = people.held_from;
    let first = people.first_reached;
    let mut text = format!("{aim}, plan {held} people in an arm");
    if first < held {
        text += &format!(" ({first} reach it too, but a few more people lose it again)");
    }
    if balanced != held {
        text += &format!("; {balanced} balance the cells");
    }
    text += ".";
    if let Some(both) = target.both_pass {
        text += &format!(
            " The claim also needs the order-corrected test: without a lean both pass with probability {} at {balanced} people.",
            percent(both)
        );
    }
    text
}

/// The power of a given number.
#[must_use]
pub fn power(question: Question, n: u64, power: f64) -> String {
    format!("With {n} people in an arm the power is {} {}.", percent(power), aim(question))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::power::SampleSize;

    const NOTICE: Question = Question::Superiority { truth: 0.75 };
    const ALIKE: Question = Question::Equivalence { truth: 0.5, bound: 0.2 };

    fn target(first_reached: u64, held_from: u64, balanced: u64, both_pass: Option<f64>) -> Target {
        let people = Some(SampleSize { first_reached, held_from });
        Target { power: 0.9, people, balanced: Some(balanced), both_pass }
    }

    #[test]
    fn sizes() {
        assert_eq!(
            size(NOTICE, &target(42, 42, 44, None)),
            "For 90.0 % power to find that people notice, where a person is right with probability 0.75, plan 42 people in \
             an arm; 44 balance the cells."
        );
        assert_eq!(
            size(ALIKE, &target(66, 68, 68, Some(0.85))),
            "For 90.0 % power to show equivalence within ±20 %, where a person is right with probability 0.5, plan 68 people \
             in an arm (66 reach it too, but a few more people lose it again). The claim also needs the order-corrected \
             test: without a lean both pass with probability 85.0 % at 68 people."
        );
        let none = Target { power: 0.9, people: None, balanced: None, both_pass: None };
        assert!(size(ALIKE, &none).ends_with("a million people in an arm are too few, or the question has no answer."));
    }

    #[test]
    fn the_rest() {
        assert_eq!(title(NOTICE), "How many people to find that they notice");
        assert_eq!(title(ALIKE), "How many people to show that they hardly notice");
        assert_eq!(
            power(NOTICE, 16, 0.405),
            "With 16 people in an arm the power is 40.5 % to find that people notice, where a person is right with \
             probability 0.75."
        );
    }
}
