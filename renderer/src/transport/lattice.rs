//! An order of pixels in which every beginning is spread evenly over the picture.

use std::ops::Range;

/// Edge of the square of pixels that the order repeats, and the number of its ranks.
const EDGE: usize = 16;

/// Ranks that there are: the pixels of one square.
pub const RANKS: u16 = (EDGE * EDGE) as u16;

/// The rank of a pixel, from 0 to [`RANKS`] - 1: the index matrix of ordered dithering (B. E. Bayer, "An optimum method
/// for two-level rendition of continuous-tone pictures", ICC 1973). The pixels of the first 4^k ranks are a square
/// lattice of step 16/2^k, those of the first 2 x 4^k a quincunx.
#[must_use]
pub const fn rank(x: usize, y: usize) -> u16 {
    let mut rank = 0;
    let mut bit = 0;
    while bit < 4 {
        let (x, y) = ((x >> bit) & 1, (y >> bit) & 1);
        rank |= ((x ^ y) << (7 - 2 * bit) | y << (6 - 2 * bit)) as u16;
        bit += 1;
    }
    rank
}

/// Pixels of some ranks.
pub(super) struct Lattice {
    /// For each row of the square, a bit for each of its columns.
    rows: [u16; EDGE],
}

impl Lattice {
    pub(super) fn new(ranks: &Range<u16>) -> Self {
        let holds = |x, y| u16::from(ranks.contains(&rank(x, y)));
        Self { rows: std::array::from_fn(|y| (0..EDGE).map(|x| holds(x, y) << x).sum()) }
    }

    /// Whether there are any in a row of the picture.
    pub(super) fn has_row(&self, y: usize) -> bool {
        self.rows[y % EDGE] != 0
    }

    /// Whether a pixel is one of them.
    pub(super) fn holds(&self, x: usize, y: usize) -> bool {
        self.rows[y % EDGE] >> (x % EDGE) & 1 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_power_of_four_is_a_lattice_and_every_rank_comes_once() {
        let mut seen = [false; RANKS as usize];
        for y in 0..EDGE {
            for x in 0..EDGE {
                let rank = rank(x, y);
                assert!(!std::mem::replace(&mut seen[rank as usize], true));
                for k in 0..=4 {
                    let step = EDGE >> k;
                    assert_eq!(rank < 1 << (2 * k), x % step == 0 && y % step == 0, "{x} {y} {k}");
                }
                assert_eq!(rank < 128, (x + y) % 2 == 0);
            }
        }
        assert_eq!(rank(35, 18), rank(3, 2));
        for ranks in [0..1, 1..8, 64..128, 0..RANKS] {
            let lattice = Lattice::new(&ranks);
            for (x, y) in (0..40).flat_map(|y| (0..40).map(move |x| (x, y))) {
                assert_eq!(lattice.holds(x, y), ranks.contains(&rank(x, y)));
                assert!(lattice.has_row(y) || !lattice.holds(x, y));
            }
        }
    }
}
