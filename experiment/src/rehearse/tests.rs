use std::path::Path;

use analysis::trial_log::{Interval, Phase, Reader, Trial as Row};
use stimuli::{Sha256, Study};

use super::*;
use crate::design::Plan;
use crate::enrol::{DataFolder, Kind};
use crate::example;
use crate::observer::Eye;
use crate::script;
use crate::session::Step;
use crate::trial::Trial;

fn rehearse(folder: &Path, study: &Study, participants: u32, eye: Eye, leaves: f64) -> Vec<Row> {
    let kind = Kind::Simulated { times: 1 };
    let data = DataFolder::open(folder, study, Sha256::of(b"pictures"), kind).unwrap();
    let mut rows = Vec::new();
    for i in 0..participants {
        let participant = format!("sim-{i:04}");
        let Ok(begun) = Conductor::begin(study, &data, &participant, NO_DISPLAY) else { break };
        let mut observer = Observer::new(eye.clone(), leaves, study.seed, &participant);
        let mut conductor = begun.conductor;
        run(&mut conductor, &mut observer, &mut Time::Jumps { now_s: 0.0 }, &mut |_| {}).unwrap();
        let folder = data.session_folder(&participant);
        let mut reader = Reader::open(&folder.join(format!("{participant}.csv"))).unwrap();
        let mut row = Row::default();
        while reader.read_into(&mut row).unwrap() {
            rows.push(row.clone());
        }
    }
    rows
}

#[test]
fn rows_are_the_planned_trials_and_say_that_they_are_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(4);
    let rows = rehearse(folder.path(), &study, 8, Eye::Guesser, 0.0);
    assert_eq!(rows.len(), 24);
    assert!(rows.iter().all(|row| row.simulated && !row.interrupted && row.refresh_hz.is_none()));
    for three in rows.chunks(3) {
        let phases: Vec<_> = three.iter().map(|row| row.phase).collect();
        assert_eq!(phases, [Phase::Practice, Phase::Critical, Phase::Check]);
        assert_eq!(three[0].worse_answer, None, "practice asks nothing about quality");
        assert_eq!((three[1].known_task, three[2].known_task), (None, Some(false)));
        let critical = &three[1];
        assert!((critical.first_duration_s.unwrap() - 6.0).abs() < 1e-9);
        assert_eq!(critical.correct.is_some(), critical.arm == "HQ/CBQ");
        assert_ne!(critical.first_layout, critical.second_layout);
    }
}

#[test]
fn the_same_seed_gives_the_same_answers() {
    let study = example::study(4);
    let answers = || {
        let folder = tempfile::tempdir().unwrap();
        let rows = rehearse(folder.path(), &study, 8, Eye::Threshold { sees: 0.5 }, 0.0);
        rows.into_iter().map(|row| (row.worse_answer, row.rt_s, row.first_count_answer)).collect::<Vec<_>>()
    };
    assert_eq!(answers(), answers());
}

/// A guesser is right in half of its trials, whatever the order: 400 trials, refused beyond 4.5 standard errors, which
/// happens to one fair guesser in 150,000; the seed is fixed.
#[test]
fn a_guesser_is_right_half_the_time_and_an_eagle_always() {
    let study = example::study(100);
    let right = |eye| {
        let folder = tempfile::tempdir().unwrap();
        let rows = rehearse(folder.path(), &study, 200, eye, 0.0);
        let checked = rows.iter().filter_map(|row| row.correct).collect::<Vec<_>>();
        (checked.iter().filter(|&&right| right).count(), checked.len())
    };
    let (guessed, of) = right(Eye::Guesser);
    assert!((guessed as f64 - of as f64 / 2.0).abs() < 4.5 * (of as f64 / 4.0).sqrt(), "{guessed} of {of}");
    let (seen, of) = right(Eye::Threshold { sees: 1.0 });
    assert_eq!(seen, of);
}

/// One JOD apart is told right three times in four, none half the time, and who always lapses guesses. 400 trials each,
/// within 4.5 standard errors: one right program in 150,000 would fail; the seeds are fixed.
#[test]
fn a_metrics_jod_are_proportions_correct() {
    let study = example::study(400);
    let right = |jod: f64, lapses: f64| {
        let eye = Eye::metric(&format!("{{\"a_cbq\": {jod}, \"b_cbq\": {jod}}}")).unwrap();
        let plan = Plan::draw(&study, 1);
        let mut answers = Vec::new();
        for slot in plan.slots.iter().filter(|slot| slot.arm == "HQ/CBQ") {
            let steps = script::steps(&study, slot);
            let critical = steps.iter().find_map(|step| match step {
                Step::Trial(trial) if trial.phase == Phase::Critical => Some(trial.clone()),
                _ => None,
            });
            let trial = Trial::new(critical.unwrap(), study.timing.clone());
            let code = format!("sim-{}", slot.number);
            let mut observer = Observer::new(eye.clone(), 0.0, 7, &code).lapsing(lapses);
            let Act::Press(keys) = observer.act(&Screen::Worse, Some(&trial)).act else { panic!() };
            let said = if keys == [Key::Digit(1)] { Interval::First } else { Interval::Second };
            answers.push(trial.plan().worse() == Some(said));
        }
        assert_eq!(answers.len(), 400);
        answers.iter().filter(|&&right| right).count() as f64 / 400.0
    };
    for (jod, lapses, expected) in [(0.0, 0.0, 0.5), (1.0, 0.0, 0.75), (2.0, 0.0, 0.911), (2.0, 1.0, 0.5)] {
        let found = right(jod, lapses);
        assert!((found - expected).abs() < 4.5 * (expected * (1.0 - expected) / 400.0_f64).sqrt(), "{jod}: {found}");
    }
    assert!(Eye::metric("{\"a\": -1}").is_err() && Eye::metric("[]").is_err());
}

#[test]
fn who_leaves_is_marked_and_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let study = example::study(4);
    let rows = rehearse(folder.path(), &study, 30, Eye::Guesser, 0.1);
    let complete = rows.iter().filter(|row| row.phase == Phase::Check).count();
    assert_eq!(complete, 8, "the plan is full");
    let started: std::collections::BTreeSet<_> = rows.iter().map(|row| &row.participant).collect();
    assert!(started.len() > 8, "somebody left");
}
