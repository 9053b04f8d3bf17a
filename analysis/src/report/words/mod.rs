//! Every sentence that a report can say about its numbers.
//!
//! A p value above the level is never read as absence of a difference: what is said of an arm comes from its interval and
//! from the equivalence test alone.

mod arm;
mod between;
mod ladder;
mod plan;
pub mod planning;
mod verdict;

pub use arm::{
    bayes, check, chi_square, informed, layout_effect, notes, order, posterior, preference, published, reach,
    usual_bounds,
};
pub use between::{contrast, multiplicity};
pub use ladder::ladder;
pub use plan::{deviations, kept};
pub use verdict::{Finding, Verdict, verdict};

use super::numbers::{percent, short};
use crate::proportion::Proportion;

/// The first digits of a hash, enough to compare by eye.
fn head(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// `9 of 16 (56.2 %)`.
pub(super) fn counted(counts: Proportion) -> String {
    match counts.value() {
        Some(share) => format!(
            "{} of {} ({})",
            super::numbers::grouped(counts.k),
            super::numbers::grouped(counts.n),
            percent(share)
        ),
        None => "0 of 0".to_owned(),
    }
}

fn percent_level(level: f64) -> String {
    format!("{} %", short(100.0 * level))
}

/// `±20 % (0.78 JOD)`.
fn bound_words(bound: crate::plan::Bound) -> String {
    format!("±{} % ({} JOD)", short(100.0 * bound.proportion), format_args!("{:.2}", bound.jod))
}
