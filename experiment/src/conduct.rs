//! One participant's session with its log: what the machine hands out is saved, the slot is given back if need be.
//!
//! The window and the rehearsal both conduct a session through here; they differ in where events come from.

use analysis::exclude::{Conduct, Times, judge};
use analysis::plan::Plan;
use analysis::trial_log::{Phase, Trial as Row};
use stimuli::Study;

use crate::clock::Utc;
use crate::display::Display;
use crate::display::DisplayFacts;
use crate::enrol::{Claimed, DataFolder, analysis_plan_hash};
use crate::error::{Error, Result};
use crate::log::SessionLog;
use crate::script;
use crate::session::{Effect, Input, Outcome, Record, Session};
use crate::setup::Conditions;
use crate::withdraw::STONE;

/// A session under way, with everything it writes to.
#[derive(Debug)]
pub struct Conductor<'a> {
    study: &'a Study,
    data: &'a DataFolder,
    claimed: Claimed,
    session: Session,
    log: SessionLog,
    display: DisplayFacts,
    critical: Option<Row>,
    last_row: Option<u32>,
    finished: Option<Outcome>,
}

/// How a session came to be conducted.
#[derive(Debug)]
pub struct Begun<'a> {
    /// The session, its first record saved.
    pub conductor: Conductor<'a>,
    /// From its start to now, seconds: more than 0 if it was taken up again.
    pub since_start_s: f64,
    /// What a broken session left to be said to the experimenter; empty for a new one.
    pub notes: Vec<String>,
}

impl<'a> Conductor<'a> {
    /// Enrols a participant and begins the session.
    ///
    /// # Errors
    /// As [`DataFolder::enrol`] and [`SessionLog::create`].
    pub fn begin(
        study: &'a Study,
        data: &'a DataFolder,
        participant: &str,
        display: DisplayFacts,
    ) -> Result<Begun<'a>> {
        let claimed = data.enrol(participant)?;
        Self::begin_in(study, data, participant, claimed, display)
    }

    fn begin_in(
        study: &'a Study,
        data: &'a DataFolder,
        participant: &str,
        claimed: Claimed,
        display: DisplayFacts,
    ) -> Result<Begun<'a>> {
        let started = Utc::now();
        let identity = data.identity(study, participant, &claimed, started);
        let folder = data.session_folder(participant);
        let log = SessionLog::create(&folder, identity, claimed.slot.number, analysis_plan_hash(study)?, started)?;
        let (session, first) = Session::begin(script::steps(study, &claimed.slot), study.timing.clone());
        let mut conductor =
            Self { study, data, claimed, session, log, display, critical: None, last_row: None, finished: None };
        conductor.carry_out(first);
        Ok(Begun { conductor, since_start_s: 0.0, notes: Vec::new() })
    }

    /// Takes up a session that broke off.
    ///
    /// # Errors
    /// If there is none under this code, its files are not what a session writes, or its slot was given to somebody else.
    pub fn resume(
        study: &'a Study,
        data: &'a DataFolder,
        participant: &str,
        display: DisplayFacts,
    ) -> Result<Begun<'a>> {
        let folder = data.session_folder(participant);
        if !folder.is_dir() {
            return Err(Error::Input(format!(
                "{}: participant {participant} has no session to go on with; leave --resume away to begin one",
                data.path().display()
            )));
        }
        if folder.join(STONE).exists() {
            return Err(Error::Input(format!("{participant} withdrew from the study; use another code")));
        }
        let claimed = match data.claimed_by(participant)? {
            Some(claimed) => claimed,
            None => data.claim(participant)?, // killed between taking the code and taking a slot
        };
        if !SessionLog::was_begun(&folder, participant) {
            // Killed before the journal's first line: nothing was shown. What is there is put aside.
            SessionLog::put_aside(&folder, participant, Utc::now())?;
            return Self::begin_in(study, data, participant, claimed, display);
        }
        let recovered = SessionLog::recover(&folder, participant, Utc::now())?;
        if recovered.done.ended.is_none() && data.is_taken_over(&claimed) {
            return Err(Error::Input(format!(
                "the slot of {participant} was given back and taken by somebody else; use another code"
            )));
        }
        let steps = script::steps(study, &claimed.slot);
        let (session, first) = Session::resume(steps, study.timing.clone(), &recovered.done, recovered.gap_s);
        let critical = recovered.rows.into_iter().find(|row| row.phase == Phase::Critical);
        let mut notes = vec![format!("The session of {participant} goes on after {:.0} s.", recovered.gap_s)];
        notes.extend(recovered.torn.iter().map(|file| format!("Half a line was put aside: {}", file.display())));
        let log = recovered.log;
        let mut conductor =
            Self { study, data, claimed, session, log, display, critical, last_row: None, finished: None };
        conductor.carry_out(first);
        Ok(Begun { conductor, since_start_s: recovered.since_start_s, notes })
    }

    /// The session's machine, to be looked at.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The arm: it decides which texts are shown, and no screen names it.
    #[must_use]
    pub fn arm(&self) -> &str {
        &self.claimed.slot.arm
    }

    /// The study.
    #[must_use]
    pub fn study(&self) -> &'a Study {
        self.study
    }

    /// Notes what the experimenter stated about this sitting.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn state(&mut self, conditions: Conditions) -> Result<()> {
        self.log.state(conditions, Utc::now())
    }

    /// Notes what was found about the display. `zero` is the moment of the session's zero second.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn found(&mut self, display: Display, zero: Utc) -> Result<()> {
        self.log.found(display, zero, Utc::now())
    }

    /// The trial whose row was brought to the disk last in this sitting.
    #[must_use]
    pub fn last_row(&self) -> Option<u32> {
        self.last_row
    }

    /// How the session ended, once it was closed.
    #[must_use]
    pub fn finished(&self) -> Option<Outcome> {
        self.finished
    }

    /// Hands an event to the session and carries out what follows. What cannot be saved makes the session wait on
    /// [`crate::session::Screen::Trouble`].
    pub fn step(&mut self, input: Input) {
        let effect = self.session.step(input);
        self.carry_out(effect);
    }

    fn carry_out(&mut self, mut effect: Effect) {
        loop {
            effect = match effect {
                Effect::None => return,
                Effect::Finished(outcome) => {
                    self.finished = Some(outcome);
                    return;
                }
                Effect::Save(record) => match self.save(&record) {
                    Ok(()) => self.session.step(Input::Saved),
                    Err(error) => self.session.step(Input::NotSaved(error.to_string())),
                },
            };
        }
    }

    fn save(&mut self, record: &Record) -> Result<()> {
        if let Record::Ended(outcome) = record
            && let Some(why) = self.why_not_kept(*outcome)
        {
            self.data.give_back(&self.claimed, &why)?;
        }
        let row = self.log.save(record, &self.display, self.session.known_task(), Utc::now())?;
        if let Some(row) = row {
            self.last_row = Some(row.trial);
            if row.phase == Phase::Critical {
                self.critical = Some(row);
            }
        }
        Ok(())
    }

    /// Why the participant's slot goes back into the plan: the session broke off, or its critical trial will be left out.
    /// Nothing here looks at the answer. A demonstration runs on any display, so that is no reason there.
    fn why_not_kept(&self, outcome: Outcome) -> Option<String> {
        if outcome != Outcome::Completed {
            return Some(outcome.word().to_owned());
        }
        let Some(critical) = &self.critical else { return Some("no critical trial".to_owned()) };
        let plan = Plan::of(self.study)?;
        let mut conduct = Conduct::of(critical, self.session.known_task() == Some(true), false);
        conduct.verified |= self.study.demo;
        let times = Times { picture_s: plan.picture_s, gap_s: plan.gap_s };
        judge(&conduct, &plan.rules, Some(times)).map(|(reason, _)| reason.words().to_owned())
    }
}
