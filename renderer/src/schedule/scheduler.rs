//! A crex's walk without a time limit: everything runs.

use crate::crex::{Cursor, Program, Span, ThresholdError};
use crate::work::{BinOccupancy, Stage, Work, WorkReport};

use super::rows::{Skipped, StageRow};

/// Decides what the tracer does next over one set of bins, and keeps a row of every stage that ran.
///
/// Primary rays come before its first decision and are no stage of it. Call [`next`](Self::next), do the work, give
/// [`report`](Self::report) what a run did, again.
#[derive(Clone, Debug)]
pub struct Scheduler<'p> {
    cursor: Cursor<'p>,
    /// The stage handed out and not yet reported.
    running: Option<Stage>,
    rows: Vec<StageRow>,
    /// Which stages run; none is all. From the record of a run under a time limit.
    ran: Option<&'p [bool]>,
}

impl<'p> Scheduler<'p> {
    /// A walk along `program`, with `thresholds` in place of its own if given: one importance in [0, 1] for each member
    /// of each `{ }`, from left to right.
    ///
    /// # Errors
    /// As [`Program::check_thresholds`].
    pub fn new(program: &'p Program, thresholds: Option<&[f32]>) -> Result<Self, ThresholdError> {
        let mut cursor = Cursor::new(program);
        if let Some(thresholds) = thresholds {
            cursor = cursor.with_thresholds(thresholds)?;
        }
        Ok(Self { cursor, running: None, rows: Vec::new(), ran: None })
    }

    /// The same walk with a decision for every stage in the order in which they come: whether it runs or is skipped as if
    /// for time. Stages beyond the last decision are skipped.
    #[must_use]
    pub fn with_decisions(self, ran: &'p [bool]) -> Self {
        Self { ran: Some(ran), ..self }
    }

    /// What to do next; none when the crex has ended. Components whose bins are empty run too: tracing nothing is a
    /// stage. Without a time limit the `occupancy` decides nothing.
    #[allow(clippy::should_implement_trait, reason = "an iterator would hide that reports must come in between")]
    pub fn next(&mut self, _occupancy: &BinOccupancy) -> Option<Work> {
        loop {
            let work = self.cursor.next()?;
            let Work::Run(stage) = &work else { return Some(work) };
            if self.ran.is_none_or(|ran| ran.get(self.rows.len()).copied().unwrap_or(false)) {
                self.running = Some(stage.clone());
                return Some(work);
            }
            self.cursor.report(0);
            let (report, skipped) = (WorkReport::default(), Some(Skipped::Time));
            self.rows.push(StageRow { stage: stage.clone(), report, predicted_s: None, bound_s: None, skipped });
        }
    }

    /// What the last [`Work::Run`] did.
    pub fn report(&mut self, report: &WorkReport) {
        self.cursor.report(report.rays);
        if let Some(stage) = self.running.take() {
            self.rows.push(StageRow::ran(stage, *report));
        }
    }

    /// Where the `*`s stand that were stopped after a million runs; each deserves a warning.
    #[must_use]
    pub fn stopped(&self) -> &[Span] {
        self.cursor.stopped()
    }

    /// The rows of all stages reported so far, in the order in which they ran.
    #[must_use]
    pub fn rows(&self) -> &[StageRow] {
        &self.rows
    }

    /// The same, to keep.
    #[must_use]
    pub fn into_rows(self) -> Vec<StageRow> {
        self.rows
    }
}
