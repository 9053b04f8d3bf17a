//! What is known of costs while a picture is made: what the profile says of each place in the crex, and what the rays of this
//! picture have shown.

use std::collections::BTreeMap;

use super::cost::{Cost, RayKind};
use super::place::Place;
use super::profile::{JITTER_S, PRIOR_OBSERVATIONS, PRIOR_SPREAD, Prediction, ProfileCache};

/// How far a cost in the sprinkle is from that in a round, as part of it, before both have been seen.
const PRIOR_PACE: f64 = 0.12;

/// Deviation of a single ray's cost, as part of the mean: at least this much is not known from few rays.
const RAY_SPREAD: f64 = 0.6;

/// What no number of observations takes away from the deviation of a prediction, as part of its mean.
const LEAST_SPREAD: f64 = 0.04;

/// Deviation of a round's cost from that of an earlier round of the same picture, as part of it.
const ROUND_SPREAD: f64 = 0.05;

/// Degrees of freedom of Student's distribution by which pictures are taken to differ: one that is unlike the others says so by its
/// sprinkle, and then these say little of it.
const TAIL: f64 = 3.0;

/// What is known of costs for a picture under way. What it learns goes into the profile too.
#[derive(Debug)]
pub struct PictureCosts<'p> {
    profile: &'p mut ProfileCache,
    /// The crex and its limits, by which the profile keeps costs of places.
    paths: String,
    sprinkled: BTreeMap<Place, Cost>,
    rounds: BTreeMap<Place, Cost>,
    /// How the rounds of this picture compared with its sprinkle, by kind of ray: the sum of logarithms by their weights, and the
    /// weights.
    pace: [(f64, f64); RayKind::ALL.len()],
}

impl<'p> PictureCosts<'p> {
    /// For a picture of which no ray was traced. `paths` says which crex it runs and under which limits.
    #[must_use]
    pub fn new(profile: &'p mut ProfileCache, paths: impl Into<String>) -> Self {
        Self {
            profile,
            paths: paths.into(),
            sprinkled: BTreeMap::new(),
            rounds: BTreeMap::new(),
            pace: Default::default(),
        }
    }

    /// What is kept for other pictures.
    #[must_use]
    pub fn profile(&self) -> &ProfileCache {
        self.profile
    }

    /// The same, to teach.
    pub fn profile_mut(&mut self) -> &mut ProfileCache {
        self.profile
    }

    /// The crex and its limits.
    #[must_use]
    pub fn paths(&self) -> &str {
        &self.paths
    }

    /// Takes in what rays of a place cost in the sprinkle: a sample of the picture, in sets that are smaller than a round's.
    pub fn sprinkled(&mut self, place: Place, cost: &Cost) {
        if cost.rays() > 0 {
            self.sprinkled.entry(place).or_default().add(cost);
        }
    }

    /// Takes in what a round's rays of a place took together: `rays` at once, of the whole picture.
    pub fn ran(&mut self, place: Place, rays: u64, seconds: f64) {
        // A `*` ends with a run that traces nothing, which is no news of what rays cost.
        if rays == 0 || !seconds.is_finite() || seconds < 0.0 {
            return;
        }
        self.profile.observe(place.kind(), rays, seconds);
        self.profile.observe_place(&self.paths, place, rays, seconds);
        if let Some(sprinkled) = self.sprinkled.get(&place) {
            let expected_ns = (1e9 * sprinkled.mean_s() * rays as f64).round() as u64;
            self.profile.observe_pace(&self.paths, place, expected_ns, seconds);
            let ratio = seconds / (sprinkled.mean_s() * rays as f64);
            if ratio.is_normal() {
                let weight = (PRIOR_PACE * PRIOR_PACE + sampling(sprinkled) + sampling_of(rays)).recip();
                let (sum, weights) = &mut self.pace[place.kind().index()];
                (*sum, *weights) = (*sum + weight * ratio.ln(), *weights + weight);
            }
        }
        self.rounds.entry(place).or_default().observe(rays, seconds);
    }

    /// What so many rays will take at a place; none if nothing is known of their kind.
    ///
    /// What earlier pictures took there, what the sprinkle of this one took, and what its earlier rounds took are weighed by
    /// their variances; if they contradict each other by more than these, the result is the less certain. Where none of them
    /// says anything, the kind's cost over all places stands in.
    #[must_use]
    pub fn predict(&self, place: Place, rays: u64) -> Option<Prediction> {
        if rays == 0 {
            return Some(Prediction::default());
        }
        let known = self.profile.place(&self.paths, place);
        let of_place = known.map(|known| known.rays).filter(|cost| cost.rays() > 0).map(|cost| {
            let spread = shrunk(&cost, PRIOR_SPREAD);
            (cost.mean_s(), spread * spread)
        });
        let of_sprinkle = self.sprinkled.get(&place).map(|cost| {
            let pace = known.map(|known| known.pace).filter(|pace| pace.rays() > 0);
            let unknown = || (self.pace_of(place.kind()), PRIOR_PACE);
            let (times, spread) = pace.map_or_else(unknown, |pace| (1e9 * pace.mean_s(), shrunk(&pace, PRIOR_PACE)));
            (cost.mean_s() * times, spread * spread + sampling(cost))
        });
        let of_rounds = self
            .rounds
            .get(&place)
            .filter(|cost| cost.rays() > 0)
            .map(|cost| (cost.mean_s(), ROUND_SPREAD * ROUND_SPREAD + sampling_of(cost.rays())));
        let of_place = of_place.map(|(mean_s, spread)| {
            let Some((other_s, sampling)) = of_sprinkle else { return (mean_s, spread) };
            let beyond = ((mean_s / other_s).ln().powi(2) - sampling).max(0.0);
            (mean_s, if beyond.is_finite() { (TAIL * spread + beyond) / (TAIL + 1.0) } else { spread })
        });
        // What is infinitely uncertain says nothing.
        let says = |&(mean_s, variance): &(f64, f64)| mean_s > 0.0 && mean_s.is_finite() && variance.is_finite();
        let evidence = [of_place, of_sprinkle, of_rounds].into_iter().flatten().filter(says);
        match weighed(evidence) {
            Some((mean_s, spread)) => {
                let mean_s = rays as f64 * mean_s;
                let spread = spread.max(LEAST_SPREAD * LEAST_SPREAD) + sampling_of(rays);
                Some(Prediction { mean_s, deviation_s: (mean_s * spread.sqrt()).hypot(JITTER_S) })
            }
            None => self.profile.predict(place.kind(), rays),
        }
    }

    /// How rounds compare with the sprinkle where no other picture has told: as those of this picture did, of the same kind first and
    /// then of the others. Primary rays, which are spawned where they run, are another matter.
    fn pace_of(&self, kind: RayKind) -> f64 {
        let prior = (PRIOR_PACE * PRIOR_PACE).recip();
        let spawned = &self.pace[RayKind::Primary.index() + 1..];
        let (sum, weights) = spawned.iter().fold((0.0, prior), |all, one| (all.0 + one.0, all.1 + one.1));
        let all = if kind == RayKind::Primary { 0.0 } else { sum / weights };
        let (sum, weights) = self.pace[kind.index()];
        ((sum + prior * all) / (weights + prior)).exp()
    }

    /// As [`ProfileCache::bound_s`].
    #[must_use]
    pub fn bound_s(&self, prediction: &Prediction) -> f64 {
        self.profile.bound_s(prediction)
    }

    /// As [`ProfileCache::record`].
    pub fn record(&mut self, prediction: &Prediction, seconds: f64) {
        self.profile.record(prediction, seconds);
    }
}

/// Relative deviation between a cost's observations, shrunk towards a prior one, and of their mean.
fn shrunk(cost: &Cost, prior: f64) -> f64 {
    let observations = cost.effective_observations();
    let own = if cost.mean_s() > 0.0 { cost.spread_s() / cost.mean_s() } else { prior };
    let variance =
        (observations * own * own + PRIOR_OBSERVATIONS * prior * prior) / (observations + PRIOR_OBSERVATIONS);
    (variance * (1.0 + 1.0 / observations)).sqrt()
}

/// Relative variance of a mean over a sample of rays, from the spread between the sets in which they ran.
fn sampling(cost: &Cost) -> f64 {
    let between = (cost.spread_s() / cost.mean_s().max(f64::MIN_POSITIVE)).powi(2) / cost.effective_observations();
    between.max(sampling_of(cost.rays()))
}

/// The same from the number of rays alone.
fn sampling_of(rays: u64) -> f64 {
    RAY_SPREAD * RAY_SPREAD / rays as f64
}

/// The mean of several means by their relative variances, and its relative variance; none of none.
fn weighed(evidence: impl Iterator<Item = (f64, f64)> + Clone) -> Option<(f64, f64)> {
    let mut weights = 0.0;
    let mut logarithms = 0.0;
    let mut count = 0_u32;
    for (mean, variance) in evidence.clone() {
        weights += variance.recip();
        logarithms += mean.ln() / variance;
        count += 1;
    }
    if count == 0 {
        return None;
    }
    let mean = (logarithms / weights).exp();
    let apart: f64 = evidence.map(|(other, variance)| (other / mean).ln().powi(2) / variance).sum();
    // Birge's ratio (1932): what the evidence contradicts itself by, over what it should.
    let ratio = if count > 1 { (apart / f64::from(count - 1)).max(1.0) } else { 1.0 };
    Some((mean, ratio / weights))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::component::Component;

    const FIRST: fn() -> Place = || Place::new(Component::Transmitted, 0, 1);
    const SECOND: fn() -> Place = || Place::new(Component::Transmitted, 1, 1);

    fn cost(observations: u32, rays: u64, seconds: f64) -> Cost {
        let mut cost = Cost::default();
        (0..observations).for_each(|_| cost.observe(rays, seconds));
        cost
    }

    fn near(one: Option<Prediction>, seconds: f64, tolerance: f64) {
        let mean_s = one.expect("something is known").mean_s;
        assert!((mean_s / seconds - 1.0).abs() < tolerance, "{mean_s} {seconds}");
    }

    #[test]
    fn places_are_told_apart_and_the_kind_stands_in() {
        let mut profile = ProfileCache::new("", "");
        for _ in 0..20 {
            let mut costs = PictureCosts::new(&mut profile, "TT");
            costs.ran(FIRST(), 1000, 1e-3);
            costs.ran(SECOND(), 1000, 3e-3);
        }
        let costs = PictureCosts::new(&mut profile, "TT");
        near(costs.predict(FIRST(), 1_000_000), 1.0, 1e-9);
        near(costs.predict(SECOND(), 1_000_000), 3.0, 1e-9);
        // A third T, and another crex: the mean over all.
        near(costs.predict(Place::new(Component::Transmitted, 2, 1), 1_000_000), 2.0, 1e-9);
        let other = PictureCosts::new(&mut profile, "DT");
        near(other.predict(FIRST(), 1_000_000), 2.0, 1e-9);
        assert_eq!(other.predict(Place::new(Component::Diffuse, 0, 1), 1), None);
        assert_eq!(other.predict(Place::new(Component::Diffuse, 0, 1), 0), Some(Prediction::default()));
    }

    #[test]
    fn a_picture_unlike_the_others_is_predicted_by_its_own_rays() {
        // Other views took between 1 and 3 us a ray; this one's sprinkle says 2.9 from 10000 rays.
        let mut profile = ProfileCache::new("", "");
        for micros in [1.0, 3.0, 1.0, 3.0, 1.0, 3.0] {
            PictureCosts::new(&mut profile, "T").ran(FIRST(), 1000, 1e-3 * micros);
        }
        let mut costs = PictureCosts::new(&mut profile, "T");
        near(costs.predict(FIRST(), 1_000_000), 2.0, 1e-9);
        let uncertain = costs.predict(FIRST(), 1_000_000).expect("known");
        costs.sprinkled(FIRST(), &cost(100, 100, 2.9e-4));
        near(costs.predict(FIRST(), 1_000_000), 2.9, 0.05);
        let certain = costs.predict(FIRST(), 1_000_000).expect("known");
        assert!(certain.deviation_s < 0.5 * uncertain.deviation_s);
        // An earlier round of the same picture says most.
        costs.ran(FIRST(), 100_000, 0.26);
        near(costs.predict(FIRST(), 1_000_000), 2.6, 0.05);
    }

    #[test]
    fn how_the_sprinkle_errs_is_learnt() {
        // Small sets cost half as much again, always.
        let mut profile = ProfileCache::new("", "");
        for micros in [1.0, 2.0, 4.0, 3.0] {
            let mut costs = PictureCosts::new(&mut profile, "T");
            costs.sprinkled(FIRST(), &cost(50, 100, 1.5e-4 * micros));
            costs.ran(FIRST(), 100_000, 0.1 * micros);
        }
        let mut costs = PictureCosts::new(&mut profile, "T");
        costs.sprinkled(FIRST(), &cost(50, 100, 1.5e-3));
        near(costs.predict(FIRST(), 1_000_000), 10.0, 0.1);
        assert_eq!(costs.profile().cost(RayKind::Of(Component::Transmitted)).map(Cost::rays), Some(400_000));
    }

    #[test]
    fn costs_beyond_measure_admit_nothing() {
        let mut profile = ProfileCache::new("", "");
        let mut costs = PictureCosts::new(&mut profile, "T");
        for seconds in [1e-3, 1e200] {
            costs.ran(FIRST(), 1, seconds);
        }
        let costs = PictureCosts::new(&mut profile, "T");
        let predicted = costs.predict(FIRST(), 1000).expect("rays were seen");
        assert!(costs.bound_s(&predicted) > 1e6, "{predicted:?}");
    }

    #[test]
    fn contradiction_makes_uncertain() {
        let agreeing = weighed([(1.0, 0.01), (1.0, 0.01)].into_iter()).expect("two");
        assert!((agreeing.0 - 1.0).abs() < 1e-12 && (agreeing.1 - 0.005).abs() < 1e-12);
        let (mean, variance) = weighed([(1.0, 0.01), (4.0, 0.01)].into_iter()).expect("two");
        assert!((mean - 2.0).abs() < 1e-12);
        // ln 2 from both: twice ln^2 2 over .01, and half of .01.
        assert!((variance - 2.0_f64.ln().powi(2)).abs() < 1e-12);
        assert_eq!(weighed(std::iter::empty::<(f64, f64)>()), None);
    }
}
