//! Crexes as the tests see them: trees of their own, made at random, and their texts.

use proptest::prelude::*;
use renderer::component::Component;

/// A crex's item, read from nothing but the grammar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Tree {
    Letter(Component),
    /// An opening bracket and the members.
    Group(char, Vec<Tree>),
    Times(u32, Box<Tree>),
    Star(Box<Tree>),
}

/// What closes a group.
pub(crate) fn closing(open: char) -> char {
    match open {
        '(' => ')',
        '<' => '>',
        '{' => '}',
        _ => ']',
    }
}

/// The text of a sequence, spaced so that numbers do not run together.
pub(crate) fn text(items: &[Tree]) -> String {
    items.iter().map(item_text).collect()
}

fn item_text(item: &Tree) -> String {
    match item {
        Tree::Letter(component) => component.letter().to_string(),
        Tree::Group(open, items) => format!("{open}{}{}", text(items), closing(*open)),
        Tree::Times(k, item) => format!("{} {k}", item_text(item)),
        Tree::Star(item) => format!("{}*", item_text(item)),
    }
}

/// Which forms may come up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Forms {
    pub(crate) stars: bool,
    pub(crate) braces: bool,
    pub(crate) brackets: bool,
}

impl Forms {
    pub(crate) const ALL: Self = Self { stars: true, braces: true, brackets: true };
    /// Forms whose executions are sets of words.
    pub(crate) const WORDS: Self = Self { stars: true, braces: false, brackets: false };
}

/// A sequence of up to `width` items nested up to `depth`, that keeps every rule of the language.
pub(crate) fn sequence(depth: u32, width: usize, forms: Forms) -> BoxedStrategy<Vec<Tree>> {
    prop::collection::vec(item(depth, width, forms), 1..=width).boxed()
}

fn item(depth: u32, width: usize, forms: Forms) -> BoxedStrategy<Tree> {
    let letter = (0..6usize).prop_map(|i| Tree::Letter(Component::ALL[i]));
    if depth == 0 {
        return letter.boxed();
    }
    let group = |open: char, forms| sequence(depth - 1, width, forms).prop_map(move |items| Tree::Group(open, items));
    let inside_braces = Forms { stars: false, braces: false, ..forms };
    let inside_brackets = Forms { stars: false, braces: false, ..forms };
    let mut atoms = vec![(4, letter.boxed()), (2, group('(', forms).boxed()), (2, group('<', forms).boxed())];
    if forms.braces {
        atoms.push((2, group('{', inside_braces).boxed()));
    }
    if forms.brackets {
        atoms.push((2, group('[', inside_brackets).boxed()));
    }
    let atom = prop::strategy::Union::new_weighted(atoms);
    let stars = forms.stars;
    (atom, 0..8u8, 1..4u32)
        .prop_map(move |(atom, multiplied, k)| match multiplied {
            0 | 1 => Tree::Times(k, Box::new(atom)),
            2 if stars => Tree::Star(Box::new(atom)),
            3 if stars => Tree::Star(Box::new(Tree::Times(k, Box::new(atom)))),
            _ => atom,
        })
        .boxed()
}
