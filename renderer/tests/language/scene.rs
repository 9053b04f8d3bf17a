//! A tracer without geometry: a ray is the word of its components, and a rule says what each one spawns.

use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

use renderer::component::{Component, PerComponent};
use renderer::crex::{Program, compile};
use renderer::schedule::{Scheduler, StageRow};
use renderer::work::{BinOccupancy, Work, WorkReport};

/// Which of a hit's children, and of which component.
pub(crate) type Step = (Component, u64);

/// A ray: the pixel that it contributes to, and the steps from the primary hit.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Ray {
    pub(crate) pixel: u32,
    pub(crate) steps: Vec<Step>,
}

impl Ray {
    pub(crate) fn word(&self) -> String {
        self.steps.iter().map(|(component, _)| component.letter()).collect()
    }
}

/// What hits spawn.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spawning {
    /// One ray of each component, up to words of this length.
    Each { length: usize },
    /// None, one or two rays of each component as if at random, up to words of this length.
    Random { seed: u64, length: usize },
    /// One ray of this component, for ever.
    Endless(Component),
}

/// Pixels with their importance, and what their rays spawn.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) importance: Vec<f32>,
    pub(crate) spawning: Spawning,
}

impl Scene {
    /// Every hit spawns one ray of each component, up to words of `length`; one pixel of importance 1.
    pub(crate) fn each(length: usize) -> Self {
        Self { importance: vec![1.0], spawning: Spawning::Each { length } }
    }

    /// How many rays of a component the hit at the end of `ray` spawns.
    pub(crate) fn spawns(&self, ray: &Ray, component: Component) -> u64 {
        match self.spawning {
            Spawning::Each { length } => u64::from(ray.steps.len() < length),
            Spawning::Endless(only) => u64::from(component == only),
            Spawning::Random { seed, length } => {
                if ray.steps.len() >= length {
                    return 0;
                }
                let mut hasher = DefaultHasher::new();
                let steps: Vec<_> = ray.steps.iter().map(|&(component, index)| (component as u8, index)).collect();
                (seed, ray.pixel, steps, component as u8).hash(&mut hasher);
                [0, 0, 0, 1, 1, 2][(hasher.finish() >> 32) as usize % 6]
            }
        }
    }

    pub(crate) fn children(&self, ray: &Ray, component: Component) -> Vec<Ray> {
        (0..self.spawns(ray, component))
            .map(|index| {
                let steps = ray.steps.iter().copied().chain([(component, index)]).collect();
                Ray { pixel: ray.pixel, steps }
            })
            .collect()
    }
}

/// Bins, as a renderer keeps them.
pub(crate) struct Tracer<'s> {
    scene: &'s Scene,
    visible: PerComponent<Vec<Ray>>,
    held: Vec<Ray>,
    /// Every ray traced, primary rays apart, in order.
    pub(crate) traced: Vec<Ray>,
}

impl<'s> Tracer<'s> {
    /// Traces the primary rays of some pixels.
    pub(crate) fn new(scene: &'s Scene, pixels: impl Iterator<Item = u32>) -> Self {
        let mut visible = PerComponent::from_fn(|_| Vec::new());
        for pixel in pixels {
            let primary = Ray { pixel, steps: Vec::new() };
            for component in Component::ALL {
                visible[component].extend(scene.children(&primary, component));
            }
        }
        Self { scene, visible, held: Vec::new(), traced: Vec::new() }
    }

    pub(crate) fn occupancy(&self) -> BinOccupancy {
        PerComponent::from_fn(|component| self.visible[component].len() as u64)
    }

    fn admits(&self, ray: &Ray, threshold: Option<f32>) -> bool {
        threshold.is_none_or(|threshold| self.scene.importance[ray.pixel as usize] >= threshold)
    }

    /// Does a piece of work; a report if it was a run.
    pub(crate) fn work(&mut self, work: &Work) -> Option<WorkReport> {
        let stage = match work {
            Work::Run(stage) => stage,
            Work::Release => {
                for ray in std::mem::take(&mut self.held) {
                    let (component, _) = ray.steps[ray.steps.len() - 1];
                    self.visible[component].push(ray);
                }
                return None;
            }
        };
        let waiting = std::mem::take(&mut self.visible[stage.component]);
        let (run, stay): (Vec<_>, Vec<_>) = waiting.into_iter().partition(|ray| self.admits(ray, stage.threshold));
        self.visible[stage.component] = stay;
        let mut report = WorkReport { rays: run.len() as u64, ..WorkReport::default() };
        for ray in run {
            for component in Component::ALL {
                let children = self.scene.children(&ray, component);
                report.spawned[component] += children.len() as u64;
                let into = if stage.held { &mut self.held } else { &mut self.visible[component] };
                into.extend(children);
            }
            self.traced.push(ray);
        }
        Some(report)
    }

    /// What the bins hold at the end.
    pub(crate) fn left(&self) -> BinOccupancy {
        assert!(self.held.is_empty(), "rays still held at the end");
        self.occupancy()
    }
}

/// What an execution did.
pub(crate) struct Execution {
    pub(crate) rows: Vec<StageRow>,
    pub(crate) traced: Vec<Ray>,
    pub(crate) left: BinOccupancy,
    /// Stopped `*`s.
    pub(crate) stopped: usize,
}

impl Execution {
    /// The rows as `D1 G2 S3`: the letter of every stage and the rays that it traced.
    pub(crate) fn counts(&self) -> String {
        let rows: Vec<_> = self.rows.iter().map(|row| format!("{}{}", row.stage.component, row.report.rays)).collect();
        rows.join(" ")
    }

    /// How often every word was traced.
    pub(crate) fn words(&self) -> BTreeMap<String, usize> {
        let mut words = BTreeMap::new();
        for ray in &self.traced {
            *words.entry(ray.word()).or_default() += 1;
        }
        words
    }

    /// Every ray traced, sorted.
    pub(crate) fn sorted(&self) -> Vec<Ray> {
        let mut rays = self.traced.clone();
        rays.sort();
        rays
    }
}

/// Runs a program over some pixels of a scene.
pub(crate) fn execute(
    program: &Program,
    thresholds: Option<&[f32]>,
    scene: &Scene,
    pixels: impl Iterator<Item = u32>,
) -> Execution {
    let mut tracer = Tracer::new(scene, pixels);
    let mut scheduler = Scheduler::new(program, thresholds).expect("thresholds fit");
    while let Some(work) = scheduler.next(&tracer.occupancy()) {
        if let Some(report) = tracer.work(&work) {
            scheduler.report(&report);
        }
    }
    let stopped = scheduler.stopped().len();
    Execution { rows: scheduler.into_rows(), left: tracer.left(), traced: tracer.traced, stopped }
}

/// Runs a crex over all pixels of a scene.
pub(crate) fn run(crex: &str, scene: &Scene) -> Execution {
    let program = compile(crex).unwrap_or_else(|errors| panic!("{crex}: {errors:?}"));
    execute(&program, None, scene, 0..scene.importance.len() as u32)
}
