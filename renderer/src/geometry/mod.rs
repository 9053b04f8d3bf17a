//! Shapes, and the aggregate that finds which of them a ray meets.

mod aggregate;
mod hit;
mod outliers;
pub mod shape;
mod wide;

pub use aggregate::{Aggregate, Item, Passage, Shadow};
pub use hit::{Hit, Ray, SurfaceId};
pub use shape::Shape;

#[cfg(test)]
mod tests;
