//! What can go wrong with a picture file.

use std::io;
use std::path::{Path, PathBuf};

/// A picture that could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {kind}", path.display())]
pub struct Error {
    /// The file, or `-` for a stream.
    pub path: PathBuf,
    /// What is wrong with it.
    pub kind: Kind,
}

impl Error {
    pub(crate) fn new(path: &Path, kind: Kind) -> Self {
        Self { path: path.to_owned(), kind }
    }

    /// Whether the input is to blame, rather than the disk: the exit code 2 of a program instead of 1.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match &self.kind {
            Kind::Read(error) => error.kind() == io::ErrorKind::NotFound,
            Kind::Write(_) => false,
            _ => true,
        }
    }
}

/// What is wrong with a picture.
#[derive(Debug, thiserror::Error)]
pub enum Kind {
    /// The operating system refused to read.
    #[error("cannot be read: {0}")]
    Read(#[source] io::Error),
    /// The operating system refused to write.
    #[error("cannot be written: {0}")]
    Write(#[source] io::Error),
    /// The first bytes are of no known picture.
    #[error("is not a picture that is known here: expected OpenEXR, Radiance HDR or PNG")]
    Unknown,
    /// The name's extension says nothing.
    #[error("says no picture format: end its name in .exr, .hdr (or .pic) or .png")]
    Extension,
    /// The file breaks its format.
    #[error("is damaged or of an unsupported kind: {0}")]
    Damaged(String),
    /// A value that no picture can hold.
    #[error(
        "{layer} at column {x}, row {y} from the top is {value}, which no picture can hold: this is a fault of the renderer or of the scene's numbers"
    )]
    NotFinite {
        /// The layer, or `beauty`.
        layer: String,
        /// The column from 0.
        x: usize,
        /// The row from 0 at the top.
        y: usize,
        /// NaN or infinite.
        value: f32,
    },
    /// Rows are missing, too many or of the wrong width.
    #[error("{0}")]
    Rows(String),
    /// A map of single values that has colours.
    #[error("has colours: a map needs one grey value per pixel; save it as greyscale, 8 or 16 bits")]
    Colour,
    /// A map value outside [0, 1].
    #[error("column {x}, row {y} from the top is {value}: a map's values must lie in [0, 1]")]
    Range {
        /// The column from 0.
        x: usize,
        /// The row from 0 at the top.
        y: usize,
        /// The value.
        value: f32,
    },
}
