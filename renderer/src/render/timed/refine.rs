//! Samples of the whole crex, tile by tile in the order of the ladder, for as long as there is time: every part of it that
//! ends is a whole picture, coarse at first, and every sample in it is complete.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::crex::ThresholdError;
use crate::film::{Block, Plane, Planes};
use crate::schedule::{ProfileCache, RayKind};
use crate::transport::{Parcel, Tracer, Workspace, rank};
use crate::work::WorkReport;

use super::super::Renderer;
use super::super::outcome::{Outcome, add_report};
use super::ladder::{Level, scrambled};

/// Seconds left for something; negative once they are over.
type Left<'a> = &'a (dyn Fn() -> f64 + Sync);

/// What a tile has so far.
struct TileSums {
    sums: Planes,
    /// Samples of each pixel.
    weights: Vec<u32>,
}

/// The refinement of a picture, as far as it has come.
pub(super) struct Refinement {
    tiles: Vec<Block>,
    sums: Vec<Mutex<TileSums>>,
    /// The order of tiles within a level.
    order: Vec<usize>,
    /// The sample number of its first pass.
    first_sample: u32,
    /// Units that are behind it, a unit being a tile at a level: the first so many, all done but the `missing`.
    units: u64,
    /// Units that were under way when the time was over, at most one for each thread, and left no trace.
    missing: Vec<u64>,
    /// What they did.
    pub(super) outcome: Outcome,
    /// Thread seconds for a share of a tile, and the share.
    spent: (f64, f64),
}

impl Refinement {
    pub(super) fn new(renderer: &Renderer<'_>, first_sample: u32) -> Self {
        let tiles = renderer.tiles();
        let empty = |tile: &Block| {
            let mut sums = Planes::default();
            sums.clear(tile.pixels(), renderer.stored(), renderer.has_ambient());
            Mutex::new(TileSums { sums, weights: vec![0; tile.pixels()] })
        };
        let (sums, order) = (tiles.iter().map(empty).collect(), scrambled(&tiles));
        Self {
            tiles,
            sums,
            order,
            first_sample,
            units: 0,
            missing: Vec::new(),
            outcome: Outcome::default(),
            spent: (0.0, 0.0),
        }
    }

    /// The same that leaves out some units.
    pub(super) fn without(self, missing: &[u64]) -> Self {
        Self { missing: missing.to_vec(), ..self }
    }

    /// Units that are behind it, and which of them are not done.
    pub(super) fn units(&self) -> (u64, &[u64]) {
        (self.units, &self.missing)
    }

    /// Levels that are done.
    pub(super) fn levels(&self) -> u64 {
        let first_missing = self.missing.iter().min();
        first_missing.map_or(self.units, |unit| self.units.min(*unit)) / self.tiles.len() as u64
    }

    /// Whole passes that are done.
    pub(super) fn passes(&self) -> u64 {
        Level::passes(self.levels())
    }

    /// Seconds that its rays took, and those that a profile says they take; none if it does not know them all.
    pub(super) fn pace(&self, known: &ProfileCache) -> Option<(f64, f64)> {
        let Outcome { primary, rows, .. } = &self.outcome;
        let threads = rayon::current_num_threads() as f64;
        let parts = rows.iter().map(|row| (RayKind::Of(row.stage.component), &row.report));
        let (mut taken_s, mut expected_s) = (0.0, 0.0);
        for (kind, report) in std::iter::once((RayKind::Primary, primary)).chain(parts) {
            taken_s += report.seconds / threads;
            expected_s += known.predict(kind, report.rays)?.mean_s;
        }
        (expected_s > 0.0).then_some((taken_s, expected_s))
    }

    /// Goes on until so many `units` are behind it or no time is left: a unit is begun while it is expected to fit into
    /// `left_s`, and given up when `whole_s` is over. The very first unit is done in any case. What was learnt about costs goes
    /// into the `profile`.
    pub(super) fn run(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        units: u64,
        (left_s, whole_s): (Left<'_>, Left<'_>),
        profile: &mut ProfileCache,
    ) -> Result<(), ThresholdError> {
        let paths = super::paths(renderer.program, &renderer.settings.limits);
        let mut by_thread = vec![Learnt::default(); rayon::current_num_threads()];
        let mut in_time = true;
        while in_time && self.units < units {
            let index = self.units / self.tiles.len() as u64;
            let end = ((index + 1) * self.tiles.len() as u64).min(units);
            in_time = self.run_level(renderer, tracer, Level::new(index), end, (left_s, whole_s), &mut by_thread)?;
        }
        // One observation for each thread: those of single levels would tell more about the system's interruptions.
        for learnt in &by_thread {
            learnt.teach(profile, &paths, by_thread.len() as f64);
        }
        Ok(())
    }

    /// As [`Self::run`], within a level, which ends before unit `end`. Whether there was time for all of it.
    fn run_level(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        level: Level,
        end: u64,
        (left_s, whole_s): (Left<'_>, Left<'_>),
        by_thread: &mut [Learnt],
    ) -> Result<bool, ThresholdError> {
        let first = self.units;
        let unit_s = if self.spent.1 > 0.0 { self.spent.0 / self.spent.1 * level.share() } else { 0.0 };
        let next = AtomicU64::new(first);
        let out_of_time = AtomicBool::new(false);
        let given_up = Mutex::new(Vec::new());
        let sample = self.first_sample.saturating_add(level.pass);
        let ranks = level.ranks.0..level.ranks.1;
        let this = &*self;
        let done = rayon::broadcast(|_| {
            let (mut workspace, mut outcome, mut learnt) =
                (Workspace::default(), Outcome::default(), Learnt::default());
            let mut parcel: Option<Parcel> = None;
            loop {
                let forced = first == 0 && next.load(Ordering::Relaxed) == 0;
                if !forced && left_s() <= unit_s {
                    out_of_time.store(true, Ordering::Relaxed);
                }
                if !forced && out_of_time.load(Ordering::Relaxed) {
                    break;
                }
                let unit = next.fetch_add(1, Ordering::Relaxed);
                if unit >= end {
                    break;
                }
                if this.missing.contains(&unit) {
                    continue;
                }
                let place = this.order[(unit % this.tiles.len() as u64) as usize];
                let tile = this.tiles[place];
                let parcel = parcel.get_or_insert_with(|| renderer.parcel(tile, &(0..0)));
                parcel.restart(tile, sample..sample + 1, renderer.stored(), renderer.has_ambient());
                let go = || unit == 0 || whole_s() > 0.0;
                // A poisoned lock means that a thread panicked, and then so does this one.
                let Some(done) = renderer.run_alone_while(tracer, &ranks, parcel, &mut workspace, &go)? else {
                    given_up.lock().expect("no thread panicked").push(unit);
                    continue;
                };
                learnt.take(&done);
                outcome.add(done);
                let mut sums = this.sums[place].lock().expect("no thread panicked");
                parcel.add_to(&mut sums.sums, renderer.settings.ambient);
                for (pixel, weight) in sums.weights.iter_mut().enumerate() {
                    let rank = rank(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
                    *weight += u32::from(ranks.contains(&rank));
                }
            }
            Ok((outcome, learnt))
        });
        self.units = next.into_inner().min(end);
        let mut given_up = given_up.into_inner().expect("no thread panicked");
        let undone = given_up.len();
        self.missing.append(&mut given_up);
        self.missing.sort_unstable();
        for (outcome, sum) in done.into_iter().zip(by_thread) {
            let (outcome, learnt) = outcome?;
            sum.add(&learnt);
            self.spent.0 += outcome.primary.seconds + outcome.rows.iter().map(|row| row.report.seconds).sum::<f64>();
            self.outcome.add(outcome);
        }
        self.spent.1 += level.share() * (self.units - first - undone as u64) as f64;
        Ok(self.units == end && undone == 0)
    }

    /// A tile's sums of a plane and the samples in them, pixel by pixel.
    pub(super) fn with_tile<T>(
        &self,
        place: usize,
        plane: Plane,
        take: impl FnOnce(&[crate::color::Rgb], &[u32]) -> T,
    ) -> T {
        let tile = self.sums[place].lock().expect("no thread panicked");
        take(tile.sums.sums(plane), &tile.weights)
    }
}

/// What a thread's rays of each kind cost and spawned.
#[derive(Clone, Default)]
struct Learnt([Kind; RayKind::ALL.len()]);

#[derive(Clone, Copy, Default)]
struct Kind {
    /// Rays, and what they spawned.
    report: WorkReport,
    /// Those of them that were timed without an interruption.
    timed_rays: u64,
}

impl Learnt {
    /// Takes in what a unit did. A stage of a unit is mostly a fraction of a millisecond: if it took many times what the others
    /// did, the thread had to wait for a processor, which says nothing of rays.
    fn take(&mut self, unit: &Outcome) {
        let rows = unit.rows.iter().map(|row| (RayKind::Of(row.stage.component), &row.report));
        for (kind, report) in std::iter::once((RayKind::Primary, &unit.primary)).chain(rows) {
            if report.rays == 0 {
                continue;
            }
            let Kind { report: sum, timed_rays } = &mut self.0[kind.index()];
            add_report(sum, &WorkReport { seconds: 0.0, ..*report });
            let expected_s = sum.seconds * report.rays as f64 / (*timed_rays as f64).max(1.0);
            if *timed_rays > 0 && expected_s > INTERRUPTED_S + INTERRUPTED * report.seconds {
                // It was the others.
                (*timed_rays, sum.seconds) = (0, 0.0);
            }
            if *timed_rays == 0 || report.seconds <= INTERRUPTED_S + INTERRUPTED * expected_s {
                *timed_rays += report.rays;
                sum.seconds += report.seconds;
            }
        }
    }

    fn add(&mut self, other: &Self) {
        for (kind, more) in self.0.iter_mut().zip(&other.0) {
            add_report(&mut kind.report, &more.report);
            kind.timed_rays += more.timed_rays;
        }
    }

    /// Teaches the profile: so many threads share the work, so a ray takes that part of its thread's time.
    fn teach(&self, profile: &mut ProfileCache, paths: &str, threads: f64) {
        for (kind, Kind { report, timed_rays }) in RayKind::ALL.into_iter().zip(&self.0) {
            profile.observe(kind, *timed_rays, report.seconds / threads);
            profile.observe_children(paths, kind, report.rays, &report.spawned);
        }
    }
}

/// A stage of a unit that took longer than so many seconds and so many times what it should was interrupted.
const INTERRUPTED_S: f64 = 1e-3;
const INTERRUPTED: f64 = 8.0;
