//! The loop: a scene, a view and a crex become a picture. The only module that sees both the schedule and the rays.

mod filtered;
mod outcome;
mod pieces;
mod settings;
mod shard;
mod stages;
mod tiles;
mod timed;

use crate::crex::Program;
use crate::geometry::Aggregate;
use crate::raster::Raster;
use crate::scene::{Scene, View};
use crate::schedule::{Clock, Scheduler};
use crate::transport::Rule;

pub use filtered::SmoothedPlane;
pub use outcome::{Account, Rendering, Snapshot};
pub use pieces::{TILE, planes, tile, tile_count};
pub use settings::{RenderError, Settings};
pub use shard::Shard;
pub use timed::{RoundRecord, TimedRecord, TimedRendering, paths};

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
    rule: Rule,
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
        settings::check(&settings, view)?;
        let (importance, thresholds, progress) = (None, None, None);
        let rule = Rule::Thresholds;
        Ok(Self { scene, aggregate, view, program, clock, settings, importance, thresholds, rule, progress })
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
            return Err(settings::out_of_range("a value of the importance map", value, "a number from 0 to 1"));
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

    /// Has the map say how many samples of a pixel run the members of `{ }`, instead of which members run: all of them,
    /// wherever it is above 0, with the expected picture kept ([`Rule::Continuous`]). Thresholds then decide nothing.
    #[must_use]
    pub fn with_continuous_importance(self) -> Self {
        let samples = self.settings.samples;
        Self { rule: Rule::Continuous { samples }, ..self }
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
        self.in_threads(|| self.render_tiles(None))?
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
}
