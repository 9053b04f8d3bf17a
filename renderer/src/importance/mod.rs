//! Where people look: maps in [0, 1] that say how much a pixel matters.

pub mod distance;
pub mod fovea;
mod glyphs;
pub mod map;
pub mod ran;
pub mod saliency;
