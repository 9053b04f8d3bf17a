//! A photodiode in software: another process watches one pixel of the screen while sessions run, and its times are held
//! against the sessions' own.
//!
//! What it shows under Xvfb is bookkeeping: that durations, rows and flags agree with an outside observer. It is no
//! measurement of a display; `docs/sessions.md` says how to make one with a real photodiode.
//!
//! ```text
//! cargo build --release -p experiment --bin crex-session
//! cargo run --release -p experiment --example photodiode -- OUT
//! ```
//!
//! Needs Xvfb and openbox. Each condition runs in chunks; a run that was broken off goes on with the chunk that is missing.

mod join;
mod stage;
mod watch;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Runs conditions and prints a table.
#[derive(Parser)]
struct Arguments {
    /// Where chunks are kept
    out: PathBuf,
    /// Seconds that a picture is shown
    #[arg(long, default_value_t = 6.0)]
    seconds: f64,
    /// Intervals in a condition
    #[arg(long, default_value_t = 200)]
    intervals: usize,
    /// Intervals in a chunk, even, 6 or more
    #[arg(long, default_value_t = 50)]
    chunk: usize,
    /// Conditions, as in 640x480, 1280x1024+load, 640x480+stalls
    #[arg(long, value_delimiter = ',', default_value = "640x480,640x480+load,1280x1024,1280x1024+load,640x480+stalls")]
    conditions: Vec<String>,
    /// The program that is watched [default: crex-session beside this one]
    #[arg(long)]
    program: Option<PathBuf>,
    /// Shows what is there, runs nothing
    #[arg(long)]
    table: bool,
}

/// One way of running.
struct Condition {
    name: String,
    size: [u32; 2],
    load: bool,
    stalls: bool,
}

impl Condition {
    fn parse(name: &str) -> Result<Self> {
        let mut parts = name.split('+');
        let (width, height) =
            parts.next().and_then(|size| size.split_once('x')).ok_or("expected a size as in 640x480")?;
        let rest: Vec<&str> = parts.collect();
        Ok(Self {
            name: name.to_owned(),
            size: [width.parse()?, height.parse()?],
            load: rest.contains(&"load"),
            stalls: rest.contains(&"stalls"),
        })
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("photodiode: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    let mut table = Vec::new();
    for name in &arguments.conditions {
        let condition = Condition::parse(name)?;
        let folder = arguments.out.join(format!("{name}-{}s", arguments.seconds));
        std::fs::create_dir_all(&folder)?;
        let chunks = arguments.intervals.div_ceil(arguments.chunk);
        for number in 1..=chunks {
            let file = folder.join(format!("chunk-{number}.json"));
            if file.exists() || arguments.table {
                continue;
            }
            eprintln!("{name}: chunk {number} of {chunks}");
            let chunk = run_chunk(arguments, &condition, &folder.join(format!("run-{number}")), number as u64)?;
            std::fs::write(&file, serde_json::to_string_pretty(&chunk)?)?;
        }
        let mut found = Vec::new();
        for number in 1..=chunks {
            if let Ok(text) = std::fs::read_to_string(folder.join(format!("chunk-{number}.json"))) {
                found.push(serde_json::from_str::<join::Chunk>(&text)?);
            }
        }
        table.extend(join::row(&condition.name, arguments.seconds, &found));
    }
    println!("{}", join::HEADER);
    table.iter().for_each(|(line, _)| println!("{line}"));
    println!("{}", join::pooled(table.iter().flat_map(|(_, onsets)| onsets)));
    Ok(())
}

/// One session under a stage of its own, watched.
fn run_chunk(arguments: &Arguments, condition: &Condition, folder: &Path, seed: u64) -> Result<join::Chunk> {
    let _old = std::fs::remove_dir_all(folder); // what a broken run left
    let (study, data) = (folder.join("study"), folder.join("data"));
    stage::write_study(&study, condition.size, arguments.seconds, arguments.chunk)?;
    let stage = stage::Stage::new(condition.size)?;
    let stop = Arc::new(AtomicBool::new(false));
    let busy = condition.load.then(|| {
        let stop = Arc::clone(&stop);
        std::thread::spawn(move || {
            while !stop.load(Ordering::Relaxed) {
                std::hint::spin_loop();
            }
        })
    });
    let program = match &arguments.program {
        Some(program) => program.clone(),
        None => std::env::current_exe()?.ancestors().nth(2).ok_or("no folder of programs")?.join("crex-session"),
    };
    let mut session = Command::new(&program)
        .arg(&study)
        .args(["--simulate", "1", "--window", "--speed", "1", "--data"])
        .arg(&data)
        .env("DISPLAY", &stage.name)
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(folder.join("said.txt"))?)
        .spawn()
        .map_err(|error| format!("{}: {error}; build it first", program.display()))?;
    let stalls = condition.stalls.then(|| watch::Stalls { pid: session.id(), seed, seconds: arguments.seconds });
    let watching = {
        let (name, stop) = (stage.name.clone(), Arc::clone(&stop));
        std::thread::spawn(move || watch::watch(&name, &stop, stalls).map_err(|error| error.to_string()))
    };
    let status = session.wait()?;
    stop.store(true, Ordering::Relaxed);
    let seen = watching.join().map_err(|_| "the observer broke down")??;
    if let Some(busy) = busy {
        busy.join().map_err(|_| "the load broke down")?;
    }
    if !status.success() {
        return Err(format!("the session failed; see {}", folder.join("said.txt").display()).into());
    }
    join::join(&data, &seen)
}
