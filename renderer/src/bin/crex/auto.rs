//! `crex auto`: a crex proposed for a scene.

use std::path::PathBuf;

use renderer::picture::display::Display;
use renderer::propose::{self, Modulated, Profile, Proposal, ProposeError, Question, Step};
use renderer::render::Settings;
use renderer::schedule::Clock;
use serde::Serialize;

use crate::compare::read_display;
use crate::console::{self, Failure};
use crate::options::RadianceOptions;
use crate::render::{self, Prepared};
use crate::scene_files::SceneArgs;
use crate::timed;

/// What `crex auto` takes besides rpict's options.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    judged: Judged,
    /// Samples for each pixel of the picture that times are predicted for
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    spp: u32,
    /// Choose for this time instead of --tolerance: the least predicted loss whose tracing is predicted to take no longer
    #[arg(long, value_name = "SECONDS", value_parser = timed::seconds)]
    time: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What the commands take that judge pictures of a scene.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Judged {
    /// Loss that is accepted, JOD: 1 means that one person in four prefers the worse picture
    #[arg(long, value_name = "JOD", default_value_t = 0.2)]
    pub(crate) tolerance: f64,
    /// The display as a TOML file [default: the 2005 experiment's: 1280 x 1024, 17 inches at 60 cm, 250 cd/m2, 50 lux]
    #[arg(long, value_name = "FILE")]
    pub(crate) display: Option<PathBuf>,
    /// Radiance times this is shown as the display's white or less [default: mean luminance at half of white, as pfilt]
    #[arg(long, value_name = "FACTOR")]
    pub(crate) exposure: Option<f64>,
    /// Chooses the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads, also -n [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) threads: Option<u32>,
}

impl Judged {
    /// The display, and a check of the numbers.
    pub(crate) fn display(&self) -> Result<Display, Failure> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !positive(self.tolerance) {
            return Err(Failure::input(format!("--tolerance {} must be a positive number", self.tolerance)));
        }
        if let Some(exposure) = self.exposure.filter(|&exposure| !positive(exposure)) {
            return Err(Failure::input(format!("--exposure {exposure} must be a positive number")));
        }
        self.display.as_deref().map_or_else(|| Ok(Display::of_the_paper()), read_display)
    }
}

/// The object that `--json` prints.
#[derive(Serialize)]
struct Report {
    /// The crex proposed: the cheapest step within the tolerance, or the best within the time.
    crex: String,
    predicted_loss_jod: f64,
    predicted_s: f64,
    tolerance_jod: f64,
    /// The time that it was chosen for, in place of the tolerance.
    time_s: Option<f64>,
    exposure: f64,
    width: usize,
    height: usize,
    spp: u32,
    /// The same crex with its components in `{ }`.
    modulated: ModulatedReport,
    /// All steps from direct light to the full solution.
    steps: Vec<StepReport>,
}

#[derive(Serialize)]
struct ModulatedReport {
    crex: String,
    thresholds: Vec<f32>,
}

#[derive(Serialize)]
struct StepReport {
    crex: String,
    predicted_loss_jod: f64,
    /// Seconds of tracing, summed over threads.
    predicted_s: f64,
}

/// Processor time of the thread that asks: a stage's cost is measured on the thread that runs it, and so a busy machine does not
/// make rays look dear.
struct ThreadTime;

impl Clock for ThreadTime {
    fn now_s(&self) -> f64 {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
}

impl Prepared {
    /// What a proposal for this scene and view is asked by.
    pub(crate) fn question<'a>(
        &'a self,
        settings: &'a Settings,
        display: &'a Display,
        exposure: Option<f64>,
    ) -> Question<'a> {
        Question {
            scene: self.scene(),
            aggregate: self.aggregate(),
            view: &self.request.view,
            settings,
            display,
            exposure,
            clock: &ThreadTime,
        }
    }
}

pub(crate) fn run(args: &Args, options: &RadianceOptions) -> Result<(), Failure> {
    let display = args.judged.display()?;
    let Judged { seed, threads, exposure, tolerance, .. } = args.judged;
    let prepared = render::prepare_scene(&args.scene, threads, seed, None, options)?;
    let settings = Settings { samples: args.spp, ..prepared.request.settings.clone() };
    let mut profile = Profile::new(prepared.question(&settings, &display, exposure))?;
    let proposal = propose::propose_from(&mut profile)?;
    let threads = timed::threads(&settings) as f64;
    let chosen = match args.time {
        None => proposal.within_loss(tolerance).clone(),
        Some(seconds) => proposal.within_seconds(seconds * threads).clone(),
    };
    let modulated = propose::modulate(&mut profile, &chosen, tolerance)?;
    if args.json {
        console::print_json(&report(&proposal, &chosen, modulated, (tolerance, args.time), &settings))
    } else {
        let why = match args.time {
            None => format!("cheapest within {tolerance} JOD"),
            Some(seconds) => format!("least loss within {seconds} s on {threads} threads, of all that were looked at"),
        };
        console::print(&words(&proposal, &chosen, &modulated, &why, &settings))
    }
}

impl From<ProposeError> for Failure {
    fn from(error: ProposeError) -> Self {
        match error {
            ProposeError::Render(error) => error.into(),
            ProposeError::Compare(_) => Self::input(error),
        }
    }
}

fn report(
    proposal: &Proposal,
    chosen: &Step,
    modulated: Modulated,
    (tolerance, time): (f64, Option<f64>),
    settings: &Settings,
) -> Report {
    let step = |step: &Step| StepReport {
        crex: step.crex.clone(),
        predicted_loss_jod: step.forecast.loss_jod,
        predicted_s: step.forecast.seconds,
    };
    Report {
        crex: chosen.crex.clone(),
        predicted_loss_jod: chosen.forecast.loss_jod,
        predicted_s: chosen.forecast.seconds,
        tolerance_jod: tolerance,
        time_s: time,
        exposure: proposal.exposure,
        width: settings.width,
        height: settings.height,
        spp: settings.samples,
        modulated: ModulatedReport { crex: modulated.crex, thresholds: modulated.thresholds },
        steps: proposal.steps.iter().map(step).collect(),
    }
}

/// The proposal for people.
fn words(proposal: &Proposal, chosen: &Step, modulated: &Modulated, why: &str, settings: &Settings) -> String {
    let Settings { width, height, samples, .. } = settings;
    let mut text = format!(
        "Crexes by predicted gain per second; {width} x {height} pixels, {samples} samples each, exposure {:.3}.\n\
         Seconds are of tracing, summed over threads.\n\n  loss JOD    seconds  crex\n",
        proposal.exposure
    );
    // What is chosen for a time may be no step.
    let other = (!proposal.steps.contains(chosen)).then_some(chosen);
    for step in proposal.steps.iter().chain(other) {
        let mark = if step.crex == chosen.crex { '*' } else { ' ' };
        let name = if step.crex.is_empty() { "(direct light alone)" } else { &step.crex };
        text.push_str(&format!("{mark} {:8.3} {:10.2}  {name}\n", step.forecast.loss_jod, step.forecast.seconds));
    }
    text.push_str(&format!("\n* {why}.\n"));
    if !modulated.crex.is_empty() {
        text.push_str(&format!("\nWith an importance map: --crex '{}'\n", modulated.crex));
        if !modulated.thresholds.is_empty() {
            let list: Vec<String> = modulated.thresholds.iter().map(f32::to_string).collect();
            text.push_str(&format!("and either --continuous or --thresholds {}\n", list.join(",")));
        }
    }
    text
}
