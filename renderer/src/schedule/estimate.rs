//! What a whole crex will cost, from a profile and before any of its rays exist: `crex estimate`.

use crate::component::{Component, PerComponent};
use crate::crex::{Cursor, Program, ThresholdError};
use crate::work::Work;

use super::cost::RayKind;
use super::profile::{Prediction, ProfileCache};

/// Rays beyond which a crex is said not to end.
const ENDLESS: f64 = 1e15;

/// A number of rays and what they will take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// Rays.
    pub rays: f64,
    /// Mean and deviation of their seconds.
    pub seconds: Prediction,
    /// Seconds not exceeded with the profile's confidence.
    pub bound_s: f64,
}

/// What a crex is expected to trace and to take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The primary rays.
    pub primary: Expected,
    /// Each component's rays, over all its runs.
    pub components: PerComponent<Expected>,
    /// Everything.
    pub total: Expected,
    /// The profile says nothing of these components, though rays of them are expected: they are not in the total.
    pub unknown: PerComponent<bool>,
    /// By the profile, the crex would never run out of rays; the walk was cut off.
    pub endless: bool,
}

/// Walks `program` with expected numbers of rays in place of rays: a ray of a kind is taken to spawn the children that
/// rays of that kind spawned on average, however deep it is, along the complete paths that the profile knows by the name of
/// `paths`. Where a crex ends only when no ray is left, so learnt from itself, the sum over all generations is that of the
/// paths; else it is near.
///
/// `primary` is the number of primary rays; `share` tells which part of the pixels has at least an importance, and falls
/// as that importance rises.
///
/// # Errors
/// As [`Program::check_thresholds`].
pub fn estimate(
    program: &Program,
    thresholds: Option<&[f32]>,
    primary: u64,
    share: impl Fn(f32) -> f64,
    (profile, paths): (&ProfileCache, &str),
) -> Result<Estimate, ThresholdError> {
    let mut cursor = Cursor::new(program);
    if let Some(thresholds) = thresholds {
        cursor = cursor.with_thresholds(thresholds)?;
    }
    let thresholds = thresholds.unwrap_or(program.thresholds());
    let children = |of, component| profile.children_per_ray(paths, of, component);
    let mut bins = ExpectedBins::new(primary, thresholds, share, &children);
    let mut traced: PerComponent<f64> = PerComponent::default();
    let mut endless = false;
    while let Some(work) = cursor.next() {
        match work {
            Work::Release => bins.release(),
            Work::Run(stage) => {
                let rays = bins.run(stage.component, stage.threshold, stage.held, &children);
                traced[stage.component] += rays;
                // Half a ray is none: the cursor counts whole ones, and a `*` must end.
                cursor.report(rays.round() as u64);
                endless |= traced[stage.component] > ENDLESS;
            }
        }
        if endless {
            break;
        }
    }
    endless |= !cursor.stopped().is_empty();
    Ok(sum_up(primary as f64, &traced, endless, profile))
}

fn sum_up(primary: f64, traced: &PerComponent<f64>, endless: bool, profile: &ProfileCache) -> Estimate {
    let expected = |kind, rays: f64| {
        let seconds = profile.predict(kind, rays.round() as u64)?;
        Some(Expected { rays, seconds, bound_s: profile.bound_s(&seconds) })
    };
    let first = expected(RayKind::Primary, primary).unwrap_or(Expected { rays: primary, ..Expected::default() });
    let mut estimate = Estimate { primary: first, total: first, endless, ..Estimate::default() };
    for (component, &rays) in traced.iter() {
        let Some(part) = expected(RayKind::Of(component), rays) else {
            estimate.unknown[component] = true;
            estimate.components[component].rays = rays;
            estimate.total.rays += rays;
            continue;
        };
        estimate.components[component] = part;
        estimate.total.rays += rays;
        estimate.total.seconds = estimate.total.seconds.and(part.seconds);
    }
    estimate.total.bound_s = profile.bound_s(&estimate.total.seconds);
    estimate
}

/// Children of a component that a ray of a kind has on average.
type Children<'a> = dyn Fn(RayKind, Component) -> f64 + 'a;

/// Rays expected in each bin, of the pixels between one threshold and the next.
struct ExpectedBins {
    /// The least importance of each class of pixels, rising.
    classes: Vec<f32>,
    visible: Vec<PerComponent<f64>>,
    held: Vec<PerComponent<f64>>,
}

impl ExpectedBins {
    fn new(primary: u64, thresholds: &[f32], share: impl Fn(f32) -> f64, children: &Children<'_>) -> Self {
        let mut classes = vec![f32::NEG_INFINITY];
        classes.extend_from_slice(thresholds);
        classes.sort_by(f32::total_cmp);
        classes.dedup();
        let reaching = |class: usize| match classes.get(class) {
            None => 0.0,
            Some(_) if class == 0 => 1.0,
            Some(&threshold) => share(threshold).clamp(0.0, 1.0),
        };
        let visible: Vec<PerComponent<f64>> = (0..classes.len())
            .map(|class| {
                let rays = primary as f64 * (reaching(class) - reaching(class + 1)).max(0.0);
                PerComponent::from_fn(|component| rays * children(RayKind::Primary, component))
            })
            .collect();
        let held = vec![PerComponent::default(); classes.len()];
        Self { classes, visible, held }
    }

    /// Runs a component; how many rays that traces.
    fn run(&mut self, component: Component, threshold: Option<f32>, hold: bool, children: &Children<'_>) -> f64 {
        let mut traced = 0.0;
        for (class, &least) in self.classes.iter().enumerate() {
            if threshold.is_some_and(|threshold| least < threshold) {
                continue;
            }
            let rays = std::mem::take(&mut self.visible[class][component]);
            traced += rays;
            let into = if hold { &mut self.held[class] } else { &mut self.visible[class] };
            for (child, count) in into.iter_mut() {
                *count += rays * children(RayKind::Of(component), child);
            }
        }
        traced
    }

    fn release(&mut self) {
        for (visible, held) in self.visible.iter_mut().zip(&mut self.held) {
            for (component, count) in held.iter_mut() {
                visible[component] += std::mem::take(count);
            }
        }
    }
}
