//! The row itself.

use serde::Serialize;

/// Which part of a session a trial belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Rehearses counting; nothing was asked about quality.
    #[default]
    Practice,
    /// The one trial per participant that the main tests use.
    Critical,
    /// After the critical question the participant knows what is asked: reported apart.
    Informed,
    /// The obvious pair that shows whether the participant can see a difference at all.
    Check,
}

/// One of the two intervals of a two-alternative forced choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Interval {
    /// The picture shown first.
    #[default]
    First,
    /// The picture shown second.
    Second,
}

/// Where the time of an onset comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OnsetSource {
    /// The moment the buffer swap returned.
    SwapReturn,
    /// A presentation time given by the window system.
    Present,
    /// Computed, not observed: rehearsals and displays that tell nothing.
    #[default]
    Estimated,
}

/// Whether swaps were found to be paced by the display. It does not say that scan-out was seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Vsync {
    /// Swaps keep the display's pace.
    Verified,
    /// Not shown to be so.
    #[default]
    Unverified,
}

/// One trial: one row of the log, columns in this order ([`COLUMNS`](super::COLUMNS) gives units and meaning).
///
/// `None` is written as an empty field. Times are monotonic seconds from the session's start.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Trial {
    /// Name of the study.
    pub study: String,
    /// Name of the session, unique over all logs of a study.
    pub session_id: String,
    /// The participant's pseudonym.
    pub participant: String,
    /// The arm, by the name that the study file gives it.
    pub arm: String,
    /// True when a simulated observer answered.
    pub simulated: bool,
    /// Part of the session.
    pub phase: Phase,
    /// Number of the trial within the session, from 1.
    pub trial: u32,
    /// Stimulus shown first, by the manifest's name.
    pub first_stimulus: String,
    /// Stimulus shown second.
    pub second_stimulus: String,
    /// Layout of the first stimulus.
    pub first_layout: String,
    /// Layout of the second stimulus.
    pub second_layout: String,
    /// Quality of the first stimulus, by the study file's name.
    pub first_quality: String,
    /// Quality of the second stimulus.
    pub second_quality: String,
    /// True count of task objects in the first stimulus; none where nothing is to be counted.
    pub first_count: Option<u32>,
    /// True count of task objects in the second stimulus.
    pub second_count: Option<u32>,
    /// The participant's count for the first stimulus.
    pub first_count_answer: Option<u32>,
    /// The participant's count for the second stimulus.
    pub second_count_answer: Option<u32>,
    /// The interval said to have had the worse rendering quality; none where that was not asked.
    pub worse_answer: Option<Interval>,
    /// Whether `worse_answer` is the lower quality; none where no answer is right.
    pub correct: Option<bool>,
    /// Confidence in the answer, 1 (guess) to 4 (certain), where asked.
    pub confidence: Option<u8>,
    /// Seconds from the question's onset to the answer.
    pub rt_s: Option<f64>,
    /// Onset of the first picture.
    pub first_onset_s: Option<f64>,
    /// How long the first picture was shown.
    pub first_duration_s: Option<f64>,
    /// Onset of the second picture.
    pub second_onset_s: Option<f64>,
    /// How long the second picture was shown.
    pub second_duration_s: Option<f64>,
    /// Where the onsets come from.
    pub onset_source: OnsetSource,
    /// Frames missed while the first picture was shown; none where that cannot be told.
    pub first_missed_frames: Option<u32>,
    /// Longest frame while the first picture was shown, milliseconds.
    pub first_max_frame_ms: Option<f64>,
    /// Frames missed while the second picture was shown.
    pub second_missed_frames: Option<u32>,
    /// Longest frame while the second picture was shown, milliseconds.
    pub second_max_frame_ms: Option<f64>,
    /// Refresh rate; none unless `vsync` is verified.
    pub refresh_hz: Option<f64>,
    /// Whether swaps are paced by the display.
    pub vsync: Vsync,
    /// True when the trial was broken off or disturbed.
    pub interrupted: bool,
    /// Why, in a word; empty where it was not.
    pub interrupt_reason: String,
    /// Seconds between the break and the resumption, where a session was resumed.
    pub resume_gap_s: Option<f64>,
    /// Whether the participant says to have known the purpose; none on rows written before that was asked.
    pub known_task: Option<bool>,
    /// Seed of the session's randomness.
    pub seed: u64,
    /// SHA-256 of the allocation plan, 64 hexadecimal digits.
    pub plan_hash: String,
    /// SHA-256 of the stimuli manifest, 64 hexadecimal digits.
    pub stimuli_hash: String,
    /// Version of the program that wrote the row.
    pub version: String,
    /// Start of the session, `YYYY-MM-DDTHH:MM:SSZ`.
    pub started_utc: String,
    /// True where the study is a demonstration, whose data never join a main study's. An addition after the columns
    /// that every log has: absent in a log, it reads as false.
    pub demo: bool,
}

impl Trial {
    /// The interval that held the lower quality, where an answer is right: it follows from answer and correctness.
    #[must_use]
    pub fn lower_quality(&self) -> Option<Interval> {
        match (self.worse_answer?, self.correct?) {
            (answer, true) => Some(answer),
            (answer, false) => Some(answer.other()),
        }
    }

    /// The layout said to have had the worse rendering quality.
    #[must_use]
    pub fn layout_chosen(&self) -> Option<&str> {
        Some(match self.worse_answer? {
            Interval::First => &self.first_layout,
            Interval::Second => &self.second_layout,
        })
    }
}

impl Interval {
    /// The other interval.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}
