//! What can go wrong when a study or a manifest is read, and what to do about it.

use std::fmt;
use std::path::{Path, PathBuf};

/// The crate's result.
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that reading and writing studies and manifests reports.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file's content is wrong. Every mistake that was found, in the order of the file.
    #[error("{}", list(.0))]
    Wrong(Vec<Mistake>),
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
    pub(crate) fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source }
    }

    /// True where the input is wrong (exit code 2), false where the machine could not (exit code 1). A file that is not
    /// there is wrong input.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Wrong(_) => true,
            Self::Io { source, .. } => source.kind() == std::io::ErrorKind::NotFound,
        }
    }
}

/// One mistake in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The file.
    pub file: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is there and what was expected.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

impl Mistake {
    /// A mistake at a byte of a text.
    #[must_use]
    pub fn at(file: &Path, text: &str, byte: usize, message: impl Into<String>, help: impl Into<String>) -> Self {
        let (line, column) = position(text, byte);
        Self { file: file.to_owned(), line, column, message: message.into(), help: help.into() }
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: {}", self.file.display(), self.line, self.column, self.message)?;
        if self.help.is_empty() { Ok(()) } else { write!(f, "\n  {}", self.help) }
    }
}

/// Line and column, both from 1, of a byte of `text`; the column counts characters.
fn position(text: &str, byte: usize) -> (usize, usize) {
    let byte = (0..=byte.min(text.len())).rev().find(|&b| text.is_char_boundary(b)).unwrap_or(0);
    let before = &text[..byte];
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

fn list(mistakes: &[Mistake]) -> String {
    mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_start_at_one() {
        assert_eq!(position("", 0), (1, 1));
        assert_eq!(position("ab\ncd", 4), (2, 2));
        assert_eq!(position("\u{e9}\u{e9}x", 4), (1, 3));
        assert_eq!(position("\u{e9}", 1), (1, 1), "inside a character: its start");
        assert_eq!(position("a\n", 99), (2, 1));
    }

    #[test]
    fn a_mistake_reads_as_file_line_column() {
        let mistake = Mistake::at(Path::new("s.toml"), "a\nbc", 3, "no", "do this");
        assert_eq!(mistake.to_string(), "s.toml:2:2: no\n  do this");
    }
}
