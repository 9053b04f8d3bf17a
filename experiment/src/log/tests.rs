use std::io::Write;

use analysis::trial_log::{Interval, Phase};
use stimuli::Stimulus;

use super::*;
use crate::input::Interruption;
use crate::session::Outcome;
use crate::timing::IntervalFrames;
use crate::trial::{Asks, Observed, Shown, TrialPlan};

fn identity() -> Identity {
    Identity {
        study: "squares".to_owned(),
        session_id: "P01-0123".to_owned(),
        participant: "P01".to_owned(),
        arm: "HQ/CBQ".to_owned(),
        simulated: false,
        seed: 7,
        plan_hash: "0".repeat(64),
        stimuli_hash: "1".repeat(64),
        version: "test".to_owned(),
        started_utc: "2005-11-29T09:30:00Z".to_owned(),
        demo: true,
    }
}

fn trial(number: u32) -> Record {
    let shown = |quality: &str, rank| Shown {
        stimulus: Stimulus { layout: "a".to_owned(), quality: quality.to_owned() },
        count: Some(3),
        rank,
    };
    let asks = Asks { counts: true, worse: true, confidence: false };
    let plan = TrialPlan { number, phase: Phase::Critical, first: shown("HQ", 2), second: shown("CBQ", 1), asks };
    let frames = IntervalFrames { onset_s: 1.5, duration_s: Some(6.25), missed: 2, longest_ms: 33.5, drawn: 360 };
    let observed = Observed {
        first: Some(frames),
        second: Some(frames),
        first_count: Some(3),
        second_count: Some(4),
        worse: Some(Interval::First),
        rt_s: Some(0.1 + 0.2),
        confidence: None,
        interruptions: vec![Interruption::FocusLost, Interruption::Escape],
    };
    Record::Trial { plan: Box::new(plan), observed: Box::new(observed), resume_gap_s: None }
}

fn create(folder: &Path) -> SessionLog {
    SessionLog::create(folder, identity(), 3, Sha256::of(b"plan"), Utc::now()).unwrap()
}

fn save(log: &mut SessionLog, record: &Record) {
    log.save(record, &DisplayFacts::default(), Some(false), Utc::now()).unwrap();
}

fn rows(folder: &Path) -> Vec<Row> {
    let mut reader = Reader::open(&folder.join("P01.csv")).unwrap();
    let (mut row, mut rows) = (Row::default(), Vec::new());
    while reader.read_into(&mut row).unwrap() {
        rows.push(row.clone());
    }
    rows
}

#[test]
fn a_row_says_what_was_planned_and_observed() {
    let folder = tempfile::tempdir().unwrap();
    let mut log = create(folder.path());
    let facts = DisplayFacts { onset_source: analysis::trial_log::OnsetSource::SwapReturn, ..DisplayFacts::default() };
    log.save(&trial(1), &facts, None, Utc::now()).unwrap();
    let row = rows(folder.path()).remove(0);
    assert_eq!((row.first_stimulus.as_str(), row.second_stimulus.as_str()), ("a_hq", "a_cbq"));
    assert_eq!((row.worse_answer, row.correct), (Some(Interval::First), Some(false)));
    assert_eq!((row.rt_s, row.first_duration_s), (Some(0.1 + 0.2), Some(6.25)));
    assert_eq!((row.first_missed_frames, row.first_max_frame_ms), (Some(2), Some(33.5)));
    assert_eq!((row.interrupted, row.interrupt_reason.as_str()), (true, "focus_lost+escape"));
    assert!(row.demo && !row.simulated);
}

#[test]
fn frames_of_a_rehearsal_are_not_claimed() {
    let folder = tempfile::tempdir().unwrap();
    save(&mut create(folder.path()), &trial(1));
    let row = rows(folder.path()).remove(0);
    assert_eq!((row.first_missed_frames, row.first_max_frame_ms), (None, None));
    assert_eq!(row.first_duration_s, Some(6.25));
}

#[test]
fn a_session_is_never_begun_twice_in_one_place() {
    let folder = tempfile::tempdir().unwrap();
    save(&mut create(folder.path()), &trial(1));
    let before = std::fs::read(folder.path().join("P01.csv")).unwrap();
    let again = SessionLog::create(folder.path(), identity(), 3, Sha256::of(b"plan"), Utc::now());
    assert!(matches!(again, Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::AlreadyExists));
    assert_eq!(std::fs::read(folder.path().join("P01.csv")).unwrap(), before);
}

/// Cut anywhere: at every byte of the log and at every byte of the journal.
#[test]
fn a_log_cut_at_any_byte_is_taken_up_with_every_whole_row() {
    let whole = tempfile::tempdir().unwrap();
    let mut log = create(whole.path());
    for record in [Record::Consent(true), Record::PairStarts { trial: 1, phase: Phase::Critical }, trial(1)] {
        save(&mut log, &record);
    }
    let csv = std::fs::read(whole.path().join("P01.csv")).unwrap();
    let journal = std::fs::read(whole.path().join("P01.events.jsonl")).unwrap();
    let last_row = header_line().len();
    for cut in last_row..=csv.len() {
        let folder = tempfile::tempdir().unwrap();
        // The row comes before its digest: whatever is cut off the row, the digest is not there yet.
        let digest = journal
            .iter()
            .rposition(|&b| b == b'\n')
            .and_then(|end| journal[..end].iter().rposition(|&b| b == b'\n').map(|start| start + 1));
        std::fs::write(folder.path().join("P01.csv"), &csv[..cut]).unwrap();
        std::fs::write(folder.path().join("P01.events.jsonl"), &journal[..digest.unwrap()]).unwrap();
        let recovered = SessionLog::recover(folder.path(), "P01", Utc::now()).unwrap();
        assert_eq!(recovered.done.finished.len(), usize::from(cut == csv.len()), "cut at {cut}");
        assert_eq!(recovered.done.consent, Some(true));
        assert!(recovered.done.started.contains(&1));
        let torn = last_row < cut && cut < csv.len();
        assert_eq!(recovered.torn.len(), usize::from(torn));
        if let Some(aside) = recovered.torn.first() {
            assert_eq!(std::fs::read(aside).unwrap(), &csv[last_row..cut], "what was torn is kept");
        }
        assert_eq!(rows(folder.path()).len(), recovered.done.finished.len());
    }
    let first_line = journal.iter().position(|&b| b == b'\n').unwrap() + 1;
    for cut in first_line..=journal.len() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("P01.csv"), &csv).unwrap();
        std::fs::write(folder.path().join("P01.events.jsonl"), &journal[..cut]).unwrap();
        let mut recovered = SessionLog::recover(folder.path(), "P01", Utc::now()).unwrap();
        assert!(recovered.done.finished.contains(&1));
        save(&mut recovered.log, &Record::Ended(Outcome::Completed));
        let again = SessionLog::recover(folder.path(), "P01", Utc::now()).unwrap();
        assert_eq!(again.done.ended, Some(Outcome::Completed));
    }
}

#[test]
fn an_altered_journal_or_row_is_found() {
    let change = |file: &str, from: &str, to: &str| {
        let folder = tempfile::tempdir().unwrap();
        let mut log = create(folder.path());
        for record in [Record::Consent(true), trial(1), Record::KnownTask(false), Record::Ended(Outcome::Completed)] {
            save(&mut log, &record);
        }
        drop(log);
        let path = folder.path().join(file);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{text}");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        SessionLog::recover(folder.path(), "P01", Utc::now()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert!(change("P01.events.jsonl", "\"known\":false", "\"known\":true").unwrap_err().contains(":5:"));
    assert!(change("P01.csv", ",first,false,", ",second,true,").unwrap_err().contains("trial 1"));
}

#[test]
fn what_cannot_be_written_whole_is_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f");
    let mut file = AppendFile::create(&path).unwrap();
    file.append(b"one\n").unwrap();
    // Somebody else's half line at the end, as a failed write leaves it.
    std::fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(b"ha").unwrap();
    let (mut file, torn) = AppendFile::recover(&path, Utc::now()).unwrap();
    assert_eq!(std::fs::read(torn.unwrap()).unwrap(), b"ha");
    file.append(b"two\n").unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"one\ntwo\n");
}

#[test]
fn a_new_file_takes_no_ones_place_and_leaves_nothing_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f");
    write_new(&path, b"one").unwrap();
    assert!(write_new(&path, b"two").is_err());
    assert_eq!(std::fs::read(&path).unwrap(), b"one");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Threads ask in the same microsecond now and then: one gets the name, the others hear that it is taken, and nothing of
/// theirs is left beside it.
#[test]
fn of_many_who_write_one_name_one_does() {
    let folder = tempfile::tempdir().unwrap();
    for round in 0..50 {
        let path = folder.path().join(format!("{round}.json"));
        let wrote: Vec<bool> = std::thread::scope(|scope| {
            let write = |i: u8| {
                let path = &path;
                scope.spawn(move || match write_new(path, &[b'0' + i; 100]) {
                    Ok(()) => true,
                    Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::AlreadyExists => false,
                    Err(other) => panic!("{other}"),
                })
            };
            let threads: Vec<_> = (0..8).map(write).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(wrote.iter().filter(|&&wrote| wrote).count(), 1);
        let winner = b'0' + wrote.iter().position(|&wrote| wrote).unwrap() as u8;
        assert_eq!(std::fs::read(&path).unwrap(), [winner; 100]);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 50);
}
