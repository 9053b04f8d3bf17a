//! What can go wrong with the parts of a picture.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use crate::render::RenderError;

/// Why a part cannot be written, read or joined.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// The renderer refused.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The operating system refused.
    #[error("{}: cannot be {doing}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: `read` or `written`.
        doing: &'static str,
        /// Why not.
        source: io::Error,
    },
    /// The file is no part of a picture, or not all of one.
    #[error("{}: {message}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// Two files are not parts of the same picture.
    #[error("{} and {} are parts of different pictures: {what}", first.display(), other.display())]
    Different {
        /// The first file.
        first: PathBuf,
        /// One that differs.
        other: PathBuf,
        /// In what, with both values.
        what: String,
    },
    /// Parts are missing or there twice.
    #[error("{}", incomplete(*all, missing, double))]
    Incomplete {
        /// How many parts there should be.
        all: u32,
        /// Those that are not there, from 1, ascending.
        missing: Vec<u32>,
        /// Those that are there more than once, with their files.
        double: Vec<(u32, Vec<PathBuf>)>,
    },
}

impl PartError {
    pub(super) fn reading(path: &Path, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing: "read", source }
    }

    pub(super) fn writing(path: &Path, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), doing: "written", source }
    }

    pub(super) fn damaged(path: &Path, message: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_owned(), message: message.into() }
    }

    /// Whether the input is to blame, rather than the machine: the exit code 2 of a program instead of 1.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Io { doing, source, .. } => *doing == "read" && source.kind() == io::ErrorKind::NotFound,
            Self::Render(RenderError::Threads { .. }) => false,
            _ => true,
        }
    }
}

/// Numbers as a list of runs, such as `1,4-6`: what `sbatch --array` takes.
#[must_use]
pub fn runs(numbers: &[u32]) -> String {
    let mut text = String::new();
    let mut rest = numbers;
    while let Some(&first) = rest.first() {
        let length = rest.iter().zip(first..).take_while(|(number, expected)| *number == expected).count();
        let last = rest[length - 1];
        let comma = if text.is_empty() { "" } else { "," };
        // Writing to a string does not fail.
        let _ = match length {
            1 => write!(text, "{comma}{first}"),
            _ => write!(text, "{comma}{first}-{last}"),
        };
        rest = &rest[length..];
    }
    text
}

fn incomplete(all: u32, missing: &[u32], double: &[(u32, Vec<PathBuf>)]) -> String {
    let mut lines = Vec::new();
    if !missing.is_empty() {
        let one = missing[0];
        let (part, is) = if missing.len() == 1 { ("part", "is") } else { ("parts", "are") };
        lines.push(format!(
            "{part} {} of {all} {is} missing: render what is missing, such as with --shard {one}/{all}, and join again",
            runs(missing)
        ));
    }
    for (number, files) in double {
        let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        lines.push(format!("part {number} of {all} is there {} times: {}; give one", files.len(), files.join(", ")));
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_listed_in_runs() {
        for (numbers, text) in [(&[][..], ""), (&[3], "3"), (&[1, 2], "1-2"), (&[1, 3, 4, 5, 9], "1,3-5,9")] {
            assert_eq!(runs(numbers), text);
        }
    }
}
