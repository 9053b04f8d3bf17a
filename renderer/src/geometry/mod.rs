//! Shapes, and the aggregate that finds which of them a ray meets.

mod aggregate;
mod block;
mod coincident;
mod hit;
mod lanes;
mod line;
mod outliers;
pub mod shape;
mod wide;
mod widen;

pub use aggregate::{Aggregate, Item, Passage, Shadow};
pub use hit::{Hit, Ray, SurfaceId};
pub use shape::Shape;

#[cfg(test)]
mod tests;
