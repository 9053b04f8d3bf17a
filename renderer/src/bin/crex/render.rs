//! `crex render`: scenes to pictures.

mod chosen;
mod request;
mod shards;

use std::path::{Path, PathBuf};

use renderer::component::Component;
use renderer::importance::ran;
use renderer::picture::{self, AtomicFile, Compression, Format, Picture, Quantity};
use renderer::raster::Raster;
use renderer::render::{Account, Rendering, Settings, Shard};
use renderer::schedule::{Clock, MonotonicClock};

use crate::console::Failure;
use crate::options::RadianceOptions;
use crate::output::{self, Output, Packing, Pictures};
use crate::scene_files::SceneArgs;
use crate::stats::Stats;
use crate::{frames, snapshots, timed};

pub(crate) use request::{Prepared, Request, prepare, prepare_scene};
pub(crate) use shards::write_joined;

/// What `crex render` takes besides rpict's options.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// What to trace and in which order, such as 'T{RSGM}'; '' is primary rays and direct light alone; `auto` is chosen for
    /// --time
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    crex: String,
    /// The picture: .exr with a layer for each component, .hdr or .png; `-` is HDR on standard output. May be repeated
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Vec<PathBuf>,
    /// The view of that name in a .rif file [default: its first, where no view is given by -vf, -vp and so on]
    #[arg(long, value_name = "NAME")]
    view: Option<String>,
    /// Samples for each pixel
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    spp: u32,
    /// Chooses the random numbers: the same seed gives the same bits
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Threads, also -n [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    threads: Option<u32>,
    /// Radiance times this is stored in .hdr, with an EXPOSURE line, and shown in .png; .exr always holds radiance
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    pub(crate) exposure: f64,
    /// The event of a path that says in which layer its light is filed
    #[arg(long, value_name = "WHICH", default_value = "last")]
    layers: LayerChoice,
    /// How much each pixel matters, for { }: a grey .png or an .exr with values in [0, 1]
    #[arg(long, value_name = "MAP")]
    importance: Option<PathBuf>,
    /// Importance that each member of each { } needs, from left to right, in place of i/(n+1)
    #[arg(long, value_name = "A,B,..", value_delimiter = ',')]
    thresholds: Option<Vec<f32>>,
    /// Smooth the planes of these components, such as D or D,G: far less noise, but biased; the message tells the noise
    /// before and after
    #[arg(long, value_name = "LETTERS", value_parser = component, value_delimiter = ',', conflicts_with_all = ["snapshots", "continuous", "time", "total_time", "replay"])]
    filter: Vec<Component>,
    /// Let the map say how many samples of a pixel run the members of { }, all of them wherever it is above 0 and with
    /// the expected picture unchanged, instead of which members run
    #[arg(long, requires = "importance", conflicts_with = "thresholds")]
    continuous: bool,
    /// Also write a picture, coloured by which components were allowed to run where, with a legend
    #[arg(long, value_name = "PICTURE")]
    ran: Option<PathBuf>,
    /// Also write the picture after the primary rays and after each stage into this folder
    #[arg(long, value_name = "DIR")]
    snapshots: Option<PathBuf>,
    /// Also write each part of the picture (direct, each component, ambient) as a picture into this folder
    #[arg(long, value_name = "DIR")]
    parts: Option<PathBuf>,
    /// Also write what was traced, stage by stage, as JSON
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Have everything done so many seconds after the program's start: tasks that are not predicted to fit are skipped,
    /// and time that is left is spent on more samples
    #[arg(long, value_name = "SECONDS", value_parser = timed::seconds, conflicts_with = "snapshots")]
    pub(crate) time: Option<f64>,
    /// What rays of this scene cost on this machine: read if it exists, and written with what was learnt
    #[arg(long, value_name = "FILE")]
    pub(crate) profile: Option<PathBuf>,
    /// Render a picture for each view of a list, numbered from 0001 before the extension; frames that exist are kept, so that a run
    /// that was stopped goes on where it was. --time is then for each frame
    #[arg(long, value_name = "FILE", conflicts_with_all = ["snapshots", "stats", "replay", "ran", "parts"])]
    views: Option<PathBuf>,
    /// With --views, have all frames done after so many seconds, instead of --time for each
    #[arg(long, value_name = "SECONDS", value_parser = timed::seconds, requires = "views", conflicts_with = "time")]
    pub(crate) total_time: Option<f64>,
    /// Render only part I of N, into a file for `crex merge`; with --views, only frames I, I+N, I+2N ...
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<Shard>,
    /// Planes of the picture that would take more MiB than this lie in a file beside the first OUT until it is written
    #[arg(long, value_name = "MIB", default_value_t = 512)]
    memory: u64,
    /// Render again, without a clock and to the same bits, what a run under --time wrote with --stats
    #[arg(long, value_name = "STATS", conflicts_with_all = ["time", "snapshots"])]
    replay: Option<PathBuf>,
}

/// `--layers`.
#[derive(clap::ValueEnum, Clone, Copy, Debug)]
enum LayerChoice {
    /// The event that spawned the ray which brought the light
    Last,
    /// The first event of its path from the eye
    First,
}

/// A component by its letter.
pub(crate) fn component(text: &str) -> Result<Component, String> {
    let mut letters = text.chars();
    match (letters.next().and_then(Component::from_letter), letters.next()) {
        (Some(component), None) => Ok(component),
        _ => Err("expected letters of components (D, S, G, T, R, M) with commas between them".to_owned()),
    }
}

pub(crate) fn run(args: &Args, options: &RadianceOptions, clock: &MonotonicClock) -> Result<(), Failure> {
    let choose = args.crex == chosen::AUTO;
    let with_crex = if choose { Some(chosen::with_crex(args)?) } else { None };
    let args = with_crex.as_ref().unwrap_or(args);
    if let Some(file) = &args.views {
        let views = frames::views(file)?;
        // All frames have the size that the first view makes.
        let options = RadianceOptions { view: views[0], view_given: true, ..options.clone() };
        return frames::run(args, prepare(args, &options)?, &views, file, clock);
    }
    if let Some(shard) = args.shard {
        return shards::run(args, shard, &prepare(args, options)?, clock);
    }
    let outputs = outputs(args)?;
    let mut prepared = prepare(args, options)?;
    if let (true, Some(seconds)) = (choose, args.time) {
        chosen::choose(&mut prepared, seconds, clock)?;
    }
    let request = &prepared.request;
    if let Some(seconds) = args.time {
        return run_timed(args, &prepared, &outputs, seconds, clock);
    }
    let mut timed = None;
    if let Some(file) = &args.replay {
        timed = timed::replay(file, &prepared, clock)?;
    }
    if let Some((timed, compression)) = timed {
        for output in &outputs {
            let packing = Packing { compression, durable: true };
            output.write(&timed.rendering.film, args.exposure, &request.provenance, packing)?;
        }
        let record = timed::TimedStats::new(&timed, compression, 0.0);
        return write_rest(args, &prepared, &outputs, &timed.rendering, Some((None, record)), clock);
    }
    if args.snapshots.is_none() && args.filter.is_empty() && prepared.exceeds(args.memory) {
        return shards::run_on_disk(args, &prepared, &outputs, clock);
    }
    let rendering = match &args.snapshots {
        None => prepared.render(clock, None)?,
        Some(folder) => {
            let mut snapshots = snapshots::Writer::new(folder, outputs[0].path(), args.exposure, &request.provenance)?;
            let rendering = prepared.render(clock, Some(&mut |snapshot| snapshots.write(&snapshot)))?;
            snapshots.finish()?;
            rendering
        }
    };
    for output in &outputs {
        output.write(&rendering.film, args.exposure, &request.provenance, Packing::CAREFUL)?;
    }
    write_rest(args, &prepared, &outputs, &rendering, None, clock)
}

/// As [`run`], within a time limit.
fn run_timed(
    args: &Args,
    prepared: &Prepared,
    outputs: &[Output],
    seconds: f64,
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    let file = args.profile.as_deref();
    let extension = format_beside(outputs[0].path());
    let beside = timed::Beside {
        stats: args.stats.is_some(),
        ran: args.ran.as_deref().and_then(Format::of_name),
        parts: args.parts.as_ref().and_then(|folder| Format::of_name(&folder.join("part").with_extension(extension))),
    };
    let mut limit = timed::Limit::new(seconds, (file, timed::profile(file, prepared)?), beside, prepared, outputs);
    let timed = limit.render(prepared, clock)?;
    limit.write(args.exposure, prepared, outputs, &timed.rendering, clock)?;
    limit.save()?;
    let record = (Some(limit.seconds()), limit.stats(&timed));
    write_rest(args, prepared, outputs, &timed.rendering, Some(record), clock)?;
    // All files are closed. To give back scene and picture piece by piece would take tens of milliseconds more.
    std::process::exit(0)
}

/// Writes whatever is asked for besides the picture: its parts, what ran where, and statistics, with the time limit and what
/// was done within it.
fn write_rest(
    args: &Args,
    prepared: &Prepared,
    outputs: &[Output],
    rendering: &Rendering,
    timed: Option<(Option<f64>, timed::TimedStats)>,
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    let Request { program, settings, provenance, .. } = &prepared.request;
    if let Some(folder) = &args.parts {
        let pictures = Pictures::of_film(&rendering.film, args.exposure, provenance);
        pictures.write(&[], Some((folder, format_beside(outputs[0].path()))), [Ok(&rendering.film)])?;
    }
    let account = rendering.account();
    write_beside(args, prepared, &account)?;
    let mut stats = Stats::new(program, settings, &account, timed::threads(settings));
    if let Some((seconds, record)) = timed {
        stats = stats.with_time(seconds, record);
    }
    write_stats(args, prepared, stats, clock)
}

/// Writes what is asked for beside the picture and does not need it.
fn write_beside(args: &Args, prepared: &Prepared, account: &Account) -> Result<(), Failure> {
    match &args.ran {
        Some(path) => write_ran(path, &prepared.request, account),
        None => Ok(()),
    }
}

/// Says so if an exposure is none.
fn check_exposure(exposure: f64) -> Result<(), Failure> {
    if exposure.is_finite() && exposure > 0.0 {
        return Ok(());
    }
    Err(Failure::input(format!("--exposure {exposure} must be a positive number")))
}

/// The places for the pictures, each checked, and made safe against interruption.
fn outputs(args: &Args) -> Result<Vec<Output>, Failure> {
    check_exposure(args.exposure)?;
    if args.output.is_empty() {
        return Err(Failure::input("no place for the picture: name it with -o, such as -o picture.exr"));
    }
    let outputs = output::checked(&args.output)?;
    let mut paths: Vec<PathBuf> = outputs.iter().filter_map(Output::path).map(Path::to_owned).collect();
    if let Some(Output::Stream) = args.ran.as_deref().map(Output::new).transpose()? {
        return Err(Failure::input("--ran wants a file, not standard output"));
    }
    for file in args.stats.iter().chain(&args.ran) {
        output::check_place(file)?;
        paths.push(file.clone());
    }
    paths.push(shards::scratch(&outputs));
    args.profile.iter().try_for_each(|file| output::check_place(file))?;
    output::clean_up_when_interrupted(paths);
    Ok(outputs)
}

/// Writes which components were allowed to run where.
fn write_ran(path: &Path, request: &Request, account: &Account) -> Result<(), Failure> {
    let Settings { width, height, .. } = request.settings;
    let rows = account.stages.iter().filter(|row| row.report.rays > 0);
    // Continuous importance lets members run wherever it is above 0.
    let least = |threshold| if request.continuous { f32::from_bits(1) } else { threshold };
    let runs: Vec<ran::Run> = rows.map(|row| (row.stage.component, row.stage.threshold.map(least))).collect();
    let sets = ran::components_run(width, height, request.importance.as_ref(), &runs);
    let shown = ran::picture(&sets);
    let pixels = shown.values().iter().map(|pixel| pixel.as_vec3().to_array()).collect();
    let beauty = Raster::from_values(shown.width(), shown.height(), pixels);
    let picture = Picture {
        quantity: Quantity::Display,
        beauty: beauty.ok_or_else(|| Failure::Cannot("a picture of what ran where lost pixels".to_owned()))?,
        layers: Vec::new(),
        provenance: request.provenance.clone(),
    };
    Ok(picture::write(path, &picture, Compression::Zip)?)
}

fn write_stats(args: &Args, prepared: &Prepared, stats: Stats, clock: &MonotonicClock) -> Result<(), Failure> {
    let Some(file) = &args.stats else { return Ok(()) };
    let stats = stats
        .with_scene(prepared.scene_hash(), prepared.request.modulation())
        .with_holdings(prepared.holdings())
        .with_wall_s(clock.now_s());
    let text = serde_json::to_string_pretty(&stats).map_err(|error| Failure::Cannot(error.to_string()))?;
    // Under a time limit nobody waits for the disk.
    let write = if args.time.is_some() { AtomicFile::write_all_unsynced } else { AtomicFile::write_all };
    write(file, format!("{text}\n").as_bytes())
        .map_err(|error| Failure::Cannot(format!("{}: cannot be written: {error}", file.display())))
}

/// The extension of the pictures beside a main one: its own, or EXR beside standard output.
pub(crate) fn format_beside(main: Option<&Path>) -> &'static str {
    match main.and_then(Format::of_name) {
        Some(Format::Png) => "png",
        Some(Format::Hdr) => "hdr",
        _ => "exr",
    }
}
