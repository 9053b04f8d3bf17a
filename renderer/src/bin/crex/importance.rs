//! `crex importance`: where people look, as a map for `{ }`.

use std::path::{Path, PathBuf};

use renderer::crex::{self, Program};
use renderer::importance::fovea::{Falloff, Fovea};
use renderer::importance::map::ImportanceMap;
use renderer::importance::overlay::overlay;
use renderer::importance::{glob, saliency};
use renderer::picture::display::Display;
use renderer::picture::grey::{self, Bits};
use renderer::picture::{self, Compression, Format, Picture, Provenance, Quantity};
use renderer::rad;
use renderer::raster::Raster;
use renderer::render::{Renderer, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::MonotonicClock;
use renderer::transport::{Samples, Tracer};
use stimuli::Sha256;
use stimuli::study::DisplayGeometry;

use crate::console::{self, Failure};
use crate::options::RadianceOptions;
use crate::output;
use crate::scene_files::{self, LoadedScene, SearchArgs};

/// Rays through a pixel, a side, that look for task objects.
const RAYS_A_SIDE: usize = 4;

/// The paper's display: 17 inches of 1280 x 1024 pixels at 60 cm.
const PAPER_DISPLAY: DisplayGeometry =
    DisplayGeometry { width_px: 1280, height_px: 1024, width_m: 0.3372, distance_m: 0.60 };

/// What `crex importance` takes besides rpict's options for the view and the size.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Args {
    /// Scene files (.rad), read as one; `-` is standard input. None if the map is of a picture alone (--saliency --of)
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArgs,
    /// The map: a grey .png, or .exr
    #[arg(short, long, value_name = "MAP")]
    output: PathBuf,
    /// Task objects: identifiers or modifiers of surfaces, * for any characters and ? for one, such as
    /// 'extinguisher.*,exit_sign.*'; may be repeated
    #[arg(long, value_name = "ID,..", value_delimiter = ',')]
    task: Vec<String>,
    /// Diameter of the fovea in degrees: within half of it from a task object the map is 1
    #[arg(long, value_name = "DEG", default_value_t = 2.0, allow_negative_numbers = true)]
    fovea: f64,
    /// How the map falls off beyond: mar (smallest resolved angle), cortical (magnification) or geisler-perry (highest
    /// frequency seen)
    #[arg(long, value_name = "LAW", default_value = "mar")]
    falloff: Falloff,
    /// Pixels in a degree of sight at the picture
    #[arg(long, value_name = "N", conflicts_with = "display")]
    px_per_deg: Option<f64>,
    /// The display, as for `crex compare`, which the picture fills [default: 17 inches at 60 cm, as in the paper]
    #[arg(long, value_name = "FILE")]
    display: Option<PathBuf>,
    /// Also what catches the eye (Itti, Koch and Niebur 1998): of the scene under direct light, or of --of
    #[arg(long)]
    saliency: bool,
    /// The picture that --saliency looks at: PNG, EXR or HDR
    #[arg(long, value_name = "PICTURE", requires = "saliency")]
    of: Option<PathBuf>,
    /// Radiance times this is what --saliency looks at
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0)]
    exposure: f64,
    /// Weight of the saliency map against the task map, from 0 to 1 [default: .5 if both are asked for]
    #[arg(long, value_name = "W", requires_all = ["task", "saliency"])]
    weight: Option<f32>,
    /// Bits of a PNG's codes: 8 or 16
    #[arg(long, value_name = "BITS", default_value = "16", value_parser = ["8", "16"])]
    bits: String,
    /// Also write the map laid over the picture, dark blue where nothing matters and yellow where all does
    #[arg(long, value_name = "PICTURE")]
    overlay: Option<PathBuf>,
}

/// The scene and the view of it.
struct Place {
    scene: Scene,
    view: View,
}

/// A map that was made, and the files that were read for its scene.
pub(crate) struct Made {
    pub(crate) files: Vec<PathBuf>,
}

pub(crate) fn run(args: &Args, options: &RadianceOptions, clock: &MonotonicClock) -> Result<Made, Failure> {
    check(args)?;
    let mut provenance =
        Provenance { software: format!("crex {}", env!("CARGO_PKG_VERSION")), ..Provenance::default() };
    let looked_at = match &args.of {
        None => None,
        Some(path) => {
            let digest = Sha256::of_file(path).map_err(Failure::input)?.to_string();
            let name = scene_files::base_name(&path.to_string_lossy());
            provenance.inputs.push(picture::Input { name, sha256: digest });
            Some(picture::read(path)?)
        }
    };
    let (place, files) = match place(args, options, &mut provenance)? {
        Some((place, files)) => (Some(place), files),
        None => (None, Vec::new()),
    };
    let (width, height) = size(args, options, place.as_ref(), looked_at.as_ref())?;

    let task = match &place {
        Some(place) if !args.task.is_empty() => Some(task_map(args, place, (width, height), &mut provenance)?),
        _ => None,
    };
    // The scene under direct light is rendered only if something looks at it.
    let shown = match (looked_at, &place) {
        (Some(picture), _) => Some(picture),
        (None, Some(place)) if args.saliency || args.overlay.is_some() => {
            Some(low_level(place, (width, height), options, clock)?)
        }
        _ => None,
    };
    let salient = match &shown {
        Some(picture) if args.saliency => Some(saliency_map(args, picture, (width, height))?),
        _ => None,
    };
    let map = mixed(args, task, salient, &mut provenance)?;
    let bits = if args.bits == "8" { Bits::Eight } else { Bits::Sixteen };
    grey::write(&args.output, map.values(), bits, &provenance)?;
    if let (Some(path), Some(shown)) = (&args.overlay, &shown) {
        write_overlay(path, shown, args.exposure, &map, provenance)?;
    }
    Ok(Made { files })
}

/// What can be said before anything is read.
fn check(args: &Args) -> Result<(), Failure> {
    if args.task.is_empty() && !args.saliency {
        return Err(Failure::input("say what matters: --task ID.. for objects, --saliency for what catches the eye"));
    }
    if args.scenes.is_empty() && (args.of.is_none() || !args.task.is_empty()) {
        return Err(Failure::input("give the scene; only `--saliency --of PICTURE` without --task needs none"));
    }
    if !(0.0..1e6).contains(&args.fovea) {
        return Err(Failure::input(format!("--fovea {} must be degrees, from 0 to below 1000000", args.fovea)));
    }
    if let Some(given) = args.px_per_deg.filter(|given| !(f64::MIN_POSITIVE..1e6).contains(given)) {
        return Err(Failure::input(format!("--px-per-deg {given} must be above 0 and below 1000000")));
    }
    if !(args.exposure.is_finite() && args.exposure > 0.0) {
        return Err(Failure::input(format!("--exposure {} must be a positive number", args.exposure)));
    }
    if let Some(weight) = args.weight.filter(|weight| !(0.0..=1.0).contains(weight)) {
        let help = "0 is the task map alone, 1 the saliency map alone";
        return Err(Failure::input(format!("--weight {weight} must lie from 0 to 1: {help}")));
    }
    if !matches!(Format::of_name(&args.output), Some(Format::Png | Format::Exr)) {
        let advice = "a map is a grey .png or an .exr";
        return Err(Failure::input(format!("-o {}: {advice}", args.output.display())));
    }
    if let Some(path) = args.overlay.as_deref().filter(|path| Format::of_name(path).is_none()) {
        let advice = "says no picture format: end its name in .png, .exr or .hdr";
        return Err(Failure::input(format!("--overlay {}: {advice}", path.display())));
    }
    if args.overlay.as_ref() == Some(&args.output) {
        return Err(Failure::input("-o and --overlay name the same file"));
    }
    for path in std::iter::once(&args.output).chain(&args.overlay) {
        if args.of.as_ref() == Some(path) {
            let advice = "is read, and would be overwritten: choose another name";
            return Err(Failure::input(format!("{}: {advice}", path.display())));
        }
        output::check_place(path)?;
    }
    Ok(())
}

/// Reads the scene, if there is one, and its view.
fn place(
    args: &Args,
    options: &RadianceOptions,
    provenance: &mut Provenance,
) -> Result<Option<(Place, Vec<PathBuf>)>, Failure> {
    if args.scenes.is_empty() {
        return Ok(None);
    }
    let LoadedScene { scene, inputs, files, .. } = scene_files::load(&args.scenes, &args.search)?;
    if !options.view_given {
        console::say("warning", "no view is given (-vf FILE, or -vp, -vd and so on): rpict's default looks north");
    }
    provenance.inputs.extend(inputs);
    provenance.view = Some(options.view.to_string());
    let view = View::new(options.view).map_err(Failure::input)?;
    Ok(Some((Place { scene, view }, files)))
}

/// Columns and rows: what the view makes of -x and -y, or those of the picture looked at.
fn size(
    args: &Args,
    options: &RadianceOptions,
    place: Option<&Place>,
    looked_at: Option<&Picture>,
) -> Result<(usize, usize), Failure> {
    match (place, looked_at) {
        (Some(place), _) => {
            let [width, height] = options.size.map(|pixels| pixels as usize);
            Ok(place.view.resolution(width, height, options.pixel_aspect))
        }
        (None, Some(picture)) => Ok((picture.beauty.width(), picture.beauty.height())),
        (None, None) => Err(Failure::input(format!("-o {}: no scene and no picture", args.output.display()))),
    }
}

/// 1 on and around the task objects, falling off as sight does.
fn task_map(
    args: &Args,
    place: &Place,
    (width, height): (usize, usize),
    provenance: &mut Provenance,
) -> Result<ImportanceMap, Failure> {
    let scene = &place.scene;
    let counts = task_surfaces(scene, &args.task)?;
    let aggregate = scene.aggregate();
    let samples = Samples { view: &place.view, width, height, jitter: 1.0, aperture: 0.0 };
    let tracer = Tracer::new(scene, &aggregate);
    let objects = tracer.pixels_showing(&samples, RAYS_A_SIDE, |surface| counts[surface.index()]);
    let shown = objects.values().iter().filter(|&&shows| shows).count();
    if shown == 0 {
        console::say("warning", "no pixel shows a task object: the task map is 0 everywhere");
    }
    let px_per_deg = px_per_deg(args, width)?;
    let fovea = Fovea { diameter_deg: args.fovea, falloff: args.falloff, px_per_deg };
    let geometry = format!("--fovea {} --falloff {} --px-per-deg {px_per_deg}", args.fovea, args.falloff);
    console::say("note", &format!("{shown} of {} pixels show a task object; {geometry}", width * height));
    provenance.options = Some(format!("--task {} {geometry}", args.task.join(",")));
    Ok(ImportanceMap::of_task(&objects, &fovea))
}

/// For each surface, whether a pattern names it or its modifier.
fn task_surfaces(scene: &Scene, patterns: &[String]) -> Result<Vec<bool>, Failure> {
    let mut counts = vec![false; scene.surfaces.len()];
    for pattern in patterns {
        let mut found = false;
        for (surface, counts) in scene.surfaces.iter().zip(&mut counts) {
            let names = std::iter::once(surface.name).chain(surface.modifier);
            if names.into_iter().any(|name| glob::matches(pattern, scene.name(name))) {
                *counts = true;
                found = true;
            }
        }
        if !found {
            let all = scene.surfaces.iter().flat_map(|surface| std::iter::once(surface.name).chain(surface.modifier));
            let near = rad::nearest(pattern, all.map(|name| scene.name(name)));
            let advice = near.map_or("the names in the scene are told by its .rad files".to_owned(), |near| {
                format!("did you mean `{near}`?")
            });
            let message = format!("--task {pattern}: no surface has such an identifier or modifier: {advice}");
            return Err(Failure::input(message));
        }
    }
    Ok(counts)
}

/// Pixels in a degree, for a picture that fills the display's width.
fn px_per_deg(args: &Args, width: usize) -> Result<f64, Failure> {
    if let Some(given) = args.px_per_deg {
        return Ok(given);
    }
    let geometry = match &args.display {
        None => PAPER_DISPLAY,
        Some(path) => {
            let Display { width_px, height_px, width_m, distance_m, .. } =
                Display::read(path).map_err(Failure::input)?;
            DisplayGeometry { width_px, height_px, width_m, distance_m }
        }
    };
    Ok(geometry.pixels_per_degree() * width as f64 / f64::from(geometry.width_px))
}

/// The scene under direct light, one sample a pixel: what the saliency map of a scene looks at.
fn low_level(
    place: &Place,
    (width, height): (usize, usize),
    options: &RadianceOptions,
    clock: &MonotonicClock,
) -> Result<Picture, Failure> {
    let program = Program::new(&crex::parse("").map_err(|_| Failure::input("the empty crex"))?);
    let mut settings = Settings::new(width, height);
    settings.ambient = options.ambient.into();
    let aggregate = place.scene.aggregate();
    let renderer = Renderer::new(&place.scene, &aggregate, &place.view, &program, clock, settings);
    let rendering = renderer.and_then(|renderer| renderer.render()).map_err(Failure::input)?;
    let beauty = rendering.film.beauty();
    let pixels = beauty.values().iter().map(|pixel| pixel.to_array()).collect();
    let beauty = Raster::from_values(width, height, pixels)
        .ok_or_else(|| Failure::Cannot("the picture under direct light lost pixels".to_owned()))?;
    Ok(Picture { quantity: Quantity::Radiance, beauty, layers: Vec::new(), provenance: Provenance::default() })
}

fn saliency_map(args: &Args, picture: &Picture, (width, height): (usize, usize)) -> Result<ImportanceMap, Failure> {
    let map = ImportanceMap::new(saliency::saliency(&picture.codes(args.exposure))).map_err(Failure::input)?;
    let found = (picture.beauty.width(), picture.beauty.height());
    if found != (width, height) {
        let of = args.of.as_deref().unwrap_or(Path::new("the picture")).display();
        let (from_x, from_y) = found;
        let how = "each pixel takes the largest value of the pixels that it overlaps";
        let message = format!("{of} has {from_x} x {from_y} pixels, the map {width} x {height}: {how}");
        console::say("note", &message);
    }
    Ok(map.resized(width, height))
}

/// The two maps in their weights.
fn mixed(
    args: &Args,
    task: Option<ImportanceMap>,
    salient: Option<ImportanceMap>,
    provenance: &mut Provenance,
) -> Result<ImportanceMap, Failure> {
    match (task, salient) {
        (Some(task), Some(salient)) => {
            let weight = args.weight.unwrap_or(0.5);
            let words = format!("{} --saliency --weight {weight}", provenance.options.take().unwrap_or_default());
            provenance.options = Some(words);
            task.mixed(&salient, weight).ok_or_else(|| Failure::input("the two maps differ in size"))
        }
        (Some(task), None) => Ok(task),
        (None, Some(salient)) => {
            provenance.options = Some("--saliency".to_owned());
            Ok(salient)
        }
        (None, None) => Err(Failure::input("neither --task nor --saliency made a map")),
    }
}

fn write_overlay(
    path: &Path,
    shown: &Picture,
    exposure: f64,
    map: &ImportanceMap,
    provenance: Provenance,
) -> Result<(), Failure> {
    let light = shown.display_light(exposure);
    let at_size = map.resized(light.width(), light.height());
    let laid = overlay(&light, &at_size).ok_or_else(|| Failure::Cannot("the overlay lost pixels".to_owned()))?;
    let pixels = laid.values().iter().map(|pixel| pixel.as_vec3().to_array()).collect();
    let beauty = Raster::from_values(laid.width(), laid.height(), pixels)
        .ok_or_else(|| Failure::Cannot("the overlay lost pixels".to_owned()))?;
    let picture = Picture { quantity: Quantity::Display, beauty, layers: Vec::new(), provenance };
    Ok(picture::write(path, &picture, Compression::Zip)?)
}
