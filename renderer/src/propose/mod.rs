//! An automatic crex: which components a scene's picture needs, in which order and how often, judged by how visible each is
//! for its time.
//!
//! In the spirit of Dumont, Pellacini and Ferwerda, "Perceptually-driven decision theory for interactive realistic rendering",
//! ACM TOG 22(2), 2003, and Stokes, Ferwerda, Walter and Greenberg, "Perceptual illumination components", ACM TOG 23(3), 2004:
//! a small picture by each candidate tells what it lacks and what it costs; a fit of our own turns that into the loss which
//! ColorVideoVDP would find in the picture that is asked for; steps are taken greedily by predicted gain per second.

mod levels;
mod profile;
mod visibility;

use crate::component::{Component, ComponentSet};
use crate::picture::compare::CompareError;
use crate::render::RenderError;

pub use levels::{Level, Levels};
pub use profile::{Forecast, Profile, Question, usual_exposure};
pub use visibility::{CONSTANT, EXPONENT, LEAST_LOSS_JOD, LEAST_PREDICTOR, loss_jod};

/// Why nothing could be proposed.
#[derive(Debug, thiserror::Error)]
pub enum ProposeError {
    /// The scene does not render so.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Its pictures cannot be judged.
    #[error(transparent)]
    Compare(#[from] CompareError),
}

/// One crex of a proposal.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What runs how often.
    pub levels: Levels,
    /// The crex.
    pub crex: String,
    /// What to expect of it.
    pub forecast: Forecast,
}

/// Crexes from direct light alone to the full solution, each with one more run of the component that is worth most for its
/// time.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// The crexes; the last one is the full solution, unless the time for choosing ended before.
    pub steps: Vec<Step>,
    /// All crexes that were looked at, those included that were no step, and the full solution in any case.
    pub seen: Vec<Step>,
    /// What radiance is multiplied by before it is judged.
    pub exposure: f64,
}

/// Proposes crexes for a scene. What they cost is measured, so that the order may differ between runs where two components
/// are worth nearly the same.
///
/// # Errors
/// If the settings or the display are refused.
pub fn propose(question: Question<'_>) -> Result<Proposal, ProposeError> {
    let mut profile = Profile::new(question)?;
    propose_from(&mut profile)
}

/// The same from small pictures that the caller keeps.
///
/// # Errors
/// As [`propose`].
pub fn propose_from(profile: &mut Profile<'_>) -> Result<Proposal, ProposeError> {
    propose_while(profile, &|| true)
}

/// The same for as long as `go` says so, which is asked before each crex that is looked at.
///
/// # Errors
/// As [`propose`].
pub fn propose_while(profile: &mut Profile<'_>, go: &dyn Fn() -> bool) -> Result<Proposal, ProposeError> {
    let mut now = step(profile, Levels::default())?;
    let mut steps = vec![now.clone()];
    let mut seen = vec![now.clone(), step(profile, Levels::full(profile.components()))?];
    loop {
        // Every component is looked at each time: losses saturate, so that one that is worth little beside a larger lack is
        // worth much once that is gone.
        let mut best: Option<(f64, Step)> = None;
        for component in profile.components().iter() {
            let Some(level) = now.levels.level(component).next(component) else { continue };
            if !go() {
                return Ok(Proposal { steps, seen, exposure: profile.exposure() });
            }
            let candidate = step(profile, now.levels.with(component, level))?;
            seen.push(candidate.clone());
            let worth = worth_of(&now, &candidate);
            if best.as_ref().is_none_or(|(found, _)| worth > *found) {
                best = Some((worth, candidate));
            }
        }
        let Some((_, chosen)) = best else { break };
        // A level that runs no further ray is no step.
        if chosen.forecast.seconds > now.forecast.seconds {
            steps.push(chosen.clone());
        }
        now = chosen;
    }
    // The last step is to say that it is the full solution, also in what runs nothing in so small a picture.
    if let Some(last) = steps.last_mut().filter(|last| !last.levels.components().is_empty()) {
        *last = now;
    }
    Ok(Proposal { steps, seen, exposure: profile.exposure() })
}

/// Predicted gain for each second; 0 if there is nothing to run.
fn worth_of(from: &Step, to: &Step) -> f64 {
    let gain = from.forecast.loss_jod - to.forecast.loss_jod;
    let seconds = to.forecast.seconds - from.forecast.seconds;
    if seconds > 0.0 { gain / seconds } else { 0.0 }
}

fn step(profile: &mut Profile<'_>, levels: Levels) -> Result<Step, ProposeError> {
    let forecast = profile.forecast(&levels)?;
    Ok(Step { crex: levels.crex(), levels, forecast })
}

impl Proposal {
    /// The cheapest step whose predicted loss is at most `loss_jod`.
    #[must_use]
    pub fn within_loss(&self, loss_jod: f64) -> &Step {
        let good = self.steps.iter().filter(|step| step.forecast.loss_jod <= loss_jod);
        let cheapest = good.min_by(|a, b| a.forecast.seconds.total_cmp(&b.forecast.seconds));
        cheapest.unwrap_or_else(|| self.full())
    }

    /// The crex of least predicted loss, of all that were looked at and are predicted to take at most `seconds` of tracing,
    /// summed over threads; the quicker one of equals, and direct light alone if none is so quick. More seconds never mean
    /// more loss.
    #[must_use]
    pub fn within_seconds(&self, seconds: f64) -> &Step {
        let quick = self.seen.iter().filter(|step| step.forecast.seconds <= seconds);
        let best = quick.min_by(|a, b| {
            let by_loss = a.forecast.loss_jod.total_cmp(&b.forecast.loss_jod);
            by_loss.then(a.forecast.seconds.total_cmp(&b.forecast.seconds))
        });
        best.unwrap_or(&self.steps[0])
    }

    /// The full solution.
    #[must_use]
    pub fn full(&self) -> &Step {
        self.steps.last().expect("there is a step for direct light alone")
    }
}

/// A crex whose components heed an importance map, with the thresholds for `--thresholds`.
#[derive(Clone, Debug, PartialEq)]
pub struct Modulated {
    /// The crex.
    pub crex: String,
    /// A threshold for each member of its `{ }`, from left to right.
    pub thresholds: Vec<f32>,
}

/// Puts the components of a step into `{ }`. Importance is read as the part of a difference that is visible at a pixel (what
/// the foveal gradient gives): where importance is p, lacking a component costs p times the loss predicted for lacking it
/// everywhere, so its threshold is that p at which the loss comes to `tolerance_jod`. Thresholds that round to 0.00 leave their
/// component outside; those of 1 and more would drop it and are set to 1.
///
/// # Errors
/// If the settings or the display are refused.
pub fn modulate(profile: &mut Profile<'_>, step: &Step, tolerance_jod: f64) -> Result<Modulated, ProposeError> {
    let mut thresholds = Vec::new();
    for &component in step.levels.components() {
        let without = profile.forecast(&step.levels.with(component, Level::Absent))?;
        let loss = (without.loss_jod - step.forecast.loss_jod).max(0.0);
        let threshold = if loss > tolerance_jod { tolerance_jod / loss } else { 1.0 };
        thresholds.push((component, ((100.0 * threshold).round() / 100.0) as f32));
    }
    let modulated: ComponentSet =
        thresholds.iter().filter(|(_, threshold)| *threshold > 0.0).map(|&(component, _)| component).collect();
    let crex = step.levels.spelled(modulated);
    let threshold = |letter: char| {
        let component = Component::from_letter(letter)?;
        thresholds.iter().find(|(known, _)| *known == component).map(|&(_, threshold)| threshold)
    };
    let inside = |letter: &char| Component::from_letter(*letter).is_some_and(|component| modulated.contains(component));
    let thresholds = crex.chars().filter(inside).filter_map(threshold).collect();
    Ok(Modulated { crex, thresholds })
}
