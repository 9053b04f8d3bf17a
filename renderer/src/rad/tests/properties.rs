//! What holds for any text: the reader ends, without panic; and it reads what was written, however it is laid out.

use proptest::prelude::*;

use super::super::{Kind, MemoryFiles, Options, Source, read};

/// A primitive to write down: its type, its name, its strings, its reals.
type Written = (Kind, String, Vec<String>, Vec<f64>);

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-zA-Z_.#!-][a-z0-9_.# ]{0,6}[a-z0-9]", "[ a-zäöü']{1,8}", "-?[0-9]{1,3}"]
        .prop_filter("words with a meaning", |name| name != "void" && name != "inherit")
}

fn primitive() -> impl Strategy<Value = Written> {
    let real = prop_oneof![
        -1e6..1e6,
        Just(0.0),
        Just(1e300),
        Just(5e-324),
        any::<f64>().prop_filter("finite", |v| v.is_finite())
    ];
    (name(), prop_oneof![Just(Kind::Plastic), Just(Kind::Colorfunc), Just(Kind::Sphere), Just(Kind::Antimatter)])
        .prop_flat_map(move |(name, kind)| {
            let (strings, reals) = match kind {
                Kind::Plastic => (0..=0, 5..=5),
                Kind::Sphere => (0..=0, 4..=4),
                Kind::Colorfunc => (4..=6, 0..=3),
                _ => (1..=3, 0..=0),
            };
            let strings = proptest::collection::vec(self::name(), strings);
            (Just(kind), Just(name), strings, proptest::collection::vec(real.clone(), reals))
        })
}

/// A word, quoted where it must be.
fn quoted(word: &str) -> String {
    match (word.contains([' ', '\'']), word.contains('"')) {
        (true, false) => format!("\"{word}\""),
        _ => word.to_owned(),
    }
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = read(&[Source::new("any", bytes)], &MemoryFiles::new(), &Options::default());
    }

    #[test]
    fn any_words_are_read_or_refused(
        words in proptest::collection::vec(
            prop_oneof![
                Just("void".to_owned()), Just("alias".to_owned()), Just("inherit".to_owned()), Just("polygon".to_owned()),
                Just("plastic".to_owned()), Just("a".to_owned()), Just("!xform -a 3 -t 1 0 0 self\n".to_owned()),
                Just("!genbox a b 1 1 1 | xform -s 2\n".to_owned()), Just("!genprism a b 3 0 0 1 0 0 1 -r .1".to_owned()),
                Just("\n".to_owned()), Just("#".to_owned()), Just("'".to_owned()), "[0-9]{1,2}", "[0-9.e+-]{1,5}", "-[a-z]{1,2}",
            ],
            0..60,
        )
    ) {
        let text = words.join(" ");
        let files = MemoryFiles::new().with("self", text.clone());
        if let Ok(document) = read(&[Source::new("any", text)], &files, &Options::default()) {
            for (index, primitive) in document.primitives.iter().enumerate() {
                prop_assert!(primitive.modifier.is_none_or(|modifier| modifier < index));
                prop_assert!(primitive.reals.iter().all(|value| value.is_finite()));
            }
        }
    }

    #[test]
    fn what_was_written_is_read(
        written in proptest::collection::vec(primitive(), 0..12),
        blank in prop_oneof![Just(" "), Just("\n"), Just("\t \r\n"), Just("  ")],
        comment in prop_oneof![Just("\n"), Just("\n# a comment 'with \" quotes\n"), Just("\n#\n\n")],
    ) {
        let mut text = String::new();
        for (kind, name, strings, reals) in &written {
            let mut words = vec!["void".to_owned(), kind.to_string(), quoted(name), strings.len().to_string()];
            words.extend(strings.iter().map(|word| quoted(word)));
            words.extend(["0".to_owned(), reals.len().to_string()]);
            words.extend(reals.iter().map(|value| format!("{value:e}")));
            text.push_str(&words.join(blank));
            text.push_str(comment);
        }
        let document = read(&[Source::new("written", text.clone())], &MemoryFiles::new(), &Options::default());
        let document = document.unwrap_or_else(|errors| panic!("{text}\n{}", errors[0]));
        let found: Vec<Written> = document
            .primitives
            .into_iter()
            .map(|primitive| (primitive.kind, primitive.name, primitive.strings, primitive.reals))
            .collect();
        prop_assert_eq!(found, written);
    }
}
