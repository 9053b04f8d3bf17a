//! From logs to what is said.

use analysis::exclude::Reason;
use analysis::plan::{Bound, Plan, Rules};
use analysis::report::words::Finding;
use analysis::report::{self, Options, Report};
use analysis::trial_log::{Interval, Phase, Sidecar, Trial};

use crate::logs::{critical, paper, practice, write};

fn of(rows: &[Trial], options: &Options) -> Report {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", rows);
    report::of_logs(&[log], options).unwrap()
}

/// A plan as a study would have it.
pub(crate) fn plan() -> Plan {
    Plan {
        study: "corridor".into(),
        alpha: 0.05,
        bound: Bound::from_proportion(0.2).unwrap(),
        rules: Rules { count_error: Some(4), duration_error_s: Some(0.05), ..Rules::default() },
        picture_s: 6.0,
        gap_s: 1.0,
        arms: vec![("HQ/CBQ".into(), 16), ("HQ/HQ".into(), 16)],
    }
}

#[test]
fn the_paper_s_counts() {
    let report = of(&paper(), &Options::default());
    assert!(!report.simulated);
    let arm = &report.arms[0];
    assert_eq!((arm.arm.as_str(), arm.n, arm.correct), ("HQ/CBQ", 16, Some(9)));
    let chi = arm.tests.chi_square.unwrap();
    assert_eq!((chi.statistic, chi.df), (0.25, 1));
    assert!((chi.p - 0.6171).abs() < 5e-5);
    assert_eq!(arm.verdict.finding, Finding::Undecided);
    let alike = &report.arms[1];
    assert_eq!((alike.arm.as_str(), alike.n, alike.correct), ("HQ/HQ", 16, None));
    assert!(alike.tests.chi_square.is_none());
    let second = alike.second_chosen.as_ref().unwrap();
    assert_eq!((second.k, second.n, second.tests.chi_square.unwrap().statistic), (8, 16, 0.0));
    assert_eq!((alike.layout_chosen[0].layout.as_str(), alike.layout_chosen[0].chosen.k), ("a", 8));
}

#[test]
fn json_has_the_shape_that_programs_rely_on() {
    let json: serde_json::Value = serde_json::from_str(&of(&paper(), &Options::default()).to_json()).unwrap();
    assert_eq!(json["simulated"], false);
    let arm = &json["arms"][0];
    assert_eq!((&arm["arm"], &arm["n"], &arm["correct"]), (&"HQ/CBQ".into(), &16.into(), &9.into()));
    assert_eq!(arm["proportion"], 0.5625);
    assert_eq!((&arm["chi_square"]["statistic"], &arm["chi_square"]["df"]), (&0.25.into(), &1.into()));
    assert!(arm["chi_square"]["log10_p"].as_f64().unwrap() < 0.0);
    assert!((arm["binomial"]["p"].as_f64().unwrap() - 0.8036).abs() < 5e-5);
    assert!((arm["intervals"]["clopper_pearson"][0].as_f64().unwrap() - 0.299).abs() < 5e-4);
    assert!((arm["intervals"]["wilson"][1].as_f64().unwrap() - 0.769).abs() < 5e-4);
    assert!(json["exclusions"].as_array().unwrap().is_empty());
    assert_eq!(json["provenance"]["study"], "corridor");
    let alike = &json["arms"][1];
    assert!(alike["correct"].is_null() && alike["chi_square"].is_null());
    assert_eq!(alike["second_chosen"]["chi_square"]["statistic"], 0.0);
}

#[test]
fn exclusions_are_data_and_results_are_given_both_ways() {
    let mut rows = paper();
    rows[0].interrupted = true;
    rows[0].interrupt_reason = "fire drill".into();
    rows[2].second_count_answer = Some(20);
    rows[4].first_duration_s = Some(6.2);
    rows.push(Trial {
        phase: Phase::Check,
        trial: 3,
        worse_answer: None,
        correct: None,
        known_task: Some(true),
        ..rows[31].clone()
    });
    rows.push(practice(99));
    let twice = Trial { session_id: "s-again".into(), ..critical(5) };
    rows.push(twice);
    let report = of(&rows, &Options { plan: Some(plan()), ..Options::default() });
    let reasons: Vec<Reason> = report.exclusions.iter().map(|excluded| excluded.reason).collect();
    assert_eq!(
        reasons,
        [
            Reason::Interrupted,
            Reason::Count,
            Reason::Duration,
            Reason::KnewTask,
            Reason::NoCriticalAnswer,
            Reason::RepeatedParticipant
        ]
    );
    assert_eq!(report.exclusions[0].detail, "fire drill");
    assert_eq!(report.exclusions[1].line, 4);
    assert_eq!((report.flow.sessions, report.flow.analysed), (34, 28));
    assert_eq!((report.arms[0].n, report.arms[0].correct), (13, Some(6)));
    assert_eq!((report.without_exclusions[0].n, report.without_exclusions[0].correct), (17, Some(10)));
    assert_eq!(report.arms[1].n, 15);
}

#[test]
fn turning_every_answer_excludes_the_same_people() {
    let mut rows = paper();
    rows[3].second_count_answer = Some(20);
    rows[7].interrupted = true;
    let turned: Vec<Trial> =
        rows.iter().map(|row| crate::logs::answered(row.clone(), row.worse_answer.unwrap().other())).collect();
    let options = Options { plan: Some(plan()), ..Options::default() };
    let excluded = |rows: &[Trial]| -> Vec<(String, Reason)> {
        let exclusions = of(rows, &options).exclusions;
        exclusions.into_iter().map(|excluded| (excluded.session_id, excluded.reason)).collect()
    };
    assert_eq!(excluded(&rows).len(), 2);
    assert_eq!(excluded(&rows), excluded(&turned));
}

#[test]
fn later_trials_are_not_counted_as_people() {
    let mut rows = vec![practice(1), critical(1)];
    for trial in 3..20 {
        rows.push(Trial { phase: Phase::Informed, trial, ..critical(1) });
    }
    assert_eq!(of(&rows, &Options::default()).arms[0].n, 1);
}

#[test]
fn simulated_reports_say_so() {
    let rows: Vec<Trial> = paper().into_iter().map(|row| Trial { simulated: true, demo: true, ..row }).collect();
    let report = of(&rows, &Options::default());
    assert!(report.simulated);
    assert!(report.title().ends_with("what simulated observers answered"), "{}", report.title());
    for text in [report.to_markdown(), report.to_html()] {
        assert!(text.contains("Simulated observers answered") && text.contains("A demonstration, not a study."));
    }
    assert!(!of(&paper(), &Options::default()).to_html().contains("Simulated"));
}

#[test]
fn a_plan_recorded_beforehand_leaves_no_deviation() {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", &paper());
    let options = Options { plan: Some(plan()), ..Options::default() };
    let deviations = || report::of_logs(std::slice::from_ref(&log), &options).unwrap().deviations;
    assert!(deviations()[0].contains("records no analysis plan"));
    let sidecar = |hash: String| Sidecar::new("log.csv", "corridor", "0.1.0", Some(hash)).to_json();
    std::fs::write(folder.path().join("log.json"), sidecar(plan().hash().to_string())).unwrap();
    assert!(deviations().is_empty());
    std::fs::write(folder.path().join("log.json"), sidecar("0".repeat(64))).unwrap();
    assert!(deviations()[0].contains("is not the one that"));
}

#[test]
fn names_are_text_in_every_format() {
    let evil = "<script>alert(1)</script>|*";
    let rows: Vec<Trial> = paper()
        .into_iter()
        .map(|row| Trial { arm: evil.into(), correct: None, second_quality: row.first_quality.clone(), ..row })
        .collect();
    let report = of(&rows, &Options::default());
    assert!(!report.to_html().contains("<script>"));
    assert!(report.to_markdown().contains("\\<script>"));
}

#[test]
fn answers_may_come_in_any_order_of_intervals() {
    let rows = [critical(1), crate::logs::answered(critical(2), Interval::First)];
    let report = of(&rows, &Options::default());
    assert_eq!(report.arms[0].second_chosen.as_ref().unwrap().k, 1);
}
