//! Rays between hits: what a parcel of them does in each stage. Knows no crex, no clock and no picture.
//!
//! A [`Parcel`] is the work unit: a block of pixels and a range of sample numbers, with its own bins and planes.
//! [`Tracer`] traces one ray: nearest hit, emission, direct light, and then every lobe goes through the one door in
//! `spawn` to a bin.

mod air;
mod bins;
mod dimension;
mod direct;
mod first_hits;
mod lattice;
mod look;
mod modulation;
mod own;
mod parcel;
mod ray;
mod spawn;
mod trace;

pub use air::Medium;
pub use bins::{RayBins, SpawnRecord};
pub use lattice::{RANKS, rank};
pub use modulation::{Choice, Modulation, Rule};
pub use parcel::{Parcel, Samples, Workspace};
pub use ray::{PathRay, RayPath, transmittance};
pub use spawn::Limits;
pub use trace::Tracer;
