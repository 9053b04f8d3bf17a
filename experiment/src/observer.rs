//! Simulated observers: they sit before the same machine as a person and press the same keys.

use analysis::trial_log::Interval;

use crate::draw::Draws;
use crate::input::Key;
use crate::session::Screen;
use crate::trial::Trial;

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// Sees no difference, and guesses.
    Guesser,
    /// Sees a difference of one rank with this probability and guesses otherwise; a larger difference is seen if any of
    /// its steps is.
    Threshold {
        /// Probability of seeing one step of rank.
        sees: f64,
    },
}

/// A simulated observer.
#[derive(Debug)]
pub struct Observer {
    eye: Eye,
    leaves: f64,
    draws: Draws,
}

impl Observer {
    /// An observer whose choices are a function of the seed and of the participant's code. Before each pair it leaves
    /// with probability `leaves`.
    #[must_use]
    pub fn new(eye: Eye, leaves: f64, seed: u64, participant: &str) -> Self {
        Self { eye, leaves, draws: Draws::new(seed, &format!("observer {participant}")) }
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

    /// Overlooks one item in twelve.
    fn count(&mut self, interval: Interval, trial: Option<&Trial>) -> Action {
        let truth = trial.and_then(|trial| trial.plan().shown(interval).count).unwrap_or(0);
        let seen = (0..truth).filter(|_| !self.draws.chance(1.0 / 12.0)).count();
        let digits = seen.to_string();
        let mut keys: Vec<Key> = digits.bytes().map(|digit| Key::Digit(digit - b'0')).collect();
        keys.push(Key::Enter);
        self.press(2.5, &keys)
    }

    fn worse(&mut self, trial: Option<&Trial>) -> Interval {
        let guess = if self.draws.chance(0.5) { Interval::First } else { Interval::Second };
        let (Eye::Threshold { sees }, Some(plan)) = (self.eye, trial.map(Trial::plan)) else { return guess };
        let steps = plan.first.rank.abs_diff(plan.second.rank);
        let seen = (0..steps).any(|_| self.draws.chance(sees));
        plan.worse().filter(|_| seen).unwrap_or(guess)
    }
}
