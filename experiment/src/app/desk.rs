//! One sitting: the display is measured, pictures go into the graphics memory, the experimenter's set-up, the session.

mod begin;
mod run;

use std::collections::{HashMap, VecDeque};

use egui::Ui;
use stimuli::Study;

use super::keys::{Stroke, strokes};
use super::pixels::{Uploaded, window_px};
use super::prepare::{Reading, does_not_fit, undrawable};
use super::screens::{self, BACKGROUND};
use super::watch::Watch;
use super::{Errand, Launch};
use crate::bot::Bot;
use crate::clock::{Time, Utc};
use crate::conduct::Conductor;
use crate::display::{Display, PixelCheck};
use crate::enrol::DataFolder;
use crate::input::{Interruption, Key};
use crate::selftest::SelfTest;
use crate::session::Outcome;
use crate::setup::Form;
use crate::stimulus::Picture;
use crate::timing::{IntervalFrames, Pace, Pacer, RefreshProbe};
use crate::trial::Trial;

/// Why the window closes.
#[derive(Clone, Debug, PartialEq)]
pub enum Exit {
    /// No session was begun.
    Unbegun,
    /// The session, or the last of several, ended like this.
    Ended(Outcome),
    /// The self-test's outcome.
    Tested(Box<SelfTest>),
    /// There can be no session here, and why.
    Refused(String),
}

/// What is going on.
#[derive(Debug)]
enum Phase<'a> {
    /// The window finds its size: how long it has had it, seconds' moment and passes.
    Settling { since_s: f64, passes: u32, size_px: [usize; 2] },
    /// Swaps are timed.
    Measuring(Box<RefreshProbe>),
    /// Pictures are uploaded, drawn once and read back, one after the other.
    Preparing { left: Vec<Picture>, reading: Option<(Reading, u32)> },
    /// The experimenter's screen.
    SetUp { form: Box<Form>, problem: String },
    /// The session.
    Session(Box<Conductor<'a>>),
    /// The self-test: the pair being shown, how many are left, what was seen.
    Testing { trial: Box<Trial>, left: u32, seen: Vec<IntervalFrames> },
    /// There can be none.
    Refused(String),
}

/// A sitting at one display.
#[derive(Debug)]
pub struct Desk<'a> {
    study: &'a Study,
    data: Option<&'a DataFolder>,
    participant: Option<String>,
    resume: bool,
    /// Programs that answer, one after the other; the first is at the desk.
    bots: VecDeque<Bot>,
    is_test: bool,
    /// Whether there is a graphics card to be asked.
    graphics: bool,
    /// The monitor that was asked for.
    monitor: Option<usize>,
    waiting: Vec<Picture>,
    phase: Phase<'a>,
    display: Display,
    os_hz: Option<f64>,
    pictures: HashMap<String, Uploaded>,
    even: Option<Uploaded>,
    time: Time,
    pacer: Pacer,
    watch: Watch,
    /// When this pass began: the frame before was handed over by then.
    pass_s: f64,
    /// The same by the system's clock, which goes on while the machine sleeps.
    pass_utc: Utc,
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
/// A pass that comes so much later than the one before, seconds of the wall's clock, comes after a sleep.
const ASLEEP_S: f64 = 1.0;
/// A picture that was not read back after so many passes cannot be.
const READ_WITHIN: u32 = 10;

impl<'a> Desk<'a> {
    /// A desk whose window has just been opened.
    #[must_use]
    pub fn new(launch: Launch<'a>, time: Time) -> Self {
        let (mut bots, mut is_test) = (VecDeque::new(), false);
        match launch.errand {
            Errand::Session => {}
            Errand::Rehearsal(observers) => bots = observers,
            Errand::SelfTest => is_test = true,
        }
        Self {
            study: launch.study,
            data: launch.data,
            participant: launch.participant,
            resume: launch.resume,
            bots,
            is_test,
            graphics: launch.graphics,
            monitor: launch.monitor,
            waiting: launch.pictures,
            phase: Phase::Settling { since_s: time.now_s(), passes: 0, size_px: [0, 0] },
            display: Display { allowed_unverified: launch.allow_unverified, ..Display::default() },
            os_hz: None,
            pictures: HashMap::new(),
            even: None,
            pass_s: time.now_s(),
            pass_utc: Utc::now(),
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

    /// Whether it must still be told which monitor it is on.
    #[must_use]
    pub fn asks_for_monitor(&self) -> bool {
        matches!(self.phase, Phase::Settling { .. })
    }

    /// The monitor, as the system describes it, and how many it has. One that was asked for and is not there is a refusal:
    /// the window system would take another without a word.
    pub fn monitor(&mut self, name: Option<String>, refresh_millihertz: Option<u32>, there: usize) {
        if let Some(wanted) = self.monitor.filter(|&wanted| wanted >= there) {
            self.phase = Phase::Refused(format!(
                "There is no display {wanted}: there are {there}, counted from 0. Name another with --display."
            ));
        }
        self.display.monitor = name;
        self.os_hz = refresh_millihertz.filter(|&rate| rate > 0).map(|rate| f64::from(rate) / 1e3);
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
        let mut happened = self.watch.look(ui.ctx());
        let utc = Utc::now();
        if utc.since_s(std::mem::replace(&mut self.pass_utc, utc)) > ASLEEP_S {
            happened.push(Interruption::Suspended);
        }
        if happened.contains(&Interruption::CloseRequested) {
            self.close_requested(ui.ctx());
        }
        match self.phase {
            Phase::Settling { .. } => self.settle(ui),
            Phase::Measuring(_) => self.measure(ui),
            Phase::Preparing { .. } => self.prepare(ui),
            Phase::SetUp { .. } => self.set_up(ui, &strokes),
            Phase::Session(_) => self.session(ui, &strokes, &happened),
            Phase::Testing { .. } => self.test(ui),
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

    fn picture_px(&self) -> [usize; 2] {
        let display = &self.study.display;
        [display.width_px, display.height_px].map(|n| usize::try_from(n).unwrap_or(usize::MAX))
    }

    fn settle(&mut self, ui: &mut Ui) {
        screens::message(ui, "One moment", "The window is being opened.");
        self.wait_for_frame();
        let now_px = window_px(ui.ctx());
        let Phase::Settling { since_s, passes, size_px } = &mut self.phase else { return };
        if *size_px != now_px {
            (*since_s, *passes, *size_px) = (self.pass_s, 0, now_px);
        }
        *passes += 1;
        let real_s = (self.pass_s - *since_s) / self.time.speed();
        if real_s < SETTLED.0 || *passes < SETTLED.1 {
            return;
        }
        self.display.window_px = now_px;
        self.display.scale = ui.ctx().pixels_per_point();
        let texts = screens::texts(self.study);
        let undrawable = undrawable(ui.ctx(), &texts);
        self.phase = if let Some(why) = does_not_fit(ui.ctx(), self.picture_px()) {
            Phase::Refused(why)
        } else if !undrawable.is_empty() {
            Phase::Refused(format!(
                "The texts of the study have characters that this program cannot draw: {undrawable}"
            ))
        } else if self.graphics {
            Phase::Measuring(Box::new(RefreshProbe::new(self.os_hz, self.study.seed)))
        } else {
            self.measured()
        };
    }

    /// What follows once it is known whether the display paces its frames. A rehearsal answers by program whatever the
    /// display does, and its rows say so.
    fn measured(&mut self) -> Phase<'a> {
        match self.display.refuses(self.study.demo || self.is_test || !self.bots.is_empty()) {
            Some(why) => Phase::Refused(why),
            None => Phase::Preparing { left: std::mem::take(&mut self.waiting), reading: None },
        }
    }

    /// Frames of the full cost, as fast as they come or held back, until the refresh is known.
    fn measure(&mut self, ui: &mut Ui) {
        let size_px = self.picture_px();
        let even = self.even.get_or_insert_with(|| Uploaded::even(ui.ctx(), size_px, BACKGROUND));
        even.draw(ui);
        screens::line_in_the_middle(ui, "One moment: the display is being measured.");
        let Phase::Measuring(probe) = &mut self.phase else { return };
        let speed = self.time.speed();
        if let Some(refresh) = probe.swapped(self.pass_s / speed) {
            self.display.refresh = Some(refresh);
            self.phase = self.measured();
            return;
        }
        let delay_s = probe.delay_s() * speed;
        self.time.until(self.time.now_s() + delay_s);
    }

    fn prepare(&mut self, ui: &mut Ui) {
        let size_px = self.picture_px();
        let even = self.even.get_or_insert_with(|| Uploaded::even(ui.ctx(), size_px, BACKGROUND)).clone();
        let Phase::Preparing { left, reading } = &mut self.phase else { return };
        if let Some((read, passes)) = reading {
            *passes += 1;
            let pixels = self.display.pixels.get_or_insert_with(PixelCheck::default);
            match read.differing_bytes() {
                Some(bytes) => {
                    pixels.pictures += 1;
                    pixels.differing_bytes += bytes;
                    *reading = None;
                }
                None if *passes > READ_WITHIN => {
                    self.phase = Phase::Refused(
                        "The window's framebuffer cannot be read: nobody would know what was shown.".to_owned(),
                    );
                    return;
                }
                None => {}
            }
        }
        if reading.is_none()
            && let Some(picture) = left.pop()
        {
            let uploaded = Uploaded::new(ui.ctx(), &picture);
            self.pictures.insert(picture.stimulus.id(), uploaded.clone());
            if self.graphics {
                *reading = Some((Reading::begin(ui, picture, &uploaded, &even), 0));
            } else {
                uploaded.draw(ui);
                even.draw(ui);
            }
        }
        let (many, ready) = (left.len(), left.is_empty() && reading.is_none());
        screens::message(ui, "One moment", &format!("{many} pictures are being prepared."));
        self.wait_for_frame();
        if ready {
            self.prepared(ui.ctx());
        }
    }

    fn prepared(&mut self, context: &egui::Context) {
        match self.display.pixels {
            Some(PixelCheck { differing_bytes, .. }) if differing_bytes > 0 && !self.is_test => {
                self.phase = Phase::Refused(format!(
                    "{differing_bytes} bytes on the screen are not those of the pictures' files (scale {}). Set the scale \
                     to a whole number and switch off whatever changes pictures.",
                    self.display.scale
                ));
            }
            _ if self.is_test => self.begin_test(context),
            _ => {
                let form = Form { code: self.participant.clone().unwrap_or_default(), ..Form::default() };
                self.phase = Phase::SetUp { form: Box::new(form), problem: String::new() };
            }
        }
    }

    fn refused(&mut self, ui: &mut Ui, strokes: &[Stroke]) {
        self.wait_for_frame();
        let Phase::Refused(why) = &self.phase else { return };
        screens::message(ui, "No session here", &format!("{why}\n\nPress Enter to close."));
        if strokes.contains(&Stroke::Down(Key::Enter)) || !self.bots.is_empty() || self.is_test {
            self.exit = Some(Exit::Refused(why.clone()));
        }
    }

    /// Keeps the pace where nothing is timed.
    fn wait_for_frame(&mut self) {
        self.next_frame(None);
    }

    /// Waits until the next frame must be begun; says when it will be seen, seconds.
    fn next_frame(&mut self, due_s: Option<f64>) -> f64 {
        let plan = self.pacer.plan(self.time.now_s(), due_s);
        let begun_s = self.time.until(plan.start_s);
        self.begun_s = Some(begun_s);
        self.frame_s = plan.frame_s;
        plan.shows_s + (begun_s - plan.start_s).max(0.0)
    }
}
