//! The session's rows beside what was seen from outside.

use std::path::Path;

use analysis::trial_log::{Reader, Trial as Row};
use experiment::log::{Event, read_journal};
use serde::{Deserialize, Serialize};

use crate::watch::Seen;

/// One interval, from both sides.
#[derive(Serialize, Deserialize)]
pub(crate) struct Interval {
    /// Duration seen, seconds.
    seen_s: f64,
    /// Duration in the row, seconds.
    logged_s: f64,
    /// Onset in the row less onset seen, milliseconds.
    onset_apart_ms: f64,
    /// Frames missed, by the row.
    missed: u32,
    longest_frame_ms: f64,
    stalled: bool,
    interrupted: bool,
}

/// One session.
#[derive(Serialize, Deserialize)]
pub(crate) struct Chunk {
    intervals: Vec<Interval>,
    planned_s: f64,
    vsync: String,
    /// Swaps a second when nothing holds them back.
    free_hz: f64,
    look_ms: f64,
}

/// Reads a session's data and pairs its intervals with what was seen.
pub(crate) fn join(data: &Path, seen: &Seen) -> crate::Result<Chunk> {
    let session = data.join("sessions/sim-00001");
    let (mut reader, mut row) = (Reader::open(&session.join("sim-00001.csv"))?, Row::default());
    let (mut zero_us, mut free_hz, mut vsync) = (None, 0.0, String::new());
    for line in read_journal(&session.join("sim-00001.events.jsonl"))? {
        if let Event::Display { display, zero_unix_us } = line.event {
            zero_us = Some(zero_unix_us as f64);
            vsync = if display.is_verified() { "verified" } else { "unverified" }.to_owned();
            free_hz = display.refresh.and_then(|refresh| refresh.free_hz).unwrap_or_default();
        }
    }
    let zero_us = zero_us.ok_or("the journal does not say when the session began")?;
    let mut logged = Vec::new();
    while reader.read_into(&mut row)? {
        let first = (row.first_onset_s, row.first_duration_s, row.first_missed_frames, row.first_max_frame_ms);
        let second = (row.second_onset_s, row.second_duration_s, row.second_missed_frames, row.second_max_frame_ms);
        for (onset, duration, missed, longest) in [first, second] {
            let complete = onset.zip(duration).zip(missed.zip(longest));
            let ((onset, duration), (missed, longest)) = complete.ok_or("a row without its intervals")?;
            logged.push((onset, duration, missed, longest, row.interrupted));
        }
    }
    if logged.len() != seen.on_us.len() || seen.off_us.len() != seen.on_us.len() {
        let (on, off) = (seen.on_us.len(), seen.off_us.len());
        return Err(format!("{} intervals in the rows, {on} onsets and {off} ends seen", logged.len()).into());
    }
    let planned_s = experiment_seconds(data)?;
    let intervals = logged
        .into_iter()
        .enumerate()
        .map(|(i, (onset_s, logged_s, missed, longest_frame_ms, interrupted))| Interval {
            seen_s: (seen.off_us[i] - seen.on_us[i]) * 1e-6,
            logged_s,
            onset_apart_ms: (zero_us + onset_s * 1e6 - seen.on_us[i]) * 1e-3,
            missed,
            longest_frame_ms,
            stalled: seen.stalled.contains(&i),
            interrupted,
        })
        .collect();
    Ok(Chunk { intervals, planned_s, vsync, free_hz, look_ms: seen.look_ms })
}

fn experiment_seconds(data: &Path) -> crate::Result<f64> {
    Ok(stimuli::Study::load(&data.with_file_name("study"))?.timing.interval_s)
}

/// The table's head.
pub(crate) const HEADER: &str = "| condition | intervals | frame ms | flagged, not stalled | stalls flagged | \
    error of the others ms: mean | SD | worst | logged - seen onset ms: median | p99 of its size | vsync |\n\
    |---|---|---|---|---|---|---|---|---|---|---|";

/// A line of the table, and the distances of onsets for the pooled figure; none without chunks.
pub(crate) fn row(name: &str, seconds: f64, chunks: &[Chunk]) -> Option<(String, Vec<f64>)> {
    let all: Vec<&Interval> = chunks.iter().flat_map(|chunk| &chunk.intervals).collect();
    let first = chunks.first()?;
    let clean: Vec<&&Interval> = all.iter().filter(|interval| interval.missed == 0 && !interval.stalled).collect();
    let errors: Vec<f64> = clean.iter().map(|interval| (interval.seen_s - first.planned_s) * 1e3).collect();
    let n = errors.len().max(1) as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let sd = (errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
    let worst = errors.iter().fold(0.0, |worst: f64, error| if error.abs() > worst.abs() { *error } else { worst });
    let flagged = all.iter().filter(|interval| !interval.stalled && interval.missed > 0).count();
    let stalled = all.iter().filter(|interval| interval.stalled).count();
    let caught = all.iter().filter(|interval| interval.stalled && interval.missed > 0).count();
    let onsets: Vec<f64> = all.iter().map(|interval| interval.onset_apart_ms).collect();
    let frame_ms = (1e3 / first.free_hz).max(1e3 / 60.0);
    let line = format!(
        "| {name} {seconds} s | {} | {frame_ms:.1} | {flagged} | {caught}/{stalled} | {mean:+.2} | {sd:.2} | {worst:+.2} | \
         {:+.2} | {:.2} | {} |",
        all.len(),
        quantile(&onsets, 0.5),
        quantile(&sizes(&onsets), 0.99),
        first.vsync
    );
    Some((line, onsets))
}

/// The p99 over all conditions: it needs a thousand onsets to mean anything.
pub(crate) fn pooled<'a>(onsets: impl Iterator<Item = &'a f64>) -> String {
    let onsets: Vec<f64> = onsets.copied().collect();
    let p99 = quantile(&sizes(&onsets), 0.99);
    format!("\n{} onsets in all: logged - seen, p99 of its size {p99:.2} ms", onsets.len())
}

fn sizes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value.abs()).collect()
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}
