//! `crex`: Radiance scenes rendered by light-transport component, and what belongs to that. Words become a request, the library
//! runs it, the outcome becomes an exit code: 0 done, 1 could not, 2 the input is wrong.

mod auto;
mod compare;
mod console;
mod estimate;
mod frames;
mod importance;
mod merge;
mod options;
mod output;
mod plan;
mod render;
mod scene_files;
mod snapshots;
mod spellings;
mod stats;
mod stimuli;
mod timed;
mod trade;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use console::Failure;
use options::RadianceOptions;
use renderer::schedule::MonotonicClock;

/// Renders Radiance scenes by light-transport component, in the order that a component regular expression says.
#[derive(Parser, Debug)]
#[command(name = "crex", version, propagate_version = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Render scenes to pictures
    Render(Box<render::Args>),
    /// Join the parts of a picture that several machines rendered
    Merge(merge::Args),
    /// Predict what a crex will cost, from what rays have cost
    Estimate(Box<estimate::Args>),
    /// Explain a crex stage by stage
    Plan(plan::Args),
    /// Make a map of where people look: task objects, what catches the eye, or both
    Importance(Box<importance::Args>),
    /// Propose a crex: what a scene's picture needs, in which order and how often
    Auto(Box<auto::Args>),
    /// Measure what quality costs: loss against time over crexes, samples and importance
    Trade(Box<trade::Args>),
    /// Measure how far a picture lies from a reference
    Compare(compare::Args),
    /// Render the pictures of a study that are missing or stale, or check them
    Stimuli(stimuli::Args),
}

/// The commands that take rpict's options.
const RENDERING: [&str; 5] = ["render", "importance", "estimate", "auto", "trade"];

fn main() -> ExitCode {
    let clock = MonotonicClock::start();
    let words: Vec<OsString> = std::env::args_os().collect();
    match run(words, &clock) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn run(words: Vec<OsString>, clock: &MonotonicClock) -> Result<(), Failure> {
    let (words, radiance) = radiance_options(words)?;
    let cli = RENDERING.iter().fold(Cli::command(), |cli, name| {
        cli.mut_subcommand(name, |command| command.after_long_help(spellings::help()))
    });
    let matches = cli.try_get_matches_from(words).map_err(Failure::Usage)?;
    let cli = Cli::from_arg_matches(&matches).map_err(Failure::Usage)?;
    match cli.command {
        Command::Render(args) => render::run(&args, &radiance, clock),
        Command::Merge(args) => merge::run(&args),
        Command::Estimate(args) => estimate::run(&args, &radiance, clock),
        Command::Auto(args) => auto::run(&args, &radiance),
        Command::Trade(args) => trade::run(&args, &radiance, clock),
        Command::Plan(args) => plan::run(&args),
        Command::Importance(args) => importance::run(&args, &radiance, clock).map(drop),
        Command::Compare(args) => compare::run(&args),
        Command::Stimuli(args) => stimuli::run(&args, clock),
    }
}

/// Takes rpict's options out of the words of a command that renders.
fn radiance_options(words: Vec<OsString>) -> Result<(Vec<OsString>, RadianceOptions), Failure> {
    let renders = words.get(1).is_some_and(|word| RENDERING.iter().any(|name| word == name));
    if !renders {
        return Ok((words, RadianceOptions::default()));
    }
    let cli = Cli::command();
    let own = words.get(1).and_then(|name| cli.find_subcommand(name)).cloned().unwrap_or_default();
    options::take(words, &own).map_err(Failure::Input)
}
