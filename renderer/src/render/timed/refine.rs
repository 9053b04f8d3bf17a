//! Samples of the whole crex, tile by tile in the order of the ladder, for as long as there is time: every part of it that
//! ends is a whole picture, coarse at first, and every sample in it is complete.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::crex::ThresholdError;
use crate::film::{Block, Plane, Planes};
use crate::schedule::{Cost, PictureCosts, Place, ProfileCache, RayKind};
use crate::transport::{Parcel, Tracer, Workspace, rank};
use crate::work::WorkReport;

use super::super::Renderer;
use super::super::outcome::{Outcome, add_report};
use super::ladder::{Level, SPRINKLED, scrambled, scrambled_blocks};

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
    /// The same within a level of the sprinkle, where the tiles of a block are traced together; and the blocks.
    sprinkled: Vec<usize>,
    blocks: Vec<(Block, Range<u64>)>,
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
        let (mut sprinkled, mut blocks) = (Vec::with_capacity(tiles.len()), Vec::new());
        for (block, mut places) in scrambled_blocks(&tiles) {
            let first = sprinkled.len() as u64;
            sprinkled.append(&mut places);
            blocks.push((block, first..sprinkled.len() as u64));
        }
        Self {
            tiles,
            sums,
            order,
            sprinkled,
            blocks,
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

    /// Rays of every place for each primary ray, primary rays included, as far as it has come.
    pub(super) fn rays_per_primary(&self) -> impl Iterator<Item = (Place, f64)> {
        let Outcome { primary, rows, .. } = &self.outcome;
        let all = std::iter::once((Place::PRIMARY, primary.rays))
            .chain(rows.iter().map(|row| (Place::of(&row.stage), row.report.rays)));
        let primary = primary.rays as f64;
        all.filter(|(_, rays)| *rays > 0).map(move |(place, rays)| (place, rays as f64 / primary))
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

    /// Goes on until so many `units` are behind it or no time is left: work is begun while it is expected to fit into
    /// `left_s`, and given up when `whole_s` is over. The very first is done in any case. `costs` learn.
    pub(super) fn run(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        units: u64,
        (left_s, whole_s): (Left<'_>, Left<'_>),
        costs: &mut PictureCosts<'_>,
    ) -> Result<(), ThresholdError> {
        let mut by_thread = vec![Learnt::default(); rayon::current_num_threads()];
        let mut in_time = true;
        while in_time && self.units < units {
            let index = self.units / self.tiles.len() as u64;
            let end = ((index + 1) * self.tiles.len() as u64).min(units);
            in_time = self.run_level(renderer, tracer, index, end, (left_s, whole_s), &mut by_thread)?;
        }
        // One observation for each thread: those of single levels would tell more about the system's interruptions.
        for learnt in &by_thread {
            learnt.teach(costs, by_thread.len() as f64);
        }
        Ok(())
    }

    /// Units from the next one on that are traced together: the tiles of a block in the sprinkle, later one by one.
    fn chunks(&self, index: u64, end: u64) -> Vec<Range<u64>> {
        let first = self.units;
        if index >= SPRINKLED {
            return (first..end).map(|unit| unit..unit + 1).collect();
        }
        let before = index * self.tiles.len() as u64;
        let chunks =
            self.blocks.iter().map(|(_, units)| (before + units.start).max(first)..(before + units.end).min(end));
        chunks.filter(|chunk| !chunk.is_empty()).collect()
    }

    /// The tiles of a chunk that are not to be left out, in one block if they are all of it.
    fn areas(&self, index: u64, chunk: &Range<u64>) -> Vec<(Block, Vec<usize>)> {
        let before = index * self.tiles.len() as u64;
        let order = if index < SPRINKLED { &self.sprinkled } else { &self.order };
        let wanted = chunk.clone().filter(|unit| !self.missing.contains(unit));
        let places: Vec<usize> = wanted.map(|unit| order[(unit - before) as usize]).collect();
        let whole = self.blocks.iter().find(|(_, units)| index < SPRINKLED && before + units.start == chunk.start);
        let pixels: usize = places.iter().map(|&place| self.tiles[place].pixels()).sum();
        match whole.filter(|(block, _)| block.pixels() == pixels) {
            Some((block, _)) => vec![(*block, places)],
            None => places.into_iter().map(|place| (self.tiles[place], vec![place])).collect(),
        }
    }

    /// As [`Self::run`], within a level, which ends before unit `end`. Whether there was time for all of it.
    fn run_level(
        &mut self,
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        index: u64,
        end: u64,
        (left_s, whole_s): (Left<'_>, Left<'_>),
        by_thread: &mut [Learnt],
    ) -> Result<bool, ThresholdError> {
        let level = Level::new(index);
        let first = self.units;
        let chunks = self.chunks(index, end);
        let longest = chunks.iter().map(|chunk| chunk.end - chunk.start).max().unwrap_or(0) as f64;
        let chunk_s = if self.spent.1 > 0.0 { self.spent.0 / self.spent.1 * level.share() * longest } else { 0.0 };
        let next = AtomicUsize::new(0);
        let out_of_time = AtomicBool::new(false);
        let given_up = Mutex::new(Vec::new());
        let sample = self.first_sample.saturating_add(level.pass);
        let ranks = level.ranks.0..level.ranks.1;
        let this = &*self;
        let done = rayon::broadcast(|_| {
            let (mut workspace, mut outcome, mut learnt) =
                (Workspace::default(), Outcome::default(), Learnt::default());
            let mut parcel: Option<Parcel> = None;
            let mut sums = Planes::default();
            loop {
                let forced = first == 0 && next.load(Ordering::Relaxed) == 0;
                if !forced && left_s() <= chunk_s {
                    out_of_time.store(true, Ordering::Relaxed);
                }
                if !forced && out_of_time.load(Ordering::Relaxed) {
                    break;
                }
                let Some(chunk) = chunks.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
                let go = || chunk.start == 0 || whole_s() > 0.0;
                for (area, places) in this.areas(index, chunk) {
                    let parcel = parcel.get_or_insert_with(|| renderer.parcel(area, &(0..0)));
                    parcel.restart(area, sample..sample + 1, renderer.stored(), renderer.has_ambient());
                    // A poisoned lock means that a thread panicked, and then so does this one.
                    let Some(done) = renderer.run_alone_while(tracer, &ranks, parcel, &mut workspace, &go)? else {
                        given_up.lock().expect("no thread panicked").extend(chunk.clone());
                        break;
                    };
                    learnt.take(&done, index < SPRINKLED);
                    outcome.add(done);
                    sums.clear(area.pixels(), renderer.stored(), renderer.has_ambient());
                    parcel.add_to(&mut sums, renderer.settings.ambient);
                    places.iter().for_each(|&place| this.take_tile(place, &ranks, &sums, &area));
                }
            }
            Ok((outcome, learnt))
        });
        self.units = chunks.get(next.into_inner()).map_or(end, |chunk| chunk.start);
        let mut given_up: Vec<u64> = given_up.into_inner().expect("no thread panicked");
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

    /// Adds to a tile what was traced in the pixels of some ranks of the area around it.
    fn take_tile(&self, place: usize, ranks: &Range<u16>, traced: &Planes, area: &Block) {
        let tile = self.tiles[place];
        let mut sums = self.sums[place].lock().expect("no thread panicked");
        sums.sums.add_part(&tile, traced, area);
        for (pixel, weight) in sums.weights.iter_mut().enumerate() {
            let rank = rank(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
            *weight += u32::from(ranks.contains(&rank));
        }
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

/// What a thread's rays cost, in the sprinkle and later, at each place of the crex, and what those of each kind spawned.
#[derive(Clone, Default)]
struct Learnt {
    sprinkled: BTreeMap<Place, Cost>,
    refined: BTreeMap<Place, Cost>,
    reports: [WorkReport; RayKind::ALL.len()],
}

impl Learnt {
    /// Takes in what a chunk did. A stage of it is mostly a fraction of a millisecond: if it took many times what the others
    /// did, the thread had to wait for a processor, which says nothing of rays.
    fn take(&mut self, chunk: &Outcome, sprinkled: bool) {
        let costs = if sprinkled { &mut self.sprinkled } else { &mut self.refined };
        let rows = chunk.rows.iter().map(|row| (Place::of(&row.stage), &row.report));
        for (place, report) in std::iter::once((Place::PRIMARY, &chunk.primary)).chain(rows) {
            if report.rays == 0 {
                continue;
            }
            let counts = WorkReport { seconds: 0.0, ..*report };
            add_report(&mut self.reports[place.kind().index()], &counts);
            let cost = costs.entry(place).or_default();
            let expected_s = cost.mean_s() * report.rays as f64;
            if cost.observations() == 1 && expected_s > INTERRUPTED_S + INTERRUPTED * report.seconds {
                // It was the first one. After several that agree, one that is cheap is just that.
                *cost = Cost::default();
            }
            if cost.rays() == 0 || report.seconds <= INTERRUPTED_S + INTERRUPTED * expected_s {
                cost.observe(report.rays, report.seconds);
            }
        }
    }

    fn add(&mut self, other: &Self) {
        for (costs, more) in [(&mut self.sprinkled, &other.sprinkled), (&mut self.refined, &other.refined)] {
            more.iter().for_each(|(place, more)| costs.entry(*place).or_default().add(more));
        }
        self.reports.iter_mut().zip(&other.reports).for_each(|(report, more)| add_report(report, more));
    }

    /// Teaches: so many threads share the work, so a ray takes that part of its thread's time.
    fn teach(&self, costs: &mut PictureCosts<'_>, threads: f64) {
        for (&place, cost) in &self.sprinkled {
            costs.sprinkled(place, &cost.scaled(threads.recip()));
        }
        let paths = costs.paths().to_owned();
        let profile = costs.profile_mut();
        for (kind, report) in RayKind::ALL.into_iter().zip(&self.reports) {
            let all = self.sprinkled.iter().chain(&self.refined).filter(|(place, _)| place.kind() == kind);
            let (rays, seconds) = all.fold((0, 0.0), |(rays, seconds), (_, cost)| {
                (rays + cost.rays(), seconds + cost.mean_s() * cost.rays() as f64)
            });
            profile.observe(kind, rays, seconds / threads);
            profile.observe_children(&paths, kind, report.rays, &report.spawned);
        }
    }
}

/// A stage of a chunk that took longer than so many seconds and so many times what it should was interrupted.
const INTERRUPTED_S: f64 = 1e-3;
const INTERRUPTED: f64 = 8.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cheap_blocks_do_not_hide_dear_ones_and_interruptions_are_left_out() {
        let block = |seconds| {
            let primary = WorkReport { rays: 60, seconds, ..WorkReport::default() };
            Outcome { primary, ..Outcome::default() }
        };
        let mean_s = |blocks: &[f64]| {
            let mut learnt = Learnt::default();
            blocks.iter().for_each(|&seconds| learnt.take(&block(seconds), true));
            60.0 * learnt.sprinkled[&Place::PRIMARY].mean_s()
        };
        let near = |found: f64, seconds: f64| assert!((found / seconds - 1.0).abs() < 1e-9, "{found} {seconds}");
        // Sky between what is lit, and before it.
        let mut mixed = vec![3e-4; 41];
        mixed[20] = 1.2e-5;
        near(mean_s(&mixed), (40.0 * 3e-4 + 1.2e-5) / 41.0);
        mixed.swap(0, 20);
        near(mean_s(&mixed), (40.0 * 3e-4 + 1.2e-5) / 41.0);
        // The same where a block takes longer than an interruption must.
        let mut long = vec![3e-2; 41];
        long[20] = 1.2e-3;
        near(mean_s(&long), (40.0 * 3e-2 + 1.2e-3) / 41.0);
        // The thread waited, at first or later.
        let mut waited = vec![3e-4; 41];
        for at in [0, 20] {
            waited[at] = 5e-2;
        }
        near(mean_s(&waited), 3e-4);
    }
}
