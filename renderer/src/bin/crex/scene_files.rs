//! From scene files on the command line to a scene.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use renderer::picture::Input;
use renderer::rad::{self, Commands, DiskFiles, Document, Files, Rif, RifView, Source};
use renderer::scene::Scene;
use stimuli::Sha256;

use crate::console::{self, Failure};

/// What the commands that read scenes take.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct SceneArgs {
    /// Scene files (.rad, .rif), read as one, or an octree (.oct); `-` is standard input
    #[arg(value_name = "SCENE", required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) search: SearchArgs,
}

/// Where files that scenes name are looked for.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct SearchArgs {
    /// Folders in which files that scenes name are looked for, after the scene's own and before those of RAYPATH
    #[arg(long = "path", value_name = "DIRS")]
    path: Vec<PathBuf>,
    /// Let scenes run any command; without it only xform, genbox and the like are carried out, and no other program is started
    #[arg(long)]
    allow_commands: bool,
}

/// Runs the commands of scenes that are trusted, as Radiance does.
struct Shell;

impl Commands for Shell {
    fn run(&self, line: &str, folder: &str) -> Result<Vec<u8>, String> {
        let folder = if folder.is_empty() { "." } else { folder };
        let output = Command::new("sh").arg("-c").arg(line).current_dir(folder).stderr(Stdio::inherit()).output();
        let output = output.map_err(|error| format!("could not be started: {error}"))?;
        if output.status.success() { Ok(output.stdout) } else { Err(format!("failed ({})", output.status)) }
    }
}

impl SearchArgs {
    /// Finds files in the scene's folder, then `--path`, then RAYPATH, which the program reads and the library never.
    pub(crate) fn files(&self) -> DiskFiles {
        let given = self.path.iter().flat_map(std::env::split_paths);
        let ray_path = std::env::var_os("RAYPATH").unwrap_or_default();
        // An empty entry, or `.`, would be the current folder; rpict looks there first, the scene's folder stands in for it.
        let usual = std::env::split_paths(&ray_path).filter(|place| !place.as_os_str().is_empty());
        DiskFiles::new(given.chain(usual).collect())
    }
}

/// A scene with what its pictures say of their making.
pub(crate) struct LoadedScene {
    pub(crate) scene: Scene,
    pub(crate) inputs: Vec<Input>,
    /// The files that were read, as they were found.
    pub(crate) files: Vec<PathBuf>,
    /// The views that .rif files name, with their files' folders.
    pub(crate) views: Vec<(RifView, String)>,
}

/// Reads scene files as one scene; warnings go to standard error.
pub(crate) fn load(scenes: &[PathBuf], search: &SearchArgs) -> Result<LoadedScene, Failure> {
    let commands = search.allow_commands.then_some(&Shell as &dyn Commands);
    let options = rad::Options { commands, ..rad::Options::default() };
    let search_files = search.files();
    let mut views = Vec::new();
    let document = if let [only] = scenes
        && has_extension(only, &["oct", "octf"])
    {
        rad::read_octree(&source(only)?, &search_files, &options)
    } else {
        let mut sources = Vec::new();
        for path in scenes {
            let text = source(path)?;
            if has_extension(path, &["rif"]) {
                let rif = Rif::read(&text).map_err(|errors| told(&errors))?;
                sources.extend(rif.scene(&search_files, &text.folder).map_err(|errors| told(&errors))?);
                views.extend(rif.views().into_iter().map(|view| (view, text.folder.clone())));
            } else {
                sources.push(text);
            }
        }
        rad::read(&sources, &search_files, &options)
    };
    let document = document.map_err(|errors| told(&errors))?;
    let scene = Scene::from_rad_with(&document, &search_files).map_err(|errors| told(&errors))?;
    for warning in document.warnings.iter().chain(&scene.warnings) {
        console::say("warning", &warning.to_string());
    }
    let files = document.sources.iter().map(|source| PathBuf::from(&source.name)).filter(|path| path.is_file());
    Ok(LoadedScene { inputs: inputs(&document), files: files.collect(), scene, views })
}

fn source(path: &Path) -> Result<Source, Failure> {
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().read_to_end(&mut bytes);
        read.map_err(|error| Failure::Cannot(format!("standard input: {error}")))?;
        return Ok(Source::new("standard input", bytes));
    }
    let name = path.to_string_lossy();
    // The place that is given is the only one: RAYPATH is for what scenes name.
    let found = DiskFiles::default().find(&name, "");
    found.map(Source::from).map_err(|reason| Failure::input(format!("{name}: {reason}")))
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|found| extensions.iter().any(|extension| found == *extension))
}

/// Each mistake with its place, the line and a caret.
fn told(errors: &[rad::Error]) -> Failure {
    Failure::Input(errors.iter().map(|error| error.to_string().trim_end().to_owned()).collect::<Vec<_>>().join("\n"))
}

/// The texts that were read, by name and hash.
fn inputs(document: &Document) -> Vec<Input> {
    let text = |source: &rad::SourceFile| Input {
        name: base_name(&source.name),
        sha256: Sha256::of(source.text.as_bytes()).to_string(),
    };
    document.sources.iter().map(text).collect()
}

/// A file's name without its folder.
pub(crate) fn base_name(name: &str) -> String {
    Path::new(name).file_name().map_or_else(|| name.to_owned(), |name| name.to_string_lossy().into_owned())
}
