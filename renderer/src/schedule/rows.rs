//! The record of an execution: a row for every stage, and the rows of image tiles made into those of the picture.

use std::collections::{BTreeMap, HashMap};

use crate::work::{Stage, StageKey, WorkReport};

/// A stage and what it did.
#[derive(Clone, Debug, PartialEq)]
pub struct StageRow {
    /// Which stage.
    pub stage: Stage,
    /// What it did; nothing if it was skipped.
    pub report: WorkReport,
    /// Seconds that its task was predicted to take, under a time limit.
    pub predicted_s: Option<f64>,
    /// Seconds that its task was predicted not to exceed, with the profile's confidence.
    pub bound_s: Option<f64>,
    /// Why it did not run.
    pub skipped: Option<Skipped>,
}

/// Why a stage did not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skipped {
    /// Its task was not predicted to end in the time left.
    Time,
}

impl StageRow {
    /// The row of a stage that ran without a prediction.
    #[must_use]
    pub fn ran(stage: Stage, report: WorkReport) -> Self {
        Self { stage, report, predicted_s: None, bound_s: None, skipped: None }
    }
}

/// The rows of one execution over the whole picture, from those of the tiles that each ran the same program by itself:
/// rays, spawned rays and seconds of equal keys are summed, rows come in the order in which one execution runs them, and
/// runs of a letter are counted anew, since a tile may have run a repeat less often than another.
///
/// Tiles may come in any order; the sum of their seconds is rounded in the order given.
#[must_use]
pub fn merge_rows(tiles: impl IntoIterator<Item = Vec<StageRow>>) -> Vec<StageRow> {
    let mut merged: BTreeMap<StageKey, StageRow> = BTreeMap::new();
    for row in tiles.into_iter().flatten() {
        match merged.get_mut(&row.stage.key) {
            None => {
                merged.insert(row.stage.key.clone(), row);
            }
            Some(sum) => {
                // Skipped only if it was skipped everywhere; else what was predicted of those that ran is what it took.
                match (sum.skipped, row.skipped) {
                    (None, Some(_)) => {}
                    (Some(_), None) => (sum.predicted_s, sum.bound_s) = (row.predicted_s, row.bound_s),
                    _ => {
                        sum.predicted_s = sum.predicted_s.zip(row.predicted_s).map(|(one, other)| one + other);
                        sum.bound_s = sum.bound_s.zip(row.bound_s).map(|(one, other)| one + other);
                    }
                }
                sum.skipped = sum.skipped.and(row.skipped);
                sum.report.rays += row.report.rays;
                sum.report.seconds += row.report.seconds;
                for (component, count) in sum.report.spawned.iter_mut() {
                    *count += row.report.spawned[component];
                }
            }
        }
    }
    let mut runs: HashMap<(usize, usize), u64> = HashMap::new();
    let mut rows: Vec<_> = merged.into_values().collect();
    for row in &mut rows {
        let run = runs.entry(row.stage.span).or_default();
        *run += 1;
        row.stage.run = *run;
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::component::Component;

    #[test]
    fn predictions_are_those_of_the_rounds_that_ran() {
        let row = |predicted_s: f64, skipped: Option<Skipped>| {
            let key = StageKey::from_words([0].into_iter());
            let component = Component::Diffuse;
            let stage = Stage { key, component, span: (0, 1), run: 1, threshold: None, held: false, group: None };
            let report = WorkReport { rays: u64::from(skipped.is_none()), ..WorkReport::default() };
            StageRow { stage, report, predicted_s: Some(predicted_s), bound_s: Some(2.0 * predicted_s), skipped }
        };
        let time = Some(Skipped::Time);
        for (rounds, predicted_s, skipped) in [
            ([(1.0, None), (2.0, None), (4.0, None)], 7.0, None),
            ([(1.0, None), (2.0, time), (4.0, None)], 5.0, None),
            ([(1.0, time), (2.0, None), (4.0, time)], 2.0, None),
            ([(1.0, time), (2.0, time), (4.0, time)], 7.0, time),
        ] {
            let merged = merge_rows(rounds.map(|(seconds, skipped)| vec![row(seconds, skipped)]));
            let [row] = &merged[..] else { panic!("one stage") };
            assert_eq!(
                (row.predicted_s, row.bound_s, row.skipped),
                (Some(predicted_s), Some(2.0 * predicted_s), skipped)
            );
        }
    }
}
