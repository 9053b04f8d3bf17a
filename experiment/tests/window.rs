//! A real window under Xvfb and openbox, its keys pressed by xdotool. Where one of them or setxkbmap is not
//! installed the tests show as ignored.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "support/lab.rs"]
mod lab;
mod support;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use analysis::trial_log::{Interval, OnsetSource, Phase, Reader, Trial as Row, Vsync};
use experiment::log::read_journal;
use image::RgbImage;
use lab::Screen;
use libtest_mimic::{Arguments, Failed, Trial};
use stimuli::Study;
use tempfile::TempDir;

const NEEDED: [&str; 4] = ["Xvfb", "openbox", "xdotool", "setxkbmap"];

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(1); // they share a processor that also has to draw
    let missing = NEEDED.iter().any(|program| !is_installed(program));
    let trials = vec![
        Trial::test("a_session_by_keyboard_in_a_window", by_keyboard),
        Trial::test("one_escape_and_a_close_button_end_nothing", undisturbed),
        Trial::test("keys_that_come_early_answer_nothing", early_keys),
        Trial::test("the_same_key_is_the_same_answer_under_every_layout", layouts),
        Trial::test("every_pixel_shown_is_the_files", pixels),
        Trial::test("programs_answer_in_the_window_and_the_report_is_made", rehearsal),
        Trial::test("what_an_unverified_display_is_fit_for", self_test),
        Trial::test("a_picture_larger_than_the_screen_is_refused", too_large),
    ];
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(missing)).collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn is_installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Waits for something that a busy machine may take long for.
fn until(what: &str, mut is_so: impl FnMut() -> bool) -> Result<(), Failed> {
    let start = Instant::now();
    while !is_so() {
        if start.elapsed() > Duration::from_secs(120) {
            return Err(format!("not within two minutes: {what}").into());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(())
}

fn log(data: &Path) -> PathBuf {
    data.join("sessions/P01/P01.csv")
}

fn journal(data: &Path) -> String {
    std::fs::read_to_string(data.join("sessions/P01/P01.events.jsonl")).unwrap_or_default()
}

fn rows(data: &Path) -> Vec<Row> {
    let mut reader = Reader::open(&log(data)).unwrap();
    let (mut row, mut rows) = (Row::default(), Vec::new());
    while reader.read_into(&mut row).unwrap() {
        rows.push(row.clone());
    }
    rows
}

/// Presses a key again and again until the journal tells that it was understood. Only for keys that do no harm on the next
/// screen.
fn press_until(screen: &Screen, key: &str, data: &Path, event: &str, times: usize) -> Result<(), Failed> {
    until(&format!("`{event}` in the journal"), || {
        screen.key(key);
        std::thread::sleep(Duration::from_millis(200));
        journal(data).matches(event).count() >= times
    })
}

/// Short pictures, so that a test takes seconds; one of the arms alone, so that it knows what is shown.
fn short(text: String) -> String {
    let arms = text.find("[[arms]]").unwrap();
    let practice = text.find("[[practice]]").unwrap();
    let arm = "[[arms]]\nname = \"HQ/CBQ\"\nqualities = [\"HQ\", \"CBQ\"]\nn = 4\n\n";
    format!("{}{arm}{}", &text[..arms], &text[practice..])
        .replace("fixation_s = 1.0", "fixation_s = 0.4")
        .replace("interval_s = 6.0", "interval_s = 1.5")
}

/// A folder that is removed when it is dropped, a study and a place for data in it, and a screen.
fn laboratory(size: &str, alter: impl Fn(String) -> String) -> (TempDir, PathBuf, PathBuf, Screen) {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, alter);
    (folder, study, data, Screen::new(size))
}

/// Confirms the set-up: one field after the other by Tab, then the box, then Enter.
fn set_up(screen: &Screen, data: &Path) -> Result<(), Failed> {
    until("the set-up takes a confirmation", || {
        // Escape leaves whatever has the focus, and the code's field takes it; backwards from there: the button, the box.
        for key in ["Escape", "shift+Tab", "shift+Tab", "space", "Return"] {
            std::thread::sleep(Duration::from_millis(300));
            screen.key(key);
        }
        std::thread::sleep(Duration::from_millis(500));
        journal(data).contains("\"conditions\"")
    })
}

fn by_keyboard() -> Result<(), Failed> {
    let (_folder, study, data, screen) = laboratory("1024x768", short);
    let mut program = screen.session(&study, &data);
    std::thread::sleep(Duration::from_secs(2));
    set_up(&screen, &data)?;
    press_until(&screen, "1", &data, "\"consent\"", 1)?;
    press_until(&screen, "space", &data, "\"pair_starts\"", 1)?;
    // The counts: digits and Enter, until the row is there. Keys during the pictures do nothing.
    until("the practice row", || {
        screen.xdotool(&["key", "--delay", "150", "4", "Return"]);
        rows(&data).len() == 1
    })?;
    press_until(&screen, "space", &data, "\"pair_starts\"", 2)?;
    until("the critical row", || {
        screen.xdotool(&["key", "--delay", "150", "KP_3", "Return"]);
        screen.key("2");
        rows(&data).len() == 2
    })?;
    until("what was noticed", || {
        screen.xdotool(&["key", "--delay", "100", "n", "o", "Return"]);
        std::thread::sleep(Duration::from_millis(300));
        journal(&data).contains("\"noticed\"")
    })?;
    press_until(&screen, "2", &data, "\"known_task\"", 1)?;
    press_until(&screen, "space", &data, "\"pair_starts\"", 3)?;
    press_until(&screen, "1", &data, "\"ended\"", 1)?;
    until("the window closes", || {
        screen.key("Return");
        program.0.try_wait().unwrap().is_some_and(|status| status.success())
    })?;
    let rows = rows(&data);
    assert_eq!(rows.iter().map(|row| row.phase).collect::<Vec<_>>(), [Phase::Practice, Phase::Critical, Phase::Check]);
    let critical = &rows[1];
    assert!(!critical.simulated && !critical.interrupted && critical.demo);
    assert_eq!((critical.vsync, critical.refresh_hz), (Vsync::Unverified, None));
    assert_eq!(critical.onset_source, OnsetSource::SwapReturn);
    assert_eq!(critical.worse_answer, Some(Interval::Second));
    assert_eq!(critical.correct, Some(critical.second_quality == "CBQ"));
    for row in &rows {
        assert!(row.first_onset_s < row.second_onset_s);
        for duration in [row.first_duration_s, row.second_duration_s] {
            assert!(duration.is_some_and(|duration| duration > 0.0));
        }
        assert!(row.first_max_frame_ms.is_some() && row.first_missed_frames.is_some());
    }
    Ok(())
}

/// During a picture: Escape, the keyboard taken by another window, the window manager's close, and a stop of 1.5 s.
fn undisturbed() -> Result<(), Failed> {
    let (_folder, study, data, screen) =
        laboratory("1024x768", |text| short(text).replace("interval_s = 1.5", "interval_s = 4.0"));
    let mut program = screen.session(&study, &data);
    std::thread::sleep(Duration::from_secs(2));
    set_up(&screen, &data)?;
    press_until(&screen, "1", &data, "\"consent\"", 1)?;
    press_until(&screen, "space", &data, "\"pair_starts\"", 1)?;
    std::thread::sleep(Duration::from_secs(1));
    screen.key("Escape");
    screen.key("alt+F4");
    screen.steal_focus();
    let pid = program.0.id().to_string();
    let signal = |name: &str| assert!(Command::new("kill").args([name, &pid]).status().unwrap().success());
    signal("-STOP");
    std::thread::sleep(Duration::from_millis(1500)); // as a machine that sleeps, within a picture of 4 s
    signal("-CONT");
    until("the practice row", || {
        screen.xdotool(&["key", "--delay", "150", "4", "Return"]);
        rows(&data).len() == 1
    })?;
    assert_eq!(program.0.try_wait().unwrap(), None, "the session goes on");
    let reasons = rows(&data)[0].interrupt_reason.clone();
    assert!(reasons.contains("escape") && reasons.contains("close_requested"), "{reasons}");
    assert!(reasons.contains("focus_lost") && reasons.contains("suspended"), "{reasons}");
    let missed = rows(&data)[0].first_missed_frames.unwrap() + rows(&data)[0].second_missed_frames.unwrap();
    assert!(missed > 0, "a frame of 1.5 s is flagged in its row");
    // The experimenter's two steps: Escape held, then F10.
    screen.xdotool(&["keydown", "Escape"]);
    std::thread::sleep(Duration::from_secs(3));
    screen.xdotool(&["keyup", "Escape"]);
    let pressed = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64();
    press_until(&screen, "F10", &data, "\"aborted\"", 1)?;
    let last = read_journal(&log(&data).with_extension("events.jsonl")).unwrap().pop().unwrap();
    eprintln!("the abort was on the disk {:.0} ms after its key", last.unix_us as f64 * 1e-3 - pressed * 1e3);
    until("the window closes", || {
        screen.key("Return");
        program.0.try_wait().unwrap().is_some()
    })?;
    let back = std::fs::read_to_string(data.join("slots/0001-1.back.json")).unwrap();
    assert!(back.contains("aborted"), "{back}");
    Ok(())
}

/// To the first question after the practice pictures.
fn to_practice(screen: &Screen, data: &Path) -> Result<(), Failed> {
    std::thread::sleep(Duration::from_secs(2));
    set_up(screen, data)?;
    press_until(screen, "1", data, "\"consent\"", 1)?;
    press_until(screen, "space", data, "\"pair_starts\"", 1)
}

/// Digits, Enter, space and backspace in great number while the pictures are shown: none of them is in the answers.
fn early_keys() -> Result<(), Failed> {
    let (_folder, study, data, screen) =
        laboratory("1024x768", |text| short(text).replace("interval_s = 1.5", "interval_s = 4.0"));
    let mut program = screen.session(&study, &data);
    to_practice(&screen, &data)?;
    let start = Instant::now();
    let mut pressed = 0;
    // Fixation .4 s, two pictures of 4 s, a gap of .5 s between them: 8.9 s in all, and the keys end well before.
    while pressed < 500 && start.elapsed() < Duration::from_millis(7500) {
        screen.xdotool(&[
            "key",
            "--delay",
            "3",
            "7",
            "Return",
            "9",
            "space",
            "BackSpace",
            "1",
            "2",
            "KP_8",
            "Return",
            "5",
        ]);
        pressed += 10;
    }
    assert!(pressed >= support::times("SESSION_KEYS", 100), "only {pressed} keys in time");
    std::thread::sleep(Duration::from_secs(10).saturating_sub(start.elapsed()));
    until("the practice row", || {
        screen.xdotool(&["key", "--delay", "150", "4", "Return"]);
        rows(&data).len() == 1
    })?;
    let row = &rows(&data)[0];
    assert_eq!((row.first_count_answer, row.second_count_answer), (Some(4), Some(4)));
    assert!(!row.interrupted, "{}", row.interrupt_reason);
    assert_eq!(program.0.try_wait().unwrap(), None);
    eprintln!("{pressed} early keys, none accepted");
    Ok(())
}

/// Keys by their codes: 10 is the key that is 1 on an American keyboard, 11 the next, 13 the fourth, 36 Enter, 65 space.
fn layouts() -> Result<(), Failed> {
    let (_folder, study, data, screen) = laboratory("1024x768", short);
    let _program = screen.session(&study, &data);
    let layout = |name: &str| {
        assert!(Command::new("setxkbmap").env("DISPLAY", &screen.name).arg(name).status().unwrap().success());
        std::thread::sleep(Duration::from_millis(400));
    };
    std::thread::sleep(Duration::from_secs(2));
    set_up(&screen, &data)?;
    layout("fr");
    press_until(&screen, "10", &data, "\"consent\"", 1)?;
    press_until(&screen, "65", &data, "\"pair_starts\"", 1)?;
    until("the practice row", || {
        screen.xdotool(&["key", "--delay", "150", "13", "36"]); // the row ' of a French keyboard
        rows(&data).len() == 1
    })?;
    press_until(&screen, "65", &data, "\"pair_starts\"", 2)?;
    layout("de");
    std::thread::sleep(Duration::from_secs(5)); // the pictures
    screen.xdotool(&["key", "--delay", "300", "13", "36"]);
    layout("ru");
    screen.xdotool(&["key", "--delay", "300", "13", "36"]);
    until("the critical row", || {
        screen.xdotool(&["key", "11"]);
        std::thread::sleep(Duration::from_millis(300));
        rows(&data).len() == 2
    })?;
    layout("us");
    until("what was noticed", || {
        screen.xdotool(&["key", "--delay", "100", "57", "36"]);
        std::thread::sleep(Duration::from_millis(300));
        journal(&data).contains("\"noticed\"")
    })?;
    press_until(&screen, "11", &data, "\"known_task\"", 1)?;
    let rows = rows(&data);
    for row in &rows {
        assert_eq!((row.first_count_answer, row.second_count_answer), (Some(4), Some(4)), "{:?}", row.phase);
    }
    assert_eq!(rows[1].worse_answer, Some(Interval::Second));
    assert!(journal(&data).contains("\"known\":false"));
    Ok(())
}

/// At every scale: whatever is in the middle of the screen while programs answer is grey, text, or a picture's file to the
/// last byte; and every picture is seen. `SESSION_STUDY` names another study than the generated one,
/// and `SESSION_BOTS=4` shows the pictures of every cell.
fn pixels() -> Result<(), Failed> {
    for scale in ["1", "1.25", "1.5", "2"] {
        let folder = tempfile::tempdir().unwrap();
        let (generated, data) = (folder.path().join("study"), folder.path().join("data"));
        let study = match std::env::var("SESSION_STUDY") {
            Ok(path) => Study::load(Path::new(&path)).unwrap(),
            Err(_) => support::write_study(&generated, |text| {
                short(text).replace("width_px = 64", "width_px = 403").replace("height_px = 48", "height_px = 301")
            }),
        };
        let display = &study.display;
        let screen = Screen::new(&format!("{}x{}", display.width_px + 237, display.height_px + 179));
        let mut wanted: Vec<(String, RgbImage, u32)> = Vec::new();
        for stimulus in study.stimuli() {
            let file = study.folder.join(stimulus.file());
            wanted.push((stimulus.id(), image::open(file).unwrap().into_rgb8(), 0));
        }
        let bots = support::times("SESSION_BOTS", 1).to_string();
        let run = ["--simulate", &bots, "--window", "--speed", "4"];
        let mut program = screen.scaled(scale, &study.folder, &data, &run);
        let mut torn = 0;
        until("the rehearsal ends", || {
            let shot = screen.capture();
            let middle = |side: u32, of: u32| (of - side) / 2;
            let (left, top) = (middle(display.width_px, shot.width()), middle(display.height_px, shot.height()));
            let shown = image::imageops::crop_imm(&shot, left, top, display.width_px, display.height_px).to_image();
            let mut best = usize::MAX;
            for (_, picture, times) in &mut wanted {
                let differing = shown.as_raw().iter().zip(picture.as_raw()).filter(|(a, b)| a != b).count();
                *times += u32::from(differing == 0);
                best = best.min(differing);
            }
            // More than half of it a picture's, and not all: that picture was drawn wrongly.
            torn += u32::from(best > 0 && best < shown.as_raw().len() / 2);
            std::thread::sleep(Duration::from_millis(30));
            program.0.try_wait().unwrap().is_some()
        })?;
        assert!(program.0.wait().unwrap().success());
        let journal = std::fs::read_to_string(data.join("sessions/sim-00001/sim-00001.events.jsonl")).unwrap();
        assert!(
            journal.contains("\"differing_bytes\":0") && journal.contains(&format!("\"scale\":{scale}")),
            "{journal}"
        );
        let seen: Vec<_> = wanted.iter().filter(|(_, _, times)| *times > 0).map(|(id, ..)| id.as_str()).collect();
        assert_eq!(torn, 0, "at scale {scale}");
        assert!(seen.len() >= 4, "at scale {scale} only {seen:?} were seen to the last byte");
        eprintln!(
            "scale {scale}: {} pictures read back by the program, {} seen from outside: 0 bytes differ",
            wanted.len(),
            seen.len()
        );
    }
    Ok(())
}

/// Programs in the real window at scaled time, and the report: `SESSION_BOTS=32` is the whole study.
fn rehearsal() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    let bots = support::times("SESSION_BOTS", 2);
    support::write_study(&study, |text| text);
    let screen = Screen::new("640x480");
    let many = bots.to_string();
    let start = Instant::now();
    let mut program =
        screen.program(&study, &data, &["--simulate", &many, "--window", "--speed", "60", "--lapses", "0.05"]);
    while program.0.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(200));
        assert!(start.elapsed() < Duration::from_secs(3600));
    }
    assert!(program.0.wait().unwrap().success());
    let report = std::fs::read_to_string(data.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["simulated"], true);
    assert!(data.join("report.html").is_file());
    let sessions = std::fs::read_dir(data.join("sessions")).unwrap().count();
    assert_eq!(sessions, bots as usize);
    eprintln!("{bots} programs answered in the window within {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// What a session says that ends before anybody sits down.
fn refused(screen: &Screen, study: &Path, data: &Path) -> Result<String, Failed> {
    let mut program = screen.session(study, data);
    until("the program ends", || {
        screen.key("Return");
        std::thread::sleep(Duration::from_millis(200));
        program.0.try_wait().unwrap().is_some()
    })?;
    assert_eq!(program.0.wait().unwrap().code(), Some(1));
    Ok(std::io::read_to_string(program.0.stderr.take().unwrap()).unwrap())
}

/// Xvfb paces nothing: the self-test says so, and a main study refuses.
fn self_test() -> Result<(), Failed> {
    let (_folder, study, data, screen) = laboratory("640x480", |text| text.replace("demo = true", "demo = false"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_crex-session"));
    command.arg(&study).args(["--self-test", "--json"]).env("DISPLAY", &screen.name).env_remove("WAYLAND_DISPLAY");
    let output = command.output().unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // A machine that is busy with other things may be fit for nothing; it is never fit for a main study.
    assert_eq!(output.status.success(), found["verdict"] == "demonstrations_only", "{found:#}");
    assert!(found["reasons"].to_string().contains("unverified"), "{found:#}");
    assert_eq!(found["display"]["refresh"]["hz"], serde_json::Value::Null);
    assert_eq!(found["display"]["pixels"]["differing_bytes"], 0);
    assert_eq!(found["intervals"], 20);

    let said = refused(&screen, &study, &data)?;
    assert!(said.contains("--allow-unverified"), "{said}");
    assert!(!data.join("sessions/P01").exists());
    Ok(())
}

fn too_large() -> Result<(), Failed> {
    let (_folder, study, data, screen) = laboratory("640x480", |text| text.replace("width_px = 64", "width_px = 700"));
    let said = refused(&screen, &study, &data)?;
    assert!(said.contains("700 x 48"), "{said}");
    Ok(())
}
