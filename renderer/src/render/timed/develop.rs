//! From rounds and refinement to a film: which samples each plane is made of.

use glam::Vec3;
use rayon::prelude::*;

use crate::color::Rgb;
use crate::component::{Component, PerComponent};
use crate::film::{Block, Film, Plane, Planes};
use crate::raster::Raster;
use crate::reconstruct::fill;

use super::super::Renderer;
use super::super::outcome::Outcome;
use super::RoundRecord;
use super::refine::Refinement;
use super::round::{Round, State};

/// Samples from which soft light is shown as it is.
pub(super) const SOFT_SAMPLES: u64 = 8;

/// Samples of a pixel from which it is shown as it is. Of soft light a few scattered samples with what lies between them filled in
/// are nearer the truth than one sample of each pixel, which is mostly noise: a pixel with fewer samples than these shares those of
/// its neighbours, so that the picture does not become worse as they come in.
fn enough(plane: Plane) -> f32 {
    match plane {
        Plane::Layer(Component::Diffuse | Component::Glossy) | Plane::Ambient => SOFT_SAMPLES as f32,
        Plane::Direct | Plane::Layer(_) => 1.0,
    }
}

/// What the rounds have brought together.
pub(super) struct Merger {
    tiles: Vec<Block>,
    sums: Vec<Planes>,
    /// Samples of the primary rays, tile by tile.
    direct: Vec<u32>,
    /// How far each component came, and its samples.
    layers: PerComponent<(State, u32)>,
    /// Whether nothing at all was skipped.
    clean: bool,
    records: Vec<RoundRecord>,
    outcome: Option<Outcome>,
    /// Rays that were traced only to learn what they cost.
    probed_rays: u64,
}

/// Where a plane's samples come from.
#[derive(Clone, Copy, PartialEq)]
enum Source {
    /// The rounds.
    Rounds,
    /// The refinement, whose samples are complete but may be few.
    Refined,
    /// Both hold the same kind of samples, and count by their numbers.
    Both,
}

impl Merger {
    pub(super) fn new(renderer: &Renderer<'_>) -> Self {
        let tiles = renderer.tiles();
        let empty = |tile: &Block| {
            let mut sums = Planes::default();
            sums.clear(tile.pixels(), renderer.stored(), renderer.has_ambient());
            sums
        };
        let sums = tiles.iter().map(empty).collect();
        let direct = vec![0; tiles.len()];
        let layers = PerComponent::from_fn(|_| (State::Nothing, 0));
        Self { tiles, sums, direct, layers, clean: true, records: Vec::new(), outcome: None, probed_rays: 0 }
    }

    /// Adds a round's samples: to a component's plane only if no other round traced more of its rays.
    pub(super) fn add(&mut self, round: Round) {
        for component in Component::ALL {
            let state = round.state(component);
            let (known, samples) = &mut self.layers[component];
            self.clean &= state == State::Whole;
            if state == State::Nothing || state < *known {
                continue;
            }
            let fresh = state > *known;
            (*known, *samples) = (state, round.record.samples + if fresh { 0 } else { *samples });
            // The ambient estimate stands for diffuse rays that wait, so it goes with theirs.
            let ambient = (component == Component::Diffuse).then_some(Plane::Ambient);
            for plane in std::iter::once(Plane::Layer(component)).chain(ambient) {
                self.add_plane(&round, plane, fresh);
            }
        }
        self.add_plane(&round, Plane::Direct, false);
        for (samples, sums) in self.direct.iter_mut().zip(&round.sums) {
            *samples += if sums.is_some() { round.record.samples } else { 0 };
        }
        self.probed_rays += round.probed_rays;
        self.records.push(round.record);
        match &mut self.outcome {
            None => self.outcome = Some(round.outcome),
            Some(outcome) => outcome.add(round.outcome),
        }
    }

    fn add_plane(&mut self, round: &Round, plane: Plane, fresh: bool) {
        self.sums.par_iter_mut().zip(&round.sums).for_each(|(sums, more)| {
            let Some(more) = more else { return };
            let sums = sums.sums_mut(plane);
            if fresh {
                sums.fill(Rgb::ZERO);
            }
            sums.iter_mut().zip(more.sums(plane)).for_each(|(sum, more)| *sum += *more);
        });
    }

    /// Whether the rounds alone give every plane samples in every pixel.
    pub(super) fn is_complete(&self) -> bool {
        self.clean && !self.direct.contains(&0)
    }

    /// Samples of every pixel, by the rounds alone.
    pub(super) fn samples(&self) -> u64 {
        self.direct.iter().min().map_or(0, |samples| u64::from(*samples))
    }

    /// What was decided in the rounds.
    pub(super) fn records(&self) -> &[RoundRecord] {
        &self.records
    }

    /// Rays that were traced only to learn what they cost.
    pub(super) fn probed_rays(&self) -> u64 {
        self.probed_rays
    }

    /// What the rounds did; none without a round.
    pub(super) fn outcome(&self) -> Option<Outcome> {
        self.outcome.clone()
    }

    /// Makes the film.
    pub(super) fn film(&self, renderer: &Renderer<'_>, refinement: &Refinement) -> Film {
        let passes = refinement.passes();
        let of_component = |component: Component| {
            let (state, samples) = self.layers[component];
            if state == State::Nothing || self.direct.contains(&0) {
                Source::Refined
            } else if self.clean {
                Source::Both
            } else if passes >= u64::from(samples) {
                // As many samples, and none of them lacks what was skipped.
                Source::Refined
            } else {
                Source::Rounds
            }
        };
        let stored = renderer.stored();
        let planes: Vec<(Plane, Source)> = std::iter::once((Plane::Direct, Source::Both))
            .chain(stored.iter().map(|component| (Plane::Layer(component), of_component(component))))
            .chain(renderer.has_ambient().then(|| (Plane::Ambient, of_component(Component::Diffuse))))
            .collect();
        let mut made: Vec<(Plane, Raster<Vec3>)> = planes
            .into_par_iter()
            .map(|(plane, source)| (plane, self.plane(renderer, refinement, plane, source)))
            .collect();
        let mut take = |plane: Plane| {
            let place = made.iter().position(|(other, _)| *other == plane)?;
            Some(made.swap_remove(place).1)
        };
        let direct = take(Plane::Direct).expect("it is among the planes");
        let layers = PerComponent::from_fn(|component| take(Plane::Layer(component)));
        let ambient = take(Plane::Ambient);
        Film::from_planes(direct, layers, ambient).expect("all planes have the picture's size")
    }

    fn plane(&self, renderer: &Renderer<'_>, refinement: &Refinement, plane: Plane, source: Source) -> Raster<Vec3> {
        let (width, height) = (renderer.settings.width, renderer.settings.height);
        let mut raster = Raster::filled(width, height, Vec3::ZERO);
        let mut known = vec![0.0; width * height];
        let enough = enough(plane);
        for (place, tile) in self.tiles.iter().enumerate() {
            let samples = match plane {
                Plane::Direct => self.direct[place],
                Plane::Layer(component) => self.layers[component].1,
                Plane::Ambient => self.layers[Component::Diffuse].1,
            };
            let rounds = self.sums[place].sums(plane);
            refinement.with_tile(place, plane, |refined, weights| {
                for pixel in 0..tile.pixels() {
                    let (sum, weight) = match source {
                        Source::Rounds => (rounds[pixel], samples),
                        Source::Refined => (refined[pixel], weights[pixel]),
                        Source::Both => (rounds[pixel] + refined[pixel], samples.saturating_add(weights[pixel])),
                    };
                    if weight > 0 {
                        let at = (tile.y + pixel / tile.width) * width + tile.x + pixel % tile.width;
                        raster.values_mut()[at] = (sum / f64::from(weight)).as_vec3();
                        known[at] = (weight as f32 / enough).min(1.0);
                    }
                }
            });
        }
        fill(&mut raster, &known);
        raster
    }
}
