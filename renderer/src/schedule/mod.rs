//! What the tracer does next: a crex walked against what the bins hold. Never sees scenes, rays or pixels.

mod rows;
mod scheduler;

pub use rows::{StageRow, merge_rows};
pub use scheduler::Scheduler;
