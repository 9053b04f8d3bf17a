//! Time, handed in from outside so that tests decide how it passes.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Tells how much time has passed. Shared between threads.
pub trait Clock: Sync {
    /// Seconds since a fixed moment of the clock's own; never falls.
    fn now_s(&self) -> f64;
}

/// The machine's monotonic clock.
#[derive(Clone, Copy, Debug)]
pub struct MonotonicClock(Instant);

impl MonotonicClock {
    /// A clock that begins now.
    #[must_use]
    pub fn start() -> Self {
        Self(Instant::now())
    }
}

impl Clock for MonotonicClock {
    fn now_s(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// A clock that stands still unless it is told to go on.
#[derive(Debug, Default)]
pub struct ManualClock(AtomicU64);

impl ManualClock {
    /// Lets time pass, in nanoseconds.
    pub fn advance_ns(&self, nanoseconds: u64) {
        self.0.fetch_add(nanoseconds, Ordering::Relaxed);
    }
}

impl Clock for ManualClock {
    fn now_s(&self) -> f64 {
        self.0.load(Ordering::Relaxed) as f64 * 1e-9
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_do_not_go_back() {
        let clock = MonotonicClock::start();
        assert!(clock.now_s() <= clock.now_s());
        let clock = ManualClock::default();
        assert_eq!(clock.now_s(), 0.0);
        clock.advance_ns(1_500_000_000);
        assert_eq!(clock.now_s(), 1.5);
    }
}
