//! `crex-report`: session logs to a report.

use std::cell::Cell;
use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use analysis::plan::Plan;
use analysis::power::Question;
use analysis::proportion::Proportion;
use analysis::report::planning::{Planning, Request, bound_of};
use analysis::report::{self, Options, Report};
use analysis::tally::ArmTally;
use clap::{Args, Parser, Subcommand};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A line on standard error. Where nobody listens there is nowhere to complain, and nothing ends for that.
macro_rules! say {
    ($($words:tt)*) => {{
        let _ = writeln!(std::io::stderr(), $($words)*);
    }};
}

/// Computes what session logs show, and writes it as HTML, Markdown, JSON or CSV.
#[derive(Parser)]
#[command(name = "crex-report", version, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,

    /// Session logs (CSV), all of one study; a folder stands for every log in it and below
    #[arg(value_name = "LOG", required_unless_present = "counts", conflicts_with = "counts")]
    logs: Vec<PathBuf>,

    /// Where to write; the format is the ending: .html, .md, .json, or .csv for a table of every
    /// number. May be given several times
    #[arg(short, value_name = "OUT")]
    out: Vec<PathBuf>,

    /// Print the report as one JSON object
    #[arg(long)]
    json: bool,

    /// A published table instead of logs: K of N people of ARM told the lower quality. May be given several times
    #[arg(long, value_name = "ARM=K/N", value_parser = parse_counts)]
    counts: Vec<Counts>,

    /// An arm of --counts in which no answer is right; its K counts choices of the second interval
    #[arg(long, value_name = "ARM", requires = "counts")]
    no_right_answer: Vec<String>,

    /// The study's folder: its analysis plan decides level, equivalence bound and exclusions, its pictures are shown with
    /// their crex and cost
    #[arg(long, value_name = "DIR")]
    stimuli: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Command {
    /// How many people a study takes, exactly, and what a number of people can show
    Power(PowerArguments),
}

#[derive(Args)]
struct PowerArguments {
    /// Probability that a person is right; .75 where noticing is to be found, .5 where equivalence is to be shown
    #[arg(long, value_name = "P", value_parser = parse_probability)]
    truth: Option<f64>,

    /// Plan for showing equivalence within 1/2 plus or minus this proportion
    #[arg(long, value_name = "P", value_parser = parse_bound)]
    bound: Option<f64>,

    /// The same bound in JOD (1 JOD is a proportion of .75)
    #[arg(long, value_name = "JOD", conflicts_with = "bound", value_parser = parse_jod)]
    jod: Option<f64>,

    /// Power aimed at; may be given several times
    #[arg(long, value_name = "P", default_values_t = [0.8, 0.9], value_parser = parse_probability)]
    target: Vec<f64>,

    /// Level of the tests
    #[arg(long, value_name = "P", default_value_t = 0.05, value_parser = parse_level)]
    alpha: f64,

    /// Say what this many people in an arm can and cannot show
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    n: Option<u64>,

    /// Where to write; the format is the ending: .html, .md, .json, or .csv for the curve
    #[arg(short, value_name = "OUT")]
    out: Vec<PathBuf>,

    /// Print the answer as one JSON object
    #[arg(long)]
    json: bool,
}

/// A number inside an open range.
fn parse_between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let inside = text.parse().ok().filter(|value| low < *value && *value < high);
    inside.ok_or_else(|| format!("expected a number between {low} and {high}"))
}

fn parse_probability(text: &str) -> Result<f64, String> {
    parse_between(text, 0.0, 1.0)
}

fn parse_bound(text: &str) -> Result<f64, String> {
    parse_between(text, 0.0, 0.5)
}

fn parse_jod(text: &str) -> Result<f64, String> {
    parse_between(text, 0.0, 10.0)
}

fn parse_level(text: &str) -> Result<f64, String> {
    parse_between(text, 0.0, 0.5)
}

/// The most people in an arm that may be typed: a thousand times all who live, and far below 2^53, to which counts are
/// exact as floating-point numbers.
const MOST_PEOPLE: u64 = 10_000_000_000_000;

#[derive(Clone)]
struct Counts {
    typed: String,
    arm: String,
    counts: Proportion,
}

fn parse_counts(text: &str) -> Result<Counts, String> {
    let wrong = || format!("expected ARM=K/N with whole numbers K <= N, N at most {MOST_PEOPLE}, as in HQ/CBQ=9/16");
    let (arm, numbers) = text.rsplit_once('=').ok_or_else(wrong)?;
    let (k, n) = numbers.split_once('/').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    let counts = Proportion::new(number(k)?, number(n)?).filter(|counts| counts.n <= MOST_PEOPLE).ok_or_else(wrong)?;
    if arm.trim().is_empty() {
        return Err(wrong());
    }
    Ok(Counts { typed: text.to_owned(), arm: arm.trim().to_owned(), counts })
}

/// Why the program ends without a report.
enum Failure {
    /// The input is wrong: exit code 2.
    Input(String),
    /// The machine could not: exit code 1.
    Machine(String),
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Input(message)) => {
            say!("crex-report: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Machine(message)) => {
            say!("crex-report: {message}");
            ExitCode::from(1)
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(Command::Power(asked)) = &arguments.command {
        return power(asked);
    }
    let formats: [Format<Report>; 4] =
        [("html", Report::to_html), ("md", Report::to_markdown), ("json", Report::to_json), ("csv", Report::to_csv)];
    check_endings(&arguments.out, &formats)?;
    let logs = expand(&arguments.logs)?;
    check_kept(&arguments.out, &logs, arguments.stimuli.as_deref())?;
    let options = arguments.stimuli.as_deref().map(read_study).transpose()?.unwrap_or_default();
    let report = make(arguments, &logs, &options)?;
    deliver(&report, &arguments.out, &formats, arguments.json)
}

fn power(asked: &PowerArguments) -> Result<(), Failure> {
    let formats: [Format<Planning>; 4] = [
        ("html", Planning::to_html),
        ("md", Planning::to_markdown),
        ("json", Planning::to_json),
        ("csv", Planning::to_csv),
    ];
    check_endings(&asked.out, &formats)?;
    let question = match bound_of(asked.bound, asked.jod) {
        Some(bound) => Question::Equivalence { truth: asked.truth.unwrap_or(0.5), bound: bound.proportion },
        None => Question::Superiority { truth: asked.truth.unwrap_or(0.75) },
    };
    let request = Request { question, targets: asked.target.clone(), alpha: asked.alpha, n: asked.n };
    deliver(&Planning::new(&request), &asked.out, &formats, asked.json)
}

/// A file's ending and what writes it.
type Format<T> = (&'static str, fn(&T) -> String);

fn format_of<T>(out: &Path, formats: &[Format<T>]) -> Option<fn(&T) -> String> {
    let ending = out.extension()?.to_str()?;
    formats.iter().find(|(known, _)| *known == ending).map(|(_, write)| *write)
}

fn check_endings<T>(outs: &[PathBuf], formats: &[Format<T>]) -> Result<(), Failure> {
    match outs.iter().find(|out| format_of(out, formats).is_none()) {
        None => Ok(()),
        Some(out) => {
            Err(Failure::Input(format!("-o {}: expected an ending of .html, .md, .json or .csv", out.display())))
        }
    }
}

/// No output may take the place of what the report is made from: a log, its sidecar, the study's manifest.
fn check_kept(outs: &[PathBuf], logs: &[PathBuf], stimuli: Option<&Path>) -> Result<(), Failure> {
    let mut inputs: Vec<PathBuf> = logs.iter().flat_map(|log| [log.clone(), log.with_extension("json")]).collect();
    inputs.extend(stimuli.map(|study| study.with_file_name(stimuli::manifest::FILE_NAME)));
    inputs.extend(stimuli.map(|study| study.join(stimuli::manifest::FILE_NAME)));
    let real = |path: &Path| path.canonicalize().ok();
    let inputs: HashSet<PathBuf> = inputs.iter().filter_map(|input| real(input)).collect();
    match outs.iter().find(|out| real(out).is_some_and(|out| inputs.contains(&out))) {
        None => Ok(()),
        Some(out) => {
            let message = "the report is made from this file and would take its place; choose another name";
            Err(Failure::Input(format!("-o {}: {message}", out.display())))
        }
    }
}

/// Writes what was asked for; Markdown to standard output where nothing was.
fn deliver<T>(value: &T, outs: &[PathBuf], formats: &[Format<T>], json: bool) -> Result<(), Failure> {
    for out in outs {
        let text = format_of(out, formats).map(|write| write(value)).unwrap_or_default();
        write_whole(out, &text).map_err(|error| Failure::Machine(format!("{}: {error}", out.display())))?;
    }
    let printed = if json {
        Some("json")
    } else if outs.is_empty() {
        Some("md")
    } else {
        None
    };
    match printed.and_then(|ending| formats.iter().find(|(known, _)| *known == ending)) {
        Some((_, write)) => print(&write(value)),
        None => Ok(()),
    }
}

fn make(arguments: &Arguments, logs: &[PathBuf], options: &Options) -> Result<Report, Failure> {
    if arguments.counts.is_empty() {
        let bar = Bar::over(logs);
        let made = report::of_logs_told(logs, options, &|bytes| bar.passed(bytes));
        bar.bar.finish_and_clear();
        return made.map_err(|error| {
            if error.is_input() { Failure::Input(error.to_string()) } else { Failure::Machine(error.to_string()) }
        });
    }
    let mut arms: Vec<(String, ArmTally)> = Vec::new();
    for given in &arguments.counts {
        if arms.iter().any(|(name, _)| *name == given.arm) {
            return Err(Failure::Input(format!("--counts {}: arm `{}` was given before", given.typed, given.arm)));
        }
        let no_right_answer = arguments.no_right_answer.contains(&given.arm);
        let tally =
            if no_right_answer { ArmTally::of_second_chosen(given.counts) } else { ArmTally::of_correct(given.counts) };
        arms.push((given.arm.clone(), tally));
    }
    if let Some(unknown) = arguments.no_right_answer.iter().find(|name| arms.iter().all(|(arm, _)| arm != *name)) {
        return Err(Failure::Input(format!("--no-right-answer {unknown}: there is no such arm in --counts")));
    }
    let typed = arguments.counts.iter().map(|given| given.typed.clone()).collect();
    Ok(report::of_counts(&arms, typed, options))
}

/// How much of the logs is read, on standard error where that is a terminal, once it takes longer than a second.
struct Bar {
    bar: ProgressBar,
    read: Cell<u64>,
}

impl Bar {
    fn over(logs: &[PathBuf]) -> Self {
        let bytes = logs.iter().filter_map(|log| log.metadata().ok()).map(|found| found.len()).sum();
        let bar = ProgressBar::with_draw_target(Some(bytes), ProgressDrawTarget::stderr_with_hz(5));
        let style = ProgressStyle::with_template("{wide_bar} {percent:>3} % {elapsed} left {eta}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, read: Cell::new(0) }
    }

    fn passed(&self, bytes: u64) {
        self.read.set(self.read.get() + bytes);
        if self.bar.elapsed() > Duration::from_secs(1) {
            self.bar.set_position(self.read.get());
        }
    }
}

/// Folders replaced by the logs in them and below: the CSV files that have their sidecar, in order of name.
fn expand(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut logs = Vec::new();
    for path in paths {
        if !path.is_dir() {
            logs.push(path.clone());
            continue;
        }
        let before = logs.len();
        collect(path, &mut logs).map_err(|error| Failure::Machine(format!("{}: {error}", path.display())))?;
        logs[before..].sort();
        if logs.len() == before {
            let expected = "expected session logs in it (CSV files with their JSON sidecar beside them)";
            return Err(Failure::Input(format!("{}: {expected}", path.display())));
        }
    }
    Ok(logs)
}

fn collect(folder: &Path, logs: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let (path, kind) = entry.and_then(|entry| Ok((entry.path(), entry.file_type()?)))?;
        if kind.is_dir() {
            collect(&path, logs)?;
        } else if path.extension().is_some_and(|ending| ending == "csv") && path.with_extension("json").is_file() {
            logs.push(path);
        }
    }
    Ok(())
}

fn read_study(path: &Path) -> Result<Options, Failure> {
    let failure = |error: stimuli::Error| {
        if error.is_input() { Failure::Input(error.to_string()) } else { Failure::Machine(error.to_string()) }
    };
    let study = stimuli::Study::load(path).map_err(failure)?;
    let plan = Plan::of(&study)
        .ok_or_else(|| Failure::Input(format!("{}: expected an equivalence bound between 0 and .5", path.display())))?;
    let pictures = analysis::pictures::load(&study.folder).map_err(failure)?;
    Ok(Options { plan: Some(plan), pictures: Some(pictures).filter(|(pictures, _)| !pictures.is_empty()) })
}

/// Writes beside the file and renames, so that no half of a report is ever there.
fn write_whole(out: &Path, text: &str) -> std::io::Result<()> {
    let mut name = out.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let beside = out.with_file_name(name);
    std::fs::write(&beside, text)?;
    std::fs::rename(&beside, out)
}

fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Machine(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}
