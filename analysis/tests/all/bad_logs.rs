//! Logs that do not belong together, each with the place and the reason.

use analysis::report::{self, Options};
use analysis::trial_log::{Interval, Phase, Trial};

use crate::logs::{alike, critical, practice, swapped, write};

/// The error that a log of these rows gives.
fn error(rows: &[Trial]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", rows);
    let error = report::of_logs(&[log], &Options::default()).unwrap_err();
    assert!(error.is_input());
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn rows_of_another_study_are_refused() {
    let other = Trial { study: "cornell".into(), ..critical(2) };
    assert_eq!(
        error(&[critical(1), other]),
        "log.csv, line 3, column 1 (study): `cornell`, but log.csv, line 2 says `corridor`: studies are not pooled; \
         report each by itself"
    );
}

#[test]
fn simulated_rows_are_refused_beside_real_ones() {
    let simulated = Trial { simulated: true, ..critical(2) };
    assert_eq!(
        error(&[critical(1), simulated]),
        "log.csv, line 3, column 5 (simulated): true, but log.csv, line 2 says false: simulated observers are never \
         pooled with people"
    );
    let demo = Trial { demo: true, ..critical(2) };
    assert!(error(&[critical(1), demo]).contains("column 42 (demo): true, but log.csv, line 2 says false"));
}

#[test]
fn an_altered_hash_is_noticed() {
    let other = Trial { stimuli_hash: "02".repeat(32), ..critical(2) };
    let said = error(&[critical(1), other]);
    assert!(said.starts_with("log.csv, line 3, column 39 (stimuli_hash): `0202"), "{said}");
    assert!(said.ends_with("people saw other pictures, or the log was edited"));
    let other = Trial { plan_hash: "ac".repeat(32), ..critical(2) };
    assert!(error(&[critical(1), other]).contains("line 3, column 38 (plan_hash)"));
    let short = Trial { plan_hash: "ab".into(), ..critical(2) };
    assert!(error(&[critical(1), short]).contains("expected a SHA-256 of 64 hexadecimal digits, found \"ab\""));
}

#[test]
fn a_session_that_comes_twice_is_refused() {
    let rows = [critical(1), critical(2), critical(1)];
    assert_eq!(
        error(&rows),
        "log.csv, line 4, column 2 (session_id): session `s0001` is already in log.csv, line 2: is a log given twice?"
    );
}

#[test]
fn a_log_given_twice_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", &[critical(1)]);
    let said = report::of_logs(&[log.clone(), log], &Options::default()).unwrap_err().to_string();
    assert!(said.contains("line 2, column 2 (session_id): session `s0001` is already in"), "{said}");
}

#[test]
fn a_session_keeps_its_person_and_its_arm() {
    let other = Trial { participant: "p9".into(), ..critical(1) };
    assert!(
        error(&[practice(1), other])
            .contains("line 3, column 3 (participant): `p9`, but the rows of session `s0001` before it say `p0001`")
    );
    let other = Trial { arm: "HQ/HQ".into(), ..critical(1) };
    assert!(error(&[practice(1), other]).contains("line 3, column 4 (arm): `HQ/HQ`"));
    let again = Trial { trial: 1, ..critical(1) };
    assert!(error(&[practice(1), again]).contains("line 3, column 7 (trial): trial 1 after trial 1"));
}

#[test]
fn a_second_critical_trial_is_refused() {
    let second = Trial { trial: 3, ..critical(1) };
    assert!(
        error(&[critical(1), second.clone()])
            .contains("line 3, column 6 (phase): a second critical trial of session `s0001`")
    );
    // Who did not answer has seen the pair all the same.
    let unanswered = Trial { worse_answer: None, correct: None, ..critical(1) };
    assert!(error(&[unanswered, second]).contains("line 3, column 6 (phase): a second critical trial"));
}

#[test]
fn correct_must_make_sense() {
    let unasked = Trial { worse_answer: None, ..critical(1) };
    assert!(error(&[unasked]).contains("line 2, column 19 (correct): correct without an answer"));
    let same = Trial { second_quality: "HQ".into(), ..critical(1) };
    assert!(error(&[same]).contains("both pictures are `HQ`, so no answer is right"));
    let turned = Trial { correct: Some(false), ..critical(2) };
    let said = error(&[critical(1), turned]);
    assert!(
        said.contains("line 3, column 19 (correct): makes `HQ` the lower quality, but log.csv, line 2 makes it `CBQ`"),
        "{said}"
    );
    let mut turned = swapped(critical(2));
    turned.correct = Some(true);
    assert!(error(&[critical(1), turned]).contains("makes `HQ` the lower quality"));
    let none = Trial { correct: None, ..critical(2) };
    assert!(error(&[critical(1), none]).contains("arm `HQ/CBQ` has not a right answer here, unlike log.csv, line 2"));
    let right = Trial { correct: Some(true), second_quality: "CBQ".into(), ..alike(2, Interval::Second) };
    assert!(error(&[alike(1, Interval::First), right]).contains("arm `HQ/HQ` has a right answer here"));
}

#[test]
fn a_broken_sidecar_is_reported_and_a_missing_log_is_input() {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", &[critical(1)]);
    std::fs::write(folder.path().join("log.json"), "{\n oops").unwrap();
    let said = report::of_logs(&[log], &Options::default()).unwrap_err().to_string();
    assert!(said.contains("log.json, line 2, column 2: not the sidecar of a log"), "{said}");
    let missing = report::of_logs(&[folder.path().join("none.csv")], &Options::default()).unwrap_err();
    assert!(missing.is_input() && missing.to_string().contains("none.csv"));
}

/// What a progress bar is drawn from: every byte of every log, once.
#[test]
fn every_byte_read_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let logs = [1, 2].map(|id| write(folder.path(), &format!("{id}.csv"), &[critical(id)]));
    let told = std::cell::Cell::new(0);
    report::of_logs_told(&logs, &Options::default(), &|bytes| told.set(told.get() + bytes)).unwrap();
    assert_eq!(told.get(), logs.iter().map(|log| log.metadata().unwrap().len()).sum::<u64>());
}

#[test]
fn practice_alone_is_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    let rows = [practice(1), Trial { phase: Phase::Critical, worse_answer: None, correct: None, ..critical(2) }];
    let log = write(folder.path(), "log.csv", &rows);
    let report = report::of_logs(&[log], &Options::default()).unwrap();
    assert_eq!((report.flow.sessions, report.flow.analysed), (2, 0));
    assert_eq!(report.exclusions.len(), 2);
    assert!(report.arms.is_empty());
}
