//! `crex estimate`: what a crex will cost, before it is rendered.

use std::collections::BTreeMap;

use renderer::schedule::{Budget, Clock, Estimate, Expected, MonotonicClock, ProfileCache, estimate};
use serde::Serialize;

use crate::console::{self, Failure};
use crate::options::RadianceOptions;
use crate::render::{self, Prepared};
use crate::{output, timed};

/// Seconds that are spent on learning what nothing is known of.
const LEARNING_S: f64 = 0.5;

/// Complete paths that tell what rays spawn.
const LEAST_PATHS: u64 = 100;

/// What `crex estimate` takes besides rpict's options.
#[derive(clap::Args, Clone, Debug)]
#[group(skip)]
pub(crate) struct Args {
    #[command(flatten)]
    render: render::Args,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    total_s: Seconds,
    primary: Row,
    components: BTreeMap<String, Row>,
    /// The crex would never run out of rays.
    endless: bool,
}

#[derive(Serialize)]
struct Seconds {
    mean: f64,
    q95: f64,
}

#[derive(Serialize)]
struct Row {
    rays: f64,
    mean_s: f64,
    q95_s: f64,
}

impl From<&Expected> for Row {
    fn from(expected: &Expected) -> Self {
        Self { rays: expected.rays, mean_s: expected.seconds.mean_s, q95_s: expected.bound_s }
    }
}

pub(crate) fn run(args: &Args, options: &RadianceOptions, clock: &MonotonicClock) -> Result<(), Failure> {
    let prepared = render::prepare(&args.render, options)?;
    let mut profile = timed::profile(args.render.profile.as_deref(), &prepared)?;
    let paths = renderer::render::paths(&prepared.request.program, &prepared.request.settings.limits);
    if !knows(&profile, &paths) {
        args.render.profile.iter().try_for_each(|file| output::check_place(file))?;
        console::say("note", "nothing is known of some rays: a few are traced to learn what they cost");
        let budget = Budget::new(clock, clock.now_s() + LEARNING_S, 0.0);
        prepared.with_renderer(clock, |renderer| renderer.render_within(budget, &mut profile))?;
        if let Some(file) = &args.render.profile {
            profile.save(file).map_err(|error| Failure::Cannot(error.to_string()))?;
        }
    }
    let estimate = expected(&prepared, &profile, &paths)?;
    report(&prepared, &estimate, args.json)
}

/// Whether the profile has seen enough paths of this crex under these limits to tell what rays spawn.
fn knows(profile: &ProfileCache, paths: &str) -> bool {
    profile.paths_seen(paths) >= LEAST_PATHS
}

fn expected(prepared: &Prepared, profile: &ProfileCache, paths: &str) -> Result<Estimate, Failure> {
    let request = &prepared.request;
    let settings = &request.settings;
    let primary = (settings.width * settings.height) as u64 * u64::from(settings.samples);
    let share = |threshold: f32| match &request.importance {
        None => 1.0,
        Some(map) => {
            let values = map.values().values();
            values.iter().filter(|value| **value >= threshold).count() as f64 / values.len() as f64
        }
    };
    estimate(&request.program, request.thresholds.as_deref(), primary, share, (profile, paths)).map_err(Failure::input)
}

fn report(prepared: &Prepared, estimate: &Estimate, json: bool) -> Result<(), Failure> {
    let run = prepared.request.program.components();
    let rows = estimate.components.iter().filter(|(component, _)| run.contains(*component));
    let report = Report {
        total_s: Seconds { mean: estimate.total.seconds.mean_s, q95: estimate.total.bound_s },
        primary: Row::from(&estimate.primary),
        components: rows.map(|(component, expected)| (component.to_string(), Row::from(expected))).collect(),
        endless: estimate.endless,
    };
    if estimate.endless {
        console::say(
            "warning",
            "by what is known the crex would never run out of rays: the numbers mean nothing (docs/time.md)",
        );
    }
    for (component, _) in estimate.unknown.iter().filter(|(_, unknown)| **unknown) {
        console::say("warning", &format!("nothing is known of {component}: its rays are not in the seconds"));
    }
    if json {
        return console::print_json(&report);
    }
    let line =
        |name: &str, row: &Row| format!("{name:<8} {:>14.0} {:>11.3} {:>11.3}\n", row.rays, row.mean_s, row.q95_s);
    let mut text = format!("{:<8} {:>14} {:>11} {:>11}\n", "", "rays", "seconds", "95 % below");
    text.push_str(&line("primary", &report.primary));
    for (name, row) in &report.components {
        text.push_str(&line(name, row));
    }
    text.push_str(&line("all", &Row::from(&estimate.total)));
    console::print(&text)
}
