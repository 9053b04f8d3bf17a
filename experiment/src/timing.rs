//! Frames: what was measured while a picture was on the screen, and when the next frame shall be drawn.
//!
//! A program cannot see light. What it can know is when the buffer swap returned; on a display whose refresh paces the
//! swaps that is the start of scan-out, to about a millisecond, and nowhere does it include the panel's own lag. Every
//! figure here is of swaps.

mod refresh;

pub use refresh::{Refresh, RefreshProbe};

/// What was measured over one interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IntervalFrames {
    /// When the swap of its first frame returned, seconds.
    pub onset_s: f64,
    /// From there to the first frame of what came next; `None` if that never came.
    pub duration_s: Option<f64>,
    /// Frames that should have been drawn and were not.
    pub missed: u32,
    /// The longest time between two swaps, milliseconds.
    pub longest_ms: f64,
    /// Frames drawn, the first one included.
    pub drawn: u32,
}

/// Follows the swaps of one interval.
#[derive(Clone, Copy, Debug)]
pub struct FrameWatch {
    seen: IntervalFrames,
    last_s: f64,
}

impl FrameWatch {
    /// A gap between swaps beyond this many frame periods holds a missed frame.
    pub const MISS_AT: f64 = 1.5;

    /// Starts with the swap that showed the interval's first frame.
    #[must_use]
    pub fn new(onset_s: f64) -> Self {
        Self { seen: IntervalFrames { onset_s, drawn: 1, ..IntervalFrames::default() }, last_s: onset_s }
    }

    /// A further frame of the interval was handed over at `at_s`; `frame_s` is the period that frames should have.
    pub fn frame(&mut self, at_s: f64, frame_s: f64) {
        self.gap(at_s, frame_s);
        self.seen.drawn += 1;
    }

    /// The first frame of what follows was handed over at `at_s`.
    #[must_use]
    pub fn end(mut self, at_s: f64, frame_s: f64) -> IntervalFrames {
        self.gap(at_s, frame_s);
        self.seen.duration_s = Some(at_s - self.seen.onset_s);
        self.seen
    }

    /// What was seen of an interval that does not end.
    #[must_use]
    pub fn so_far(&self) -> IntervalFrames {
        self.seen
    }

    fn gap(&mut self, at_s: f64, frame_s: f64) {
        let gap_s = at_s - self.last_s;
        self.last_s = at_s;
        self.seen.longest_ms = self.seen.longest_ms.max(gap_s * 1e3);
        let frames = gap_s / frame_s;
        if frames > Self::MISS_AT && frames.is_finite() {
            // Saturating: a machine that slept over night has missed more frames than matter.
            let missed = (frames.round() - 1.0).max(1.0).min(f64::from(u32::MAX)) as u32;
            self.seen.missed = self.seen.missed.saturating_add(missed);
        }
    }
}

/// When to start the next frame, and when it will be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramePlan {
    /// Start drawing at this moment, seconds; it may be past.
    pub start_s: f64,
    /// The swap is expected to return then.
    pub shows_s: f64,
    /// The period of frames at present, seconds.
    pub frame_s: f64,
}

/// What sets the pace of frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// The display: a swap returns at its refresh, whose period was measured, in seconds.
    Display(f64),
    /// The clock: nothing else paces swaps here, so frames are placed on a grid of this period that ends at the deadline.
    Clock(f64),
}

/// Plans frames so that what is due at a deadline is seen as close to it as the machine can.
#[derive(Clone, Debug)]
pub struct Pacer {
    pace: Pace,
    /// What the latest frames took from the start of drawing to the swap's return, seconds; a ring.
    costs: [f64; Pacer::REMEMBERED],
    known: usize,
    last_swap_s: f64,
}

impl Pacer {
    const REMEMBERED: usize = 15;
    /// A frame that takes this much of its period leaves too little room: then the period is made longer.
    const FILL: f64 = 0.85;

    /// Nothing is known of the machine yet.
    #[must_use]
    pub fn new(pace: Pace) -> Self {
        Self { pace, costs: [0.0; Self::REMEMBERED], known: 0, last_swap_s: f64::NEG_INFINITY }
    }

    /// What sets the pace.
    #[must_use]
    pub fn pace(&self) -> Pace {
        self.pace
    }

    /// A frame was started at `start_s`, and its swap returned at `swap_s`.
    pub fn drawn(&mut self, start_s: f64, swap_s: f64) {
        self.costs[self.known % Self::REMEMBERED] = (swap_s - start_s).max(0.0);
        self.known += 1;
        self.last_swap_s = swap_s;
    }

    /// The median of what the latest frames took, seconds: a stall now and then does not move it.
    #[must_use]
    pub fn cost_s(&self) -> f64 {
        let mut known = self.costs;
        let known = &mut known[..self.known.min(Self::REMEMBERED)];
        known.sort_by(f64::total_cmp);
        known.get(known.len() / 2).copied().unwrap_or(0.0)
    }

    /// The next frame, given the present and the moment at which the next screen is due.
    #[must_use]
    pub fn plan(&self, now_s: f64, due_s: Option<f64>) -> FramePlan {
        match self.pace {
            Pace::Display(frame_s) => {
                let next = self.last_swap_s + frame_s;
                let shows_s = if next > now_s { next } else { now_s + frame_s };
                FramePlan { start_s: now_s, shows_s, frame_s } // the swap itself waits
            }
            Pace::Clock(wanted_s) => self.on_the_clock(now_s, due_s, wanted_s),
        }
    }

    /// What is left until the deadline is divided into even frames, so that the last one meets it: as many as the wanted
    /// period allows or, on a machine too slow for that, as it can draw.
    fn on_the_clock(&self, now_s: f64, due_s: Option<f64>, wanted_s: f64) -> FramePlan {
        /// Rounding must not take a frame away that just fits.
        const SLACK: f64 = 1e-6;
        let cost_s = self.cost_s();
        let least_s = wanted_s.max(cost_s / Self::FILL);
        let left_s = due_s.map_or(least_s, |due_s| due_s - self.last_swap_s);
        let frame_s = match (left_s / least_s + SLACK).floor() {
            frames if left_s.is_finite() && frames >= 1.0 => left_s / frames,
            _ => least_s,
        };
        let shows_s = (self.last_swap_s + left_s.min(frame_s)).max(now_s + cost_s);
        FramePlan { start_s: shows_s - cost_s, shows_s, frame_s }
    }
}

#[cfg(test)]
mod tests;
