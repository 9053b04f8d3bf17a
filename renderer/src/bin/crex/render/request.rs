//! A request of `crex render`: everything that its pictures depend on, read and checked.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use clap::{Args as _, FromArgMatches as _};
use renderer::component::Component;
use renderer::crex::{self, Program, Setting};
use renderer::film::{Layers, Plane};
use renderer::geometry::Aggregate;
use renderer::importance::map::ImportanceMap;
use renderer::picture::{Input, Provenance, grey};
use renderer::rad::RifView;
use renderer::render::{Account, RenderError, Renderer, Rendering, Settings, Snapshot};
use renderer::scene::{Holdings, Scene, View};
use renderer::schedule::MonotonicClock;
use renderer::transport::Limits;
use stimuli::Sha256;

use super::{Args, LayerChoice};
use crate::console::{self, Failure, Progress};
use crate::options::RadianceOptions;
use crate::scene_files::{self, LoadedScene, SceneArgs};
use crate::{plan, timed};

/// Takes the picture after every stage.
type Show<'a> = &'a mut (dyn FnMut(Snapshot<'_>) + Send);

/// Everything that a picture depends on, checked.
pub(crate) struct Request {
    pub(crate) program: Program,
    pub(crate) view: View,
    pub(crate) settings: Settings,
    pub(crate) importance: Option<ImportanceMap>,
    pub(crate) thresholds: Option<Vec<f32>>,
    pub(crate) continuous: bool,
    /// Components whose planes are smoothed.
    pub(crate) filter: Vec<Component>,
    pub(crate) provenance: Provenance,
}

impl Request {
    /// What `{ }` heeds, in words that are equal just if it is.
    pub(crate) fn modulation(&self) -> String {
        let map = self.importance.as_ref().and(self.provenance.inputs.last());
        let map = map.map_or("no map", |input| input.sha256.as_str());
        let thresholds: Vec<String> = self.thresholds.iter().flatten().map(f32::to_string).collect();
        let rule =
            if self.continuous { "continuous".to_owned() } else { format!("thresholds {}", thresholds.join(",")) };
        format!("{map}; {rule}")
    }
}

/// A scene and what is asked of it, ready to be rendered.
pub(crate) struct Prepared {
    pub(crate) request: Request,
    /// The files that were read for the scene.
    pub(crate) files: Vec<PathBuf>,
    scene: Scene,
    /// Its hierarchy, built when first asked for.
    aggregate: OnceCell<Aggregate>,
    scene_inputs: Vec<Input>,
}

/// Reads and checks everything; warnings go to standard error.
pub(crate) fn prepare(args: &Args, options: &RadianceOptions) -> Result<Prepared, Failure> {
    for message in &options.without_effect {
        console::say("note", message);
    }
    let ast = plan::parse(&args.crex)?;
    let LoadedScene { mut scene, inputs, files, views } = scene_files::load(&args.scene.scenes, &args.scene.search)?;
    scene.set_relays(options.relays);
    let scene_inputs = inputs.clone();
    let with_view = rif_view(args.view.as_deref(), &views, options)?;
    let options = with_view.as_ref().unwrap_or(options);
    let request = request(args, options, Program::new(&ast), inputs)?;
    let setting = Setting {
        components: Some(scene.components(options.glossy_threshold)),
        importance_map: Some(args.importance.is_some()),
        time_limit: Some(args.time.is_some()),
    };
    for warning in crex::warnings(&ast, &setting) {
        console::say("warning", &warning.render(&args.crex));
    }
    Ok(Prepared { request, files, scene, aggregate: OnceCell::new(), scene_inputs })
}

/// The options with the view of that name, or the first one if no view is given otherwise.
fn rif_view(
    name: Option<&str>,
    views: &[(RifView, String)],
    options: &RadianceOptions,
) -> Result<Option<RadianceOptions>, Failure> {
    let chosen = match name {
        Some(name) => Some(views.iter().find(|(view, _)| view.name.as_deref() == Some(name)).ok_or_else(|| {
            let names: Vec<&str> = views.iter().filter_map(|(view, _)| view.name.as_deref()).collect();
            Failure::input(format!("no .rif file has a view `{name}`; views: {}", names.join(", ")))
        })?),
        None if options.view_given => None,
        None => views.first(),
    };
    let Some((view, folder)) = chosen else { return Ok(None) };
    let mut options = options.clone();
    options.take_view(&view.options, Path::new(folder)).map_err(Failure::input)?;
    Ok(Some(options))
}

/// The same for commands that choose crex and samples themselves: everything but those as `crex render` takes it.
pub(crate) fn prepare_scene(
    scene: &SceneArgs,
    threads: Option<u32>,
    seed: u64,
    importance: Option<&Path>,
    options: &RadianceOptions,
) -> Result<Prepared, Failure> {
    let mut words: Vec<std::ffi::OsString> =
        ["render", "scene", "--crex", "", "-o", "-", "--seed"].map(Into::into).into();
    words.push(seed.to_string().into());
    if let Some(threads) = threads {
        words.extend(["--threads".into(), threads.to_string().into()]);
    }
    if let Some(map) = importance {
        words.extend(["--importance".into(), map.into()]);
    }
    let command = Args::augment_args(clap::Command::new("render"));
    let matches = command.try_get_matches_from(words).map_err(Failure::Usage)?;
    let args = Args { scene: scene.clone(), ..Args::from_arg_matches(&matches).map_err(Failure::Usage)? };
    prepare(&args, options)
}

impl Prepared {
    /// What the scene holds.
    pub(crate) fn holdings(&self) -> Holdings {
        self.scene.holdings()
    }

    /// The scene.
    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene's hierarchy of surfaces.
    pub(crate) fn aggregate(&self) -> &Aggregate {
        self.aggregate.get_or_init(|| self.scene.aggregate())
    }

    /// The planes of the picture.
    pub(crate) fn planes(&self) -> Vec<Plane> {
        let Request { program, settings, .. } = &self.request;
        renderer::render::planes(&self.scene, program, settings)
    }

    /// Renders, with a bar on standard error; `show` gets the picture after every stage.
    pub(crate) fn render(&self, clock: &MonotonicClock, show: Option<Show<'_>>) -> Result<Rendering, Failure> {
        let smoothed = &self.request.filter;
        let (rendering, planes) = self.with_progress(clock, |renderer| match show {
            Some(show) => renderer.render_stages(show).map(|rendering| (rendering, Vec::new())),
            None if smoothed.is_empty() => renderer.render().map(|rendering| (rendering, Vec::new())),
            None => renderer.render_smoothed(smoothed.iter().copied().collect()),
        })?;
        for plane in planes {
            let percent = [plane.noise_before, plane.noise_after].map(|noise| 100.0 * noise);
            console::say(
                "note",
                &format!(
                    "{} is smoothed: noise {:.2} % of its mean, {:.2} % afterwards, beside what smoothing moved",
                    plane.component, percent[0], percent[1]
                ),
            );
        }
        self.warn_of_stopped(&rendering.account());
        Ok(rendering)
    }

    /// Warns of each `*` that was stopped before its rays ran out.
    pub(super) fn warn_of_stopped(&self, account: &Account) {
        for span in &account.stopped {
            let text = crex::Warning { message: "`*` was stopped after a million runs".to_owned(), span: *span };
            console::say("warning", &text.render(self.request.program.text()));
        }
    }

    /// Does something with a renderer of what is asked for, with a bar on standard error.
    pub(super) fn with_progress<T, E: Into<Failure>>(
        &self,
        clock: &MonotonicClock,
        work: impl FnOnce(Renderer<'_>) -> Result<T, E>,
    ) -> Result<T, Failure> {
        let progress = Progress::new(clock);
        let report = |fraction| progress.set(fraction);
        let made = self.with_renderer(clock, |renderer| Ok(work(renderer.with_progress(&report))))?;
        progress.done();
        made.map_err(Into::into)
    }

    /// Does something with a renderer of what is asked for.
    pub(crate) fn with_renderer<T>(
        &self,
        clock: &MonotonicClock,
        work: impl FnOnce(Renderer<'_>) -> Result<T, RenderError>,
    ) -> Result<T, Failure> {
        let Request { program, view, settings, .. } = &self.request;
        let mut renderer = Renderer::new(&self.scene, self.aggregate(), view, program, clock, settings.clone())?;
        if let Some(map) = &self.request.importance {
            renderer = renderer.with_importance(map.values())?;
        }
        if let Some(thresholds) = &self.request.thresholds {
            renderer = renderer.with_thresholds(thresholds)?;
        }
        if self.request.continuous {
            renderer = renderer.with_continuous_importance();
        }
        work(renderer).map_err(Failure::from)
    }

    /// What the scene was made from.
    pub(crate) fn scene_hash(&self) -> String {
        timed::scene_hash(&self.scene_inputs)
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Threads { .. } => Self::Cannot(error.to_string()),
            _ => Self::input(error),
        }
    }
}

fn request(args: &Args, options: &RadianceOptions, program: Program, inputs: Vec<Input>) -> Result<Request, Failure> {
    if !options.view_given {
        console::say(
            "warning",
            "no view is given (-vf FILE, or -vp, -vd and so on): rpict's default looks north from the origin",
        );
    }
    let view = View::new(options.view).map_err(Failure::input)?;
    let [width, height] = options.size.map(|pixels| pixels as usize);
    let (width, height) = view.resolution(width, height, options.pixel_aspect);
    let threads = args.threads.or(options.threads).map(|threads| threads as usize);
    let settings = Settings {
        width,
        height,
        samples: args.spp,
        seed: args.seed,
        jitter: options.pixel_jitter,
        aperture: options.aperture,
        limits: Limits {
            reflections: options.reflections,
            least_weight: options.least_weight,
            diffuse: options.diffuse,
            glossy_threshold: options.glossy_threshold,
            diffuse_rays: options.diffuse_rays,
            glossy_rays: options.glossy_rays,
        },
        ambient: options.ambient.into(),
        lights_visible: options.lights_visible,
        layers: match args.layers {
            LayerChoice::Last => Layers::Last,
            LayerChoice::First => Layers::First,
        },
        threads,
    };
    let mut inputs = inputs;
    let importance = match &args.importance {
        None => None,
        Some(path) => {
            let (map, input) = importance(path, width, height)?;
            inputs.push(input);
            Some(map)
        }
    };
    if !args.filter.is_empty() && matches!(args.layers, LayerChoice::First) {
        return Err(Failure::input("--filter smooths what the last event brought: it cannot go with --layers first"));
    }
    let mut words = format!("--spp {} --seed {}", args.spp, args.seed);
    if matches!(args.layers, LayerChoice::First) {
        words.push_str(" --layers first");
    }
    if let Some(thresholds) = &args.thresholds {
        let list: Vec<String> = thresholds.iter().map(f32::to_string).collect();
        words.push_str(&format!(" --thresholds {}", list.join(",")));
    }
    if !args.filter.is_empty() {
        let letters: Vec<String> = args.filter.iter().map(ToString::to_string).collect();
        words.push_str(&format!(" --filter {}", letters.join(",")));
    }
    if args.continuous {
        words.push_str(" --continuous");
    }
    if !options.spelled.is_empty() {
        words.push_str(&format!(" {}", options.spelled));
    }
    let provenance = Provenance {
        software: format!("crex {}", env!("CARGO_PKG_VERSION")),
        crex: Some(args.crex.clone()),
        view: Some(options.view.to_string()),
        options: Some(words),
        inputs,
        exposure: None,
    };
    let (thresholds, continuous) = (args.thresholds.clone(), args.continuous);
    let filter = args.filter.clone();
    Ok(Request { program, view, settings, importance, thresholds, continuous, filter, provenance })
}

/// Reads an importance map and brings it to the picture's size, with a word on how.
fn importance(path: &Path, width: usize, height: usize) -> Result<(ImportanceMap, Input), Failure> {
    let bytes = std::fs::read(path).unwrap_or_default();
    let map = grey::read(path)?;
    let (found_width, found_height) = (map.width(), map.height());
    let map = ImportanceMap::new(map).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
    let map = if (found_width, found_height) == (width, height) {
        map
    } else {
        console::say(
            "note",
            &format!(
                "{} has {found_width} x {found_height} pixels, the picture {width} x {height}: each pixel takes the largest \
                 value of the map's pixels that it overlaps",
                path.display()
            ),
        );
        map.resized(width, height)
    };
    let name = scene_files::base_name(&path.to_string_lossy());
    Ok((map, Input { name, sha256: Sha256::of(&bytes).to_string() }))
}
