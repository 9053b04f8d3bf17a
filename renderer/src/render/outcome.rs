//! What was rendered, and how the work of parcels and tiles adds up.

use crate::component::{ComponentSet, PerComponent};
use crate::crex::Span;
use crate::film::Film;
use crate::schedule::{StageRow, merge_rows};
use crate::transport::Parcel;
use crate::work::{Stage, WorkReport};

/// What a rendering made.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The picture in its layers.
    pub film: Film,
    /// What the primary rays did.
    pub primary: WorkReport,
    /// What every stage did over the whole picture, in the order in which they ran. Seconds are summed over threads.
    pub stages: Vec<StageRow>,
    /// Rays that were spawned and not traced.
    pub left: PerComponent<u64>,
    /// Where the `*`s stand that were stopped before their rays ran out; each deserves a warning.
    pub stopped: Vec<Span>,
}

impl Rendering {
    /// What was done, without the picture.
    #[must_use]
    pub fn account(&self) -> Account {
        let Self { primary, stages, left, stopped, .. } = self;
        Account { primary: *primary, stages: stages.clone(), left: *left, stopped: stopped.clone() }
    }
}

/// What was done to make a picture or a part of it; as in [`Rendering`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Account {
    /// What the primary rays did.
    pub primary: WorkReport,
    /// What every stage did.
    pub stages: Vec<StageRow>,
    /// Rays that were spawned and not traced.
    pub left: PerComponent<u64>,
    /// Where the `*`s stand that were stopped before their rays ran out.
    pub stopped: Vec<Span>,
}

impl Account {
    /// The account of a picture from those of its parts, in any order but for the last digit of the seconds.
    #[must_use]
    pub fn sum(parts: impl IntoIterator<Item = Self>) -> Self {
        let outcome = |Self { primary, stages: rows, left, stopped }| Outcome { primary, rows, left, stopped };
        let mut sum = Outcome::default();
        sum.add_all(parts.into_iter().map(outcome).collect());
        sum.into()
    }

    /// The components of which rays were traced: those that a picture has layers for.
    #[must_use]
    pub fn reached(&self) -> ComponentSet {
        reached(&self.stages)
    }
}

impl From<Outcome> for Account {
    fn from(outcome: Outcome) -> Self {
        let Outcome { primary, rows: stages, left, mut stopped } = outcome;
        stopped.sort_by_key(|span| (span.start, span.end));
        Self { primary, stages, left, stopped }
    }
}

/// A state of the picture between two stages.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// The stage that has just ended; `None` after the primary rays.
    pub stage: Option<&'a Stage>,
    /// What it did.
    pub report: &'a WorkReport,
    /// The picture so far.
    pub film: &'a Film,
}

/// What a parcel, a tile or a picture did.
#[derive(Clone, Default)]
pub(super) struct Outcome {
    pub(super) primary: WorkReport,
    pub(super) rows: Vec<StageRow>,
    pub(super) left: PerComponent<u64>,
    pub(super) stopped: Vec<Span>,
}

impl Outcome {
    pub(super) fn add(&mut self, other: Self) {
        self.add_all(vec![other]);
    }

    pub(super) fn add_all(&mut self, others: Vec<Self>) {
        let mut rows = vec![std::mem::take(&mut self.rows)];
        for other in others {
            add_report(&mut self.primary, &other.primary);
            add_counts(&mut self.left, &other.left);
            rows.push(other.rows);
            for span in other.stopped {
                if !self.stopped.contains(&span) {
                    self.stopped.push(span);
                }
            }
        }
        self.rows = merge_rows(rows);
    }
}

pub(super) fn add_counts(sum: &mut PerComponent<u64>, counts: &PerComponent<u64>) {
    for (component, sum) in sum.iter_mut() {
        *sum += counts[component];
    }
}

pub(super) fn add_report(sum: &mut WorkReport, report: &WorkReport) {
    sum.rays += report.rays;
    sum.seconds += report.seconds;
    add_counts(&mut sum.spawned, &report.spawned);
}

pub(super) fn occupancy(parcels: &[Parcel]) -> PerComponent<u64> {
    let mut sum = PerComponent::default();
    parcels.iter().for_each(|parcel| add_counts(&mut sum, &parcel.occupancy()));
    sum
}

/// The components of which rays were traced.
pub(super) fn reached(rows: &[StageRow]) -> ComponentSet {
    rows.iter().filter(|row| row.report.rays > 0).map(|row| row.stage.component).collect()
}

pub(super) fn finish(mut film: Film, outcome: Outcome) -> Rendering {
    let Account { primary, stages, left, stopped } = outcome.into();
    film.keep(reached(&stages));
    Rendering { film, primary, stages, left, stopped }
}
