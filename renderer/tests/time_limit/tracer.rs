//! The tracer of `scene` with prices: every ray takes its component's time, more or less, on a manual clock.

use std::collections::BTreeMap;

use renderer::component::{Component, PerComponent};
use renderer::crex::Program;
use renderer::schedule::{
    Budget, Clock, ManualClock, PictureCosts, ProfileCache, RayKind, StageRow, TimedScheduler, TimedWork,
};
use renderer::work::{BinOccupancy, WorkReport};

use crate::scene::{Ray, Scene};

/// Random numbers by SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Nearly normal, of mean 0 and deviation 1.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// What rays cost.
#[derive(Clone, Debug)]
pub(crate) struct Prices {
    /// Microseconds a ray.
    pub(crate) micros: PerComponent<u64>,
    /// Relative deviation of a run's cost.
    pub(crate) noise: f64,
    /// How many times as much a ray costs as its parent would.
    pub(crate) deeper: f64,
}

impl Prices {
    /// The same for each component, without noise.
    pub(crate) fn flat(micros: u64) -> Self {
        Self { micros: PerComponent::from_fn(|_| micros), noise: 0.0, deeper: 1.0 }
    }
}

pub(crate) struct PricedTracer<'s> {
    scene: &'s Scene,
    visible: PerComponent<Vec<Ray>>,
    held: Vec<Ray>,
    /// Probed rays.
    aside: PerComponent<Vec<Ray>>,
    pub(crate) traced: Vec<Ray>,
    /// Rays traced to no avail, since their task was skipped.
    pub(crate) wasted: usize,
    prices: &'s Prices,
    dice: Dice,
    clock: &'s ManualClock,
}

impl<'s> PricedTracer<'s> {
    pub(crate) fn new(scene: &'s Scene, prices: &'s Prices, clock: &'s ManualClock, seed: u64) -> Self {
        let mut visible = PerComponent::from_fn(|_| Vec::new());
        for pixel in 0..scene.importance.len() as u32 {
            let primary = Ray { pixel, steps: Vec::new() };
            for component in Component::ALL {
                visible[component].extend(scene.children(&primary, component));
            }
        }
        let aside = PerComponent::from_fn(|_| Vec::new());
        let (held, traced) = (Vec::new(), Vec::new());
        Self { scene, visible, held, aside, traced, wasted: 0, prices, dice: Dice(seed), clock }
    }

    fn admits(scene: &Scene, ray: &Ray, threshold: Option<f32>) -> bool {
        threshold.is_none_or(|threshold| scene.importance[ray.pixel as usize] >= threshold)
    }

    pub(crate) fn admitted(&self, threshold: Option<f32>) -> BinOccupancy {
        PerComponent::from_fn(|component| {
            let rays = self.visible[component].iter();
            rays.filter(|ray| Self::admits(self.scene, ray, threshold)).count() as u64
        })
    }

    pub(crate) fn left(&self) -> BinOccupancy {
        assert!(self.held.is_empty());
        assert!(self.aside.iter().all(|(_, rays)| rays.is_empty()), "rays still set aside at the end");
        self.admitted(None)
    }

    fn take(&mut self, component: Component, threshold: Option<f32>, most: usize) -> Vec<Ray> {
        let (mut run, mut stay) = (Vec::new(), Vec::new());
        for ray in std::mem::take(&mut self.visible[component]) {
            let admitted = run.len() < most && Self::admits(self.scene, &ray, threshold);
            if admitted { &mut run } else { &mut stay }.push(ray);
        }
        self.visible[component] = stay;
        run
    }

    /// Lets the time pass that rays take, and says what they spawn.
    fn trace(&mut self, component: Component, rays: &[Ray]) -> WorkReport {
        let scale = (1.0 + self.prices.noise * self.dice.normal()).max(0.0);
        let depth = |ray: &Ray| self.prices.deeper.powi(ray.steps.len() as i32 - 1);
        let micros = rays.iter().map(depth).sum::<f64>() * self.prices.micros[component] as f64 * scale;
        self.clock.advance_ns((micros * 1000.0) as u64);
        let mut report = WorkReport { rays: rays.len() as u64, ..WorkReport::default() };
        for ray in rays {
            for (component, count) in report.spawned.iter_mut() {
                *count += self.scene.spawns(ray, component);
            }
        }
        report
    }

    pub(crate) fn work(&mut self, work: &TimedWork) -> Option<WorkReport> {
        match work {
            TimedWork::Probe { component, threshold, rays } => {
                let run = self.take(*component, *threshold, *rays as usize);
                assert_eq!(run.len() as u64, *rays, "a probe asks for no more than there is");
                let report = self.trace(*component, &run);
                self.aside[*component].extend(run);
                Some(report)
            }
            TimedWork::Discard => {
                for component in Component::ALL {
                    let back = std::mem::take(&mut self.aside[component]);
                    self.wasted += back.len();
                    self.visible[component].extend(back);
                }
                None
            }
            TimedWork::Run(stage) => {
                let mut run = self.take(stage.component, stage.threshold, usize::MAX);
                let report = self.trace(stage.component, &run);
                run.append(&mut self.aside[stage.component]);
                for ray in run {
                    for component in Component::ALL {
                        let children = self.scene.children(&ray, component);
                        let into = if stage.held { &mut self.held } else { &mut self.visible[component] };
                        into.extend(children);
                    }
                    self.traced.push(ray);
                }
                Some(report)
            }
            TimedWork::Release => {
                for ray in std::mem::take(&mut self.held) {
                    let (component, _) = ray.steps[ray.steps.len() - 1];
                    self.visible[component].push(ray);
                }
                None
            }
        }
    }
}

/// What an execution under a time limit did.
pub(crate) struct Timed {
    pub(crate) rows: Vec<StageRow>,
    pub(crate) traced: Vec<Ray>,
    pub(crate) left: BinOccupancy,
    pub(crate) wasted: usize,
    /// When it ended.
    pub(crate) end_s: f64,
    /// Probes asked for.
    pub(crate) probes: Vec<(Component, u64)>,
}

impl Timed {
    /// `T11 [R-] ..`: rays of every stage, `-` for skipped ones.
    pub(crate) fn counts(&self) -> String {
        let row = |row: &StageRow| match row.skipped {
            None => format!("{}{}", row.stage.component, row.report.rays),
            Some(_) => format!("{}-", row.stage.component),
        };
        self.rows.iter().map(row).collect::<Vec<_>>().join(" ")
    }

    pub(crate) fn sorted(&self) -> Vec<Ray> {
        let mut rays = self.traced.clone();
        rays.sort();
        rays
    }

    pub(crate) fn words(&self) -> BTreeMap<String, usize> {
        let mut words = BTreeMap::new();
        self.traced.iter().for_each(|ray| *words.entry(ray.word()).or_default() += 1);
        words
    }
}

/// A profile in which each component's price is known exactly.
pub(crate) fn knowing(prices: &Prices) -> ProfileCache {
    let mut profile = ProfileCache::new("scene", "machine");
    for component in Component::ALL {
        for _ in 0..1000 {
            let seconds = prices.micros[component] as f64 * 1e-6 * 1e6;
            profile.observe(RayKind::Of(component), 1_000_000, seconds);
        }
    }
    profile
}

/// Runs a program for so many seconds.
pub(crate) fn execute(
    program: &Program,
    scene: &Scene,
    prices: &Prices,
    seconds: f64,
    profile: &mut ProfileCache,
    seed: u64,
) -> Timed {
    let clock = ManualClock::default();
    let mut tracer = PricedTracer::new(scene, prices, &clock, seed);
    let budget = Budget::new(&clock, seconds, 0.0);
    let mut costs = PictureCosts::new(profile, program.text());
    let mut scheduler = TimedScheduler::new(program, None, budget, &mut costs).expect("own thresholds");
    let mut probes = Vec::new();
    while let Some(work) = scheduler.next(|threshold| tracer.admitted(threshold)) {
        if let TimedWork::Probe { component, rays, .. } = work {
            probes.push((component, rays));
        }
        if let Some(report) = tracer.work(&work) {
            scheduler.report(&report);
        }
    }
    let rows = scheduler.into_rows();
    Timed { rows, left: tracer.left(), wasted: tracer.wasted, end_s: clock.now_s(), probes, traced: tracer.traced }
}
