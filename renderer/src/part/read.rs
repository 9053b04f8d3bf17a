//! Reading a part: what it says of itself first, tiles when they are asked for.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::error::PartError;
use super::record::{Head, Tail};
use super::{MAGIC, seal};
use crate::film::{Block, Film, Plane};
use crate::render::{Account, Shard, tile, tile_count};

/// Longest line of JSON: what no head reaches.
const LONGEST_LINE: u64 = 1 << 24;

/// Bytes of a pixel of a plane, and of a tile's checksum.
const PIXEL: u64 = 12;
const CHECK: u64 = 4;

/// The file of a part, found to be whole; its planes stay on disk.
#[derive(Debug)]
pub struct Part {
    path: PathBuf,
    head: Head,
    tail: Tail,
    shard: Shard,
    planes: Vec<Plane>,
    account: Account,
    /// Where the first tile begins.
    start: u64,
}

impl Part {
    /// Opens a part and reads what it says of itself.
    ///
    /// # Errors
    /// If it cannot be read, is no part of a picture, or is not whole.
    pub fn open(path: &Path) -> Result<Self, PartError> {
        let reading = |error| PartError::reading(path, error);
        let damaged = |message: String| PartError::damaged(path, message);
        let mut file = BufReader::new(File::open(path).map_err(reading)?);
        let length = file.get_ref().metadata().map_err(reading)?.len();
        let magic = line(&mut file, MAGIC.len() as u64 + 1).map_err(reading)?;
        if magic.as_deref() != Some(MAGIC) {
            return Err(damaged("is no part of a picture, as `crex render --shard I/N -o PART` writes it".to_owned()));
        }
        let short = || damaged("is not whole: render it again".to_owned());
        let head = line(&mut file, LONGEST_LINE).map_err(reading)?.ok_or_else(short)?;
        let text = head;
        let head: Head = serde_json::from_str(&text).map_err(|error| damaged(format!("its head: {error}")))?;
        let start = file.stream_position().map_err(reading)?;
        let senseless = || damaged("its head makes no sense".to_owned());
        let (shard, planes) = head.shard().zip(head.planes()).ok_or_else(senseless)?;
        let most = i32::MAX as usize;
        if head.width == 0 || head.height == 0 || head.width > most || head.height > most {
            return Err(senseless());
        }
        // A tile has a pixel at least: sizes that the file cannot hold would only ask for time and memory.
        let count = tile_count(head.width, head.height);
        let own = count.saturating_sub(shard.number() as usize - 1).div_ceil(shard.all() as usize);
        if own as u64 > length / PIXEL {
            return Err(short());
        }
        let bytes: u64 = shard.of(0..count).map(|index| tile_bytes(&head, planes.len(), index)).sum();
        if length <= start + bytes {
            return Err(short());
        }
        file.seek(SeekFrom::Start(start + bytes)).map_err(reading)?;
        let tail = line(&mut file, LONGEST_LINE).map_err(reading)?.ok_or_else(short)?;
        let seal_there = line(&mut file, LONGEST_LINE).map_err(reading)?.ok_or_else(short)?;
        if seal_there != seal(&text, &tail) {
            return Err(damaged("is damaged: render it again".to_owned()));
        }
        let tail: Tail = serde_json::from_str(&tail).map_err(|error| damaged(format!("its account: {error}")))?;
        let account = tail.account().ok_or_else(|| damaged("its account names a component that is none".to_owned()))?;
        if file.stream_position().map_err(reading)? != length {
            return Err(damaged("goes on after its end".to_owned()));
        }
        Ok(Self { path: path.to_owned(), head, tail, shard, planes, account, start })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it is of.
    #[must_use]
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// What making it took.
    #[must_use]
    pub fn tail(&self) -> &Tail {
        &self.tail
    }

    /// Which part it is.
    #[must_use]
    pub fn shard(&self) -> Shard {
        self.shard
    }

    /// The planes that it holds.
    #[must_use]
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// What was done for it.
    #[must_use]
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// Where each of its tiles begins in the file, in their order.
    pub(super) fn offsets(&self) -> Vec<u64> {
        let tiles = self.shard.of(0..tile_count(self.head.width, self.head.height));
        let starts = tiles.scan(self.start, |next, index| {
            let start = *next;
            *next += tile_bytes(&self.head, self.planes.len(), index);
            Some(start)
        });
        starts.collect()
    }

    /// Reads the tiles among `tiles` (numbers of the picture's) into `band`, whose first row is the picture's row `y`; planes that
    /// the band has not are left out.
    pub(super) fn read(
        &self,
        tiles: Range<usize>,
        offsets: &[u64],
        band: &mut Film,
        y: usize,
    ) -> Result<(), PartError> {
        let reading = |error| PartError::reading(&self.path, error);
        let mut file = File::open(&self.path).map_err(reading)?;
        let mut bytes = Vec::new();
        let before = self.shard.of(0..tiles.start).count();
        let all = self.shard.all() as usize;
        let first = before * all + self.shard.number() as usize - 1;
        for (index, offset) in (first..tiles.end).step_by(all).zip(&offsets[before..]) {
            let length = tile_bytes(&self.head, self.planes.len(), index);
            bytes.resize(usize::try_from(length).expect("a tile fits in memory"), 0);
            file.seek(SeekFrom::Start(*offset)).and_then(|_| file.read_exact(&mut bytes)).map_err(reading)?;
            let (data, check) = bytes.split_at(bytes.len() - CHECK as usize);
            if crc32fast::hash(data).to_le_bytes() != check {
                let message = format!("tile {index} is damaged: render this part again");
                return Err(PartError::damaged(&self.path, message));
            }
            let block = tile(self.head.width, self.head.height, index);
            let size = block.pixels() * PIXEL as usize;
            for (&plane, data) in self.planes.iter().zip(data.chunks_exact(size)) {
                place(data, block, y, band, plane);
            }
        }
        Ok(())
    }
}

fn place(data: &[u8], block: Block, y: usize, band: &mut Film, plane: Plane) {
    let Some(plane) = band.plane_mut(plane) else { return };
    let (width, numbers) = (plane.width(), |bytes: &[u8]| {
        let number = |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        Vec3::new(number(0), number(4), number(8))
    });
    for (row, data) in data.chunks_exact(block.width * PIXEL as usize).enumerate() {
        let start = (block.y - y + row) * width + block.x;
        let pixels = &mut plane.values_mut()[start..start + block.width];
        pixels.iter_mut().zip(data.chunks_exact(PIXEL as usize)).for_each(|(pixel, bytes)| *pixel = numbers(bytes));
    }
}

/// Bytes of a tile in the file.
fn tile_bytes(head: &Head, planes: usize, index: usize) -> u64 {
    tile(head.width, head.height, index).pixels() as u64 * PIXEL * planes as u64 + CHECK
}

/// A line without its end; `None` if there is no whole line of at most so many bytes.
fn line(file: &mut impl BufRead, longest: u64) -> std::io::Result<Option<String>> {
    let mut bytes = Vec::new();
    file.take(longest).read_until(b'\n', &mut bytes)?;
    Ok(match bytes.pop() {
        Some(b'\n') => String::from_utf8(bytes).ok(),
        _ => None,
    })
}
