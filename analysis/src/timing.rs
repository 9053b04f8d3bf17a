//! What the logs say about timing: how long pictures stood, frames missed, where onsets come from.

use serde::Serialize;

use crate::trial_log::{OnsetSource, Trial, Vsync};

/// Width of a bin of the histogram, milliseconds.
pub const BIN_MS: f64 = 1.0;

/// Bins on each side of the planned duration; the outermost take everything beyond.
const SIDE: usize = 50;

/// Gathers timing row by row.
#[derive(Clone, Debug)]
pub struct Gathering {
    planned_s: Option<f64>,
    timing: Timing,
}

/// Timing of all pictures of all rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Pictures with a duration.
    pub pictures: u64,
    /// Shortest and longest duration, seconds.
    pub duration_s: Option<[f64; 2]>,
    /// Duration less planned duration in bins of [`BIN_MS`] about 0, the outermost open; empty without a plan.
    pub error_bins: Vec<u64>,
    /// Largest distance of a duration from the planned one, milliseconds; none without a plan.
    pub worst_error_ms: Option<f64>,
    /// Pictures during which a frame was missed.
    pub with_missed_frames: u64,
    /// Pictures for which missed frames are known.
    pub frames_known: u64,
    /// The longest frame, milliseconds.
    pub longest_frame_ms: Option<f64>,
    /// Lowest and highest refresh rate of verified rows, Hz.
    pub refresh_hz: Option<[f64; 2]>,
    /// Rows on a verified display.
    pub verified: u64,
    /// Rows.
    pub rows: u64,
    /// Rows whose onsets are swap returns, presentation times, and estimates.
    pub onset_sources: [u64; 3],
}

impl Gathering {
    /// Gathers against a planned duration, where there is one.
    #[must_use]
    pub fn new(planned_s: Option<f64>) -> Self {
        let error_bins = if planned_s.is_some() { vec![0; 2 * SIDE + 1] } else { Vec::new() };
        Self { planned_s, timing: Timing { error_bins, ..Timing::default() } }
    }

    /// Adds a row.
    pub fn add(&mut self, trial: &Trial) {
        let timing = &mut self.timing;
        timing.rows += 1;
        timing.verified += u64::from(trial.vsync == Vsync::Verified);
        let source = match trial.onset_source {
            OnsetSource::SwapReturn => 0,
            OnsetSource::Present => 1,
            OnsetSource::Estimated => 2,
        };
        timing.onset_sources[source] += 1;
        widen(&mut timing.refresh_hz, trial.refresh_hz);
        for duration in [trial.first_duration_s, trial.second_duration_s].into_iter().flatten() {
            timing.pictures += 1;
            widen(&mut timing.duration_s, Some(duration));
            if let Some(planned) = self.planned_s {
                let error_ms = (duration - planned) * 1e3;
                let bin = (error_ms / BIN_MS).round().clamp(-(SIDE as f64), SIDE as f64) + SIDE as f64;
                timing.error_bins[bin as usize] += 1;
                let worst = timing.worst_error_ms.get_or_insert(0.0);
                *worst = worst.max(error_ms.abs());
            }
        }
        for missed in [trial.first_missed_frames, trial.second_missed_frames].into_iter().flatten() {
            timing.frames_known += 1;
            timing.with_missed_frames += u64::from(missed > 0);
        }
        for longest in [trial.first_max_frame_ms, trial.second_max_frame_ms].into_iter().flatten() {
            let so_far = timing.longest_frame_ms.get_or_insert(longest);
            *so_far = so_far.max(longest);
        }
    }

    /// What was gathered.
    #[must_use]
    pub fn finish(self) -> Timing {
        self.timing
    }
}

fn widen(range: &mut Option<[f64; 2]>, value: Option<f64>) {
    let Some(value) = value else { return };
    let [low, high] = range.get_or_insert([value, value]);
    *low = low.min(value);
    *high = high.max(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_fall_into_their_bins() {
        let mut gathering = Gathering::new(Some(6.0));
        for duration in [6.0, 6.0004, 6.002, 5.0] {
            gathering.add(&Trial { first_duration_s: Some(duration), ..Trial::default() });
        }
        let timing = gathering.finish();
        assert_eq!((timing.pictures, timing.rows), (4, 4));
        assert_eq!(timing.error_bins[SIDE], 2);
        assert_eq!(timing.error_bins[SIDE + 2], 1);
        assert_eq!(timing.error_bins[0], 1, "beyond the last bin");
        assert!((timing.worst_error_ms.unwrap() - 1000.0).abs() < 1e-9);
        assert_eq!(timing.duration_s, Some([5.0, 6.002]));
    }

    #[test]
    fn frames_and_displays_are_counted() {
        let mut gathering = Gathering::new(None);
        gathering.add(&Trial {
            vsync: Vsync::Verified,
            refresh_hz: Some(59.9),
            onset_source: OnsetSource::SwapReturn,
            first_missed_frames: Some(0),
            second_missed_frames: Some(2),
            first_max_frame_ms: Some(16.7),
            second_max_frame_ms: Some(50.1),
            ..Trial::default()
        });
        gathering.add(&Trial::default());
        let timing = gathering.finish();
        assert_eq!((timing.frames_known, timing.with_missed_frames, timing.verified, timing.rows), (2, 1, 1, 2));
        assert_eq!((timing.longest_frame_ms, timing.refresh_hz), (Some(50.1), Some([59.9, 59.9])));
        assert_eq!(timing.onset_sources, [1, 0, 1]);
        assert!(timing.error_bins.is_empty() && timing.worst_error_ms.is_none());
    }
}
