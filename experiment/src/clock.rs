//! The only place of this crate that asks for the time.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Monotonic seconds since this clock was made. A rehearsal may let it run faster than the wall's.
#[derive(Clone, Debug)]
pub struct Clock {
    start: Instant,
    offset_s: f64,
    speed: f64,
}

impl Clock {
    /// A clock that starts now and runs `speed` times as fast as the wall's: 1 in every real session.
    #[must_use]
    pub fn new(speed: f64) -> Self {
        Self { start: Instant::now(), offset_s: 0.0, speed }
    }

    /// The same clock, showing `offset_s` more: a resumed session goes on counting from its first start.
    #[must_use]
    pub fn later(self, offset_s: f64) -> Self {
        Self { offset_s: self.offset_s + offset_s, ..self }
    }

    /// Seconds since the start.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.offset_s + self.start.elapsed().as_secs_f64() * self.speed
    }

    /// How many of this clock's seconds pass in one of the wall's.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Returns when this clock shows `time_s`, at once if that is past. The system's sleep may oversleep by its timer's
    /// slack, so it is left early and the rest is waited for awake: 1 ms more CPU time for some 50 us of precision.
    pub fn wait_until(&self, time_s: f64) {
        const AWAKE_S: f64 = 1e-3;
        let left = |clock: &Self| (time_s - clock.now_s()) / self.speed;
        let asleep = left(self) - AWAKE_S;
        if asleep > 0.0 && asleep.is_finite() {
            std::thread::sleep(Duration::from_secs_f64(asleep));
        }
        while left(self) > 0.0 {
            std::hint::spin_loop();
        }
    }
}

/// How a session's time runs.
#[derive(Debug)]
pub enum Time {
    /// It jumps from one event to the next: rehearsals and tests.
    Jumps {
        /// Where it stands, seconds.
        now_s: f64,
    },
    /// It runs, faster than the wall's or as fast.
    Runs(Clock),
}

impl Time {
    /// Lets it become `time_s`, if it is not past, and gives what it is then.
    pub fn until(&mut self, time_s: f64) -> f64 {
        match self {
            Self::Jumps { now_s } => *now_s = now_s.max(time_s),
            Self::Runs(clock) => clock.wait_until(time_s),
        }
        self.now_s()
    }

    /// A session begins, or goes on `at_s` seconds after it began: from now on, this is the time.
    pub fn start_at(&mut self, at_s: f64) {
        *self = match self {
            Self::Jumps { .. } => Self::Jumps { now_s: at_s },
            Self::Runs(clock) => Self::Runs(Clock::new(clock.speed()).later(at_s)),
        };
    }

    /// How many of its seconds pass in one of the wall's: 1 where it jumps.
    #[must_use]
    pub fn speed(&self) -> f64 {
        match self {
            Self::Jumps { .. } => 1.0,
            Self::Runs(clock) => clock.speed(),
        }
    }

    /// Seconds from the session's start.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        match self {
            Self::Jumps { now_s } => *now_s,
            Self::Runs(clock) => clock.now_s(),
        }
    }
}

/// A moment of universal time, to the microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Utc {
    micros: u64,
}

impl Utc {
    /// The present moment. A clock set before 1970 reads as 1970.
    #[must_use]
    pub fn now() -> Self {
        Self::from_unix(SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default())
    }

    /// A moment after the start of 1970.
    #[must_use]
    pub fn from_unix(since: Duration) -> Self {
        Self { micros: u64::try_from(since.as_micros()).unwrap_or(u64::MAX) }
    }

    /// Microseconds since the start of 1970.
    #[must_use]
    pub fn micros(self) -> u64 {
        self.micros
    }

    /// The moment so many seconds before this one.
    #[must_use]
    pub fn before_s(self, seconds: f64) -> Self {
        Self { micros: self.micros.saturating_sub((seconds * 1e6).max(0.0).round() as u64) }
    }

    /// Seconds from `earlier` to this moment; negative if the system's clock was set back in between.
    #[must_use]
    pub fn since_s(self, earlier: Self) -> f64 {
        (i128::from(self.micros) - i128::from(earlier.micros)) as f64 * 1e-6
    }

    /// As a name for a file: `20051129T093000Z`.
    #[must_use]
    pub fn compact(self) -> String {
        self.to_string().chars().filter(|c| c.is_ascii_alphanumeric()).collect()
    }
}

/// `YYYY-MM-DDTHH:MM:SSZ`, fractions of a second left out.
impl std::fmt::Display for Utc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let seconds = self.micros / 1_000_000;
        let (days, second) = (seconds / 86_400, seconds % 86_400);
        let (year, month, day) = civil(days);
        let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
    }
}

/// Year, month and day of the proleptic Gregorian calendar, from days since 1970-01-01. Years start in March here, so
/// that the leap day is the last of its year; 719,468 days lie between 0000-03-01 and 1970-01-01.
fn civil(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 { march_month + 3 } else { march_month - 9 };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_read_as_the_calendar_says() {
        for (unix_s, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (951_868_799, "2000-02-29T23:59:59Z"),
            (951_868_800, "2000-03-01T00:00:00Z"),
            (1_133_256_600, "2005-11-29T09:30:00Z"),
            (4_107_542_399, "2100-02-28T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(Utc::from_unix(Duration::from_secs(unix_s)).to_string(), text);
        }
        assert_eq!(Utc::from_unix(Duration::from_secs(1_133_256_600)).compact(), "20051129T093000Z");
    }

    #[test]
    fn differences_have_a_sign() {
        let (early, late) = (Utc::from_unix(Duration::from_secs(5)), Utc::from_unix(Duration::from_millis(7500)));
        assert_eq!(late.since_s(early), 2.5);
        assert_eq!(early.since_s(late), -2.5);
    }

    #[test]
    fn waiting_ends_when_the_clock_says_so() {
        let clock = Clock::new(10.0);
        clock.wait_until(0.05);
        assert!(clock.now_s() >= 0.05);
        clock.wait_until(f64::NEG_INFINITY);
    }
}
