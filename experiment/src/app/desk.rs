//! One sitting: pictures into the graphics memory, the experimenter's set-up, the session.

use std::collections::HashMap;

use analysis::trial_log::{OnsetSource, Vsync};
use egui::Ui;
use stimuli::Study;

use super::Launch;
use super::keys::{Stroke, strokes};
use super::pixels::{Uploaded, window_px};
use super::screens::{self, BACKGROUND, SetUp};
use super::watch::Watch;
use crate::clock::Time;
use crate::conduct::Conductor;
use crate::enrol::DataFolder;
use crate::input::{Interruption, Key};
use crate::log::DisplayFacts;
use crate::session::{Input, Outcome, Screen};
use crate::setup::Form;
use crate::stimulus::Picture;
use crate::timing::{Pace, Pacer};

/// Why the window closes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Exit {
    /// No session was begun.
    Unbegun,
    /// The session ended like this.
    Ended(Outcome),
    /// There can be no session here, and why.
    Refused(String),
}

/// What is going on.
#[derive(Debug)]
enum Phase<'a> {
    /// The window finds its size: how long it has had it, seconds' moment and passes.
    Settling { since_s: f64, passes: u32, size_px: [usize; 2] },
    /// Pictures are uploaded and drawn once, one a pass.
    Preparing { left: Vec<Picture> },
    /// The experimenter's screen.
    SetUp { form: Box<Form>, problem: String },
    /// The session.
    Session(Box<Conductor<'a>>),
    /// There can be none.
    Refused(String),
}

/// A sitting at one display.
#[derive(Debug)]
pub struct Desk<'a> {
    study: &'a Study,
    data: &'a DataFolder,
    participant: Option<String>,
    resume: bool,
    waiting: Vec<Picture>,
    phase: Phase<'a>,
    pictures: HashMap<String, Uploaded>,
    even: Option<Uploaded>,
    time: Time,
    pacer: Pacer,
    watch: Watch,
    /// When this pass began: the frame before was handed over by then.
    pass_s: f64,
    /// When the frame before was begun, after waiting; `None` if none was.
    begun_s: Option<f64>,
    frame_s: f64,
    noticed: String,
    exit: Option<Exit>,
}

/// How long the window must keep its size before anything is shown, seconds and passes.
const SETTLED: (f64, u32) = (0.6, 8);
/// The pace where no display sets one, seconds.
const FRAME_S: f64 = 1.0 / 60.0;

impl<'a> Desk<'a> {
    /// A desk whose window has just been opened.
    #[must_use]
    pub fn new(launch: Launch<'a>, time: Time) -> Self {
        Self {
            study: launch.study,
            data: launch.data,
            participant: launch.participant,
            resume: launch.resume,
            waiting: launch.pictures,
            phase: Phase::Settling { since_s: time.now_s(), passes: 0, size_px: [0, 0] },
            pictures: HashMap::new(),
            even: None,
            pass_s: time.now_s(),
            time,
            pacer: Pacer::new(Pace::Clock(FRAME_S)),
            watch: Watch::default(),
            begun_s: None,
            frame_s: FRAME_S,
            noticed: String::new(),
            exit: None,
        }
    }

    /// Why the window is to be closed; `None` while it is not.
    #[must_use]
    pub fn exit(&self) -> Option<Exit> {
        self.exit.clone()
    }

    /// A pass begins: stamps the moment.
    pub fn begin_pass(&mut self) {
        self.pass_s = self.time.now_s();
    }

    /// The rest of the pass: what happened, what is due, what is to be seen.
    pub fn show(&mut self, ui: &mut Ui) {
        if let Some(begun_s) = self.begun_s.take() {
            self.pacer.drawn(begun_s, self.pass_s);
        }
        let strokes = strokes(ui.ctx());
        let happened = self.watch.look(ui.ctx());
        if happened.contains(&Interruption::CloseRequested) {
            self.close_requested(ui.ctx());
        }
        match self.phase {
            Phase::Settling { .. } => self.settle(ui),
            Phase::Preparing { .. } => self.prepare(ui),
            Phase::SetUp { .. } => self.set_up(ui, &strokes),
            Phase::Session(_) => self.session(ui, &strokes, &happened),
            Phase::Refused(_) => self.refused(ui, &strokes),
        }
    }

    /// Alt-F4 and its like end nothing that has begun.
    fn close_requested(&mut self, context: &egui::Context) {
        match &self.phase {
            _ if self.exit.is_some() => {} // this program's own wish
            Phase::Session(_) => context.send_viewport_cmd(egui::ViewportCommand::CancelClose),
            Phase::Refused(why) => self.exit = Some(Exit::Refused(why.clone())),
            _ => self.exit = Some(Exit::Unbegun),
        }
    }

    fn settle(&mut self, ui: &mut Ui) {
        screens::message(ui, "One moment", "The window is being opened.");
        self.wait_for_frame(None);
        let now_px = window_px(ui.ctx());
        let Phase::Settling { since_s, passes, size_px } = &mut self.phase else { return };
        if *size_px != now_px {
            (*since_s, *passes, *size_px) = (self.pass_s, 0, now_px);
        }
        *passes += 1;
        if self.pass_s - *since_s < SETTLED.0 || *passes < SETTLED.1 {
            return;
        }
        self.phase = match self.cannot_show(ui.ctx()) {
            Some(why) => Phase::Refused(why),
            None => Phase::Preparing { left: std::mem::take(&mut self.waiting) },
        };
    }

    /// Why the study cannot be shown in this window.
    fn cannot_show(&self, context: &egui::Context) -> Option<String> {
        let display = &self.study.display;
        let wanted = [display.width_px, display.height_px].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        let window = window_px(context);
        if window[0] < wanted[0] || window[1] < wanted[1] {
            return Some(format!(
                "The pictures have {} x {} pixels and the window only {} x {}. They are shown pixel for pixel or not at \
                 all: use a larger display. (Without a window manager a window cannot fill the screen.)",
                wanted[0], wanted[1], window[0], window[1]
            ));
        }
        let most = context.input(|input| input.max_texture_side);
        if wanted.iter().any(|&side| side > most) {
            return Some(format!("This machine's graphics cannot hold a picture of more than {most} pixels a side."));
        }
        if !self.study.demo {
            return Some(
                "This study is not a demonstration, and this release does not verify that a display paces its frames: \
                 it conducts demonstrations only."
                    .to_owned(),
            );
        }
        None
    }

    /// One picture a pass: uploaded, and drawn under an even grey, so that its first showing is not its first drawing.
    fn prepare(&mut self, ui: &mut Ui) {
        let Phase::Preparing { left } = &mut self.phase else { return };
        let next = left.pop();
        let many = left.len();
        if let Some(picture) = &next {
            let uploaded = Uploaded::new(ui.ctx(), picture);
            uploaded.draw(ui);
            let size_px = [picture.width_px, picture.height_px].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
            let even = self.even.get_or_insert_with(|| Uploaded::even(ui.ctx(), size_px, BACKGROUND));
            even.draw(ui);
            self.pictures.insert(picture.stimulus.id(), uploaded);
        }
        screens::message(ui, "One moment", &format!("{many} pictures are being prepared."));
        self.wait_for_frame(None);
        if next.is_none() {
            let form = Form { code: self.participant.clone().unwrap_or_default(), ..Form::default() };
            self.phase = Phase::SetUp { form: Box::new(form), problem: String::new() };
        }
    }

    fn set_up(&mut self, ui: &mut Ui, strokes: &[Stroke]) {
        self.wait_for_frame(None);
        // Enter begins; left to egui it would also press whatever has the focus.
        ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Enter));
        let [width, height] = window_px(ui.ctx());
        let facts = format!(
            "Window {width} x {height} pixels, scale {}. Refresh not verified. Data go to {}.",
            ui.ctx().pixels_per_point(),
            self.data.path().display()
        );
        let Phase::SetUp { form, problem } = &mut self.phase else { return };
        let mut act = screens::set_up(ui, self.study, form, &facts, problem);
        screens::demo_notice(ui, self.study);
        if strokes.contains(&Stroke::Down(Key::Enter)) {
            act = SetUp::Begin;
        }
        if act == SetUp::Begin {
            let form = form.clone();
            self.begin(ui.ctx(), form);
        }
    }

    fn begin(&mut self, context: &egui::Context, form: Box<Form>) {
        let display =
            DisplayFacts { onset_source: OnsetSource::SwapReturn, refresh_hz: None, vsync: Vsync::Unverified };
        let begun = form.finish(self.study).and_then(|conditions| {
            let start = if self.resume { Conductor::resume } else { Conductor::begin };
            let mut begun = start(self.study, self.data, &form.code, display).map_err(|error| error.to_string())?;
            begun.conductor.state(conditions).map_err(|error| error.to_string())?;
            Ok(begun)
        });
        match begun {
            Ok(begun) => {
                self.time.start_at(begun.since_start_s);
                self.pacer = Pacer::new(Pace::Clock(FRAME_S));
                self.begun_s = None; // it was a moment of the time before
                context.memory_mut(|memory| memory.stop_text_input());
                self.phase = Phase::Session(Box::new(begun.conductor));
            }
            Err(problem) => self.phase = Phase::SetUp { form, problem },
        }
    }

    fn session(&mut self, ui: &mut Ui, strokes: &[Stroke], happened: &[Interruption]) {
        let Phase::Session(conductor) = &mut self.phase else { return };
        for &what in happened {
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
        conductor.step(Input::Swapped { at_s: self.pass_s, frame_s: self.frame_s });
        let due_s = conductor.session().due_s();
        let plan = self.pacer.plan(self.time.now_s(), due_s);
        let begun_s = self.time.until(plan.start_s);
        let late_s = (begun_s - plan.start_s).max(0.0);
        self.begun_s = Some(begun_s);
        self.frame_s = plan.frame_s;
        conductor.step(Input::Frame { shows_s: plan.shows_s + late_s, frame_s: plan.frame_s });
        if let Some(outcome) = conductor.finished() {
            self.exit = Some(Exit::Ended(outcome));
        }
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
            }
            Screen::Fixation | Screen::Gap => {
                if let Some(even) = &self.even {
                    even.draw(ui);
                }
                if screen == Screen::Fixation {
                    screens::fixation(ui);
                }
            }
            _ => screens::text(ui, self.study, &screen, &mut self.noticed),
        }
        if session.abort_asked() {
            screens::abort_notice(ui);
        } else if !timed {
            screens::demo_notice(ui, self.study);
        }
    }

    fn refused(&mut self, ui: &mut Ui, strokes: &[Stroke]) {
        self.wait_for_frame(None);
        let Phase::Refused(why) = &self.phase else { return };
        screens::message(ui, "No session here", &format!("{why}\n\nPress Enter to close."));
        if strokes.contains(&Stroke::Down(Key::Enter)) {
            self.exit = Some(Exit::Refused(why.clone()));
        }
    }

    /// Keeps the pace where nothing is timed.
    fn wait_for_frame(&mut self, due_s: Option<f64>) {
        let plan = self.pacer.plan(self.time.now_s(), due_s);
        self.begun_s = Some(self.time.until(plan.start_s));
        self.frame_s = plan.frame_s;
    }
}
