//! Whether an arm's two qualities look alike, within a bound.

use serde::Serialize;

use crate::equivalence::Tost;
use crate::order::CorrectedTost;
use crate::plan::{Bound, PlannedBound};
use crate::tally::ArmTally;

/// The equivalence tests at the planned bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Equivalence {
    /// The planned bound.
    pub bound: Bound,
    /// The exact test on the raw proportion.
    pub raw: Tost,
    /// The test on the order-corrected proportion; none where the answers by order are not known.
    pub corrected: Option<CorrectedTost>,
    /// Whether the logs show that the bound was fixed before the first participant.
    pub recorded: bool,
    /// True only when both pass and the bound was fixed beforehand.
    pub claimed: bool,
}

impl Equivalence {
    /// The tests of an arm at the planned bound; none without data or without a right answer.
    #[must_use]
    pub fn new(tally: &ArmTally, PlannedBound { bound, recorded }: PlannedBound, alpha: f64) -> Option<Self> {
        let raw = Tost::new(tally.correct, bound.proportion, alpha).filter(|_| tally.right_answer)?;
        let corrected = tally.order.as_ref().and_then(|table| CorrectedTost::new(table, bound.proportion, alpha));
        let claimed = recorded && raw.passes && corrected.is_some_and(|test| test.passes);
        Some(Self { bound, raw, corrected, recorded, claimed })
    }
}
