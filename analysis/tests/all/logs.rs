//! Logs to test with.

use std::path::{Path, PathBuf};

use analysis::trial_log::{Interval, OnsetSource, Phase, Trial, Vsync, header_line, row_line};

/// A good critical trial of participant `id` in the arm HQ/CBQ: the lower quality was second, and was told.
pub(crate) fn critical(id: u32) -> Trial {
    Trial {
        study: "corridor".into(),
        session_id: format!("s{id:04}"),
        participant: format!("p{id:04}"),
        arm: "HQ/CBQ".into(),
        phase: Phase::Critical,
        trial: 2,
        first_stimulus: "a_hq".into(),
        second_stimulus: "b_cbq".into(),
        first_layout: "a".into(),
        second_layout: "b".into(),
        first_quality: "HQ".into(),
        second_quality: "CBQ".into(),
        first_count: Some(11),
        second_count: Some(9),
        first_count_answer: Some(10),
        second_count_answer: Some(9),
        worse_answer: Some(Interval::Second),
        correct: Some(true),
        rt_s: Some(2.0),
        first_onset_s: Some(30.0),
        first_duration_s: Some(6.0),
        second_onset_s: Some(37.0),
        second_duration_s: Some(6.0),
        onset_source: OnsetSource::SwapReturn,
        first_missed_frames: Some(0),
        first_max_frame_ms: Some(16.7),
        second_missed_frames: Some(0),
        second_max_frame_ms: Some(16.7),
        refresh_hz: Some(60.0),
        vsync: Vsync::Verified,
        seed: 2005,
        plan_hash: "ab".repeat(32),
        stimuli_hash: "01".repeat(32),
        version: "0.1.0".into(),
        started_utc: "2005-11-29T09:30:00Z".into(),
        ..Trial::default()
    }
}

/// The practice trial before it.
pub(crate) fn practice(id: u32) -> Trial {
    Trial {
        phase: Phase::Practice,
        trial: 1,
        second_quality: "HQ".into(),
        worse_answer: None,
        correct: None,
        ..critical(id)
    }
}

/// A trial in HQ/HQ, where no answer is right.
pub(crate) fn alike(id: u32, answer: Interval) -> Trial {
    Trial {
        arm: "HQ/HQ".into(),
        second_quality: "HQ".into(),
        worse_answer: Some(answer),
        correct: None,
        ..critical(id)
    }
}

/// The trial with another answer.
pub(crate) fn answered(trial: Trial, answer: Interval) -> Trial {
    let correct = trial.lower_quality().map(|lower| lower == answer);
    Trial { worse_answer: Some(answer), correct, ..trial }
}

/// The trial with its two pictures in the other order and the same answer.
pub(crate) fn swapped(trial: Trial) -> Trial {
    let correct = trial.correct.map(|correct| !correct);
    Trial {
        first_stimulus: trial.second_stimulus,
        second_stimulus: trial.first_stimulus,
        first_layout: trial.second_layout,
        second_layout: trial.first_layout,
        first_quality: trial.second_quality,
        second_quality: trial.first_quality,
        first_count: trial.second_count,
        second_count: trial.first_count,
        first_count_answer: trial.second_count_answer,
        second_count_answer: trial.first_count_answer,
        correct,
        ..trial
    }
}

/// Writes a log.
pub(crate) fn write(folder: &Path, name: &str, rows: &[Trial]) -> PathBuf {
    let text: String = std::iter::once(header_line()).chain(rows.iter().map(row_line)).collect();
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// The paper's counts as trials: 9 of 16 right in HQ/CBQ, balanced over order; 8 of 16 second in HQ/HQ.
pub(crate) fn paper() -> Vec<Trial> {
    let mut rows = Vec::new();
    for id in 0..16 {
        let trial = if id < 8 { critical(id) } else { swapped(critical(id)) };
        let answer = if id % 2 == 0 || id == 1 {
            trial.lower_quality().unwrap()
        } else {
            trial.lower_quality().unwrap().other()
        };
        rows.push(answered(trial, answer));
    }
    for id in 16..32 {
        rows.push(alike(id, if id % 2 == 0 { Interval::First } else { Interval::Second }));
    }
    rows
}
