//! Where people look: maps in [0, 1] that say how much a pixel matters.

pub mod distance;
pub mod fovea;
pub mod glob;
mod glyphs;
pub mod map;
pub mod overlay;
pub mod ran;
pub mod saliency;
