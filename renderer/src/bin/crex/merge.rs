//! `crex merge`: parts of a picture, from `crex render --shard`, joined to the picture that one machine would have made.

use std::path::{Path, PathBuf};

use renderer::crex::Program;
use renderer::part::{Joined, Part, PartError, join, runs};
use renderer::picture::AtomicFile;
use renderer::render::Settings;
use serde::Serialize;

use crate::console::{self, Failure};
use crate::output;
use crate::plan;
use crate::render::write_joined;
use crate::stats::Stats;

/// What `crex merge` takes.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    /// The parts, in any order
    #[arg(value_name = "PART", required = true)]
    parts: Vec<PathBuf>,
    /// The picture, as of `crex render`; may be repeated
    #[arg(short, long, value_name = "OUT", required_unless_present = "check")]
    output: Vec<PathBuf>,
    /// Only say whether the parts make a picture, and which are missing or double
    #[arg(long, conflicts_with_all = ["output", "stats"])]
    check: bool,
    /// Also write what was traced in all, as of `crex render`: wall_s and peak_bytes are the largest of a part, threads their sum
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Print one JSON object: how many parts there are, which are missing or double
    #[arg(long)]
    json: bool,
}

/// The object of `--json`.
#[derive(Serialize)]
struct Report {
    parts: u32,
    /// Those that are not there, from 1.
    missing: Vec<u32>,
    /// The same as `sbatch --array` takes it, such as `3,5-7`.
    array: String,
    /// Those that are there more than once.
    double: Vec<u32>,
    complete: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let outputs = output::checked(&args.output)?;
    if let Some(part) = args.parts.iter().find(|part| args.output.contains(part) || args.stats.as_ref() == Some(part)) {
        return Err(Failure::input(format!("{}: is a part, and cannot be written over", part.display())));
    }
    let files = args.output.iter().chain(&args.stats).filter(|path| *path != Path::new("-"));
    output::clean_up_when_interrupted(files.cloned().collect());
    args.stats.iter().try_for_each(|file| output::check_place(file))?;
    let parts = args.parts.iter().map(|path| Part::open(path)).collect::<Result<Vec<_>, _>>()?;
    match join(parts) {
        Ok(joined) => {
            if !args.check {
                write_joined(&joined, &outputs, None)?;
                if let Some(file) = &args.stats {
                    write_stats(file, &joined)?;
                }
            }
            let parts = joined.parts().len() as u32;
            tell(args, &Report { parts, missing: vec![], array: String::new(), double: vec![], complete: true })
        }
        Err(error) => {
            if let PartError::Incomplete { all, missing, double } = &error {
                let double = double.iter().map(|(number, _)| *number).collect();
                let (missing, array) = (missing.clone(), runs(missing));
                tell(args, &Report { parts: *all, missing, array, double, complete: false })?;
            }
            Err(error.into())
        }
    }
}

fn tell(args: &Args, report: &Report) -> Result<(), Failure> {
    if args.json { console::print_json(report) } else { Ok(()) }
}

fn write_stats(file: &Path, joined: &Joined) -> Result<(), Failure> {
    let head = joined.head();
    let program = Program::new(&plan::parse(head.provenance.crex.as_deref().unwrap_or_default())?);
    let settings = Settings { samples: head.samples, seed: head.seed, ..Settings::new(head.width, head.height) };
    let tails = || joined.parts().iter().map(Part::tail);
    let threads = tails().map(|tail| tail.threads).sum();
    let wall_s = tails().map(|tail| tail.wall_s).fold(0.0, f64::max);
    let stats = Stats::new(&program, &settings, joined.account(), threads)
        .with_scene(head.scene.clone(), head.modulation.clone())
        .with_wall_s(wall_s)
        .with_peak_bytes(tails().filter_map(|tail| tail.peak_bytes).max());
    let text = serde_json::to_string_pretty(&stats).map_err(|error| Failure::Cannot(error.to_string()))?;
    AtomicFile::write_all(file, format!("{text}\n").as_bytes())
        .map_err(|error| Failure::Cannot(format!("{}: cannot be written: {error}", file.display())))
}
