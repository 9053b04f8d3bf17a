//! Pictures from fewer samples than they would need: smoothed, which is biased and so only done on request and with the
//! noise before and after; and filled in where a time limit left pixels without a sample.

mod fill;
mod padded;
mod smooth;

pub use fill::fill;
pub use smooth::{Guides, Smoothed, smooth};
