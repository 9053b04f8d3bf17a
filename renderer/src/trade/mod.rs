//! The trade of quality for time: the curve of what was measured, its front, its knee, and its picture.

mod curve;
mod svg;

pub use curve::{Curve, Half, Loss, Modulated, Point};
pub use svg::svg;
