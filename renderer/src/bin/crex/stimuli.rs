//! `crex stimuli`: renders the pictures of a study that are missing or stale, and keeps its manifest.
//!
//! First the importance maps, if the study says how they are made; then the pictures. A picture of a study is exactly what `crex render` makes of the words that [`words`] gives.

mod maps;
mod parts;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ::stimuli::{Manifest, PictureRecord, PictureStatus, Request, Sha256, Stimulus, Study, Timing};
use clap::{CommandFactory, FromArgMatches};
use renderer::color::{Rgb, luminance_cd_m2};
use renderer::film::Film;
use renderer::render::{Account, Shard};
use renderer::schedule::{Clock, MonotonicClock};

use crate::console::{self, Failure};
use crate::{Cli, Command, options, output, render, timed};

/// What `crex stimuli` takes.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    /// The study: its file, or a folder with a study.toml
    #[arg(value_name = "STUDY", default_value = "stimuli/corridor")]
    study: PathBuf,
    /// Say of each picture whether it is what would be made, and render nothing; exit code 1 if one is not
    #[arg(long, conflicts_with = "force")]
    check: bool,
    /// Only this picture, such as a_hq; may be repeated
    #[arg(long, value_name = "ID")]
    only: Vec<String>,
    /// Render even what is as it should be
    #[arg(long)]
    force: bool,
    /// Render only part I of N of each picture, into a file beside it, and write nothing else: as many machines as there are parts can
    /// work at once. A part that is there already is kept
    #[arg(long, value_name = "I/N", conflicts_with_all = ["check", "merge", "maps"])]
    shard: Option<Shard>,
    /// Join the parts that --shard made to pictures, and remove them; says which are missing or double
    #[arg(long, conflicts_with_all = ["check", "maps", "force"])]
    merge: bool,
    /// Make the importance maps and no pictures, as --shard wants it
    #[arg(long, conflicts_with = "check")]
    maps: bool,
    /// Threads [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    threads: Option<u32>,
}

/// A picture to be made.
struct Job {
    stimulus: Stimulus,
    request: Request,
    status: PictureStatus,
}

/// The name and version that pictures are marked with.
fn version() -> String {
    format!("crex {}", env!("CARGO_PKG_VERSION"))
}

pub(crate) fn run(args: &Args, clock: &MonotonicClock) -> Result<(), Failure> {
    let study = Study::load(&args.study).map_err(failure)?;
    let mut manifest = Manifest::load(&study.folder).map_err(failure)?;
    let needed = needed_maps(&study, &args.only)?;
    let maps = maps::maps(&study, &manifest, &needed)?;
    if args.check {
        return check(&maps, &jobs(&study, &manifest, &args.only)?);
    }
    if args.shard.is_some() || args.merge {
        parts::check_maps(args, &maps)?;
    } else {
        maps::make(&study, &maps, &mut manifest, args.force, clock)?;
    }
    if args.maps {
        return Ok(());
    }
    // Whether a picture is stale depends on the maps.
    let jobs = jobs(&study, &manifest, &args.only)?;
    let jobs: Vec<Job> = jobs.into_iter().filter(|job| args.force || job.status != PictureStatus::Fresh).collect();
    if jobs.is_empty() {
        console::say("note", "every picture is what would be made");
        return Ok(());
    }
    let file = |job: &Job| {
        let picture = study.folder.join(job.stimulus.file());
        args.shard.map_or_else(|| picture.clone(), |shard| parts::path(&picture, shard))
    };
    output::clean_up_when_interrupted(jobs.iter().map(file).collect());
    for (i, job) in jobs.iter().enumerate() {
        let id = job.stimulus.id();
        console::say("note", &format!("{} of {}: {id}, {}", i + 1, jobs.len(), word(&job.status)));
        let made = match args.shard {
            Some(shard) => parts::render(&study, job, shard, args.threads, clock).map(|()| None),
            None if args.merge => parts::merge(&study, job, clock).map(Some),
            None => make(&study, job, args.threads, clock).map(|(record, timing)| Some((record, timing, Vec::new()))),
        };
        let made = made.map_err(|failure| match failure {
            Failure::Input(message) => Failure::Input(format!("{}: picture {id}: {message}", args.study.display())),
            other => other,
        })?;
        let Some((record, timing, used)) = made else { continue };
        console::say("note", &format!("{id}: {:.1} s, {:.2} cd/m2", timing.seconds, record.mean_luminance_cd_m2));
        if manifest.study.is_empty() {
            manifest.study.clone_from(&study.id);
        }
        manifest.pictures.insert(id.clone(), record);
        manifest.timings.insert(id, timing);
        forget_strangers(&study, &mut manifest);
        manifest.save(&study.folder).map_err(failure)?;
        for file in used {
            std::fs::remove_file(&file).map_err(|error| Failure::Cannot(format!("{}: {error}", file.display())))?;
        }
    }
    Ok(())
}

/// The files of the maps that modulate these pictures.
fn needed_maps(study: &Study, only: &[String]) -> Result<Vec<PathBuf>, Failure> {
    let stimuli = chosen(study, only)?;
    Ok(stimuli.iter().filter_map(|stimulus| study.request(stimulus)?.importance).collect())
}

/// The pictures of the study, or those of them that were asked for.
fn jobs(study: &Study, manifest: &Manifest, only: &[String]) -> Result<Vec<Job>, Failure> {
    chosen(study, only)?
        .into_iter()
        .filter_map(|stimulus| Some((study.request(&stimulus)?, stimulus)))
        .map(|(request, stimulus)| {
            let status = manifest.status(&study.folder, &stimulus.id(), &request, &version()).map_err(failure)?;
            Ok(Job { stimulus, request, status })
        })
        .collect()
}

/// What the study shows, or those that were asked for.
fn chosen(study: &Study, only: &[String]) -> Result<Vec<Stimulus>, Failure> {
    let stimuli = study.stimuli();
    if let Some(unknown) = only.iter().find(|only| !stimuli.iter().any(|stimulus| stimulus.id() == **only)) {
        let known: Vec<String> = stimuli.iter().map(Stimulus::id).collect();
        let message = format!("--only {unknown}: the study shows no such picture; it shows {}", known.join(", "));
        return Err(Failure::input(message));
    }
    Ok(stimuli.into_iter().filter(|stimulus| only.is_empty() || only.contains(&stimulus.id())).collect())
}

/// One line a map and a picture; fails if one is not what would be made.
fn check(maps: &[maps::Map], jobs: &[Job]) -> Result<(), Failure> {
    let maps = maps.iter().map(|map| (map.file.display().to_string(), &map.status));
    let all: Vec<_> = maps.chain(jobs.iter().map(|job| (job.stimulus.id(), &job.status))).collect();
    let lines: String = all.iter().map(|(name, status)| format!("{name}: {}\n", word(status))).collect();
    console::print(&lines)?;
    let wrong = all.iter().filter(|(_, status)| **status != PictureStatus::Fresh).count();
    if wrong == 0 {
        return Ok(());
    }
    Err(Failure::Cannot(format!(
        "{wrong} of {} files are not what would be made; `crex stimuli` makes them",
        all.len()
    )))
}

fn word(status: &PictureStatus) -> String {
    match status {
        PictureStatus::Fresh => "as it would be made".to_owned(),
        PictureStatus::Missing => "missing".to_owned(),
        PictureStatus::Altered => "altered: not the file that was written".to_owned(),
        PictureStatus::Stale(changed) => format!("stale: changed since are {}", changed.join(", ")),
    }
}

/// A picture about to be made: everything read and checked.
struct Ready {
    path: PathBuf,
    prepared: render::Prepared,
    /// Digests of what was read, and not of what may be there when the rendering has ended.
    inputs: BTreeMap<PathBuf, Sha256>,
}

fn ready(study: &Study, job: &Job, threads: Option<u32>) -> Result<Ready, Failure> {
    let path = study.folder.join(job.stimulus.file());
    let (Command::Render(args), radiance) = parsed(words(&job.request, &study.folder, &path, threads))? else {
        unreachable!("the words begin with `crex render`")
    };
    let prepared = render::prepare(&args, &radiance)?;
    let settings = &prepared.request.settings;
    let (width, height) = (job.request.width_px as usize, job.request.height_px as usize);
    if (settings.width, settings.height) != (width, height) {
        let message = format!(
            "{}: this view makes {} x {} pixels of the study's {width} x {height}; change its -vh or -vv so that pixels are square",
            study.folder.join(&job.request.view).display(),
            settings.width,
            settings.height
        );
        return Err(Failure::input(message));
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| Failure::Cannot(format!("{}: {error}", folder.display())))?;
    }
    let own = std::iter::once(&job.request.view).chain(&job.request.importance);
    let inputs = inputs(study, own, &prepared.files)?;
    Ok(Ready { path, prepared, inputs })
}

/// Renders one picture and says how it came about.
fn make(
    study: &Study,
    job: &Job,
    threads: Option<u32>,
    clock: &MonotonicClock,
) -> Result<(PictureRecord, Timing), Failure> {
    let begun_s = clock.now_s();
    let ready = ready(study, job, threads)?;
    let Ready { path, prepared, .. } = &ready;
    let rendering = prepared.render(clock, None)?;
    output::write_film(path, &rendering.film, job.request.exposure, &prepared.request.provenance)?;
    let threads = timed::threads(&prepared.request.settings);
    let record = record(job, ready, &rendering.account(), MeanLuminance::default().with(&rendering.film))?;
    Ok((record, Timing { seconds: clock.now_s() - begun_s, threads }))
}

/// How a picture came about that was made and written.
fn record(job: &Job, ready: Ready, account: &Account, mean: MeanLuminance) -> Result<PictureRecord, Failure> {
    Ok(PictureRecord {
        layout: job.stimulus.layout.clone(),
        quality: job.stimulus.quality.clone(),
        file: job.stimulus.file(),
        sha256: Sha256::of_file(&ready.path).map_err(failure)?,
        request: job.request.clone(),
        inputs: ready.inputs,
        rays: rays(account),
        mean_luminance_cd_m2: mean.cd_m2(),
        version: version(),
    })
}

/// The words behind `crex` that make a picture.
fn words(request: &Request, folder: &Path, picture: &Path, threads: Option<u32>) -> Vec<OsString> {
    let mut words: Vec<OsString> = vec!["crex".into(), "render".into()];
    words.extend(request.scene.iter().map(|file| folder.join(file).into()));
    words.extend(["-vf".into(), folder.join(&request.view).into()]);
    words.extend(["-x".into(), request.width_px.to_string().into()]);
    words.extend(["-y".into(), request.height_px.to_string().into()]);
    words.push("-av".into());
    words.extend(request.ambient.iter().map(|channel| channel.to_string().into()));
    words.extend(request.options.iter().map(OsString::from));
    words.extend(["--crex".into(), request.crex.clone().into()]);
    words.extend(["--spp".into(), request.spp.to_string().into()]);
    words.extend(["--seed".into(), request.seed.to_string().into()]);
    words.extend(["--exposure".into(), request.exposure.to_string().into()]);
    if let Some(map) = &request.importance {
        words.extend(["--importance".into(), folder.join(map).into()]);
    }
    if !request.thresholds.is_empty() {
        let list: Vec<String> = request.thresholds.iter().map(f32::to_string).collect();
        words.extend(["--thresholds".into(), list.join(",").into()]);
    }
    if let Some(threads) = threads {
        words.extend(["--threads".into(), threads.to_string().into()]);
    }
    words.extend(["-o".into(), picture.into()]);
    words
}

/// Words of a command, read as the command line is.
fn parsed(words: Vec<OsString>) -> Result<(Command, options::RadianceOptions), Failure> {
    let (words, radiance) = crate::radiance_options(words)?;
    let matches = Cli::command().try_get_matches_from(words).map_err(Failure::Usage)?;
    Ok((Cli::from_arg_matches(&matches).map_err(Failure::Usage)?.command, radiance))
}

/// Digests of all files that were read, by their paths from the study's folder: its `own` files, and those of the scene.
fn inputs<'a>(
    study: &Study,
    own: impl IntoIterator<Item = &'a PathBuf>,
    scene: &[PathBuf],
) -> Result<BTreeMap<PathBuf, Sha256>, Failure> {
    let own = own.into_iter().map(|file| study.folder.join(file));
    scene
        .iter()
        .cloned()
        .chain(own)
        .map(|path| {
            let digest = Sha256::of_file(&path).map_err(failure)?;
            let name = path.strip_prefix(&study.folder).map(Path::to_owned).unwrap_or(path);
            Ok((name, digest))
        })
        .collect()
}

fn rays(account: &Account) -> BTreeMap<String, u64> {
    let mut rays = BTreeMap::from([("primary".to_owned(), account.primary.rays)]);
    for row in &account.stages {
        *rays.entry(row.stage.component.to_string()).or_default() += row.report.rays;
    }
    rays
}

/// The mean luminance of a picture whose rows come from the top: added up in that order, the same bits however many come at a time.
#[derive(Default)]
struct MeanLuminance {
    sum: Rgb,
    pixels: usize,
}

impl MeanLuminance {
    fn with(mut self, rows: &Film) -> Self {
        for pixel in rows.beauty().values() {
            self.sum += pixel.as_dvec3();
            self.pixels += 1;
        }
        self
    }

    fn cd_m2(&self) -> f64 {
        luminance_cd_m2(self.sum / self.pixels as f64)
    }
}

/// Drops what the study no longer shows.
fn forget_strangers(study: &Study, manifest: &mut Manifest) {
    let shown: Vec<String> = study.stimuli().iter().map(Stimulus::id).collect();
    // Studies that extend one another share a folder: what another shows is there, and stays.
    manifest.pictures.retain(|id, record| shown.contains(id) || study.folder.join(&record.file).exists());
    let Manifest { pictures, timings, .. } = manifest;
    timings.retain(|id, _| pictures.contains_key(id));
}

fn failure(error: ::stimuli::Error) -> Failure {
    if error.is_input() { Failure::input(error) } else { Failure::Cannot(error.to_string()) }
}
