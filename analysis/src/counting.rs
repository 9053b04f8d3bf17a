//! The counting task: how well people counted, by arm and quality. It shows whether they did what they were asked.

use serde::Serialize;

use crate::trial_log::Trial;

/// Errors of counts, gathered one by one (Welford 1962).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    n: u64,
    mean: f64,
    squares: f64,
    absolute: f64,
    exact: u64,
}

/// How well counts agree with the true counts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// Pictures counted.
    pub n: u64,
    /// Mean of count less true count, objects: below 0 people miss some.
    pub mean_error: f64,
    /// Its standard deviation, objects; none for one picture.
    pub sd: Option<f64>,
    /// Mean distance from the true count, objects.
    pub mean_distance: f64,
    /// Share of pictures counted exactly.
    pub exact_share: f64,
}

impl Errors {
    /// Adds one count.
    pub fn add(&mut self, truth: u32, answer: u32) {
        let error = f64::from(answer) - f64::from(truth);
        self.n += 1;
        let step = error - self.mean;
        self.mean += step / self.n as f64;
        self.squares += step * (error - self.mean);
        self.absolute += error.abs();
        self.exact += u64::from(answer == truth);
    }

    /// The accuracy; none without counts.
    #[must_use]
    pub fn accuracy(&self) -> Option<Accuracy> {
        let n = self.n as f64;
        (self.n > 0).then(|| Accuracy {
            n: self.n,
            mean_error: self.mean,
            sd: (self.n > 1).then(|| (self.squares / (n - 1.0)).sqrt()),
            mean_distance: self.absolute / n,
            exact_share: self.exact as f64 / n,
        })
    }
}

/// The counts of a trial with their qualities: (quality, true count, answer).
pub fn counts_of(trial: &Trial) -> impl Iterator<Item = (&str, u32, u32)> {
    let pictures = [
        (trial.first_quality.as_str(), trial.first_count, trial.first_count_answer),
        (trial.second_quality.as_str(), trial.second_count, trial.second_count_answer),
    ];
    pictures.into_iter().filter_map(|(quality, truth, answer)| Some((quality, truth?, answer?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_the_textbook_s() {
        let mut errors = Errors::default();
        assert_eq!(errors.accuracy(), None);
        for (truth, answer) in [(10, 8), (10, 10), (10, 11), (10, 9)] {
            errors.add(truth, answer);
        }
        let found = errors.accuracy().unwrap();
        assert_eq!((found.n, found.mean_error, found.mean_distance, found.exact_share), (4, -0.5, 1.0, 0.25));
        // Errors -2, 0, 1, -1: sum of squares about the mean is 6 - 4/4 = 5, over 3.
        assert!((found.sd.unwrap() - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn large_counts_do_not_cancel() {
        let mut errors = Errors::default();
        for i in 0..1_000_000_u32 {
            errors.add(4_000_000_000, 4_000_000_000 - (i % 2));
        }
        let found = errors.accuracy().unwrap();
        assert!((found.mean_error + 0.5).abs() < 1e-12 && (found.sd.unwrap() - 0.5).abs() < 1e-6);
    }

    #[test]
    fn what_was_not_counted_is_left_out() {
        let trial =
            Trial { first_count: Some(3), second_count: Some(4), second_count_answer: Some(4), ..Trial::default() };
        assert_eq!(counts_of(&trial).collect::<Vec<_>>(), [("", 4, 4)]);
    }
}
