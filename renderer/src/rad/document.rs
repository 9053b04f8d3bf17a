//! What scene text says, before it means anything: primitives in order, with names bound and places kept.

use std::collections::HashMap;

use super::kind::Kind;
use super::lexer::Lexer;
use crate::diagnostic::Error;

/// A stretch of a source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// Index into [`Document::sources`].
    pub source: u32,
    /// Byte offset of the first character.
    pub start: u32,
    /// Byte offset after the last.
    pub end: u32,
}

/// A text that was read: a scene file, or a file that one of its commands reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// The file as the user knows it.
    pub name: String,
    /// Its text. A file that is not UTF-8 is taken as Latin-1, so nothing is lost.
    pub text: String,
    /// The command that first read it; `None` for a file that was asked for.
    pub read_by: Option<Span>,
}

/// One surface, material, pattern, texture or mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// Index in [`Document::primitives`] of the modifier, always earlier than this one; `None` is `void`.
    pub modifier: Option<usize>,
    /// Its type.
    pub kind: Kind,
    /// Its name, without quotes. Names need not be unique.
    pub name: String,
    /// String arguments. Those that name a modifier are looked up with [`Document::modifier_named`].
    pub strings: Vec<String>,
    /// Real arguments, all finite.
    pub reals: Vec<f64>,
    /// Its text, from its modifier to its last argument; of a primitive that a command made, the command.
    pub span: Span,
    /// Whether the arguments stand in the text as they are here (they do not after a transform or out of a generator).
    pub as_written: bool,
}

/// A part of a primitive's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// The modifier's name.
    Modifier,
    /// The type keyword.
    Kind,
    /// The primitive's own name.
    Name,
    /// A string argument, from 0.
    String(usize),
    /// A real argument, from 0.
    Real(usize),
}

/// Scene text, read: every command run, every alias followed.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// The texts that were read.
    pub sources: Vec<SourceFile>,
    /// The primitives in the order of their definition. An alias with a modifier of its own stands here as a copy of
    /// what it names, under its new name and modifier.
    pub primitives: Vec<Primitive>,
    /// Remarks on what is legal but probably not meant.
    pub warnings: Vec<Error>,
    /// The folders in which files that arguments name are looked for first, in order.
    pub folders: Vec<String>,
    names: Names,
}

/// What each modifier name means from which primitive on.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    /// By name: (number of primitives that came before the definition's end, the modifier), ascending.
    meanings: HashMap<String, Vec<(usize, usize)>>,
}

impl Names {
    /// From the primitive with index `from` on, `name` means the primitive `index`.
    pub(super) fn define(&mut self, name: &str, from: usize, index: usize) {
        match self.meanings.get_mut(name) {
            Some(meanings) => meanings.push((from, index)),
            None => {
                self.meanings.insert(name.to_owned(), vec![(from, index)]);
            }
        }
    }

    /// What `name` means to the primitive with index `user`.
    pub(super) fn meaning(&self, name: &str, user: usize) -> Option<usize> {
        let meanings = self.meanings.get(name)?;
        let later = meanings.partition_point(|&(from, _)| from <= user);
        Some(meanings[later.checked_sub(1)?].1)
    }

    /// All names.
    pub(super) fn all(&self) -> impl Iterator<Item = &str> {
        self.meanings.keys().map(String::as_str)
    }
}

impl Document {
    pub(super) fn new(sources: Vec<SourceFile>, primitives: Vec<Primitive>, names: Names) -> Self {
        Self { sources, primitives, warnings: Vec::new(), folders: Vec::new(), names }
    }

    /// The modifier that `name` means to the primitive with index `user`: the latest definition before it. `void` is
    /// no definition: callers ask for it first.
    #[must_use]
    pub fn modifier_named(&self, name: &str, user: usize) -> Option<usize> {
        self.names.meaning(name, user)
    }

    /// An error at a place, ready to be shown.
    #[must_use]
    pub fn error(&self, span: Span, message: impl Into<String>) -> Error {
        error_at(&self.sources, span, message)
    }

    /// An error at one argument of a primitive.
    #[must_use]
    pub fn argument_error(&self, primitive: &Primitive, argument: Argument, message: impl Into<String>) -> Error {
        self.error(self.argument_span(primitive, argument), message)
    }

    /// Where an argument stands; the whole primitive (or the command that made it) where it does not stand in the
    /// text.
    #[must_use]
    pub fn argument_span(&self, primitive: &Primitive, argument: Argument) -> Span {
        let whole = primitive.span;
        let text = self.sources.get(whole.source as usize).map(|source| source.text.as_str());
        if !primitive.as_written {
            return whole;
        }
        text.and_then(|text| find_argument(text, whole, primitive.strings.len(), argument)).unwrap_or(whole)
    }
}

/// An error at a place in one of `sources`.
pub(super) fn error_at(sources: &[SourceFile], span: Span, message: impl Into<String>) -> Error {
    let Some(source) = sources.get(span.source as usize) else { return Error::of_file("", message) };
    // A compiled file has no text to show.
    if source.text.is_empty() {
        return Error::of_file(&source.name, message);
    }
    let mut error = Error::in_text(&source.name, &source.text, span.start as usize, span.end as usize, message);
    let mut reader = source.read_by;
    // A file is read by files that were read before it, so this ends.
    while let Some((by, file)) = reader.and_then(|by| Some((by, sources.get(by.source as usize)?))) {
        let (line, column, _) = crate::diagnostic::locate(&file.text, by.start as usize);
        error.notes.push(format!("read by {}:{line}:{column}", file.name));
        reader = file.read_by;
    }
    error
}

/// Cuts a primitive's text again up to the argument: cheaper than to keep a place for every number of a scene.
fn find_argument(text: &str, whole: Span, strings: usize, argument: Argument) -> Option<Span> {
    let skipped = match argument {
        Argument::Modifier => 0,
        Argument::Kind => 1,
        Argument::Name => 2,
        Argument::String(index) => 4 + index,
        // After the strings come the integers' count, which is 0, and the reals' count.
        Argument::Real(index) => 4 + strings + 2 + index,
    };
    let mut lexer = Lexer::new(text.get(..whole.end as usize)?, whole.start as usize);
    for _ in 0..skipped {
        lexer.word()?;
    }
    let word = lexer.word()?;
    Some(Span { source: whole.source, start: u32::try_from(word.start).ok()?, end: u32::try_from(word.end).ok()? })
}
