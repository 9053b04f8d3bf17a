//! A count out of a number, the value that every one-sample test is about.

use serde::Serialize;

/// `k` of `n`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct Proportion {
    /// How many of them, at most `n`.
    pub k: u64,
    /// Out of how many.
    pub n: u64,
}

impl Proportion {
    /// `k` of `n`; none where `k` is larger than `n`.
    #[must_use]
    pub fn new(k: u64, n: u64) -> Option<Self> {
        (k <= n).then_some(Self { k, n })
    }

    /// `k / n`; none where `n` is 0.
    #[must_use]
    pub fn value(self) -> Option<f64> {
        (self.n > 0).then(|| self.k as f64 / self.n as f64)
    }

    /// The rest: `n - k` of `n`.
    #[must_use]
    pub fn complement(self) -> Self {
        Self { k: self.n - self.k, n: self.n }
    }

    /// The two as floating-point numbers, exact up to 2^53.
    #[must_use]
    pub fn as_f64(self) -> (f64, f64) {
        (self.k as f64, self.n as f64)
    }

    /// Counts one more.
    pub fn count(&mut self, hit: bool) {
        self.k += u64::from(hit);
        self.n += 1;
    }
}

impl std::fmt::Display for Proportion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {}", self.k, self.n)
    }
}
