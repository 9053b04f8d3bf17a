//! Takes a generator's words one by one.

use super::super::command::Word;
use super::super::number::{integer, real};
use super::super::xform::BadWords;

/// What is left of a command's words.
pub(super) struct Arguments<'a> {
    words: &'a [Word],
    next: usize,
}

impl<'a> Arguments<'a> {
    pub(super) fn new(words: &'a [Word]) -> Self {
        Self { words, next: 0 }
    }

    /// The next word, if any is left.
    pub(super) fn next(&mut self) -> Option<&'a Word> {
        let word = self.words.get(self.next)?;
        self.next += 1;
        Some(word)
    }

    /// How many words are left.
    pub(super) fn left(&self) -> usize {
        self.words.len() - self.next
    }

    /// The word taken last.
    pub(super) fn last(&self) -> Option<&'a Word> {
        self.words.get(self.next.checked_sub(1)?)
    }

    pub(super) fn word(&mut self, wanted: &str) -> Result<&'a Word, BadWords> {
        self.next().ok_or_else(|| BadWords::at(None, format!("ends where {wanted} should stand")))
    }

    pub(super) fn real(&mut self, wanted: &str) -> Result<f64, BadWords> {
        let word = self.word(wanted)?;
        real(&word.text).map_err(|_| BadWords::at(Some(word), format!("expected {wanted}, found `{}`", word.text)))
    }

    /// A real above 0.
    pub(super) fn positive(&mut self, wanted: &str) -> Result<f64, BadWords> {
        let value = self.real(wanted)?;
        if value > 0.0 { Ok(value) } else { Err(BadWords::at(self.last(), format!("{wanted} must be above 0"))) }
    }

    /// An integer in a range.
    pub(super) fn count(&mut self, wanted: &str, least: usize, most: usize) -> Result<usize, BadWords> {
        let word = self.word(wanted)?;
        let count = integer(&word.text).ok().and_then(|count| usize::try_from(count).ok());
        count.filter(|count| (least..=most).contains(count)).ok_or_else(|| {
            let message = format!("expected {wanted}, an integer from {least} to {most}, found `{}`", word.text);
            BadWords::at(Some(word), message)
        })
    }

    /// The error for an option that the program does not know.
    pub(super) fn unknown(&self, known: &str) -> BadWords {
        let word = self.last();
        let text = word.map_or("", |word| word.text.as_str());
        BadWords::at(word, format!("unknown option `{text}`: expected {known}"))
    }
}
