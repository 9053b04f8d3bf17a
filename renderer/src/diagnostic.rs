//! What is wrong with a text, said so that it can be found: `file:line:column: message`, the line, a caret.

use std::fmt;

/// Collected problems are cut off after this many: beyond it a reader fixes the first ones and tries again.
pub const MAX_ERRORS: usize = 20;

/// How much of a long line is shown around the column, characters.
const EXCERPT: usize = 100;

/// One problem in a scene, a view or a function file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The file as the user knows it.
    pub file: String,
    /// Line, from 1; 0 if the problem is of the file as a whole.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What was found, what was expected, what to do.
    pub message: String,
    /// The source line, without its end.
    pub text: String,
    /// How many characters from `column` on are meant, at least 1.
    pub width: usize,
    /// Where the file was read from, innermost first: "read by ...".
    pub notes: Vec<String>,
}

impl Error {
    /// A problem of a file as a whole (it cannot be read, say).
    #[must_use]
    pub fn of_file(file: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            line: 0,
            column: 0,
            message: message.into(),
            text: String::new(),
            width: 0,
            notes: Vec::new(),
        }
    }

    /// A problem at bytes `start..end` of a text. Offsets past the end mean the end.
    #[must_use]
    pub fn in_text(file: &str, text: &str, start: usize, end: usize, message: impl Into<String>) -> Self {
        let (line, column, source) = locate(text, start);
        let width = text
            .get(floor(text, start)..floor(text, end.max(start)))
            .map_or(1, |meant| meant.lines().next().map_or(1, |first| first.chars().count()));
        Self {
            file: file.to_owned(),
            line,
            column,
            message: message.into(),
            text: source.to_owned(),
            width: width.max(1),
            notes: Vec::new(),
        }
    }
}

/// Line and column (both from 1; the column counts characters) of a byte offset, and the line's text.
pub(crate) fn locate(text: &str, offset: usize) -> (usize, usize, &str) {
    let offset = floor(text, offset);
    let start = text[..offset].rfind('\n').map_or(0, |newline| newline + 1);
    let line = 1 + text[..start].bytes().filter(|&byte| byte == b'\n').count();
    let column = 1 + text[start..offset].chars().count();
    let source = text[start..].split('\n').next().unwrap_or_default();
    (line, column, source.trim_end_matches('\r'))
}

/// The nearest character boundary at or before a byte offset.
fn floor(text: &str, offset: usize) -> usize {
    (0..=offset.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.message)?;
        } else {
            writeln!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.message)?;
            // A generated file can be one line of megabytes: show the part around the column only.
            let skip = (self.column - 1).saturating_sub(EXCERPT / 2);
            let (before, after) = (
                if skip > 0 { "..." } else { "" },
                if self.text.chars().count() > skip + EXCERPT { "..." } else { "" },
            );
            let shown: String = self.text.chars().skip(skip).take(EXCERPT).map(printable).collect();
            writeln!(f, "    {before}{shown}{after}")?;
            let indent: String = self.text.chars().skip(skip).take(self.column - 1 - skip).map(as_blank).collect();
            let carets = "^".repeat(self.width.clamp(1, EXCERPT));
            write!(f, "    {}{indent}{carets}", as_blanks(before))?;
        }
        for note in &self.notes {
            write!(f, "\n    {note}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// Control characters would move a terminal's cursor.
fn printable(letter: char) -> char {
    if letter.is_control() && letter != '\t' { '\u{fffd}' } else { letter }
}

/// A tab stays a tab, so that the caret stands under the column on every terminal.
fn as_blank(letter: char) -> char {
    if letter == '\t' { '\t' } else { ' ' }
}

fn as_blanks(text: &str) -> String {
    text.chars().map(as_blank).collect()
}

/// Collects problems up to [`MAX_ERRORS`].
#[derive(Debug, Default)]
pub(crate) struct Problems {
    errors: Vec<Error>,
    closed: bool,
}

impl Problems {
    /// Adds one, unless there are enough or it repeats one (a file may be read by several commands).
    pub(crate) fn add(&mut self, error: Error) {
        if !self.full() && !self.errors.contains(&error) {
            self.errors.push(error);
        }
    }

    /// Whether looking for more is pointless.
    pub(crate) fn full(&self) -> bool {
        self.closed || self.errors.len() >= MAX_ERRORS
    }

    /// Takes no more: the last one makes looking for others pointless.
    pub(crate) fn close(&mut self) {
        self.closed = true;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// The problems in the order in which they were found.
    pub(crate) fn into_errors(self) -> Vec<Error> {
        self.errors
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_stands_under_the_column() {
        let text = "void plastic red\n\t0 0 x 1 1 0 0\n";
        let at = text.find('x').unwrap();
        let error = Error::in_text("a.rad", text, at, at + 1, "expected a number");
        assert_eq!((error.line, error.column, error.width), (2, 6, 1));
        assert_eq!(error.to_string(), "a.rad:2:6: expected a number\n    \t0 0 x 1 1 0 0\n    \t    ^");
    }

    #[test]
    fn columns_count_characters() {
        let text = "größe ist\n";
        let error = Error::in_text("a.rad", text, text.find("ist").unwrap(), text.len() - 1, "no");
        assert_eq!((error.line, error.column, error.width), (1, 7, 3));
    }

    #[test]
    fn a_long_line_is_cut_around_the_column() {
        let text = format!("{}here{}", "1 ".repeat(5000), " 2".repeat(5000));
        let at = text.find("here").unwrap();
        let shown = Error::in_text("a", &text, at, at + 4, "m").to_string();
        let lines: Vec<&str> = shown.lines().collect();
        assert!(lines.iter().all(|line| line.chars().count() < 130));
        assert_eq!(lines[1].find("here"), lines[2].find("^^^^"));
    }

    #[test]
    fn offsets_past_the_end_are_the_end() {
        let error = Error::in_text("a", "ab", 99, 120, "m");
        assert_eq!((error.line, error.column, error.width), (1, 3, 1));
    }
}
