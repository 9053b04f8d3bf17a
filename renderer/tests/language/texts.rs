//! Texts in and out: the printer's round trip, and that no text whatever does harm.

use proptest::prelude::*;
use renderer::component::Component;
use renderer::crex::{Ast, Atom, Item, Repeat, Setting, compile, explain, parse, warnings};

use crate::trees::{Forms, Tree, sequence, text};

/// What was parsed, as the tests' own tree.
fn tree(items: &[Item]) -> Vec<Tree> {
    items
        .iter()
        .map(|item| {
            let atom = match item.atom() {
                Atom::Component(component) => Tree::Letter(*component),
                Atom::Group(group, members) => Tree::Group(group.brackets().0, tree(members)),
            };
            item.multipliers().iter().fold(atom, |tree, multiplier| match multiplier.repeat {
                Repeat::Times(k) => Tree::Times(k.get(), Box::new(tree)),
                Repeat::UntilEmpty => Tree::Star(Box::new(tree)),
            })
        })
        .collect()
}

/// The same text with white space put between some tokens.
fn spaced(text: &str, gaps: &[u8]) -> String {
    let mut gaps = gaps.iter().cycle();
    let mut spaced = String::new();
    let mut before = ' ';
    for character in text.chars() {
        if !(before.is_ascii_digit() && character.is_ascii_digit()) {
            spaced.push_str(["", "", " ", "\n", "\t "][usize::from(*gaps.next().unwrap_or(&0)) % 5]);
        }
        spaced.push(character);
        before = character;
    }
    spaced
}

fn print_and_parse(ast: &Ast) -> Ast {
    let printed = ast.to_string();
    let again = parse(&printed).unwrap_or_else(|errors| panic!("{printed}: {errors:?}"));
    assert_eq!(again.to_string(), printed, "what is printed is canonical");
    again
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_tree_is_read_as_it_was_written(items in sequence(4, 3, Forms::ALL), gaps in prop::collection::vec(any::<u8>(), 7)) {
        let written = spaced(&text(&items), &gaps);
        let ast = parse(&written).map_err(|errors| TestCaseError::fail(format!("{written}: {errors:?}")))?;
        prop_assert_eq!(tree(ast.items()), items);
        prop_assert_eq!(print_and_parse(&ast), ast);
    }

    #[test]
    fn no_text_does_harm(garbage in any::<String>()) {
        survive(&garbage);
    }

    #[test]
    fn no_text_of_the_languages_own_characters_does_harm(garbage in r"[DGSTRM()<>{}\[\]*0-9 dgx]{0,60}") {
        survive(&garbage);
    }
}

/// Puts a text through all that a user can do with one.
fn survive(given: &str) {
    match parse(given) {
        Ok(ast) => {
            assert_eq!(print_and_parse(&ast), ast);
            assert!(explain(&ast).ends_with('\n'));
            let _ = warnings(&ast, &Setting::default());
            compile(given).expect("parsed before");
        }
        Err(errors) => {
            assert!(!errors.is_empty());
            assert!(errors.is_sorted_by_key(|error| error.span.start));
            for error in errors {
                assert!(error.span.start < error.span.end && error.span.end <= given.len());
                assert!(!error.span.of(given).is_empty(), "the span stands on character boundaries");
                assert!(error.render(given).contains('^'));
                assert!(parse(&error.example()).is_ok());
            }
        }
    }
}

#[test]
fn white_space_separates_and_means_nothing_else() {
    let same = |one: &str, other: &str| assert_eq!(parse(one).expect(one), parse(other).expect(other));
    same("T2 3", "(T2)3".replace(['(', ')'], " ").trim());
    same(" T R\n{ S\tG }\u{a0}", "TR{SG}");
    same("T007", "T7");
    assert_ne!(parse("T2 3").expect("a crex"), parse("T23").expect("a crex"));
    assert_eq!(parse("T2 3 * 04").expect("a crex").to_string(), "T2 3*4");
}

#[test]
fn an_explanation_has_a_line_for_every_member() {
    let text = "(T{RS2})*[D<G>]M";
    let ast = parse(text).expect("a crex");
    let words = explain(&ast);
    for expected in ["importance 0.33", "importance 0.66", "2 times in a row", "whole or not at all", "mirrors"] {
        assert!(words.contains(expected), "no {expected:?} in\n{words}");
    }
    // Two lines on primary rays, ten letters and groups, one on what is left.
    assert_eq!(words.lines().count(), 2 + 10 + 1, "{words}");
    assert!(explain(&parse("").expect("empty")).contains("empty"));
    for component in Component::ALL {
        assert!(explain(&parse(&component.to_string()).expect("a letter")).contains("trace the"));
    }
}
