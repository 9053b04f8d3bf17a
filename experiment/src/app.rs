//! The window: this module and `main` alone name egui and eframe.
//!
//! One pass of egui is one frame. It begins by stamping the moment at which the frame before was handed over (the swap has
//! returned by then), goes on with the keys that came since, waits until the next frame must be begun to be seen when it
//! is due, lets the session move on, and draws its screen. Everything that decides is in [`crate::session`] and
//! [`crate::timing`]; here is only what needs a window.

mod desk;
mod keys;
mod pixels;
mod prepare;
mod screens;
mod watch;

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

use stimuli::Study;

use crate::bot::Bot;
use crate::clock::{Clock, Time};
use crate::enrol::DataFolder;
use crate::error::{Error, Result};
use crate::stimulus::Picture;

pub use desk::{Desk, Exit};
pub use screens::{BACKGROUND, style};

/// What the window is opened for.
#[derive(Debug)]
pub enum Errand {
    /// A session with a person.
    Session,
    /// Sessions with programs, one after the other.
    Rehearsal(VecDeque<Bot>),
    /// To find out what the machine can do.
    SelfTest,
}

/// What a session in a window needs.
#[derive(Debug)]
pub struct Launch<'a> {
    /// The study.
    pub study: &'a Study,
    /// Where its data go; a self-test needs none.
    pub data: Option<&'a DataFolder>,
    /// What for.
    pub errand: Errand,
    /// Why a main study may run on a display that is not verified; `None` where it must not.
    pub allow_unverified: Option<String>,
    /// Whether refresh and framebuffer are asked: always, except in tests of the screens without any graphics.
    pub graphics: bool,
    /// Every picture of the study.
    pub pictures: Vec<Picture>,
    /// The participant's code, if it is known already.
    pub participant: Option<String>,
    /// Whether the participant's session is taken up again.
    pub resume: bool,
    /// How fast time runs: 1 except in rehearsals.
    pub speed: f64,
    /// The monitor, counted from 0 in the system's order; the one that the system chooses if `None`.
    pub monitor: Option<usize>,
}

/// Opens the window and runs the errand in it; says why the window was closed.
///
/// # Errors
/// If no window can be opened, the display cannot show the pictures, or the session cannot begin.
pub fn run(launch: Launch<'_>) -> Result<Exit> {
    let exit = Arc::new(Mutex::new(Exit::Unbegun));
    let mut viewport = egui::ViewportBuilder::default()
        .with_title("crex-session") // the study's title may say what it is about
        .with_fullscreen(true)
        .with_decorations(false)
        .with_app_id("crex-session");
    if let Some(monitor) = launch.monitor {
        viewport = viewport.with_monitor(monitor);
    }
    let options = eframe::NativeOptions {
        viewport,
        renderer: eframe::Renderer::Glow,
        dithering: false,      // it would add noise to stimuli
        persist_window: false, // where the window was last time is no place for a stimulus
        system_font_fallback: false,
        clipboard_shortcuts: false,
        ..eframe::NativeOptions::default()
    };
    let shared = Arc::clone(&exit);
    let create: eframe::AppCreator<'_> = Box::new(move |context| {
        context.egui_ctx.options_mut(|options| {
            options.zoom_with_keyboard = false; // a zoom would spoil the 1:1 pixels
            options.max_passes = std::num::NonZeroUsize::MIN; // one pass, one frame
        });
        screens::style(&context.egui_ctx);
        let time = Time::Runs(Clock::new(launch.speed));
        Ok(Box::new(Window { desk: Desk::new(launch, time), exit: shared }))
    });
    eframe::run_native("crex-session", options, create).map_err(|error| {
        Error::Machine(format!("cannot open a window: {error}; is a display connected, and OpenGL installed?"))
    })?;
    let ended = match exit.lock() {
        Ok(mut exit) => std::mem::replace(&mut *exit, Exit::Unbegun),
        Err(_) => Exit::Unbegun,
    };
    match ended {
        Exit::Refused(why) => Err(Error::Machine(why)),
        exit => Ok(exit),
    }
}

/// The desk in eframe's window.
struct Window<'a> {
    desk: Desk<'a>,
    exit: Arc<Mutex<Exit>>,
}

impl eframe::App for Window<'_> {
    /// The first thing that eframe calls in a pass: the swap of the pass before has returned.
    fn raw_input_hook(&mut self, _context: &egui::Context, _input: &mut egui::RawInput) {
        self.desk.begin_pass();
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if self.desk.asks_for_monitor()
            && let Some(monitor) = frame.winit_window().and_then(|window| window.current_monitor())
        {
            let there = frame.winit_window().map_or(0, |window| window.available_monitors().count());
            self.desk.monitor(monitor.name(), monitor.refresh_rate_millihertz(), there);
        }
        self.desk.show(ui);
        if let Some(exit) = self.desk.exit() {
            if let Ok(mut shared) = self.exit.lock() {
                *shared = exit;
            }
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        ui.ctx().request_repaint();
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        BACKGROUND.to_normalized_gamma_f32()
    }
}
