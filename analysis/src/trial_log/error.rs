//! What can be wrong with a log, and where.

use std::fmt;
use std::path::PathBuf;

/// A place in a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The log.
    pub file: PathBuf,
    /// Line in the file, from 1.
    pub line: u64,
    /// Number of the column, from 1, and its name, which is empty where it has none.
    pub column: Option<(usize, String)>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, line {}", self.file.display(), self.line)?;
        match &self.column {
            Some((number, name)) if name.is_empty() => write!(f, ", column {number}"),
            Some((number, name)) => write!(f, ", column {number} ({name})"),
            None => Ok(()),
        }
    }
}

/// Why a log cannot be used. The message says what was expected and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file could not be read.
    #[error("{}: {source}", file.display())]
    Io {
        /// The log.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The log's content is wrong.
    #[error("{place}: {message}")]
    Content {
        /// Where.
        place: Place,
        /// What is wrong, what was expected, what to do.
        message: String,
    },
}

impl Error {
    /// True where the input is wrong (exit code 2), false where the machine could not (exit code 1). A file that is not
    /// there is wrong input.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Content { .. } => true,
            Self::Io { source, .. } => source.kind() == std::io::ErrorKind::NotFound,
        }
    }
}
