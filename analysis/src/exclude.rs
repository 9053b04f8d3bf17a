//! Whose trial is left out, and why, as data.

use serde::Serialize;

use crate::plan::Rules;
use crate::trial_log::{Trial, Vsync};

/// What the rules may look at. The answer to "which was worse", its correctness and its confidence are not in here, so
/// that no rule can depend on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conduct {
    /// The trial was broken off or disturbed, with the reason given.
    pub interrupted: Option<String>,
    /// The participant says to have known the purpose.
    pub knew_task: bool,
    /// The display was verified, or the observer was a program and looked at none.
    pub verified: bool,
    /// From the first onset to the second, seconds.
    pub onset_to_onset_s: Option<f64>,
    /// How long the two pictures were shown, seconds.
    pub durations_s: [Option<f64>; 2],
    /// How far the two counts missed, objects; none where nothing was to be counted or no count was given.
    pub count_errors: [Option<u32>; 2],
    /// The participant took part before.
    pub repeated: bool,
}

impl Conduct {
    /// What may be known of a critical trial.
    #[must_use]
    pub fn of(trial: &Trial, knew_task: bool, repeated: bool) -> Self {
        let error = |count: Option<u32>, answer: Option<u32>| Some(count?.abs_diff(answer?));
        let between = |first: Option<f64>, second: Option<f64>| Some(second? - first?);
        Self {
            interrupted: trial.interrupted.then(|| trial.interrupt_reason.clone()),
            knew_task,
            verified: trial.vsync == Vsync::Verified || trial.simulated,
            onset_to_onset_s: between(trial.first_onset_s, trial.second_onset_s),
            durations_s: [trial.first_duration_s, trial.second_duration_s],
            count_errors: [
                error(trial.first_count, trial.first_count_answer),
                error(trial.second_count, trial.second_count_answer),
            ],
            repeated,
        }
    }
}

/// A reason to leave a trial out, in the order in which they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The session holds no answered critical trial.
    NoCriticalAnswer,
    /// The participant took part before.
    RepeatedParticipant,
    /// Broken off or disturbed.
    Interrupted,
    /// The display was not verified.
    UnverifiedDisplay,
    /// The second picture came too early or too late.
    Onset,
    /// A picture was shown too long or too short.
    Duration,
    /// A count was too far off.
    Count,
    /// The purpose was known.
    KnewTask,
}

impl Reason {
    /// In words, as the end of "left out because".
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::NoCriticalAnswer => "the session holds no answered critical trial",
            Self::RepeatedParticipant => "the participant took part before",
            Self::Interrupted => "the trial was interrupted",
            Self::UnverifiedDisplay => "the display was not verified",
            Self::Onset => "the second picture came too early or too late",
            Self::Duration => "a picture was shown too long or too short",
            Self::Count => "a count was farther off than the plan allows",
            Self::KnewTask => "the participant knew the purpose",
        }
    }
}

/// The planned times that durations and onsets are held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// How long a picture is shown, seconds.
    pub picture_s: f64,
    /// Between the pictures, seconds.
    pub gap_s: f64,
}

/// The first reason that the rules give for leaving a trial out, with the measured value in words.
#[must_use]
pub fn judge(conduct: &Conduct, rules: &Rules, times: Option<Times>) -> Option<(Reason, String)> {
    if conduct.repeated {
        return Some((Reason::RepeatedParticipant, String::new()));
    }
    if let (true, Some(why)) = (rules.interrupted, &conduct.interrupted) {
        return Some((Reason::Interrupted, why.clone()));
    }
    if rules.unverified_display && !conduct.verified {
        return Some((Reason::UnverifiedDisplay, String::new()));
    }
    if let (Some(limit), Some(times)) = (rules.onset_error_s, times)
        && let Some(found) = conduct.onset_to_onset_s
    {
        let planned = times.picture_s + times.gap_s;
        if (found - planned).abs() > limit {
            return Some((Reason::Onset, format!("{found:.4} s after the first, planned {planned} s")));
        }
    }
    if let (Some(limit), Some(times)) = (rules.duration_error_s, times) {
        let off = conduct.durations_s.iter().flatten().find(|found| (**found - times.picture_s).abs() > limit);
        if let Some(found) = off {
            return Some((Reason::Duration, format!("shown for {found:.4} s, planned {} s", times.picture_s)));
        }
    }
    if let Some(limit) = rules.count_error
        && let Some(off) = conduct.count_errors.iter().flatten().find(|off| **off > limit)
    {
        return Some((Reason::Count, format!("off by {off}, at most {limit} allowed")));
    }
    if rules.knew_task && conduct.knew_task {
        return Some((Reason::KnewTask, String::new()));
    }
    None
}

/// One session whose critical trial is not in the main tests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Excluded {
    /// The session.
    pub session_id: String,
    /// The participant.
    pub participant: String,
    /// The arm.
    pub arm: String,
    /// Why.
    pub reason: Reason,
    /// The measured value, where the reason is one.
    pub detail: String,
    /// The log.
    pub file: String,
    /// The line of the critical trial, or the session's first.
    pub line: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: Option<Times> = Some(Times { picture_s: 6.0, gap_s: 1.0 });

    fn rules() -> Rules {
        Rules {
            interrupted: true,
            knew_task: true,
            unverified_display: true,
            onset_error_s: Some(0.05),
            duration_error_s: Some(0.05),
            count_error: Some(4),
        }
    }

    fn good() -> Conduct {
        Conduct {
            verified: true,
            onset_to_onset_s: Some(7.04),
            durations_s: [Some(6.04), Some(5.96)],
            count_errors: [Some(4), Some(0)],
            ..Conduct::default()
        }
    }

    fn reason(conduct: Conduct) -> Option<Reason> {
        judge(&conduct, &rules(), TIMES).map(|(reason, _)| reason)
    }

    #[test]
    fn a_good_trial_stays() {
        assert_eq!(reason(good()), None);
    }

    #[test]
    fn every_rule_has_its_reason() {
        let cases = [
            (Conduct { repeated: true, ..good() }, Reason::RepeatedParticipant),
            (Conduct { interrupted: Some("fire drill".into()), ..good() }, Reason::Interrupted),
            (Conduct { verified: false, ..good() }, Reason::UnverifiedDisplay),
            (Conduct { onset_to_onset_s: Some(6.94), ..good() }, Reason::Onset),
            (Conduct { durations_s: [Some(6.0), Some(6.06)], ..good() }, Reason::Duration),
            (Conduct { count_errors: [Some(0), Some(5)], ..good() }, Reason::Count),
            (Conduct { knew_task: true, ..good() }, Reason::KnewTask),
        ];
        for (conduct, expected) in cases {
            assert_eq!(reason(conduct), Some(expected));
        }
    }

    #[test]
    fn the_first_reason_counts_and_says_the_value() {
        let conduct = Conduct { durations_s: [Some(6.5), None], knew_task: true, ..good() };
        let (reason, detail) = judge(&conduct, &rules(), TIMES).unwrap();
        assert_eq!((reason, detail.as_str()), (Reason::Duration, "shown for 6.5000 s, planned 6 s"));
    }

    #[test]
    fn without_a_plan_only_what_needs_no_limit() {
        let bad = Conduct { verified: false, count_errors: [Some(99), None], durations_s: [Some(1.0), None], ..good() };
        assert_eq!(judge(&bad, &Rules::default(), None), None);
        let knew = Conduct { knew_task: true, ..bad };
        assert_eq!(judge(&knew, &Rules::default(), None).map(|(reason, _)| reason), Some(Reason::KnewTask));
    }

    #[test]
    fn every_reason_has_words() {
        use Reason::*;
        let all =
            [NoCriticalAnswer, RepeatedParticipant, Interrupted, UnverifiedDisplay, Onset, Duration, Count, KnewTask];
        assert!(all.iter().all(|reason| reason.words().len() > 10));
        assert!(all.is_sorted());
    }
}
