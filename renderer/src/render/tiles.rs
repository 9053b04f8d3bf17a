//! A picture tile by tile: each runs the whole crex by itself, and memory follows the number of threads.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::crex::ThresholdError;
use crate::film::{Block, Film, Planes};
use crate::schedule::Scheduler;
use crate::transport::{Parcel, RANKS, Tracer, Workspace};
use crate::work::{Work, WorkReport};

use super::outcome::{Outcome, finish};
use super::{RenderError, Renderer, Rendering};

/// Tiles traced before what they did is added up: so many that threads seldom wait for each other, so few that what they
/// hand over is small in memory (100 MB, with planes for everything).
const TILES_AT_ONCE: usize = 4096;

/// What a thread keeps from tile to tile.
#[derive(Default)]
pub(super) struct Bench {
    workspace: Workspace,
    parcel: Option<Parcel>,
    sums: Planes,
}

impl Bench {
    /// What the last tile brought, summed over its samples.
    pub(super) fn sums(&self) -> &Planes {
        &self.sums
    }
}

impl Renderer<'_> {
    /// Renders all tiles. `first`, if it is there, gets the planes that it has as the first half of the samples made them.
    pub(super) fn render_tiles(&self, first: Option<&Mutex<Film>>) -> Result<Rendering, RenderError> {
        let half = first.map_or(0, |_| self.first_half());
        let ranges: Vec<Range<u32>> =
            self.ranges(0..half).into_iter().chain(self.ranges(half..self.settings.samples)).collect();
        // A poisoned lock means that a thread panicked, and then so does this one.
        let store = |film: &Mutex<Film>, tile: Block, sums: &Planes, samples: u32| {
            film.lock().expect("no thread panicked").store(tile, sums, samples);
        };
        let film = Mutex::new(self.film());
        let trace = |bench: &mut Bench, tile: Block| {
            let outcome = self.trace_tile(tile, &ranges, bench, &mut |samples, sums| {
                if let (true, Some(first)) = (samples == half, first) {
                    store(first, tile, sums, half);
                }
            })?;
            store(&film, tile, bench.sums(), self.settings.samples);
            Ok((outcome, ()))
        };
        let total = self.trace_tiles(&self.tiles(), trace, &mut |_, ()| Ok::<_, RenderError>(()))?;
        let film = film.into_inner().expect("no thread panicked");
        Ok(finish(film, total))
    }

    /// Does `trace` for each tile, on all threads, and hands over what it made, in the order of the tiles; adds up what was
    /// done.
    pub(super) fn trace_tiles<T: Send, E: From<RenderError>>(
        &self,
        tiles: &[Block],
        trace: impl Fn(&mut Bench, Block) -> Result<(Outcome, T), ThresholdError> + Sync,
        take: &mut dyn FnMut(Block, T) -> Result<(), E>,
    ) -> Result<Outcome, E> {
        let done = AtomicU64::new(0);
        let traced = |bench: &mut Bench, &tile: &Block| {
            let traced = trace(bench, tile);
            if let Some(progress) = self.progress {
                progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / tiles.len() as f64);
            }
            traced
        };
        let mut total = Outcome::default();
        for tiles in tiles.chunks(TILES_AT_ONCE) {
            let made: Result<Vec<(Outcome, T)>, ThresholdError> =
                tiles.par_iter().map_init(Bench::default, traced).collect();
            let (outcomes, made): (Vec<_>, Vec<_>) = made.map_err(RenderError::from)?.into_iter().unzip();
            total.add_all(outcomes);
            tiles.iter().zip(made).try_for_each(|(&tile, made)| take(tile, made))?;
        }
        Ok(total)
    }

    /// Runs the whole crex over a tile, a range of samples after another; `show` gets the sums, and of how many samples
    /// they are, after each.
    pub(super) fn trace_tile(
        &self,
        tile: Block,
        ranges: &[Range<u32>],
        bench: &mut Bench,
        show: &mut dyn FnMut(u32, &Planes),
    ) -> Result<Outcome, ThresholdError> {
        let tracer = self.tracer();
        let Bench { workspace, parcel: kept, sums } = bench;
        sums.clear(tile.pixels(), self.stored(), self.has_ambient());
        let mut outcomes = Vec::with_capacity(ranges.len());
        for range in ranges {
            let parcel = kept.get_or_insert_with(|| self.parcel(tile, range));
            parcel.restart(tile, range.clone(), self.stored(), self.has_ambient());
            outcomes.push(self.run_alone(&tracer, &(0..RANKS), parcel, workspace)?);
            parcel.add_to(sums, self.settings.ambient);
            show(range.end, sums);
        }
        let mut outcome = Outcome::default();
        outcome.add_all(outcomes);
        Ok(outcome)
    }

    /// Runs the whole crex over one parcel.
    pub(super) fn run_alone(
        &self,
        tracer: &Tracer<'_>,
        ranks: &Range<u16>,
        parcel: &mut Parcel,
        workspace: &mut Workspace,
    ) -> Result<Outcome, ThresholdError> {
        let outcome = self.run_alone_while(tracer, ranks, parcel, workspace, &|| true)?;
        Ok(outcome.expect("nothing stops it"))
    }

    /// The same for as long as `go` says so; `None` if it was stopped, and then the parcel holds no picture.
    pub(super) fn run_alone_while(
        &self,
        tracer: &Tracer<'_>,
        ranks: &Range<u16>,
        parcel: &mut Parcel,
        workspace: &mut Workspace,
        go: &dyn Fn() -> bool,
    ) -> Result<Option<Outcome>, ThresholdError> {
        let mut scheduler = Scheduler::new(self.program, self.thresholds)?;
        let primary = self.timed(|| parcel.trace_lattice(tracer, &self.samples(), ranks, workspace));
        while let Some(work) = scheduler.next(&parcel.occupancy()) {
            match work {
                Work::Release => parcel.release(),
                Work::Run(stage) => {
                    let begun_s = self.clock.now_s();
                    let (report, complete) = parcel.run_while(tracer, &stage, workspace, go);
                    if !complete {
                        return Ok(None);
                    }
                    scheduler.report(&WorkReport { seconds: self.clock.now_s() - begun_s, ..report });
                }
            }
        }
        let stopped = scheduler.stopped().to_vec();
        Ok(Some(Outcome { primary, rows: scheduler.into_rows(), left: parcel.left(), stopped }))
    }
}
