//! From what was planned and observed to a row of the log.

use analysis::trial_log::{OnsetSource, Trial as Row};
use serde::{Deserialize, Serialize};

use crate::display::DisplayFacts;
use crate::timing::IntervalFrames;
use crate::trial::{Observed, TrialPlan};

/// Whose session it is, and with what: the same in every row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// The study's id.
    pub study: String,
    /// Unique over all sessions of the study.
    pub session_id: String,
    /// The participant's code.
    pub participant: String,
    /// The arm's name.
    pub arm: String,
    /// Whether the observer is a program.
    pub simulated: bool,
    /// The study's seed.
    pub seed: u64,
    /// The digest of the plan.
    pub plan_hash: String,
    /// The digest of the stimuli's manifest.
    pub stimuli_hash: String,
    /// Name and version of the program.
    pub version: String,
    /// When the session began.
    pub started_utc: String,
    /// Whether the study is a demonstration.
    pub demo: bool,
}

/// The row of a trial.
pub(super) fn row(
    identity: &Identity,
    display: &DisplayFacts,
    plan: &TrialPlan,
    observed: &Observed,
    known_task: Option<bool>,
    resume_gap_s: Option<f64>,
) -> Row {
    let (first, second) = (observed.first, observed.second);
    // Frames that a rehearsal never drew cannot be missed.
    let drawn = |frames: Option<IntervalFrames>| frames.filter(|_| display.onset_source != OnsetSource::Estimated);
    let correct = plan.worse().and_then(|worse| Some(observed.worse? == worse));
    let reasons: Vec<_> = observed.interruptions.iter().map(|interruption| interruption.word()).collect();
    let identity = identity.clone();
    Row {
        study: identity.study,
        session_id: identity.session_id,
        participant: identity.participant,
        arm: identity.arm,
        simulated: identity.simulated,
        phase: plan.phase,
        trial: plan.number,
        first_stimulus: plan.first.stimulus.id(),
        second_stimulus: plan.second.stimulus.id(),
        first_layout: plan.first.stimulus.layout.clone(),
        second_layout: plan.second.stimulus.layout.clone(),
        first_quality: plan.first.stimulus.quality.clone(),
        second_quality: plan.second.stimulus.quality.clone(),
        first_count: plan.first.count,
        second_count: plan.second.count,
        first_count_answer: observed.first_count,
        second_count_answer: observed.second_count,
        worse_answer: observed.worse,
        correct,
        confidence: observed.confidence,
        rt_s: observed.rt_s,
        first_onset_s: first.map(|frames| frames.onset_s),
        first_duration_s: first.and_then(|frames| frames.duration_s),
        second_onset_s: second.map(|frames| frames.onset_s),
        second_duration_s: second.and_then(|frames| frames.duration_s),
        onset_source: display.onset_source,
        first_missed_frames: drawn(first).map(|frames| frames.missed),
        first_max_frame_ms: drawn(first).map(|frames| frames.longest_ms),
        second_missed_frames: drawn(second).map(|frames| frames.missed),
        second_max_frame_ms: drawn(second).map(|frames| frames.longest_ms),
        refresh_hz: display.refresh_hz,
        vsync: display.vsync,
        interrupted: !observed.interruptions.is_empty(),
        interrupt_reason: reasons.join("+"),
        resume_gap_s,
        known_task,
        seed: identity.seed,
        plan_hash: identity.plan_hash,
        stimuli_hash: identity.stimuli_hash,
        version: identity.version,
        started_utc: identity.started_utc,
        demo: identity.demo,
    }
}
