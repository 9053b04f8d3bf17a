//! Every sentence that a report can say is said by one of these reports, and every one of them is true of its numbers by the
//! tests beside the words themselves (`report/words/*.rs`), which hold the wording.
//!
//! The sentences are read from the program's own text, so that one that is added without a report that says it is noticed.

use analysis::pictures::Picture;
use analysis::plan::Plan;
use analysis::power::Question;
use analysis::proportion::Proportion;
use analysis::report::planning::{Planning, Request};
use analysis::report::{self, Options, Report};
use analysis::tally::ArmTally;
use analysis::trial_log::{Interval, OnsetSource, Phase, Sidecar, Trial, Vsync};
use stimuli::Sha256;

use crate::logs::{alike, answered, critical, paper, practice, swapped, write};
use crate::reports::plan;

/// The program text that has words for readers.
const SOURCES: [(&str, &str); 16] = [
    ("words/arm.rs", include_str!("../../src/report/words/arm.rs")),
    ("words/between.rs", include_str!("../../src/report/words/between.rs")),
    ("words/ladder.rs", include_str!("../../src/report/words/ladder.rs")),
    ("words/plan.rs", include_str!("../../src/report/words/plan.rs")),
    ("words/planning.rs", include_str!("../../src/report/words/planning.rs")),
    ("words/verdict.rs", include_str!("../../src/report/words/verdict.rs")),
    ("document.rs", include_str!("../../src/report/document.rs")),
    ("sources.rs", include_str!("../../src/report/sources.rs")),
    ("planning.rs", include_str!("../../src/report/planning.rs")),
    ("mod.rs", include_str!("../../src/report/mod.rs")),
    ("plot/curves.rs", include_str!("../../src/report/plot/curves.rs")),
    ("plot/flow.rs", include_str!("../../src/report/plot/flow.rs")),
    ("plot/intervals.rs", include_str!("../../src/report/plot/intervals.rs")),
    ("plot/ladder.rs", include_str!("../../src/report/plot/ladder.rs")),
    ("plot/timing.rs", include_str!("../../src/report/plot/timing.rs")),
    ("exclude.rs", include_str!("../../src/exclude.rs")),
];

/// The string literals of a source file before its tests, without comments and the reasons of `expect`.
fn literals(source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut characters = code.chars().peekable();
    let mut before = String::new();
    while let Some(character) = characters.next() {
        match character {
            '/' if characters.peek() == Some(&'/') => {
                for skipped in characters.by_ref() {
                    if skipped == '\n' {
                        break;
                    }
                }
            }
            '"' => {
                let text = literal(&mut characters);
                if !before.ends_with("expect(") {
                    found.push(text);
                }
                before.clear();
            }
            // Character literals may hold a quote.
            '\'' if matches!(characters.peek(), Some('"')) => {
                characters.next();
            }
            _ => before.push(character),
        }
    }
    found
}

fn literal(characters: &mut std::iter::Peekable<std::str::Chars<'_>>) -> String {
    let mut text = String::new();
    while let Some(character) = characters.next() {
        match character {
            '"' => break,
            '\\' => match characters.next() {
                Some('\n') => while characters.next_if(|next| next.is_whitespace()).is_some() {},
                Some('u') => {
                    let code: String = characters.by_ref().skip(1).take_while(|next| *next != '}').collect();
                    text.extend(u32::from_str_radix(&code, 16).ok().and_then(char::from_u32));
                }
                Some('n') => text.push('\n'),
                Some(other) => text.push(other),
                None => break,
            },
            other => text.push(other),
        }
    }
    text
}

/// The parts of a literal between its placeholders that are at least three words.
fn phrases(literal: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut inside = false;
    for character in literal.chars() {
        match character {
            '{' => {
                inside = true;
                parts.push(String::new());
            }
            '}' => inside = false,
            other if !inside => parts.last_mut().unwrap().push(other),
            _ => {}
        }
    }
    parts.retain(|part| part.split_whitespace().filter(|word| word.chars().any(char::is_alphabetic)).count() >= 3);
    parts.into_iter().map(|part| part.trim().to_owned()).collect()
}

/// A log of these rows beside a sidecar that records a plan, or none.
fn of(rows: &[Trial], recorded: Option<&Plan>, options: &Options) -> Report {
    let folder = tempfile::tempdir().unwrap();
    let log = write(folder.path(), "log.csv", rows);
    let sidecar = Sidecar::new("log.csv", "corridor", "0.1.0", recorded.map(|plan| plan.hash().to_string()));
    std::fs::write(folder.path().join("log.json"), sidecar.to_json()).unwrap();
    report::of_logs(&[log], options).unwrap()
}

fn planned(plan: Plan) -> Options {
    Options { plan: Some(plan), ..Options::default() }
}

/// `half` people of each order: `second` of them right where the lower quality came second, `first` where it came first.
fn orders(half: u32, second: u32, first: u32, start: u32) -> Vec<Trial> {
    let row = |i: u32| {
        let trial = if i < half { critical(start + i) } else { swapped(critical(start + i)) };
        let right = if i < half { i < second } else { i - half < first };
        let lower = trial.lower_quality().unwrap();
        answered(trial, if right { lower } else { lower.other() })
    };
    (0..2 * half).map(row).collect()
}

fn arm(rows: Vec<Trial>, name: &str) -> Vec<Trial> {
    rows.into_iter().map(|row| Trial { arm: name.into(), ..row }).collect()
}

fn people(plan: Plan, n: u32) -> Plan {
    Plan { arms: vec![("HQ/CBQ".into(), n)], ..plan }
}

/// Reports of logs: verdicts of every kind, exclusions of every kind, departures from the plan of every kind.
fn of_logs() -> Vec<Report> {
    let mut reports = vec![of(&[], None, &Options::default()), of(&paper(), None, &Options::default())];
    for (half, second, first) in
        [(100, 50, 50), (50, 50, 2), (1000, 550, 550), (1000, 450, 450), (8, 5, 4), (8, 3, 5), (8, 6, 6)]
    {
        let plan = people(plan(), 2 * half);
        let rows = orders(half, second, first, 0);
        reports.push(of(&rows, Some(&plan), &planned(plan.clone())));
        reports.push(of(&rows, None, &planned(plan)));
    }
    // One order alone; a tie of layouts; other names than planned.
    reports.push(of(&orders(8, 8, 0, 0)[..8], Some(&plan()), &planned(Plan { study: "cornell".into(), ..plan() })));
    let same_layout: Vec<Trial> =
        orders(4, 2, 2, 0).into_iter().map(|row| Trial { second_layout: row.first_layout.clone(), ..row }).collect();
    reports.push(of(&same_layout, Some(&people(plan(), 5)), &planned(plan())));
    let several =
        [arm(orders(8, 8, 8, 0), "free"), arm(orders(8, 4, 4, 20), "task"), arm(orders(8, 0, 0, 40), "other")];
    reports.push(of(&several.concat(), None, &Options::default()));
    reports.push(of(&(0..16).map(|id| alike(id, Interval::Second)).collect::<Vec<_>>(), None, &Options::default()));
    reports.push(of(&(0..16).map(|id| alike(id, Interval::First)).collect::<Vec<_>>(), None, &Options::default()));
    reports.push(excluded());
    reports.extend([after(true), after(false), very_many()]);
    reports
}

fn excluded() -> Report {
    let mut rows = paper();
    rows[0].interrupted = true;
    rows[0].interrupt_reason = "fire drill".into();
    rows[1].vsync = Vsync::Unverified;
    rows[2].second_count_answer = Some(20);
    rows[3].second_onset_s = Some(40.0);
    rows[4].first_duration_s = Some(6.2);
    rows[5].version = "0.2.0".into();
    rows[6].known_task = Some(true);
    rows.push(practice(99));
    rows.push(Trial { session_id: "again".into(), ..critical(5) });
    let mut plan = plan();
    plan.rules.unverified_display = true;
    plan.rules.onset_error_s = Some(0.05);
    let pictures = Some((vec![picture("CBQ", 1.0)], Sha256::of(b"")));
    of(&rows, Some(&plan), &Options { plan: Some(plan.clone()), pictures })
}

/// What comes after the critical trial, in a demonstration with simulated observers.
fn after(all_told: bool) -> Report {
    let mut rows = Vec::new();
    for id in 0..8 {
        let told = if id == 0 && !all_told { Interval::First } else { Interval::Second };
        rows.push(Trial { confidence: Some(1 + id as u8 % 4), ..critical(id) });
        rows.push(Trial { phase: Phase::Informed, trial: 3, ..critical(id) });
        rows.push(answered(Trial { phase: Phase::Check, trial: 4, ..critical(id) }, told));
    }
    for row in &mut rows {
        (row.simulated, row.demo, row.onset_source) = (true, true, OnsetSource::Estimated);
        (row.first_missed_frames, row.second_missed_frames) = (None, None);
        row.first_duration_s = Some(6.1);
    }
    let mut plan = plan();
    (plan.rules.interrupted, plan.rules.knew_task) = (false, false);
    (plan.rules.count_error, plan.rules.duration_error_s) = (None, None);
    of(&rows, None, &planned(plan))
}

/// More exclusions than are listed.
fn very_many() -> Report {
    let mut report = excluded();
    report.flow.excluded[0].1 += 20_000;
    report
}

fn picture(quality: &str, seconds: f64) -> Picture {
    Picture {
        id: format!("a_{quality}"),
        layout: "a".into(),
        quality: quality.into(),
        crex: "T{RSGM}".into(),
        rays: vec![("primary".into(), 1000)],
        cost: Some((seconds, 2)),
        sha256: "00".repeat(32),
        thumbnail: None,
    }
}

/// Ladders: one that fits, one that does not, one of three steps, one that brackets nothing.
pub(crate) fn ladders() -> Vec<Report> {
    let ladder = |right: &[u32]| {
        let mut rows = Vec::new();
        let mut pictures = vec![picture("HQ", 100.0)];
        for (i, right) in right.iter().enumerate() {
            let quality = format!("Q{i}");
            pictures.push(picture(&quality, 2.0_f64.powi(i as i32)));
            for row in arm(orders(50, *right, *right, 1000 * i as u32), &format!("HQ/{quality}")) {
                let named = |name: &String| if name == "CBQ" { quality.clone() } else { name.clone() };
                rows.push(Trial {
                    first_quality: named(&row.first_quality),
                    second_quality: named(&row.second_quality),
                    ..row
                });
            }
        }
        of(&rows, None, &Options { plan: None, pictures: Some((pictures, Sha256::of(b""))) })
    };
    vec![ladder(&[50, 47, 38, 28, 25]), ladder(&[50, 25, 50, 25, 50, 25]), ladder(&[46, 36, 26]), ladder(&[25; 5])]
}

fn of_counts() -> Vec<Report> {
    let told = |k, n| ("told".to_owned(), ArmTally::of_correct(Proportion { k, n }));
    let mut reports = Vec::new();
    for (k, n) in
        [(0, 0), (1, 3), (4, 6), (9, 16), (16, 16), (1, 16), (11, 16), (50, 100), (500_000_001, 1_000_000_000)]
    {
        for options in [Options::default(), planned(plan())] {
            reports.push(report::of_counts(&[told(k, n)], vec!["told=..".into()], &options));
        }
    }
    let two = [
        told(900_000_000, 1_000_000_000),
        ("task".to_owned(), ArmTally::of_correct(Proportion { k: 1, n: 1_000_000_000 })),
    ];
    reports.push(report::of_counts(&two, Vec::new(), &Options::default()));
    let none = [("alike".to_owned(), ArmTally::of_second_chosen(Proportion::default()))];
    reports.push(report::of_counts(&none, Vec::new(), &Options::default()));
    reports
}

fn plannings() -> Vec<Planning> {
    let asks = [
        (Question::Superiority { truth: 0.75 }, Some(16)),
        (Question::Superiority { truth: 0.5001 }, Some(4)),
        (Question::Equivalence { truth: 0.5, bound: 0.2 }, None),
    ];
    asks.map(|(question, n)| Planning::new(&Request { question, targets: vec![0.8, 0.9], alpha: 0.05, n })).to_vec()
}

#[test]
fn every_sentence_is_said_by_some_report() {
    let reports: Vec<Report> = [of_logs(), ladders(), of_counts()].concat();
    let mut said: Vec<String> = reports.iter().map(Report::to_markdown).collect();
    said.extend(plannings().iter().map(Planning::to_markdown));
    // Drawings have words of their own.
    said.extend(reports.iter().map(Report::to_html));
    let said: Vec<String> = said.into_iter().map(|text| plain(&text)).collect();
    let mut silent = Vec::new();
    let mut phrases_found = 0;
    for (file, source) in SOURCES {
        for literal in literals(source) {
            for phrase in phrases(&literal) {
                phrases_found += 1;
                if !said.iter().any(|text| text.contains(&plain(&phrase))) {
                    silent.push(format!("{file}: {phrase}"));
                }
            }
        }
    }
    assert!(phrases_found > 120, "the sentences are found: {phrases_found}");
    assert!(silent.is_empty(), "said by no report:\n{}", silent.join("\n"));
}

/// Text without what the formats add.
fn plain(text: &str) -> String {
    let text = text.replace('\\', "").replace('\u{a0}', " ").replace("&#39;", "'").replace("&quot;", "\"");
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

#[test]
fn literals_are_read_as_the_compiler_reads_them() {
    let source = "// \"no\"\nsay(\"one {x} two three four\", \"a \\\n    b\"); x.expect(\"not this\");\n#[cfg(test)] \"nor this\"";
    assert_eq!(literals(source), ["one {x} two three four", "a b"]);
    assert_eq!(phrases("one {x} two three four"), ["two three four"]);
}
