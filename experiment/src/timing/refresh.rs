//! Whether the display paces the swaps of this window: measured, never assumed.
//!
//! Two series of swaps. In the first, frames are drawn as fast as they come. In the second, each frame is held back by a
//! random part of the first series' period before it is drawn. Where the display paces swaps, the second series keeps the
//! period of the first: a swap waits for the next refresh, however late within the period it was asked for. Where it does
//! not (no display behind the window, synchronisation switched off, a variable refresh rate), each swap comes later by its
//! own delay. What the system says about the display's rate must agree with what was measured, if it says anything.
//!
//! A pass means that swaps are paced. It does not mean that light was seen: no program can know that.

use serde::{Deserialize, Serialize};

use crate::draw::Draws;

/// What was found about the refresh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refresh {
    /// What the system says, Hz; `None` where it says nothing.
    pub os_hz: Option<f64>,
    /// Swaps in a second when frames came as fast as they could, by the median, Hz.
    pub free_hz: Option<f64>,
    /// The share of those swaps within 10 % of their median period.
    pub free_share: f64,
    /// The share of held-back swaps within 10 % of the same period.
    pub held_share: f64,
    /// The refresh rate, Hz; `None` unless swaps are paced by it.
    pub hz: Option<f64>,
    /// Why it is not verified; `None` where it is.
    pub why_not: Option<String>,
}

/// A measurement under way. It knows no clock: its driver says when swaps returned, and waits as it is told.
#[derive(Debug)]
pub struct RefreshProbe {
    os_hz: Option<f64>,
    draws: Draws,
    begun_s: Option<f64>,
    last_s: f64,
    swaps: usize,
    free: Vec<f64>,
    held: Vec<f64>,
}

impl RefreshProbe {
    /// Swaps that only warm up.
    const WARM: usize = 20;
    /// Swaps of the first series.
    const FREE: usize = 60;
    /// Swaps of the second series.
    const HELD: usize = 90;
    /// After this time it is given up, seconds: so slow a window is paced by its own drawing.
    const LONGEST_S: f64 = 15.0;
    /// How near to the median period a swap must be, as a share of it.
    const NEAR: f64 = 0.1;
    /// The least share of swaps that must be near.
    const SHARE: f64 = 0.9;
    /// How far the system's rate and the measured one may be apart, as a share.
    const AGREE: f64 = 0.02;

    /// A measurement of a display of which the system says that it has `os_hz`.
    #[must_use]
    pub fn new(os_hz: Option<f64>, seed: u64) -> Self {
        Self {
            os_hz,
            draws: Draws::new(seed, "delays of the refresh measurement"),
            begun_s: None,
            last_s: 0.0,
            swaps: 0,
            free: Vec::new(),
            held: Vec::new(),
        }
    }

    /// A swap returned at `at_s`, seconds of the wall's clock; gives what was found once that is enough.
    pub fn swapped(&mut self, at_s: f64) -> Option<Refresh> {
        let begun_s = *self.begun_s.get_or_insert(at_s);
        let gap_s = at_s - std::mem::replace(&mut self.last_s, at_s);
        self.swaps += 1;
        if self.swaps > Self::WARM + 1 {
            let series = if self.free.len() < Self::FREE { &mut self.free } else { &mut self.held };
            series.push(gap_s);
        }
        let enough = self.held.len() >= Self::HELD || at_s - begun_s > Self::LONGEST_S;
        enough.then(|| self.judge())
    }

    /// How long to wait now, before the next frame is drawn, seconds.
    pub fn delay_s(&mut self) -> f64 {
        if self.free.len() < Self::FREE { 0.0 } else { 0.5 * median(&self.free) * self.draws.unit() }
    }

    fn judge(&self) -> Refresh {
        let period_s = median(&self.free);
        let share = |gaps: &[f64]| {
            let near = gaps.iter().filter(|&&gap_s| (gap_s - period_s).abs() <= Self::NEAR * period_s).count();
            near as f64 / gaps.len().max(1) as f64
        };
        let (free_share, held_share) = (share(&self.free), share(&self.held));
        let all = || self.free.iter().chain(&self.held);
        let periods: f64 = all().map(|gap_s| (gap_s / period_s).round()).sum();
        let hz = periods / all().sum::<f64>();
        let why_not = if self.held.len() < Self::HELD {
            Some("frames take too long to be paced by anything else".to_owned())
        } else if held_share < Self::SHARE {
            Some("swaps do not wait for the display: they come later by as much as they are asked for later".to_owned())
        } else if free_share < Self::SHARE {
            Some("swaps come at uneven times".to_owned())
        } else if self.os_hz.is_some_and(|os_hz| (hz / os_hz - 1.0).abs() > Self::AGREE) {
            let os_hz = self.os_hz.unwrap_or_default();
            Some(format!("mismatch: the system says {os_hz:.2} Hz, and swaps come at {hz:.2} Hz"))
        } else {
            None
        };
        let free_hz = (period_s > 0.0).then_some(1.0 / period_s);
        let verified = why_not.is_none() && hz.is_finite();
        Refresh { os_hz: self.os_hz, free_hz, free_share, held_share, hz: verified.then_some(hz), why_not }
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Swaps of a machine that needs `cost_s` for a frame, and of a display that shows one every `period_s` (0: it does
    /// not pace). Each is late by up to `jitter_s`.
    fn measure(os_hz: Option<f64>, period_s: f64, cost_s: f64, jitter_s: f64) -> Refresh {
        let mut probe = RefreshProbe::new(os_hz, 1);
        let mut draws = Draws::new(2, "jitter");
        let mut now_s = 0.0;
        loop {
            let asked_s = now_s + probe.delay_s() + cost_s;
            now_s = if period_s > 0.0 { ((asked_s / period_s).floor() + 1.0) * period_s } else { asked_s };
            if let Some(refresh) = probe.swapped(now_s + jitter_s * draws.unit()) {
                return refresh;
            }
        }
    }

    #[test]
    fn a_display_that_paces_is_verified_at_its_rate() {
        for hz in [59.94, 60.0, 75.0, 144.0, 240.0] {
            let refresh = measure(Some(hz), 1.0 / hz, 0.2 / hz, 0.03 / hz);
            assert!(refresh.hz.is_some_and(|found| (found / hz - 1.0).abs() < 1e-3), "{refresh:?}");
            assert!(
                measure(None, 1.0 / hz, 0.2 / hz, 0.0).hz.is_some(),
                "a system that says nothing contradicts nothing"
            );
        }
    }

    #[test]
    fn swaps_that_follow_the_drawing_are_not_verified_however_even_they_are() {
        for cost_s in [0.0005, 0.004, 1.0 / 60.0, 0.05] {
            let refresh = measure(None, 0.0, cost_s, 0.0);
            assert_eq!(refresh.hz, None);
            assert!(refresh.why_not.is_some() && refresh.free_hz.is_some(), "{refresh:?}");
        }
    }

    #[test]
    fn a_rate_that_is_not_the_systems_is_a_mismatch() {
        let refresh = measure(Some(144.0), 1.0 / 60.0, 0.004, 0.0);
        assert_eq!(refresh.hz, None);
        assert!(refresh.why_not.is_some_and(|why| why.contains("mismatch")));
    }

    #[test]
    fn a_machine_that_misses_refreshes_is_not_verified() {
        let refresh = measure(Some(60.0), 1.0 / 60.0, 0.012, 0.0);
        assert_eq!(refresh.hz, None, "half of the held frames miss a refresh");
    }
}
