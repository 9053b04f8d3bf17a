//! Pictures from fewer samples than they would need: biased, so only on request and with the noise before and after.

mod padded;
mod smooth;

pub use smooth::{Guides, Smoothed, smooth};
