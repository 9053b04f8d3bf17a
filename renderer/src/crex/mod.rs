//! The component regular expression: the paper's Tables 1 and 2 read, checked, explained and walked.
//!
//! [`parse`] gives an [`Ast`] that keeps every rule, or all the errors found, each with the span to underline;
//! [`Program`] is the same lowered to a few instructions, and a [`Cursor`] walks it, asking after each run how many rays
//! it traced. Nothing here knows rays, scenes or time.

mod ast;
mod cursor;
mod error;
mod explain;
mod lex;
mod parse;
mod print;
mod program;
mod tree;
mod warning;

pub use ast::{Ast, Atom, Group, Item, MAX_NESTING, Multiplier, Repeat, Span};
pub use cursor::{Cursor, Task};
pub use error::{Error, ErrorKind};
pub use explain::explain;
pub use parse::{MAX_ERRORS, parse};
pub use program::{Holding, Program, STAR_LIMIT, ThresholdError};
pub use tree::{PlanError, PlanReport};
pub use warning::{Setting, Warning, warnings};

/// Parses a crex and lowers it to a [`Program`], ready to be walked.
///
/// # Errors
/// All errors found, as [`parse`] gives them.
pub fn compile(text: &str) -> Result<Program, Vec<Error>> {
    parse(text).map(|ast| Program::new(&ast))
}
