//! What is timed: the session, and the self-test, which shows grey for as long as pictures would be shown.

use analysis::trial_log::Phase as TrialPhase;
use stimuli::Stimulus;

use super::{Desk, Exit, Phase};
use crate::app::keys::Stroke;
use crate::app::screens;
use crate::enrol::DataFolder;
use crate::input::{Interruption, Key};
use crate::selftest::{PAIRS, SelfTest, TIMING};
use crate::session::{Input, Outcome, Screen};
use crate::setup::Form;
use crate::trial::{Asks, Shown, Trial, TrialPlan};

impl Desk<'_> {
    pub(super) fn session(&mut self, ui: &mut egui::Ui, strokes: &[Stroke], happened: &[Interruption]) {
        let Phase::Session(conductor) = &mut self.phase else { return };
        // A trial that was not seen yet was not disturbed by a slow disk before it.
        let seen = conductor.session().is_shown();
        for &what in happened.iter().filter(|&&what| seen || what != Interruption::Suspended) {
            conductor.step(Input::Interrupted(what));
        }
        // Keys first: what was pressed before this moment was pressed before the new screen was seen.
        for stroke in strokes {
            let session = conductor.session();
            let writes = session.screen() == Screen::Noticed && !session.abort_asked();
            match *stroke {
                Stroke::Down(Key::Enter) if writes => {
                    conductor.step(Input::Text(std::mem::take(&mut self.noticed)));
                }
                Stroke::Down(key) => conductor.step(Input::Key { key, now_s: self.pass_s }),
                Stroke::Up(key) => conductor.step(Input::Released(key)),
            }
        }
        if let Some(bot) = self.bots.front_mut() {
            bot.act(conductor, self.pass_s);
        }
        conductor.step(Input::Swapped { at_s: self.pass_s, frame_s: self.frame_s });
        if let Some(bot) = self.bots.front_mut() {
            bot.look(conductor, self.pass_s);
        }
        let due_s = conductor.session().due_s();
        let shows_s = self.next_frame(due_s);
        let frame_s = self.frame_s;
        let Phase::Session(conductor) = &mut self.phase else { return };
        conductor.step(Input::Frame { shows_s, frame_s });
        if let Some(outcome) = conductor.finished() {
            return self.finished(outcome);
        }
        let Phase::Session(conductor) = &self.phase else { return };
        let session = conductor.session();
        let screen = session.screen();
        let timed = matches!(screen, Screen::Fixation | Screen::Picture(_) | Screen::Gap);
        if timed {
            ui.ctx().set_cursor_icon(egui::CursorIcon::None);
        }
        match &screen {
            Screen::Picture(stimulus) => {
                if let Some(picture) = self.pictures.get(&stimulus.id()) {
                    picture.draw(ui);
                }
                screens::name(ui, "Picture");
            }
            Screen::Fixation | Screen::Gap => {
                if let Some(even) = &self.even {
                    even.draw(ui);
                }
                if screen == Screen::Fixation {
                    screens::fixation(ui);
                    screens::name(ui, "Fixation mark");
                } else {
                    screens::name(ui, "Even grey");
                }
            }
            _ => screens::text(ui, self.study, conductor.arm(), &screen, &mut self.noticed),
        }
        if session.abort_asked() {
            screens::abort_notice(ui);
        } else if !timed {
            screens::demo_notice(ui, self.study);
        }
    }

    /// The session is over: the next program sits down, or the window closes.
    fn finished(&mut self, outcome: Outcome) {
        self.bots.pop_front();
        if self.bots.is_empty() {
            self.exit = Some(Exit::Ended(outcome));
        } else {
            self.phase = Phase::SetUp { form: Box::new(Form::default()), problem: String::new() };
        }
    }

    pub(super) fn begin_test(&mut self, _context: &egui::Context) {
        self.time.start_at(0.0);
        self.restart_pace();
        self.phase = Phase::Testing { trial: Box::new(grey_pair()), left: PAIRS, seen: Vec::new() };
    }

    /// Pairs of grey, timed as pictures are.
    pub(super) fn test(&mut self, ui: &mut egui::Ui) {
        let Phase::Testing { trial, left, seen } = &mut self.phase else { return };
        trial.swapped(self.pass_s, self.frame_s);
        if trial.is_over() {
            let observed = trial.observed();
            seen.extend([observed.first, observed.second].into_iter().flatten());
            **trial = grey_pair();
            *left -= 1;
        }
        if *left == 0 {
            let disk_ms = self.data.map(DataFolder::time_disk_ms).transpose().ok().flatten();
            let test = SelfTest::judge(self.display.clone(), seen, disk_ms);
            self.exit = Some(Exit::Tested(Box::new(test)));
            return;
        }
        let due_s = trial.due_s();
        let shows_s = self.next_frame(due_s);
        let Phase::Testing { trial, .. } = &mut self.phase else { return };
        trial.frame(shows_s, self.frame_s);
        if let Some(even) = &self.even {
            even.draw(ui);
        }
        screens::line_in_the_middle(ui, "Self-test");
    }
}

/// A pair that asks nothing.
fn grey_pair() -> Trial {
    let stimulus = Stimulus { layout: String::new(), quality: String::new() };
    let shown = Shown { stimulus, count: None, rank: 0 };
    let plan = TrialPlan {
        number: 1,
        phase: TrialPhase::Practice,
        first: shown.clone(),
        second: shown,
        asks: Asks::default(),
    };
    Trial::new(plan, TIMING)
}
