//! `--stats`: what a rendering did, as one JSON object.

use std::collections::BTreeMap;

use renderer::component::PerComponent;
use renderer::crex::Program;
use renderer::render::{Account, Settings};
use renderer::scene::Holdings;
use renderer::schedule::{Skipped, StageRow, executed};
use renderer::work::WorkReport;
use serde::Serialize;

use crate::timed::TimedStats;

/// The object.
#[derive(Debug, Serialize)]
pub(crate) struct Stats {
    /// The crex as given.
    crex: String,
    /// The crex that was carried out.
    executed: String,
    width: usize,
    height: usize,
    spp: u32,
    seed: u64,
    threads: usize,
    /// From the program's start until everything was written but this.
    wall_s: f64,
    /// Most memory that the process had, where the system tells.
    peak_bytes: Option<u64>,
    deadline_s: Option<f64>,
    /// Rays that still waited at the end.
    left: Counts,
    /// A hash of what the scene was made from.
    scene: String,
    /// What the scene holds in memory; absent where several machines had it.
    #[serde(skip_serializing_if = "Option::is_none")]
    holds: Option<Holdings>,
    /// What `{ }` heeded: the hash of the map, and by which rule.
    modulation: String,
    /// What a clock decided, under a time limit.
    timed: Option<TimedStats>,
    stages: Vec<StageStats>,
}

/// Rays by component.
type Counts = BTreeMap<String, u64>;

/// One run of a component over the whole picture.
#[derive(Debug, Serialize)]
struct StageStats {
    stage: String,
    /// The letter's place in the crex, bytes, end exclusive.
    span: [usize; 2],
    /// How often this letter has run, from 1.
    run: u64,
    /// The `[ ]` that it belongs to.
    group: Option<String>,
    rays: u64,
    spawned: Counts,
    /// Summed over threads; under a time limit by the clock.
    seconds: f64,
    predicted_s: Option<f64>,
    /// What its task was predicted not to exceed, 19 times in 20.
    bound_s: Option<f64>,
    skipped: SkippedStats,
}

/// `false`, or why.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum SkippedStats {
    No(bool),
    Because(&'static str),
}

impl Stats {
    /// The object of a finished rendering; the wall clock and the memory are read by the caller.
    pub(crate) fn new(program: &Program, settings: &Settings, account: &Account, threads: usize) -> Self {
        let primary = StageStats::new("primary".to_owned(), [0, 0], 1, &account.primary);
        let rows = account.stages.iter().map(|row| StageStats::of_row(program, row));
        Self {
            crex: program.text().to_owned(),
            executed: executed(program, &account.stages).crex,
            width: settings.width,
            height: settings.height,
            spp: settings.samples,
            seed: settings.seed,
            threads,
            wall_s: 0.0,
            peak_bytes: peak_bytes(),
            deadline_s: None,
            left: counts(&account.left),
            scene: String::new(),
            modulation: String::new(),
            holds: None,
            timed: None,
            stages: std::iter::once(primary).chain(rows).collect(),
        }
    }

    /// The same of a scene, and of what `{ }` heeded.
    pub(crate) fn with_scene(self, scene: String, modulation: String) -> Self {
        Self { scene, modulation, ..self }
    }

    /// The same with what the scene holds.
    pub(crate) fn with_holdings(self, holds: Holdings) -> Self {
        Self { holds: Some(holds), ..self }
    }

    /// The same of a run under a time limit, in seconds, or of one repeated.
    pub(crate) fn with_time(self, deadline_s: Option<f64>, timed: TimedStats) -> Self {
        Self { deadline_s, timed: Some(timed), ..self }
    }

    /// The same with the time since the program's start, seconds.
    pub(crate) fn with_wall_s(self, wall_s: f64) -> Self {
        Self { wall_s, ..self }
    }

    /// The same with the most memory that another process had, bytes.
    pub(crate) fn with_peak_bytes(self, peak_bytes: Option<u64>) -> Self {
        Self { peak_bytes, ..self }
    }
}

impl StageStats {
    fn new(stage: String, span: [usize; 2], run: u64, report: &WorkReport) -> Self {
        Self {
            stage,
            span,
            run,
            group: None,
            rays: report.rays,
            spawned: counts(&report.spawned),
            seconds: report.seconds,
            predicted_s: None,
            bound_s: None,
            skipped: SkippedStats::No(false),
        }
    }

    fn of_row(program: &Program, row: &StageRow) -> Self {
        let StageRow { stage, report, predicted_s, bound_s, skipped } = row;
        let (start, end) = stage.span;
        Self {
            group: stage.group.map(|group| program.group_text(group).to_owned()),
            predicted_s: *predicted_s,
            bound_s: *bound_s,
            skipped: match skipped {
                Some(Skipped::Time) => SkippedStats::Because("time"),
                None => SkippedStats::No(false),
            },
            ..Self::new(stage.component.to_string(), [start, end], stage.run, report)
        }
    }
}

fn counts(rays: &PerComponent<u64>) -> Counts {
    rays.iter().map(|(component, &count)| (component.to_string(), count)).collect()
}

/// The high-water mark of the process's memory; Linux tells it in a file.
pub(crate) fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}
