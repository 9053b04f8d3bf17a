//! Taking up a session that broke off: what is on disk decides where it goes on.
//!
//! The policy, for every phase alike: a pair whose start is on disk was seen, or may have been. It is never shown again;
//! it gets a row that says so, and the session goes on behind it.

use std::collections::BTreeSet;

use stimuli::study::Timing;

use super::{Effect, Outcome, Record, Session, Step, Then};
use crate::input::Interruption;
use crate::trial::Observed;

/// What a broken session left on disk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Done {
    /// Whether consent was given; `None` if it was not asked yet.
    pub consent: Option<bool>,
    /// Trials whose pair was about to be shown, by number.
    pub started: BTreeSet<u32>,
    /// Trials with a row.
    pub finished: BTreeSet<u32>,
    /// Whether it was asked what was noticed.
    pub noticed: bool,
    /// Whether the purpose was known; `None` if that was not asked yet.
    pub known_task: Option<bool>,
    /// How the session ended, if it did.
    pub ended: Option<Outcome>,
}

impl Done {
    fn has(&self, step: &Step) -> bool {
        match step {
            Step::Consent => self.consent == Some(true),
            Step::Page(_) => true,
            Step::Trial(plan) => self.started.contains(&plan.number) || self.finished.contains(&plan.number),
            Step::Noticed => self.noticed,
            Step::KnownTask => self.known_task.is_some(),
        }
    }
}

impl Session {
    /// Goes on with a session that broke off `gap_s` seconds ago. The texts before the step that comes next are shown
    /// again; no picture is.
    #[must_use]
    pub fn resume(steps: Vec<Step>, timing: Timing, done: &Done, gap_s: f64) -> (Self, Effect) {
        let mut next = steps.iter().position(|step| !done.has(step)).unwrap_or(steps.len());
        if next < steps.len() {
            while next > 0 && matches!(steps[next - 1], Step::Page(_)) {
                next -= 1;
            }
        }
        let lost = steps.iter().find_map(|step| match step {
            Step::Trial(plan) if done.started.contains(&plan.number) && !done.finished.contains(&plan.number) => {
                Some(plan.clone())
            }
            _ => None,
        });
        let mut session = Self::at_rest(steps, timing);
        session.known_task = done.known_task;
        let effect = match (done.ended, lost) {
            (Some(outcome), _) => {
                session.stage = super::Stage::End(outcome, None);
                Effect::None
            }
            (None, Some(plan)) => {
                let observed = Observed { interruptions: vec![Interruption::Crash], ..Observed::default() };
                let record =
                    Record::Trial { plan: Box::new(plan), observed: Box::new(observed), resume_gap_s: Some(gap_s) };
                session.save(record, Then::Go(next))
            }
            (None, None) if done.consent == Some(false) => {
                session.save(Record::Ended(Outcome::Declined), Then::End(Outcome::Declined))
            }
            (None, None) => session.go(next),
        };
        (session, effect)
    }
}
