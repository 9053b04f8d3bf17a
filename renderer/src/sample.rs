//! Random numbers as a pure function of where they are used.
//!
//! A number depends on the seed, the pixel, the sample, the path that led there and the dimension asked for, and on
//! nothing else: so neither the order in which bins run nor the number of threads changes a picture, and paths with the
//! same word of components use the same numbers whatever the crex.
//!
//! Each pair of dimensions is a scrambled and shuffled Sobol (0,2)-sequence over the samples of its pixel: B. Burley,
//! "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020, with the hash of N. Vegdahl, "Building a Better LK Hash",
//! 2021.

/// The way from the eye to a hit, as far as random numbers are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PathKey(u32);

impl PathKey {
    /// The path of primary rays.
    pub const EYE: Self = Self(0x9e37_79b9);

    /// This path, one event further. `step` tells apart the events that a hit can spawn.
    #[must_use]
    pub const fn then(self, step: u32) -> Self {
        Self(mix(self.0 as u64 ^ (step as u64 + 1) << 32) as u32)
    }
}

/// The random numbers of one ray and of the hit that it leads to.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    key: u64,
    /// The sample's number with its bits reversed.
    reversed: u32,
}

impl Sampler {
    /// The numbers for `path` in sample number `sample` of a pixel. Samples 0..n of a pixel are stratified together.
    #[must_use]
    pub const fn new(seed: u64, pixel: u64, path: PathKey, sample: u32) -> Self {
        let key = mix(mix(seed ^ mix(pixel)) ^ path.0 as u64);
        Self { key, reversed: sample.reverse_bits() }
    }

    /// A point of the unit square, in [0,1)^2. Different dimensions are independent of each other.
    #[must_use]
    pub const fn pair(&self, dimension: u32) -> [f64; 2] {
        let hash = mix(self.key.wrapping_add((dimension as u64).wrapping_mul(GOLDEN)));
        let (shuffle, scramble) = (hash as u32, (hash >> 32) as u32);
        let shuffled = owen(self.reversed, shuffle).reverse_bits();
        let first = owen(shuffled, scramble);
        let second = owen(pascal(shuffled), scramble.wrapping_mul(0x9e37_79b1) ^ shuffle);
        [unit(first.reverse_bits()), unit(second.reverse_bits())]
    }

    /// A number in [0,1).
    #[must_use]
    pub const fn single(&self, dimension: u32) -> f64 {
        self.pair(dimension)[0]
    }
}

/// 2^64 over the golden ratio, odd.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes 64 bits (the finaliser of SplitMix64: Steele, Lea and Flood, OOPSLA 2014, with Stafford's constants).
const fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(GOLDEN);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

/// Owen scrambling of bits in reversed order: each bit is flipped depending on the bits below it.
const fn owen(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul(seed >> 16 | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Multiplies by Pascal's triangle modulo 2, which makes the second Sobol dimension (bits reversed) of an index.
const fn pascal(index: u32) -> u32 {
    // Entry (i, j) is odd just if the bits of i are among those of j (Lucas): a sum over supersets, one bit of i at a
    // time.
    let mut x = index;
    x ^= x >> 1 & 0x5555_5555;
    x ^= x >> 2 & 0x3333_3333;
    x ^= x >> 4 & 0x0f0f_0f0f;
    x ^= x >> 8 & 0x00ff_00ff;
    x ^ x >> 16 & 0x0000_ffff
}

/// 32 bits as a number in [0,1).
const fn unit(bits: u32) -> f64 {
    bits as f64 * (1.0 / 4_294_967_296.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(seed: u64, pixel: u64, dimension: u32, n: u32) -> Vec<[f64; 2]> {
        (0..n).map(|sample| Sampler::new(seed, pixel, PathKey::EYE, sample).pair(dimension)).collect()
    }

    #[test]
    fn the_second_dimension_is_sobols() {
        // Direction numbers of Sobol's second dimension: rows of Pascal's triangle modulo 2, from the top bit.
        let numbers = [0x8000_0000_u32, 0xc000_0000, 0xa000_0000, 0xf000_0000, 0x8800_0000];
        for (bit, number) in numbers.into_iter().enumerate() {
            assert_eq!(pascal(1 << bit).reverse_bits(), number);
        }
    }

    proptest! {
        /// Every elementary interval of area 2^-k holds exactly one of the first 2^k points, and of each 2^k that
        /// follow.
        #[test]
        fn pairs_are_a_0_2_sequence(seed: u64, pixel: u64, dimension in 0..100_u32, k in 0..9_u32, block in 0..4_u32) {
            let n = 1_u32 << k;
            for wide in 0..=k {
                let (columns, rows) = (f64::from(1 << wide), f64::from(1 << (k - wide)));
                let mut seen = vec![false; n as usize];
                for sample in block * n..(block + 1) * n {
                    let [x, y] = Sampler::new(seed, pixel, PathKey::EYE, sample).pair(dimension);
                    let cell = (x * columns) as usize + (y * rows) as usize * (columns as usize);
                    prop_assert!(!std::mem::replace(&mut seen[cell], true));
                }
            }
        }

        #[test]
        fn numbers_are_a_function_of_their_place(seed: u64, pixel: u64, sample: u32, step in 0..12_u32, dimension: u32) {
            let path = PathKey::EYE.then(step);
            let [x, y] = Sampler::new(seed, pixel, path, sample).pair(dimension);
            prop_assert_eq!([x, y], Sampler::new(seed, pixel, path, sample).pair(dimension));
            prop_assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
        }
    }

    /// The correlation of n independent pairs is normal with deviation 1/sqrt(n); 5 deviations raise a false alarm once
    /// in 1.7 million, here 4 times: 2e-6. The seed is fixed.
    #[test]
    fn pixels_paths_dimensions_and_seeds_are_uncorrelated() {
        let n = 40_000_u32;
        let base = |i: u32| Sampler::new(1, u64::from(i), PathKey::EYE, 3).pair(0)[0];
        let others: [&dyn Fn(u32) -> f64; 4] = [
            &|i| Sampler::new(1, u64::from(i) + 1, PathKey::EYE, 3).pair(0)[0],
            &|i| Sampler::new(1, u64::from(i), PathKey::EYE.then(2), 3).pair(0)[0],
            &|i| Sampler::new(1, u64::from(i), PathKey::EYE, 3).pair(1)[0],
            &|i| Sampler::new(2, u64::from(i), PathKey::EYE, 3).pair(0)[0],
        ];
        for other in others {
            let sum: f64 = (0..n).map(|i| (base(i) - 0.5) * (other(i) - 0.5) * 12.0).sum();
            let correlation = sum / f64::from(n);
            assert!(correlation.abs() < 5.0 / f64::from(n).sqrt(), "{correlation}");
        }
    }

    /// Over many pixels the estimate is unbiased: the mean of x y is 1/4, with deviation .22/sqrt(n) for independent
    /// points and less for stratified ones. 5 deviations: false alarm below 1e-6; fixed seed.
    #[test]
    fn estimates_are_unbiased() {
        let pixels = 4_000;
        let mean =
            (0..pixels).map(|pixel| points(7, pixel, 5, 5).iter().map(|[x, y]| x * y).sum::<f64>() / 5.0).sum::<f64>()
                / pixels as f64;
        assert!((mean - 0.25).abs() < 5.0 * 0.22 / (5.0 * pixels as f64).sqrt(), "{mean}");
    }

    #[test]
    fn stratified_estimates_beat_independent_ones() {
        // Root mean square error of the mean of x y at n = 256: independent points give .22/16 = .0138.
        let pixels = 200_u64;
        let square_error: f64 = (0..pixels)
            .map(|pixel| points(3, pixel, 0, 256).iter().map(|[x, y]| x * y).sum::<f64>() / 256.0 - 0.25)
            .map(|error| error * error)
            .sum();
        let error = (square_error / pixels as f64).sqrt();
        assert!(error < 0.0138 / 10.0, "{error}");
    }

    #[test]
    fn paths_of_different_words_differ() {
        let mut keys: Vec<u32> = vec![PathKey::EYE.0];
        let mut last = vec![PathKey::EYE];
        for _ in 0..4 {
            last = last.iter().flat_map(|path| (0..12).map(|step| path.then(step))).collect();
            keys.extend(last.iter().map(|path| path.0));
        }
        let all = keys.len();
        keys.sort_unstable();
        keys.dedup();
        // 22621 keys of 32 bits: .06 collisions expected, 3 or more in one of 30 000 draws.
        assert!(all - keys.len() < 3);
    }
}
