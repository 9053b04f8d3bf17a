//! Plots as SVG, in the page's own colours and type: nothing is drawn that the page's style does not know.

mod canvas;
mod curves;
mod flow;
mod intervals;
mod ladder;
mod timing;

pub use curves::{posterior, power_by_people, power_by_truth, power_curve};
pub use flow::flow;
pub use intervals::{Row, intervals};
pub use ladder::ladder;
pub use timing::timing;

/// A drawing with the words that stand for it where it cannot be seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Figure {
    /// The SVG element, without accessible name: the page puts it in a figure that has one.
    pub svg: String,
    /// Printed below.
    pub caption: String,
    /// What the drawing shows, for those who do not see it.
    pub description: String,
}
