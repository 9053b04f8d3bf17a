//! From a study and a slot of its plan to the steps of one session.

use analysis::trial_log::Phase;
use stimuli::study::Viewing;
use stimuli::{Stimulus, Study};

use crate::design::{Pair, Slot};
use crate::session::{Page, Step};
use crate::trial::{Asks, Shown, TrialPlan};

/// The steps of the session of one slot: consent, instructions, practice, the critical trial, what was noticed, whether
/// the purpose was known, the obvious pair.
///
/// Until the critical answer nothing asks about quality: practice asks for counts alone, and for nothing in an arm of free
/// viewing.
#[must_use]
pub fn steps(study: &Study, slot: &Slot) -> Vec<Step> {
    let counts = study.viewing(&slot.arm) == Viewing::Task;
    let mut steps = vec![Step::Consent, Step::Page(Page::Instructions)];
    let mut number = 0;
    let mut trial = |phase, first: &Stimulus, second: &Stimulus, asks: Asks| {
        number += 1;
        let [first, second] = [first, second].map(|stimulus| shown(study, stimulus, asks));
        Step::Trial(TrialPlan { number, phase, first, second, asks })
    };
    if !study.practice.is_empty() {
        steps.push(Step::Page(Page::Practice));
    }
    for practice in &study.practice {
        let asks = Asks { counts, ..Asks::default() };
        steps.push(trial(Phase::Practice, &practice.first, &practice.second, asks));
    }
    steps.push(Step::Page(Page::Ready));
    let confidence = study.wording.confidence.is_some();
    let Pair { first, second } = &slot.critical;
    steps.push(trial(Phase::Critical, first, second, Asks { counts, worse: true, confidence }));
    steps.extend([Step::Noticed, Step::KnownTask]);
    if let Some(Pair { first, second }) = &slot.check {
        steps.push(Step::Page(Page::Check));
        steps.push(trial(Phase::Check, first, second, Asks { counts: false, worse: true, confidence }));
    }
    steps
}

fn shown(study: &Study, stimulus: &Stimulus, asks: Asks) -> Shown {
    Shown {
        stimulus: stimulus.clone(),
        count: if asks.counts { study.true_count(&stimulus.layout) } else { None },
        rank: study.quality(&stimulus.quality).map_or(0, |quality| quality.rank),
    }
}
