//! A whole session as a state machine: every event goes through [`Session::step`], and nothing else changes it.
//!
//! What must be on disk is handed out as [`Effect::Save`], and the session stands still until the driver answers that it
//! is ([`Input::Saved`]): so no later screen can be seen before. The window and the rehearsal drive this same machine.

use analysis::trial_log::{Interval, Phase};
use stimuli::Stimulus;
use stimuli::study::Timing;

use crate::input::{Interruption, Key};
use crate::trial::{Moment, Observed, Trial, TrialPlan};

mod resume;

pub use resume::Done;

/// A screen of text that waits for the space bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The role and the task.
    Instructions,
    /// Before practice.
    Practice,
    /// Before the critical trial.
    Ready,
    /// Before the obvious pair.
    Check,
}

/// One step of a session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Asks for consent.
    Consent,
    /// Shows a text.
    Page(Page),
    /// Two pictures and the questions about them.
    Trial(TrialPlan),
    /// Asks what was noticed, in free text.
    Noticed,
    /// Asks whether the purpose was known.
    KnownTask,
}

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All steps were gone through.
    Completed,
    /// The participant did not agree.
    Declined,
    /// The experimenter ended it.
    Aborted,
}

/// What must be on disk before the session goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// Whether the participant agreed.
    Consent(bool),
    /// A pair is about to be shown: if nothing follows, it was seen and not answered.
    PairStarts {
        /// The trial's number.
        trial: u32,
        /// Its phase.
        phase: Phase,
    },
    /// A trial is over, or will not be finished.
    Trial {
        /// What was planned.
        plan: Box<TrialPlan>,
        /// What was measured and answered.
        observed: Box<Observed>,
        /// From the break to the resumption, where the trial was lost in one, seconds.
        resume_gap_s: Option<f64>,
    },
    /// What was noticed.
    Noticed(String),
    /// Whether the purpose was known.
    KnownTask(bool),
    /// The session is over.
    Ended(Outcome),
}

/// What happens to a session. Times are seconds from its start.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A key went down. Repeats of a held key are not keys.
    Key {
        /// Which.
        key: Key,
        /// When.
        now_s: f64,
    },
    /// A key went up.
    Released(Key),
    /// A text was entered.
    Text(String),
    /// The frame drawn last was handed over.
    Swapped {
        /// When the swap returned.
        at_s: f64,
        /// The period that frames should have.
        frame_s: f64,
    },
    /// A frame is about to be drawn, of what the session then shows.
    Frame {
        /// When it will be seen.
        shows_s: f64,
        /// The period of frames.
        frame_s: f64,
    },
    /// Something may have spoilt what is going on.
    Interrupted(Interruption),
    /// What was handed out for saving is on disk.
    Saved,
    /// It is not, and why.
    NotSaved(String),
}

/// What the driver must do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Nothing.
    None,
    /// Bring this to the disk and answer with [`Input::Saved`] or [`Input::NotSaved`].
    Save(Record),
    /// Close the session.
    Finished(Outcome),
}

/// What is to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Screen<'a> {
    /// The consent text.
    Consent,
    /// A text.
    Page(Page),
    /// The fixation mark.
    Fixation,
    /// A picture.
    Picture(&'a Stimulus),
    /// Even grey.
    Gap,
    /// The question after the number of items, and what was typed.
    Count(Interval, &'a str),
    /// Which was worse.
    Worse,
    /// How sure.
    Confidence,
    /// What was noticed.
    Noticed,
    /// Whether the purpose was known.
    KnownTask,
    /// The data cannot be saved, and why.
    Trouble(&'a str),
    /// The last screen.
    End(Outcome),
}

/// Where the machine stands within a step.
#[derive(Clone, Debug)]
enum Stage {
    /// A screen of its own, seen since then.
    Still(Option<f64>),
    /// A trial.
    Trial(Box<Trial>),
    /// The last screen, seen since then.
    End(Outcome, Option<f64>),
}

/// What follows once a record is on disk.
#[derive(Clone, Debug)]
enum Then {
    /// The step of this index.
    Go(usize),
    /// The trial whose start was recorded.
    Show(Box<Trial>),
    /// Its end must be recorded next.
    Close(Outcome),
    /// The last screen.
    End(Outcome),
}

/// A session.
#[derive(Clone, Debug)]
pub struct Session {
    steps: Vec<Step>,
    timing: Timing,
    at: usize,
    stage: Stage,
    /// Whether the present stage was drawn, where it is no trial: only then can a swap have shown it.
    drawn: bool,
    saving: Option<(Record, Then)>,
    trouble: Option<String>,
    known_task: Option<bool>,
    escape_since_s: Option<f64>,
    abort_asked_s: Option<f64>,
}

impl Session {
    /// How long Escape must be held for the first step of an abort, seconds.
    pub const HOLD_S: f64 = 2.0;
    /// How long the second step of an abort is waited for, seconds.
    pub const ASK_S: f64 = 10.0;

    /// A session that has not begun, and what must be done first.
    #[must_use]
    pub fn begin(steps: Vec<Step>, timing: Timing) -> (Self, Effect) {
        let mut session = Self::at_rest(steps, timing);
        let effect = session.go(0);
        (session, effect)
    }

    fn at_rest(steps: Vec<Step>, timing: Timing) -> Self {
        Self {
            steps,
            timing,
            at: 0,
            stage: Stage::Still(None),
            drawn: false,
            saving: None,
            trouble: None,
            known_task: None,
            escape_since_s: None,
            abort_asked_s: None,
        }
    }

    /// What is to be seen.
    #[must_use]
    pub fn screen(&self) -> Screen<'_> {
        if let Some(why) = &self.trouble {
            return Screen::Trouble(why);
        }
        match &self.stage {
            Stage::Trial(trial) => match trial.moment() {
                Moment::Fixation => Screen::Fixation,
                Moment::Picture(interval) => Screen::Picture(&trial.plan().shown(interval).stimulus),
                Moment::Gap | Moment::Done => Screen::Gap,
                Moment::Count(interval) => Screen::Count(interval, trial.typed()),
                Moment::Worse => Screen::Worse,
                Moment::Confidence => Screen::Confidence,
            },
            Stage::End(outcome, _) => Screen::End(*outcome),
            Stage::Still(_) => match self.steps.get(self.at) {
                Some(Step::Consent) => Screen::Consent,
                Some(Step::Page(page)) => Screen::Page(*page),
                Some(Step::Noticed) => Screen::Noticed,
                Some(Step::KnownTask) => Screen::KnownTask,
                Some(Step::Trial(_)) | None => Screen::Gap,
            },
        }
    }

    /// When the next screen is due; `None` where a key decides.
    #[must_use]
    pub fn due_s(&self) -> Option<f64> {
        match (&self.stage, &self.saving) {
            (Stage::Trial(trial), None) => trial.due_s(),
            _ => None,
        }
    }

    /// The trial under way.
    #[must_use]
    pub fn trial(&self) -> Option<&Trial> {
        match &self.stage {
            Stage::Trial(trial) => Some(trial),
            _ => None,
        }
    }

    /// Whether the present screen was seen: only then does a key answer it.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        match &self.stage {
            Stage::Trial(trial) => trial.is_shown(),
            Stage::Still(seen) | Stage::End(_, seen) => seen.is_some(),
        }
    }

    /// Whether the participant said to have known the purpose; `None` until that was asked.
    #[must_use]
    pub fn known_task(&self) -> Option<bool> {
        self.known_task
    }

    /// Whether the experimenter is being asked to confirm an abort.
    #[must_use]
    pub fn abort_asked(&self) -> bool {
        self.abort_asked_s.is_some()
    }

    /// The one door: what happened, and what must be done about it.
    pub fn step(&mut self, input: Input) -> Effect {
        match input {
            Input::Saved => self.saved(),
            Input::NotSaved(why) => {
                self.trouble = Some(why);
                Effect::None
            }
            Input::Interrupted(what) => {
                self.interrupt(what);
                Effect::None
            }
            Input::Released(Key::Escape) => {
                self.escape_since_s = None;
                Effect::None
            }
            Input::Released(_) => Effect::None,
            Input::Key { key, now_s } => self.key(key, now_s),
            Input::Text(text) => self.text(text),
            Input::Swapped { at_s, frame_s } => self.swapped(at_s, frame_s),
            Input::Frame { shows_s, frame_s } => {
                self.watch_escape(shows_s);
                match (&mut self.stage, &self.saving) {
                    (Stage::Trial(trial), None) => trial.frame(shows_s, frame_s),
                    _ => self.drawn = true,
                }
                Effect::None
            }
        }
    }

    fn interrupt(&mut self, what: Interruption) {
        if what == Interruption::FocusLost {
            self.escape_since_s = None; // the key's release goes to another window
        }
        if let Stage::Trial(trial) = &mut self.stage {
            trial.interrupt(what);
        }
    }

    fn swapped(&mut self, at_s: f64, frame_s: f64) -> Effect {
        match &mut self.stage {
            Stage::Still(seen) | Stage::End(_, seen) if self.drawn => {
                seen.get_or_insert(at_s);
            }
            Stage::Still(_) | Stage::End(..) => {}
            Stage::Trial(trial) => trial.swapped(at_s, frame_s),
        }
        self.finish_trial()
    }

    /// Hands out a trial's row once all is answered and its last picture has been followed to its end.
    fn finish_trial(&mut self) -> Effect {
        let Stage::Trial(trial) = &self.stage else { return Effect::None };
        if self.saving.is_some() || !trial.is_over() {
            return Effect::None;
        }
        let record = Record::Trial {
            plan: Box::new(trial.plan().clone()),
            observed: Box::new(trial.observed().clone()),
            resume_gap_s: None,
        };
        self.save(record, Then::Go(self.at + 1))
    }

    fn key(&mut self, key: Key, now_s: f64) -> Effect {
        if key == Key::Escape {
            self.escape_since_s.get_or_insert(now_s);
            self.interrupt(Interruption::Escape);
            return Effect::None;
        }
        if self.abort_asked_s.take().is_some() {
            return if key == Key::F10 { self.abort() } else { Effect::None };
        }
        if self.trouble.is_some() {
            return if key == Key::Enter { self.retry() } else { Effect::None };
        }
        if self.saving.is_some() {
            return Effect::None;
        }
        let next = self.at + 1;
        match &mut self.stage {
            Stage::Trial(trial) => {
                trial.key(key, now_s);
                self.finish_trial()
            }
            Stage::End(outcome, Some(_)) if matches!(key, Key::Enter | Key::Space) => Effect::Finished(*outcome),
            Stage::Still(Some(_)) => match (self.steps.get(self.at), key) {
                (Some(Step::Page(_)), Key::Space) => self.go(next),
                (Some(Step::Consent), Key::Digit(1)) => self.save(Record::Consent(true), Then::Go(next)),
                (Some(Step::Consent), Key::Digit(2)) => {
                    self.save(Record::Consent(false), Then::Close(Outcome::Declined))
                }
                (Some(Step::KnownTask), Key::Digit(answer @ (1 | 2))) => {
                    let known = answer == 1;
                    self.known_task = Some(known);
                    self.save(Record::KnownTask(known), Then::Go(next))
                }
                _ => Effect::None,
            },
            Stage::Still(None) | Stage::End(..) => Effect::None,
        }
    }

    fn text(&mut self, text: String) -> Effect {
        let asked = matches!((self.steps.get(self.at), &self.stage), (Some(Step::Noticed), Stage::Still(Some(_))));
        if !asked || self.saving.is_some() {
            return Effect::None;
        }
        self.save(Record::Noticed(text), Then::Go(self.at + 1))
    }

    fn go(&mut self, at: usize) -> Effect {
        self.at = at;
        (self.stage, self.drawn) = (Stage::Still(None), false);
        match self.steps.get(at) {
            Some(Step::Trial(plan)) => {
                let record = Record::PairStarts { trial: plan.number, phase: plan.phase };
                let trial = Trial::new(plan.clone(), self.timing.clone());
                self.save(record, Then::Show(Box::new(trial)))
            }
            Some(_) => Effect::None,
            None => self.save(Record::Ended(Outcome::Completed), Then::End(Outcome::Completed)),
        }
    }

    fn save(&mut self, record: Record, then: Then) -> Effect {
        self.saving = Some((record.clone(), then));
        Effect::Save(record)
    }

    fn saved(&mut self) -> Effect {
        self.trouble = None;
        let Some((_, then)) = self.saving.take() else { return Effect::None };
        match then {
            Then::Go(at) => self.go(at),
            Then::Show(trial) => {
                self.stage = Stage::Trial(trial);
                Effect::None
            }
            Then::Close(outcome) => self.save(Record::Ended(outcome), Then::End(outcome)),
            Then::End(outcome) => {
                (self.stage, self.drawn) = (Stage::End(outcome, None), false);
                Effect::None
            }
        }
    }

    fn retry(&mut self) -> Effect {
        self.trouble = None;
        match &self.saving {
            Some((record, _)) => Effect::Save(record.clone()),
            None => Effect::None,
        }
    }

    /// Escape held long enough asks for the second step; unanswered, the question goes away.
    fn watch_escape(&mut self, now_s: f64) {
        if self.escape_since_s.is_some_and(|since| now_s - since >= Self::HOLD_S) {
            self.abort_asked_s.get_or_insert(now_s);
            self.escape_since_s = None;
        }
        if self.abort_asked_s.is_some_and(|since| now_s - since >= Self::ASK_S) {
            self.abort_asked_s = None;
        }
    }

    fn abort(&mut self) -> Effect {
        if matches!(self.stage, Stage::End(..)) || self.saving.is_some() {
            return Effect::None;
        }
        match std::mem::replace(&mut self.stage, Stage::Still(None)) {
            Stage::Trial(trial) => {
                let (plan, observed) = trial.break_off(Interruption::Aborted);
                let record = Record::Trial { plan: Box::new(plan), observed: Box::new(observed), resume_gap_s: None };
                self.save(record, Then::Close(Outcome::Aborted))
            }
            _ => self.save(Record::Ended(Outcome::Aborted), Then::End(Outcome::Aborted)),
        }
    }
}

#[cfg(test)]
mod tests;
