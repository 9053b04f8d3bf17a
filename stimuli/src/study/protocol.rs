//! What a participant meets: display, times, texts, the task, the arms.

use serde::{Deserialize, Serialize};

use super::Stimulus;
use crate::hash::Sha256;

/// The picture on the display, and the eye before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DisplayGeometry {
    /// Picture width in physical pixels.
    pub width_px: u32,
    /// Picture height in physical pixels.
    pub height_px: u32,
    /// The picture's width on the display, metres.
    pub width_m: f64,
    /// From the eye to the display, metres.
    pub distance_m: f64,
}

impl DisplayGeometry {
    /// Pixels in the degree about the line of sight, 2 d tan(1/2 degree) long. A 17-inch display of 1280 x 1024 at 60 cm
    /// has 39.75.
    #[must_use]
    pub fn pixels_per_degree(&self) -> f64 {
        2.0 * self.distance_m * 0.5_f64.to_radians().tan() * f64::from(self.width_px) / self.width_m
    }

    /// The distance in metres at which a picture of `width_m` metres shows this study's pixels per degree.
    #[must_use]
    pub fn distance_for_width_m(&self, width_m: f64) -> f64 {
        self.distance_m * width_m / self.width_m
    }
}

/// How long things are on the screen, in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// The fixation mark before the first picture.
    pub fixation_s: f64,
    /// Each of the two pictures.
    pub interval_s: f64,
    /// The even grey between the two pictures.
    pub gap_s: f64,
}

/// What the participant agrees to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Consent {
    /// The version, to be changed with the text.
    pub version: String,
    /// The text that is agreed to. It must not mention quality or rendering.
    pub text: String,
}

impl Consent {
    /// The digest of version and text.
    #[must_use]
    pub fn hash(&self) -> Sha256 {
        Sha256::of(format!("{}\n{}", self.version, self.text).as_bytes())
    }
}

/// Every text that is shown. Until the critical answer none may mention quality or rendering.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wording {
    /// BCP 47 tag of the language of the texts.
    pub language: String,
    /// The role and the task.
    pub instructions: String,
    /// Before the practice trials.
    pub practice: String,
    /// Between practice and the critical trial.
    pub ready: String,
    /// Asks for the number of items in the first picture.
    pub count_first: String,
    /// Asks for the number of items in the second picture.
    pub count_second: String,
    /// The critical question: which of the two had the worse rendering quality.
    pub worse: String,
    /// Asks how sure the answer is; no such question if absent.
    #[serde(default)]
    pub confidence: Option<String>,
    /// After the critical answer: what was noticed, in free text.
    pub noticed: String,
    /// Asks whether the purpose was known beforehand: `known_task`.
    pub known_task: String,
    /// Before the obvious pair.
    pub check: String,
    /// The last screen.
    pub end: String,
    /// Shown on every screen of a demonstration.
    pub demo_notice: String,
    /// The texts of arms without a task; none where every arm counts.
    #[serde(default)]
    pub free: Option<FreeWording>,
    /// Which key does what.
    #[serde(default)]
    pub hints: Hints,
}

impl Wording {
    /// Instructions, the text before practice, and the text before the critical trial, for an arm.
    #[must_use]
    pub fn before_trials(&self, viewing: Viewing) -> [&str; 3] {
        match (viewing, &self.free) {
            (Viewing::Free, Some(free)) => [&free.instructions, &free.practice, &free.ready],
            _ => [&self.instructions, &self.practice, &self.ready],
        }
    }

    /// Every text.
    pub fn all(&self) -> impl Iterator<Item = &str> {
        let own = [
            &self.instructions,
            &self.practice,
            &self.ready,
            &self.count_first,
            &self.count_second,
            &self.worse,
            &self.noticed,
            &self.known_task,
            &self.check,
            &self.end,
            &self.demo_notice,
        ];
        let free = self.free.iter().flat_map(|free| [&free.instructions, &free.practice, &free.ready]);
        own.into_iter().chain(self.confidence.iter()).chain(free).chain(self.hints.all()).map(String::as_str)
    }
}

/// What the participants of an arm read who have nothing to count. As little as the others may they learn that quality
/// is what the study is about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeWording {
    /// What they do.
    pub instructions: String,
    /// Before the practice trials.
    pub practice: String,
    /// Between practice and the critical trial.
    pub ready: String,
}

/// The short lines under a screen that say which key does what. The keys are fixed, these words are not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Hints {
    /// Under a text: the space bar.
    pub go_on: String,
    /// Under consent: key 1.
    pub agree: String,
    /// Under consent: key 2.
    pub decline: String,
    /// Under a count: digits, then Enter.
    pub count: String,
    /// Under the critical question: key 1.
    pub first: String,
    /// Under the critical question: key 2.
    pub second: String,
    /// Under the question how sure: keys 1 to 4.
    pub confidence: String,
    /// Under what was noticed: Enter.
    pub noticed: String,
    /// Under the question after the purpose: key 1.
    pub yes: String,
    /// Under the question after the purpose: key 2.
    pub no: String,
}

impl Default for Hints {
    fn default() -> Self {
        let texts = [
            "Press the space bar to go on.",
            "Press 1 if you agree.",
            "Press 2 if you do not agree.",
            "Type the number, then press Enter.",
            "Press 1 for the first picture.",
            "Press 2 for the second picture.",
            "Press a key from 1 to 4.",
            "Type, then press Enter.",
            "Press 1 for yes.",
            "Press 2 for no.",
        ];
        let [go_on, agree, decline, count, first, second, confidence, noticed, yes, no] = texts.map(str::to_owned);
        Self { go_on, agree, decline, count, first, second, confidence, noticed, yes, no }
    }
}

impl Hints {
    fn all(&self) -> [&String; 10] {
        let Self { go_on, agree, decline, count, first, second, confidence, noticed, yes, no } = self;
        [go_on, agree, decline, count, first, second, confidence, noticed, yes, no]
    }
}

/// What is counted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// The kinds of items that count.
    pub kinds: Vec<Kind>,
    /// Names of objects that look like items and are not: for the map of what differs, never counted.
    #[serde(default)]
    pub distractors: Vec<String>,
}

/// A kind of item.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// Short name, the key of the layouts' true counts: letters, digits, `-` and `_`.
    pub id: String,
    /// For people, singular.
    pub label: String,
    /// The start of the names of its surfaces in the scenes; the next part of a name, up to a dot, numbers the item.
    pub objects: String,
}

/// A group of participants, and what differs between its two pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Name in log and report, as in HQ/CBQ.
    pub name: String,
    /// The names of the two qualities; which comes first is drawn for every participant.
    pub qualities: [String; 2],
    /// Participants; a multiple of 4 fills the cells evenly.
    pub n: u32,
    /// What they do while they look: they count, unless it is said here.
    #[serde(default)]
    pub viewing: Viewing,
}

/// What the participants of an arm do while they look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Viewing {
    /// They count items.
    #[default]
    Task,
    /// They look, and are asked nothing about items.
    Free,
}

impl Arm {
    /// Whether the two pictures differ in quality, so that one answer is right.
    #[must_use]
    pub fn has_right_answer(&self) -> bool {
        self.qualities[0] != self.qualities[1]
    }
}

/// A trial that rehearses counting; nothing is asked about quality.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Practice {
    /// Shown first.
    pub first: Stimulus,
    /// Shown second.
    pub second: Stimulus,
}

/// The obvious pair: one layout in two qualities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QualityCheck {
    /// The layout of both pictures.
    pub layout: String,
    /// The two qualities; which comes first is drawn.
    pub qualities: [String; 2],
}

impl QualityCheck {
    /// Its two pictures.
    #[must_use]
    pub fn stimuli(&self) -> [Stimulus; 2] {
        self.qualities.clone().map(|quality| Stimulus { layout: self.layout.clone(), quality })
    }
}
