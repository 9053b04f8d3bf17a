//! The loop: a scene, a view and a crex become a picture. The only module that sees both the schedule and the rays.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::color::Rgb;
use crate::component::{Component, ComponentSet, PerComponent};
use crate::crex::{Program, Span, ThresholdError};
use crate::film::{Block, Film, Layers, Planes};
use crate::geometry::Aggregate;
use crate::raster::Raster;
use crate::scene::{Scene, View};
use crate::schedule::{Clock, Scheduler, StageRow, merge_rows};
use crate::transport::{Limits, Parcel, Samples, Tracer, Workspace};
use crate::work::{Stage, Work, WorkReport};

/// Edge of an image tile in pixels.
const TILE: usize = 16;

/// Primary rays of a parcel, about: what keeps its bins within a processor's cache, and the cost of its stages small.
const RAYS_PER_PARCEL: usize = 8192;

/// How to render. Same settings, same bits, for any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples for each pixel, at least 1.
    pub samples: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// `-pj`: how much of a pixel's extent its samples cover, in [0, 1].
    pub jitter: f64,
    /// Where paths end and how they branch.
    pub limits: Limits,
    /// `-av`: radiance that stands for diffuse light that is not traced, W/(sr m2).
    pub ambient: Rgb,
    /// `-dv`: whether light sources are seen.
    pub lights_visible: bool,
    /// Under which component light is filed.
    pub layers: Layers,
    /// Threads to use; `None` is one for each processor.
    pub threads: Option<usize>,
}

impl Settings {
    /// The defaults for a picture of this size: one sample for each pixel over its whole extent, Radiance's limits.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            samples: 1,
            seed: 0,
            jitter: 1.0,
            limits: Limits::default(),
            ambient: Rgb::ZERO,
            lights_visible: true,
            layers: Layers::Last,
            threads: None,
        }
    }
}

/// Why settings do not render.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The thresholds do not fit the crex.
    #[error(transparent)]
    Thresholds(#[from] ThresholdError),
    /// A setting is out of its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// Which.
        name: &'static str,
        /// What it is.
        value: String,
        /// Its range, in words.
        expected: &'static str,
    },
    /// The importance map has not the size of the picture.
    #[error(
        "the importance map has {found_width} x {found_height} pixels, the picture {width} x {height}; scale the map"
    )]
    ImportanceSize {
        /// Pixels in a row of the map.
        found_width: usize,
        /// Rows of the map.
        found_height: usize,
        /// Pixels in a row of the picture.
        width: usize,
        /// Rows of the picture.
        height: usize,
    },
    /// The machine refused.
    #[error("could not start {threads} threads: {reason}")]
    Threads {
        /// How many.
        threads: usize,
        /// Why.
        reason: String,
    },
}

/// What a rendering made.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The picture in its layers.
    pub film: Film,
    /// What the primary rays did.
    pub primary: WorkReport,
    /// What every stage did over the whole picture, in the order in which they ran. Seconds are summed over threads.
    pub stages: Vec<StageRow>,
    /// Rays that were spawned and not traced.
    pub left: PerComponent<u64>,
    /// Where the `*`s stand that were stopped before their rays ran out; each deserves a warning.
    pub stopped: Vec<Span>,
}

/// A state of the picture between two stages.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// The stage that has just ended; `None` after the primary rays.
    pub stage: Option<&'a Stage>,
    /// What it did.
    pub report: &'a WorkReport,
    /// The picture so far.
    pub film: &'a Film,
}

/// A scene ready to be rendered.
pub struct Renderer<'a> {
    scene: &'a Scene,
    aggregate: &'a Aggregate,
    view: &'a View,
    program: &'a Program,
    clock: &'a dyn Clock,
    settings: Settings,
    importance: Option<&'a Raster<f32>>,
    thresholds: Option<&'a [f32]>,
    progress: Option<&'a (dyn Fn(f64) + Sync)>,
}

impl<'a> Renderer<'a> {
    /// What to render, and the clock that measures it. Checks the settings.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(
        scene: &'a Scene,
        aggregate: &'a Aggregate,
        view: &'a View,
        program: &'a Program,
        clock: &'a dyn Clock,
        settings: Settings,
    ) -> Result<Self, RenderError> {
        check(&settings)?;
        let (importance, thresholds, progress) = (None, None, None);
        Ok(Self { scene, aggregate, view, program, clock, settings, importance, thresholds, progress })
    }

    /// Modulates `{ }` by a map of values in [0, 1], of the picture's size.
    ///
    /// # Errors
    /// If the size or a value does not fit.
    pub fn with_importance(self, map: &'a Raster<f32>) -> Result<Self, RenderError> {
        let Settings { width, height, .. } = self.settings;
        if (map.width(), map.height()) != (width, height) {
            let (found_width, found_height) = (map.width(), map.height());
            return Err(RenderError::ImportanceSize { found_width, found_height, width, height });
        }
        if let Some(value) = map.values().iter().find(|value| !(0.0..=1.0).contains(*value)) {
            return Err(out_of_range("a value of the importance map", value, "a number from 0 to 1"));
        }
        Ok(Self { importance: Some(map), ..self })
    }

    /// Sets the thresholds of the members of all `{ }`, from left to right.
    ///
    /// # Errors
    /// If their number does not fit the crex, or a value does not lie in [0, 1].
    pub fn with_thresholds(self, thresholds: &'a [f32]) -> Result<Self, RenderError> {
        Scheduler::new(self.program, Some(thresholds))?;
        Ok(Self { thresholds: Some(thresholds), ..self })
    }

    /// Has `progress` called with the fraction of the work that is done, from any thread.
    #[must_use]
    pub fn with_progress(self, progress: &'a (dyn Fn(f64) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Renders the picture. Each image tile runs the whole crex by itself, so memory follows the number of threads and
    /// not the picture.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn render(&self) -> Result<Rendering, RenderError> {
        self.in_threads(|| self.render_tiles())?
    }

    /// Renders the picture stage by stage, and shows its state after each. The rays of all tiles are held at once:
    /// memory follows the number of hits. The picture is the same to the last bit as that of [`Self::render`].
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn render_stages(&self, show: &mut (dyn FnMut(Snapshot<'_>) + Send)) -> Result<Rendering, RenderError> {
        self.in_threads(|| self.render_globally(show))?
    }

    fn in_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, RenderError> {
        let threads = self.settings.threads.unwrap_or(0);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| RenderError::Threads { threads, reason: error.to_string() })?;
        Ok(pool.install(work))
    }

    fn render_tiles(&self) -> Result<Rendering, RenderError> {
        let tracer = self.tracer();
        let tiles = self.tiles();
        let ranges = self.ranges();
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
                        outcome.add(self.run_alone(&tracer, parcel, workspace)?);
                        parcel.add_to(sums, self.settings.ambient);
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
    fn run_alone(
        &self,
        tracer: &Tracer<'_>,
        parcel: &mut Parcel,
        workspace: &mut Workspace,
    ) -> Result<Outcome, ThresholdError> {
        let mut scheduler = Scheduler::new(self.program, self.thresholds)?;
        let primary = self.timed(|| parcel.trace_primary(tracer, &self.samples(), workspace));
        while let Some(work) = scheduler.next(&parcel.occupancy()) {
            match work {
                Work::Release => parcel.release(),
                Work::Run(stage) => {
                    let report = self.timed(|| parcel.run(tracer, &stage, self.importance, workspace));
                    scheduler.report(&report);
                }
            }
        }
        let stopped = scheduler.stopped().to_vec();
        Ok(Outcome { primary, rows: scheduler.into_rows(), left: parcel.left(), stopped })
    }

    fn render_globally(&self, show: &mut (dyn FnMut(Snapshot<'_>) + Send)) -> Result<Rendering, RenderError> {
        let tracer = self.tracer();
        let mut scheduler = Scheduler::new(self.program, self.thresholds)?;
        let ranges = self.ranges();
        let mut parcels: Vec<Parcel> = self
            .tiles()
            .into_iter()
            .flat_map(|tile| ranges.iter().map(move |range| (tile, range)))
            .map(|(tile, range)| self.parcel(tile, range))
            .collect();
        let samples = self.samples();
        let primary =
            self.all_parcels(&mut parcels, |parcel, workspace| parcel.trace_primary(&tracer, &samples, workspace));
        let mut film = self.film();
        self.develop(&parcels, &mut film);
        show(Snapshot { stage: None, report: &primary, film: &film });
        while let Some(work) = scheduler.next(&occupancy(&parcels)) {
            match work {
                Work::Release => parcels.par_iter_mut().for_each(Parcel::release),
                Work::Run(stage) => {
                    let report = self.all_parcels(&mut parcels, |parcel, workspace| {
                        parcel.run(&tracer, &stage, self.importance, workspace)
                    });
                    scheduler.report(&report);
                    self.develop(&parcels, &mut film);
                    show(Snapshot { stage: Some(&stage), report: &report, film: &film });
                }
            }
        }
        let mut left = PerComponent::default();
        parcels.iter().for_each(|parcel| add_counts(&mut left, &parcel.left()));
        let stopped = scheduler.stopped().to_vec();
        Ok(finish(film, Outcome { primary, rows: scheduler.into_rows(), left, stopped }))
    }

    /// Does something with every parcel, and adds up what it did, in their order.
    fn all_parcels(
        &self,
        parcels: &mut [Parcel],
        work: impl Fn(&mut Parcel, &mut Workspace) -> WorkReport + Sync,
    ) -> WorkReport {
        let reports: Vec<WorkReport> = parcels
            .par_iter_mut()
            .map_init(Workspace::default, |workspace, parcel| self.timed(|| work(parcel, workspace)))
            .collect();
        let mut sum = WorkReport::default();
        reports.iter().for_each(|report| add_report(&mut sum, report));
        sum
    }

    /// Makes the picture of what the parcels have brought so far.
    fn develop(&self, parcels: &[Parcel], film: &mut Film) {
        let ranges = self.ranges().len();
        let mut sums = Planes::default();
        for (tile, parcels) in self.tiles().into_iter().zip(parcels.chunks_exact(ranges)) {
            sums.clear(tile.pixels(), self.stored(), self.has_ambient());
            parcels.iter().for_each(|parcel| parcel.add_to(&mut sums, self.settings.ambient));
            film.store(tile, &sums, self.settings.samples);
        }
    }

    fn timed(&self, work: impl FnOnce() -> WorkReport) -> WorkReport {
        let start = self.clock.now_s();
        let report = work();
        WorkReport { seconds: self.clock.now_s() - start, ..report }
    }

    fn tracer(&self) -> Tracer<'a> {
        Tracer {
            scene: self.scene,
            aggregate: self.aggregate,
            limits: self.settings.limits,
            ambient: self.settings.ambient,
            lights_visible: self.settings.lights_visible,
            layers: self.settings.layers,
            seed: self.settings.seed,
        }
    }

    fn samples(&self) -> Samples<'a> {
        let Settings { width, height, jitter, .. } = self.settings;
        Samples { view: self.view, width, height, jitter }
    }

    fn film(&self) -> Film {
        Film::new(self.settings.width, self.settings.height, self.stored(), self.has_ambient())
    }

    fn parcel(&self, tile: Block, range: &std::ops::Range<u32>) -> Parcel {
        Parcel::new(tile, range.clone(), self.stored(), self.has_ambient())
    }

    fn has_ambient(&self) -> bool {
        self.settings.ambient != Rgb::ZERO
    }

    /// The components that the scene can spawn and the crex runs.
    fn stored(&self) -> ComponentSet {
        let spawned = self.scene.components(self.settings.limits.glossy_threshold);
        let run = self.program.components();
        Component::ALL.into_iter().filter(|&component| spawned.contains(component) && run.contains(component)).collect()
    }

    /// The tiles of the picture, row by row.
    fn tiles(&self) -> Vec<Block> {
        let Settings { width, height, .. } = self.settings;
        let edge = |start: usize, end: usize| TILE.min(end - start);
        let rows = (0..height).step_by(TILE);
        rows.flat_map(|y| {
            (0..width).step_by(TILE).map(move |x| Block { x, y, width: edge(x, width), height: edge(y, height) })
        })
        .collect()
    }

    /// The sample numbers in pieces that keep a parcel's bins small.
    fn ranges(&self) -> Vec<std::ops::Range<u32>> {
        let rays = TILE * TILE * self.settings.limits.most_rays() as usize;
        let step = u32::try_from((RAYS_PER_PARCEL / rays).max(1)).expect("at most the rays of a parcel");
        let samples = self.settings.samples;
        (0..samples).step_by(step as usize).map(|start| start..samples.min(start.saturating_add(step))).collect()
    }
}

/// What a parcel, a tile or a picture did.
#[derive(Default)]
struct Outcome {
    primary: WorkReport,
    rows: Vec<StageRow>,
    left: PerComponent<u64>,
    stopped: Vec<Span>,
}

impl Outcome {
    fn add(&mut self, other: Self) {
        add_report(&mut self.primary, &other.primary);
        add_counts(&mut self.left, &other.left);
        self.rows = merge_rows([std::mem::take(&mut self.rows), other.rows]);
        for span in other.stopped {
            if !self.stopped.contains(&span) {
                self.stopped.push(span);
            }
        }
    }
}

fn add_counts(sum: &mut PerComponent<u64>, counts: &PerComponent<u64>) {
    for (component, sum) in sum.iter_mut() {
        *sum += counts[component];
    }
}

fn add_report(sum: &mut WorkReport, report: &WorkReport) {
    sum.rays += report.rays;
    sum.seconds += report.seconds;
    add_counts(&mut sum.spawned, &report.spawned);
}

fn occupancy(parcels: &[Parcel]) -> PerComponent<u64> {
    let mut sum = PerComponent::default();
    parcels.iter().for_each(|parcel| add_counts(&mut sum, &parcel.occupancy()));
    sum
}

fn finish(mut film: Film, outcome: Outcome) -> Rendering {
    let Outcome { primary, rows: stages, left, mut stopped } = outcome;
    let reached = stages.iter().filter(|row| row.report.rays > 0).map(|row| row.stage.component).collect();
    film.keep(reached);
    stopped.sort_by_key(|span| (span.start, span.end));
    Rendering { film, primary, stages, left, stopped }
}

fn out_of_range(name: &'static str, value: impl std::fmt::Display, expected: &'static str) -> RenderError {
    RenderError::Setting { name, value: value.to_string(), expected }
}

fn check(settings: &Settings) -> Result<(), RenderError> {
    let Limits { least_weight, glossy_threshold, glossy_rays, .. } = settings.limits;
    let within =
        |holds: bool, name, value: f64, expected| if holds { Ok(()) } else { Err(out_of_range(name, value, expected)) };
    if settings.width == 0 || settings.height == 0 || u32::try_from(settings.width.max(settings.height)).is_err() {
        let value = format!("{} x {}", settings.width, settings.height);
        return Err(out_of_range("the picture's size", value, "at least 1 x 1 pixel"));
    }
    within(settings.samples > 0, "the number of samples", 0.0, "at least 1")?;
    within((0.0..=1.0).contains(&settings.jitter), "the pixel jitter (-pj)", settings.jitter, "a number from 0 to 1")?;
    let positive = |x: f64| (0.0..f64::INFINITY).contains(&x);
    within(positive(least_weight), "the least weight (-lw)", least_weight, "a number, 0 or more")?;
    within(positive(glossy_threshold), "the specular threshold (-st)", glossy_threshold, "a number, 0 or more")?;
    within(positive(glossy_rays), "the number of glossy rays (-ss)", glossy_rays, "a number, 0 or more")?;
    for value in settings.ambient.to_array() {
        within(positive(value), "the ambient value (-av)", value, "three numbers, 0 or more")?;
    }
    let all = f64::from(settings.samples) * f64::from(settings.limits.diffuse_rays).max(glossy_rays).max(1.0);
    within(all < 4_294_967_296.0, "samples times rays for each hit (-ad, -ss)", all, "less than 2^32")
}
