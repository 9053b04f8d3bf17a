//! The profile cache on disk: JSON that may be read, shared by runs that end at the same time, never half written.
//!
//! ```json
//! {
//!   "format": "crex profile 3",
//!   "scene": "<hash of what the scene was made from>",
//!   "machine": "<processor, threads, program>",
//!   "rays": {
//!     "primary": {"rays": 1228800, "observations": 1, "effective": 1.0, "mean_s": 1.1e-6, "spread_s": 0.0},
//!     "D": ...
//!   },
//!   "writers": {"zip": {"rays": 103680000, ...}},
//!   "places": {"(TRD)* <limits>": {"T@1 run 2": {"rays": {"rays": 31000, ...}, "pace": {"rays": 44000000, ...}}, ...}},
//!   "children": {"(TRD)* <limits>": {"primary": {"parents": 4800, "spawned": {"D": 3600, "T": 120}}, ...}},
//!   "errors": [-0.4, 1.2]
//! }
//! ```
//! `mean_s` and `spread_s` are seconds a ray, `effective` the number of equal observations that would say as much,
//! `errors` those of past predictions in deviations, the oldest first. `writers` is the cost of writing pictures, by format
//! or EXR's compression, and of other chores (`gather`, `develop`, `soften`, `fill`), of which bytes are counted in place of rays, and of
//! the `sprinkle`, of which nanoseconds are counted that its rays were expected to take. `places` holds, for a crex and the limits
//! of its paths, what rays of rounds cost at each place: the letter, the byte at which it stands, and which of its runs it is (the
//! 16th stands for all later ones). `pace` is the same for each nanosecond that they would have taken at the cost of their picture's
//! sprinkle. `children` holds, for a crex and the
//! limits of its paths, rays of complete paths and what they spawned. Kinds never observed are absent.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::component::{Component, PerComponent};

use super::calibration::REMEMBERED;
use super::cost::{Cost, RayKind};
use super::offspring::Offspring;
use super::place::Place;
use super::profile::{PlaceCost, ProfileCache};
use crate::atomic::AtomicFile;

const FORMAT: &str = "crex profile 3";

/// How often and how long to wait for another run that is storing: a second in all.
const PATIENCE: (u32, Duration) = (100, Duration::from_millis(10));

/// Why a profile could not be read or stored.
#[derive(Debug, Error)]
pub enum ProfileError {
    /// The file system refused.
    #[error("{path}: {source}")]
    Io {
        /// Which file.
        path: PathBuf,
        /// What it said.
        source: io::Error,
    },
    /// It is not a profile.
    #[error("{path}:{line}:{column}: not a profile: {message}; delete it, and the next run makes a new one")]
    Broken {
        /// Which file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What was expected.
        message: String,
    },
    /// Its costs are those of something else.
    #[error("{path} was measured for {what} {found:?}, not {expected:?}: name another file, or delete this one")]
    Other {
        /// Which file.
        path: PathBuf,
        /// Scene, machine or format.
        what: &'static str,
        /// What the file says.
        found: String,
        /// What this run is.
        expected: String,
    },
    /// Another run keeps the file locked.
    #[error("{path} has been locked by another run for more than a second")]
    Locked {
        /// The lock's file.
        path: PathBuf,
    },
}

#[derive(Serialize, Deserialize)]
struct Stored {
    format: String,
    scene: String,
    machine: String,
    rays: BTreeMap<String, StoredCost>,
    #[serde(default)]
    writers: BTreeMap<String, StoredCost>,
    #[serde(default)]
    places: BTreeMap<String, BTreeMap<String, StoredPlace>>,
    #[serde(default)]
    children: BTreeMap<String, BTreeMap<String, StoredOffspring>>,
    errors: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
struct StoredCost {
    rays: u64,
    observations: u64,
    effective: f64,
    mean_s: f64,
    spread_s: f64,
}

#[derive(Serialize, Deserialize)]
struct StoredPlace {
    rays: StoredCost,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pace: Option<StoredCost>,
}

#[derive(Serialize, Deserialize)]
struct StoredOffspring {
    parents: u64,
    spawned: BTreeMap<char, u64>,
}

impl ProfileCache {
    /// Reads the profile of a scene and machine; an empty one if there is no such file.
    ///
    /// # Errors
    /// If the file cannot be read, is not a profile, or is one of another scene or machine.
    pub fn load(path: &Path, scene: &str, machine: &str) -> Result<Self, ProfileError> {
        match fs::read_to_string(path) {
            Ok(text) => from_json(&text, path, scene, machine),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Self::new(scene, machine)),
            Err(source) => Err(ProfileError::Io { path: path.to_owned(), source }),
        }
    }

    /// Stores what was learnt since the cache was read or last stored, together with what other runs have stored
    /// meanwhile; the cache then holds both.
    ///
    /// The new file is written beside the old one and takes its name when it is complete; the system brings it to disk when it
    /// likes, since saving counts as part of a time limit. Runs wait for each other by a lock on a file beside it (`.lock`),
    /// which the system lifts when a run dies.
    ///
    /// # Errors
    /// As [`Self::load`]; if it cannot be written; if another run keeps it locked for more than a second. What is on disk
    /// is then as it was.
    pub fn save(&mut self, path: &Path) -> Result<(), ProfileError> {
        let lock = lock(&beside(path, ".lock"))?;
        let mut all = Self::load(path, self.scene(), self.machine())?;
        all.add_fresh(self);
        AtomicFile::write_all_unsynced(path, to_json(&all).as_bytes())
            .map_err(|source| ProfileError::Io { path: path.to_owned(), source })?;
        drop(lock);
        all.stored();
        *self = all;
        Ok(())
    }
}

/// The file's name with `ending` appended.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(ending);
    name.into()
}

/// Locks a file until it is dropped.
fn lock(path: &Path) -> Result<File, ProfileError> {
    let io_error = |source| ProfileError::Io { path: path.to_owned(), source };
    let file = OpenOptions::new().create(true).truncate(false).write(true).open(path).map_err(io_error)?;
    let (times, pause) = PATIENCE;
    for _ in 0..times {
        match file.try_lock() {
            Ok(()) => return Ok(file),
            Err(TryLockError::WouldBlock) => sleep(pause),
            Err(TryLockError::Error(source)) => return Err(io_error(source)),
        }
    }
    Err(ProfileError::Locked { path: path.to_owned() })
}

/// What a kind of ray is called in the file.
fn name(kind: RayKind) -> String {
    match kind {
        RayKind::Primary => "primary".to_owned(),
        RayKind::Of(component) => component.to_string(),
    }
}

fn to_json(cache: &ProfileCache) -> String {
    let costs = RayKind::ALL.into_iter().filter_map(|kind| Some((kind, cache.cost(kind)?)));
    let stored = Stored {
        format: FORMAT.to_owned(),
        scene: cache.scene().to_owned(),
        machine: cache.machine().to_owned(),
        rays: costs.map(|(kind, cost)| (name(kind), stored_cost(cost))).collect(),
        writers: cache.writers().map(|(name, cost)| (name.to_owned(), stored_cost(cost))).collect(),
        places: cache.places().map(|(paths, places)| (paths.to_owned(), places.map(stored_place).collect())).collect(),
        children: cache.children().map(|(paths, family)| (paths.to_owned(), stored_family(family))).collect(),
        errors: cache.calibration().errors().collect(),
    };
    let mut text = serde_json::to_string_pretty(&stored).expect("text keys and finite numbers are JSON");
    text.push('\n');
    text
}

fn stored_family<'a>(family: impl Iterator<Item = (RayKind, &'a Offspring)>) -> BTreeMap<String, StoredOffspring> {
    let stored = |offspring: &Offspring| {
        let spawned = offspring.spawned().iter().filter(|(_, count)| **count > 0);
        let spawned = spawned.map(|(component, count)| (component.letter(), *count)).collect();
        StoredOffspring { parents: offspring.parents(), spawned }
    };
    family.map(|(kind, offspring)| (name(kind), stored(offspring))).collect()
}

fn stored_place((place, PlaceCost { rays, pace }): (Place, &PlaceCost)) -> (String, StoredPlace) {
    let pace = Some(stored_cost(pace)).filter(|pace| pace.rays > 0);
    (place.to_string(), StoredPlace { rays: stored_cost(rays), pace })
}

fn stored_cost(cost: &Cost) -> StoredCost {
    StoredCost {
        rays: cost.rays(),
        observations: cost.observations(),
        effective: cost.effective_observations(),
        mean_s: cost.mean_s(),
        spread_s: cost.spread_s(),
    }
}

fn from_json(text: &str, path: &Path, scene: &str, machine: &str) -> Result<ProfileCache, ProfileError> {
    let broken = |line, column, message: String| ProfileError::Broken { path: path.to_owned(), line, column, message };
    let stored: Stored =
        serde_json::from_str(text).map_err(|error| broken(error.line(), error.column(), error.to_string()))?;
    for (what, found, expected) in
        [("format", &stored.format, FORMAT), ("scene", &stored.scene, scene), ("machine", &stored.machine, machine)]
    {
        if found != expected {
            let (found, expected) = (found.clone(), expected.to_owned());
            return Err(ProfileError::Other { path: path.to_owned(), what, found, expected });
        }
    }
    let mut cache = ProfileCache::new(scene, machine);
    let refuse = |key: &str, message: &str| {
        let quoted = format!("\"{key}\"");
        let line = text.lines().position(|line| line.contains(&quoted)).unwrap_or(0);
        let column = text.lines().nth(line).and_then(|line| line.find(&quoted)).unwrap_or(0);
        broken(line + 1, column + 1, message.to_owned())
    };
    let kind = |key: &str| {
        let kind = RayKind::ALL.into_iter().find(|kind| name(*kind) == key);
        kind.ok_or_else(|| refuse(key, "expected primary or one of the components D S G T R M"))
    };
    let numbers = "expected rays (or bytes), observations and seconds of at least 0";
    let known = |key: &str, stored: StoredCost| {
        let StoredCost { rays, observations, effective, mean_s, spread_s } = stored;
        Cost::from_parts(rays, observations, mean_s, spread_s, effective).ok_or_else(|| refuse(key, numbers))
    };
    for (key, stored) in stored.rays {
        cache.restore(kind(&key)?, known(&key, stored)?);
    }
    for (key, stored) in stored.writers {
        let cost = known(&key, stored)?;
        cache.restore_writer(key, cost);
    }
    for (paths, places) in stored.places {
        for (key, StoredPlace { rays, pace }) in places {
            let place = key.parse().map_err(|_| refuse(&key, "expected primary or a place such as D@3 run 1"))?;
            let pace = pace.map_or(Ok(Cost::default()), |pace| known(&key, pace))?;
            cache.restore_place(&paths, place, PlaceCost { rays: known(&key, rays)?, pace });
        }
    }
    for (paths, family) in stored.children {
        for (key, StoredOffspring { parents, spawned: counts }) in family {
            let mut spawned = PerComponent::default();
            for (letter, count) in counts {
                let component = Component::from_letter(letter);
                let component =
                    component.ok_or_else(|| refuse(&letter.to_string(), "expected rays of D S G T R M only"))?;
                spawned[component] = count;
            }
            cache.restore_children(&paths, kind(&key)?, Offspring::new(parents, spawned));
        }
    }
    let skip = stored.errors.len().saturating_sub(REMEMBERED);
    cache.restore_errors(stored.errors.into_iter().skip(skip));
    Ok(cache)
}
