//! `crex trade`: the curve of quality against time for a scene.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use renderer::crex::Program;
use renderer::geometry::Aggregate;
use renderer::picture::display::Display;
use renderer::picture::{AtomicFile, Picture, compare};
use renderer::propose::{self, Profile, Question, Step};
use renderer::render::{RenderError, Renderer, Rendering, Settings};
use renderer::schedule::{Clock, MonotonicClock};
use renderer::trade::{Curve, Half, Modulated, Point, svg};
use serde::Serialize;

use crate::auto::{Judged, ThreadTime, refused};
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
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A crex to try.
#[derive(Clone, Debug)]
struct Candidate {
    crex: String,
    importance: Modulated,
    thresholds: Vec<f32>,
}

impl Candidate {
    fn plain(crex: String) -> Self {
        Self { crex, importance: Modulated::No, thresholds: Vec::new() }
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
    aggregate: Aggregate,
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
    let aggregate = prepared.scene().aggregate();
    let question = Question {
        scene: prepared.scene(),
        aggregate: &aggregate,
        view: &prepared.request.view,
        settings: &settings,
        display: &display,
        exposure,
        clock: &ThreadTime,
    };
    let mut profile = Profile::new(question).map_err(refused)?;
    let proposal = propose::propose_from(&mut profile).map_err(refused)?;
    let candidates = candidates(args, &proposal.steps, &mut profile, tolerance)?;
    let exposure = profile.exposure();
    let bench = Bench { prepared: &prepared, aggregate, display, exposure, clock };
    let most = args.spp.iter().copied().max().unwrap_or(1);
    let reference = Reference {
        crex: proposal.full().crex.clone(),
        spp: args.reference_spp.unwrap_or_else(|| most.saturating_mul(4)),
        seed: seed.wrapping_add(1),
    };
    let curve = Curve::new(bench.measure(&candidates, &args.spp, &reference)?);
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
            let modulated = propose::modulate(profile, step, tolerance).map_err(refused)?;
            if modulated.thresholds.is_empty() {
                continue;
            }
            let all = step.levels.components().iter().copied().collect();
            made.push(Candidate {
                crex: modulated.crex,
                importance: Modulated::Thresholds,
                thresholds: modulated.thresholds,
            });
            made.push(Candidate {
                crex: step.levels.spelled(all),
                importance: Modulated::Continuous,
                thresholds: vec![],
            });
        }
    }
    for crex in &args.crexes {
        let importance =
            if args.importance.is_some() && crex.contains('{') { Modulated::Thresholds } else { Modulated::No };
        made.push(Candidate { crex: crex.clone(), importance, thresholds: Vec::new() });
    }
    let mut known: Vec<(String, Modulated)> = Vec::new();
    made.retain(|candidate| {
        let name = (candidate.crex.clone(), candidate.importance);
        let new = !known.contains(&name);
        known.push(name);
        new
    });
    Ok(made)
}

impl Bench<'_> {
    fn measure(&self, candidates: &[Candidate], spps: &[u32], reference: &Reference) -> Result<Vec<Point>, Failure> {
        let progress = Progress::new(self.clock);
        // The reference costs about as much as the full solution at all samples together, and that is a step of many.
        let all =
            f64::from(reference.spp) + spps.iter().map(|&spp| f64::from(spp)).sum::<f64>() * candidates.len() as f64;
        let done = Cell::new(0.0);
        let show = |begun: f64, part: f64, fraction: f64| progress.set((begun + part * fraction) / all);
        let settings = |spp: u32, seed: u64| Settings { samples: spp, seed, ..self.prepared.request.settings.clone() };
        let begin = |part: f64| done.replace(done.get() + part);
        let begun = begin(f64::from(reference.spp));
        let full = Candidate::plain(reference.crex.clone());
        let part = f64::from(reference.spp);
        let truth =
            self.render(&full, settings(reference.spp, reference.seed), &|fraction| show(begun, part, fraction))?;
        let truth = picture(&truth);
        let mut points = Vec::new();
        for candidate in candidates {
            for &spp in spps {
                let part = f64::from(spp);
                let begun = begin(part);
                let seed = self.prepared.request.settings.seed;
                let (wall, cpu) = (self.clock.now_s(), cpu_s());
                let rendering = self.render(candidate, settings(spp, seed), &|fraction| show(begun, part, fraction))?;
                let (wall_s, cpu_s) = (self.clock.now_s() - wall, cpu_s() - cpu);
                points.push(self.judge(candidate, spp, &rendering, &truth, wall_s, cpu_s)?);
            }
        }
        progress.done();
        Ok(points)
    }

    fn render(
        &self,
        candidate: &Candidate,
        settings: Settings,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Rendering, Failure> {
        let refused = |error: RenderError| match error {
            RenderError::Threads { .. } => Failure::Cannot(error.to_string()),
            _ => Failure::input(error),
        };
        let program = Program::new(&plan::parse(&candidate.crex)?);
        let request = &self.prepared.request;
        let (scene, view) = (self.prepared.scene(), &request.view);
        let mut renderer = Renderer::new(scene, &self.aggregate, view, &program, self.clock, settings)
            .map_err(refused)?
            .with_progress(progress);
        if let Some(map) = request.importance.as_ref().filter(|_| candidate.importance != Modulated::No) {
            renderer = renderer.with_importance(map.values()).map_err(refused)?;
        }
        if candidate.importance == Modulated::Continuous {
            renderer = renderer.with_continuous_importance();
        } else if !candidate.thresholds.is_empty() {
            renderer = renderer.with_thresholds(&candidate.thresholds).map_err(refused)?;
        }
        renderer.render().map_err(refused)
    }

    fn judge(
        &self,
        candidate: &Candidate,
        spp: u32,
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
            crex: candidate.crex.clone(),
            importance: candidate.importance,
            spp,
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
    let mut text =
        format!("{}\n\n   cpu s   wall s  loss JOD    FLIP  rel MSE  spp  importance  crex\n", title(report));
    for point in curve.front() {
        let Point { crex, importance, spp, wall_s, cpu_s, loss_jod, flip, rel_mse, .. } = point;
        let mark = if point.knee { "  <- knee" } else { "" };
        text.push_str(&format!(
            "{cpu_s:8.3} {wall_s:8.3} {loss_jod:9.3} {flip:7.4} {rel_mse:8.4} {spp:4}  {:<10}  {crex}{mark}\n",
            importance.word()
        ));
    }
    match curve.half() {
        Some(Half { best, half }) => text.push_str(&format!(
            "\nAt half the time of the best ({:.2} of {:.2} s) you lose {:.2} JOD more ({:.2} against {:.2}; FLIP {:.3} against \
             {:.3}), with {:?} and {} spp.\n",
            half.cpu_s,
            best.cpu_s,
            half.loss_jod - best.loss_jod,
            half.loss_jod,
            best.loss_jod,
            half.flip,
            best.flip,
            half.crex,
            half.spp
        )),
        None => text.push_str("\nNothing that was tried takes half the time of the best.\n"),
    }
    text
}
