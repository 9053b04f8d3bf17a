//! What `{ }` does with the importance of pixels.

use crate::raster::Raster;
use crate::sample::{PathKey, Sampler};

use super::dimension;

/// An importance map of the whole picture, values in [0, 1], and what it decides.
#[derive(Clone, Copy, Debug)]
pub struct Modulation<'a> {
    /// How much each pixel matters.
    pub map: &'a Raster<f32>,
    /// By which rule.
    pub rule: Rule,
}

/// How importance becomes rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// A member of `{ }` runs the rays of pixels that reach its threshold (Debattista et al. 2005, section 4).
    Thresholds,
    /// Every member of `{ }` runs wherever the map is above 0, for as many samples of a pixel as its importance says,
    /// with ripple that makes up for the others: the expected picture is the one without a map.
    ///
    /// Of N samples of a pixel of importance p the first n run, n = pN rounded up or down at random so that its mean is
    /// pN; the first n numbers of each dimension are themselves stratified. Their ripple grows by N/n where pN >= 1
    /// (the mean of any n samples is unbiased, and so the random n adds no noise), else by 1/p (Russian roulette: J.
    /// Arvo and D. Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990). A path is chosen and weighted once,
    /// however many modulated components it has.
    Continuous {
        /// N: samples of each pixel.
        samples: u32,
    },
    /// Every member of `{ }` runs all samples wherever the map is above 0: the picture that [`Self::Continuous`] expects.
    Expected,
}

/// What continuous importance has decided of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// Its sample runs the members of `{ }`.
    #[default]
    Chosen,
    /// Its sample leaves them to others of its pixel.
    PassedOver,
    /// It has run one, and its ripple stands for those passed over.
    Weighted,
}

/// The samples of one pixel that run the members of `{ }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    /// How many, from the first.
    pub(super) chosen: u32,
    /// What the ripple of each grows by.
    pub(super) weight: f64,
}

impl Modulation<'_> {
    /// The share of a pixel, `name` as random numbers know it; `None` if thresholds decide, or if its importance is 0.
    pub(super) fn share(&self, x: usize, y: usize, name: u64, seed: u64) -> Option<Share> {
        let Rule::Continuous { samples } = self.rule else { return None };
        let importance = f64::from(*self.map.at(x, y));
        let (all, expected) = (f64::from(samples), importance * f64::from(samples));
        let rounding = || Sampler::new(seed, name, PathKey::EYE, 0).single(dimension::IMPORTANCE);
        if importance <= 0.0 {
            return None;
        }
        let chosen = if importance < 1.0 { (expected + rounding()).floor().min(all) } else { all };
        let weight = if expected >= 1.0 { all / chosen } else { 1.0 / importance };
        Some(Share { chosen: chosen as u32, weight })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn share(importance: f32, samples: u32, seed: u64) -> Option<Share> {
        let map = Raster::filled(1, 1, importance);
        Modulation { map: &map, rule: Rule::Continuous { samples } }.share(0, 0, 0, seed)
    }

    proptest! {
        #[test]
        fn samples_follow_importance(importance in 1e-6_f32..1.0, samples in 1..100_000_u32, seed: u64) {
            let Share { chosen, weight } = share(importance, samples, seed).unwrap();
            let expected = f64::from(importance) * f64::from(samples);
            prop_assert!(f64::from(chosen) >= expected.floor() && f64::from(chosen) <= expected.ceil());
            prop_assert!(chosen <= samples && weight >= 1.0);
        }

        #[test]
        fn the_ends_are_exact(samples in 1_u32.., seed: u64) {
            prop_assert_eq!(share(1.0, samples, seed), Some(Share { chosen: samples, weight: 1.0 }));
            prop_assert_eq!(share(0.0, samples, seed), None);
        }
    }

    /// The mean weight that a sample gets is 1: over 40 000 seeds the total weight / N has a deviation of at most
    /// 1/p/2/200 where pN < 1 (one draw a pixel) and none else; 5 deviations: false alarm 6e-7 for each of the two.
    #[test]
    fn weights_make_up_for_what_is_passed_over() {
        for (importance, samples) in [(0.3_f32, 1), (0.15, 4), (0.3, 10), (0.77, 16)] {
            let seeds = 40_000_u64;
            let total: f64 = (0..seeds)
                .map(|seed| {
                    let Share { chosen, weight } = share(importance, samples, seed).unwrap();
                    f64::from(chosen) * weight / f64::from(samples)
                })
                .sum();
            let mean = total / seeds as f64;
            let p = (f64::from(importance) * f64::from(samples)).min(1.0);
            let deviation = ((1.0 - p) / p / seeds as f64).sqrt();
            assert!((mean - 1.0).abs() <= 5.0 * deviation + 1e-9, "{importance} x {samples}: {mean}");
        }
    }
}
