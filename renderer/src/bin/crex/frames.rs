//! `--views`: a picture for each of a list of views, within a time limit for each or for all, over one or several runs.

use std::path::{Path, PathBuf};

use renderer::rad::ViewSpec;
use renderer::render::Shard;
use renderer::scene::View;
use renderer::schedule::{Clock, MonotonicClock};

use crate::console::{self, Failure};
use crate::output::{self, Output, Packing};
use crate::render::{Args, Prepared};
use crate::timed::{self, Beside, Limit};

/// The views of a list, one a line that holds `VIEW=` or begins with `rvu`; the rest of the file is skipped.
pub(crate) fn views(file: &Path) -> Result<Vec<ViewSpec>, Failure> {
    let name = file.display().to_string();
    let text = std::fs::read_to_string(file).map_err(|error| Failure::input(format!("--views {name}: {error}")))?;
    let mut views = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut view = ViewSpec::default();
        let taken = view.take_header(&name, line).map_err(|errors| {
            let first = errors.first().map(|error| error.message.clone()).unwrap_or_default();
            Failure::input(format!("{name}:{}: {first}", number + 1))
        })?;
        if taken > 0 {
            views.push(view);
        }
    }
    if views.is_empty() {
        let advice = "expected lines such as `rvu -vtv -vp 0 0 0 -vd 0 1 0`";
        return Err(Failure::input(format!("--views {name}: holds no view: {advice}")));
    }
    Ok(views)
}

/// A frame's file: the name with its number, from 0001, before the extension.
fn numbered(path: &Path, frame: usize) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}_{:04}.{extension}", frame + 1))
}

/// Renders the frames that are not there yet.
pub(crate) fn run(
    args: &Args,
    mut prepared: Prepared,
    views: &[ViewSpec],
    file: &Path,
    clock: &MonotonicClock,
) -> Result<(), Failure> {
    if args.output.is_empty() || args.output.iter().any(|path| path == Path::new("-")) {
        return Err(Failure::input("--views makes many pictures: name a file with -o, not standard output"));
    }
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    let names = |frame: usize| args.output.iter().map(|path| numbered(path, frame)).collect::<Vec<_>>();
    let waiting: Vec<usize> =
        shard.of(0..views.len()).filter(|&frame| !names(frame).iter().all(|name| name.exists())).collect();
    let stored = args.profile.as_deref();
    stored.iter().try_for_each(|file| output::check_place(file))?;
    let mut profile = None;
    output::clean_up_when_interrupted(waiting.iter().flat_map(|&frame| names(frame)).collect());
    for (done, &frame) in waiting.iter().enumerate() {
        let view = views[frame];
        prepared.request.view = View::new(view)
            .map_err(|error| Failure::input(format!("{}: view {}: {error}", file.display(), frame + 1)))?;
        prepared.request.provenance.view = Some(view.to_string());
        let outputs = names(frame).iter().map(|name| Output::new(name)).collect::<Result<Vec<_>, _>>()?;
        // The first frame's time counts from the program's start.
        let begun_s = if done == 0 { 0.0 } else { clock.now_s() };
        let left = (waiting.len() - done) as f64;
        let seconds = args.time.or_else(|| args.total_time.map(|total| (total - begun_s).max(0.0) / left));
        if let Some(seconds) = seconds {
            let known = match profile.take() {
                Some(known) => known,
                None => timed::profile(stored, &prepared)?,
            };
            let mut limit =
                Limit::new(seconds, (stored, known), Beside::default(), &prepared, &outputs).beginning_at(begun_s);
            let timed = limit.render(&prepared, clock)?;
            limit.write(args.exposure, &prepared, &outputs, &timed.rendering, clock)?;
            limit.save()?;
            profile = Some(limit.into_profile());
        } else {
            let rendering = prepared.render(clock, None)?;
            for output in &outputs {
                output.write(&rendering.film, args.exposure, &prepared.request.provenance, Packing::CAREFUL)?;
            }
        }
        console::say("note", &format!("frame {} of {}: {:.2} s", frame + 1, views.len(), clock.now_s() - begun_s));
    }
    Ok(())
}
