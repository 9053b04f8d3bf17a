//! What stands in scene text, before commands are run and names bound.

use super::document::Span;
use super::kind::Kind;

/// A primitive whose modifier is still a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draft {
    pub(super) modifier: String,
    pub(super) kind: Kind,
    pub(super) name: String,
    pub(super) strings: Vec<String>,
    pub(super) reals: Vec<f64>,
    pub(super) span: Span,
    pub(super) as_written: bool,
}

/// `modifier alias name target`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Alias {
    pub(super) modifier: String,
    pub(super) name: String,
    pub(super) target: String,
    pub(super) span: Span,
}

/// One entry of a scene text, or of a command's output.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Statement {
    Primitive(Draft),
    Alias(Alias),
    /// `!` and a command line; the span starts at the `!`.
    Command(Span),
    /// A modifier of this name stood here, but with errors: who uses it is not to blame.
    Broken(String),
}
