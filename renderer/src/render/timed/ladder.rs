//! The order in which a picture under a time limit is refined: coarse lattices of pixels first, then whole passes.

use std::collections::BTreeMap;

use crate::film::Block;
use crate::sample::{PathKey, Sampler};
use crate::transport::RANKS;

/// Levels that are sprinkled before anything is decided: 1/256 of the pixels first, then 1/16.
pub(super) const SPRINKLED: u64 = 2;

/// Levels that make up the first pass: lattices that grow until every pixel has a sample.
const FIRST: u64 = 7;

/// Parts of every later pass, each a lattice of every other column and row.
const PARTS: u64 = 4;

/// Edge of the blocks of the coarsest levels, in pixels: as few rays as these have in a tile tell more about beginning a stage than
/// about rays.
const BLOCK: usize = 32;

/// Pixels of equal standing, to be sampled once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Level {
    /// Which pass over the picture it belongs to, from 0.
    pub(super) pass: u32,
    /// The ranks of its pixels, end exclusive.
    pub(super) ranks: (u16, u16),
}

impl Level {
    /// Level number `index`.
    pub(super) fn new(index: u64) -> Self {
        let quarter = |part: u64| {
            let size = RANKS / PARTS as u16;
            (size * part as u16, size * (part as u16 + 1))
        };
        match index {
            0 => Self { pass: 0, ranks: (0, 1) },
            1 => Self { pass: 0, ranks: (1, 16) },
            2 | 3 => Self { pass: 0, ranks: (8 << (index - 1), 8 << index) },
            4..FIRST => Self { pass: 0, ranks: quarter(index - 3) },
            _ => {
                let (pass, part) = (1 + (index - FIRST) / PARTS, (index - FIRST) % PARTS);
                Self { pass: u32::try_from(pass).unwrap_or(u32::MAX), ranks: quarter(part) }
            }
        }
    }

    /// Whole passes that so many levels amount to.
    pub(super) fn passes(levels: u64) -> u64 {
        if levels < FIRST { 0 } else { 1 + (levels - FIRST) / PARTS }
    }

    /// The part of the pixels that it holds.
    pub(super) fn share(self) -> f64 {
        f64::from(self.ranks.1 - self.ranks.0) / f64::from(RANKS)
    }
}

/// The places of tiles in an order that leaves no trace in a picture that is cut off: as if drawn at random.
pub(super) fn scrambled(tiles: &[Block]) -> Vec<usize> {
    let mut order: Vec<(u64, usize)> = (0..tiles.len())
        .map(|place| (Sampler::new(0, place as u64, PathKey::EYE, 0).pair(0)[0].to_bits(), place))
        .collect();
    order.sort_unstable();
    order.into_iter().map(|(_, place)| place).collect()
}

/// The same in larger blocks: the places of the tiles of each, the blocks scrambled.
pub(super) fn scrambled_blocks(tiles: &[Block]) -> Vec<(Block, Vec<usize>)> {
    let mut blocks: BTreeMap<(usize, usize), (Block, Vec<usize>)> = BTreeMap::new();
    for (place, tile) in tiles.iter().enumerate() {
        let of = (tile.y / BLOCK, tile.x / BLOCK);
        let first = || (Block { width: 0, height: 0, ..*tile }, Vec::new());
        let (block, places) = blocks.entry(of).or_insert_with(first);
        // Tiles come row by row, so the first one is the block's corner.
        block.width = block.width.max(tile.x + tile.width - block.x);
        block.height = block.height.max(tile.y + tile.height - block.y);
        places.push(place);
    }
    let mut blocks: Vec<Option<(Block, Vec<usize>)>> = blocks.into_values().map(Some).collect();
    let corners: Vec<Block> = blocks.iter().flatten().map(|(block, _)| *block).collect();
    scrambled(&corners).into_iter().filter_map(|place| blocks[place].take()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{tile, tile_count};

    #[test]
    fn every_pass_takes_every_rank_once_in_rising_order() {
        let mut levels = (0..).map(Level::new).peekable();
        for pass in 0..3 {
            let mut next = 0;
            while let Some(level) = levels.next_if(|level| level.pass == pass) {
                assert_eq!(level.ranks.0, next);
                next = level.ranks.1;
            }
            assert_eq!(next, RANKS);
        }
        let passes = [0, 6, 7, 10, 11, 14, 15].map(Level::passes);
        assert_eq!(passes, [0, 0, 1, 1, 2, 2, 3]);
        assert_eq!(Level::new(1).share(), 15.0 / 256.0);
        assert_eq!(Level::new(SPRINKLED).ranks.0, 16);
    }

    #[test]
    fn scrambled_is_a_permutation() {
        let tiles = vec![Block { x: 0, y: 0, width: 1, height: 1 }; 100];
        let mut order = scrambled(&tiles);
        assert!(order.windows(2).any(|pair| pair[0] > pair[1]));
        order.sort_unstable();
        assert!(order.into_iter().eq(0..100));
    }

    #[test]
    fn blocks_hold_every_tile_once() {
        let (width, height) = (200, 90);
        let tiles: Vec<Block> = (0..tile_count(width, height)).map(|index| tile(width, height, index)).collect();
        let blocks = scrambled_blocks(&tiles);
        assert_eq!(blocks.len(), 7 * 3);
        let mut seen: Vec<usize> = blocks.iter().flat_map(|(_, places)| places.clone()).collect();
        seen.sort_unstable();
        assert!(seen.into_iter().eq(0..tiles.len()));
        for (block, places) in &blocks {
            assert_eq!(block.pixels(), places.iter().map(|&place| tiles[place].pixels()).sum::<usize>());
            assert!(block.width <= BLOCK && block.height <= BLOCK);
        }
    }
}
