//! A part of a picture, for one of several machines: every N-th tile, so that parts take about as long.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use super::outcome::Account;
use super::tiles::Bench;
use super::{RenderError, Renderer};
use crate::film::{Block, Film};

/// Part `number` of `all`, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u32,
    all: u32,
}

impl Shard {
    /// The only part of one.
    pub const WHOLE: Self = Self { number: 1, all: 1 };

    /// Most parts that a picture can have.
    pub const MOST: u32 = 1_000_000;

    /// Part `number` of `all`; `None` unless `number` lies from 1 to `all`, and that does not exceed [`Self::MOST`].
    #[must_use]
    pub fn new(number: u32, all: u32) -> Option<Self> {
        (1 <= number && number <= all && all <= Self::MOST).then_some(Self { number, all })
    }

    /// Which part, from 1.
    #[must_use]
    pub fn number(self) -> u32 {
        self.number
    }

    /// How many parts there are.
    #[must_use]
    pub fn all(self) -> u32 {
        self.all
    }

    /// Of things numbered from 0, those that are this part's: every `all`-th.
    pub fn of(self, things: Range<usize>) -> impl Iterator<Item = usize> {
        let first = things.start + (self.number - 1) as usize;
        (first..things.end).step_by(self.all as usize)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        numbers
            .and_then(|(number, all)| Self::new(number, all))
            .ok_or_else(|| "expected I/N with I from 1 to N, such as 2/8".to_owned())
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.all)
    }
}

impl Renderer<'_> {
    /// Renders the tiles of a part of the picture and hands each over as a film of its own size, in the order of
    /// [`super::tile`]; no more than some thousands of them are held at once. All parts together are, to the last bit, the
    /// picture of [`Self::render`], whoever renders them, and their accounts add up to its.
    ///
    /// # Errors
    /// If the threads cannot be started, or `take` fails.
    pub fn render_shard<E: From<RenderError> + Send>(
        &self,
        shard: Shard,
        take: &mut (dyn FnMut(Block, &Film) -> Result<(), E> + Send),
    ) -> Result<Account, E> {
        let all = self.tiles();
        let tiles: Vec<Block> = shard.of(0..all.len()).map(|index| all[index]).collect();
        let ranges = self.ranges(0..self.settings.samples);
        let trace = |bench: &mut Bench, tile: Block| {
            let outcome = self.trace_tile(tile, &ranges, bench, &mut |_, _| ())?;
            let mut film = Film::new(tile.width, tile.height, self.stored(), self.has_ambient());
            film.store(Block { x: 0, y: 0, ..tile }, bench.sums(), self.settings.samples);
            Ok((outcome, film))
        };
        let all = self.in_threads(|| self.trace_tiles(&tiles, trace, &mut |tile, film| take(tile, &film)))??;
        Ok(all.into())
    }
}
