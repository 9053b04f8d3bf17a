//! How far predictions have been off, and so how much to add to the next one.

use std::collections::VecDeque;

/// The part of tasks that must end within their bound.
pub const CONFIDENCE: f64 = 0.95;

/// Errors remembered: the latest ones.
pub const REMEMBERED: usize = 256;

/// Deviations to add before enough errors are known.
pub const FIRST_FACTOR: f64 = 2.0;

/// The errors of past predictions, each in deviations of its own prediction.
///
/// The next task's bound is its mean and as many deviations as would have covered [`CONFIDENCE`] of these tasks, by the
/// rule of conformal prediction (Vovk, Gammerman and Shafer 2005): of n errors the smallest one with at least
/// (n + 1) x confidence of them at or below. It holds for errors of any distribution, as long as the next task is drawn
/// like the ones before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    /// In the order of their coming.
    errors: VecDeque<f64>,
    /// The same, sorted.
    sorted: Vec<f64>,
}

impl Calibration {
    /// Takes in an error, finite, in deviations; positive if the task took longer than predicted.
    pub fn record(&mut self, error: f64) {
        if self.errors.len() == REMEMBERED
            && let Some(oldest) = self.errors.pop_front()
        {
            let place = self.place(oldest);
            self.sorted.remove(place);
        }
        self.errors.push_back(error);
        let place = self.place(error);
        self.sorted.insert(place, error);
    }

    fn place(&self, error: f64) -> usize {
        self.sorted.partition_point(|known| *known < error)
    }

    /// The deviations to add to a prediction's mean: [`FIRST_FACTOR`] until the errors known are enough for the rule (19
    /// for 95 %).
    #[must_use]
    pub fn factor(&self) -> f64 {
        let rank = ((self.sorted.len() + 1) as f64 * CONFIDENCE).ceil() as usize;
        self.sorted.get(rank.saturating_sub(1)).copied().unwrap_or(FIRST_FACTOR)
    }

    /// The errors remembered, the oldest first, in deviations.
    pub fn errors(&self) -> impl Iterator<Item = f64> {
        self.errors.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_is_the_conformal_rank() {
        let mut calibration = Calibration::default();
        for error in (1..=18).rev() {
            assert_eq!(calibration.factor(), FIRST_FACTOR);
            calibration.record(f64::from(error));
        }
        calibration.record(19.0);
        // 20 x .95 = 19: the 19th of 19.
        assert_eq!(calibration.factor(), 19.0);
        (20..=39).for_each(|error| calibration.record(f64::from(error)));
        // 40 x .95 = 38: the 38th of 39.
        assert_eq!(calibration.factor(), 38.0);
    }

    #[test]
    fn only_the_latest_errors_count() {
        let mut calibration = Calibration::default();
        (0..REMEMBERED).for_each(|_| calibration.record(100.0));
        (0..REMEMBERED).for_each(|_| calibration.record(-1.0));
        assert_eq!(calibration.factor(), -1.0);
        assert_eq!(calibration.errors().count(), REMEMBERED);
    }
}
