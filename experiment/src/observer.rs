//! Simulated observers: they sit before the same machine as a person and press the same keys.

use std::collections::BTreeMap;

use analysis::trial_log::Interval;

use crate::draw::Draws;
use crate::input::Key;
use crate::session::Screen;
use crate::trial::{Shown, Trial};

/// What an observer does at a screen.
#[derive(Clone, Debug, PartialEq)]
pub enum Act {
    /// Presses these keys, one after the other.
    Press(Vec<Key>),
    /// Enters a text.
    Write(String),
    /// Gets up and leaves: the experimenter ends the session.
    Leave,
}

/// What an observer does, and after how many seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// From the moment the screen is seen, seconds.
    pub after_s: f64,
    /// What.
    pub act: Act,
}

/// How a simulated observer finds the worse picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Eye {
    /// Sees no difference, and guesses.
    Guesser,
    /// Sees a difference of one rank with this probability and guesses otherwise; a larger difference is seen if any of
    /// its steps is.
    Threshold {
        /// Probability of seeing one step of rank.
        sees: f64,
    },
    /// Sees what a metric predicts: by picture, how many just objectionable differences (JOD) it is worse than the best of
    /// its layout. A picture that is missing is the best.
    Metric(BTreeMap<String, f64>),
}

/// Phi^-1(3/4): one JOD is told right three times in four (Perez-Ortiz & Mantiuk 2017).
const Z_THREE_QUARTERS: f64 = 0.674_489_750_196_081_7;

impl Eye {
    /// Reads a metric's predictions: a JSON object of pictures' names and JOD, 0 or more, as in `{"a_cbq": 0.8}`.
    ///
    /// # Errors
    /// What is wrong with it, with line and column.
    pub fn metric(text: &str) -> std::result::Result<Self, String> {
        let losses: BTreeMap<String, f64> =
            serde_json::from_str(text).map_err(|error| format!("{}:{}: {error}", error.line(), error.column()))?;
        match losses.iter().find(|(_, jod)| !(jod.is_finite() && **jod >= 0.0)) {
            Some((picture, jod)) => Err(format!("1:1: {picture} is {jod} JOD worse than the best; expected 0 or more")),
            None => Ok(Self::Metric(losses)),
        }
    }
}

/// A simulated observer.
#[derive(Debug)]
pub struct Observer {
    eye: Eye,
    leaves: f64,
    lapses: f64,
    draws: Draws,
}

impl Observer {
    /// An observer whose choices are a function of the seed and of the participant's code. Before each pair it leaves
    /// with probability `leaves`.
    #[must_use]
    pub fn new(eye: Eye, leaves: f64, seed: u64, participant: &str) -> Self {
        Self { eye, leaves, lapses: 0.0, draws: Draws::new(seed, &format!("observer {participant}")) }
    }

    /// The same observer, which answers any question without having looked, with probability `lapses`.
    #[must_use]
    pub fn lapsing(self, lapses: f64) -> Self {
        Self { lapses, ..self }
    }

    /// What it does at a screen that waits for it; `trial` is the trial under way.
    pub fn act(&mut self, screen: &Screen<'_>, trial: Option<&Trial>) -> Action {
        match screen {
            Screen::Consent => self.press(3.0, &[Key::Digit(1)]),
            Screen::Page(_) if self.draws.chance(self.leaves) => Action { after_s: 5.0, act: Act::Leave },
            Screen::Page(_) => self.press(8.0, &[Key::Space]),
            Screen::Count(interval, _) => self.count(*interval, trial),
            Screen::Worse => {
                let answer = self.worse(trial);
                self.press(1.2, &[Key::Digit(if answer == Interval::First { 1 } else { 2 })])
            }
            Screen::Confidence => {
                let sure = u8::try_from(1 + self.draws.below(4)).unwrap_or(1);
                self.press(1.0, &[Key::Digit(sure)])
            }
            Screen::Noticed => Action { after_s: 6.0, act: Act::Write("simulated".to_owned()) },
            Screen::KnownTask => self.press(1.5, &[Key::Digit(2)]),
            Screen::End(_) | Screen::Trouble(_) => self.press(1.0, &[Key::Enter]),
            Screen::Fixation | Screen::Gap | Screen::Picture(_) => self.press(1.0, &[]),
        }
    }

    /// Log-normal times, as people's are (Luce 1986, "Response Times"); the spread is a third of the median.
    fn press(&mut self, median_s: f64, keys: &[Key]) -> Action {
        let after_s = median_s * (0.33 * self.draws.normal()).exp();
        Action { after_s, act: Act::Press(keys.to_vec()) }
    }

    /// Overlooks one item in twelve; who lapses says any number up to 20.
    fn count(&mut self, interval: Interval, trial: Option<&Trial>) -> Action {
        let truth = trial.and_then(|trial| trial.plan().shown(interval).count).unwrap_or(0);
        let said = if self.lapses > 0.0 && self.draws.chance(self.lapses) {
            self.draws.below(21)
        } else {
            (0..truth).filter(|_| !self.draws.chance(1.0 / 12.0)).count() as u64
        };
        let mut keys: Vec<Key> = said.to_string().bytes().map(|digit| Key::Digit(digit - b'0')).collect();
        keys.push(Key::Enter);
        self.press(2.5, &keys)
    }

    fn worse(&mut self, trial: Option<&Trial>) -> Interval {
        let guess = if self.draws.chance(0.5) { Interval::First } else { Interval::Second };
        if self.lapses > 0.0 && self.draws.chance(self.lapses) {
            return guess;
        }
        let Some(plan) = trial.map(Trial::plan) else { return guess };
        match &self.eye {
            Eye::Guesser => guess,
            Eye::Threshold { sees } => {
                let steps = plan.first.rank.abs_diff(plan.second.rank);
                let seen = (0..steps).any(|_| self.draws.chance(*sees));
                plan.worse().filter(|_| seen).unwrap_or(guess)
            }
            // Thurstone's case V: the difference on the scale, and normal noise of the scale's unit.
            Eye::Metric(losses) => {
                let jod = |shown: &Shown| losses.get(&shown.stimulus.id()).copied().unwrap_or(0.0);
                let apart = Z_THREE_QUARTERS * (jod(&plan.second) - jod(&plan.first));
                if apart + self.draws.normal() < 0.0 { Interval::First } else { Interval::Second }
            }
        }
    }
}
