//! Some samples of every pixel, stage by stage over the whole picture: where tasks are predicted, and run or are skipped.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::component::{Component, PerComponent};
use crate::crex::ThresholdError;
use crate::film::Planes;
use crate::schedule::{Budget, PictureCosts, Place, Scheduler, Skipped, TimedScheduler, TimedWork};
use crate::transport::{Parcel, Tracer, Workspace};
use crate::work::{BinOccupancy, Stage, StageKey, Work, WorkReport};

use super::super::Renderer;
use super::super::outcome::{Outcome, add_counts, add_report, occupancy};
use super::RoundRecord;
use super::ladder::scrambled;

/// A task is made undoable if it was predicted to need more than this part of the time left: only then can it overrun it.
const RISKY: f64 = 0.1;

/// What a round brought.
pub(super) struct Round {
    /// The sums of every tile; of tiles whose primary rays were not traced there are none.
    pub(super) sums: Vec<Option<Planes>>,
    pub(super) outcome: Outcome,
    pub(super) record: RoundRecord,
    /// When its last task had ended, by the budget's clock.
    pub(super) ended_s: f64,
    /// Rays that were traced only to learn what they cost.
    pub(super) probed_rays: u64,
}

/// What the parcels have brought, and the rays that wait in them.
type Standing = (Vec<Planes>, PerComponent<u64>);

/// The parcels of a round on their way.
struct Batch<'a, 'r> {
    renderer: &'a Renderer<'r>,
    tracer: &'a Tracer<'r>,
    parcels: Vec<Parcel>,
    /// What the picture was before the task under way, and the rays that waited: for tasks that are likely to be cut off.
    before: Option<Standing>,
    /// The same, once the task was cut off: what the parcels hold since then counts for nothing.
    cut: Option<Standing>,
    /// A task was cut off that was not likely to be: there is no picture but that of the primary rays, which left so many
    /// rays waiting.
    spoilt: Option<PerComponent<u64>>,
    /// Rays that the primary rays left waiting.
    first_left: PerComponent<u64>,
    /// What probes did for the task under way, and the part of each bin that they took.
    probed: PerComponent<(WorkReport, f64)>,
    /// Rays of all probes.
    probed_rays: u64,
}

impl Round {
    /// Carries out a round. `share` is the time that its tasks are admitted to, `whole` all that is left: work is cut off at
    /// the end of that. `None`: even its primary rays are not predicted to fit.
    pub(super) fn run(
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        first_sample: u32,
        samples: u32,
        budgets: (Budget<'_>, Budget<'_>),
        costs: &mut PictureCosts<'_>,
    ) -> Result<Option<Self>, ThresholdError> {
        let (share, whole) = budgets;
        let pixels = (renderer.settings.width * renderer.settings.height) as u64 * u64::from(samples);
        let predicted = costs.predict(Place::PRIMARY, pixels);
        if predicted.is_none_or(|predicted| costs.bound_s(&predicted) > share.left_s()) {
            return Ok(None);
        }
        let mut batch = Batch::new(renderer, tracer, first_sample, samples);
        let begun_s = whole.now_s();
        let threads = rayon::current_num_threads() as f64;
        let parcel_s = predicted.map_or(0.0, |it| it.mean_s) / batch.parcels.len() as f64 * threads;
        let (primary, tiles) = batch.trace_primary(batch.parcels.len(), &|| whole.left_s() > parcel_s);
        let primary = WorkReport { seconds: whole.now_s() - begun_s, ..primary };
        costs.ran(Place::PRIMARY, primary.rays, primary.seconds);
        if let Some(predicted) = predicted {
            costs.record(&predicted, primary.seconds);
        }
        let mut rows = Vec::new();
        let mut stopped = Vec::new();
        if tiles == batch.parcels.len() {
            let mut scheduler = TimedScheduler::new(renderer.program, renderer.thresholds, share, costs)?;
            while let Some(work) = scheduler.next(|threshold| batch.admitted(threshold)) {
                match work {
                    TimedWork::Release => batch.parcels.par_iter_mut().for_each(Parcel::release),
                    TimedWork::Discard => batch.probed = PerComponent::default(),
                    TimedWork::Probe { component, threshold, rays } => {
                        scheduler.report(&batch.probe(component, threshold, rays));
                    }
                    TimedWork::Run(stage) => batch.run_timed(&stage, &mut scheduler, whole),
                }
            }
            stopped = scheduler.stopped().to_vec();
            rows = scheduler.into_rows();
        }
        let ended_s = whole.now_s();
        if batch.spoilt.is_some() {
            for row in &mut rows {
                (row.report, row.skipped) = (WorkReport::default(), Some(Skipped::Time));
            }
        }
        let ran = rows.iter().map(|row| row.skipped.is_none()).collect();
        let record = RoundRecord { first_sample, samples, tiles, ran };
        let probed_rays = batch.probed_rays;
        let (sums, left) = batch.finish(tiles);
        Ok(Some(Self { sums, outcome: Outcome { primary, rows, left, stopped }, record, ended_s, probed_rays }))
    }

    /// Carries out a round once more as it is recorded.
    pub(super) fn replay(
        renderer: &Renderer<'_>,
        tracer: &Tracer<'_>,
        record: &RoundRecord,
    ) -> Result<Self, ThresholdError> {
        let mut batch = Batch::new(renderer, tracer, record.first_sample, record.samples);
        let (primary, tiles) = batch.trace_primary(record.tiles, &|| true);
        let mut rows = Vec::new();
        let mut stopped = Vec::new();
        if tiles == batch.parcels.len() {
            let scheduler = Scheduler::new(renderer.program, renderer.thresholds)?;
            let mut scheduler = scheduler.with_decisions(&record.ran);
            while let Some(work) = scheduler.next(&occupancy(&batch.parcels)) {
                match work {
                    Work::Release => batch.parcels.par_iter_mut().for_each(Parcel::release),
                    Work::Run(stage) => {
                        let (report, _) = batch.run(&stage, &|| true);
                        scheduler.report(&report);
                    }
                }
            }
            stopped = scheduler.stopped().to_vec();
            rows = scheduler.into_rows();
        }
        let (sums, left) = batch.finish(tiles);
        let (outcome, record) = (Outcome { primary, rows, left, stopped }, record.clone());
        Ok(Self { sums, outcome, record, ended_s: 0.0, probed_rays: 0 })
    }

    /// What became of a component.
    pub(super) fn state(&self, component: Component) -> State {
        if self.sums.iter().any(Option::is_none) {
            return State::Nothing;
        }
        let rows = || self.outcome.rows.iter().filter(|row| row.stage.component == component);
        let skipped = rows().any(|row| row.skipped.is_some());
        let ran = rows().any(|row| row.report.rays > 0);
        match (skipped, ran) {
            (false, _) => State::Whole,
            (true, true) => State::Partly,
            (true, false) => State::Nothing,
        }
    }
}

/// How far a component's rays were traced in a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum State {
    /// None of them: its tasks were skipped.
    Nothing,
    /// Some of its tasks ran and others were skipped.
    Partly,
    /// All that the crex asks for.
    Whole,
}

impl<'a, 'r> Batch<'a, 'r> {
    /// A parcel for each tile, in scrambled order, so that nothing shows of where a stage was cut off.
    fn new(renderer: &'a Renderer<'r>, tracer: &'a Tracer<'r>, first_sample: u32, samples: u32) -> Self {
        let tiles = renderer.tiles();
        let numbers = first_sample..first_sample + samples;
        let parcels = scrambled(&tiles).into_iter().map(|place| renderer.parcel(tiles[place], &numbers)).collect();
        let (before, cut, spoilt) = (None, None, None);
        let (first_left, probed) = (PerComponent::default(), PerComponent::default());
        Self { renderer, tracer, parcels, before, cut, spoilt, first_left, probed, probed_rays: 0 }
    }

    /// Traces the primary rays of at most so many parcels, the first ones, while `go` says so; what that took and how many
    /// have been traced.
    fn trace_primary(&mut self, most: usize, go: &(dyn Fn() -> bool + Sync)) -> (WorkReport, usize) {
        let samples = self.renderer.samples();
        let tracer = self.tracer;
        let most = most.min(self.parcels.len());
        // Claimed in order, so that the parcels done are the first ones; each by one thread alone.
        let waiting: Vec<_> = self.parcels[..most].iter_mut().map(std::sync::Mutex::new).collect();
        let next = AtomicUsize::new(0);
        let reports = rayon::broadcast(|_| {
            let (mut workspace, mut sum) = (Workspace::default(), WorkReport::default());
            while go() {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let Some(parcel) = waiting.get(place) else { break };
                let mut parcel = parcel.lock().expect("no thread panicked");
                add_report(&mut sum, &parcel.trace_primary(tracer, &samples, &mut workspace));
            }
            sum
        });
        let mut sum = WorkReport::default();
        reports.iter().for_each(|report| add_report(&mut sum, report));
        self.first_left = self.left();
        (sum, next.into_inner().min(most))
    }

    /// Rays that a stage would run now, less those that probes have run already.
    fn admitted(&self, threshold: Option<f32>) -> BinOccupancy {
        let mut sum = PerComponent::default();
        self.parcels.iter().for_each(|parcel| add_counts(&mut sum, &parcel.admitted(self.tracer, threshold)));
        PerComponent::from_fn(|component| sum[component].saturating_sub(self.probed[component].0.rays))
    }

    /// Traces copies of about so many rays of a bin; what they find is forgotten, and found again if the task runs.
    fn probe(&mut self, component: Component, threshold: Option<f32>, rays: u64) -> WorkReport {
        let all = self.admitted(threshold)[component] + self.probed[component].0.rays;
        let begin = self.probed[component].1;
        let share = begin..begin + rays as f64 / (all as f64).max(1.0);
        let tracer = self.tracer;
        let stage = Stage { threshold, ..probing(component) };
        let reports: Vec<WorkReport> = self
            .parcels
            .par_iter()
            .map_init(Workspace::default, |workspace, parcel| {
                let mut part = parcel.copy_of(tracer, component, &share, threshold);
                part.run(tracer, &stage, workspace)
            })
            .collect();
        let mut sum = WorkReport::default();
        reports.iter().for_each(|report| add_report(&mut sum, report));
        self.probed_rays += sum.rays;
        let (probed, end) = &mut self.probed[component];
        add_report(probed, &sum);
        *end = share.end;
        sum
    }

    /// Runs a stage within the time. If that ends before the stage does, its task leaves nothing behind: it is undone, or, if
    /// nobody thought that likely enough to pay for a copy, all that the round has brought is given up but its primary rays.
    fn run_timed(&mut self, stage: &Stage, scheduler: &mut TimedScheduler<'_, '_>, whole: Budget<'_>) {
        if scheduler.begins_task() {
            self.before = (scheduler.risk() > RISKY).then(|| self.saved());
        }
        let (report, ended) = self.run(stage, &|| whole.left_s() > 0.0);
        if ended {
            let (probed, _) = std::mem::take(&mut self.probed[stage.component]);
            let mut spawned = report.spawned;
            spawned.iter_mut().for_each(|(component, count)| *count -= probed.spawned[component].min(*count));
            scheduler.report(&WorkReport { rays: report.rays - probed.rays.min(report.rays), spawned, ..report });
        } else {
            scheduler.cut_off(&report);
            self.cut = self.before.take();
            self.spoilt = self.cut.is_none().then_some(self.first_left);
        }
    }

    /// Runs a stage while `go` says so; what it did, and whether it came to its end.
    fn run(&mut self, stage: &Stage, go: &(dyn Fn() -> bool + Sync)) -> (WorkReport, bool) {
        let tracer = self.tracer;
        let cut = AtomicBool::new(false);
        let reports: Vec<WorkReport> = self
            .parcels
            .par_iter_mut()
            .map_init(Workspace::default, |workspace, parcel| {
                if parcel.occupancy()[stage.component] == 0 {
                    return WorkReport::default();
                }
                let (report, complete) =
                    parcel.run_while(tracer, stage, workspace, &|| !cut.load(Ordering::Relaxed) && go());
                if !complete {
                    cut.store(true, Ordering::Relaxed);
                }
                report
            })
            .collect();
        let mut sum = WorkReport::default();
        reports.iter().for_each(|report| add_report(&mut sum, report));
        (sum, !cut.into_inner())
    }

    /// What the parcels have brought, and the rays that wait in them.
    fn saved(&self) -> Standing {
        (self.parcels.par_iter().map(|parcel| self.developed(parcel)).collect(), self.left())
    }

    fn left(&self) -> PerComponent<u64> {
        let mut left = PerComponent::default();
        self.parcels.iter().for_each(|parcel| add_counts(&mut left, &parcel.left()));
        left
    }

    fn developed(&self, parcel: &Parcel) -> Planes {
        let mut sums = Planes::default();
        sums.clear(parcel.pixels(), self.renderer.stored(), self.renderer.has_ambient());
        parcel.add_to(&mut sums, self.renderer.settings.ambient);
        sums
    }

    /// The sums of the first `done` parcels, in the places of their tiles; as they were before a task that was cut off.
    fn finish(mut self, done: usize) -> (Vec<Option<Planes>>, PerComponent<u64>) {
        let (planes, left) = match self.cut.take() {
            Some(before) => before,
            None => self.saved(),
        };
        let left = self.spoilt.unwrap_or(left);
        let mut sums: Vec<Option<Planes>> = planes.iter().map(|_| None).collect();
        let order = scrambled(&self.renderer.tiles());
        for (place, planes) in order.into_iter().zip(planes).take(done) {
            sums[place] = Some(planes);
        }
        (sums, left)
    }
}

/// The stage of a probe: its rays' children are forgotten, so where they would go does not matter.
fn probing(component: Component) -> Stage {
    let key = StageKey::from_words(std::iter::empty());
    Stage { key, component, span: (0, 0), run: 0, threshold: None, held: false, group: None }
}
