//! `crex-report`: session logs to a report.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use analysis::plan::Plan;
use analysis::proportion::Proportion;
use analysis::report::{self, Options, Report};
use analysis::tally::ArmTally;
use clap::Parser;

/// Computes what session logs show, and writes it as HTML, Markdown, JSON or CSV.
#[derive(Parser)]
#[command(name = "crex-report", version)]
struct Arguments {
    /// Session logs (CSV), all of one study
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

#[derive(Clone)]
struct Counts {
    typed: String,
    arm: String,
    counts: Proportion,
}

fn parse_counts(text: &str) -> Result<Counts, String> {
    let wrong = || "expected ARM=K/N with whole numbers K <= N, as in HQ/CBQ=9/16".to_owned();
    let (arm, numbers) = text.rsplit_once('=').ok_or_else(wrong)?;
    let (k, n) = numbers.split_once('/').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    let counts = Proportion::new(number(k)?, number(n)?).ok_or_else(wrong)?;
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
            eprintln!("crex-report: {message}");
            ExitCode::from(2)
        }
        Err(Failure::Machine(message)) => {
            eprintln!("crex-report: {message}");
            ExitCode::from(1)
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    for out in &arguments.out {
        if format_of(out).is_none() {
            return Err(Failure::Input(format!(
                "-o {}: expected an ending of .html, .md, .json or .csv",
                out.display()
            )));
        }
    }
    let options = arguments.stimuli.as_deref().map(read_study).transpose()?.unwrap_or_default();
    let report = make(arguments, &options)?;
    for out in &arguments.out {
        write_whole(out, &format_of(out).map(|write| write(&report)).unwrap_or_default())
            .map_err(|error| Failure::Machine(format!("{}: {error}", out.display())))?;
    }
    if arguments.json {
        print(&report.to_json())?;
    } else if arguments.out.is_empty() {
        print(&report.to_markdown())?;
    }
    Ok(())
}

fn make(arguments: &Arguments, options: &Options) -> Result<Report, Failure> {
    if arguments.counts.is_empty() {
        return report::of_logs(&arguments.logs, options).map_err(|error| {
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

fn format_of(out: &Path) -> Option<fn(&Report) -> String> {
    match out.extension()?.to_str()? {
        "html" => Some(Report::to_html),
        "md" => Some(Report::to_markdown),
        "json" => Some(Report::to_json),
        "csv" => Some(Report::to_csv),
        _ => None,
    }
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
