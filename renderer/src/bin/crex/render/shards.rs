//! Pictures that are not held whole: a part of one for another machine to join (`--shard`), and whole ones whose planes would
//! take more memory than they may (`--memory`).

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use renderer::part::{Head, Joined, PartError, PartFile, Tail};
use renderer::render::{Account, Shard};
use renderer::schedule::{Clock, MonotonicClock};

use super::{Args, Prepared, format_beside, write_beside, write_stats};
use crate::console::Failure;
use crate::output::{self, Output, Packing, Pictures};
use crate::stats::{self, Stats};
use crate::timed;

/// Bytes of a pixel of a plane.
const PIXEL_BYTES: u64 = 12;

impl Prepared {
    /// What a part of the picture says of itself.
    pub(crate) fn head(&self, shard: Shard, exposure: f64) -> Head {
        let settings = &self.request.settings;
        Head {
            shard: [shard.number(), shard.all()],
            width: settings.width,
            height: settings.height,
            planes: self.planes().iter().map(ToString::to_string).collect(),
            samples: settings.samples,
            seed: settings.seed,
            exposure,
            scene: self.scene_hash(),
            modulation: self.request.modulation(),
            provenance: self.request.provenance.clone(),
        }
    }

    /// Renders a part into its file.
    pub(crate) fn render_part(
        &self,
        shard: Shard,
        mut file: PartFile,
        clock: &MonotonicClock,
    ) -> Result<(PartFile, Tail, Account), Failure> {
        let account =
            self.with_progress(clock, |renderer| renderer.render_shard(shard, &mut |_, tile| file.add(tile)))?;
        self.warn_of_stopped(&account);
        let threads = timed::threads(&self.request.settings);
        let tail = Tail::new(&account, threads, clock.now_s(), stats::peak_bytes());
        Ok((file, tail, account))
    }

    /// Whether the planes of the picture would take more than so many MiB.
    pub(super) fn exceeds(&self, mebibytes: u64) -> bool {
        let settings = &self.request.settings;
        let pixels = (settings.width as u64).saturating_mul(settings.height as u64);
        pixels.saturating_mul(PIXEL_BYTES * self.planes().len() as u64) > mebibytes.saturating_mul(1 << 20)
    }
}

/// `crex render --shard`: a part instead of a picture.
pub(super) fn run(args: &Args, shard: Shard, prepared: &Prepared, clock: &MonotonicClock) -> Result<(), Failure> {
    let whole = [
        (args.time.is_some(), "--time"),
        (args.replay.is_some(), "--replay"),
        (args.profile.is_some(), "--profile"),
        (args.snapshots.is_some(), "--snapshots"),
        (!args.filter.is_empty(), "--filter"),
        (args.parts.is_some(), "--parts"),
        (args.ran.is_some(), "--ran"),
    ];
    if let Some((_, option)) = whole.iter().find(|(given, _)| *given) {
        return Err(Failure::input(format!("{option} needs the whole picture: it cannot go with --shard")));
    }
    super::check_exposure(args.exposure)?;
    let [path] = args.output.as_slice() else {
        return Err(Failure::input("--shard writes one part: name it once with -o, such as -o picture.2-of-8.part"));
    };
    if path == Path::new("-") {
        return Err(Failure::input("--shard writes a part into a file: name it, not standard output"));
    }
    let files: Vec<PathBuf> = std::iter::once(path).chain(&args.stats).cloned().collect();
    files.iter().try_for_each(|file| output::check_place(file))?;
    output::clean_up_when_interrupted(files);
    let file = PartFile::create(path, &prepared.head(shard, args.exposure))?;
    let (file, tail, account) = prepared.render_part(shard, file, clock)?;
    file.finish(&tail)?;
    let stats = Stats::new(&prepared.request.program, &prepared.request.settings, &account, tail.threads);
    write_stats(args, prepared, stats, clock)
}

/// Where the planes of a picture lie that is not held in memory, until it is written: beside the first file.
pub(super) fn scratch(outputs: &[Output]) -> PathBuf {
    let beside = outputs.iter().find_map(Output::path).map(Path::to_owned);
    let beside = beside.unwrap_or_else(|| std::env::temp_dir().join("crex"));
    let mut name = beside.file_name().map_or_else(OsString::new, OsString::from);
    name.push(".planes");
    beside.with_file_name(name)
}

/// `crex render` of a picture that is not held in memory: the same bits.
pub(super) fn run_on_disk(
    args: &Args,
    prepared: &Prepared,
    outputs: &[Output],
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    let file = PartFile::create(&scratch(outputs), &prepared.head(Shard::WHOLE, args.exposure))?;
    let (file, tail, account) = prepared.render_part(Shard::WHOLE, file, clock)?;
    let planes = file.into_scratch(&tail)?;
    let parts = args.parts.as_deref().map(|folder| (folder, format_beside(outputs[0].path())));
    write_joined(&planes.joined, outputs, parts)?;
    drop(planes);
    write_beside(args, prepared, &account)?;
    let stats = Stats::new(&prepared.request.program, &prepared.request.settings, &account, tail.threads);
    write_stats(args, prepared, stats, clock)
}

/// Writes a joined picture, rows by rows.
pub(crate) fn write_joined(joined: &Joined, outputs: &[Output], parts: Option<(&Path, &str)>) -> Result<(), Failure> {
    let head = joined.head();
    let pictures = Pictures {
        width: head.width,
        height: head.height,
        planes: joined.planes(),
        exposure: head.exposure,
        provenance: &head.provenance,
        packing: Packing::CAREFUL,
    };
    pictures.write(outputs, parts, joined.bands().map(|band| band.map_err(Failure::from)))
}

impl From<PartError> for Failure {
    fn from(error: PartError) -> Self {
        if error.is_input() { Self::input(error) } else { Self::Cannot(error.to_string()) }
    }
}
