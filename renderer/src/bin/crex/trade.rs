//! `crex trade`: the curve of quality against time for a scene.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use renderer::component::{Component, ComponentSet};
use renderer::crex::Program;
use renderer::picture::display::Display;
use renderer::picture::{AtomicFile, Picture, compare};
use renderer::propose::{self, Profile, Step};
use renderer::render::{Renderer, Rendering, Settings};
use renderer::schedule::{Budget, Clock, MonotonicClock, ProfileCache};
use renderer::trade::{Curve, Half, Loss, Modulated, Point, svg};
use serde::Serialize;

use crate::auto::Judged;
use crate::console::{self, Failure, Progress};
use crate::options::RadianceOptions;
use crate::render::{self, Prepared};
use crate::scene_files::SceneArgs;
use crate::{output, plan};

/// What `crex trade` takes besides rpict's options.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    judged: Judged,
    /// The curve: .csv, .json or .svg; may be repeated
    #[arg(short, long, value_name = "OUT")]
    output: Vec<PathBuf>,
    /// Samples of each pixel to try
    #[arg(long, value_name = "N,N,..", value_delimiter = ',', default_value = "1,4,16", value_parser = clap::value_parser!(u32).range(1..))]
    spp: Vec<u32>,
    /// Samples of the reference: the full solution with another seed [default: 4 times the most of --spp]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    reference_spp: Option<u32>,
    /// A crex to try besides those that `crex auto` proposes; may be repeated
    #[arg(long = "crex", value_name = "EXPR", allow_hyphen_values = true)]
    crexes: Vec<String>,
    /// Also try the proposed crexes with their components in { }, by thresholds and with continuous importance
    #[arg(long, value_name = "MAP")]
    importance: Option<PathBuf>,
    /// Also try the crexes with the planes of these components smoothed, where they run and there are 2 samples or more
    #[arg(long, value_name = "LETTERS", value_parser = render::component, value_delimiter = ',')]
    filter: Vec<Component>,
    /// Also try the crexes within so many seconds of rendering, with the most samples of --spp
    #[arg(long, value_name = "S,S,..", value_parser = crate::timed::seconds, value_delimiter = ',')]
    time: Vec<f64>,
    /// The loss by which points are better or worse; all are in .csv and .json
    #[arg(long, value_name = "LOSS", default_value = "jod")]
    by: By,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// `--by`.
#[derive(clap::ValueEnum, Clone, Copy, Debug)]
enum By {
    /// What ColorVideoVDP predicts that people see
    Jod,
    /// Mean FLIP
    Flip,
    /// Relative mean squared error of luminance
    RelMse,
}

/// A crex to try.
#[derive(Clone, Debug)]
struct Candidate {
    crex: String,
    importance: Modulated,
    thresholds: Vec<f32>,
    filter: ComponentSet,
}

/// How a candidate is tried.
#[derive(Clone, Copy)]
struct Trial<'a> {
    candidate: &'a Candidate,
    spp: u32,
    deadline_s: Option<f64>,
}

impl Candidate {
    fn plain(crex: String) -> Self {
        Self { crex, importance: Modulated::No, thresholds: Vec::new(), filter: ComponentSet::EMPTY }
    }
}

/// The object of `--json` and of a .json file.
#[derive(Serialize)]
struct Report<'a> {
    scene: String,
    width: usize,
    height: usize,
    threads: Option<usize>,
    seed: u64,
    exposure: f64,
    reference: Reference,
    /// The loss that decides the front, the knee and the half.
    loss: Loss,
    points: &'a [Point],
    knee: Option<&'a Point>,
    half: Option<Half>,
}

#[derive(Clone, Serialize)]
struct Reference {
    crex: String,
    spp: u32,
    seed: u64,
}

/// What all renderings share.
struct Bench<'a> {
    prepared: &'a Prepared,
    display: Display,
    exposure: f64,
    clock: &'a MonotonicClock,
}

pub(crate) fn run(args: &Args, options: &RadianceOptions, clock: &MonotonicClock) -> Result<(), Failure> {
    let display = args.judged.display()?;
    check_outputs(&args.output)?;
    for text in &args.crexes {
        plan::parse(text)?;
    }
    let Judged { seed, threads, exposure, tolerance, .. } = args.judged;
    let prepared = render::prepare_scene(&args.scene, threads, seed, args.importance.as_deref(), options)?;
    let settings = prepared.request.settings.clone();
    let mut profile = Profile::new(prepared.question(&settings, &display, exposure))?;
    let proposal = propose::propose_from(&mut profile)?;
    let candidates = candidates(args, &proposal.steps, &mut profile, tolerance)?;
    let exposure = profile.exposure();
    let bench = Bench { prepared: &prepared, display, exposure, clock };
    let most = args.spp.iter().copied().max().unwrap_or(1);
    let reference = Reference {
        crex: proposal.full().crex.clone(),
        spp: args.reference_spp.unwrap_or_else(|| most.saturating_mul(4)),
        seed: seed.wrapping_add(1),
    };
    let trials = trials(args, &candidates, most);
    let loss = match args.by {
        By::Jod => Loss::Jod,
        By::Flip => Loss::Flip,
        By::RelMse => Loss::RelMse,
    };
    let curve = Curve::new(bench.measure(&trials, &reference)?, loss);
    let names = args.scene.scenes.iter().map(|path| path.display().to_string());
    let Settings { width, height, threads, .. } = settings;
    let report = Report {
        scene: names.collect::<Vec<_>>().join(" "),
        width,
        height,
        threads,
        seed,
        exposure,
        reference,
        loss,
        points: curve.points(),
        knee: curve.knee(),
        half: curve.half(),
    };
    for path in &args.output {
        write(path, &curve, &report)?;
    }
    if args.json { console::print_json(&report) } else { console::print(&words(&curve, &report)) }
}

fn check_outputs(paths: &[PathBuf]) -> Result<(), Failure> {
    for path in paths {
        if kind(path).is_none() {
            return Err(Failure::input(format!("{}: the curve is written as .csv, .json or .svg", path.display())));
        }
        output::check_place(path)?;
    }
    output::clean_up_when_interrupted(paths.to_vec());
    Ok(())
}

fn kind(path: &Path) -> Option<&str> {
    path.extension().and_then(|extension| extension.to_str()).filter(|kind| ["csv", "json", "svg"].contains(kind))
}

/// The steps of the proposal, with a map also modulated, and what was asked for; none twice.
fn candidates(
    args: &Args,
    steps: &[Step],
    profile: &mut Profile<'_>,
    tolerance: f64,
) -> Result<Vec<Candidate>, Failure> {
    let mut made: Vec<Candidate> = steps.iter().map(|step| Candidate::plain(step.crex.clone())).collect();
    if args.importance.is_some() {
        for step in steps {
            let modulated = propose::modulate(profile, step, tolerance)?;
            if modulated.thresholds.is_empty() {
                continue;
            }
            let all = step.levels.components().iter().copied().collect();
            made.push(Candidate {
                crex: modulated.crex,
                importance: Modulated::Thresholds,
                thresholds: modulated.thresholds,
                filter: ComponentSet::EMPTY,
            });
            made.push(Candidate {
                crex: step.levels.spelled(all),
                importance: Modulated::Continuous,
                thresholds: vec![],
                filter: ComponentSet::EMPTY,
            });
        }
    }
    for crex in &args.crexes {
        let importance =
            if args.importance.is_some() && crex.contains('{') { Modulated::Thresholds } else { Modulated::No };
        made.push(Candidate { importance, ..Candidate::plain(crex.clone()) });
    }
    let mut known: Vec<(String, Modulated)> = Vec::new();
    made.retain(|candidate| {
        let name = (candidate.crex.clone(), candidate.importance);
        let new = !known.contains(&name);
        known.push(name);
        new
    });
    for index in 0..made.len() {
        let run = Program::new(&plan::parse(&made[index].crex)?).components();
        let filter: ComponentSet = args.filter.iter().copied().filter(|&component| run.contains(component)).collect();
        // Continuous importance spreads samples unevenly, and smoothing wants two halves of them.
        if !filter.is_empty() && made[index].importance != Modulated::Continuous {
            made.push(Candidate { filter, ..made[index].clone() });
        }
    }
    Ok(made)
}

/// Every candidate at all numbers of samples, and within all time limits.
fn trials<'a>(args: &Args, candidates: &'a [Candidate], most: u32) -> Vec<Trial<'a>> {
    let mut trials = Vec::new();
    for candidate in candidates {
        let smoothed = !candidate.filter.is_empty();
        let spps = args.spp.iter().filter(|&&spp| spp > 1 || !smoothed);
        trials.extend(spps.map(|&spp| Trial { candidate, spp, deadline_s: None }));
        let times = args.time.iter().filter(|_| !smoothed);
        trials.extend(times.map(|&time| Trial { candidate, spp: most, deadline_s: Some(time) }));
    }
    trials
}

impl Bench<'_> {
    fn measure(&self, trials: &[Trial<'_>], reference: &Reference) -> Result<Vec<Point>, Failure> {
        let progress = Progress::new(self.clock);
        // The reference costs about as much as the full solution at all samples together, and that is a step of many.
        let parts = trials.iter().map(|trial| f64::from(trial.spp));
        let all = f64::from(reference.spp) + parts.sum::<f64>();
        let done = Cell::new(0.0);
        let begin = |part: f64| {
            let begun = done.replace(done.get() + part);
            let progress = &progress;
            move |fraction: f64| progress.set((begun + part * fraction) / all)
        };
        let settings = |spp: u32, seed: u64| Settings { samples: spp, seed, ..self.prepared.request.settings.clone() };
        let full = Candidate::plain(reference.crex.clone());
        let trial = Trial { candidate: &full, spp: reference.spp, deadline_s: None };
        let show = begin(f64::from(reference.spp));
        let truth = picture(&self.render(trial, settings(reference.spp, reference.seed), &show)?);
        let mut points = Vec::new();
        for &trial in trials {
            let show = begin(f64::from(trial.spp));
            let seed = self.prepared.request.settings.seed;
            let (wall, cpu) = (self.clock.now_s(), cpu_s());
            let rendering = self.render(trial, settings(trial.spp, seed), &show)?;
            let (wall_s, cpu_s) = (self.clock.now_s() - wall, cpu_s() - cpu);
            points.push(self.judge(trial, &rendering, &truth, wall_s, cpu_s)?);
        }
        progress.done();
        Ok(points)
    }

    fn render(
        &self,
        trial: Trial<'_>,
        settings: Settings,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendering, Failure> {
        let candidate = trial.candidate;
        let program = Program::new(&plan::parse(&candidate.crex)?);
        let request = &self.prepared.request;
        let (scene, view) = (self.prepared.scene(), &request.view);
        let mut renderer = Renderer::new(scene, self.prepared.aggregate(), view, &program, self.clock, settings)?;
        renderer = renderer.with_progress(progress);
        if let Some(map) = request.importance.as_ref().filter(|_| candidate.importance != Modulated::No) {
            renderer = renderer.with_importance(map.values())?;
        }
        if candidate.importance == Modulated::Continuous {
            renderer = renderer.with_continuous_importance();
        } else if !candidate.thresholds.is_empty() {
            renderer = renderer.with_thresholds(&candidate.thresholds)?;
        }
        Ok(match trial.deadline_s {
            // Each run learns what rays cost by itself, as a user's first one would.
            Some(seconds) => {
                let budget = Budget::new(self.clock, self.clock.now_s() + seconds, 0.0);
                renderer.render_within(budget, &mut ProfileCache::new("", ""))?.rendering
            }
            None if candidate.filter.is_empty() => renderer.render()?,
            None => renderer.render_smoothed(candidate.filter)?.0,
        })
    }

    fn judge(
        &self,
        trial: Trial<'_>,
        rendering: &Rendering,
        truth: &Picture,
        wall_s: f64,
        cpu_s: f64,
    ) -> Result<Point, Failure> {
        let made = picture(rendering);
        let difference = compare::difference(truth, &made).map_err(Failure::input)?;
        let jod = compare::jod(truth, &made, &self.display, self.exposure).map_err(Failure::input)?.jod;
        let flip = compare::mean(&compare::flip(truth, &made, &self.display, self.exposure).map_err(Failure::input)?);
        let rays = rendering.primary.rays + rendering.stages.iter().map(|row| row.report.rays).sum::<u64>();
        Ok(Point {
            crex: trial.candidate.crex.clone(),
            importance: trial.candidate.importance,
            filter: trial.candidate.filter.iter().map(Component::letter).collect(),
            deadline_s: trial.deadline_s,
            spp: trial.spp,
            wall_s,
            cpu_s,
            rays,
            loss_jod: (10.0 - jod).max(0.0),
            flip,
            rel_mse: difference.rel_mse.unwrap_or(0.0),
            front: false,
            knee: false,
        })
    }
}

fn picture(rendering: &Rendering) -> Picture {
    Picture::of_radiance(&rendering.film.beauty())
}

/// Processor seconds of the program so far.
fn cpu_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn write(path: &Path, curve: &Curve, report: &Report<'_>) -> Result<(), Failure> {
    let cannot = |error: String| Failure::Cannot(format!("{}: cannot be written: {error}", path.display()));
    let text = match kind(path) {
        Some("csv") => curve.csv(),
        Some("svg") => svg(curve, &title(report)),
        _ => serde_json::to_string_pretty(report).map_err(|error| cannot(error.to_string()))? + "\n",
    };
    AtomicFile::write_all(path, text.as_bytes()).map_err(|error| cannot(error.to_string()))
}

fn title(report: &Report<'_>) -> String {
    let Report { width, height, reference, .. } = report;
    format!("{}, {width} x {height}, against {} at {} spp", report.scene, reference.crex, reference.spp)
}

/// The front for people, the knee, and what half the time costs.
fn words(curve: &Curve, report: &Report<'_>) -> String {
    let mut text = format!("{}\n\n   cpu s   wall s  loss JOD    FLIP  rel MSE  how\n", title(report));
    for point in curve.front() {
        let Point { wall_s, cpu_s, loss_jod, flip, rel_mse, .. } = point;
        let mark = if point.knee { "  <- knee" } else { "" };
        text.push_str(&format!(
            "{cpu_s:8.3} {wall_s:8.3} {loss_jod:9.3} {flip:7.4} {rel_mse:8.4}  {}{mark}\n",
            point.how()
        ));
    }
    match curve.half() {
        Some(Half { best, half }) => {
            let loss = curve.loss();
            let [less, most] = [&half, &best].map(|point| loss.of(point));
            text.push_str(&format!(
                "\nAt half the time of the best ({:.2} of {:.2} s) you lose {} more ({} against {}), with {}.\n",
                half.cpu_s,
                best.cpu_s,
                loss.words(less - most),
                loss.words(less),
                loss.words(most),
                half.how()
            ));
        }
        None => text.push_str("\nNothing that was tried takes half the time of the best.\n"),
    }
    text
}
