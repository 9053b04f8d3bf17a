//! What a crex says, as a tree: items of a component or a group, each with its multipliers.

use std::num::NonZeroU32;

use crate::component::Component;

/// Groups within each other, at most. A multiplier on a multiplied item counts as the group that it stands for:
/// `T2*` is `(T2)*`.
pub const MAX_NESTING: usize = 64;

/// Byte offsets into a crex text, end exclusive, both on character boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// From `start` up to, not with, `end`.
    #[must_use]
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The part of `text` that it covers.
    #[must_use]
    pub fn of(self, text: &str) -> &str {
        text.get(self.start..self.end).unwrap_or_default()
    }
}

/// The four groups of the paper's Table 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// `( )`: later members run what earlier ones spawned.
    Inherit,
    /// `< >`: what members spawn is held until the group ends.
    Hold,
    /// `{ }`: as `( )`, each member on the pixels whose importance reaches its threshold.
    Importance,
    /// `[ ]`: as `< >`, and under a time limit run whole or not at all.
    Timed,
}

impl Group {
    /// All four, in the order of Table 1.
    pub const ALL: [Self; 4] = [Self::Inherit, Self::Hold, Self::Importance, Self::Timed];

    /// The opening and the closing bracket.
    #[must_use]
    pub const fn brackets(self) -> (char, char) {
        match self {
            Self::Inherit => ('(', ')'),
            Self::Hold => ('<', '>'),
            Self::Importance => ('{', '}'),
            Self::Timed => ('[', ']'),
        }
    }

    /// Both brackets, as `crex plan --json` names the group.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Inherit => "()",
            Self::Hold => "<>",
            Self::Importance => "{}",
            Self::Timed => "[]",
        }
    }
}

/// A multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Repeat {
    /// `k`: this many times in a row.
    Times(NonZeroU32),
    /// `*`: until a whole run traces no ray.
    UntilEmpty,
}

/// A multiplier and where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Multiplier {
    /// What it asks for.
    pub repeat: Repeat,
    /// Where it stands in the text.
    pub span: Span,
}

/// A component's letter or a group.
#[derive(Clone, Debug, PartialEq)]
pub enum Atom {
    /// One letter.
    Component(Component),
    /// A group and its members, of which there is at least one.
    Group(Group, Vec<Item>),
}

/// An atom with its multipliers, the innermost first: `T2*` is `(T2)*`.
#[derive(Clone, Debug)]
pub struct Item {
    pub(super) atom: Atom,
    pub(super) atom_span: Span,
    pub(super) multipliers: Vec<Multiplier>,
}

impl Item {
    /// What is multiplied.
    #[must_use]
    pub fn atom(&self) -> &Atom {
        &self.atom
    }

    /// Where the letter, or the group with its brackets, stands; multipliers not counted.
    #[must_use]
    pub fn atom_span(&self) -> Span {
        self.atom_span
    }

    /// Its multipliers, the innermost first.
    #[must_use]
    pub fn multipliers(&self) -> &[Multiplier] {
        &self.multipliers
    }

    /// Where the whole item stands.
    #[must_use]
    pub fn span(&self) -> Span {
        Span::new(self.atom_span.start, self.multipliers.last().map_or(self.atom_span.end, |last| last.span.end))
    }
}

/// Items are equal when they say the same; where they stand in their texts is not compared.
impl PartialEq for Item {
    fn eq(&self, other: &Self) -> bool {
        let repeats = |item: &Self| item.multipliers.iter().map(|multiplier| multiplier.repeat).collect::<Vec<_>>();
        self.atom == other.atom && repeats(self) == repeats(other)
    }
}

/// A crex that keeps every rule of the language. Only [`parse`](super::parse) makes one.
#[derive(Clone, Debug)]
pub struct Ast {
    pub(super) text: String,
    pub(super) items: Vec<Item>,
}

impl Ast {
    /// The text that it was parsed from, to which all spans refer.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What runs after the primary rays, in order; nothing for the empty crex.
    #[must_use]
    pub fn items(&self) -> &[Item] {
        &self.items
    }
}

/// Crexes are equal when they say the same; white space, leading zeros and spans are not compared.
impl PartialEq for Ast {
    fn eq(&self, other: &Self) -> bool {
        self.items == other.items
    }
}
