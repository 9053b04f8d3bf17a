//! The screens, driven without any graphics by what they say to assistive programs (AccessKit), in time that jumps.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::path::{Path, PathBuf};

use analysis::trial_log::{Interval, Reader, Trial as Row};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use experiment::app::{Desk, Errand, Exit, Launch, style};
use experiment::clock::Time;
use experiment::enrol::{DataFolder, Kind};
use experiment::session::Outcome;
use experiment::stimulus::Pictures;
use stimuli::Study;

/// A study on disk, its data folder, and a desk before it.
struct Lab {
    _folder: tempfile::TempDir,
    study: &'static Study,
    data: &'static DataFolder,
    at: PathBuf,
}

impl Lab {
    fn new(edit: impl FnOnce(String) -> String) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let short = |text: String| {
            text.replace("interval_s = 6.0", "interval_s = 0.3").replace("fixation_s = 1.0", "fixation_s = 0.2")
        };
        let study = support::write_study(&folder.path().join("study"), |text| edit(short(text)));
        // A harness wants what lives for ever; a test is short enough.
        let study: &'static Study = Box::leak(Box::new(study));
        let at = folder.path().join("data");
        let hash = Pictures::of(study).unwrap().hash().unwrap();
        let data = Box::leak(Box::new(DataFolder::open(&at, study, hash, Kind::Real).unwrap()));
        Self { _folder: folder, study, data, at }
    }

    fn desk(&self, allow_unverified: Option<&str>) -> Harness<'static, Desk<'static>> {
        let mut pictures = Vec::new();
        Pictures::of(self.study).unwrap().each(|picture| pictures.push(picture)).unwrap();
        let launch = Launch {
            study: self.study,
            data: Some(self.data),
            errand: Errand::Session,
            allow_unverified: allow_unverified.map(str::to_owned),
            graphics: false,
            pictures,
            participant: None,
            resume: false,
            speed: 1.0,
            monitor: None,
        };
        let app = |ui: &mut egui::Ui, desk: &mut Desk<'static>| {
            desk.begin_pass();
            desk.show(ui);
        };
        let builder = Harness::builder().with_size([1280.0, 1024.0]).with_context_setup(style);
        builder.allow_missing_glyphs().build_ui_state(app, Desk::new(launch, Time::Jumps { now_s: 0.0 }))
    }

    fn rows(&self, participant: &str) -> Vec<Row> {
        let log = self.at.join(format!("sessions/{participant}/{participant}.csv"));
        let (mut reader, mut row, mut rows) = (Reader::open(&log).unwrap(), Row::default(), Vec::new());
        while reader.read_into(&mut row).unwrap() {
            rows.push(row.clone());
        }
        rows
    }

    fn journal(&self, participant: &str) -> String {
        std::fs::read_to_string(self.at.join(format!("sessions/{participant}/{participant}.events.jsonl"))).unwrap()
    }
}

/// Everything that the screen says.
fn said(harness: &Harness<'_, Desk<'_>>) -> String {
    let nodes = harness.root().children_recursive();
    let words = nodes.map(|node| {
        let node = node.accesskit_node();
        format!("{} {}", node.label().unwrap_or_default(), node.value().unwrap_or_default())
    });
    words.collect::<Vec<_>>().join("\n")
}

/// Steps until the screen says `text`; `look` sees every screen on the way.
fn until(harness: &mut Harness<'_, Desk<'_>>, text: &str, look: &mut dyn FnMut(&str)) {
    for _ in 0..2000 {
        harness.step();
        let said = said(harness);
        look(&said);
        if said.contains(text) {
            harness.step(); // seen: now keys answer it
            return;
        }
    }
    panic!("`{text}` never came; there is: {}", said(harness));
}

fn press(harness: &mut Harness<'_, Desk<'_>>, keys: &[egui::Key]) {
    for &key in keys {
        harness.key_press(key);
        harness.step();
    }
}

fn fill(harness: &mut Harness<'_, Desk<'_>>, label: &str, text: &str) {
    harness.get_by_label(label).focus();
    harness.step();
    harness.get_by_label(label).type_text(text);
    harness.step();
}

fn set_up(harness: &mut Harness<'_, Desk<'_>>, look: &mut dyn FnMut(&str)) {
    until(harness, "Participant's code", look);
    fill(harness, "Participant's code (no name)", "P07");
    harness.get_by_label("Night light, HDR and colour management are off.").click();
    harness.step();
    press(harness, &[egui::Key::Enter]);
}

/// A whole session by labels and keys. Until the critical question no screen says anything about quality or rendering,
/// and none ever names an arm.
#[test]
fn a_session_by_its_labels_which_gives_nothing_away() {
    use egui::Key::{Enter, Num1, Num2, Num4, Space};
    let lab = Lab::new(|text| text);
    let mut harness = lab.desk(None);
    let mut naive = |said: &str| {
        let lower = said.to_lowercase();
        assert!(!["quality", "render", "cbq", "hq/", "squares on"].iter().any(|word| lower.contains(word)), "{said}");
    };
    set_up(&mut harness, &mut naive);
    until(&mut harness, "of my own free will", &mut naive);
    press(&mut harness, &[Num1]);
    until(&mut harness, "Count the fire safety items", &mut naive);
    press(&mut harness, &[Space]);
    until(&mut harness, "Two pictures to practise.", &mut naive);
    press(&mut harness, &[Space]);
    for name in ["Fixation mark", "Picture", "Even grey"] {
        until(&mut harness, name, &mut naive);
    }
    until(&mut harness, "in the first picture?", &mut naive);
    press(&mut harness, &[Num4, Enter]);
    until(&mut harness, "in the second picture?", &mut naive);
    press(&mut harness, &[Num2, Enter]);
    until(&mut harness, "Now the two pictures that count.", &mut naive);
    press(&mut harness, &[Space]);
    until(&mut harness, "in the first picture?", &mut naive);
    press(&mut harness, &[Num4, Enter]);
    until(&mut harness, "in the second picture?", &mut naive);
    press(&mut harness, &[Num1, Num2, Enter]);
    let mut blind = |said: &str| assert!(!["HQ/HQ", "HQ/CBQ"].iter().any(|arm| said.contains(arm)), "{said}");
    until(&mut harness, "worse rendering quality?", &mut blind);
    press(&mut harness, &[Num2]);
    until(&mut harness, "What did you notice?", &mut blind);
    harness.get_by_label("What did you notice?").type_text("a \"blue\" chair");
    harness.step();
    press(&mut harness, &[Enter]);
    until(&mut harness, "Did you know the purpose", &mut blind);
    press(&mut harness, &[Num2]);
    until(&mut harness, "One more pair.", &mut blind);
    press(&mut harness, &[Space]);
    until(&mut harness, "worse rendering quality?", &mut blind);
    press(&mut harness, &[Num1]);
    until(&mut harness, "Thank you.", &mut blind);
    press(&mut harness, &[Enter]);
    assert_eq!(harness.state().exit(), Some(Exit::Ended(Outcome::Completed)));

    let rows = lab.rows("P07");
    assert_eq!(rows.iter().map(|row| row.first_count_answer).collect::<Vec<_>>(), [Some(4), Some(4), None]);
    assert_eq!(rows.iter().map(|row| row.second_count_answer).collect::<Vec<_>>(), [Some(2), Some(12), None]);
    assert_eq!(rows[1].worse_answer, Some(Interval::Second));
    assert!(rows.iter().all(|row| !row.interrupted));
    let journal = lab.journal("P07");
    assert!(journal.contains(r#""text":"a \"blue\" chair""#), "{journal}");
    assert!(journal.contains(r#""ambient_lx":null"#), "what was not measured says so");
}

#[test]
fn the_set_up_says_what_is_wrong_and_loses_nothing() {
    let lab = Lab::new(|text| text);
    let mut harness = lab.desk(None);
    until(&mut harness, "Participant's code", &mut |_| {});
    press(&mut harness, &[egui::Key::Enter]);
    assert!(said(&harness).contains("cannot be a participant's code"));
    fill(&mut harness, "Participant's code (no name)", "P07");
    press(&mut harness, &[egui::Key::Enter]);
    assert!(said(&harness).contains("Confirm that night light"));
    harness.get_by_label("Night light, HDR and colour management are off.").click();
    fill(&mut harness, "Width of the picture on the display, mm", "16.9");
    fill(&mut harness, "From the eye to the display, mm", "700");
    press(&mut harness, &[egui::Key::Enter]);
    let there = said(&harness);
    assert!(there.contains("5 %") && there.contains("600 mm") && there.contains("P07"), "{there}");
    assert!(!lab.at.join("sessions/P07").exists(), "nothing was begun");
}

/// Without graphics nothing was measured: that is not verified either.
#[test]
fn a_main_study_refuses_an_unverified_display_unless_a_reason_is_logged() {
    let main = |text: String| text.replace("demo = true", "demo = false");
    let lab = Lab::new(main);
    let mut harness = lab.desk(None);
    until(&mut harness, "No session here", &mut |_| {});
    let why = said(&harness);
    assert!(why.contains("unverified") && why.contains("--allow-unverified"), "{why}");
    press(&mut harness, &[egui::Key::Enter]);
    assert!(matches!(harness.state().exit(), Some(Exit::Refused(_))));

    let mut harness = lab.desk(Some("pilot on the office machine"));
    set_up(&mut harness, &mut |_| {});
    until(&mut harness, "of my own free will", &mut |_| {});
    assert!(lab.journal("P07").contains(r#""allowed_unverified":"pilot on the office machine""#));
}

#[test]
fn texts_in_other_scripts_are_shown_or_refused_beforehand() {
    let say = |ready: &str| {
        let ready = format!("ready = \"{ready}\"");
        let lab = Lab::new(|text| text.replace("ready = \"Now the two pictures that count.\"", &ready));
        let mut harness = lab.desk(None);
        let mut stop = String::new();
        for _ in 0..200 {
            harness.step();
            stop = said(&harness);
            if stop.contains("No session here") || stop.contains("Participant's code") {
                break;
            }
        }
        stop
    };
    for drawn in [
        "Nun die zwei Bilder, die z\u{e4}hlen.",
        "\u{412}\u{43e}\u{442} \u{43e}\u{43d}\u{438}",
        "\u{3a4}\u{3ce}\u{3c1}\u{3b1}",
    ] {
        assert!(say(drawn).contains("Participant's code"), "{drawn}");
    }
    let refused = say("\u{73b0}\u{5728}");
    assert!(refused.contains("cannot draw") && refused.contains('\u{73b0}'), "{refused}");
}

/// An arm that looks freely counts nothing, and is asked about quality all the same.
#[test]
fn free_viewing_asks_for_no_count() {
    use egui::Key::{Num1, Space};
    let lab = Lab::new(|text| {
        let (start, end) = (text.find("[[arms]]").unwrap(), text.find("[[practice]]").unwrap());
        let free = "[wording.free]\ninstructions = \"Look.\"\npractice = \"Rehearse.\"\nready = \"Now look.\"\n\n\
                    [[arms]]\nname = \"free\"\nqualities = [\"HQ\", \"CBQ\"]\nn = 4\nviewing = \"free\"\n\n";
        format!("{}{free}{}", &text[..start], &text[end..])
    });
    let mut harness = lab.desk(None);
    set_up(&mut harness, &mut |_| {});
    until(&mut harness, "of my own free will", &mut |_| {});
    press(&mut harness, &[Num1]);
    for page in ["Look.", "Rehearse.", "Now look."] {
        until(&mut harness, page, &mut |said| assert!(!said.contains("How many"), "{said}"));
        press(&mut harness, &[Space]);
    }
    until(&mut harness, "worse rendering quality?", &mut |said| assert!(!said.contains("How many"), "{said}"));
    press(&mut harness, &[Num1]);
    until(&mut harness, "What did you notice?", &mut |_| {});
    let rows = lab.rows("P07");
    assert_eq!(rows.len(), 2);
    assert!(rows.iter().all(|row| row.first_count.is_none() && row.first_count_answer.is_none()));
    assert_eq!((rows[0].worse_answer, rows[1].worse_answer), (None, Some(Interval::First)));
}

/// A stone-dead folder is known at the set-up, before anybody sits down.
#[test]
fn a_folder_that_is_gone_is_said_at_the_set_up() {
    let lab = Lab::new(|text| text);
    let mut harness = lab.desk(None);
    until(&mut harness, "Participant's code", &mut |_| {});
    std::fs::remove_dir_all::<&Path>(lab.at.as_ref()).unwrap();
    fill(&mut harness, "Participant's code (no name)", "P07");
    harness.get_by_label("Night light, HDR and colour management are off.").click();
    harness.step();
    press(&mut harness, &[egui::Key::Enter]);
    assert!(said(&harness).contains("cannot be written there"), "{}", said(&harness));
}
