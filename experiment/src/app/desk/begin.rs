//! The experimenter's set-up, and the session's beginning.

use super::{Desk, FRAME_S, Phase};
use crate::app::keys::Stroke;
use crate::app::pixels::window_px;
use crate::app::screens::{self, SetUp};
use crate::clock::Utc;
use crate::conduct::Conductor;
use crate::input::Key;
use crate::setup::{Conditions, Form};
use crate::timing::{Pace, Pacer};

impl Desk<'_> {
    pub(super) fn set_up(&mut self, ui: &mut egui::Ui, strokes: &[Stroke]) {
        self.wait_for_frame();
        if let Some(bot) = self.bots.front() {
            let form = Form { code: bot.participant.clone(), ..Form::default() };
            self.begin(ui.ctx(), Box::new(form), Some(Form::nothing_stated()));
            if let Phase::SetUp { problem, .. } = &self.phase {
                self.phase = Phase::Refused(problem.clone());
            }
            return;
        }
        // Enter begins; left to egui it would also press whatever has the focus.
        ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Enter));
        let [width, height] = window_px(ui.ctx());
        let pixels = match self.display.pixels {
            Some(check) => format!("{} pictures read back from the screen: equal to their files. ", check.pictures),
            None => String::new(),
        };
        let facts = format!(
            "Window {width} x {height} pixels, scale {}. {} {pixels}Data go to {}.",
            ui.ctx().pixels_per_point(),
            self.display.refresh_in_words(),
            self.data.map(|data| data.path().display().to_string()).unwrap_or_default()
        );
        let Phase::SetUp { form, problem } = &mut self.phase else { return };
        let mut act = screens::set_up(ui, self.study, form, &facts, problem);
        screens::demo_notice(ui, self.study);
        if strokes.contains(&Stroke::Down(Key::Enter)) {
            act = SetUp::Begin;
        }
        if act == SetUp::Begin {
            let form = form.clone();
            self.begin(ui.ctx(), form, None);
        }
    }

    /// Begins the session, with what the form says or with `stated`.
    fn begin(&mut self, context: &egui::Context, form: Box<Form>, stated: Option<Conditions>) {
        let facts = self.display.facts();
        let conditions = stated.map_or_else(|| form.finish(self.study), Ok);
        let begun = conditions.and_then(|conditions| {
            let data = self.data.ok_or("there is no data folder")?;
            data.check_room().map_err(|error| error.to_string())?;
            let again = self.resume && (self.bots.is_empty() || data.session_folder(&form.code).is_dir());
            let start = if again { Conductor::resume } else { Conductor::begin };
            let mut begun = start(self.study, data, &form.code, facts).map_err(|error| error.to_string())?;
            begun.conductor.state(conditions).map_err(|error| error.to_string())?;
            self.time.start_at(begun.since_start_s);
            let zero = Utc::now().before_s(self.time.now_s());
            begun.conductor.found(self.display.clone(), zero).map_err(|error| error.to_string())?;
            Ok(begun)
        });
        match begun {
            Ok(begun) => {
                self.restart_pace();
                context.memory_mut(|memory| memory.stop_text_input());
                self.phase = Phase::Session(Box::new(begun.conductor));
            }
            Err(problem) => self.phase = Phase::SetUp { form, problem },
        }
    }

    /// The pace of a session or of a test: the display's where that was verified, else the clock's.
    pub(super) fn restart_pace(&mut self) {
        let verified_hz = self.display.facts().refresh_hz.filter(|_| self.time.speed() == 1.0);
        self.pacer = Pacer::new(verified_hz.map_or(Pace::Clock(FRAME_S), |hz| Pace::Display(1.0 / hz)));
        self.begun_s = None; // it was a moment of the time before
    }
}
