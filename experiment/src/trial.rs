//! One trial as a state machine: fixation, first picture, gap, second picture, then the questions.
//!
//! It knows no clock and no screen. The driver tells it when a frame was handed to the display ([`Trial::swapped`]), when
//! the next frame will be seen ([`Trial::frame`]) and which keys were pressed; it says what to show.

use analysis::trial_log::{Interval, Phase};
use stimuli::Stimulus;
use stimuli::study::Timing;

use crate::input::{Interruption, Key};
use crate::timing::{FrameWatch, IntervalFrames};

/// One picture of a trial, and what is true of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Which picture.
    pub stimulus: Stimulus,
    /// How many items are truly in it; `None` where nothing is to be counted.
    pub count: Option<u32>,
    /// The rank of its quality: higher is better.
    pub rank: u32,
}

/// What is asked after the two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asks {
    /// The number of items in each.
    pub counts: bool,
    /// Which of the two was worse.
    pub worse: bool,
    /// How sure that answer is.
    pub confidence: bool,
}

/// What a trial shows and asks; fixed before the session begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrialPlan {
    /// Number within the session, from 1.
    pub number: u32,
    /// Part of the session.
    pub phase: Phase,
    /// Shown first.
    pub first: Shown,
    /// Shown second.
    pub second: Shown,
    /// Asked afterwards.
    pub asks: Asks,
}

impl TrialPlan {
    /// The picture of an interval.
    #[must_use]
    pub fn shown(&self, interval: Interval) -> &Shown {
        match interval {
            Interval::First => &self.first,
            Interval::Second => &self.second,
        }
    }

    /// The interval of the lower quality; `None` where both have the same rank, so that no answer is right.
    #[must_use]
    pub fn worse(&self) -> Option<Interval> {
        match self.first.rank.cmp(&self.second.rank) {
            std::cmp::Ordering::Less => Some(Interval::First),
            std::cmp::Ordering::Equal => None,
            std::cmp::Ordering::Greater => Some(Interval::Second),
        }
    }
}

/// Where a trial stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// The fixation mark.
    Fixation,
    /// One of the two pictures.
    Picture(Interval),
    /// The even grey between the pictures.
    Gap,
    /// The question after the number of items.
    Count(Interval),
    /// "Which of the two had the worse rendering quality?"
    Worse,
    /// How sure that was.
    Confidence,
    /// All is answered.
    Done,
}

/// What was measured and answered in a trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observed {
    /// The first picture's frames.
    pub first: Option<IntervalFrames>,
    /// The second picture's frames.
    pub second: Option<IntervalFrames>,
    /// The count given for the first picture.
    pub first_count: Option<u32>,
    /// The count given for the second picture.
    pub second_count: Option<u32>,
    /// The interval said to be worse.
    pub worse: Option<Interval>,
    /// From the question's onset to that answer, seconds.
    pub rt_s: Option<f64>,
    /// 1 (guess) to 4 (certain).
    pub confidence: Option<u8>,
    /// What disturbed the trial, each kind once, in the order of its first occurrence.
    pub interruptions: Vec<Interruption>,
}

/// A trial under way.
#[derive(Clone, Debug)]
pub struct Trial {
    plan: TrialPlan,
    timing: Timing,
    moment: Moment,
    /// Whether the present moment was drawn: only then can a swap have shown it.
    drawn: bool,
    /// When the present moment's first frame was handed over; `None` until it was.
    onset_s: Option<f64>,
    /// The picture whose frames are being followed.
    watch: Option<(Interval, FrameWatch)>,
    typed: String,
    observed: Observed,
}

impl Trial {
    /// The most digits of a count.
    const DIGITS: usize = 3;

    /// A trial that begins with its fixation mark.
    #[must_use]
    pub fn new(plan: TrialPlan, timing: Timing) -> Self {
        let mut trial = Self {
            plan,
            timing,
            moment: Moment::Fixation,
            drawn: false,
            onset_s: None,
            watch: None,
            typed: String::new(),
            observed: Observed::default(),
        };
        trial.skip_what_takes_no_time();
        trial
    }

    /// Where it stands.
    #[must_use]
    pub fn moment(&self) -> Moment {
        self.moment
    }

    /// What was planned.
    #[must_use]
    pub fn plan(&self) -> &TrialPlan {
        &self.plan
    }

    /// What was measured and answered so far.
    #[must_use]
    pub fn observed(&self) -> &Observed {
        &self.observed
    }

    /// Whether all is answered and the last picture was followed to its end.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.moment == Moment::Done && self.watch.is_none()
    }

    /// What has been typed into the present question.
    #[must_use]
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// Whether the present screen has been seen: only then does a key answer it.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.onset_s.is_some()
    }

    /// When the next screen is due; `None` while the present one was not seen yet, and for questions.
    #[must_use]
    pub fn due_s(&self) -> Option<f64> {
        Some(self.onset_s? + self.lasts_s()?)
    }

    /// The frame drawn last was handed over at `at_s`; frames should come every `frame_s`. A screen that a key brought on
    /// since then was not in that frame.
    pub fn swapped(&mut self, at_s: f64, frame_s: f64) {
        let follows = |interval| self.moment == Moment::Picture(interval);
        match self.watch.take() {
            Some((interval, mut watch)) if follows(interval) => {
                watch.frame(at_s, frame_s);
                self.watch = Some((interval, watch));
            }
            Some((interval, watch)) => self.keep(interval, watch.end(at_s, frame_s)),
            None => {}
        }
        if self.onset_s.is_none() && self.drawn {
            self.onset_s = Some(at_s);
            if let Moment::Picture(interval) = self.moment {
                self.watch = Some((interval, FrameWatch::new(at_s)));
            }
        }
    }

    /// The next frame is about to be drawn and will be seen at `shows_s`, and the one after it `frame_s` later: moves on
    /// if the present screen's time is nearer to this frame than to that.
    pub fn frame(&mut self, shows_s: f64, frame_s: f64) {
        if self.due_s().is_some_and(|due_s| shows_s + frame_s / 2.0 >= due_s) {
            self.advance();
        }
        self.drawn = true;
    }

    /// A key went down at `now_s`. A key that comes before its question was seen answers nothing.
    pub fn key(&mut self, key: Key, now_s: f64) {
        let Some(onset_s) = self.onset_s else { return };
        match (self.moment, key) {
            (Moment::Count(_), Key::Digit(digit)) if self.typed.len() < Self::DIGITS => {
                self.typed.extend(char::from_digit(u32::from(digit), 10));
            }
            (Moment::Count(_), Key::Backspace) => {
                self.typed.pop();
            }
            (Moment::Count(interval), Key::Enter) => {
                let Ok(count) = self.typed.parse() else { return };
                match interval {
                    Interval::First => self.observed.first_count = Some(count),
                    Interval::Second => self.observed.second_count = Some(count),
                }
                self.typed.clear();
                self.advance();
            }
            (Moment::Worse, Key::Digit(digit @ (1 | 2))) => {
                self.observed.worse = Some(if digit == 1 { Interval::First } else { Interval::Second });
                self.observed.rt_s = Some(now_s - onset_s);
                self.advance();
            }
            (Moment::Confidence, Key::Digit(digit @ 1..=4)) => {
                self.observed.confidence = Some(digit);
                self.advance();
            }
            _ => {}
        }
    }

    /// Something disturbed the trial: it goes on, and is marked.
    pub fn interrupt(&mut self, what: Interruption) {
        if self.moment != Moment::Done && !self.observed.interruptions.contains(&what) {
            self.observed.interruptions.push(what);
        }
    }

    /// Ends the trial where it stands and gives what there is.
    #[must_use]
    pub fn break_off(mut self, why: Interruption) -> (TrialPlan, Observed) {
        self.interrupt(why);
        if let Some((interval, watch)) = self.watch.take() {
            self.keep(interval, watch.so_far());
        }
        (self.plan, self.observed)
    }

    fn keep(&mut self, interval: Interval, frames: IntervalFrames) {
        match interval {
            Interval::First => self.observed.first = Some(frames),
            Interval::Second => self.observed.second = Some(frames),
        }
    }

    fn lasts_s(&self) -> Option<f64> {
        match self.moment {
            Moment::Fixation => Some(self.timing.fixation_s),
            Moment::Picture(_) => Some(self.timing.interval_s),
            Moment::Gap => Some(self.timing.gap_s),
            Moment::Count(_) | Moment::Worse | Moment::Confidence | Moment::Done => None,
        }
    }

    fn advance(&mut self) {
        let asks = self.plan.asks;
        let after_counts = if asks.worse { Moment::Worse } else { Moment::Done };
        self.moment = match self.moment {
            Moment::Fixation => Moment::Picture(Interval::First),
            Moment::Picture(Interval::First) => Moment::Gap,
            Moment::Gap => Moment::Picture(Interval::Second),
            Moment::Picture(Interval::Second) if asks.counts => Moment::Count(Interval::First),
            Moment::Count(Interval::First) => Moment::Count(Interval::Second),
            Moment::Picture(Interval::Second) | Moment::Count(Interval::Second) => after_counts,
            Moment::Worse if asks.confidence => Moment::Confidence,
            Moment::Worse | Moment::Confidence | Moment::Done => Moment::Done,
        };
        (self.drawn, self.onset_s) = (false, None);
        self.skip_what_takes_no_time();
    }

    /// A fixation or a gap of no time is not shown for a frame either.
    fn skip_what_takes_no_time(&mut self) {
        if matches!(self.moment, Moment::Fixation | Moment::Gap) && self.lasts_s() == Some(0.0) {
            self.advance();
        }
    }
}

#[cfg(test)]
mod tests;
