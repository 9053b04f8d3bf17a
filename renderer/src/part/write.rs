//! Writing a part.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::PartError;
use super::read::Part;
use super::record::{Head, Tail};
use super::{Joined, MAGIC, join, seal};
use crate::film::{Film, Plane};
use crate::picture::AtomicFile;

/// A part being written: takes tiles in their order, and appears under its name when [`PartFile::finish`] succeeds.
#[derive(Debug)]
pub struct PartFile {
    path: PathBuf,
    head: String,
    planes: Vec<Plane>,
    file: AtomicFile,
    stream: BufWriter<File>,
    bytes: Vec<u8>,
}

impl PartFile {
    /// Starts a part that will be called `path`.
    ///
    /// # Errors
    /// If the head makes no sense, or the file cannot be written.
    pub fn create(path: &Path, head: &Head) -> Result<Self, PartError> {
        let planes = head.planes().filter(|_| head.shard().is_some());
        let planes = planes.ok_or_else(|| PartError::damaged(path, "its head makes no sense"))?;
        let writing = |error| PartError::writing(path, error);
        let file = AtomicFile::create(path).map_err(writing)?;
        let mut stream = BufWriter::with_capacity(1 << 20, file.handle().map_err(writing)?);
        let head = serde_json::to_string(head).map_err(|error| writing(error.into()))?;
        writeln!(stream, "{MAGIC}\n{head}").map_err(writing)?;
        Ok(Self { path: path.to_owned(), head, planes, file, stream, bytes: Vec::new() })
    }

    /// Takes the next tile, as a film of its size. Panics if a plane of the head is not there.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn add(&mut self, tile: &Film) -> Result<(), PartError> {
        self.bytes.clear();
        for &plane in &self.planes {
            let plane = tile.plane(plane).expect("a tile has the planes of its picture");
            let numbers = plane.values().iter().flat_map(|pixel| pixel.to_array());
            self.bytes.extend(numbers.flat_map(f32::to_le_bytes));
        }
        let check = crc32fast::hash(&self.bytes);
        self.bytes.extend(check.to_le_bytes());
        self.stream.write_all(&self.bytes).map_err(|error| PartError::writing(&self.path, error))
    }

    /// Completes the file, puts it on disk and gives it its name.
    ///
    /// # Errors
    /// If the disk refuses; the name then means what it meant before.
    pub fn finish(mut self, tail: &Tail) -> Result<(), PartError> {
        self.end(tail)?;
        self.file.commit().map_err(|error| PartError::writing(&self.path, error))
    }

    /// Completes the file for this process alone: it never gets its name, and is gone when the scratch is dropped.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn into_scratch(mut self, tail: &Tail) -> Result<Scratch, PartError> {
        self.end(tail)?;
        let part = Part::open(&AtomicFile::temporary(&self.path))?;
        Ok(Scratch { joined: join(vec![part])?, _file: self.file })
    }

    fn end(&mut self, tail: &Tail) -> Result<(), PartError> {
        let writing = |error| PartError::writing(&self.path, error);
        let tail = serde_json::to_string(tail).map_err(|error| writing(error.into()))?;
        writeln!(self.stream, "{tail}\n{}", seal(&self.head, &tail)).and_then(|()| self.stream.flush()).map_err(writing)
    }
}

/// A whole picture on disk instead of in memory, for as long as this lives.
#[derive(Debug)]
pub struct Scratch {
    /// The picture.
    pub joined: Joined,
    _file: AtomicFile,
}
