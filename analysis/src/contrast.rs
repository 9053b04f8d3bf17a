//! Two arms against each other: the difference of two proportions.
//!
//! That one arm's test rejects and another's does not is no difference between them; this is the test of that.

use serde::Serialize;

use crate::interval::wilson;
use crate::proportion::Proportion;
use crate::special::beta;

/// Barnard's test enumerates every table: beyond this many people in an arm it is not computed.
pub const BARNARD_LIMIT: u64 = 300;

/// Fisher's test sums over the tables of the same margins: beyond this many it is not computed.
pub const FISHER_LIMIT: u64 = 10_000_000;

/// The contrast of two arms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Contrast {
    /// First proportion less the second.
    pub difference: f64,
    /// Newcombe's hybrid score interval of the difference (Newcombe 1998, method 10).
    pub newcombe: [f64; 2],
    /// Cohen's h of the two, `2 asin sqrt p1 - 2 asin sqrt p2`.
    pub h: f64,
    /// Fisher's exact test, two-sided: the tables of the same margins no likelier than this one. None beyond
    /// [`FISHER_LIMIT`].
    pub fisher_p: Option<f64>,
    /// Barnard's exact test with the pooled score statistic, two-sided. None beyond [`BARNARD_LIMIT`] people an arm.
    pub barnard_p: Option<f64>,
}

impl Contrast {
    /// The contrast; none where an arm is empty. `level` is the interval's.
    #[must_use]
    pub fn new(first: Proportion, second: Proportion, level: f64) -> Option<Self> {
        let (p, q) = (first.value()?, second.value()?);
        Some(Self {
            difference: p - q,
            newcombe: newcombe(first, second, level),
            h: 2.0 * (p.sqrt().asin() - q.sqrt().asin()),
            fisher_p: fisher(first, second),
            barnard_p: barnard(first, second),
        })
    }
}

fn newcombe(first: Proportion, second: Proportion, level: f64) -> [f64; 2] {
    let share = |counts: Proportion| counts.value().unwrap_or(0.5);
    let (p, q) = (share(first), share(second));
    let ([p_low, p_high], [q_low, q_high]) = (wilson(first, level), wilson(second, level));
    let difference = p - q;
    [difference - (p - p_low).hypot(q_high - q), difference + (p_high - p).hypot(q - q_low)]
}

/// Fisher's exact test, two-sided.
#[must_use]
pub fn fisher(first: Proportion, second: Proportion) -> Option<f64> {
    let successes = first.k + second.k;
    let low = successes.saturating_sub(second.n);
    let high = successes.min(first.n);
    if high - low > FISHER_LIMIT {
        return None;
    }
    // Hypergeometric weights relative to this table's, by their ratios outwards from it. Weights that differ from it by
    // rounding alone count as equal.
    let ((m, n), s) = ((first.n as f64, second.n as f64), successes as f64);
    let ratio_up = |i: f64| (m - i) * (s - i) / ((i + 1.0) * (n - s + i + 1.0));
    let equal = 1.0 + 1e-10;
    let (mut all, mut extreme) = (1.0, 1.0);
    let mut add = |weight: f64| {
        all += weight;
        if weight <= equal {
            extreme += weight;
        }
    };
    let mut weight = 1.0;
    for i in first.k..high {
        weight *= ratio_up(i as f64);
        add(weight);
    }
    weight = 1.0;
    for i in (low..first.k).rev() {
        weight /= ratio_up(i as f64);
        add(weight);
    }
    if all.is_finite() { Some(extreme / all) } else { fisher_far(first, second, low, high) }
}

/// The same where this table is so unlikely that the others' weights overflow: all weights as logarithms.
fn fisher_far(first: Proportion, second: Proportion, low: u64, high: u64) -> Option<f64> {
    let successes = first.k + second.k;
    let ln_weight = |i: u64| ln_choose(first.n, i) + ln_choose(second.n, successes - i);
    let here = ln_weight(first.k);
    let most = (low..=high).map(ln_weight).fold(f64::NEG_INFINITY, f64::max);
    let (mut all, mut extreme) = (0.0, 0.0);
    for weight in (low..=high).map(ln_weight) {
        all += (weight - most).exp();
        if weight <= here + 1e-10 {
            extreme += (weight - most).exp();
        }
    }
    Some(extreme / all)
}

fn ln_choose(n: u64, k: u64) -> f64 {
    // C(n, k) = 1 / ((n + 1) B(k + 1, n - k + 1)).
    -((n + 1) as f64).ln() - beta::ln_beta(k as f64 + 1.0, (n - k) as f64 + 1.0)
}

/// Barnard's exact test with the pooled score statistic (Barnard 1947; Suissa and Shuster 1985): the largest probability,
/// over the common proportion, of a table at least as extreme as this one.
#[must_use]
pub fn barnard(first: Proportion, second: Proportion) -> Option<f64> {
    if first.n == 0 || second.n == 0 || first.n > BARNARD_LIMIT || second.n > BARNARD_LIMIT {
        return None;
    }
    let (m, n) = (first.n, second.n);
    let here = score(first.k, m, second.k, n);
    // The number of extreme tables by their total of successes, as the logarithm of their weight.
    let mut ln_weights = vec![f64::NEG_INFINITY; usize::try_from(m + n + 1).ok()?];
    let column = |n: u64| -> Vec<f64> { (0..=n).map(|k| ln_choose(n, k)).collect() };
    let (ln_first, ln_second) = (column(m), column(n));
    for (i, first) in ln_first.iter().enumerate() {
        for (j, second) in ln_second.iter().enumerate() {
            if !less(score(i as u64, m, j as u64, n), here) {
                let total = &mut ln_weights[i + j];
                *total = crate::special::ln_add_exp(*total, first + second);
            }
        }
    }
    if here.0 == 0 {
        return Some(1.0);
    }
    let size = |p: f64| -> f64 {
        let (ln_p, ln_q) = (p.ln(), (-p).ln_1p());
        let people = (m + n) as f64;
        let terms = ln_weights.iter().enumerate().filter(|(_, weight)| weight.is_finite());
        terms.map(|(s, weight)| (weight + s as f64 * ln_p + (people - s as f64) * ln_q).exp()).sum()
    };
    Some(largest(size).min(1.0))
}

/// The square of the pooled score statistic, as a fraction of whole numbers, so that tables as extreme as each other are
/// known to be. 0 where the statistic is not defined (all or no successes).
fn score(a: u64, m: u64, b: u64, n: u64) -> (u128, u128) {
    let s = a + b;
    if s == 0 || s == m + n {
        return (0, 1);
    }
    let cross = u128::from((a * n).abs_diff(b * m));
    (cross * cross * u128::from(m + n), u128::from(m * n) * u128::from(s) * u128::from(m + n - s))
}

fn less(left: (u128, u128), right: (u128, u128)) -> bool {
    left.0 * right.1 < right.0 * left.1
}

/// The largest value of a smooth function on (0, 1): a grid, then golden sections about every peak near the highest.
fn largest(f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 1000;
    let values: Vec<f64> =
        (0..=STEPS).map(|i| if i == 0 || i == STEPS { 0.0 } else { f(i as f64 / STEPS as f64) }).collect();
    let highest = values.iter().copied().fold(0.0, f64::max);
    let mut best = highest;
    for i in 1..STEPS {
        if values[i] < 0.999 * highest || values[i] < values[i - 1] || values[i] < values[i + 1] {
            continue;
        }
        let (mut low, mut high) = ((i - 1) as f64 / STEPS as f64, (i + 1) as f64 / STEPS as f64);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        for _ in 0..40 {
            let (left, right) = (high - golden * (high - low), low + golden * (high - low));
            if f(left) > f(right) { high = right } else { low = left }
        }
        best = best.max(f(0.5 * (low + high)));
    }
    best
}

/// Holm's step-down adjustment: p values that may each be compared with alpha though there are several (Holm 1979).
#[must_use]
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));
    let mut adjusted = vec![0.0; p.len()];
    let mut running = 0.0_f64;
    for (rank, &i) in order.iter().enumerate() {
        running = running.max(((p.len() - rank) as f64 * p[i]).min(1.0));
        adjusted[i] = running;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn contrast(a: u64, m: u64, b: u64, n: u64) -> Contrast {
        Contrast::new(Proportion { k: a, n: m }, Proportion { k: b, n }, 0.95).unwrap()
    }

    #[test]
    fn nine_and_eight_of_sixteen() {
        let found = contrast(9, 16, 8, 16);
        assert_eq!(found.difference, 0.0625);
        assert!((found.newcombe[0] + 0.256).abs() < 5e-4 && (found.newcombe[1] - 0.364).abs() < 5e-4);
        assert!((found.fisher_p.unwrap() - 1.0).abs() < 1e-12);
    }

    /// Fisher's tea: four of four right, p = 2 / C(8, 4).
    #[test]
    fn the_lady_tasting_tea() {
        assert!((contrast(4, 4, 0, 4).fisher_p.unwrap() - 2.0 / 70.0).abs() < 1e-15);
        // Barnard: both extreme tables at p = 1/2, 2 / 2^8.
        assert!((contrast(4, 4, 0, 4).barnard_p.unwrap() - 2.0 / 256.0).abs() < 1e-12);
    }

    #[test]
    fn large_arms_are_left_to_the_interval() {
        let found = contrast(500_000_000, 1_000_000_000, 400_000_000, 1_000_000_000);
        assert_eq!((found.fisher_p, found.barnard_p), (None, None));
        assert!((found.difference - 0.1).abs() < 1e-15);
        let far = contrast(3000, 3000, 0, 3000);
        assert_eq!((far.barnard_p, far.fisher_p.unwrap() < 1e-300), (None, true));
        assert_eq!(Contrast::new(Proportion { k: 0, n: 0 }, Proportion { k: 1, n: 2 }, 0.95), None);
    }

    #[test]
    fn holm_s_example() {
        let close =
            |found: Vec<f64>, expected: [f64; 4]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(holm(&[0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02]));
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }

    proptest! {
        #[test]
        fn swapping_arms_or_answers_changes_only_signs(a in 0..30_u64, x in 0..30_u64, b in 0..30_u64, y in 0..30_u64) {
            prop_assume!(a + x > 0 && b + y > 0);
            let (m, n) = (a + x, b + y);
            let this = contrast(a, m, b, n);
            let near = |p: Option<f64>, q: Option<f64>| (p.unwrap() / q.unwrap() - 1.0).abs() < 1e-9;
            for (other, sign) in [(contrast(b, n, a, m), -1.0), (contrast(x, m, y, n), -1.0)] {
                prop_assert!(near(this.fisher_p, other.fisher_p) && near(this.barnard_p, other.barnard_p));
                prop_assert!((this.difference - sign * other.difference).abs() < 1e-12);
                prop_assert!((this.newcombe[0] + other.newcombe[1]).abs() < 1e-12);
            }
            prop_assert!(this.newcombe[0] <= this.difference && this.difference <= this.newcombe[1]);
        }

        #[test]
        fn the_far_sum_agrees(a in 0..60_u64, x in 0..60_u64, b in 0..60_u64, y in 0..60_u64) {
            let (first, second) = (Proportion { k: a, n: a + x }, Proportion { k: b, n: b + y });
            let low = (a + b).saturating_sub(second.n);
            let far = fisher_far(first, second, low, (a + b).min(first.n)).unwrap();
            prop_assert!((fisher(first, second).unwrap() / far - 1.0).abs() < 1e-9);
        }
    }
}
