//! Where in the study file a value is written.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A step from a value to a part of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Step {
    Key(&'static str),
    Name(String),
    Index(usize),
}

/// The byte where the value at `path` starts in `text`; if it is not written there, where the last part of the path that
/// is written starts.
pub(super) fn byte_of(text: &str, path: &[Step]) -> usize {
    let Ok(root) = DeTable::parse(text) else { return 0 };
    let mut at: Range<usize> = 0..0;
    let mut table = Some(root.get_ref());
    let mut array: Option<&[Spanned<DeValue<'_>>]> = None;
    for step in path {
        let next = match step {
            Step::Key(key) => table.and_then(|table| table.get(*key)),
            Step::Name(key) => table.and_then(|table| table.get(key.as_str())),
            Step::Index(i) => array.and_then(|array| array.get(*i)),
        };
        let Some(value) = next else { break };
        at = value.span();
        table = None;
        array = None;
        match value.get_ref() {
            DeValue::Table(inner) => table = Some(inner),
            DeValue::Array(inner) => array = Some(inner),
            _ => {}
        }
    }
    at.start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_through_tables_and_arrays() {
        let text = "a = 1\n[[b]]\nc = [1, 2]\n[[b]]\nc = [3, 44]\n";
        let at = |path: &[Step]| byte_of(text, path);
        assert_eq!(&text[at(&[Step::Key("a")])..][..1], "1");
        let deep = [Step::Key("b"), Step::Index(1), Step::Key("c"), Step::Index(1)];
        assert_eq!(&text[at(&deep)..][..2], "44");
        let absent = [Step::Key("b"), Step::Index(1), Step::Name("zzz".into())];
        assert_eq!(text[..at(&absent)].matches('\n').count(), 3, "the second [[b]] is on the fourth line");
        assert_eq!(at(&[Step::Key("zzz")]), 0);
    }
}
