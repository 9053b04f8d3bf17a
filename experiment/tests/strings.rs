//! What other programs see: text of any kind through Python's csv module and pandas, a dataset through the BIDS validator,
//! the order of system calls through strace. Where one of them is not installed its test shows as ignored.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, ExitCode};

use analysis::trial_log::{Trial as Row, header_line, row_line};
use experiment::draw::Draws;
use libtest_mimic::{Arguments, Failed, Trial};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let runs = |program: &str, arguments: &[&str]| {
        Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
    };
    let python = python();
    let trials = vec![
        Trial::test("fuzzed_strings_survive_pythons_csv", || strings(CSV))
            .with_ignored_flag(!runs(&python, &["--version"])),
        Trial::test("fuzzed_strings_survive_pandas", || strings(PANDAS))
            .with_ignored_flag(!runs(&python, &["-c", "import pandas"])),
        Trial::test("every_line_is_synced_before_the_next", order_of_calls)
            .with_ignored_flag(!runs("strace", &["--version"])),
        Trial::test("the_bids_validator_finds_no_error", bids).with_ignored_flag(!runs(&validator(), &["--version"])),
    ];
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn python() -> String {
    std::env::var("SESSION_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

fn validator() -> String {
    std::env::var("SESSION_BIDS_VALIDATOR").unwrap_or_else(|_| "bids-validator".to_owned())
}

const CSV: &str = "import csv, sys\nrows = list(csv.DictReader(open(sys.argv[1], newline='', encoding='utf-8')))\n";
const PANDAS: &str = "import pandas, sys\n\
    rows = pandas.read_csv(sys.argv[1], dtype=str, keep_default_na=False).to_dict('records')\n";
/// Both fields of every row against the strings as JSON.
const COMPARE: &str = "import json\nwanted = json.load(open(sys.argv[2], encoding='utf-8'))\n\
    assert len(rows) == len(wanted), (len(rows), len(wanted))\n\
    wrong = [(r['arm'], w) for r, w in zip(rows, wanted) if [r['arm'], r['interrupt_reason']] != w]\n\
    assert not wrong, wrong[:3]\nprint(len(rows))\n";

/// Anything that a text can hold but NUL, which no field of the log can get: quotes, line ends of every kind, what a
/// spreadsheet would take for a formula, emoji, text from right to left.
fn string(draws: &mut Draws) -> String {
    const PIECES: [&str; 24] = [
        "\"",
        "\"\"",
        ",",
        ";",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "'",
        "\\",
        "=cmd|' /C calc'!A0",
        "@SUM(1)",
        "-1",
        "+1",
        "#",
        " ",
        "\u{1F600}\u{1F3FD}",
        "\u{5E9}\u{5DC}",
        "\u{202E}",
        "\u{FEFF}",
        "\u{0301}",
        "NA",
        "null",
        "\u{7f}",
    ];
    let piece = |draws: &mut Draws| match draws.below(3) {
        0 => loop {
            // Any scalar value of Unicode but NUL.
            if let Some(c) = char::from_u32(1 + draws.below(0x0010_FFFF) as u32) {
                break c.to_string();
            }
        },
        _ => PIECES[draws.below(PIECES.len() as u64) as usize].to_owned(),
    };
    (0..draws.below(12)).map(|_| piece(draws)).collect()
}

fn strings(program: &str) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let mut draws = Draws::new(5, "strings");
    let wanted: Vec<[String; 2]> =
        (0..support::times("SESSION_STRINGS", 1000) / 2).map(|_| [string(&mut draws), string(&mut draws)]).collect();
    let mut text = header_line();
    for [arm, reason] in &wanted {
        let (arm, interrupt_reason) = (arm.clone(), reason.clone());
        text.push_str(&row_line(&Row { arm, interrupt_reason, participant: "P01".to_owned(), ..Row::default() }));
    }
    let (log, json, script) = ["log.csv", "wanted.json", "read.py"].map(|name| folder.path().join(name)).into();
    std::fs::write(&log, text)?;
    std::fs::write(&json, serde_json::to_string(&wanted)?)?;
    std::fs::write(&script, format!("{program}{COMPARE}"))?;
    let output = Command::new(python()).arg(&script).arg(&log).arg(&json).output()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() { Ok(()) } else { Err(said.into()) }
}

/// A rehearsed study, one who left and one who withdrew among them, exported and validated.
fn bids() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let (study, data, to) = ["study", "data", "bids"].map(|name| folder.path().join(name)).into();
    support::write_study(&study, |text| text.replace("n = 16", "n = 4"));
    session(&study, &data, &["--simulate", "8", "--leaves", "0.05"])?;
    session(&study, &data, &["--withdraw", "sim-00003"])?;
    session(&study, &data, &["--bids", to.to_str().unwrap()])?;
    assert!(!to.join("sub-sim00003").exists() && to.join("sub-sim00001").exists());
    let output = Command::new(validator()).arg(&to).args(["--json"]).output()?;
    let report: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let errors = &report["issues"]["errors"];
    assert_eq!(errors.as_array().map(Vec::len), Some(0), "{errors:#}");
    Ok(())
}

fn session(study: &Path, data: &Path, arguments: &[&str]) -> Result<(), Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crex-session"));
    let output = command.arg(study).args(arguments).arg("--data").arg(data).output()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() { Ok(()) } else { Err(said.into()) }
}

/// Every line of rows and journal is on the disk before anything else is written: after each `write` to one of these files
/// the next call on any of them is its `fdatasync`; and each file was made by a call that fails if it is there.
fn order_of_calls() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let [study, data, trace] = ["study", "data", "trace"].map(|name| folder.path().join(name));
    support::write_study(&study, |text| text.replace("n = 16", "n = 4"));
    let calls = "trace=openat,write,fdatasync,fsync,close";
    let mut command = Command::new("strace");
    command.args(["-f", "-e", calls, "-s", "16", "-o"]).arg(&trace).arg(env!("CARGO_BIN_EXE_crex-session"));
    let output = command.arg(&study).args(["--simulate", "1", "--data"]).arg(&data).output()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (mut open, mut unsynced, mut synced) = (BTreeMap::new(), None, 0);
    for line in std::fs::read_to_string(&trace)?.lines() {
        let call = line.split_once(' ').map_or(line, |(_pid, call)| call.trim_start());
        let argument = |call: &str| call.split(['(', ',', ')']).nth(1).map(str::to_owned).unwrap_or_default();
        let result = call.rsplit_once("= ").map(|(_, result)| result.trim().to_owned()).unwrap_or_default();
        if call.starts_with("openat(") && (call.contains(".csv\"") || call.contains(".events.jsonl\"")) {
            if call.contains("O_CREAT") {
                assert!(call.contains("O_EXCL") && call.contains("O_APPEND"), "{call}");
                open.insert(result, call.to_owned());
            }
        } else if call.starts_with("close(") {
            open.remove(&argument(call));
        } else if open.contains_key(&argument(call)) {
            if call.starts_with("write(") {
                assert_eq!(unsynced.replace(argument(call)), None, "{call}");
            } else if call.starts_with("fdatasync(") {
                assert_eq!(unsynced.take(), Some(argument(call)), "{call}");
                synced += 1;
            }
        }
    }
    assert_eq!(unsynced, None);
    // Header, three rows; start, three pairs, three digests, consent, noticed, known, end.
    assert_eq!(synced, 4 + 11);
    Ok(())
}
