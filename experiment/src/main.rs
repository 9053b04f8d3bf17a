//! `crex-session`: conducts a session in a window, rehearses a study, shows its plan.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use analysis::report::{self, Options, Report};
use clap::Parser;
use experiment::app::{self, Errand, Exit, Launch};
use experiment::bids;
use experiment::bot::Bot;
use experiment::clock::{Clock, Time, Utc};
use experiment::conduct::Conductor;
use experiment::enrol::{DataFolder, Kind};
use experiment::error::{Error, Result};
use experiment::observer::{Eye, Observer};
use experiment::rehearse;
use experiment::selftest::Verdict;
use experiment::session::Outcome;
use experiment::stimulus::{Picture, Pictures};
use experiment::withdraw::withdraw;
use stimuli::Study;

/// A line on standard error. Where nobody listens there is nowhere to complain, and nothing ends for that.
macro_rules! say {
    ($($words:tt)*) => {{
        let _ = writeln!(std::io::stderr(), $($words)*);
    }};
}

/// The study that is run when none is named.
const SHIPPED: &str = "stimuli/corridor";

const NO_DISPLAY_FOUND: &str = "no display was found (neither DISPLAY nor WAYLAND_DISPLAY is set): a session needs one";

/// Shows the pictures of a study and records the answers.
///
/// Without arguments it runs the shipped study: in a window where there is a display, else as a rehearsal with
/// simulated observers that ends in a report.
#[derive(Parser)]
#[command(name = "crex-session", version)]
struct Arguments {
    /// The study's folder or study file
    #[arg(value_name = "STUDY")]
    study: Option<PathBuf>,

    /// The participant's code: letters, digits, `-` and `_`; no name of a person
    #[arg(long, value_name = "ID", conflicts_with_all = ["simulate", "plan"])]
    participant: Option<String>,

    /// Rehearses the study with N simulated observers, without a window, and writes a report
    #[arg(long, value_name = "N", conflicts_with = "plan")]
    simulate: Option<u32>,

    /// Prints the plan's hash and cell totals, and stores them
    #[arg(long)]
    plan: bool,

    /// With --plan: shows the concealed sequence too. That this was done is logged
    #[arg(long, requires = "plan")]
    unblind: bool,

    /// Where the data go [default: data/STUDY, rehearsals: a new folder in rehearsal/]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,

    /// Goes on with a session that broke off; with --simulate, with every one that did
    #[arg(long)]
    resume: bool,

    /// The monitor, counted from 0
    #[arg(long, value_name = "N")]
    display: Option<usize>,

    /// Finds out what this machine and display can do, and says what they are fit for
    #[arg(long, conflicts_with_all = ["participant", "simulate", "plan"])]
    self_test: bool,

    /// Lets a main study run on a display whose refresh is not verified; REASON is written into the data
    #[arg(long, value_name = "REASON", value_parser = clap::builder::NonEmptyStringValueParser::new())]
    allow_unverified: Option<String>,

    /// Erases what participant ID answered and leaves a dated note in its place
    #[arg(long, value_name = "ID", conflicts_with_all = ["participant", "simulate", "plan", "self_test"])]
    withdraw: Option<String>,

    /// Writes the data of --data as a BIDS dataset into a new folder
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["participant", "simulate", "plan", "self_test", "withdraw"])]
    bids: Option<PathBuf>,

    /// With --simulate: the observers answer in the real window
    #[arg(long, requires = "simulate")]
    window: bool,

    /// Rehearsals only: makes the time of a simulated session run, X times as fast as the wall's
    #[arg(long, value_name = "X", requires = "simulate", value_parser = parse_speed)]
    speed: Option<f64>,

    /// Simulated observers see one step of quality with probability P, and guess otherwise
    #[arg(long, value_name = "P", requires = "simulate", default_value = "0", value_parser = parse_probability)]
    sees: f64,

    /// Simulated observers answer without having looked with probability P
    #[arg(long, value_name = "P", requires = "simulate", default_value = "0", value_parser = parse_probability)]
    lapses: f64,

    /// Simulated observers see what a metric predicts: JSON of pictures and how many JOD they are worse than the best of
    /// their layout, as in {"a_cbq": 0.8}
    #[arg(long, value_name = "FILE", requires = "simulate", conflicts_with = "sees")]
    jod: Option<PathBuf>,

    /// Simulated observers leave before each screen of text with probability P
    #[arg(long, value_name = "P", requires = "simulate", default_value = "0", value_parser = parse_probability)]
    leaves: f64,

    /// Prints one JSON object: the plan or the rehearsal's report
    #[arg(long)]
    json: bool,
}

fn parse_speed(text: &str) -> std::result::Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| speed.is_finite() && *speed > 0.0);
    speed.ok_or_else(|| "expected a number above 0, as in 10".to_owned())
}

fn parse_probability(text: &str) -> std::result::Result<f64, String> {
    let p = text.parse().ok().filter(|p| (0.0..=1.0).contains(p));
    p.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            say!("crex-session: {error}");
            ExitCode::from(if error.is_input() { 2 } else { 1 })
        }
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    let study = Study::load(&study_folder(arguments.study.as_deref()))?;
    if arguments.plan {
        return show_plan(&study, arguments);
    }
    if let Some(observers) = arguments.simulate {
        return simulate(&study, observers, arguments);
    }
    if let Some(participant) = &arguments.withdraw {
        return erase(&study, participant, arguments);
    }
    if let Some(to) = &arguments.bids {
        let data = DataFolder::reopen(&data_folder(&study, arguments), &study, Pictures::of(&study)?.hash()?)?;
        let participants = bids::export(&data, &study, to)?;
        say!("{participants} participants in {}", to.display());
        return Ok(());
    }
    if arguments.self_test {
        return self_test(&study, arguments);
    }
    if has_display() {
        return session(&study, arguments);
    }
    if arguments.participant.is_some() {
        return Err(Error::Machine(NO_DISPLAY_FOUND.to_owned()));
    }
    let observers = study.arms.iter().map(|arm| arm.n).sum();
    say!(
        "There is no display here (neither DISPLAY nor WAYLAND_DISPLAY is set), so no session can be shown.\n\
         Instead {observers} simulated observers rehearse \"{}\" through the same session machine.",
        study.title
    );
    simulate(&study, observers, arguments)
}

/// The study named, else the shipped one: below the current folder, or where this program was built.
fn study_folder(named: Option<&Path>) -> PathBuf {
    if let Some(named) = named {
        return named.to_owned();
    }
    let here = PathBuf::from(SHIPPED);
    if here.join("study.toml").is_file() {
        return here;
    }
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(SHIPPED);
    if built.join("study.toml").is_file() { built } else { here }
}

/// Only X11 and Wayland say beforehand whether there is a display; elsewhere there is.
fn has_display() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// Where the data of a study go if nothing else is said.
fn data_folder(study: &Study, arguments: &Arguments) -> PathBuf {
    arguments.data.clone().unwrap_or_else(|| Path::new("data").join(&study.id))
}

fn session(study: &Study, arguments: &Arguments) -> Result<()> {
    let pictures = Pictures::of(study)?;
    let decoded = decode(&pictures)?;
    let folder = data_folder(study, arguments);
    let data = DataFolder::open(&folder, study, pictures.hash()?, Kind::Real)?;
    data.check_room()?;
    say!("Plan {}, {} slots.", data.plan().hash(), data.plan().slots.len());
    match app::run(Launch { pictures: decoded, ..launch(study, Some(&data), arguments) })? {
        Exit::Ended(outcome) => {
            say!("The session has ended ({}); its data are in {}.", outcome.word(), folder.display());
        }
        _ => say!("No session was begun."),
    }
    Ok(())
}

fn decode(pictures: &Pictures<'_>) -> Result<Vec<Picture>> {
    let mut decoded = Vec::new();
    pictures.each(|picture| decoded.push(picture))?;
    Ok(decoded)
}

/// What a session with a person needs, pictures left out.
fn launch<'a>(study: &'a Study, data: Option<&'a DataFolder>, arguments: &Arguments) -> Launch<'a> {
    Launch {
        study,
        data,
        errand: Errand::Session,
        allow_unverified: arguments.allow_unverified.clone(),
        graphics: true,
        pictures: Vec::new(),
        participant: arguments.participant.clone(),
        resume: arguments.resume,
        speed: 1.0,
        monitor: arguments.display,
    }
}

fn self_test(study: &Study, arguments: &Arguments) -> Result<()> {
    if !has_display() {
        return Err(Error::Machine(NO_DISPLAY_FOUND.to_owned()));
    }
    let pictures = decode(&Pictures::of(study)?)?;
    let data = match &arguments.data {
        Some(folder) => Some(DataFolder::reopen(folder, study, Pictures::of(study)?.hash()?)?),
        None => None,
    };
    let launch = launch(study, data.as_ref(), arguments);
    match app::run(Launch { errand: Errand::SelfTest, pictures, ..launch })? {
        Exit::Tested(test) => {
            let json = || serde_json::to_string(&test).map_err(|error| Error::Machine(error.to_string()));
            print(&if arguments.json { json()? } else { test.to_text() })?;
            match test.verdict {
                Verdict::Unfit => Err(Error::Machine("this machine and display are unfit".to_owned())),
                _ => Ok(()),
            }
        }
        _ => Err(Error::Machine("the self-test was broken off".to_owned())),
    }
}

fn erase(study: &Study, participant: &str, arguments: &Arguments) -> Result<()> {
    let data = DataFolder::reopen(&data_folder(study, arguments), study, Pictures::of(study)?.hash()?)?;
    let done = withdraw(&data, participant)?;
    let (folder, files) = (done.folder.display(), done.files);
    let again = if done.again { " They had withdrawn before." } else { "" };
    say!(
        "{files} files of {participant} are erased; a dated note is in {folder}.{again} Reports, exports and backups made \
         before still hold the answers: make or clear them again."
    );
    Ok(())
}

fn simulate(study: &Study, observers: u32, arguments: &Arguments) -> Result<()> {
    let pictures = Pictures::of(study)?;
    let planned = study.arms.iter().map(|arm| arm.n).sum::<u32>().max(1);
    let kind = Kind::Simulated { times: observers.div_ceil(planned).max(1) };
    let new = || Path::new("rehearsal").join(format!("{}-{}", study.id, Utc::now().compact()));
    let folder = arguments.data.clone().unwrap_or_else(new);
    let eye = eye(arguments)?;
    let observer = |participant: &str| {
        Observer::new(eye.clone(), arguments.leaves, study.seed, participant).lapsing(arguments.lapses)
    };
    let codes: Vec<String> = (1..=observers).map(|number| format!("sim-{number:05}")).collect();
    let decoded = decode(&pictures)?;
    let data = DataFolder::open(&folder, study, pictures.hash()?, kind)?;
    say!("Simulated: no person answers here. Data go to {}.", folder.display());
    if arguments.window {
        let bots = codes.iter().map(|code| Bot::new(code.clone(), observer(code))).collect();
        let launch = launch(study, Some(&data), arguments);
        let speed = arguments.speed.unwrap_or(1.0);
        let exit = app::run(Launch { errand: Errand::Rehearsal(bots), pictures: decoded, speed, ..launch })?;
        if exit == Exit::Unbegun {
            return Err(Error::Machine("the window was closed before the rehearsal began".to_owned()));
        }
    } else {
        for code in &codes {
            rehearse_one(study, &data, code, observer(code), arguments)?;
        }
    }
    let logs: Vec<_> = codes.iter().map(|code| data.session_folder(code).join(format!("{code}.csv"))).collect();
    let options =
        Options { plan: analysis::plan::Plan::of(study), pictures: Some(analysis::pictures::load(&study.folder)?) };
    write_report(&report::of_logs(&logs, &options)?, &folder, arguments.json)
}

fn eye(arguments: &Arguments) -> Result<Eye> {
    if let Some(file) = &arguments.jod {
        let read = |source| Error::Io { action: "read", path: file.clone(), source };
        let text = std::fs::read_to_string(file).map_err(read)?;
        return Eye::metric(&text).map_err(|what| Error::Input(format!("{}:{what}", file.display())));
    }
    Ok(if arguments.sees > 0.0 { Eye::Threshold { sees: arguments.sees } } else { Eye::Guesser })
}

/// One observer's session without a window.
fn rehearse_one(
    study: &Study,
    data: &DataFolder,
    participant: &str,
    mut observer: Observer,
    arguments: &Arguments,
) -> Result<()> {
    let again = arguments.resume && data.session_folder(participant).is_dir();
    let start = if again { Conductor::resume } else { Conductor::begin };
    let begun = start(study, data, participant, rehearse::NO_DISPLAY)?;
    let mut conductor = begun.conductor;
    begun.notes.iter().for_each(|note| say!("{note}"));
    let mut time = arguments.speed.map_or(Time::Jumps { now_s: 0.0 }, |speed| Time::Runs(Clock::new(speed)));
    time.start_at(begun.since_start_s);
    let mut told = None;
    let outcome = rehearse::run(&mut conductor, &mut observer, &mut time, &mut |conductor| {
        if arguments.speed.is_some() && conductor.last_row() != told {
            told = conductor.last_row();
            say!("{participant}: trial {} saved", told.unwrap_or_default());
        }
    })?;
    if outcome != Outcome::Completed || arguments.simulate.unwrap_or_default() <= 64 {
        say!("{participant}: {}", outcome.word());
    }
    Ok(())
}

/// Writes the report beside the data in every format, and prints it in one.
fn write_report(report: &Report, folder: &Path, json: bool) -> Result<()> {
    let (markdown, as_json) = (report.to_markdown(), report.to_json());
    for (name, text) in [("report.md", &markdown), ("report.json", &as_json), ("report.html", &report.to_html())] {
        let path = folder.join(name);
        let beside = folder.join(format!(".{name}.part"));
        std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, &path)).map_err(|source| Error::Io {
            action: "write",
            path: path.clone(),
            source,
        })?;
        say!("{}", path.display());
    }
    print(if json { &as_json } else { &markdown })
}

fn show_plan(study: &Study, arguments: &Arguments) -> Result<()> {
    let folder = data_folder(study, arguments);
    let data = DataFolder::open(&folder, study, Pictures::of(study)?.hash()?, Kind::Real)?;
    let plan = data.plan();
    if arguments.unblind {
        data.note_unblinding()?;
    }
    if arguments.json {
        let mut object = serde_json::json!({
            "study": study.id,
            "plan_hash": plan.hash(),
            "seed": study.seed,
            "slots": plan.slots.len(),
            "cells": plan.totals(),
        });
        if arguments.unblind {
            object["sequence"] = serde_json::json!(plan.slots);
        }
        return print(&object.to_string());
    }
    let mut text = format!("{}\nplan {}\nseed {}\n", study.title, plan.hash(), study.seed);
    for cell in plan.totals() {
        text.push_str(&format!("{:4} x {}: {}, then {}\n", cell.n, cell.arm, cell.first, cell.second));
    }
    if arguments.unblind {
        for slot in &plan.slots {
            let pair = &slot.critical;
            text.push_str(&format!("{:4} {}: {}, then {}\n", slot.number, slot.arm, pair.first.id(), pair.second.id()));
        }
    } else {
        text.push_str("The sequence is concealed; --unblind shows it, and is logged.\n");
    }
    print(&text)
}

/// To standard output. A reader that has gone away (a pager that was left) is no failure.
fn print(text: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{}", text.trim_end()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::Machine(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}
