//! Sessions killed at any moment, started at the same moment, taken up again.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use analysis::trial_log::{Phase, Reader, Trial as Row};
use experiment::draw::Draws;

const PROGRAM: &str = env!("CARGO_BIN_EXE_crex-session");

fn simulate(study: &Path, data: &Path, speed: &str) -> Child {
    let mut command = Command::new(PROGRAM);
    command.arg(study).args(["--simulate", "2", "--resume", "--speed", speed, "--data"]).arg(data);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn log(data: &Path, participant: &str) -> PathBuf {
    data.join("sessions").join(participant).join(format!("{participant}.csv"))
}

/// The trials of a log's whole lines. The last line may be half there, as long as nobody took the session up again.
fn whole_rows(path: &Path) -> Vec<Row> {
    let Ok(text) = std::fs::read_to_string(path) else { return Vec::new() };
    let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
    if whole.is_empty() {
        return Vec::new();
    }
    let mut reader = Reader::new(whole.as_bytes(), path).unwrap();
    let (mut row, mut rows) = (Row::default(), Vec::new());
    while reader.read_into(&mut row).unwrap() {
        rows.push(row.clone());
    }
    rows
}

/// Kills the program at random moments again and again until two sessions have come to their ends; every trial that it said
/// to have saved is there each time, and in the end every planned trial has one row.
fn kill_and_resume(seed: u64) -> u32 {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, |text| text);
    let mut draws = Draws::new(seed, "moments to kill at");
    let mut kills = 0;
    loop {
        let mut child = simulate(&study, &data, "60");
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        std::thread::sleep(Duration::from_secs_f64(0.9 * draws.unit()));
        let ended = child.try_wait().unwrap();
        child.kill().unwrap(); // SIGKILL
        child.wait().unwrap();
        for line in lines.by_ref().map_while(Result::ok) {
            if let Some((participant, trial)) = line.split_once(": trial ") {
                let trial: u32 = trial.trim_end_matches(" saved").parse().unwrap();
                let rows = whole_rows(&log(&data, participant));
                assert!(rows.iter().any(|row| row.trial == trial), "{line}, and it is not there");
            }
        }
        match ended {
            Some(status) => {
                assert!(status.success());
                break;
            }
            None => kills += 1,
        }
    }
    for participant in ["sim-00001", "sim-00002"] {
        let rows = whole_rows(&log(&data, participant));
        assert_eq!(rows.iter().map(|row| row.trial).collect::<Vec<_>>(), [1, 2, 3]);
        let phases: Vec<Phase> = rows.iter().map(|row| row.phase).collect();
        assert_eq!(phases, [Phase::Practice, Phase::Critical, Phase::Check]);
        for row in rows {
            assert_eq!(row.interrupt_reason == "crash", row.resume_gap_s.is_some());
            assert_eq!(row.interrupted, row.worse_answer.is_none() && row.first_count_answer.is_none());
        }
    }
    kills
}

#[test]
fn a_killed_session_has_lost_no_finished_trial_and_goes_on() {
    let kills: u32 = (0..3).map(kill_and_resume).sum();
    assert!(kills > 0, "no kill came in time");
}

/// One code, started sixteen times at once: one session, and nothing of it overwritten.
#[test]
fn one_code_started_at_once_many_times_is_one_session() {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, |text| text);
    let start = || {
        let mut command = Command::new(PROGRAM);
        command.arg(&study).args(["--simulate", "1", "--data"]).arg(&data);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let children: Vec<Child> = (0..16).map(|_| start()).collect();
    let mut went_through = 0;
    for mut child in children {
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        let status = child.wait().unwrap();
        went_through += u32::from(status.success());
        assert!(status.success() || (status.code() == Some(2) && said.contains("has a session")), "{said}");
    }
    assert_eq!(went_through, 1);
    assert_eq!(whole_rows(&log(&data, "sim-00001")).len(), 3);
}

/// What is refused, and with which exit code.
#[test]
fn what_is_wrong_is_said_before_anybody_sits_down() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study");
    support::write_study(&study, |text| text);
    let run = |arguments: &[&str]| {
        let mut command = Command::new(PROGRAM);
        command.arg(&study).args(arguments).arg("--data").arg(folder.path().join("data"));
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, said) = run(&["--participant", "P01"]);
    assert_eq!(code, Some(1));
    assert!(said.contains("no display"), "{said}");

    std::fs::write(study.join("pictures/a_hq.png"), b"not what was rendered").unwrap();
    let (code, said) = run(&["--simulate", "1"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("a_hq.png") && said.contains("SHA-256"), "{said}");

    std::fs::remove_file(study.join("pictures/a_hq.png")).unwrap();
    let (code, said) = run(&["--simulate", "1"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("a_hq.png") && said.contains("missing"), "{said}");
    assert!(!folder.path().join("data").exists(), "nothing was begun");
}

#[test]
fn without_a_display_the_study_is_rehearsed_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study");
    support::write_study(&study, |text| text.replace("n = 16", "n = 4"));
    let data = folder.path().join("data");
    let mut command = Command::new(PROGRAM);
    command.arg(&study).arg("--data").arg(&data).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("no display"), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).to_lowercase().contains("simulated"));
    let json = std::fs::read_to_string(data.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["simulated"], true);
    let arms: Vec<(&str, u64)> = report["arms"]
        .as_array()
        .unwrap()
        .iter()
        .map(|arm| (arm["arm"].as_str().unwrap(), arm["n"].as_u64().unwrap()))
        .collect();
    assert_eq!(arms, [("HQ/CBQ", 4), ("HQ/HQ", 4)]);
}
