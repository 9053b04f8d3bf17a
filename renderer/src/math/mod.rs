//! Frames, sampling warps with their densities, and the numerical policy of rays and roots.

mod frame;
pub mod quadratic;
pub mod tolerance;
pub mod warp;

pub use frame::Frame;
