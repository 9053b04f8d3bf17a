//! An order of pixels in which every beginning is spread evenly over the picture.

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
    }
}
