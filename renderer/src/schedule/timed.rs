//! A crex's walk under a time limit: every task is predicted first, and runs whole or is skipped.

use crate::component::{Component, PerComponent};
use crate::crex::{Cursor, Program, Span, Task, ThresholdError};
use crate::work::{BinOccupancy, Stage, Work, WorkReport};

use super::budget::Budget;
use super::cost::{Cost, RayKind};
use super::here::PictureCosts;
use super::place::Place;
use super::profile::Prediction;
use super::rows::{Skipped, StageRow};

/// The part of a bin that is traced to learn what its rays cost: the paper's 1 %.
pub const PROBE_SHARE: f64 = 0.01;

/// Probes into which that part is cut, so that their spread shows.
pub const PROBES: u32 = 4;

/// Rays of a probe, at least: fewer tell more about the clock than about the rays.
pub const LEAST_PROBE: u64 = 32;

/// The part of the time left that a probe may take if its rays cost as much as the costliest kind known.
pub const PROBE_TIME: f64 = 0.01;

/// What the tracer is to do next under a time limit.
#[derive(Clone, Debug, PartialEq)]
pub enum TimedWork {
    /// Trace this many rays, drawn as if at random from the visible rays of a component's bin that the threshold admits,
    /// and set them and all that they find aside. They are not in the bin any more.
    Probe {
        /// Whose bin.
        component: Component,
        /// Only rays of pixels with at least this importance.
        threshold: Option<f32>,
        /// How many.
        rays: u64,
    },
    /// Forget what was set aside: its rays go back to their bins, and nothing that they found remains.
    Discard,
    /// Trace what the stage admits of its component's bin. What was set aside for this component now belongs to the
    /// stage: its light to the picture, its children where the stage's go.
    Run(Stage),
    /// As [`Work::Release`].
    Release,
}

/// How far the task is that the cursor stands before or in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// It may need probes before it can be decided.
    Weighing,
    /// It is to run or to be skipped, and has not begun.
    Decided { runs: bool },
    /// It has begun.
    Under { runs: bool },
}

/// What a call of [`TimedScheduler::report`] will be about.
#[derive(Clone, Debug)]
enum Pending {
    Probe(Component),
    Run(Stage),
}

/// Decides what the tracer does next within a [`Budget`], and keeps a row of every stage, run or skipped.
///
/// Every single run of a component outside `[ ]`, and every outermost `[ ]`, is one task. A task runs if the time left is
/// no less than the bound of its prediction; else it is skipped, its rays stay in their bins, and the next task is
/// considered. A component of which nothing is known is probed first: a part of its bin is traced, and kept only if the
/// task runs.
///
/// Call [`next`](Self::next), do the work, give [`report`](Self::report) what a probe or run did, again. Time between the
/// two calls is what the work is taken to have cost, by the budget's clock. A decision looks at a few numbers and at no
/// ray.
#[derive(Debug)]
pub struct TimedScheduler<'a, 'p> {
    cursor: Cursor<'a>,
    budget: Budget<'a>,
    costs: &'a mut PictureCosts<'p>,
    rows: Vec<StageRow>,
    /// Where the rows of the task begin that is under way.
    task_rows: usize,
    /// What the time left was when it was decided on, and what it was not to exceed.
    margin_s: (f64, f64),
    phase: Phase,
    /// What the task was predicted to take from when it was decided on, if it could be.
    prediction: Option<Prediction>,
    /// What of that falls to each of its components; to the first run of each, since later ones find nothing.
    parts: PerComponent<Option<Prediction>>,
    /// Seconds that its runs have taken since.
    taken_s: f64,
    /// Probes for it: how many, and what those not yet kept did.
    probes: PerComponent<(u32, WorkReport)>,
    /// Seconds that its probes took.
    probed_s: PerComponent<f64>,
    /// What was handed out and when, not yet reported.
    pending: Option<(Pending, f64)>,
    /// A task was cut off: all that comes is skipped.
    over: bool,
}

impl<'a, 'p> TimedScheduler<'a, 'p> {
    /// A walk along `program` within `budget`, that predicts by `costs` and teaches them. `thresholds` as for
    /// [`Scheduler`](super::Scheduler).
    ///
    /// # Errors
    /// As [`Program::check_thresholds`].
    pub fn new(
        program: &'a Program,
        thresholds: Option<&[f32]>,
        budget: Budget<'a>,
        costs: &'a mut PictureCosts<'p>,
    ) -> Result<Self, ThresholdError> {
        let mut cursor = Cursor::new(program);
        if let Some(thresholds) = thresholds {
            cursor = cursor.with_thresholds(thresholds)?;
        }
        Ok(Self {
            cursor,
            budget,
            costs,
            rows: Vec::new(),
            task_rows: 0,
            margin_s: (0.0, 0.0),
            phase: Phase::Under { runs: true },
            prediction: None,
            parts: PerComponent::default(),
            taken_s: 0.0,
            probes: PerComponent::default(),
            probed_s: PerComponent::default(),
            pending: None,
            over: false,
        })
    }

    /// What to do next; none when the crex has ended. `admitted` counts the visible rays in each bin, of pixels of at least
    /// an importance if one is given; rays set aside are not counted.
    pub fn next(&mut self, admitted: impl Fn(Option<f32>) -> BinOccupancy) -> Option<TimedWork> {
        loop {
            if !matches!(self.phase, Phase::Decided { .. })
                && let Some(task) = self.cursor.task()
            {
                if matches!(self.phase, Phase::Under { .. }) {
                    self.end_task();
                }
                let bins = admitted(task.threshold);
                if let Some(probe) = self.probe(&task, &bins) {
                    return Some(probe);
                }
                let runs = self.decide(&task, &bins);
                self.task_rows = self.rows.len();
                self.phase = Phase::Decided { runs };
                if !runs && self.probes.iter().any(|(_, (times, _))| *times > 0) {
                    return Some(TimedWork::Discard);
                }
            }
            if let Phase::Decided { runs } = self.phase {
                self.phase = Phase::Under { runs };
            }
            let Some(work) = self.cursor.next() else {
                self.end_task();
                return None;
            };
            match work {
                Work::Release => return Some(TimedWork::Release),
                Work::Run(stage) if self.phase == (Phase::Under { runs: true }) => {
                    self.pending = Some((Pending::Run(stage.clone()), self.budget.now_s()));
                    return Some(TimedWork::Run(stage));
                }
                Work::Run(stage) => {
                    self.cursor.report(0);
                    let report = WorkReport::default();
                    let (predicted_s, bound_s) = self.expected_s();
                    self.rows.push(StageRow { stage, report, predicted_s, bound_s, skipped: Some(Skipped::Time) });
                }
            }
        }
    }

    /// What the last [`TimedWork::Probe`] or [`TimedWork::Run`] did: rays that it traced now, not those set aside before.
    /// The seconds are not looked at.
    pub fn report(&mut self, report: &WorkReport) {
        let Some((pending, since_s)) = self.pending.take() else {
            return;
        };
        let mut report = WorkReport { seconds: self.budget.now_s() - since_s, ..*report };
        match pending {
            Pending::Probe(component) => {
                self.costs.profile_mut().observe(RayKind::Of(component), report.rays, report.seconds);
                let (times, sum) = &mut self.probes[component];
                *times += 1;
                add(sum, &report);
                self.probed_s[component] += report.seconds;
            }
            Pending::Run(stage) => {
                self.costs.ran(Place::of(&stage), report.rays, report.seconds);
                self.taken_s += report.seconds;
                let (_, bound_s) = self.expected_s();
                let part = self.parts[stage.component].take();
                let part_s = part.map_or(0.0, |part| part.mean_s + self.probed_s[stage.component]);
                let predicted_s = self.prediction.map(|_| part_s);
                // What the probes did is the stage's now, and counted once.
                let (_, kept) = &mut self.probes[stage.component];
                add(&mut report, &std::mem::take(kept));
                self.cursor.report(report.rays);
                self.rows.push(StageRow { stage, report, predicted_s, bound_s, skipped: None });
            }
        }
    }

    /// Whether the stage just handed out is the first of its task: from here on all must be undone if the task is cut off.
    #[must_use]
    pub fn begins_task(&self) -> bool {
        self.rows.len() == self.task_rows
    }

    /// The part of the time left that the task under way was predicted not to exceed; 1 is all of it.
    #[must_use]
    pub fn risk(&self) -> f64 {
        let (bound_s, left_s) = self.margin_s;
        if bound_s > 0.0 { bound_s / left_s.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// In place of [`report`](Self::report): the task was cut off since it overran the time, and all that it did has been
    /// undone. All that comes after it is skipped. `part` is what the last stage did until then; it teaches the profile, and a
    /// task cut off counts as one that took at least as long as the time it was given.
    pub fn cut_off(&mut self, part: &WorkReport) {
        let Some((pending, since_s)) = self.pending.take() else {
            return;
        };
        let seconds = self.budget.now_s() - since_s;
        let Pending::Run(stage) = pending else {
            return;
        };
        self.costs.ran(Place::of(&stage), part.rays, seconds);
        self.taken_s += seconds;
        if let Some(prediction) = self.prediction
            && prediction.mean_s > 0.0
        {
            self.costs.record(&prediction, self.taken_s.max(prediction.mean_s));
        }
        for row in &mut self.rows[self.task_rows..] {
            row.report = WorkReport::default();
            row.skipped = Some(Skipped::Time);
        }
        let (predicted_s, bound_s) = self.expected_s();
        let skipped = Some(Skipped::Time);
        self.rows.push(StageRow { stage, report: WorkReport::default(), predicted_s, bound_s, skipped });
        self.cursor.report(0);
        self.phase = Phase::Under { runs: false };
        self.over = true;
    }

    /// As [`Scheduler::stopped`](super::Scheduler::stopped).
    #[must_use]
    pub fn stopped(&self) -> &[Span] {
        self.cursor.stopped()
    }

    /// The rows of all stages so far, in the order in which they ran or were skipped; seconds by the budget's clock.
    #[must_use]
    pub fn into_rows(self) -> Vec<StageRow> {
        self.rows
    }

    /// What the task under way is predicted to take, and not to exceed, with the seconds that its probes took already.
    fn expected_s(&self) -> (Option<f64>, Option<f64>) {
        let (bound_s, _) = self.margin_s;
        let probed_s: f64 = self.probed_s.iter().map(|(_, seconds)| seconds).sum();
        let whole = |seconds: f64| self.prediction.map(|_| seconds + probed_s);
        (self.prediction.and_then(|prediction| whole(prediction.mean_s)), whole(bound_s))
    }

    /// A probe that the task needs before it can be predicted.
    fn probe(&mut self, task: &Task, bins: &BinOccupancy) -> Option<TimedWork> {
        if self.over {
            return None;
        }
        let left_s = self.budget.left_s();
        let component = task.components.iter().find(|&component| {
            let (times, _) = self.probes[component];
            let unknown = || self.costs.predict(place(task, component), bins[component]).is_none();
            (times > 0 || unknown()) && times < PROBES && bins[component] > 0 && left_s > 0.0
        })?;
        let costs = RayKind::ALL.into_iter().filter_map(|kind| self.costs.profile().cost(kind));
        let costliest_s = costs.map(Cost::mean_s).fold(0.0, f64::max);
        let affordable = (PROBE_TIME * left_s / costliest_s).max(1.0);
        let share = (bins[component] as f64 * PROBE_SHARE / f64::from(PROBES)).ceil().max(LEAST_PROBE as f64);
        let rays = (share.min(affordable) as u64).min(bins[component]);
        self.pending = Some((Pending::Probe(component), self.budget.now_s()));
        Some(TimedWork::Probe { component, threshold: task.threshold, rays })
    }

    /// Whether the task runs.
    fn decide(&mut self, task: &Task, bins: &BinOccupancy) -> bool {
        let mut whole = Some(Prediction::default());
        self.parts = PerComponent::default();
        for component in task.components.iter() {
            let part = self.costs.predict(place(task, component), bins[component]);
            self.parts[component] = part;
            whole = whole.zip(part).map(|(whole, part)| whole.and(part));
        }
        self.prediction = whole;
        let nothing_to_do = task.components.iter().all(|component| bins[component] == 0);
        let left_s = self.budget.left_s();
        let bound_s = whole.map_or(f64::INFINITY, |whole| self.costs.bound_s(&whole));
        self.margin_s = (bound_s, left_s);
        !self.over && (nothing_to_do || bound_s <= left_s)
    }

    /// Learns how far the last task's prediction was off, and makes room for the next task.
    fn end_task(&mut self) {
        if let Some(prediction) = self.prediction.take()
            && self.phase == (Phase::Under { runs: true })
            && prediction.mean_s > 0.0
        {
            self.costs.record(&prediction, self.taken_s);
        }
        self.phase = Phase::Weighing;
        self.taken_s = 0.0;
        self.probes = PerComponent::default();
        self.probed_s = PerComponent::default();
    }
}

/// Where a component of a task runs.
fn place(task: &Task, component: Component) -> Place {
    let (letter, run) = task.places[component];
    Place::new(component, letter, run)
}

fn add(sum: &mut WorkReport, report: &WorkReport) {
    sum.rays += report.rays;
    sum.seconds += report.seconds;
    for (component, count) in sum.spawned.iter_mut() {
        *count += report.spawned[component];
    }
}
