//! Commands in scenes: what is refused, where errors are told, what ends.

use std::cell::RefCell;

use super::super::{Commands, Document, Error, Kind, Limits, MemoryFiles, Options, Source, read};

const BALL: &str = "void plastic m 0 0 5 1 1 1 0 0\nm sphere s 0 0 4 0 0 0 1\n";

fn with_files(text: &str, files: &[(&str, &str)]) -> Result<Document, Vec<Error>> {
    let files = files.iter().fold(MemoryFiles::new(), |files, (name, text)| files.with(*name, *text));
    read(&[Source::new("scene.rad", text)], &files, &Options::default())
}

fn first_error(text: &str, files: &[(&str, &str)]) -> Error {
    with_files(text, files).unwrap_err().remove(0)
}

#[test]
fn other_commands_are_refused_by_name() {
    let error = first_error("# scene\n\n!rm x\n", &[]);
    assert_eq!((error.line, error.column, error.width), (3, 2, 2));
    assert!(error.message.contains("`rm` is not run: no shell is run for a scene"), "{error}");
    for text in ["!genbox m b 1 1 1; rm x", "!xform $(rm x)", "!cat x > y", "!genbox m b 1 1 1 | sh", "!`rm x`", "!"] {
        let error = first_error(text, &[("x", BALL)]);
        assert_eq!(error.line, 1, "{text}: {error}");
    }
}

#[test]
fn an_error_in_a_command_stands_under_its_word() {
    let text = format!("{BALL}!genbox m b 1 1 1 | \\\n  xform -t 1 two 3\n");
    let error = first_error(&text, &[]);
    assert_eq!((error.line, error.column, error.width), (4, 14, 3), "{error}");
    for (command, column, words) in [
        ("!genbox m b 1 1", 16, "ends where the z size"),
        ("!genbox m b 1 -1 1", 15, "must be above 0"),
        ("!genbox m b 1 1 1 -q", 19, "unknown option `-q`"),
        ("!genprism m p 2 0 0 1 1", 15, "at least 3 vertices"),
        ("!genprism m p 99999999999 0 0", 15, "need two numbers each"),
        ("!genprism m p 3 0 0 1 1 1 0 -l 1 0 0", 36, "must leave the plane"),
        ("!xform", 7, "nothing to transform"),
        ("!xform -t 1 2", 14, "wants 3 numbers"),
        ("!xform -s 0 a.rad", 11, "leaves nothing"),
        ("!xform -a 0 a.rad", 11, "at least one copy"),
        ("!xform -t 1 2 3 -n x a.rad", 17, "must stand before the transform"),
        ("!xform -q a.rad", 8, "no such option"),
        ("!xform nowhere.rad", 8, "`nowhere.rad` is not found"),
        ("!cat", 5, "wants at least one file"),
        ("!xform -f a.rad", 11, "`void` is not found"),
    ] {
        let error = first_error(command, &[("a.rad", BALL)]);
        assert_eq!(error.column, column, "{error}");
        assert!(error.message.contains(words), "{error}");
    }
}

#[test]
fn an_error_in_a_file_that_is_read_says_by_whom() {
    let files = [("a.rad", "# a\n!xform -s 2 b.rad\n"), ("b.rad", "void plastic p\n0 0 5 1 1 1 0 x\n")];
    let error = first_error("!cat a.rad", &files);
    assert_eq!((error.file.as_str(), error.line, error.column), ("b.rad", 2, 15));
    assert_eq!(error.notes, ["read by a.rad:2:13", "read by scene.rad:1:6"]);
}

#[test]
fn xform_reads_in_the_folder_of_its_file() {
    let files = [("house/house.rad", "!xform -t 1 0 0 chair.rad"), ("house/chair.rad", BALL), ("chair.rad", "")];
    let document = with_files("!xform house/house.rad", &files).unwrap();
    assert_eq!(document.primitives[1].reals, [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(with_files("!xform -c house/house.rad", &files).unwrap().primitives.len(), 0);
    assert_eq!(with_files("!cat house/house.rad", &files).unwrap().warnings.len(), 2);
}

#[test]
fn loops_end() {
    let error = first_error("!cat a.rad", &[("a.rad", "!xform b.rad"), ("b.rad", "!cat a.rad")]);
    assert!(error.message.contains("a.rad -> b.rad -> a.rad: a file cannot read itself"), "{error}");
    let error = first_error("!xform scene.rad", &[("scene.rad", "!xform scene.rad")]);
    assert!(error.message.contains("cannot read itself"), "{error}");
    let error = first_error("!xform -f f.txt", &[("f.txt", "-f f.txt")]);
    assert!(error.message.contains("more than 16 deep"), "{error}");
}

#[test]
fn bombs_are_defused_by_arithmetic() {
    let files = [("a.rad", BALL), ("b.rad", "!xform -a 1000 a.rad"), ("c.rad", "!xform -a 1000 b.rad")];
    for text in [
        "!xform -a 1000000000000 -t 1 0 0 a.rad",
        "!xform -a 9223372036854775807 -a 9223372036854775807 -t 1 0 0 a.rad",
        "!xform -a 1000000 -t 1 0 0 -a 1000000 -t 0 1 0 a.rad",
        "!xform -a 1000 c.rad",
        "!genbox m b 1 1 1 | xform -a 100000 -t 1 0 0 | xform -a 100000 -t 0 1 0",
    ] {
        let error = first_error(text, &files);
        assert!(error.message.contains("more than the limit"), "{error}");
        assert_eq!((error.line, error.column), (1, 1));
    }
    // Each file doubles the one below, 2^60 times nothing in the end.
    let names: Vec<String> = (0..61).map(|depth| format!("{depth}.rad")).collect();
    let mut files = vec![("0.rad", "# nothing".to_owned())];
    for pair in names.windows(2) {
        files.push((&pair[1], format!("!xform {}\n!xform -mx {}\n", pair[0], pair[0])));
    }
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    assert_eq!(with_files("!cat 60.rad", &files).unwrap().primitives.len(), 0);
    let mut full = files.clone();
    full[0].1 = BALL;
    assert!(first_error("!cat 60.rad", &full).message.contains("more than the limit"));
}

#[test]
fn chains_of_files_have_a_depth() {
    let texts: Vec<(String, String)> =
        (0..80).map(|depth| (format!("{depth}.rad"), format!("!xform {}.rad", depth + 1))).collect();
    let files: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    assert!(first_error("!xform 0.rad", &files).message.contains("more than 64 deep"));
}

#[test]
fn numbers_that_a_transform_makes_infinite_are_errors() {
    let error = first_error(&format!("{BALL}!xform -s 1e200 -i 1 -t 1e308 0 0 -s 1e200 a.rad"), &[("a.rad", BALL)]);
    assert!(error.message.contains("carries `s` beyond the range"), "{error}");
    assert_eq!(error.line, 3);
}

#[test]
fn transforms_keep_all_digits() {
    let document = with_files("!xform -t 100000.123456789 0 0 a.rad", &[("a.rad", BALL)]).unwrap();
    assert_eq!(document.primitives[1].reals[0], 100_000.123_456_789);
}

/// Counts what it is asked to run, and answers with a scene.
struct Fake(RefCell<Vec<(String, String)>>);

impl Commands for Fake {
    fn run(&self, line: &str, folder: &str) -> Result<Vec<u8>, String> {
        self.0.borrow_mut().push((line.to_owned(), folder.to_owned()));
        if line.contains("fail") { Err("it says so".to_owned()) } else { Ok(BALL.into()) }
    }
}

#[test]
fn commands_run_by_leave_up_to_the_last_unknown_one() {
    let fake = Fake(RefCell::default());
    let options = Options { commands: Some(&fake), limits: Limits::default() };
    let run = |text: &str| read(&[Source::new("scene.rad", text)], &MemoryFiles::new(), &options);
    let document = run("!obj2rad a.obj | sort | xform -t 1 0 0 | xform -s 2").unwrap();
    assert_eq!(document.primitives[1].reals, [2.0, 0.0, 0.0, 2.0]);
    assert_eq!(document.primitives[0].kind, Kind::Plastic);
    run("!for x in a b; do cat $x; done").unwrap();
    run("!genbox m b 1 1 1 | xform -t 0 0 0").unwrap_err();
    let errors = run("\n!fail").unwrap_err();
    assert_eq!((errors[0].line, errors[0].message.as_str()), (2, "the command failed: it says so"));
    let lines: Vec<String> = fake.0.borrow().iter().map(|(line, _)| line.trim().to_owned()).collect();
    assert_eq!(lines, ["obj2rad a.obj | sort", "for x in a b; do cat $x; done", "fail"]);
}
