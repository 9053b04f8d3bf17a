use std::collections::BTreeSet;

use super::*;
use crate::draw::Draws;
use crate::example;

fn open(folder: &Path, study: &Study, kind: Kind) -> Result<DataFolder> {
    DataFolder::open(folder, study, Sha256::of(b"pictures"), kind)
}

#[test]
fn a_folder_belongs_to_one_plan_one_set_of_pictures_and_one_kind() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(4);
    open(folder.path(), &study, Kind::Real).unwrap();
    open(folder.path(), &study, Kind::Real).unwrap();
    let simulated = Kind::Simulated { times: 1 };
    assert!(open(folder.path(), &study, simulated).unwrap_err().to_string().contains("never mixed"));
    let other = Study { seed: 1, ..study.clone() };
    assert!(open(folder.path(), &other, Kind::Real).unwrap_err().to_string().contains("changed"));
    let pictures = DataFolder::open(folder.path(), &study, Sha256::of(b"others"), Kind::Real);
    assert!(pictures.unwrap_err().to_string().contains("pictures"));
}

#[test]
fn the_plans_record_tells_totals_and_no_sequence() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(4);
    let data = open(folder.path(), &study, Kind::Real).unwrap();
    let text = std::fs::read_to_string(folder.path().join("plan.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(record["plan_hash"], data.plan().hash().to_string());
    assert_eq!(record["slots"], 8);
    assert_eq!(record["cells"].as_array().unwrap().len(), 6);
    assert!(record.as_object().unwrap().keys().all(|key| !key.contains("sequence")));
}

#[test]
fn every_code_gets_a_slot_of_its_own_until_all_are_taken() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(2);
    let data = open(folder.path(), &study, Kind::Real).unwrap();
    for i in 1..=4 {
        assert_eq!(data.enrol(&format!("P{i}")).unwrap().slot.number, i);
    }
    assert!(data.enrol("P1").unwrap_err().to_string().contains("--resume"));
    assert!(data.enrol("P5").unwrap_err().to_string().contains("complete"));
    assert!(!data.session_folder("P5").exists(), "a code that got no slot stays free");
    let third = data.claimed_by("P3").unwrap().unwrap();
    data.give_back(&third, "declined").unwrap();
    data.give_back(&third, "declined").unwrap();
    let again = data.enrol("P5").unwrap();
    assert_eq!((again.slot.number, again.generation), (3, 2));
    assert_eq!(data.claimed_by("P5").unwrap(), Some(again));
    assert_eq!(data.claimed_by("P9").unwrap(), None);
}

#[test]
fn many_at_once_get_one_slot_each() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(8);
    let slots: Vec<u32> = std::thread::scope(|scope| {
        let start = |i: u32| {
            let (folder, study) = (folder.path(), &study);
            scope.spawn(move || open(folder, study, Kind::Real).unwrap().enrol(&format!("P{i}")).unwrap().slot.number)
        };
        let started: Vec<_> = (0..16).map(start).collect();
        started.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(slots.iter().collect::<BTreeSet<_>>().len(), 16);
}

#[test]
fn one_code_started_many_times_at_once_has_one_session() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(8);
    let got: Vec<bool> = std::thread::scope(|scope| {
        let started: Vec<_> = (0..16)
            .map(|_| scope.spawn(|| open(folder.path(), &study, Kind::Real).unwrap().enrol("P1").is_ok()))
            .collect();
        started.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(got.iter().filter(|&&got| got).count(), 1);
}

/// Participants who drop out give their slots back: the study ends with every slot used once, so its cells are the plan's.
#[test]
fn dropouts_leave_no_hole() {
    let study = example::study(4);
    let mut draws = Draws::new(1, "dropouts");
    let folder = tempfile::tempdir().unwrap();
    let data = open(folder.path(), &study, Kind::Real).unwrap();
    let mut completed = Vec::new();
    for i in 0.. {
        match data.enrol(&format!("P{i}")) {
            Ok(claimed) if draws.chance(0.2) => data.give_back(&claimed, "aborted").unwrap(),
            Ok(claimed) => completed.push(claimed.slot),
            Err(_) => break,
        }
    }
    completed.sort_by_key(|slot| slot.number);
    assert_eq!(completed, data.plan().slots);
}
