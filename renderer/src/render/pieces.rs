//! Into which pieces a picture is cut, and what tracing them takes.

use std::ops::Range;

use crate::color::Rgb;
use crate::component::{Component, ComponentSet};
use crate::film::{Block, Film};
use crate::transport::{Modulation, Parcel, Samples, Tracer};
use crate::work::WorkReport;

use super::Renderer;
use super::settings::Settings;

/// Edge of an image tile in pixels.
const TILE: usize = 16;

/// Primary rays of a parcel, about: what keeps its bins within a processor's cache, and the cost of its stages small.
const RAYS_PER_PARCEL: usize = 8192;

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
        let Settings { width, height, jitter, .. } = self.settings;
        Samples { view: self.view, width, height, jitter }
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
        let spawned = self.scene.components(self.settings.limits.glossy_threshold);
        let run = self.program.components();
        Component::ALL.into_iter().filter(|&component| spawned.contains(component) && run.contains(component)).collect()
    }

    /// The tiles of the picture, row by row.
    pub(super) fn tiles(&self) -> Vec<Block> {
        let Settings { width, height, .. } = self.settings;
        let edge = |start: usize, end: usize| TILE.min(end - start);
        let rows = (0..height).step_by(TILE);
        rows.flat_map(|y| {
            (0..width).step_by(TILE).map(move |x| Block { x, y, width: edge(x, width), height: edge(y, height) })
        })
        .collect()
    }

    /// Sample numbers in pieces that keep a parcel's bins small.
    pub(super) fn ranges(&self, samples: Range<u32>) -> Vec<Range<u32>> {
        let rays = TILE * TILE * self.settings.limits.most_rays() as usize;
        let step = u32::try_from((RAYS_PER_PARCEL / rays).max(1)).expect("at most the rays of a parcel");
        let end = samples.end;
        samples.step_by(step as usize).map(|start| start..end.min(start.saturating_add(step))).collect()
    }
}
