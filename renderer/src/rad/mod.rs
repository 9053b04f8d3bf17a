//! Radiance scene text (`.rad`) and views (`.vf`), read without giving them a meaning.
//!
//! [`read`] turns texts into a [`Document`]: primitives in order, their modifiers bound, their aliases followed, with
//! the place of each kept for messages. What a type means is the scene builder's business. Sources: Radiance's reference
//! manual ("Scene Description") and the manual pages named where they apply.

mod arguments;
mod document;
mod error;
mod files;
mod kind;
mod lexer;
mod number;
mod parse;
mod resolve;
mod spelling;
mod statement;
mod view;
mod view_text;

#[cfg(test)]
mod tests;

pub use document::{Argument, Document, Primitive, SourceFile, Span};
pub use error::{Error, MAX_ERRORS};
pub use files::{DiskFiles, Files, Found, MemoryFiles};
pub use kind::{Class, Kind};
pub use spelling::nearest;
pub use view::{ViewKind, ViewSpec};
pub use view_text::BadOption;

use error::Problems;
use statement::Statement;

/// A scene text to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Its name for messages.
    pub name: String,
    /// The folder in which files that it names are looked for first.
    pub folder: String,
    /// Its text.
    pub bytes: Vec<u8>,
}

impl Source {
    /// A text that was made, not read from a file.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), folder: String::new(), bytes: text.into() }
    }
}

impl From<Found> for Source {
    fn from(found: Found) -> Self {
        Self { name: found.name, folder: found.folder, bytes: found.bytes }
    }
}

/// How to read.
#[derive(Clone, Debug, Default)]
pub struct Options {}

/// Reads several texts as one scene, in order.
///
/// # Errors
/// All problems that were found, at most [`MAX_ERRORS`].
pub fn read(files: &[Source], _resolver: &dyn Files, _options: &Options) -> Result<Document, Vec<Error>> {
    let mut problems = Problems::default();
    let mut sources: Vec<SourceFile> = Vec::new();
    let mut statements: Vec<Statement> = Vec::new();
    for file in files {
        let source = SourceFile { name: file.name.clone(), text: decode(&file.bytes), read_by: None };
        let Some(index) = u32::try_from(source.text.len()).ok().and_then(|_| u32::try_from(sources.len()).ok()) else {
            problems.add(Error::of_file(&file.name, "the file is too large"));
            continue;
        };
        statements.extend(parse::parse(index, &source, &mut problems));
        sources.push(source);
    }
    for statement in &statements {
        if let Statement::Command(span) = statement {
            problems.add(document::error_at(&sources, *span, "commands in scenes are not supported yet"));
        }
    }
    let document = resolve::resolve(sources, statements, &mut problems);
    if problems.is_empty() { Ok(document) } else { Err(problems.into_errors()) }
}

/// Text of a file: UTF-8, or else Latin-1 (each byte one character), so that nothing is lost.
fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}
