//! Samples of the whole crex, tile by tile in the order of the ladder, for as long as there is time: every part of it that
//! ends is a whole picture, coarse at first, and every sample in it is complete.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::component::Component;
use crate::crex::ThresholdError;
use crate::film::{Block, Plane, Planes};
use crate::schedule::{ProfileCache, RayKind};
use crate::transport::{Parcel, Tracer, Workspace, rank};

use super::super::Renderer;
use super::super::outcome::Outcome;
use super::ladder::{Level, scrambled};

/// A unit is begun if this many times its expected seconds are left: units differ from place to place in a picture.
const GUARD: f64 = 3.0;

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
    /// Units that are done, a unit being a tile at a level; always the first so many.
    units: u64,
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
        Self { tiles, sums, order, first_sample, units: 0, outcome: Outcome::default(), spent: (0.0, 0.0) }
    }

    /// Units that are done.
    pub(super) fn units(&self) -> u64 {
        self.units
    }

    /// Levels that are done.
    pub(super) fn levels(&self) -> u64 {
        self.units / self.tiles.len() as u64
    }

    /// Goes on until so many `units` are done or `left_s` says that no time is left. The very first unit is done in any case.
    /// Returns whether time was left. What was learnt about costs goes into the `profile`.
    pub(super) fn run(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        units: u64,
        left_s: &(dyn Fn() -> f64 + Sync),
        profile: &mut ProfileCache,
    ) -> Result<bool, ThresholdError> {
        let mut by_thread = vec![Outcome::default(); rayon::current_num_threads()];
        let mut in_time = true;
        while in_time && self.units < units {
            let index = self.levels();
            let end = ((index + 1) * self.tiles.len() as u64).min(units);
            in_time = self.run_level(renderer, tracer, Level::new(index), end, left_s, &mut by_thread)?;
        }
        // One observation for each thread: those of single levels would tell more about the system's interruptions.
        for outcome in &by_thread {
            learn(profile, outcome, by_thread.len() as f64);
        }
        Ok(in_time)
    }

    /// As [`Self::run`], within a level, which ends before unit `end`.
    fn run_level(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        level: Level,
        end: u64,
        left_s: &(dyn Fn() -> f64 + Sync),
        by_thread: &mut [Outcome],
    ) -> Result<bool, ThresholdError> {
        let first = self.units;
        let guard_s = if self.spent.1 > 0.0 { GUARD * self.spent.0 / self.spent.1 * level.share() } else { 0.0 };
        let next = AtomicU64::new(first);
        let out_of_time = AtomicBool::new(false);
        let sample = self.first_sample.saturating_add(level.pass);
        let ranks = level.ranks.0..level.ranks.1;
        let this = &*self;
        let done = rayon::broadcast(|_| {
            let (mut workspace, mut outcome) = (Workspace::default(), Outcome::default());
            let mut parcel: Option<Parcel> = None;
            loop {
                let forced = first == 0 && next.load(Ordering::Relaxed) == 0;
                if !forced && left_s() <= guard_s {
                    out_of_time.store(true, Ordering::Relaxed);
                }
                // Every unit that is claimed is done, so those that are done are the first ones.
                if !forced && out_of_time.load(Ordering::Relaxed) {
                    break;
                }
                let unit = next.fetch_add(1, Ordering::Relaxed);
                if unit >= end {
                    break;
                }
                let place = this.order[(unit % this.tiles.len() as u64) as usize];
                let tile = this.tiles[place];
                let parcel = parcel.get_or_insert_with(|| renderer.parcel(tile, &(0..0)));
                parcel.restart(tile, sample..sample + 1, renderer.stored(), renderer.has_ambient());
                outcome.add(renderer.run_alone(tracer, &ranks, parcel, &mut workspace)?);
                // A poisoned lock means that a thread panicked, and then so does this one.
                let mut sums = this.sums[place].lock().expect("no thread panicked");
                parcel.add_to(&mut sums.sums, renderer.settings.ambient);
                for (pixel, weight) in sums.weights.iter_mut().enumerate() {
                    let rank = rank(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
                    *weight += u32::from(ranks.contains(&rank));
                }
            }
            Ok(outcome)
        });
        self.units = next.into_inner().min(end);
        for (outcome, sum) in done.into_iter().zip(by_thread) {
            let outcome = outcome?;
            sum.add(outcome.clone());
            self.spent.0 += outcome.primary.seconds + outcome.rows.iter().map(|row| row.report.seconds).sum::<f64>();
            self.outcome.add(outcome);
        }
        self.spent.1 += level.share() * (self.units - first) as f64;
        Ok(self.units == end)
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

/// Teaches the profile what rays cost: so many threads share the work, so a ray takes that part of its thread's time.
fn learn(profile: &mut ProfileCache, outcome: &Outcome, threads: f64) {
    let Outcome { primary, rows, .. } = outcome;
    profile.observe(RayKind::Primary, primary.rays, primary.seconds / threads, &primary.spawned);
    for component in Component::ALL {
        let mut sum = crate::work::WorkReport::default();
        for row in rows.iter().filter(|row| row.stage.component == component) {
            super::super::outcome::add_report(&mut sum, &row.report);
        }
        profile.observe(RayKind::Of(component), sum.rays, sum.seconds / threads, &sum.spawned);
    }
}
