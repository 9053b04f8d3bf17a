//! The profile cache of the paper's section 5.1: what rays of each kind cost on one scene and machine, and how far
//! predictions from it have been off.

use std::collections::BTreeMap;

use crate::component::{Component, PerComponent};

use super::calibration::Calibration;
use super::cost::{Cost, RayKind};
use super::offspring::Offspring;
use super::place::Place;

/// Seconds by which the operating system may lengthen a task of any size: the least standard deviation of a prediction.
pub const JITTER_S: f64 = 2e-4;

/// The standard deviation of a cost, as part of its mean, that is assumed before observations say otherwise; it counts
/// as [`PRIOR_OBSERVATIONS`] of them. The paper's own errors (Table 3) are of this order.
pub const PRIOR_SPREAD: f64 = 0.25;

/// How many observations [`PRIOR_SPREAD`] counts as.
pub const PRIOR_OBSERVATIONS: f64 = 2.0;

/// Deviations that are kept for a chore beyond its mean: of three chores that err on their own, as many as follow a picture, 1.7
/// of their sum.
pub const KEPT_DEVIATIONS: f64 = 1.0;

/// What a chore may take, as a multiple of what is kept for it, and be believed.
pub const MOST_EXCESS: f64 = 2.0;

/// How long a task is expected to take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Its mean, in seconds.
    pub mean_s: f64,
    /// Its standard deviation, in seconds.
    pub deviation_s: f64,
}

impl Prediction {
    /// Of both one after the other. What makes one late (a busy machine) makes the other late too, so deviations are added
    /// and not their squares.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { mean_s: self.mean_s + other.mean_s, deviation_s: self.deviation_s + other.deviation_s }
    }
}

/// What rays cost on one scene and machine.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileCache {
    scene: String,
    machine: String,
    /// All that is known.
    known: [Cost; 7],
    calibration: Calibration,
    /// What of it was learnt since the cache was read or stored: another run may store in the meantime.
    fresh: [Cost; 7],
    fresh_errors: Vec<f64>,
    /// What finishing pictures has cost, by the name of the format for writers; its "rays" are bytes.
    writers: BTreeMap<String, Cost>,
    fresh_writers: BTreeMap<String, Cost>,
    /// What rays spawned along complete paths, by what the paths were.
    children: BTreeMap<String, Family>,
    fresh_children: BTreeMap<String, Family>,
    /// What rays cost at each place of a crex, by what the paths were.
    places: BTreeMap<String, Places>,
    fresh_places: BTreeMap<String, Places>,
}

/// The offspring of each kind of ray.
type Family = [Offspring; 7];

/// What is known of the places of a crex.
type Places = BTreeMap<Place, PlaceCost>;

/// What rays cost at a place of a crex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaceCost {
    /// In rounds over the whole picture.
    pub rays: Cost,
    /// The same, for each nanosecond (in place of rays) that they would have taken at the cost of the picture's sprinkle.
    pub pace: Cost,
}

impl ProfileCache {
    /// An empty cache. `scene` and `machine` say what its costs hold for: a hash of all that the scene was made from, and a
    /// fingerprint of processor, threads and program. Any text will do; equal means that costs carry over.
    #[must_use]
    pub fn new(scene: impl Into<String>, machine: impl Into<String>) -> Self {
        Self {
            scene: scene.into(),
            machine: machine.into(),
            known: [Cost::default(); 7],
            calibration: Calibration::default(),
            fresh: [Cost::default(); 7],
            fresh_errors: Vec::new(),
            writers: BTreeMap::new(),
            fresh_writers: BTreeMap::new(),
            children: BTreeMap::new(),
            fresh_children: BTreeMap::new(),
            places: BTreeMap::new(),
            fresh_places: BTreeMap::new(),
        }
    }

    /// The scene that the costs hold for.
    #[must_use]
    pub fn scene(&self) -> &str {
        &self.scene
    }

    /// The machine that the costs hold for.
    #[must_use]
    pub fn machine(&self) -> &str {
        &self.machine
    }

    /// What is known of a kind of ray; none before the first observation.
    #[must_use]
    pub fn cost(&self, kind: RayKind) -> Option<&Cost> {
        Some(&self.known[kind.index()]).filter(|cost| cost.rays() > 0)
    }

    /// How far predictions have been off.
    #[must_use]
    pub fn calibration(&self) -> &Calibration {
        &self.calibration
    }

    /// Takes in that `rays` rays of a kind took `seconds` together.
    pub fn observe(&mut self, kind: RayKind, rays: u64, seconds: f64) {
        self.known[kind.index()].observe(rays, seconds);
        self.fresh[kind.index()].observe(rays, seconds);
    }

    /// Takes in that `rays` rays took `seconds` together at a place of a crex; `paths` as for
    /// [`Self::observe_children`]. The kind's own cost is another matter.
    pub(super) fn observe_place(&mut self, paths: &str, place: Place, rays: u64, seconds: f64) {
        self.of_place(paths, place, |known| known.rays.observe(rays, seconds));
    }

    /// The same of how rounds compare with the sprinkle.
    pub(super) fn observe_pace(&mut self, paths: &str, place: Place, expected_ns: u64, seconds: f64) {
        self.of_place(paths, place, |known| known.pace.observe(expected_ns, seconds));
    }

    fn of_place(&mut self, paths: &str, place: Place, teach: impl Fn(&mut PlaceCost)) {
        for places in [&mut self.places, &mut self.fresh_places] {
            if !places.contains_key(paths) {
                places.insert(paths.to_owned(), Places::new());
            }
            let known = places.get_mut(paths).expect("it was just put there");
            teach(known.entry(place).or_default());
        }
    }

    /// What is known of a place; none before anything was observed there.
    #[must_use]
    pub fn place(&self, paths: &str, place: Place) -> Option<&PlaceCost> {
        self.places.get(paths)?.get(&place)
    }

    /// All that is known of places, by crex and limits.
    pub fn places(&self) -> impl Iterator<Item = (&str, impl Iterator<Item = (Place, &PlaceCost)>)> {
        self.places.iter().map(|(paths, places)| (paths.as_str(), places.iter().map(|(place, cost)| (*place, cost))))
    }

    /// Takes in what `parents` rays of a kind spawned, all on paths that ran through a whole crex. `paths` says which crex that
    /// was, and under which limits: what rays spawn depends on both.
    pub fn observe_children(&mut self, paths: &str, kind: RayKind, parents: u64, spawned: &PerComponent<u64>) {
        let more = Offspring::new(parents, *spawned);
        for children in [&mut self.children, &mut self.fresh_children] {
            children.entry(paths.to_owned()).or_default()[kind.index()].add(&more);
        }
    }

    /// How many complete paths of this kind have been seen.
    #[must_use]
    pub fn paths_seen(&self, paths: &str) -> u64 {
        self.children.get(paths).map_or(0, |family| family[RayKind::Primary.index()].parents())
    }

    /// Children of `component` that a ray of a kind has on average along such paths; 0 where nothing is known.
    #[must_use]
    pub fn children_per_ray(&self, paths: &str, kind: RayKind, component: Component) -> f64 {
        self.children.get(paths).map_or(0.0, |family| family[kind.index()].per_ray(component))
    }

    /// What is known of complete paths: what they were, and of each kind of ray its offspring.
    pub fn children(&self) -> impl Iterator<Item = (&str, impl Iterator<Item = (RayKind, &Offspring)>)> {
        self.children.iter().map(|(paths, family)| {
            let seen = RayKind::ALL.into_iter().zip(family).filter(|(_, offspring)| offspring.parents() > 0);
            (paths.as_str(), seen)
        })
    }

    /// Takes in that a writer, named by its format, or another chore that ends a picture took `seconds` for so many bytes of
    /// pixels. More than [`MOST_EXCESS`] times what would have been kept for it is taken for that much: a disk that stalled once is
    /// not to starve the pictures that follow, and one that has become slower is learnt all the same.
    pub fn observe_writer(&mut self, name: &str, bytes: u64, seconds: f64) {
        let most_s = self.kept_s(name, bytes).map_or(f64::INFINITY, |kept_s| MOST_EXCESS * kept_s);
        let seconds = seconds.min(most_s);
        for writers in [&mut self.writers, &mut self.fresh_writers] {
            writers.entry(name.to_owned()).or_default().observe(bytes, seconds);
        }
    }

    /// What a writer will take for so many bytes of pixels; none if nothing is known of it.
    #[must_use]
    pub fn predict_writer(&self, name: &str, bytes: u64) -> Option<Prediction> {
        self.writers.get(name).filter(|cost| cost.rays() > 0).map(|cost| predict(cost, bytes))
    }

    /// What is known of writers, by the names of their formats; rays are bytes.
    pub fn writers(&self) -> impl Iterator<Item = (&str, &Cost)> {
        self.writers.iter().map(|(name, cost)| (name.as_str(), cost))
    }

    /// What `rays` rays of a kind will take; none if nothing is known of that kind.
    ///
    /// The deviation is that between observations, shrunk towards [`PRIOR_SPREAD`], widened by the uncertainty of the mean
    /// itself (1 + 1/n), and at least [`JITTER_S`].
    #[must_use]
    pub fn predict(&self, kind: RayKind, rays: u64) -> Option<Prediction> {
        if rays == 0 {
            return Some(Prediction::default());
        }
        self.cost(kind).map(|cost| predict(cost, rays))
    }

    /// The seconds that a predicted task will not exceed with the confidence of
    /// [`CONFIDENCE`](super::calibration::CONFIDENCE); nothing for a task without rays.
    #[must_use]
    pub fn bound_s(&self, prediction: &Prediction) -> f64 {
        (prediction.mean_s + self.calibration.factor() * prediction.deviation_s).max(0.0)
    }

    /// Seconds to keep for a writer or another chore: [`KEPT_DEVIATIONS`] more than its mean. Its errors are not those of rays,
    /// and what is kept and not needed is lost.
    #[must_use]
    pub fn kept_s(&self, name: &str, bytes: u64) -> Option<f64> {
        self.predict_writer(name, bytes).map(|predicted| predicted.mean_s + KEPT_DEVIATIONS * predicted.deviation_s)
    }

    /// Takes in how long a predicted task took.
    pub fn record(&mut self, prediction: &Prediction, seconds: f64) {
        let error = (seconds - prediction.mean_s) / prediction.deviation_s;
        if error.is_finite() {
            self.calibration.record(error);
            self.fresh_errors.push(error);
        }
    }

    /// Takes in what another cache of the same scene and machine learnt since it was read.
    pub(super) fn add_fresh(&mut self, other: &Self) {
        for (name, fresh) in &other.fresh_writers {
            for writers in [&mut self.writers, &mut self.fresh_writers] {
                writers.entry(name.clone()).or_default().add(fresh);
            }
        }
        for (paths, fresh) in &other.fresh_children {
            for children in [&mut self.children, &mut self.fresh_children] {
                let family = children.entry(paths.clone()).or_default();
                family.iter_mut().zip(fresh).for_each(|(known, fresh)| known.add(fresh));
            }
        }
        for (paths, fresh) in &other.fresh_places {
            for (&place, fresh) in fresh {
                self.of_place(paths, place, |known| {
                    known.rays.add(&fresh.rays);
                    known.pace.add(&fresh.pace);
                });
            }
        }
        for (kind, fresh) in other.fresh.iter().enumerate() {
            self.known[kind].add(fresh);
            self.fresh[kind].add(fresh);
        }
        for &error in &other.fresh_errors {
            self.calibration.record(error);
            self.fresh_errors.push(error);
        }
    }

    /// Sets what is known of a kind, as it was stored.
    pub(super) fn restore(&mut self, kind: RayKind, cost: Cost) {
        self.known[kind.index()] = cost;
    }

    /// Sets what rays of a kind spawned along complete paths, as it was stored.
    pub(super) fn restore_children(&mut self, paths: &str, kind: RayKind, offspring: Offspring) {
        self.children.entry(paths.to_owned()).or_default()[kind.index()] = offspring;
    }

    /// Sets what is known of a place, as it was stored.
    pub(super) fn restore_place(&mut self, paths: &str, place: Place, cost: PlaceCost) {
        self.places.entry(paths.to_owned()).or_default().insert(place, cost);
    }

    /// Sets what is known of a writer, as it was stored.
    pub(super) fn restore_writer(&mut self, name: String, cost: Cost) {
        self.writers.insert(name, cost);
    }

    /// Sets how far predictions have been off, as it was stored; the oldest first.
    pub(super) fn restore_errors(&mut self, errors: impl IntoIterator<Item = f64>) {
        errors.into_iter().for_each(|error| self.calibration.record(error));
    }

    /// Forgets which part of what is known is not stored yet: all of it is.
    pub(super) fn stored(&mut self) {
        self.fresh = [Cost::default(); 7];
        self.fresh_errors.clear();
        self.fresh_writers.clear();
        self.fresh_children.clear();
        self.fresh_places.clear();
    }
}

/// What so many units (rays, bytes) of known cost will take.
fn predict(cost: &Cost, units: u64) -> Prediction {
    let observations = cost.effective_observations();
    let prior = (PRIOR_SPREAD * cost.mean_s()).powi(2);
    let variance =
        (observations * cost.spread_s().powi(2) + PRIOR_OBSERVATIONS * prior) / (observations + PRIOR_OBSERVATIONS);
    let of_units = units as f64 * (variance * (1.0 + 1.0 / observations)).sqrt();
    Prediction { mean_s: units as f64 * cost.mean_s(), deviation_s: of_units.hypot(JITTER_S) }
}
