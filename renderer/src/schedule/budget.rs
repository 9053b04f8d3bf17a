//! A time limit, and what is left of it.

use std::fmt;

use super::clock::Clock;

/// Time to render in: until a moment of a clock, less what must be kept for what comes after rendering.
#[derive(Clone, Copy)]
pub struct Budget<'c> {
    clock: &'c dyn Clock,
    deadline_s: f64,
    reserve_s: f64,
}

impl<'c> Budget<'c> {
    /// Time until `clock` shows `deadline_s` seconds; `reserve_s` seconds of it are for developing and writing the picture.
    #[must_use]
    pub fn new(clock: &'c dyn Clock, deadline_s: f64, reserve_s: f64) -> Self {
        Self { clock, deadline_s, reserve_s }
    }

    /// The same with so many seconds more to be kept.
    #[must_use]
    pub fn with_more_reserve(self, seconds: f64) -> Self {
        Self { reserve_s: self.reserve_s + seconds, ..self }
    }

    /// The same with so many times as much kept, on a machine so many times slower.
    #[must_use]
    pub fn slowed(self, times: f64) -> Self {
        Self { reserve_s: self.reserve_s * times, ..self }
    }

    /// Seconds now, by the budget's clock.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.clock.now_s()
    }

    /// When all must be done, in seconds of the budget's clock.
    #[must_use]
    pub fn deadline_s(&self) -> f64 {
        self.deadline_s
    }

    /// Seconds left to render in; negative once they are over.
    #[must_use]
    pub fn left_s(&self) -> f64 {
        self.deadline_s - self.reserve_s - self.clock.now_s()
    }
}

impl fmt::Debug for Budget<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Budget")
            .field("deadline_s", &self.deadline_s)
            .field("reserve_s", &self.reserve_s)
            .finish_non_exhaustive()
    }
}
