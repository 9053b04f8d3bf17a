//! `--time`, `--profile` and `--replay`: a picture within a time limit, counted from the program's start to its closed
//! files, and the same picture again without a clock.

use std::fs;
use std::path::Path;

use renderer::picture::{Compression, Format, Input};
use renderer::render::{Rendering, RoundRecord, Settings, TimedRecord, TimedRendering};
use renderer::schedule::{Budget, Clock, MonotonicClock, ProfileCache};
use serde::{Deserialize, Serialize};
use stimuli::Sha256;

use crate::console::{self, Failure};
use crate::output::{Output, Packing};
use crate::render::Prepared;

/// What a writer costs before it was measured, in seconds for each byte of pixels, on one 2 GHz core; pictures differ by half of it.
const WRITING_S: [(Compression, &str, f64); 4] = [
    (Compression::Zip, "zip", 15e-9),
    (Compression::Piz, "piz", 14e-9),
    (Compression::Rle, "rle", 3e-9),
    (Compression::Uncompressed, "uncompressed", 2e-9),
];

/// The part of the time limit that writing may take before a faster compression is taken.
const WRITING_TIME: f64 = 0.05;

/// What a first guess of the writer's cost is multiplied by.
const UNMEASURED: f64 = 2.0;

/// Seconds between the start of the process and of its clock, and between the last file and the end of the process.
const EDGES_S: f64 = 0.003;

/// Seconds for each byte of memory that the system takes back at the end.
const TAKING_BACK_S: f64 = 20e-12;

/// The part of the bound that is not used, against what the system does meanwhile: the programs of a machine take turns. Of bounds
/// below a second as much less as they are shorter, since there is less time in which something can happen.
const MARGIN: f64 = 0.015;

/// Seconds to store a profile or what was done.
const SMALL_FILE_S: f64 = 0.001;

/// What is written besides the pictures: its format where it is pictures too.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Beside {
    pub(crate) stats: bool,
    pub(crate) ran: Option<Format>,
    pub(crate) parts: Option<Format>,
}

/// A time limit and what is known of costs.
pub(crate) struct Limit<'a> {
    seconds: f64,
    /// From when they count, by the program's clock.
    begun_s: f64,
    file: Option<&'a Path>,
    profile: ProfileCache,
    compression: Compression,
    /// Seconds kept for what comes after rendering.
    reserve_s: f64,
}

/// Reads the time limit of the command line.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("expected seconds, more than 0".to_owned()),
    }
}

/// What a profile's costs hold for: a hash of everything that was read for the scene.
pub(crate) fn scene_hash(inputs: &[Input]) -> String {
    let text: String = inputs.iter().map(|input| format!("{}\n", input.sha256)).collect();
    Sha256::of(text.as_bytes()).to_string()
}

/// The same for the machine: its processor, the threads used, and this program.
pub(crate) fn machine(threads: usize) -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
    let model = model.map_or(std::env::consts::ARCH, |(_, model)| model.trim());
    format!("{model}, {threads} threads, crex {}", env!("CARGO_PKG_VERSION"))
}

/// The threads that settings amount to.
pub(crate) fn threads(settings: &Settings) -> usize {
    let available = || std::thread::available_parallelism().ok().map(usize::from);
    settings.threads.or_else(available).unwrap_or(1)
}

/// Reads a profile, or begins one.
pub(crate) fn profile(file: Option<&Path>, prepared: &Prepared) -> Result<ProfileCache, Failure> {
    let (scene, machine) = (prepared.scene_hash(), machine(threads(&prepared.request.settings)));
    match file {
        Some(file) => ProfileCache::load(file, &scene, &machine).map_err(Failure::input),
        None => Ok(ProfileCache::new(scene, machine)),
    }
}

impl<'a> Limit<'a> {
    /// Decides how pictures will be packed.
    pub(crate) fn new(
        seconds: f64,
        (file, profile): (Option<&'a Path>, ProfileCache),
        beside: Beside,
        prepared: &Prepared,
        outputs: &[Output],
    ) -> Self {
        let mut sizes: Vec<(Option<Format>, f64)> = outputs.iter().map(|output| bytes(output, prepared)).collect();
        let Settings { width, height, .. } = prepared.request.settings;
        let plane = (width * height * 12) as f64;
        sizes.extend(beside.ran.map(|format| (Some(format), plane)));
        sizes.extend(beside.parts.map(|format| (Some(format), plane * prepared.planes().len() as f64)));
        let mut chosen = (Compression::Uncompressed, f64::INFINITY);
        for (compression, name, guess) in WRITING_S {
            let cost = |(format, bytes): &(Option<Format>, f64)| {
                let name = writer_name(*format, name);
                let guess = if *format == Some(Format::Exr) { guess } else { WRITING_S[0].2 };
                profile.kept_s(name, *bytes as u64).unwrap_or(UNMEASURED * guess * bytes)
            };
            let all: f64 = sizes.iter().map(cost).sum();
            chosen = (compression, all);
            if all <= WRITING_TIME * seconds {
                break;
            }
        }
        let small = usize::from(beside.stats) + usize::from(file.is_some());
        let reserve_s = chosen.1 + EDGES_S + small as f64 * SMALL_FILE_S + MARGIN * seconds * seconds.min(1.0);
        Self { seconds, begun_s: 0.0, file, profile, compression: chosen.0, reserve_s }
    }

    /// Renders.
    pub(crate) fn render(&mut self, prepared: &Prepared, clock: &MonotonicClock) -> Result<TimedRendering, Failure> {
        let budget = Budget::new(clock, self.begun_s + self.seconds, self.reserve_s);
        if budget.left_s() <= 0.0 {
            let message = format!(
                "--time {}: reading the scene took {:.2} s and writing may take {:.2} s more: a picture of the coarsest \
                 kind will be late",
                self.seconds,
                clock.now_s(),
                self.reserve_s
            );
            console::say("warning", &message);
        }
        prepared.with_renderer(clock, |renderer| {
            let bytes = renderer.timed_bytes();
            say_if_too_large(bytes);
            renderer.render_within(budget.with_more_reserve(TAKING_BACK_S * bytes), &mut self.profile)
        })
    }

    /// Writes the pictures, and learns what that takes.
    pub(crate) fn write(
        &mut self,
        exposure: f64,
        prepared: &Prepared,
        outputs: &[Output],
        rendering: &Rendering,
        clock: &MonotonicClock,
    ) -> Result<(), Failure> {
        for output in outputs {
            let begun_s = clock.now_s();
            let packing = Packing { compression: self.compression, durable: false };
            output.write(&rendering.film, exposure, &prepared.request.provenance, packing)?;
            let (format, bytes) = bytes(output, prepared);
            let name = writer_name(format, compression_name(self.compression));
            self.profile.observe_writer(name, bytes as u64, clock.now_s() - begun_s);
        }
        Ok(())
    }

    /// The same with the time counted from a moment of the program's clock.
    pub(crate) fn beginning_at(self, begun_s: f64) -> Self {
        Self { begun_s, ..self }
    }

    /// The profile, for the next picture.
    pub(crate) fn into_profile(self) -> ProfileCache {
        self.profile
    }

    /// Stores what was learnt, if there is a file for it.
    pub(crate) fn save(&mut self) -> Result<(), Failure> {
        match self.file {
            Some(file) => self.profile.save(file).map_err(|error| Failure::Cannot(error.to_string())),
            None => Ok(()),
        }
    }
}

fn compression_name(compression: Compression) -> &'static str {
    WRITING_S.iter().find(|(other, ..)| *other == compression).map_or("zip", |(_, name, _)| name)
}

fn writer_name(format: Option<Format>, compression: &'static str) -> &'static str {
    match format {
        Some(Format::Exr) => compression,
        Some(Format::Png) => "png",
        Some(Format::Hdr) | None => "hdr",
    }
}

/// The bytes of pixels that a writer is given.
fn bytes(output: &Output, prepared: &Prepared) -> (Option<Format>, f64) {
    let format = output.path().and_then(Format::of_name);
    let Settings { width, height, .. } = &prepared.request.settings;
    let planes = if format == Some(Format::Exr) { 1 + prepared.planes().len() } else { 1 };
    (format, (width * height * planes * 12) as f64)
}

/// Says so if a rendering will need more memory than is free, where the system tells.
fn say_if_too_large(bytes: f64) {
    let info = fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"));
    let free = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()).map(|kb| 1024.0 * kb);
    if let Some(free) = free.filter(|free| bytes > *free) {
        let message = format!(
            "this may take {:.1} GB of memory and {:.1} GB are free: render a smaller picture, or without --time",
            bytes * 1e-9,
            free * 1e-9
        );
        console::say("warning", &message);
    }
}

/// What `--stats` keeps of a run under a time limit: enough to repeat it.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct TimedStats {
    rounds: Vec<RoundStats>,
    /// Tiles times levels of the refinement.
    units: u64,
    /// Those of them that were given up when the time was over.
    #[serde(default)]
    missing: Vec<u64>,
    /// Rays that the refinement traced, primary ones included.
    refined_rays: u64,
    /// Complete samples of a pixel, on average, from the refinement.
    refined_samples: f64,
    /// Rays that were traced only to learn what they cost.
    #[serde(default)]
    probed_rays: u64,
    compression: String,
    /// Seconds kept for writing.
    reserve_s: f64,
}

#[derive(Debug, Serialize, Deserialize)]
struct RoundStats {
    first_sample: u32,
    samples: u32,
    tiles: usize,
    /// A digit for every stage: 1 if it ran, 0 if it was skipped.
    ran: String,
}

impl TimedStats {
    pub(crate) fn new(timed: &TimedRendering, compression: Compression, reserve_s: f64) -> Self {
        let rounds = timed.record.rounds.iter().map(|round| RoundStats {
            first_sample: round.first_sample,
            samples: round.samples,
            tiles: round.tiles,
            ran: round.ran.iter().map(|&ran| if ran { '1' } else { '0' }).collect(),
        });
        Self {
            rounds: rounds.collect(),
            units: timed.record.units,
            missing: timed.record.missing.clone(),
            refined_rays: timed.refined.rays,
            refined_samples: timed.refined_samples,
            probed_rays: timed.probed_rays,
            compression: compression_name(compression).to_owned(),
            reserve_s,
        }
    }
}

impl Limit<'_> {
    /// What to keep of a run.
    pub(crate) fn stats(&self, timed: &TimedRendering) -> TimedStats {
        TimedStats::new(timed, self.compression, self.reserve_s)
    }

    /// The time limit, seconds.
    pub(crate) fn seconds(&self) -> f64 {
        self.seconds
    }
}

/// What `--replay` reads of a file of `--stats`.
#[derive(Debug, Deserialize)]
struct Recorded {
    crex: String,
    scene: String,
    #[serde(default)]
    modulation: String,
    width: usize,
    height: usize,
    spp: u32,
    seed: u64,
    timed: Option<TimedStats>,
}

/// The crex of a file of `--stats`.
pub(crate) fn recorded_crex(file: &Path) -> Result<String, Failure> {
    recorded(file).map(|recorded| recorded.crex)
}

fn recorded(file: &Path) -> Result<Recorded, Failure> {
    let name = file.display();
    let text = fs::read_to_string(file).map_err(|error| Failure::input(format!("--replay {name}: {error}")))?;
    serde_json::from_str(&text).map_err(|error| {
        let (line, column) = (error.line(), error.column());
        Failure::input(format!("{name}:{line}:{column}: not what --stats writes: {error}"))
    })
}

/// Renders what a file of `--stats` says once more, and says how it is to be packed.
pub(crate) fn replay(
    file: &Path,
    prepared: &Prepared,
    clock: &MonotonicClock,
) -> Result<Option<(TimedRendering, Compression)>, Failure> {
    let name = file.display();
    let recorded = recorded(file)?;
    let settings = &prepared.request.settings;
    let here = [
        ("crex", prepared.request.program.text().to_owned(), recorded.crex.clone()),
        ("scene", prepared.scene_hash(), recorded.scene.clone()),
        ("importance (map; thresholds)", prepared.request.modulation(), recorded.modulation.clone()),
        (
            "size",
            format!("{} x {}", settings.width, settings.height),
            format!("{} x {}", recorded.width, recorded.height),
        ),
        ("--spp", settings.samples.to_string(), recorded.spp.to_string()),
        ("--seed", settings.seed.to_string(), recorded.seed.to_string()),
    ];
    for (what, given, wanted) in here {
        if given != wanted {
            let message = format!("--replay {name}: it was rendered with {what} {wanted}, not {given}: give the same");
            return Err(Failure::input(message));
        }
    }
    let Some(timed) = recorded.timed else { return Ok(None) };
    let compression = WRITING_S.iter().find(|(_, name, _)| *name == timed.compression);
    let compression = compression.map_or(Compression::Zip, |(compression, ..)| *compression);
    let rounds = timed.rounds.iter().map(|round| RoundRecord {
        first_sample: round.first_sample,
        samples: round.samples,
        tiles: round.tiles,
        ran: round.ran.chars().map(|ran| ran == '1').collect(),
    });
    let record = TimedRecord { rounds: rounds.collect(), units: timed.units, missing: timed.missing };
    let samples: u64 = record.rounds.iter().map(|round| u64::from(round.samples)).sum();
    if samples > u64::from(settings.samples) {
        let message = format!("--replay {name}: its rounds have {samples} samples, more than its --spp");
        return Err(Failure::input(message));
    }
    let rendering = prepared.with_renderer(clock, |renderer| renderer.replay(&record))?;
    Ok(Some((rendering, compression)))
}
