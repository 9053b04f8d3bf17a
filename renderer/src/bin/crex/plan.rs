//! `crex plan`: a crex explained, or what is wrong with it.

use std::path::PathBuf;

use renderer::component::{Component, ComponentSet};
use renderer::crex::{self, PlanReport, Setting};
use serde::Serialize;

use crate::console::{self, Failure};
use crate::scene_files::{self, SearchArgs};

/// What `crex plan` takes.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The component regular expression, such as 'T{RSGM}'; an empty one is primary rays and direct light
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    crex: String,
    /// Scenes, to say which components they can spawn
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    plan: PlanReport,
    /// Letters of what the scenes can spawn; none without scenes.
    components: Option<Vec<char>>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let components = match args.scenes.as_slice() {
        [] => None,
        // What the specular threshold -st leaves of the glossy rays is known only to a rendering.
        scenes => Some(scene_files::load(scenes, &args.search)?.scene.components(0.0)),
    };
    let setting = Setting { components, ..Setting::default() };
    if args.json {
        let plan = PlanReport::new(&args.crex, &setting);
        let valid = plan.valid;
        let components = components.map(|set| set.iter().map(Component::letter).collect());
        console::print_json(&Report { plan, components })?;
        return if valid { Ok(()) } else { Err(Failure::Told) };
    }
    let ast = parse(&args.crex)?;
    for warning in crex::warnings(&ast, &setting) {
        console::say("warning", &warning.render(&args.crex));
    }
    let mut text = crex::explain(&ast);
    if let Some(components) = components {
        text.push_str(&spawned(components));
    }
    console::print(&text)
}

/// What scenes can spawn, in a sentence.
fn spawned(components: ComponentSet) -> String {
    let letters = |set: Vec<Component>| set.iter().map(Component::to_string).collect::<Vec<_>>().join(" ");
    let (can, cannot): (Vec<_>, Vec<_>) =
        Component::ALL.into_iter().partition(|&component| components.contains(component));
    match (can.is_empty(), cannot.is_empty()) {
        (true, _) => "The scene spawns no rays: its picture is direct light.\n".to_owned(),
        (_, true) => format!("The scene can spawn rays of every component: {}.\n", letters(can)),
        _ => format!("The scene can spawn {}; no material spawns {}.\n", letters(can), letters(cannot)),
    }
}

/// Parses a crex; what is wrong is shown in the text, underlined.
pub(crate) fn parse(text: &str) -> Result<crex::Ast, Failure> {
    crex::parse(text).map_err(|errors| Failure::Input(errors.iter().map(|error| error.render(text)).collect()))
}
