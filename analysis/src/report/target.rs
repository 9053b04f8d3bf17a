//! How many people an aim takes.

use serde::Serialize;

use crate::power::SampleSize;

/// The people that one target takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Target {
    /// The power aimed at.
    pub power: f64,
    /// The numbers of people; none where a million are too few.
    pub people: Option<SampleSize>,
    /// `held_from` rounded up to a multiple of 4, so that the cells of an arm can be balanced.
    pub balanced: Option<u64>,
    /// For equivalence: the probability that raw and order-corrected test both pass with `balanced` people without a
    /// lean; none beyond a number that can be enumerated.
    pub both_pass: Option<f64>,
}
