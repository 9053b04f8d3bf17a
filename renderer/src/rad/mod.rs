//! Radiance scene text (`.rad`) and views (`.vf`), read without giving them a meaning.
//!
//! [`read`] turns texts into a [`Document`]: primitives in order, their modifiers bound, their aliases followed, with
//! the place of each kept for messages. What a type means is the scene builder's business. Sources: Radiance's reference
//! manual ("Scene Description") and the manual pages named where they apply.

mod arguments;
mod binary;
mod command;
mod document;
mod expand;
mod files;
mod generate;
mod kind;
mod lexer;
mod mesh;
mod number;
mod obj;
mod octree;
mod options;
mod parse;
mod place;
mod resolve;
mod rif;
mod spelling;
mod statement;
mod transform;
mod view;
mod view_text;
mod xform;

#[cfg(test)]
mod tests;

pub use crate::diagnostic::{Error, MAX_ERRORS};
pub use document::{Argument, Document, Primitive, SourceFile, Span};
pub use files::{DiskFiles, Files, Found, MemoryFiles};
pub use kind::{Class, Kind};
pub use mesh::{Mesh, MeshTriangle, MeshVertex, read_mesh};
pub use obj::{Obj, ObjFace, read_obj};
pub use octree::read_octree;
pub use options::{Commands, Limits, Options};
pub use rif::{Rif, RifView};
pub use spelling::nearest;
pub use transform::{BadTransform, Transform};
pub use view::{ViewKind, ViewSpec};
pub use view_text::BadOption;

use expand::Loader;
use resolve::Resolver;

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

/// Reads several texts as one scene, in order; `files` finds what their commands name.
///
/// # Errors
/// All problems that were found, at most [`MAX_ERRORS`].
pub fn read(texts: &[Source], files: &dyn Files, options: &Options<'_>) -> Result<Document, Vec<Error>> {
    let mut loader = Loader::new(files, options);
    let nodes: Vec<_> = texts.iter().filter_map(|text| loader.text(text)).collect();
    loader.admit(&nodes);
    let Loader { sources, mut problems, warnings, incomplete, .. } = loader;
    // Names that a failed command would have defined are not the fault of those who use them.
    if incomplete || problems.full() {
        return Err(problems.into_errors());
    }
    let mut resolver = Resolver::new(sources);
    let mut lost = Vec::new();
    for node in &nodes {
        let note_lost = &mut |span, name: &str| {
            if lost.len() < MAX_ERRORS {
                lost.push((span, format!("the transform carries `{name}` beyond the range of numbers")));
            }
        };
        expand::emit(node, &mut |statement| resolver.statement(statement), note_lost);
    }
    let mut document = resolver.finish(&mut problems);
    for (span, message) in lost {
        problems.add(document.error(span, message));
    }
    document.warnings = warnings;
    for text in texts {
        if !document.folders.contains(&text.folder) {
            document.folders.push(text.folder.clone());
        }
    }
    if problems.is_empty() { Ok(document) } else { Err(problems.into_errors()) }
}

/// Text of a file: UTF-8, or else Latin-1 (each byte one character), so that nothing is lost.
fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}
