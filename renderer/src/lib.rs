//! Radiance scenes rendered by light-transport component, in the order that a component regular expression says.

mod atomic;
pub mod cal;
pub mod color;
pub mod component;
pub mod crex;
pub mod diagnostic;
pub mod features;
pub mod film;
pub mod geometry;
pub mod importance;
pub mod material;
pub mod math;
pub mod part;
pub mod pattern;
pub mod picture;
pub mod propose;
pub mod rad;
pub mod raster;
pub mod reconstruct;
pub mod render;
pub mod sample;
pub mod scene;
pub mod schedule;
pub mod trade;
pub mod transport;
pub mod work;
