//! How many people a question needs, exactly.
//!
//! Exact power is a saw-tooth in n: it climbs, and falls back where the critical count moves. The number that is asked
//! for is therefore not the first that reaches the target but the one from which power never falls below it again.

use serde::Serialize;

use crate::{binomial, equivalence};

/// What a study is to show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "question")]
pub enum Question {
    /// That people notice: the two-sided exact test rejects one half when a person is right with probability `truth`.
    Superiority {
        /// Probability of a right answer.
        truth: f64,
    },
    /// That people hardly notice: the exact equivalence test passes at `bound` when a person is right with probability
    /// `truth`.
    Equivalence {
        /// Probability of a right answer.
        truth: f64,
        /// Distance of the bounds from one half.
        bound: f64,
    },
}

impl Question {
    /// The exact power with `n` people.
    #[must_use]
    pub fn power(self, n: u64, alpha: f64) -> f64 {
        match self {
            Self::Superiority { truth } => binomial::power(n, truth, alpha),
            Self::Equivalence { truth, bound } => equivalence::power(n, truth, bound, alpha),
        }
    }

    /// Half the distance that n must resolve, for the normal approximation that starts the search.
    fn distance(self) -> f64 {
        match self {
            Self::Superiority { truth } => (truth - 0.5).abs(),
            Self::Equivalence { truth, bound } => bound - (truth - 0.5).abs(),
        }
    }
}

/// The numbers of people that a target power asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct SampleSize {
    /// The first n whose power is at least the target.
    pub first_reached: u64,
    /// The n from which power stays at least the target for every larger n: plan with this one.
    pub held_from: u64,
}

/// Largest number of people that [`sample_size`] considers.
pub const MOST: u64 = 1_000_000;

/// The smallest numbers of people for `target` power at level `alpha`; none where [`MOST`] people are too few, or the
/// truth is one half (superiority) or on or beyond the bound (equivalence).
#[must_use]
pub fn sample_size(question: Question, target: f64, alpha: f64) -> Option<SampleSize> {
    let distance = question.distance();
    if distance <= 0.0 || !(0.0..1.0).contains(&target) {
        return None;
    }
    let reaches = |n: u64| question.power(n, alpha) >= target;
    let mut first = 1;
    while !reaches(first) {
        first += 1 + first / 2_000;
        if first > MOST {
            return None;
        }
    }
    while first > 1 && reaches(first - 1) {
        first -= 1;
    }
    // An earlier tooth may have reached it between the steps: teeth are as high as power climbs in some sqrt n people.
    let before = 1 + first / 1_000 + 8 * first.isqrt();
    let first_reached = (first.saturating_sub(before).max(1)..=first).find(|&n| reaches(n)).unwrap_or(first);
    // A target near the level is lost again and again for long: the last fall must lie well before where looking ends.
    let mut horizon = first_reached + 200 + 20 * first_reached.isqrt();
    while horizon <= 2 * MOST {
        let last_below = (first_reached..=horizon).rev().find(|&n| !reaches(n));
        let held_from = last_below.map_or(first_reached, |n| n + 1);
        if held_from - first_reached <= (horizon - first_reached) / 2 {
            return (held_from <= MOST).then_some(SampleSize { first_reached, held_from });
        }
        horizon *= 2;
    }
    None
}

/// What `n` people can and cannot show, for the report and for planning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reach {
    /// People.
    pub n: u64,
    /// Smallest count of right answers that the exact test rejects; none where no outcome does.
    pub least_significant: Option<u64>,
    /// Exact power of the exact test where a person is right with probability .6, .7, .75, .8 and .9.
    pub power: Vec<(f64, f64)>,
    /// The smallest equivalence bound at which any outcome passes; none where none below .5 does.
    pub smallest_bound: Option<f64>,
    /// The probability right, above one half, from which the test's power is at least .8; none where it never is.
    pub detectable: Option<f64>,
}

impl Reach {
    /// What `n` people can show at `alpha`; none without people.
    #[must_use]
    pub fn new(n: u64, alpha: f64) -> Option<Self> {
        if n == 0 {
            return None;
        }
        let rejected = binomial::rejects_up_to(n, alpha);
        let power = |truth: f64| {
            rejected.map_or(0.0, |k| {
                let (low, high) = (binomial::ln_at_most(k, n, truth), binomial::ln_at_least(n - k, n, truth));
                (low.exp() + high.exp()).min(1.0)
            })
        };
        let rising = |reached: &dyn Fn(f64) -> bool, mut low: f64, mut high: f64| {
            reached(high).then(|| {
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    if reached(middle) { high = middle } else { low = middle }
                }
                high
            })
        };
        Some(Self {
            n,
            least_significant: rejected.map(|k| n - k),
            power: [0.6, 0.7, 0.75, 0.8, 0.9].map(|truth| (truth, power(truth))).to_vec(),
            smallest_bound: rising(&|bound| equivalence::passing(n, bound, alpha).is_some(), 0.0, 0.5 - 1e-9),
            detectable: rising(&|truth| power(truth) >= 0.8, 0.5, 1.0 - 1e-9),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn superiority(truth: f64) -> [u64; 2] {
        [0.8, 0.9].map(|target| sample_size(Question::Superiority { truth }, target, 0.05).unwrap().held_from)
    }

    #[test]
    fn numbers_for_noticing() {
        assert_eq!(superiority(0.75), [35, 42]);
        assert_eq!(superiority(0.70), [54, 70]);
        assert_eq!(superiority(0.65), [97, 121]);
        assert_eq!(superiority(0.60), [210, 274]);
        assert_eq!(superiority(0.25), [35, 42], "choosing the better one as often is as easily seen");
    }

    #[test]
    fn numbers_for_equivalence() {
        let at = |bound| {
            [0.8, 0.9].map(|target| sample_size(Question::Equivalence { truth: 0.5, bound }, target, 0.05).unwrap())
        };
        for (bound, held) in [(0.25, [35, 44]), (0.20, [57, 69]), (0.15, [100, 126]), (0.10, [227, 281])] {
            assert_eq!(at(bound).map(|size| size.held_from), held, "{bound}");
        }
        // .2 JOD.
        let size = sample_size(
            Question::Equivalence { truth: 0.5, bound: stimuli::study::AnalysisPlan::proportion_of_jod(0.2) },
            0.9,
            0.05,
        )
        .unwrap();
        assert!(size.held_from == 969, "{size:?}");
    }

    /// The saw-tooth, for two questions and three targets.
    #[test]
    fn a_target_reached_may_be_lost_again() {
        for target in [0.5, 0.8, 0.9] {
            for question in [Question::Superiority { truth: 0.7 }, Question::Equivalence { truth: 0.5, bound: 0.2 }] {
                let size = sample_size(question, target, 0.05).unwrap();
                let power = |n| question.power(n, 0.05);
                assert!(power(size.first_reached) >= target);
                assert!((1..size.first_reached).all(|n| power(n) < target));
                assert!((size.held_from..size.held_from + 400).all(|n| power(n) >= target));
                assert!(size.held_from == 1 || power(size.held_from - 1) < target);
                assert!(size.first_reached <= size.held_from);
            }
        }
    }

    /// A target within the teeth of the size itself is reached at 17 people by luck of the critical count and held only
    /// where the effect, not the tooth, lifts the power.
    #[test]
    fn a_target_below_the_level_is_not_held_too_early() {
        let question = Question::Superiority { truth: 0.501 };
        let size = sample_size(question, 0.04, 0.05).unwrap();
        // By scipy 1.17: the last n below it is 417.
        assert_eq!((size.first_reached, size.held_from), (17, 418));
        assert!(question.power(size.held_from - 1, 0.05) < 0.04);
        assert!((size.held_from..4_000).all(|n| question.power(n, 0.05) >= 0.04));
    }

    #[test]
    fn questions_without_an_answer() {
        assert_eq!(sample_size(Question::Superiority { truth: 0.5 }, 0.8, 0.05), None);
        assert_eq!(sample_size(Question::Equivalence { truth: 0.7, bound: 0.2 }, 0.8, 0.05), None);
        assert_eq!(sample_size(Question::Superiority { truth: 0.7 }, 1.0, 0.05), None);
    }

    #[test]
    fn what_sixteen_people_can_show() {
        let reach = Reach::new(16, 0.05).unwrap();
        assert_eq!(reach.least_significant, Some(13));
        assert!((reach.power[2].1 - 0.405).abs() < 5e-4);
        assert!((reach.power[1].1 - 0.246).abs() < 5e-4 && (reach.power[3].1 - 0.598).abs() < 5e-4);
        let bound = reach.smallest_bound.unwrap();
        assert!(bound < 0.25 && bound > 0.20);
        let detectable = reach.detectable.unwrap();
        assert!((binomial::power(16, detectable, 0.05) - 0.8).abs() < 1e-6);
        assert_eq!(Reach::new(3, 0.05).unwrap().least_significant, None);
        assert_eq!(Reach::new(0, 0.05), None);
    }
}
