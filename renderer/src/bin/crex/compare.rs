//! `crex compare`: how far a picture lies from a reference, in numbers and as people would see it.

use std::path::PathBuf;

use renderer::picture::compare::{self, Difference};
use renderer::picture::display::{Display, DisplayError};
use renderer::picture::{self, Picture, Quantity};
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
    width: usize,
    height: usize,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if !(args.exposure.is_finite() && args.exposure > 0.0) {
        return Err(Failure::input(format!("--exposure {} must be a positive number", args.exposure)));
    }
    let display = args.display.as_deref().map(Display::read).transpose().map_err(|error| match error {
        DisplayError::Read { ref error, .. } if error.kind() != std::io::ErrorKind::NotFound => {
            Failure::Cannot(error.to_string())
        }
        other => Failure::input(other),
    })?;
    let (reference, picture) = (picture::read(&args.reference)?, picture::read(&args.picture)?);
    let difference = compare::difference(&reference, &picture).map_err(Failure::input)?;
    let (mut flip, mut jod) = (None, None);
    if let Some(display) = &display {
        let map = compare::flip(&reference, &picture, display, args.exposure).map_err(Failure::input)?;
        flip = Some(compare::mean(&map));
        jod = Some(compare::jod(&reference, &picture, display, args.exposure).map_err(Failure::input)?.jod);
    }
    let (width, height) = (reference.beauty.width(), reference.beauty.height());
    let report = Report { difference, flip, jod, width, height };
    if args.json { console::print_json(&report) } else { console::print(&words(&report, &reference, display.as_ref())) }
}

/// The report for people.
fn words(report: &Report, reference: &Picture, display: Option<&Display>) -> String {
    let Report { difference, flip, jod, width, height } = report;
    let unit = match reference.quantity {
        Quantity::Radiance => "W/(sr m2)",
        Quantity::Display => "of the display's white",
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
    text
}
