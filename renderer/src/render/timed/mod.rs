//! A picture within a time limit.
//!
//! First a sprinkle: the whole crex on a coarse lattice of pixels, which tells what rays cost and is the least that will
//! be shown. Then rounds over the whole picture, whose tasks run or are skipped as the crex says. What time is left goes
//! into refining the lattice, then into further samples. At the end each plane is made of the samples that are complete
//! for it, and pixels without any are filled in from their neighbours.

mod develop;
mod ladder;
mod refine;
mod round;

use crate::crex::ThresholdError;
use crate::schedule::{Budget, ProfileCache};
use crate::transport::{Modulation, Rule, Tracer};
use crate::work::WorkReport;

use super::outcome::{Outcome, add_report, reached};
use super::{RenderError, Renderer, Rendering};
use develop::Merger;
use refine::Refinement;
use round::Round;

/// The part of the picture that is sprinkled with samples before anything is decided: levels of the ladder, 1/64 of the
/// pixels.
const SPRINKLED: u64 = 4;

/// The part of the time that the sprinkle may take.
const SPRINKLE_TIME: f64 = 0.1;

/// Bytes that the waiting rays of a round may take, about.
const ROUND_BYTES: f64 = 2e9;

/// Bytes that the rays take which a primary ray leaves waiting, about: a few records.
const BYTES_PER_SAMPLE: f64 = 1000.0;

/// What was decided in a round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoundRecord {
    /// Its first sample.
    pub first_sample: u32,
    /// Its samples for each pixel.
    pub samples: u32,
    /// Tiles whose primary rays were traced.
    pub tiles: usize,
    /// For every stage, in their order, whether it ran.
    pub ran: Vec<bool>,
}

/// All that a clock decided: what must be known to render the same picture again without one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimedRecord {
    /// The rounds over the whole picture.
    pub rounds: Vec<RoundRecord>,
    /// How far the refinement came, in tiles times levels.
    pub units: u64,
}

/// What a rendering within a time limit made.
#[derive(Clone, Debug)]
pub struct TimedRendering {
    /// As of a rendering without a limit. The stages are those of the rounds; of the refinement, if there was no time for a
    /// round. Seconds of rounds are by the clock, not summed over threads.
    pub rendering: Rendering,
    /// What was decided.
    pub record: TimedRecord,
    /// What the refinement traced, primary rays included.
    pub refined: WorkReport,
    /// Samples of the whole crex for a pixel, on average, from the refinement.
    pub refined_samples: f64,
}

impl Renderer<'_> {
    /// Renders the picture within a budget: when it returns, the budget's reserve is left. Time that the crex does not need
    /// is spent on more samples. Costs are taken from the `profile`, which learns.
    ///
    /// A clock decides what runs, so two runs need not agree; [`Self::replay`] repeats one.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn render_within(&self, budget: Budget<'_>, profile: &mut ProfileCache) -> Result<TimedRendering, RenderError> {
        self.in_threads(|| self.within(budget, profile))?.map_err(RenderError::from)
    }

    /// Renders once more, to the same bits, what a clock decided at another time.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn replay(&self, record: &TimedRecord) -> Result<TimedRendering, RenderError> {
        self.in_threads(|| self.again(record))?.map_err(RenderError::from)
    }

    fn within(&self, budget: Budget<'_>, profile: &mut ProfileCache) -> Result<TimedRendering, ThresholdError> {
        let tracer = self.tracer();
        let complete = self.refining();
        let budget = budget.with_more_reserve(self.develop_s());
        let left_s = || budget.left_s();
        let mut refinement = Refinement::new(self, self.settings.samples);
        let tiles = self.tiles().len() as u64;
        let sprinkle_ends_s = budget.now_s() + SPRINKLE_TIME * budget.left_s();
        let sprinkle = || (sprinkle_ends_s - budget.now_s()).min(budget.left_s());
        refinement.run(self, &complete, SPRINKLED * tiles, &sprinkle, profile)?;
        let mut merger = Merger::new(self);
        let mut first = 0;
        let all = self.settings.samples;
        let at_once = self.samples_at_once();
        while first < all {
            let samples = at_once.min(all - first);
            let part = f64::from(samples) / f64::from(all - first);
            let share = budget.with_more_reserve((1.0 - part) * budget.left_s().max(0.0));
            let Some(round) = Round::run(self, &tracer, first, samples, (share, budget), profile)? else { break };
            merger.add(round);
            first += samples;
        }
        refinement.run(self, &complete, u64::MAX, &left_s, profile)?;
        Ok(self.developed(&merger, refinement))
    }

    fn again(&self, record: &TimedRecord) -> Result<TimedRendering, ThresholdError> {
        let tracer = self.tracer();
        let complete = self.refining();
        let mut merger = Merger::new(self);
        for round in &record.rounds {
            merger.add(Round::replay(self, &tracer, round)?);
        }
        let mut refinement = Refinement::new(self, self.settings.samples);
        // Nobody asks what this learns.
        let mut profile = ProfileCache::new("", "");
        refinement.run(self, &complete, record.units, &|| f64::INFINITY, &mut profile)?;
        Ok(self.developed(&merger, refinement))
    }

    fn developed(&self, merger: &Merger, refinement: Refinement) -> TimedRendering {
        let mut film = merger.film(self, &refinement);
        let record = TimedRecord { rounds: merger.records().to_vec(), units: refinement.units() };
        let Outcome { primary, rows, .. } = &refinement.outcome;
        let mut refined = *primary;
        rows.iter().for_each(|row| add_report(&mut refined, &row.report));
        let refined_samples = primary.rays as f64 / (self.settings.width * self.settings.height) as f64;
        let outcome = merger.outcome().unwrap_or_else(|| refinement.outcome.clone());
        // A component that was skipped in the rounds is there if the refinement reached it.
        let shown = reached(&outcome.rows).iter().chain(reached(rows).iter()).collect();
        film.keep(shown);
        let Outcome { primary, rows: stages, left, stopped } = outcome;
        let rendering = Rendering { film, primary, stages, left, stopped };
        TimedRendering { rendering, record, refined, refined_samples }
    }

    /// What traces single samples: continuous importance, which chooses among many, becomes all samples wherever the map is
    /// above 0, since that is the picture it expects.
    fn refining(&self) -> Tracer<'_> {
        let tracer = self.tracer();
        let modulation = tracer.modulation.map(|modulation| match modulation.rule {
            Rule::Thresholds => modulation,
            Rule::Continuous { .. } | Rule::Expected => Modulation { rule: Rule::Expected, ..modulation },
        });
        Tracer { modulation, ..tracer }
    }

    /// Samples of a pixel whose rays may wait at once.
    fn samples_at_once(&self) -> u32 {
        if let Rule::Continuous { samples } = self.rule {
            // Which of its samples stand for which others is decided over all of them.
            return samples;
        }
        let rays = f64::from(self.settings.limits.most_rays()).sqrt();
        let sample = (self.settings.width * self.settings.height) as f64 * BYTES_PER_SAMPLE * rays;
        ((ROUND_BYTES / sample) as u32).max(1)
    }

    /// Bytes that a rendering within a time limit takes at most, about: sums and film of each plane, and the waiting rays of
    /// a round.
    #[must_use]
    pub fn timed_bytes(&self) -> f64 {
        let pixels = (self.settings.width * self.settings.height) as f64;
        let planes = 2.0 + self.stored().iter().count() as f64;
        let waiting = BYTES_PER_SAMPLE * f64::from(self.samples_at_once().min(self.settings.samples));
        pixels * (planes * (4.0 * 24.0 + 12.0) + waiting)
    }

    /// Seconds to keep for making the film of the sums, by what that took at most where it was measured (a 2 GHz core).
    fn develop_s(&self) -> f64 {
        let planes = 2.0 + self.stored().iter().count() as f64;
        let pixels = (self.settings.width * self.settings.height) as f64;
        DEVELOP_S * planes * pixels
    }
}

/// Seconds for each pixel and plane to merge and fill, generously.
const DEVELOP_S: f64 = 60e-9;
