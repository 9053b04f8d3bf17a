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
        (vec!["--counts", "A=1/2", "--counts", "A=1/2"], "was given before"),
        (vec!["--counts", "A=1/2", "--no-right-answer", "B"], "there is no such arm"),
        (vec![], "LOG"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(says), "{arguments:?}: {}", text(&output.stderr));
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
