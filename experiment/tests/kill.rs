//! Sessions killed at any moment, started at the same moment, taken up again.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use analysis::trial_log::{Phase, Reader, Trial as Row};
use experiment::design::Plan;
use experiment::draw::Draws;
use experiment::log::{Event, read_journal};
use experiment::script;
use experiment::session::Step;
use stimuli::{Sha256, Study};

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

/// The trials that the plan has for the slot of a session: phase, number, the two pictures.
fn planned(study: &Study, slot: u32) -> Vec<(Phase, u32, String, String)> {
    let plan = Plan::draw(study, 1);
    let trials = script::steps(study, plan.slot(slot).unwrap()).into_iter().filter_map(|step| match step {
        Step::Trial(trial) => Some((trial.phase, trial.number, trial.first.stimulus.id(), trial.second.stimulus.id())),
        _ => None,
    });
    trials.collect()
}

/// Kills the program at random moments again and again until two sessions have come to their ends; every trial that it said
/// to have saved is there each time, the journal's chain holds, and in the end the rows are those of the uninterrupted plan.
fn kill_and_resume(seed: u64) -> u32 {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    let shipped = support::write_study(&study, |text| text);
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
        let text = std::fs::read_to_string(log(&data, participant)).unwrap();
        assert!(text.ends_with('\n'), "no half line is left");
        let lines = read_journal(&log(&data, participant).with_extension("events.jsonl")).unwrap();
        let Event::Started { slot, .. } = lines[0].event else { panic!("{:?}", lines[0]) };
        let rows = whole_rows(&log(&data, participant));
        let shown = |row: &Row| (row.phase, row.trial, row.first_stimulus.clone(), row.second_stimulus.clone());
        assert_eq!(rows.iter().map(shown).collect::<Vec<_>>(), planned(&shipped, slot));
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
    let wanted = support::times("SESSION_KILLS", 12);
    let (mut kills, mut seed) = (0, 0);
    while kills < wanted && seed < 10 * u64::from(wanted) {
        kills += kill_and_resume(seed);
        seed += 1;
    }
    assert!(kills >= wanted, "no kill came in time");
    eprintln!("{kills} kills in {seed} pairs of sessions");
}

/// The digests of a folder's files.
fn digests(folder: &Path) -> Vec<(PathBuf, Sha256)> {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = files.map(|path| (path.clone(), Sha256::of_file(&path).unwrap())).collect();
    found.sort();
    found
}

/// One code, started 64 times at once: one session, and nothing of it overwritten; then again, with the session there.
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
    let all_at_once = |many: u32| {
        let children: Vec<Child> = (0..many).map(|_| start()).collect();
        let mut went_through = 0;
        for mut child in children {
            let mut said = String::new();
            child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
            let status = child.wait().unwrap();
            went_through += u32::from(status.success());
            assert!(status.success() || (status.code() == Some(2) && said.contains("has a session")), "{said}");
        }
        went_through
    };
    assert_eq!(all_at_once(64), 1);
    assert_eq!(whole_rows(&log(&data, "sim-00001")).len(), 3);
    let before = digests(&data.join("sessions/sim-00001"));
    assert_eq!(all_at_once(8), 0);
    assert_eq!(digests(&data.join("sessions/sim-00001")), before);
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

/// A disk that is full at some moment (here: no file may grow beyond a limit): what was saved is whole, what was not is said,
/// and once there is room the session goes on.
#[test]
#[cfg(unix)]
fn a_full_disk_tears_no_row_and_the_session_goes_on() {
    let mut stopped = 0;
    for blocks in 3..12 {
        let folder = tempfile::tempdir().unwrap();
        let (study, data) = (folder.path().join("study"), folder.path().join("data"));
        support::write_study(&study, |text| text.replace("n = 16", "n = 4"));
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$1\" --simulate 1 --data \"$2\"");
        let output = Command::new("sh").args(["-c", &script, PROGRAM]).arg(&study).arg(&data).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            assert_eq!(output.status.code(), Some(1), "{said}");
            assert!(said.contains("cannot"), "{said}");
            stopped += u32::from(data.join("sessions/sim-00001").exists());
        }
        let text = std::fs::read_to_string(log(&data, "sim-00001")).unwrap_or_default();
        assert!(text.is_empty() || text.ends_with('\n'), "half a row: {text}");
        assert!(
            Command::new(PROGRAM)
                .arg(&study)
                .args(["--simulate", "1", "--resume", "--data"])
                .arg(&data)
                .output()
                .unwrap()
                .status
                .success()
        );
        let rows = whole_rows(&log(&data, "sim-00001"));
        assert_eq!(rows.iter().map(|row| row.trial).collect::<Vec<_>>(), [1, 2, 3]);
    }
    assert!(stopped > 0, "no limit fell into a session");
}

/// Who withdraws leaves a dated note and no answer; the slot goes back, and the code stays taken.
#[test]
fn who_withdraws_leaves_a_stone_and_no_answers() {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, |text| text.replace("n = 16", "n = 4"));
    let run = |arguments: &[&str]| {
        let output = Command::new(PROGRAM).arg(&study).args(arguments).arg("--data").arg(&data).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(run(&["--simulate", "3"]).0, Some(0));
    for _ in 0..2 {
        assert_eq!(run(&["--withdraw", "sim-00002"]).0, Some(0));
    }
    let left: Vec<_> = digests(&data.join("sessions/sim-00002"));
    assert_eq!(left.len(), 1);
    let stone: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&left[0].0).unwrap()).unwrap();
    assert_eq!((&stone["lines_erased"], &stone["simulated"]), (&3.into(), &true.into()));
    assert!(stone["withdrawn_utc"].as_str().unwrap().ends_with('Z'));
    assert!(std::fs::read_to_string(data.join("slots/0002-1.back.json")).unwrap().contains("withdrawn"));
    assert_eq!(run(&["--withdraw", "nobody"]).0, Some(2));
    let (code, said) = run(&["--simulate", "2", "--resume"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("withdrew"), "{said}");
}
