//! What the tracer does next: a crex walked against what the bins hold. Never sees scenes, rays or pixels.

mod clock;
mod executed;
mod rows;
mod scheduler;

pub use clock::{Clock, ManualClock, MonotonicClock};
pub use executed::{Executed, executed};
pub use rows::{Skipped, StageRow, merge_rows};
pub use scheduler::Scheduler;
