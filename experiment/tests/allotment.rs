//! Whole studies, simulated, in which people leave.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::collections::BTreeMap;

use analysis::trial_log::{Phase, Reader, Trial as Row};
use experiment::clock::Time;
use experiment::conduct::Conductor;
use experiment::enrol::{DataFolder, Kind};
use experiment::observer::{Eye, Observer};
use experiment::rehearse;
use experiment::session::Outcome;
use stimuli::{Sha256, Study};

/// Four pages of text, left at each with this probability: one participant in five.
const LEAVES: f64 = 0.0543;

/// Runs a study until its plan is full; gives how many left, and the critical rows of those who did not.
fn conduct(study: &Study) -> (u32, Vec<Row>) {
    let folder = tempfile::tempdir().unwrap();
    let data = DataFolder::open(folder.path(), study, Sha256::of(b"pictures"), Kind::Simulated { times: 1 }).unwrap();
    let (mut left, mut rows) = (0, Vec::new());
    for number in 1.. {
        let participant = format!("sim-{number:05}");
        let mut conductor = match Conductor::begin(study, &data, &participant, rehearse::NO_DISPLAY) {
            Ok(begun) => begun.conductor,
            Err(error) if error.to_string().contains("complete") => break,
            Err(error) => panic!("{error}"),
        };
        let mut observer = Observer::new(Eye::Guesser, LEAVES, study.seed, &participant);
        let mut time = Time::Jumps { now_s: 0.0 };
        if rehearse::run(&mut conductor, &mut observer, &mut time, &mut |_| {}).unwrap() != Outcome::Completed {
            left += 1;
            continue;
        }
        let log = data.session_folder(&participant).join(format!("{participant}.csv"));
        let (mut reader, mut row) = (Reader::open(&log).unwrap(), Row::default());
        while reader.read_into(&mut row).unwrap() {
            if row.phase == Phase::Critical {
                rows.push(row.clone());
            }
        }
    }
    (left, rows)
}

/// Whoever leaves, a study of 2 x 16 ends with 16 in each arm and with cells of order and layout that differ by one at most.
/// A count off in an arm leaves a participant out and gives the slot back as well, so more than those who left are replaced.
#[test]
fn studies_end_full_and_balanced() {
    let studies = support::times("SESSION_STUDIES", 4);
    let folder = tempfile::tempdir().unwrap();
    let shipped =
        support::write_study(folder.path(), |text| text.replace("max_count_error = 3", "max_count_error = 99"));
    let (mut left, mut all) = (0, 0);
    for seed in 0..studies {
        let study = Study { seed: u64::from(seed), ..shipped.clone() };
        let (gone, rows) = conduct(&study);
        (left, all) = (left + gone, all + gone + 32);
        let mut arms: BTreeMap<String, BTreeMap<(String, String), u32>> = BTreeMap::new();
        for row in rows {
            let cell = (row.first_stimulus, row.second_stimulus);
            *arms.entry(row.arm).or_default().entry(cell).or_insert(0) += 1;
        }
        assert_eq!(arms.len(), 2);
        for (arm, cells) in arms {
            let (planned, counts) = (if arm == "HQ/HQ" { 2 } else { 4 }, cells.values());
            assert_eq!((counts.clone().sum::<u32>(), cells.len()), (16, planned), "{arm} of study {seed}");
            assert!(counts.clone().max().unwrap() - counts.min().unwrap() <= 1, "{arm} of study {seed}: {cells:?}");
        }
    }
    assert!(left > 0);
    eprintln!("{studies} studies, {left} of {all} participants left");
}
