//! Arms against one another, and several tests at once.

use serde::Serialize;

use super::arm::ArmReport;
use super::words;
use crate::contrast::{Contrast, holm};

/// The contrast of two arms that have a right answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContrastReport {
    /// The first arm.
    pub first: String,
    /// The arm that is taken from it.
    pub second: String,
    /// The numbers.
    #[serde(flatten)]
    pub contrast: Contrast,
    /// What they say.
    pub sentence: String,
}

impl ContrastReport {
    /// Every pair of arms that have a right answer and people.
    #[must_use]
    pub fn all(arms: &[ArmReport], alpha: f64) -> Vec<Self> {
        let counted: Vec<_> = arms.iter().filter_map(|arm| Some((&arm.arm, arm.counts()?))).collect();
        let mut all = Vec::new();
        for (at, (first, counts)) in counted.iter().enumerate() {
            for (second, others) in &counted[at + 1..] {
                if let Some(contrast) = Contrast::new(*counts, *others, 1.0 - alpha) {
                    let sentence = words::contrast(first, second, &contrast, 1.0 - alpha);
                    all.push(Self { first: (*first).clone(), second: (*second).clone(), contrast, sentence });
                }
            }
        }
        all
    }
}

/// The primary tests, adjusted for being several.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Multiplicity {
    /// The arms with their Holm-adjusted exact p values.
    pub holm: Vec<(String, f64)>,
    /// What it means.
    pub sentence: String,
}

impl Multiplicity {
    /// The exact tests of all arms with a right answer.
    #[must_use]
    pub fn new(arms: &[ArmReport], alpha: f64) -> Self {
        let tests: Vec<(String, f64)> =
            arms.iter().filter_map(|arm| Some((arm.arm.clone(), arm.tests.binomial?.p))).collect();
        let adjusted = holm(&tests.iter().map(|(_, p)| *p).collect::<Vec<_>>());
        let holm: Vec<(String, f64)> = tests.into_iter().map(|(arm, _)| arm).zip(adjusted).collect();
        Self { sentence: words::multiplicity(&holm, alpha), holm }
    }
}
