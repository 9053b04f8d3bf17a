//! A picture tile by tile: each runs the whole crex by itself, and memory follows the number of threads.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::crex::ThresholdError;
use crate::film::{Film, Planes};
use crate::schedule::Scheduler;
use crate::transport::{Parcel, RANKS, Tracer, Workspace};
use crate::work::Work;

use super::outcome::{Outcome, finish};
use super::{RenderError, Renderer, Rendering};

impl Renderer<'_> {
    /// Renders all tiles. `first`, if it is there, gets the planes that it has as the first half of the samples made them.
    pub(super) fn render_tiles(&self, first: Option<&Mutex<Film>>) -> Result<Rendering, RenderError> {
        let tracer = self.tracer();
        let tiles = self.tiles();
        let half = first.map_or(0, |_| self.first_half());
        let ranges: Vec<Range<u32>> =
            self.ranges(0..half).into_iter().chain(self.ranges(half..self.settings.samples)).collect();
        let film = Mutex::new(self.film());
        let done = AtomicU64::new(0);
        let all = (tiles.len() * ranges.len()) as f64;
        let outcomes: Vec<Outcome> = tiles
            .par_iter()
            .map_init(
                || (Workspace::default(), None::<Parcel>, Planes::default()),
                |(workspace, kept, sums), tile| {
                    let mut outcome = Outcome::default();
                    sums.clear(tile.pixels(), self.stored(), self.has_ambient());
                    for range in &ranges {
                        let parcel = kept.get_or_insert_with(|| self.parcel(*tile, range));
                        parcel.restart(*tile, range.clone(), self.stored(), self.has_ambient());
                        outcome.add(self.run_alone(&tracer, &(0..RANKS), parcel, workspace)?);
                        parcel.add_to(sums, self.settings.ambient);
                        if let (true, Some(first)) = (range.end == half, first) {
                            first.lock().expect("no thread panicked").store(*tile, sums, half);
                        }
                        if let Some(progress) = self.progress {
                            progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / all);
                        }
                    }
                    // A poisoned lock means that a thread panicked, and then so does this one.
                    film.lock().expect("no thread panicked").store(*tile, sums, self.settings.samples);
                    Ok(outcome)
                },
            )
            .collect::<Result<_, ThresholdError>>()?;
        let mut total = Outcome::default();
        outcomes.into_iter().for_each(|outcome| total.add(outcome));
        let film = film.into_inner().expect("no thread panicked");
        Ok(finish(film, total))
    }

    /// Runs the whole crex over one parcel.
    pub(super) fn run_alone(
        &self,
        tracer: &Tracer<'_>,
        ranks: &Range<u16>,
        parcel: &mut Parcel,
        workspace: &mut Workspace,
    ) -> Result<Outcome, ThresholdError> {
        let mut scheduler = Scheduler::new(self.program, self.thresholds)?;
        let primary = self.timed(|| parcel.trace_lattice(tracer, &self.samples(), ranks, workspace));
        while let Some(work) = scheduler.next(&parcel.occupancy()) {
            match work {
                Work::Release => parcel.release(),
                Work::Run(stage) => {
                    let report = self.timed(|| parcel.run(tracer, &stage, workspace));
                    scheduler.report(&report);
                }
            }
        }
        let stopped = scheduler.stopped().to_vec();
        Ok(Outcome { primary, rows: scheduler.into_rows(), left: parcel.left(), stopped })
    }
}
