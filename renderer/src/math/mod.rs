//! Frames, sampling warps with their densities, and the numerical policy of rays and roots.

mod frame;
pub mod quadratic;
mod similarity;
pub mod tolerance;
pub mod warp;

pub use frame::Frame;
pub use similarity::Similarity;
