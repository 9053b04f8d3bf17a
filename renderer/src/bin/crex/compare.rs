//! `crex compare`: how far a picture lies from a reference, in numbers and as people would see it.

use std::path::{Path, PathBuf};

use renderer::importance::map::ImportanceMap;
use renderer::importance::ran::ramp;
use renderer::picture::compare::{self, Difference};
use renderer::picture::display::{Display, DisplayError};
use renderer::picture::region::Region;
use renderer::picture::{self, Compression, Picture, Provenance, Quantity, grey};
use renderer::raster::Raster;
use serde::Serialize;

use crate::console::{self, Failure};

/// What `crex compare` takes.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The picture that is taken as the truth: EXR, HDR or PNG
    reference: PathBuf,
    /// The picture to judge: of the same size and kind
    picture: PathBuf,
    /// Also predict what people see (FLIP, JOD) on the display that this TOML file describes: `peak_cd_m2`,
    /// `black_cd_m2`, `width_px`, `height_px`, `width_m`, `distance_m`; optional `ambient_lux`, `reflectivity` and
    /// `transfer` ("srgb" or a gamma)
    #[arg(long, value_name = "FILE")]
    display: Option<PathBuf>,
    /// Radiance times this is shown as the display's white or less; needs --display
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, requires = "display")]
    exposure: f64,
    /// Also judge by itself the part of the pictures where this map, a grey .png or .exr, is at least --at-least; needs --display
    #[arg(long, value_name = "MAP", requires = "display")]
    map: Option<PathBuf>,
    /// The value of --map from which on a pixel belongs to the part; 1 is the fovea about task objects
    #[arg(long, value_name = "V", default_value_t = 1.0, requires = "map")]
    at_least: f32,
    /// Also write a picture of where they differ for people, from dark blue (not at all) to yellow (3 JOD and more); needs
    /// --display
    #[arg(long, value_name = "PICTURE", requires = "display")]
    difference: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The object that `--json` prints.
#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    difference: Difference,
    flip: Option<f64>,
    jod: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<RegionReport>,
    width: usize,
    height: usize,
}

/// The part of the pictures that `--map` picks out.
#[derive(Serialize)]
struct RegionReport {
    /// The least value of the map in it.
    at_least: f32,
    /// Part of all pixels.
    share: f64,
    flip: f64,
    jod: f64,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if !(args.exposure.is_finite() && args.exposure > 0.0) {
        return Err(Failure::input(format!("--exposure {} must be a positive number", args.exposure)));
    }
    if args.difference.as_ref().is_some_and(|path| [&args.reference, &args.picture].contains(&path)) {
        return Err(Failure::input("--difference would overwrite a picture that is compared: choose another name"));
    }
    let display = args.display.as_deref().map(read_display).transpose()?;
    let (reference, picture) = (picture::read(&args.reference)?, picture::read(&args.picture)?);
    let difference = compare::difference(&reference, &picture).map_err(Failure::input)?;
    let (mut flip, mut jod, mut region) = (None, None, None);
    if let Some(display) = &display {
        let map = compare::flip(&reference, &picture, display, args.exposure).map_err(Failure::input)?;
        flip = Some(compare::mean(&map));
        let predicted = compare::jod(&reference, &picture, display, args.exposure).map_err(Failure::input)?;
        jod = Some(predicted.jod);
        if let Some(path) = &args.difference {
            write_difference(path, &predicted.map)?;
        }
        if let Some(path) = &args.map {
            region = Some(region_report(args, path, &reference, &picture, display)?);
        }
    }
    let (width, height) = (reference.beauty.width(), reference.beauty.height());
    let report = Report { difference, flip, jod, region, width, height };
    if args.json { console::print_json(&report) } else { console::print(&words(&report, &reference, display.as_ref())) }
}

fn region_report(
    args: &Args,
    path: &Path,
    reference: &Picture,
    picture: &Picture,
    display: &Display,
) -> Result<RegionReport, Failure> {
    let map = ImportanceMap::new(grey::read(path)?).map_err(Failure::input)?;
    let (width, height) = (reference.beauty.width(), reference.beauty.height());
    let found = (map.values().width(), map.values().height());
    if found != (width, height) {
        let how = "each pixel takes the largest value of the map's pixels that it overlaps";
        let (from_x, from_y) = found;
        let message =
            format!("{} has {from_x} x {from_y} pixels, the pictures {width} x {height}: {how}", path.display());
        console::say("note", &message);
    }
    let region = Region::at_least(map.resized(width, height).values(), args.at_least);
    let region = region.ok_or_else(|| {
        let advice = "lower --at-least";
        Failure::input(format!("{}: no pixel is at least {}: {advice}", path.display(), args.at_least))
    })?;
    let seen = region.seen(reference, picture, display, args.exposure).map_err(Failure::input)?;
    Ok(RegionReport { at_least: args.at_least, share: seen.share, flip: seen.flip, jod: seen.jod })
}

/// Where people would see a difference: 1 - JOD/10 of every pixel, in colours.
fn write_difference(path: &Path, map: &Raster<f32>) -> Result<(), Failure> {
    /// The loss, in JOD, that the brightest colour stands for.
    const MOST_JOD: f64 = 3.0;
    let colour = |&value: &f32| ramp(10.0 * f64::from(value) / MOST_JOD).as_vec3().to_array();
    let pixels = map.values().iter().map(colour).collect();
    let beauty = Raster::from_values(map.width(), map.height(), pixels)
        .ok_or_else(|| Failure::Cannot("the picture of the difference lost pixels".to_owned()))?;
    let provenance = Provenance { software: format!("crex {}", env!("CARGO_PKG_VERSION")), ..Provenance::default() };
    let picture = Picture { quantity: Quantity::Display, beauty, layers: Vec::new(), provenance };
    Ok(picture::write(path, &picture, Compression::Zip)?)
}

/// Reads a display file.
pub(crate) fn read_display(path: &Path) -> Result<Display, Failure> {
    Display::read(path).map_err(|error| match error {
        DisplayError::Read { ref error, .. } if error.kind() != std::io::ErrorKind::NotFound => {
            Failure::Cannot(error.to_string())
        }
        other => Failure::input(other),
    })
}

/// The report for people.
fn words(report: &Report, reference: &Picture, display: Option<&Display>) -> String {
    let Report { difference, flip, jod, region, width, height } = report;
    let unit = match reference.quantity {
        Quantity::Radiance => "W/(sr m2)",
        Quantity::Display => "parts of the display's white",
    };
    let number =
        |value: Option<f64>| value.map_or("none: the reference is black".to_owned(), |value| format!("{value:.6}"));
    let mut text = format!(
        "{width} x {height} pixels, luminance in {unit}\n\
         RMSE           {:.6}\n\
         relative MSE   {}\n\
         mean ratio     {}\n\
         largest        {:.6} (any channel)\n\
         identical      {}\n",
        difference.rmse,
        number(difference.rel_mse),
        number(difference.mean_ratio),
        difference.max_abs,
        if difference.identical { "yes, every bit" } else { "no" },
    );
    if let (Some(flip), Some(jod), Some(display)) = (flip, jod, display) {
        text.push_str(&format!(
            "FLIP           {flip:.6} (mean; 0 is no difference)\n\
             JOD            {jod:.4} (10 is no visible difference; ColorVideoVDP v0.5.7, {:.2} pix/deg, Lpeak={}, \
             Lblack={}, Eambient={} lux)\n",
            display.pixels_per_degree(),
            display.peak_cd_m2,
            display.black_cd_m2,
            display.ambient_lux,
        ));
    }
    if let Some(RegionReport { at_least, share, flip, jod }) = region {
        text.push_str(&format!(
            "where the map is at least {at_least} ({:.1} % of the pixels)\n\
             FLIP           {flip:.6}\n\
             JOD            {jod:.4}\n",
            100.0 * share,
        ));
    }
    text
}
