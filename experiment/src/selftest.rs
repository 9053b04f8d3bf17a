//! `--self-test`: what this machine and this display can do, with a verdict.

use serde::Serialize;
use stimuli::study::Timing;

use crate::display::Display;
use crate::timing::IntervalFrames;

/// What a machine is fit for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Any study.
    MainStudy,
    /// Demonstrations and rehearsals.
    DemonstrationsOnly,
    /// Nothing: what it shows is not what it should, or cannot be saved.
    Unfit,
}

/// The outcome of a self-test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SelfTest {
    /// What it is fit for.
    pub verdict: Verdict,
    /// Why nothing better, each a sentence.
    pub reasons: Vec<String>,
    /// The display.
    pub display: Display,
    /// How many intervals were shown.
    pub intervals: usize,
    /// How long each was to be, seconds.
    pub planned_s: f64,
    /// Intervals with a missed frame.
    pub flagged: usize,
    /// Mean error of the durations of the others, milliseconds.
    pub mean_error_ms: f64,
    /// Its standard deviation, milliseconds.
    pub sd_ms: f64,
    /// The worst error, milliseconds.
    pub worst_ms: f64,
    /// The longest frame of all, milliseconds.
    pub longest_frame_ms: f64,
    /// The median and the longest time that a line took to be on the disk, milliseconds; `None` without a data folder.
    pub disk_ms: Option<[f64; 2]>,
    /// What no program can know.
    pub not_known: &'static str,
}

/// The intervals of the test: long enough for a wrong pace to show, short enough to wait for.
pub const TIMING: Timing = Timing { fixation_s: 0.3, interval_s: 1.0, gap_s: 0.3 };
/// Pairs of intervals that are shown.
pub const PAIRS: u32 = 10;
/// At most this share of intervals may have a missed frame.
const FLAGGED_SHARE: f64 = 0.05;

impl SelfTest {
    /// Judges what was seen.
    #[must_use]
    pub fn judge(display: Display, seen: &[IntervalFrames], disk_ms: Option<[f64; 2]>) -> Self {
        let error_ms = |frames: &&IntervalFrames| Some((frames.duration_s? - TIMING.interval_s) * 1e3);
        let flagged = seen.iter().filter(|frames| frames.missed > 0 || frames.duration_s.is_none()).count();
        let clean: Vec<f64> = seen.iter().filter(|frames| frames.missed == 0).filter_map(|f| error_ms(&f)).collect();
        let n = clean.len().max(1) as f64;
        let mean_error_ms = clean.iter().sum::<f64>() / n;
        let sd_ms = (clean.iter().map(|e| (e - mean_error_ms).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
        let worst_ms = clean.iter().fold(0.0, |worst: f64, e| if e.abs() > worst.abs() { *e } else { worst });
        let longest_frame_ms = seen.iter().fold(0.0, |longest: f64, frames| longest.max(frames.longest_ms));

        let (mut unfit, mut limits) = (Vec::new(), Vec::new());
        match display.pixels {
            None => unfit.push("The framebuffer could not be read, so nobody knows what is shown.".to_owned()),
            Some(pixels) if pixels.differing_bytes > 0 => unfit.push(format!(
                "{} bytes of the framebuffer are not the files'; is the scale {} a fraction?",
                pixels.differing_bytes, display.scale
            )),
            Some(_) => {}
        }
        if clean.is_empty() {
            unfit.push("No interval was shown without a missed frame.".to_owned());
        }
        if !display.is_verified() {
            limits.push(display.refresh_in_words());
        }
        if flagged as f64 > FLAGGED_SHARE * seen.len() as f64 {
            limits.push(format!("{flagged} of {} intervals have missed frames: end other programs.", seen.len()));
        }
        let verdict = match (unfit.is_empty(), limits.is_empty()) {
            (false, _) => Verdict::Unfit,
            (true, false) => Verdict::DemonstrationsOnly,
            (true, true) => Verdict::MainStudy,
        };
        Self {
            verdict,
            reasons: unfit.into_iter().chain(limits).collect(),
            display,
            intervals: seen.len(),
            planned_s: TIMING.interval_s,
            flagged,
            mean_error_ms,
            sd_ms,
            worst_ms,
            longest_frame_ms,
            disk_ms,
            not_known: "when light left the panel: its lag, rise time and backlight; a photodiode tells",
        }
    }

    /// The outcome for people.
    #[must_use]
    pub fn to_text(&self) -> String {
        let verdict = match self.verdict {
            Verdict::MainStudy => "fit for a main study",
            Verdict::DemonstrationsOnly => "fit for demonstrations only",
            Verdict::Unfit => "unfit",
        };
        let [width, height] = self.display.window_px;
        let pixels = match self.display.pixels {
            Some(check) => format!("{} bytes differ in {} pictures", check.differing_bytes, check.pictures),
            None => "not read".to_owned(),
        };
        let disk = match self.disk_ms {
            Some([median, longest]) => format!("a line is on it after {median:.1} ms, at most {longest:.1} ms"),
            None => "not tried (no data folder)".to_owned(),
        };
        let mut text = format!(
            "Verdict      {verdict}\nWindow       {width} x {height} pixels, scale {}\nRefresh      {}\n\
             Framebuffer  {pixels}\nIntervals    {} of {} s, {} with missed frames; the others {:+.2} ms, SD {:.2} ms, \
             worst {:+.2} ms\nFrames       longest {:.1} ms\nDisk         {disk}\nNot known    {}\n",
            self.display.scale,
            self.display.refresh_in_words(),
            self.intervals,
            self.planned_s,
            self.flagged,
            self.mean_error_ms,
            self.sd_ms,
            self.worst_ms,
            self.longest_frame_ms,
            self.not_known
        );
        for reason in &self.reasons {
            text.push_str(&format!("Because      {reason}\n"));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::PixelCheck;
    use crate::timing::Refresh;

    fn display(hz: Option<f64>, differing_bytes: u64) -> Display {
        let why_not = hz.is_none().then(|| "swaps do not wait".to_owned());
        let refresh = Refresh { os_hz: hz, free_hz: hz, free_share: 1.0, held_share: 1.0, hz, why_not };
        let pixels = Some(PixelCheck { pictures: 4, differing_bytes });
        Display { refresh: Some(refresh), pixels, ..Display::default() }
    }

    fn shown(error_ms: f64, missed: u32) -> IntervalFrames {
        IntervalFrames { duration_s: Some(1.0 + error_ms * 1e-3), missed, ..IntervalFrames::default() }
    }

    #[test]
    fn the_verdict_is_the_worst_of_what_was_found() {
        let clean: Vec<_> = (0..20).map(|i| shown(if i % 2 == 0 { 1.0 } else { -1.0 }, 0)).collect();
        let good = SelfTest::judge(display(Some(60.0), 0), &clean, None);
        assert_eq!((good.verdict, good.reasons.len()), (Verdict::MainStudy, 0));
        assert!(good.mean_error_ms.abs() < 1e-9 && (good.worst_ms.abs() - 1.0).abs() < 1e-9);
        assert_eq!(SelfTest::judge(display(None, 0), &clean, None).verdict, Verdict::DemonstrationsOnly);
        assert_eq!(SelfTest::judge(display(Some(60.0), 1), &clean, None).verdict, Verdict::Unfit);
        assert_eq!(SelfTest::judge(Display::default(), &clean, None).verdict, Verdict::Unfit);
        let mut stalled = clean;
        stalled[3] = shown(80.0, 4);
        stalled[4] = shown(80.0, 4);
        let busy = SelfTest::judge(display(Some(60.0), 0), &stalled, None);
        assert_eq!((busy.verdict, busy.flagged), (Verdict::DemonstrationsOnly, 2));
        assert!((busy.worst_ms.abs() - 1.0).abs() < 1e-9, "the flagged ones are told apart");
        assert!(busy.to_text().contains("end other programs"));
    }
}
