//! A parcel: a block of pixels and a range of samples that are traced together.

use std::ops::Range;

use crate::color::Rgb;
use crate::component::{Component, ComponentSet, PerComponent};
use crate::film::{Block, Plane, Planes};
use crate::geometry::Ray;
use crate::math::warp;
use crate::sample::{PathKey, Sampler};
use crate::scene::View;
use crate::work::{BinOccupancy, Stage, WorkReport};

use super::bins::{RayBins, SpawnRecord};
use super::dimension;
use super::direct::Scratch;
use super::lattice::{Lattice, RANKS};
use super::modulation::{Choice, Rule};
use super::ray::{PathRay, RayPath};
use super::spawn::Spawner;
use super::trace::Tracer;

/// Where the primary rays of a picture come from.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    /// The view.
    pub view: &'a View,
    /// Pixels in a row of the whole picture.
    pub width: usize,
    /// Rows of the whole picture.
    pub height: usize,
    /// `-pj`: how much of a pixel's extent its samples cover, in [0, 1]; 1 is a box filter, 0 samples the centre.
    pub jitter: f64,
    /// `-pd`: diameter of the lens, which only perspective views have; 0 is a point.
    pub aperture: f64,
}

/// Pixels and samples with the rays that they have brought forth so far.
#[derive(Clone, Debug)]
pub struct Parcel {
    block: Block,
    numbers: Range<u32>,
    bins: RayBins,
    planes: Planes,
}

/// Rays that are traced between two looks at whether to go on: a fraction of a millisecond.
const UNASKED: u32 = 32;

/// Memory that tracing needs beside a parcel; one for each thread.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    scratch: Scratch,
}

impl Parcel {
    /// A parcel of the samples `numbers` of a block's pixels, whose spawned rays are kept for the components in
    /// `stored`.
    #[must_use]
    pub fn new(block: Block, numbers: Range<u32>, stored: ComponentSet, ambient: bool) -> Self {
        let mut parcel = Self { block, numbers: 0..0, bins: RayBins::default(), planes: Planes::default() };
        parcel.restart(block, numbers, stored, ambient);
        parcel
    }

    /// As [`Self::new`], with the memory of this parcel.
    pub fn restart(&mut self, block: Block, numbers: Range<u32>, stored: ComponentSet, ambient: bool) {
        self.block = block;
        self.numbers = numbers;
        self.bins.clear(stored);
        self.planes.clear(block.pixels(), stored, ambient);
    }

    /// Traces the primary rays, and chooses those whose paths will run the members of `{ }` if importance is continuous.
    pub fn trace_primary(
        &mut self,
        tracer: &Tracer<'_>,
        samples: &Samples<'_>,
        workspace: &mut Workspace,
    ) -> WorkReport {
        self.trace_lattice(tracer, samples, &(0..RANKS), workspace)
    }

    /// As [`Self::trace_primary`], in the pixels of some ranks (see the lattice) alone.
    pub fn trace_lattice(
        &mut self,
        tracer: &Tracer<'_>,
        samples: &Samples<'_>,
        ranks: &Range<u16>,
        workspace: &mut Workspace,
    ) -> WorkReport {
        let mut rays = 0;
        let mut spawner = spawner(tracer, &mut self.bins, &mut self.planes, false);
        let lattice = Lattice::new(ranks);
        let pixels = (0..self.block.height).filter(|row| lattice.has_row(self.block.y + row)).flat_map(|row| {
            let first = row * self.block.width;
            first..first + self.block.width
        });
        for pixel in pixels {
            let (x, y) = place(&self.block, pixel);
            if !lattice.holds(x, y) {
                continue;
            }
            let share = tracer.modulation.and_then(|modulation| modulation.share(x, y, name(x, y), tracer.seed));
            for sample in self.numbers.clone() {
                let sampler = Sampler::new(tracer.seed, name(x, y), PathKey::EYE, sample);
                let [across, down] = sampler.pair(dimension::PIXEL).map(|u| 0.5 + samples.jitter * (u - 0.5));
                let ray = samples
                    .view
                    .ray((x as f64 + across) / samples.width as f64, (y as f64 + down) / samples.height as f64);
                let Some(mut ray) = ray else { continue };
                if samples.aperture > 0.0 {
                    let lens = warp::disc(sampler.pair(dimension::LENS));
                    match samples.view.through_lens(&ray, samples.aperture, lens) {
                        Some(bent) => ray = bent,
                        None => continue,
                    }
                }
                rays += 1;
                let mut path = RayPath::primary(pixel as u32, sample);
                if share.is_some_and(|share| sample >= share.chosen) {
                    path.choice = Choice::PassedOver;
                }
                let ray = PathRay { ray, ripple: Rgb::ONE, path };
                tracer.trace(&ray, &sampler, &mut workspace.scratch, &mut spawner);
            }
        }
        WorkReport { rays, spawned: spawner.spawned, seconds: 0.0 }
    }

    /// Traces the visible rays of a component's bin: all, or if the stage has a threshold those that the tracer's
    /// modulation admits (without one every pixel counts as 1). The others stay visible; only rays that continuous
    /// importance has passed over are dropped, since others of their pixel stand for them.
    pub fn run(&mut self, tracer: &Tracer<'_>, stage: &Stage, workspace: &mut Workspace) -> WorkReport {
        self.run_while(tracer, stage, workspace, &|| true).0
    }

    /// As [`Self::run`], for as long as `go` says so: what was done, and whether that is all. If it is not, rays have been lost
    /// and the parcel holds no picture any more.
    pub fn run_while(
        &mut self,
        tracer: &Tracer<'_>,
        stage: &Stage,
        workspace: &mut Workspace,
        go: &dyn Fn() -> bool,
    ) -> (WorkReport, bool) {
        let mut records = self.bins.take(stage.component);
        let mut rays = 0;
        let mut unasked = 0u32;
        let mut complete = true;
        let mut spawned = PerComponent::default();
        let glossy = tracer.limits.glossy_sampling();
        for mut record in records.drain(..) {
            if unasked == 0 {
                if !go() {
                    complete = false;
                    break;
                }
                unasked = UNASKED;
            }
            unasked = unasked.saturating_sub(record.count);
            let (x, y) = place(&self.block, record.path.pixel as usize);
            if !reaches(tracer, &self.block, &record, stage.threshold) {
                self.bins.push(stage.component, record, false);
                continue;
            }
            if let (Some(_), Some(modulation)) = (stage.threshold, tracer.modulation) {
                match (modulation.share(x, y, name(x, y), tracer.seed), record.path.choice) {
                    (Some(_), Choice::PassedOver) => continue,
                    (Some(share), Choice::Chosen) => {
                        record.ripple *= share.weight;
                        record.path.choice = Choice::Weighted;
                    }
                    _ => {}
                }
            }
            let mut spawner = Spawner { spawned, ..spawner(tracer, &mut self.bins, &mut self.planes, stage.held) };
            for i in 0..record.count {
                let sample = record.path.sample.wrapping_mul(record.count).wrapping_add(i);
                let sampler = Sampler::new(tracer.seed, name(x, y), record.path.key, sample);
                let drawn = record.spread.direction(glossy, |trial| sampler.pair(dimension::DIRECTION + trial));
                rays += 1;
                let Some((dir, weight)) = drawn else { continue };
                let ray = PathRay {
                    ray: Ray::new(record.origin, dir).leaving(record.leaving),
                    ripple: record.ripple * weight,
                    path: RayPath { sample, ..record.path },
                };
                tracer.trace(&ray, &sampler, &mut workspace.scratch, &mut spawner);
            }
            spawned = spawner.spawned;
        }
        self.bins.give_back(records);
        (WorkReport { rays, spawned, seconds: 0.0 }, complete)
    }

    /// Number of its pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.block.pixels()
    }

    /// Makes all held rays visible.
    pub fn release(&mut self) {
        self.bins.release();
    }

    /// Rays that a stage with a threshold would trace now, by component.
    #[must_use]
    pub fn admitted(&self, tracer: &Tracer<'_>, threshold: Option<f32>) -> BinOccupancy {
        if threshold.is_none() || tracer.modulation.is_none() {
            return self.occupancy();
        }
        PerComponent::from_fn(|component| {
            let records = self.bins.visible(component).iter();
            let admitted = records.filter(|record| traces(tracer, &self.block, record, threshold));
            admitted.map(|record| u64::from(record.count)).sum()
        })
    }

    /// A parcel of copies of visible records of a component, as if drawn at random from those that a stage with a
    /// threshold would trace: those whose number in [0, 1), which depends on nothing but their path, lies in `share`.
    #[must_use]
    pub fn copy_of(
        &self,
        tracer: &Tracer<'_>,
        component: Component,
        share: &Range<f64>,
        threshold: Option<f32>,
    ) -> Self {
        let mut part = Self { block: self.block, numbers: 0..0, bins: RayBins::default(), planes: Planes::default() };
        part.bins.clear(self.bins.stored());
        part.planes.clear_like(&self.planes);
        for record in self.bins.visible(component) {
            let (x, y) = place(&self.block, record.path.pixel as usize);
            let sampler = Sampler::new(0, name(x, y), record.path.key, record.path.sample);
            if share.contains(&sampler.pair(dimension::PROBE)[0]) && traces(tracer, &self.block, record, threshold) {
                part.bins.push(component, *record, false);
            }
        }
        part
    }

    /// Rays now visible, by component.
    #[must_use]
    pub fn occupancy(&self) -> BinOccupancy {
        self.bins.occupancy()
    }

    /// All rays that have been spawned and not traced, by component.
    #[must_use]
    pub fn left(&self) -> PerComponent<u64> {
        self.bins.left()
    }

    /// Adds what the parcel has brought so far to `sums`: its planes, and the ambient estimate of the diffuse rays that
    /// still wait.
    pub fn add_to(&self, sums: &mut Planes, ambient: Rgb) {
        sums.add_all(&self.planes);
        if ambient != Rgb::ZERO {
            for record in self.bins.waiting(Component::Diffuse) {
                let estimate = record.ripple * f64::from(record.count) * ambient;
                sums.add(record.path.pixel, Plane::Ambient, estimate);
            }
        }
    }
}

fn spawner<'a>(tracer: &'a Tracer<'_>, bins: &'a mut RayBins, planes: &'a mut Planes, held: bool) -> Spawner<'a> {
    let (limits, ambient) = (&tracer.limits, tracer.ambient);
    Spawner { limits, ambient, bins, planes, held, spawned: PerComponent::default() }
}

/// Whether a record's pixel is important enough to leave the bin.
fn reaches(tracer: &Tracer<'_>, block: &Block, record: &SpawnRecord, threshold: Option<f32>) -> bool {
    // Without a map every pixel counts as 1, and no threshold exceeds that.
    let (Some(threshold), Some(modulation)) = (threshold, tracer.modulation) else { return true };
    let (x, y) = place(block, record.path.pixel as usize);
    match modulation.rule {
        Rule::Thresholds => *modulation.map.at(x, y) >= threshold,
        Rule::Continuous { .. } | Rule::Expected => *modulation.map.at(x, y) > 0.0,
    }
}

/// Whether a record's rays would be traced, and not stay or be passed over.
fn traces(tracer: &Tracer<'_>, block: &Block, record: &SpawnRecord, threshold: Option<f32>) -> bool {
    let passed_over = threshold.is_some() && record.path.choice == Choice::PassedOver;
    reaches(tracer, block, record, threshold) && !passed_over
}

/// Column and row in the picture of a block's pixel.
fn place(block: &Block, pixel: usize) -> (usize, usize) {
    (block.x + pixel % block.width, block.y + pixel / block.width)
}

/// A pixel as random numbers know it: the same in pictures of any width.
fn name(x: usize, y: usize) -> u64 {
    (y as u64) << 32 | x as u64
}
