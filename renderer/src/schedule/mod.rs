//! What the tracer does next: a crex walked against what the bins hold, and under a time limit against what rays have
//! cost so far. Never sees scenes, rays or pixels.

mod budget;
mod calibration;
mod clock;
mod cost;
mod estimate;
mod executed;
mod here;
mod offspring;
mod place;
mod profile;
mod profile_file;
mod rows;
mod scheduler;
mod timed;

pub use budget::Budget;
pub use calibration::{CONFIDENCE, Calibration, FIRST_FACTOR, REMEMBERED};
pub use clock::{Clock, ManualClock, MonotonicClock};
pub use cost::{Cost, RayKind};
pub use estimate::{Estimate, Expected, estimate};
pub use executed::{Executed, executed};
pub use here::PictureCosts;
pub use offspring::Offspring;
pub use place::Place;
pub use profile::{
    JITTER_S, KEPT_DEVIATIONS, MOST_EXCESS, PRIOR_OBSERVATIONS, PRIOR_SPREAD, PlaceCost, Prediction, ProfileCache,
};
pub use profile_file::ProfileError;
pub use rows::{Skipped, StageRow, merge_rows};
pub use scheduler::Scheduler;
pub use timed::{LEAST_PROBE, PROBE_SHARE, PROBE_TIME, PROBES, TimedScheduler, TimedWork};
