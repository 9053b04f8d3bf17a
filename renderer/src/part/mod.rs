//! Parts of pictures: what machines that share a picture, or one that cannot hold it, write to disk, and how such files are
//! joined to the picture that one machine would have made.
//!
//! A file of a part is, in order: the line `crex part 1`; a line of JSON, the [`Head`]; for each tile of the part
//! ([`crate::render::Shard`], [`crate::render::tile`]) its planes in the order of the head, each row by row from the top, a
//! pixel as three little-endian `f32` (linear red, green, blue; W/(sr m2)), then the CRC-32 of these bytes (IEEE 802.3,
//! little-endian); a line of JSON, the [`Tail`]; last a line with the CRC-32 of the texts of both lines of JSON, in 8 hexadecimal
//! digits.

mod error;
mod join;
mod read;
mod record;
mod write;

pub use error::{PartError, runs};
pub use join::{Joined, join};
pub use read::Part;
pub use record::{Head, Tail};
pub use write::{PartFile, Scratch};

/// The first line, without its end.
const MAGIC: &str = "crex part 1";

/// The last line, without its end.
fn seal(head: &str, tail: &str) -> String {
    let mut hash = crc32fast::Hasher::new();
    hash.update(head.as_bytes());
    hash.update(tail.as_bytes());
    format!("{:08x}", hash.finalize())
}
