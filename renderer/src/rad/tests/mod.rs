//! The reader as a whole, on texts of its own.

mod commands;
mod compiled;
mod properties;
mod real_programs;

use super::{Argument, Document, Error, Kind, MemoryFiles, Options, Source, read};

fn read_text(text: &str) -> Result<Document, Vec<Error>> {
    read(&[Source::new("scene.rad", text)], &MemoryFiles::new(), &Options::default())
}

fn errors(text: &str) -> Vec<Error> {
    read_text(text).unwrap_err()
}

#[test]
fn a_small_scene() {
    let document = read_text(
        "# a comment\n\nvoid plastic red 0 0 5 .7 .1 .1 0 0\n\nred sphere \"my ball\"\n0\n0\n4 1 2 3 .5\n# the end",
    )
    .unwrap();
    let [red, ball] = &document.primitives[..] else { panic!("{:?}", document.primitives) };
    assert_eq!((red.kind, red.name.as_str(), red.modifier), (Kind::Plastic, "red", None));
    assert_eq!(red.reals, [0.7, 0.1, 0.1, 0.0, 0.0]);
    assert_eq!((ball.kind, ball.name.as_str(), ball.modifier), (Kind::Sphere, "my ball", Some(0)));
    let span = document.argument_span(ball, Argument::Real(3));
    assert_eq!(&document.sources[0].text[span.start as usize..span.end as usize], ".5");
}

#[test]
fn a_comment_starts_only_where_a_primitive_may() {
    let document = read_text(
        "void colorfunc c 4 a#b #x # . 0 0 # here one may start\nvoid plastic p 0 0 5 1 1 1 0 0 # and here\n#",
    )
    .unwrap();
    assert_eq!(document.primitives[0].strings, ["a#b", "#x", "#", "."]);
}

#[test]
fn names_bind_to_the_latest_earlier_definition() {
    let document = read_text(
        "void plastic m 0 0 5 1 0 0 0 0\nm sphere a 0 0 4 0 0 0 1\nvoid metal m 0 0 5 1 0 0 0 0\n\
         m sphere b 0 0 4 0 0 0 1\nvoid mixfunc x 4 m void .5 . 0 0\n",
    )
    .unwrap();
    assert_eq!(document.primitives[1].modifier, Some(0));
    assert_eq!(document.primitives[3].modifier, Some(2));
    assert_eq!(document.modifier_named("m", 1), Some(0));
    assert_eq!(document.modifier_named("m", 4), Some(2));
    assert_eq!(document.modifier_named("x", 4), None);
    assert_eq!(document.modifier_named("x", 5), Some(4));
}

#[test]
fn a_surface_does_not_hide_a_modifier_of_its_name() {
    let document =
        read_text("void plastic m 0 0 5 1 0 0 0 0\nm sphere m 0 0 4 0 0 0 1\nm sphere b 0 0 4 0 0 0 1\n").unwrap();
    assert_eq!(document.primitives[2].modifier, Some(0));
}

#[test]
fn aliases() {
    let text = "void brightfunc dirt 2 .5 . 0 0\ndirt plastic red 0 0 5 1 0 0 0 0\n\
                inherit alias same red\ndirt alias again red\nvoid alias clean red\n\
                same sphere a 0 0 4 0 0 0 1\nagain sphere b 0 0 4 0 0 0 1\nclean sphere c 0 0 4 0 0 0 1\n\
                dirt alias dirty clean\ndirty sphere d 0 0 4 0 0 0 1\n";
    let document = read_text(text).unwrap();
    let named = |name: &str| document.primitives.iter().find(|p| p.name == name).unwrap();
    let material = |name: &str| &document.primitives[named(name).modifier.unwrap()];
    assert_eq!((material("a").name.as_str(), material("a").modifier), ("red", Some(0)));
    assert_eq!(material("b").name, "red");
    assert_eq!((material("c").name.as_str(), material("c").modifier), ("clean", None));
    assert_eq!(material("c").reals, material("a").reals);
    assert_eq!((material("d").name.as_str(), material("d").modifier), ("dirty", Some(0)));
}

#[test]
fn an_alias_binds_when_it_is_made() {
    let document = read_text(
        "void plastic m 0 0 5 1 0 0 0 0\ninherit alias n m\nvoid plastic m 0 0 5 0 1 0 0 0\nn sphere s 0 0 4 0 0 0 1\n",
    )
    .unwrap();
    assert_eq!(document.primitives[2].modifier, Some(0));
}

#[test]
fn an_alias_of_itself_names_the_definition_before() {
    let text = "void plastic m 0 0 5 1 0 0 0 0\nvoid brightfunc f 2 1 . 0 0\nf alias m m\nm sphere s 0 0 4 0 0 0 1\n";
    let document = read_text(text).unwrap();
    assert_eq!((document.primitives[3].modifier, document.primitives[2].modifier), (Some(2), Some(1)));
    // A name that nothing defines cannot loop: it is undefined where it is first used.
    assert!(errors("void alias a b\nvoid alias b a\n")[0].message.contains("undefined modifier `b`"));
}

#[test]
fn an_error_on_line_7_is_reported_there() {
    let text = "# 1\nvoid plastic red\n0\n0\n5 1 0 0 0 0\n\nred sphere s 0 0 4 0 zero 0 1\n";
    let errors = errors(text);
    assert_eq!(errors.len(), 1);
    assert_eq!((errors[0].line, errors[0].column), (7, 22));
    assert!(errors[0].to_string().starts_with("scene.rad:7:22: `zero` is not a number"), "{}", errors[0]);
}

#[test]
fn crlf_counts_lines_alike() {
    let text = "void plastic red\r\n0\r\n0\r\n5 1 0 0 0 0\r\n\r\n\r\nred sphear s 0 0 4 0 0 0 1\r\n";
    let errors = errors(text);
    assert_eq!((errors[0].line, errors[0].column), (7, 5));
    assert!(errors[0].message.contains("did you mean `sphere`?"), "{}", errors[0]);
    assert_eq!(errors[0].text, "red sphear s 0 0 4 0 0 0 1");
}

#[test]
fn messages_name_what_is_wanted() {
    for (text, line, column, words) in [
        ("void plastic", 1, 13, "ends where a name should stand"),
        ("void plastic p 0 0 4 1 1 1 0\n", 1, 14, "expected 5 (red green blue, specularity, roughness)"),
        ("void plastic p 0 0 5 1 1 1 0\n\n", 1, 29, "ends where real argument 5 of the 5"),
        ("void plastic p 0 0 5 1 1 1 0\nvoid plastic q 0 0 5 1 1 1 0 0", 2, 1, "`void` is not a number"),
        ("void plastic p 0 0 5 1 1 nan 0 0", 1, 26, "`nan` is not a number"),
        ("void plastic p 0 0 5 1 1 1e400 0 0", 1, 26, "beyond the range"),
        ("void plastic p 0 1 5 1 1 1 0 0", 1, 18, "no type takes integer arguments"),
        ("void plastic p -1 0 5 1 1 1 0 0", 1, 16, "expected the number of string arguments"),
        ("void plastic p 0 0 99999999999 1 1", 1, 20, "too short for them"),
        ("void plastic p 99999999999999999999999999 0 0", 1, 16, "too short for them"),
        ("void plastic p 0 0 5 1 1 1 0 0 0 1", 1, 32, "more arguments than its counts say"),
        ("rde sphere s 0 0 4 0 0 0 1", 1, 1, "undefined modifier `rde`"),
        ("inherit sphere s 0 0 4 0 0 0 1", 1, 1, "only an alias can inherit"),
        ("void plastic void 0 0 5 1 1 1 0 0", 1, 14, "cannot be named `void`"),
        ("void plastic 'p 0 0 5 1 1 1 0 0", 1, 14, "quote is not closed"),
        ("void mixfunc m 3 a b c 0 0", 1, 14, "expected at least 4"),
    ] {
        let errors = errors(text);
        let first = &errors[0];
        assert!(first.message.contains(words), "{text}: {first}");
        assert_eq!((first.line, first.column), (line, column), "{text}: {first}");
    }
}

#[test]
fn several_errors_are_collected_up_to_a_limit() {
    let text =
        "void plastic a 0 0 5 1 1 x 0 0\nvoid plastik b 0 0 0\na sphere c 0 0 4 0 0 0 1\nd sphere e 0 0 4 0 0 0 1\n";
    let found: Vec<usize> = errors(text).iter().map(|error| error.line).collect();
    assert_eq!(found, [1, 2, 4]);
    let many: String = (0..1000).map(|i| format!("void plastic p{i} 0 0 1 1\n")).collect();
    assert_eq!(errors(&many).len(), super::MAX_ERRORS);
}

#[test]
fn latin_1_is_kept() {
    let bytes = b"void plastic gr\xfcn 0 0 5 1 1 1 0 0\ngr\xfcn sphere s 0 0 4 0 0 0 1".to_vec();
    let document = read(&[Source::new("a", bytes)], &MemoryFiles::new(), &Options::default()).unwrap();
    assert_eq!(document.primitives[0].name, "grün");
    assert_eq!(document.primitives[1].modifier, Some(0));
}

#[test]
fn several_files_are_one_scene() {
    let files =
        [Source::new("m.rad", "void plastic m 0 0 5 1 1 1 0 0"), Source::new("s.rad", "m sphere s 0 0 4 0 0 0 1 x")];
    let errors = read(&files, &MemoryFiles::new(), &Options::default()).unwrap_err();
    assert_eq!(errors[0].file, "s.rad");
    let document = read(&files[..1], &MemoryFiles::new(), &Options::default()).unwrap();
    assert_eq!(document.primitives.len(), 1);
}
