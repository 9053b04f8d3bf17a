//! What was fixed before the first participant: level, bound, exclusions.
//!
//! The plan is a part of the study file; a session stores its hash beside its log before the first trial
//! ([`Sidecar`](crate::trial_log::Sidecar)), and the report compares.

use serde::Serialize;
use stimuli::{Sha256, Study};

use crate::special::normal;

/// The equivalence bound, in both of its units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bound {
    /// Distance of the proportion correct from 1/2, in (0, 1/2).
    pub proportion: f64,
    /// The same in JOD: one JOD is a proportion of 3/4.
    pub jod: f64,
}

impl Bound {
    /// The bound at a distance of the proportion correct from 1/2; none outside (0, 1/2).
    #[must_use]
    pub fn from_proportion(proportion: f64) -> Option<Self> {
        let jod = normal::quantile(0.5 + proportion) / normal::quantile(0.75);
        (proportion > 0.0 && proportion < 0.5).then_some(Self { proportion, jod })
    }
}

/// The bound of a plan, and whether it is shown to be one that was fixed beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedBound {
    /// The bound.
    pub bound: Bound,
    /// True where every log recorded the plan's hash before its first trial.
    pub recorded: bool,
}

/// Whose critical trial is left out. None of the rules sees the answer to "which was worse".
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rules {
    /// Leave out interrupted trials.
    pub interrupted: bool,
    /// Leave out those who knew the purpose.
    pub knew_task: bool,
    /// Leave out trials on a display that was not verified.
    pub unverified_display: bool,
    /// The most that the second onset may miss its time after the first, seconds.
    pub onset_error_s: Option<f64>,
    /// The most that a picture's duration may miss its time, seconds.
    pub duration_error_s: Option<f64>,
    /// The most that either count may miss the true count, objects.
    pub count_error: Option<u32>,
}

impl Default for Rules {
    /// Without a plan only what needs no limit: interrupted trials and those who knew the purpose.
    fn default() -> Self {
        Self {
            interrupted: true,
            knew_task: true,
            unverified_display: false,
            onset_error_s: None,
            duration_error_s: None,
            count_error: None,
        }
    }
}

/// An analysis plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The study's id.
    pub study: String,
    /// Level of every test.
    pub alpha: f64,
    /// The equivalence bound.
    pub bound: Bound,
    /// Whose trial is left out.
    pub rules: Rules,
    /// How long each picture is to be shown, seconds.
    pub picture_s: f64,
    /// From one picture's end to the next one's onset, seconds.
    pub gap_s: f64,
    /// Participants planned in each arm.
    pub arms: Vec<(String, u32)>,
}

impl Plan {
    /// The plan that a study file states; none if its bound lies outside (0, 1/2).
    #[must_use]
    pub fn of(study: &Study) -> Option<Self> {
        let rules = &study.exclusions;
        Some(Self {
            study: study.id.clone(),
            alpha: study.analysis.alpha,
            bound: Bound { jod: study.analysis.bound_jod, ..Bound::from_proportion(study.analysis.bound_proportion)? },
            rules: Rules {
                interrupted: rules.interrupted,
                knew_task: rules.knew_task,
                unverified_display: rules.unverified_display,
                onset_error_s: Some(rules.max_onset_error_ms / 1e3),
                duration_error_s: Some(rules.max_duration_error_ms / 1e3),
                count_error: Some(rules.max_count_error),
            },
            picture_s: study.timing.interval_s,
            gap_s: study.timing.gap_s,
            arms: study.arms.iter().map(|arm| (arm.name.clone(), arm.n)).collect(),
        })
    }

    /// The digest of everything in the plan.
    #[must_use]
    pub fn hash(&self) -> Sha256 {
        Sha256::of(serde_json::to_string(self).expect("a plan is names and finite numbers").as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_is_one_jod() {
        assert!((Bound::from_proportion(0.25).unwrap().jod - 1.0).abs() < 1e-14);
        assert_eq!(Bound::from_proportion(0.5), None);
        assert_eq!(Bound::from_proportion(0.0), None);
    }
}
