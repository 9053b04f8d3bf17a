//! A crex without `{ }` and `[ ]` is the set of the words that its execution can spell.

use std::collections::BTreeSet;

use proptest::prelude::*;
use renderer::component::Component;

use crate::scene::{Scene, run};
use crate::trees::{Forms, Tree, sequence, text};

/// All words of one to `length` letters.
fn all_words(length: usize) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut last = words.clone();
    for _ in 0..length {
        last = last
            .iter()
            .flat_map(|word| Component::ALL.map(|component| format!("{word}{}", component.letter())))
            .collect();
        words.extend(last.iter().cloned());
    }
    words.split_off(1)
}

/// How far one word gets by a crex, whatever the other words do: letters spelled, and whether the last one still
/// waits for a group to end before its successor may follow.
#[derive(Clone, Copy, PartialEq)]
struct Progress {
    spelled: usize,
    waiting: bool,
}

/// Spells `word` along a tree. A `*` is as many runs as the word could need: one that spells no letter is the last.
fn spell(items: &[Tree], word: &[char], holding: bool, mut progress: Progress) -> Progress {
    for item in items {
        progress = match item {
            Tree::Letter(component) => {
                let next = word.get(progress.spelled) == Some(&component.letter()) && !progress.waiting;
                Progress {
                    spelled: progress.spelled + usize::from(next),
                    waiting: progress.waiting || (next && holding),
                }
            }
            Tree::Group('(', members) => spell(members, word, holding, progress),
            Tree::Group(_, members) => {
                let inside = spell(members, word, true, progress);
                Progress { waiting: inside.waiting && holding, ..inside }
            }
            Tree::Times(k, item) => {
                (0..*k).fold(progress, |progress, _| spell(std::slice::from_ref(&**item), word, holding, progress))
            }
            Tree::Star(item) => (0..=word.len())
                .fold(progress, |progress, _| spell(std::slice::from_ref(&**item), word, holding, progress)),
        };
    }
    progress
}

fn spelled(items: &[Tree], length: usize) -> BTreeSet<String> {
    all_words(length)
        .into_iter()
        .filter(|word| {
            let letters: Vec<_> = word.chars().collect();
            spell(items, &letters, false, Progress { spelled: 0, waiting: false }).spelled == letters.len()
        })
        .collect()
}

/// The words traced; each must have been traced once.
fn traced(crex: &str, length: usize) -> BTreeSet<String> {
    let words = run(crex, &Scene::each(length)).words();
    assert!(words.values().all(|&times| times == 1), "{crex}: a word was traced twice");
    words.into_keys().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn what_runs_is_what_the_crex_can_spell(items in sequence(3, 4, Forms::WORDS)) {
        let crex = text(&items);
        prop_assert_eq!(traced(&crex, 3), spelled(&items, 3), "{}", crex);
    }
}

/// The words of up to five letters that satisfy `rule`.
fn words_of(rule: impl Fn(&str) -> bool) -> BTreeSet<String> {
    all_words(5).into_iter().filter(|word| rule(word)).collect()
}

/// Whether a word is in a set.
type Rule = Box<dyn Fn(&str) -> bool>;

fn only(letters: &str) -> impl Fn(&str) -> bool {
    move |word| word.chars().all(|letter| letters.contains(letter))
}

#[test]
fn known_crexes_spell_their_regular_sets() {
    let bounce_then_panes = |word: &str| only("T")(&word[1..]);
    let two_bounces = |word: &str| {
        let bounces = word.chars().filter(|&letter| letter != 'T').count();
        // Each pass gives a bounce, or none, and then panes: two bounces leave no panes before the first.
        bounces < 2 || (bounces == 2 && !word.starts_with('T'))
    };
    let cases: [(&str, Rule); 14] = [
        ("T*", Box::new(only("T"))),
        ("(TR)*", Box::new(only("TR"))),
        ("(TRSM)*", Box::new(only("TRSM"))),
        ("(TRSGMD)*", Box::new(|_| true)),
        ("(D*G*S*T*R*M*)*", Box::new(|_| true)),
        ("<MRSGD>T*", Box::new(bounce_then_panes)),
        ("(<MRSGD>T*)2", Box::new(two_bounces)),
        ("(<MRSGD>T*)*", Box::new(|_| true)),
        ("D", Box::new(|word| word == "D")),
        ("DD", Box::new(|word| word == "D" || word == "DD")),
        ("D2", Box::new(|word| word == "D" || word == "DD")),
        (
            "(SG)2",
            Box::new(|word| ["S", "G", "SG", "SS", "GS", "GG", "SGS", "SGG", "SSG", "GSG", "SGSG"].contains(&word)),
        ),
        ("<SG>2", Box::new(|word| word.len() <= 2 && only("SG")(word))),
        ("T*D", Box::new(|word| only("T")(word) || (word.ends_with('D') && only("T")(&word[..word.len() - 1])))),
    ];
    for (crex, rule) in cases {
        assert_eq!(traced(crex, 5), words_of(rule), "{crex}");
    }
}
