//! How large a departure from one half is, in the units that people compare.

use serde::Serialize;

use crate::proportion::Proportion;
use crate::special::normal;

/// Effect sizes of a proportion against one half. Infinite values (everybody, nobody) are `null` in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Cohen's h, `2 asin sqrt p - pi/2`: .2 is called small, .5 medium, .8 large (Cohen 1988, chapter 6).
    pub h: f64,
    /// Cohen's w, `sqrt(chi-square / n)`.
    pub w: f64,
    /// Cohen's g, `p - 1/2`.
    pub g: f64,
    /// Sensitivity d' of two-alternative forced choice without regard to order, `sqrt 2 z(p)` (Green and Swets 1966).
    pub d_prime: f64,
    /// d' at the ends of the Clopper-Pearson interval.
    pub d_prime_interval: [f64; 2],
    /// Just-objectionable differences, `z(p) / z(3/4)`.
    pub jod: f64,
}

impl Effect {
    /// The effect sizes of `counts`, with the limits of its Clopper-Pearson interval; none without data.
    #[must_use]
    pub fn new(counts: Proportion, clopper_pearson: [f64; 2]) -> Option<Self> {
        let p = counts.value()?;
        let (k, n) = counts.as_f64();
        // 2p - 1 without the rounding of p.
        let doubled = (2.0 * k - n) / n;
        let d_prime = |p: f64| std::f64::consts::SQRT_2 * normal::quantile(p);
        Some(Self {
            h: doubled.asin(),
            w: doubled.abs(),
            g: 0.5 * doubled,
            d_prime: d_prime(p),
            d_prime_interval: clopper_pearson.map(d_prime),
            jod: normal::quantile(p) / normal::quantile(0.75),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interval::clopper_pearson;

    fn effect(k: u64, n: u64) -> Effect {
        let counts = Proportion { k, n };
        Effect::new(counts, clopper_pearson(counts, 0.95)).unwrap()
    }

    #[test]
    fn the_paper_s_effect() {
        let found = effect(9, 16);
        assert!((found.h - 0.125_327_831_168_065).abs() < 1e-14); // asin(1/8)
        assert_eq!((found.w, found.g), (0.125, 0.0625));
        assert!((found.d_prime - 0.22).abs() < 5e-3);
        assert!((found.d_prime_interval[0] + 0.75).abs() < 5e-3 && (found.d_prime_interval[1] - 1.20).abs() < 5e-3);
    }

    #[test]
    fn three_in_four_is_one_jod() {
        assert!((effect(12, 16).jod - 1.0).abs() < 1e-14);
        assert!((effect(12, 16).d_prime - (2.0 * 0.674_489_750_196_081_7_f64.powi(2)).sqrt()).abs() < 1e-14);
    }

    #[test]
    fn everybody_is_infinitely_far() {
        let found = effect(16, 16);
        assert_eq!((found.d_prime, found.h), (f64::INFINITY, std::f64::consts::FRAC_PI_2));
        assert!(serde_json::to_value(found).unwrap()["d_prime"].is_null());
        assert_eq!(Effect::new(Proportion { k: 0, n: 0 }, [0.0, 1.0]), None);
    }
}
