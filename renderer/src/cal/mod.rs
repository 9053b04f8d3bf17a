//! Radiance's function language: what `.cal` files and the expressions of scenes say, parsed, checked, evaluated.
//!
//! Sources: Radiance's reference manual ("Function Files") and icalc(1). A file holds definitions, `name = expression;` and
//! `name(a, b) = expression;`, with `:` in place of `=` for what never changes; `{..}` is a comment. Names are local to
//! their file unless another file has them ([`Functions::define_file`]). Values are real numbers; true is above 0;
//! functions take their arguments by need, so `if(a, b, c)` evaluates one of b and c only, and recursion can end.
//! Evaluation ends: after so many steps or so deep it is an error.

mod channels;
mod evaluate;
mod functions;
mod lexer;
mod library;
mod node;
mod noise;
mod parse;
mod shipped;
mod symbols;

#[cfg(test)]
mod tests;

pub use channels::CHANNELS;
pub use evaluate::{EvaluationError, Evaluator, Memory, Nowhere, Surroundings};
pub use functions::{Expression, Functions, Lambda};
pub use library::Dialect;
pub use parse::BadExpression;
pub use shipped::shipped;
