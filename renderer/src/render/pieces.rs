//! Into which pieces a picture is cut, and what tracing them takes.

use std::ops::Range;

use crate::color::Rgb;
use crate::component::{Component, ComponentSet};
use crate::crex::Program;
use crate::film::{Block, Film, Plane};
use crate::scene::Scene;
use crate::transport::{Modulation, Parcel, Samples, Tracer};
use crate::work::WorkReport;

use super::Renderer;
use super::settings::Settings;

/// Edge of an image tile in pixels.
pub const TILE: usize = 16;

/// Primary rays of a parcel, about: what keeps its bins within a processor's cache, and the cost of its stages small.
const RAYS_PER_PARCEL: usize = 8192;

/// Tiles of a picture.
#[must_use]
pub fn tile_count(width: usize, height: usize) -> usize {
    width.div_ceil(TILE) * height.div_ceil(TILE)
}

/// A tile of a picture by its number: row by row from the top, each row from the left.
#[must_use]
pub fn tile(width: usize, height: usize, index: usize) -> Block {
    let across = width.div_ceil(TILE);
    let (x, y) = (index % across * TILE, index / across * TILE);
    Block { x, y, width: TILE.min(width - x), height: TILE.min(height - y) }
}

/// The planes of a picture that is to be rendered so: one for light that primary rays meet, one for each component that the
/// scene can spawn and the crex runs, and one for the ambient estimate if there is any.
#[must_use]
pub fn planes(scene: &Scene, program: &Program, settings: &Settings) -> Vec<Plane> {
    let components = stored(scene, program, settings);
    let there = |plane: &Plane| match plane {
        Plane::Direct => true,
        Plane::Layer(component) => components.contains(*component),
        Plane::Ambient => settings.ambient != Rgb::ZERO,
    };
    Plane::all().filter(there).collect()
}

fn stored(scene: &Scene, program: &Program, settings: &Settings) -> ComponentSet {
    let spawned = scene.components(settings.limits.glossy_threshold);
    let run = program.components();
    Component::ALL.into_iter().filter(|&component| spawned.contains(component) && run.contains(component)).collect()
}

impl<'a> Renderer<'a> {
    pub(super) fn timed(&self, work: impl FnOnce() -> WorkReport) -> WorkReport {
        let start = self.clock.now_s();
        let report = work();
        WorkReport { seconds: self.clock.now_s() - start, ..report }
    }

    pub(super) fn tracer(&self) -> Tracer<'a> {
        Tracer {
            scene: self.scene,
            aggregate: self.aggregate,
            limits: self.settings.limits,
            ambient: self.settings.ambient,
            lights_visible: self.settings.lights_visible,
            layers: self.settings.layers,
            seed: self.settings.seed,
            modulation: self.importance.map(|map| Modulation { map, rule: self.rule }),
        }
    }

    pub(super) fn samples(&self) -> Samples<'a> {
        let Settings { width, height, jitter, aperture, .. } = self.settings;
        Samples { view: self.view, width, height, jitter, aperture }
    }

    pub(super) fn film(&self) -> Film {
        Film::new(self.settings.width, self.settings.height, self.stored(), self.has_ambient())
    }

    pub(super) fn parcel(&self, tile: Block, range: &Range<u32>) -> Parcel {
        Parcel::new(tile, range.clone(), self.stored(), self.has_ambient())
    }

    pub(super) fn has_ambient(&self) -> bool {
        self.settings.ambient != Rgb::ZERO
    }

    /// The components that the scene can spawn and the crex runs.
    pub(super) fn stored(&self) -> ComponentSet {
        stored(self.scene, self.program, &self.settings)
    }

    /// The tiles of the picture, row by row.
    pub(super) fn tiles(&self) -> Vec<Block> {
        let Settings { width, height, .. } = self.settings;
        (0..tile_count(width, height)).map(|index| tile(width, height, index)).collect()
    }

    /// Sample numbers in pieces that keep a parcel's bins small.
    pub(super) fn ranges(&self, samples: Range<u32>) -> Vec<Range<u32>> {
        let rays = TILE * TILE * self.settings.limits.most_rays() as usize;
        let step = u32::try_from((RAYS_PER_PARCEL / rays).max(1)).expect("at most the rays of a parcel");
        let end = samples.end;
        samples.step_by(step as usize).map(|start| start..end.min(start.saturating_add(step))).collect()
    }
}
