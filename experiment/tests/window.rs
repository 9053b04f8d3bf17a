//! A real window under Xvfb and openbox, its keys pressed by xdotool. Where one of the three is not installed the tests
//! show as ignored.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use analysis::trial_log::{Interval, OnsetSource, Phase, Reader, Trial as Row, Vsync};
use libtest_mimic::{Arguments, Failed, Trial};

const NEEDED: [&str; 3] = ["Xvfb", "openbox", "xdotool"];

fn main() -> ExitCode {
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(1); // they share a processor that also has to draw
    let missing = NEEDED.iter().any(|program| !is_installed(program));
    let trials = vec![
        Trial::test("a_session_by_keyboard_in_a_window", by_keyboard),
        Trial::test("one_escape_and_a_close_button_end_nothing", undisturbed),
        Trial::test("a_picture_larger_than_the_screen_is_refused", too_large),
    ];
    let trials = trials.into_iter().map(|trial| trial.with_ignored_flag(missing)).collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn is_installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Ends its process with itself.
struct Kept(Child);

impl Drop for Kept {
    fn drop(&mut self) {
        let _gone = self.0.kill();
        let _status = self.0.wait();
    }
}

/// An X server with a window manager; without one a window cannot fill the screen.
struct Screen {
    name: String,
    _manager: Kept,
    _server: Kept,
}

impl Screen {
    fn new(size: &str) -> Self {
        // The server finds a free number and tells it.
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", &format!("{size}x24"), "-nolisten", "tcp"]);
        let mut server = Kept(server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap());
        let mut line = String::new();
        BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let name = format!(":{}", line.trim());
        let mut manager = Command::new("openbox");
        manager.env("DISPLAY", &name).stdout(Stdio::null()).stderr(Stdio::null());
        let manager = Kept(manager.spawn().unwrap());
        Self { name, _manager: manager, _server: server }
    }

    fn session(&self, study: &Path, data: &Path) -> Kept {
        let mut program = Command::new(env!("CARGO_BIN_EXE_crex-session"));
        program.arg(study).args(["--participant", "P01", "--data"]).arg(data);
        program.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").stderr(Stdio::piped());
        Kept(program.spawn().unwrap())
    }

    fn xdotool(&self, arguments: &[&str]) {
        let mut command = Command::new("xdotool");
        assert!(command.env("DISPLAY", &self.name).args(arguments).status().unwrap().success());
    }

    fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
    }
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

/// Confirms the set-up: one field after the other by Tab, then the box, then Enter.
fn set_up(screen: &Screen, data: &Path) -> Result<(), Failed> {
    until("the set-up takes a confirmation", || {
        // Backwards from the code's field: the button, then the box.
        for key in ["shift+Tab", "shift+Tab", "space", "Return"] {
            std::thread::sleep(Duration::from_millis(300));
            screen.key(key);
        }
        std::thread::sleep(Duration::from_millis(500));
        journal(data).contains("\"conditions\"")
    })
}

fn by_keyboard() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, short);
    let screen = Screen::new("1024x768");
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

/// During a picture: Escape, the keyboard taken by another window, and the window manager's close.
fn undisturbed() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, |text| short(text).replace("interval_s = 1.5", "interval_s = 4.0"));
    let screen = Screen::new("1024x768");
    let mut program = screen.session(&study, &data);
    std::thread::sleep(Duration::from_secs(2));
    set_up(&screen, &data)?;
    press_until(&screen, "1", &data, "\"consent\"", 1)?;
    press_until(&screen, "space", &data, "\"pair_starts\"", 1)?;
    std::thread::sleep(Duration::from_secs(1));
    screen.key("Escape");
    screen.key("alt+F4");
    until("the practice row", || {
        screen.xdotool(&["key", "--delay", "150", "4", "Return"]);
        rows(&data).len() == 1
    })?;
    assert_eq!(program.0.try_wait().unwrap(), None, "the session goes on");
    let reasons = rows(&data)[0].interrupt_reason.clone();
    assert!(reasons.contains("escape") && reasons.contains("close_requested"), "{reasons}");
    // The experimenter's two steps: Escape held, then F10.
    screen.xdotool(&["keydown", "Escape"]);
    std::thread::sleep(Duration::from_secs(3));
    screen.xdotool(&["keyup", "Escape"]);
    press_until(&screen, "F10", &data, "\"aborted\"", 1)?;
    until("the window closes", || {
        screen.key("Return");
        program.0.try_wait().unwrap().is_some()
    })?;
    let back = std::fs::read_to_string(data.join("slots/0001-1.back.json")).unwrap();
    assert!(back.contains("aborted"), "{back}");
    Ok(())
}

fn too_large() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let (study, data) = (folder.path().join("study"), folder.path().join("data"));
    support::write_study(&study, |text| text.replace("width_px = 64", "width_px = 700"));
    let screen = Screen::new("640x480");
    let mut program = screen.session(&study, &data);
    until("the program ends", || {
        screen.key("Return");
        std::thread::sleep(Duration::from_millis(200));
        program.0.try_wait().unwrap().is_some()
    })?;
    assert_eq!(program.0.wait().unwrap().code(), Some(1));
    let said: Vec<String> = BufReader::new(program.0.stderr.take().unwrap()).lines().map_while(Result::ok).collect();
    assert!(said.join("\n").contains("700 x 48"), "{said:?}");
    Ok(())
}
