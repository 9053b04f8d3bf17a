//! The canonical text of a crex: no white space but between two numbers, no leading zeros.

use std::fmt::{self, Write as _};

use super::ast::{Ast, Atom, Item, Repeat};

impl fmt::Display for Ast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.items.iter().try_for_each(|item| item.fmt(f))
    }
}

/// Recurses as deep as groups nest, at most [`MAX_NESTING`](super::MAX_NESTING).
impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.atom {
            Atom::Component(component) => component.fmt(f)?,
            Atom::Group(group, items) => {
                let (open, close) = group.brackets();
                f.write_char(open)?;
                items.iter().try_for_each(|item| item.fmt(f))?;
                f.write_char(close)?;
            }
        }
        let mut after_number = false;
        for multiplier in &self.multipliers {
            if after_number && multiplier.repeat != Repeat::UntilEmpty {
                f.write_char(' ')?;
            }
            multiplier.repeat.fmt(f)?;
            after_number = multiplier.repeat != Repeat::UntilEmpty;
        }
        Ok(())
    }
}

impl fmt::Display for Repeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Times(times) => times.fmt(f),
            Self::UntilEmpty => f.write_char('*'),
        }
    }
}
