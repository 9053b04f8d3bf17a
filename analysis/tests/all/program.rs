//! The program: exit codes, outputs, messages.

use std::path::Path;
use std::process::{Command, Output};

use crate::logs::{critical, paper, write};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_crex-report")).args(arguments).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_paper_s_table_from_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(
        folder.path(),
        &["--counts", "HQ/CBQ=9/16", "--counts", "HQ/HQ=8/16", "--no-right-answer", "HQ/HQ", "--json"],
    );
    assert_eq!(output.status.code(), Some(0));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let chi = &json["arms"][0]["chi_square"];
    assert_eq!(chi["statistic"], 0.25);
    assert_eq!(format!("{:.4}", chi["p"].as_f64().unwrap()), "0.6171");
    assert!(json["arms"][1]["correct"].is_null());
    assert_eq!(json["provenance"]["counts"][0], "HQ/CBQ=9/16");
}

#[test]
fn outputs_go_by_their_ending() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "log.csv", &paper());
    let output = run(folder.path(), &["log.csv", "-o", "r.html", "-o", "r.md", "-o", "r.json"]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0), "{}", text(&output.stderr));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(read("r.html").starts_with("<!doctype html>"));
    assert!(
        read("r.md").contains("| HQ/CBQ | right answers | 9 of 16 | 56.2 % | 0.25 (1) | 0.6171 | 0.8036 |"),
        "{}",
        read("r.md")
    );
    assert!(serde_json::from_str::<serde_json::Value>(&read("r.json")).is_ok());
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(left.len(), 4, "nothing but what was asked for: {left:?}");
}

#[test]
fn wrong_input_ends_with_two_and_says_where() {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", &[critical(1)]);
    let broken = std::fs::read_to_string(&log).unwrap().replace(",critical,", ",criticle,");
    std::fs::write(&log, broken).unwrap();
    let output = run(folder.path(), &["log.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert_eq!(
        text(&output.stderr),
        "crex-report: log.csv, line 2, column 6 (phase): expected practice, critical, informed or check, found \"criticle\"\n"
    );
    for (arguments, says) in [
        (vec!["none.csv"], "none.csv"),
        (vec!["log.csv", "-o", "out.pdf"], "expected an ending"),
        (vec!["--counts", "HQ/CBQ=17/16"], "whole numbers K <= N"),
        (vec!["--counts", "A=18446744073709551615/18446744073709551615"], "N at most 10000000000000"),
        (vec!["--counts", "A=1/2", "--counts", "A=1/2"], "was given before"),
        (vec!["--counts", "A=1/2", "--no-right-answer", "B"], "there is no such arm"),
        (vec![], "LOG"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(says), "{arguments:?}: {}", text(&output.stderr));
    }
}

/// Every way in which a log is broken: the program ends with 2, prints no report, leaves the file that is there alone, and
/// says file, line and column.
#[test]
fn broken_logs_end_with_two_and_say_where() {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", &[critical(1), critical(2)]);
    let good = std::fs::read_to_string(&log).unwrap();
    let lines: Vec<&str> = good.lines().collect();
    let second = |line: String| format!("{}\n{}\n{line}\n", lines[0], lines[1]);
    let changed = |from: &str, to: &str| {
        assert!(lines[2].contains(from));
        second(lines[2].replacen(from, to, 1)).into_bytes()
    };
    let latin1 = |text: String| -> Vec<u8> { text.chars().map(|character| character as u8).collect() };
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(good.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        (
            "missing column",
            good.replace("vsync,", "").into_bytes(),
            "log.csv, line 1, column 32 (vsync): the column is missing",
        ),
        ("wrong type", changed("30.0", "soon"), "log.csv, line 3, column 22 (first_onset_s): expected a finite number"),
        (
            "mixed studies",
            changed("corridor", "cornell"),
            "log.csv, line 3, column 1 (study): `cornell`, but log.csv, line 2",
        ),
        (
            "simulated beside real",
            changed("false", "true"),
            "log.csv, line 3, column 5 (simulated): true, but log.csv, line 2",
        ),
        (
            "duplicate session",
            second(lines[1].to_owned()).into_bytes(),
            "log.csv, line 3, column 7 (trial): trial 2 after trial 2: is a row there twice, or moved?",
        ),
        (
            "duplicate session, apart",
            (second(lines[2].to_owned()) + lines[1] + "\n").into_bytes(),
            "log.csv, line 4, column 2 (session_id): session `s0001` is already in log.csv, line 2",
        ),
        ("altered hash", changed("0101", "0111"), "log.csv, line 3, column 39 (stimuli_hash): `0111"),
        ("hash cut short", changed("abab", "ab"), "log.csv, line 3, column 38 (plan_hash): expected a SHA-256 of 64"),
        (
            "half a row",
            good.as_bytes()[..good.len() - 120].to_vec(),
            "log.csv, line 3, column 38 (plan_hash): the row ends",
        ),
        (
            "surplus field",
            second(format!("{},x", lines[2])).into_bytes(),
            "log.csv, line 3, column 43: 43 fields, expected 42",
        ),
        ("UTF-16", utf16, "log.csv, line 1, column 1: this is UTF-16: save the log as UTF-8"),
        (
            "Latin-1",
            latin1(second(lines[2].replace("p0002", "J\u{fc}rg"))),
            "log.csv, line 3, column 3 (participant): not UTF-8",
        ),
        (
            "semicolons",
            good.replace(',', ";").into_bytes(),
            "log.csv, line 1, column 1: fields are set apart by semicolons",
        ),
        ("nothing", Vec::new(), "log.csv, line 1, column 1: the log is empty"),
    ];
    std::fs::write(folder.path().join("r.html"), "an earlier report").unwrap();
    for (what, bytes, says) in cases {
        std::fs::write(&log, bytes).unwrap();
        let output = run(folder.path(), &["log.csv", "-o", "r.html"]);
        let said = text(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{what}: {said}");
        assert!(said.contains(says), "{what}: {said}");
        assert_eq!(std::fs::read_to_string(folder.path().join("r.html")).unwrap(), "an earlier report", "{what}");
    }
}

/// A report in place of the data that it is made from would lose them.
#[test]
fn an_output_never_takes_the_place_of_an_input() {
    let folder = tempfile::tempdir().unwrap();
    let below = folder.path().join("data");
    std::fs::create_dir(&below).unwrap();
    let log = write(&below, "log.csv", &paper());
    let sidecar = below.join("log.json");
    std::fs::write(&sidecar, "{}").unwrap();
    let before = std::fs::read(&log).unwrap();
    let absolute = log.display().to_string();
    for arguments in [
        ["data/log.csv", "-o", "data/log.csv"],
        ["data", "-o", "data/../data/log.csv"],
        ["data", "-o", "data/log.json"],
        ["data/log.csv", "-o", &absolute],
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains("would take its place"), "{}", text(&output.stderr));
    }
    assert_eq!((std::fs::read(&log).unwrap(), std::fs::read(&sidecar).unwrap()), (before, b"{}".to_vec()));
    // Beside them is no harm, and a report may be made again.
    for _ in 0..2 {
        let output = run(folder.path(), &["data", "-o", "data/numbers.csv"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
}

#[test]
fn what_the_machine_cannot_do_ends_with_one() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "log.csv", &paper());
    let output = run(folder.path(), &["log.csv", "-o", "no/such/folder/r.html"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
}

#[test]
fn a_folder_stands_for_its_logs() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(run(folder.path(), &["."]).status.code(), Some(2));
    for id in 1..4 {
        let below = folder.path().join(format!("p{id}"));
        std::fs::create_dir(&below).unwrap();
        write(&below, "log.csv", &[critical(id)]);
        write(&below, "frames.csv", &[critical(id)]);
        std::fs::write(below.join("log.json"), "{}").unwrap();
    }
    let output = run(folder.path(), &[".", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["provenance"]["logs"].as_array().unwrap().len(), 3);
    assert_eq!(json["provenance"]["logs"][2]["file"], "./p3/log.csv");
    assert_eq!(json["arms"][0]["n"], 3);
}

#[test]
fn power_answers_in_words_and_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["power", "--n", "16"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.contains("plan 42 people in an arm") && said.contains("the power is 40.5 % to find"), "{said}");
    let output = run(folder.path(), &["power", "--jod", "0.5", "--target", "0.9", "--json", "-o", "curve.csv"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["question"], "equivalence");
    assert!((json["bound"].as_f64().unwrap() - 0.132).abs() < 1e-3);
    assert!(std::fs::read_to_string(folder.path().join("curve.csv")).unwrap().starts_with("people,power\n"));
    for (arguments, says) in [
        (vec!["power", "--bound", "0.5"], "expected a number between 0 and 0.5"),
        (vec!["power", "--truth", "nan"], "expected a number between 0 and 1"),
        (vec!["power", "--n", "0"], "0 is not in"),
        (vec!["power", "-o", "x.txt"], "expected an ending"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(says), "{arguments:?}: {}", text(&output.stderr));
    }
}
