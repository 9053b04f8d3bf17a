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

use crate::color::Rgb;
use crate::crex::{Program, ThresholdError};
use crate::schedule::{Budget, PictureCosts, ProfileCache};
use crate::transport::{Limits, Modulation, Rule, Tracer};
use crate::work::WorkReport;

use super::outcome::{Outcome, add_report, reached};
use super::{RenderError, Renderer, Rendering};
use develop::{Merger, SOFT_SAMPLES};
use ladder::SPRINKLED;
use refine::Refinement;
use round::Round;

/// The part of the time that the sprinkle may take.
const SPRINKLE_TIME: f64 = 0.1;

/// The part of a sample of everything that must fit, if samples are to run stage by stage with some of their tasks skipped.
const MOST: f64 = 0.5;

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
    /// Which of these units were under way when the time was over, and are not in the picture; rising, at most one for each
    /// thread.
    pub missing: Vec<u64>,
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
    /// Rays that were traced only to learn what they cost: copies, whose light was forgotten.
    pub probed_rays: u64,
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
        let (end, known) = (budget, profile.clone());
        let mut costs = PictureCosts::new(profile, paths(self.program, &self.settings.limits));
        let budget = end.with_more_reserve(self.chore_s(FILL, &known));
        let left_s = || budget.left_s();
        let mut refinement = Refinement::new(self, self.settings.samples);
        let tiles = self.tiles().len() as u64;
        let sprinkle_ends_s = budget.now_s() + SPRINKLE_TIME * budget.left_s();
        let sprinkle = || (sprinkle_ends_s - budget.now_s()).min(budget.left_s());
        refinement.run(self, &complete, SPRINKLED * tiles, (&sprinkle, &left_s), &mut costs)?;
        // What comes at the end will be as slow as what came first.
        let mut slower = slower(&refinement, &known, costs.profile_mut());
        let kept = |chore, slower| end.slowed(slower).with_more_reserve(slower * self.chore_s(chore, &known));
        let mut merger = Merger::new(self);
        let mut first = 0;
        let all = self.settings.samples;
        while first < all {
            let whole = kept(FILL, slower).with_more_reserve(slower * self.chore_s(GATHER, &known));
            let fitting = fitting(all - first, whole.left_s(), self.sample_s(&refinement, &costs));
            let Some(round) = self.round(&tracer, (first, fitting), whole, &mut costs)? else { break };
            first += round.record.samples;
            let ended_s = round.ended_s;
            merger.add(round);
            let gathered_s = budget.now_s() - ended_s;
            if known.predict_writer(GATHER, self.plane_bytes()).is_none() {
                slower = slower.max(slower_than_guessed(gathered_s, self.plane_bytes()));
            }
            costs.profile_mut().observe_writer(GATHER, self.plane_bytes(), gathered_s);
        }
        let budget = kept(chore(merger.is_complete(), merger.samples()), slower);
        let left_s = || budget.left_s();
        refinement.run(self, &complete, u64::MAX, (&left_s, &left_s), &mut costs)?;
        let ended_s = budget.now_s();
        let complete = merger.is_complete() || refinement.passes() > 0;
        let chore = chore(complete, merger.samples() + refinement.passes());
        let developed = self.developed(merger, refinement);
        costs.profile_mut().observe_writer(chore, self.plane_bytes(), budget.now_s() - ended_s);
        Ok(developed)
    }

    /// The next round, of as many samples at most as are said to fit, and of fewer if not even their primary rays do; none if
    /// those of a single sample do not.
    fn round(
        &self,
        tracer: &Tracer<'_>,
        (first, fitting): (u32, u32),
        whole: Budget<'_>,
        costs: &mut PictureCosts<'_>,
    ) -> Result<Option<Round>, ThresholdError> {
        let at_once = self.samples_at_once();
        for fitting in (1..=fitting).rev() {
            let samples = at_once.min(fitting);
            if self.indivisible() && samples < self.settings.samples {
                break;
            }
            let part = f64::from(samples) / f64::from(fitting);
            let share = whole.with_more_reserve((1.0 - part) * whole.left_s().max(0.0));
            let round = Round::run(self, tracer, first, samples, (share, whole), costs)?;
            if round.is_some() {
                return Ok(round);
            }
        }
        Ok(None)
    }

    /// Seconds that a sample of the whole crex is predicted to take in every pixel, by what the sprinkle has met.
    fn sample_s(&self, sprinkle: &Refinement, costs: &PictureCosts<'_>) -> Option<f64> {
        let pixels = (self.settings.width * self.settings.height) as f64;
        let seconds = sprinkle
            .rays_per_primary()
            .map(|(place, rays)| costs.predict(place, (pixels * rays).ceil() as u64).map(|predicted| predicted.mean_s));
        seconds.sum::<Option<f64>>().filter(|seconds| *seconds > 0.0)
    }

    fn again(&self, record: &TimedRecord) -> Result<TimedRendering, ThresholdError> {
        let tracer = self.tracer();
        let complete = self.refining();
        let mut merger = Merger::new(self);
        for round in &record.rounds {
            merger.add(Round::replay(self, &tracer, round)?);
        }
        let mut refinement = Refinement::new(self, self.settings.samples).without(&record.missing);
        // Nobody asks what this learns.
        let mut profile = ProfileCache::new("", "");
        let mut costs = PictureCosts::new(&mut profile, "");
        let left_s = || f64::INFINITY;
        refinement.run(self, &complete, record.units, (&left_s, &left_s), &mut costs)?;
        Ok(self.developed(merger, refinement))
    }

    fn developed(&self, merger: Merger, refinement: Refinement) -> TimedRendering {
        let mut film = merger.film(self, &refinement);
        let (units, missing) = refinement.units();
        let record = TimedRecord { rounds: merger.records().to_vec(), units, missing: missing.to_vec() };
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
        TimedRendering { rendering, record, refined, refined_samples, probed_rays: merger.probed_rays() }
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

    /// Whether a round must have all samples: which of them stand for which others is decided over all.
    fn indivisible(&self) -> bool {
        matches!(self.rule, Rule::Continuous { .. })
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

    /// Bytes of the sums of all planes.
    fn plane_bytes(&self) -> u64 {
        let planes = 2 + self.stored().iter().count();
        (self.settings.width * self.settings.height * planes * size_of::<Rgb>()) as u64
    }

    /// Seconds to keep for something that is done with the sums of all planes when the time is over.
    fn chore_s(&self, name: &str, profile: &ProfileCache) -> f64 {
        let bytes = self.plane_bytes();
        profile.kept_s(name, bytes).unwrap_or(CHORE_S * bytes as f64)
    }
}

/// How many of so many samples rounds are to have, given the seconds left and those that a sample of everything would take, if they
/// are known: so many that [`MOST`] of each fits. Where not even one would, the refinement shows more.
fn fitting(wanted: u32, left_s: f64, sample_s: Option<f64>) -> u32 {
    let fitting = sample_s.map_or(f64::INFINITY, |sample_s| left_s / (MOST * sample_s));
    if fitting < f64::from(wanted) { fitting.max(0.0) as u32 } else { wanted }
}

/// What paths are like, for the profile: the crex that they run and the limits that end them.
#[must_use]
pub fn paths(program: &Program, limits: &Limits) -> String {
    let Limits { reflections, least_weight, diffuse, glossy_threshold, diffuse_rays, glossy_rays } = limits;
    let diffuse = diffuse.map_or(String::new(), |most| format!(" -ab {most}"));
    let (ends, splits) =
        (format!("-lr {reflections} -lw {least_weight}"), format!("-ad {diffuse_rays} -ss {glossy_rays}"));
    format!("{} {ends}{diffuse} -st {glossy_threshold} {splits}", program.text())
}

/// Bringing a round's sums together, and making the film, of enough samples in every pixel, with soft light to be shared or with
/// pixels to be filled in, by their names in the profile.
const GATHER: &str = "gather";
const DEVELOP: &str = "develop";
const SOFTEN: &str = "soften";
const FILL: &str = "fill";

/// What making the film will be, with samples of the whole crex in every pixel or not, and so many of them.
fn chore(complete: bool, samples: u64) -> &'static str {
    match complete {
        true if samples >= SOFT_SAMPLES => DEVELOP,
        true => SOFTEN,
        false => FILL,
    }
}

/// Seconds that these take for each byte of the planes before they were measured, generously (a 2 GHz core).
const CHORE_S: f64 = 1.2e-9;

/// The seconds of a sprinkle, by its name in the profile, for each nanosecond that its rays were expected to take: more than
/// rays of rounds, which run in larger sets.
const SPRINKLE: &str = "sprinkle";

/// A slower machine than this is a short interruption, not what is to be expected; one that is slower by less than this is as
/// usual.
const MOST_SLOWED: f64 = 4.0;
const LEAST_SLOWED: f64 = 1.15;

/// A sprinkle shorter than this tells nothing of the machine.
const LEAST_SPRINKLE_S: f64 = 2e-3;

/// How many times slower than guessed the machine is, by the first chore that is measured on it: then so may be those that come at
/// the end, of which nothing but guesses is known.
fn slower_than_guessed(gathered_s: f64, bytes: u64) -> f64 {
    (gathered_s / (CHORE_S * bytes as f64)).clamp(1.0, MOST_SLOWED)
}

/// How many times slower the machine is than it used to be, by the sprinkle: what other programs do to it now. At least 1, and
/// 1 while nothing is known.
fn slower(sprinkle: &Refinement, known: &ProfileCache, profile: &mut ProfileCache) -> f64 {
    let pace = sprinkle.pace(known).filter(|(_, expected_s)| *expected_s > LEAST_SPRINKLE_S);
    let Some((taken_s, expected_s)) = pace else { return 1.0 };
    let expected_ns = (1e9 * expected_s).round() as u64;
    profile.observe_writer(SPRINKLE, expected_ns, taken_s);
    let usual = known.predict_writer(SPRINKLE, expected_ns);
    let slower = usual.filter(|usual| usual.mean_s > 0.0).map_or(1.0, |usual| taken_s / usual.mean_s);
    if slower > LEAST_SLOWED { slower.min(MOST_SLOWED) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_have_as_many_samples_as_most_of_each_fits() {
        let fitting = |left_s| fitting(4, left_s, Some(2.0));
        assert_eq!([-1.0, 0.0, 0.9, 1.1, 2.1, 3.9, 4.1, 100.0].map(fitting), [0, 0, 0, 1, 2, 3, 4, 4]);
        assert_eq!(super::fitting(4, 1.0, None), 4);
    }

    #[test]
    fn what_costs_differently_at_the_end_is_learnt_apart() {
        assert_eq!([chore(false, 0), chore(false, 9), chore(true, 1), chore(true, 7)], [FILL, FILL, SOFTEN, SOFTEN]);
        assert_eq!(chore(true, SOFT_SAMPLES), DEVELOP);
    }

    #[test]
    fn what_is_only_guessed_is_kept_for_as_long_as_the_machine_is_slow() {
        let bytes = 1 << 20;
        let guessed_s = CHORE_S * bytes as f64;
        for (times, slower) in [(0.3, 1.0), (1.0, 1.0), (2.5, 2.5), (100.0, MOST_SLOWED)] {
            assert!((slower_than_guessed(times * guessed_s, bytes) - slower).abs() < 1e-12);
        }
    }
}
