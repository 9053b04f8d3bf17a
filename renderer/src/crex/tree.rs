//! What `crex plan --json` prints: whether a crex is valid, its errors or its tree, its warnings.

use serde::Serialize;

use super::ast::{Ast, Atom, Item, Repeat};
use super::parse::parse;
use super::warning::{Setting, warnings};

/// The one JSON object of `crex plan --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanReport {
    /// The text as it was given.
    pub crex: String,
    /// Whether it is a crex.
    pub valid: bool,
    /// What is wrong with it.
    pub errors: Vec<PlanError>,
    /// What it says; none if it is not valid. The root is a sequence.
    pub tree: Option<Node>,
    /// What it does less than its writer may think.
    pub warnings: Vec<String>,
}

/// An error of a [`PlanReport`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlanError {
    /// What is wrong and what was expected.
    pub message: String,
    /// First byte of the offending part of the text.
    pub start: usize,
    /// One past its last byte.
    pub end: usize,
}

/// A node of a [`PlanReport`]'s tree.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Node {
    /// The whole crex.
    Sequence {
        /// Its items, in order.
        sequence: Vec<Node>,
    },
    /// A component.
    Component {
        /// Its letter.
        component: char,
    },
    /// A group.
    Group {
        /// Its brackets: `()`, `<>`, `{}` or `[]`.
        group: &'static str,
        /// Its members, in order.
        items: Vec<Node>,
    },
    /// A multiplied item.
    Repeat {
        /// How often.
        repeat: Count,
        /// What is repeated.
        item: Box<Node>,
    },
}

/// A multiplier in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum Count {
    /// `k`.
    Times(u32),
    /// `*`, as the text "*".
    UntilEmpty(char),
}

impl PlanReport {
    /// Parses `text` and reports on it.
    #[must_use]
    pub fn new(text: &str, setting: &Setting) -> Self {
        let mut report =
            Self { crex: text.to_owned(), valid: false, errors: Vec::new(), tree: None, warnings: Vec::new() };
        match parse(text) {
            Ok(ast) => {
                report.valid = true;
                report.tree = Some(Node::from(&ast));
                report.warnings = warnings(&ast, setting).into_iter().map(|warning| warning.message).collect();
            }
            Err(errors) => {
                report.errors = errors
                    .iter()
                    .map(|error| PlanError {
                        message: format!("{}; expected {}", error.message(), error.expected()),
                        start: error.span.start,
                        end: error.span.end,
                    })
                    .collect();
            }
        }
        report
    }
}

impl From<&Ast> for Node {
    fn from(ast: &Ast) -> Self {
        Self::Sequence { sequence: ast.items().iter().map(Self::from).collect() }
    }
}

/// Recurses as deep as groups nest, at most [`MAX_NESTING`](super::MAX_NESTING).
impl From<&Item> for Node {
    fn from(item: &Item) -> Self {
        let atom = match item.atom() {
            Atom::Component(component) => Self::Component { component: component.letter() },
            Atom::Group(group, items) => {
                Self::Group { group: group.name(), items: items.iter().map(Self::from).collect() }
            }
        };
        item.multipliers().iter().fold(atom, |item, multiplier| {
            let repeat = match multiplier.repeat {
                Repeat::Times(times) => Count::Times(times.get()),
                Repeat::UntilEmpty => Count::UntilEmpty('*'),
            };
            Self::Repeat { repeat, item: Box::new(item) }
        })
    }
}
