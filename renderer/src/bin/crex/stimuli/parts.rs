//! A study's pictures made by several machines: each renders its part of every picture into a file beside it, then one joins them.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ::stimuli::{PictureRecord, PictureStatus, Study, Timing};
use renderer::part::{Part, PartFile, join};
use renderer::render::Shard;
use renderer::schedule::{Clock, MonotonicClock};

use super::maps::Map;
use super::{Args, Job, MeanLuminance, Ready, ready, record, word};
use crate::console::{self, Failure};
use crate::output::Output;
use crate::render::write_joined;

/// The file of a part: the picture's, and `.2-of-8.part`.
pub(super) fn path(picture: &Path, shard: Shard) -> PathBuf {
    let mut name = picture.file_name().map_or_else(OsString::new, OsString::from);
    name.push(format!(".{}-of-{}.part", shard.number(), shard.all()));
    picture.with_file_name(name)
}

/// Machines that work at once must not make the maps each for itself: they have to be there.
pub(super) fn check_maps(args: &Args, maps: &[Map]) -> Result<(), Failure> {
    match maps.iter().find(|map| map.status != PictureStatus::Fresh) {
        None => Ok(()),
        Some(map) => Err(Failure::input(format!(
            "{}: this map is {}: first run `crex stimuli {} --maps`, once",
            map.file.display(),
            word(&map.status),
            args.study.display()
        ))),
    }
}

/// Renders a part of one picture, unless it is there.
pub(super) fn render(
    study: &Study,
    job: &Job,
    shard: Shard,
    threads: Option<u32>,
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    let begun_s = clock.now_s();
    let Ready { path: picture, prepared, .. } = ready(study, job, threads)?;
    let head = prepared.head(shard, job.request.exposure);
    let path = path(&picture, shard);
    if Part::open(&path).is_ok_and(|part| *part.head() == head) {
        console::say("note", &format!("{} is there", path.display()));
        return Ok(());
    }
    let (file, tail, _) = prepared.render_part(shard, PartFile::create(&path, &head)?, clock)?;
    file.finish(&tail)?;
    console::say("note", &format!("{}: {:.1} s", path.display(), clock.now_s() - begun_s));
    Ok(())
}

/// Joins the parts of one picture, and says which files they are: they may go once the manifest knows the picture.
pub(super) fn merge(
    study: &Study,
    job: &Job,
    clock: &MonotonicClock,
) -> Result<(PictureRecord, Timing, Vec<PathBuf>), Failure> {
    let begun_s = clock.now_s();
    let ready = ready(study, job, None)?;
    let files = files(&ready.path)?;
    if files.is_empty() {
        let message = "no part of it is there: make them with `crex stimuli --shard I/N`, for each I";
        return Err(Failure::input(message));
    }
    let joined = join(files.iter().map(|file| Part::open(file)).collect::<Result<_, _>>()?)?;
    let wanted = ready.prepared.head(joined.parts()[0].shard(), job.request.exposure);
    if let Some(what) = wanted.difference(joined.head()) {
        return Err(Failure::input(format!(
            "its parts are of another picture than the study asks for now ({what}): remove them and render them again"
        )));
    }
    write_joined(&joined, &[Output::File(ready.path.clone())], None)?;
    let mut mean = MeanLuminance::default();
    for band in joined.bands() {
        mean = mean.with(&band?);
    }
    let tails = || joined.parts().iter().map(Part::tail);
    let slowest_s = tails().map(|tail| tail.wall_s).fold(0.0, f64::max);
    let timing =
        Timing { seconds: slowest_s + clock.now_s() - begun_s, threads: tails().map(|tail| tail.threads).sum() };
    let record = record(job, ready, joined.account(), mean)?;
    Ok((record, timing, files))
}

/// All files that are named as parts of a picture, by name.
fn files(picture: &Path) -> Result<Vec<PathBuf>, Failure> {
    let folder = picture.parent().unwrap_or(Path::new("."));
    let cannot = |error: std::io::Error| Failure::Cannot(format!("{}: {error}", folder.display()));
    let prefix = format!("{}.", picture.file_name().unwrap_or_default().to_string_lossy());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let numbers = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(".part"));
        if numbers.is_some_and(|numbers| numbers.replace("-of-", "/").parse::<Shard>().is_ok()) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
