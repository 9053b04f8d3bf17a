//! The columns of a log: name, unit, meaning.

use serde::Serialize;

/// What one column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Column {
    /// Name, as in the header line.
    pub name: &'static str,
    /// Kind of value: `text`, `true or false`, `whole number`, `number`, or the words allowed.
    pub values: &'static str,
    /// Unit of a number; empty where it has none.
    pub unit: &'static str,
    /// Whether the field may be empty.
    pub optional: bool,
    /// What it means.
    pub meaning: &'static str,
}

const TEXT: &str = "text";
const BOOL: &str = "true or false";
const WHOLE: &str = "whole number";
const NUMBER: &str = "number";
const HASH: &str = "64 hexadecimal digits";

const fn must(name: &'static str, values: &'static str, unit: &'static str, meaning: &'static str) -> Column {
    Column { name, values, unit, optional: false, meaning }
}

const fn may(name: &'static str, values: &'static str, unit: &'static str, meaning: &'static str) -> Column {
    Column { name, values, unit, optional: true, meaning }
}

/// Every column, in the order of the log. All but the last are in every log.
pub const COLUMNS: [Column; 42] = [
    must("study", TEXT, "", "name of the study"),
    must("session_id", TEXT, "", "name of the session, unique over all logs of the study"),
    must("participant", TEXT, "", "the participant's pseudonym"),
    must("arm", TEXT, "", "arm of the study that the participant was allotted to"),
    must("simulated", BOOL, "", "true when a simulated observer answered"),
    must(
        "phase",
        "practice, critical, informed or check",
        "",
        "part of the session; the main tests use critical alone",
    ),
    must("trial", WHOLE, "", "number of the trial within the session, from 1"),
    must("first_stimulus", TEXT, "", "stimulus shown first, by the manifest's name"),
    must("second_stimulus", TEXT, "", "stimulus shown second, by the manifest's name"),
    may("first_layout", TEXT, "", "layout of the first stimulus"),
    may("second_layout", TEXT, "", "layout of the second stimulus"),
    may("first_quality", TEXT, "", "quality of the first stimulus, by the study file's name"),
    may("second_quality", TEXT, "", "quality of the second stimulus, by the study file's name"),
    may("first_count", WHOLE, "objects", "true count of task objects in the first stimulus"),
    may("second_count", WHOLE, "objects", "true count of task objects in the second stimulus"),
    may("first_count_answer", WHOLE, "objects", "the participant's count for the first stimulus"),
    may("second_count_answer", WHOLE, "objects", "the participant's count for the second stimulus"),
    may("worse_answer", "first or second", "", "interval said to have had the worse rendering quality"),
    may("correct", BOOL, "", "whether worse_answer is the lower quality; empty where no answer is right"),
    may("confidence", WHOLE, "", "confidence in worse_answer, 1 (guess) to 4 (certain)"),
    may("rt_s", NUMBER, "s", "from the question's onset to the answer"),
    may("first_onset_s", NUMBER, "s", "onset of the first picture, monotonic from the session's start"),
    may("first_duration_s", NUMBER, "s", "how long the first picture was shown"),
    may("second_onset_s", NUMBER, "s", "onset of the second picture, monotonic from the session's start"),
    may("second_duration_s", NUMBER, "s", "how long the second picture was shown"),
    must("onset_source", "swap_return, present or estimated", "", "where the onsets come from"),
    may("first_missed_frames", WHOLE, "frames", "frames missed while the first picture was shown"),
    may("first_max_frame_ms", NUMBER, "ms", "longest frame while the first picture was shown"),
    may("second_missed_frames", WHOLE, "frames", "frames missed while the second picture was shown"),
    may("second_max_frame_ms", NUMBER, "ms", "longest frame while the second picture was shown"),
    may("refresh_hz", NUMBER, "Hz", "refresh rate; empty unless vsync is verified"),
    must("vsync", "verified or unverified", "", "whether swaps were found to be paced by the display"),
    must("interrupted", BOOL, "", "true when the trial was broken off or disturbed"),
    may("interrupt_reason", TEXT, "", "why it was interrupted"),
    may("resume_gap_s", NUMBER, "s", "between the break and the resumption of the session"),
    may("known_task", BOOL, "", "whether the participant says to have known the purpose; empty before that is asked"),
    must("seed", WHOLE, "", "seed of the session's randomness"),
    must("plan_hash", HASH, "", "SHA-256 of the allocation plan"),
    must("stimuli_hash", HASH, "", "SHA-256 of the stimuli manifest"),
    must("version", TEXT, "", "version of the program that wrote the row"),
    must("started_utc", "YYYY-MM-DDTHH:MM:SSZ", "", "start of the session, universal time"),
    must("demo", BOOL, "", "true where the study is a demonstration; a log without the column is none"),
];

/// How many of [`COLUMNS`] a log must have.
pub(super) const REQUIRED: usize = COLUMNS.len() - 1;

/// The place of a column in [`COLUMNS`], by name.
#[must_use]
pub fn column(name: &str) -> Option<usize> {
    COLUMNS.iter().position(|column| column.name == name)
}
