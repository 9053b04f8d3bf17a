//! What can go wrong around a session, and what to do about it.

use std::path::{Path, PathBuf};

/// The crate's result.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a session cannot begin, go on or be saved.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The study or its manifest.
    #[error(transparent)]
    Study(#[from] stimuli::Error),
    /// A log that is there.
    #[error(transparent)]
    Log(#[from] analysis::trial_log::Error),
    /// What was asked for cannot be: what was found, what was expected, what to do.
    #[error("{0}")]
    Input(String),
    /// The machine could not: the same.
    #[error("{0}")]
    Machine(String),
    /// The file system refused.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io {
        /// What was asked of it, as in "cannot read".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's word.
        source: std::io::Error,
    },
}

impl Error {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }

    /// True where the input is wrong (exit code 2), false where the machine could not (exit code 1).
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Study(error) => error.is_input(),
            Self::Log(error) => error.is_input(),
            Self::Input(_) => true,
            Self::Machine(_) | Self::Io { .. } => false,
        }
    }
}
