//! Small pictures of a scene by one crex or another: what each shows and what it costs.

use std::collections::BTreeMap;

use glam::Vec3;

use crate::color::brightness;
use crate::component::{ComponentSet, PerComponent};
use crate::crex::{self, Program};
use crate::geometry::Aggregate;
use crate::picture::Picture;
use crate::picture::compare;
use crate::picture::display::Display;
use crate::raster::Raster;
use crate::render::{Renderer, Rendering, Settings};
use crate::scene::{Scene, View};
use crate::schedule::Clock;

use super::ProposeError;
use super::levels::Levels;
use super::visibility;

/// What a crex is proposed for.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its shapes.
    pub aggregate: &'a Aggregate,
    /// The view.
    pub view: &'a View,
    /// How the picture will be rendered: size, samples, limits, ambient value.
    pub settings: &'a Settings,
    /// Where it will be looked at.
    pub display: &'a Display,
    /// Radiance times this is shown; `None` is what `pfilt` chooses, mean luminance at half of white.
    pub exposure: Option<f64>,
    /// Measures what rays cost.
    pub clock: &'a dyn Clock,
}

/// Longest side of the small pictures, pixels.
const LONGEST: f64 = 48.0;

/// Samples of each of their pixels.
const SAMPLES: u32 = 4;

/// Under a bound: the longest side of the picture that tells what pictures cost, and the least of those that tell what they show;
/// pixels, with one sample each.
const PILOT: f64 = 4.0;
const SHORTEST: f64 = 12.0;

/// How many full solutions the time for choosing has room for, so that there is time for others.
const FULL_ONES: f64 = 4.0;

/// What is known of a crex before it is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forecast {
    /// Loss of the small picture against the full solution, JOD.
    pub small_loss_jod: f64,
    /// Predicted loss of the picture that is asked for, JOD.
    pub loss_jod: f64,
    /// Predicted seconds of tracing, summed over threads.
    pub seconds: f64,
}

/// The small pictures of a scene.
pub struct Profile<'a> {
    question: Question<'a>,
    settings: Settings,
    display: Display,
    exposure: f64,
    full: Picture,
    /// Seconds for a primary ray, and for a ray of each component.
    primary_s: f64,
    ray_s: PerComponent<f64>,
    /// Rays of the picture that is asked for / rays of the small one.
    scale: f64,
    components: ComponentSet,
    known: BTreeMap<String, Forecast>,
}

impl<'a> Profile<'a> {
    /// Renders the full solution small.
    ///
    /// # Errors
    /// If the settings are refused.
    pub fn new(question: Question<'a>) -> Result<Self, ProposeError> {
        Self::of_size(question, LONGEST, SAMPLES)
    }

    /// The same with one sample for each pixel, and pictures as much smaller as is needed to look at several crexes within so
    /// many seconds, summed over threads; none if they would be too small to show anything.
    ///
    /// # Errors
    /// If the settings are refused.
    pub fn within(question: Question<'a>, seconds: f64) -> Result<Option<Self>, ProposeError> {
        let settings = small(question.settings, PILOT, 1);
        let components = question.scene.components(question.settings.limits.glossy_threshold);
        let pilot = render(&question, &settings, &Levels::full(components).crex())?;
        let pilot_s = pilot.primary.seconds + pilot.stages.iter().map(|row| row.report.seconds).sum::<f64>();
        let times = ((seconds - pilot_s) / FULL_ONES / pilot_s).max(0.0);
        // Pixels go with the square of the side.
        let longest = (PILOT * times.sqrt()).min(LONGEST);
        if longest >= SHORTEST { Self::of_size(question, longest, 1).map(Some) } else { Ok(None) }
    }

    fn of_size(question: Question<'a>, longest: f64, samples: u32) -> Result<Self, ProposeError> {
        let asked = question.settings;
        let settings = small(asked, longest, samples);
        let (width, height) = (settings.width, settings.height);
        let scale = (asked.width * asked.height) as f64 * f64::from(asked.samples)
            / ((width * height) as f64 * f64::from(samples));
        let components = question.scene.components(asked.limits.glossy_threshold);
        let text = Levels::full(components).crex();
        let rendering = render(&question, &settings, &text)?;
        let full = rendering.film.beauty();
        let exposure = question.exposure.unwrap_or_else(|| usual_exposure(&full));
        let (mut rays, mut seconds) = (PerComponent::<u64>::default(), PerComponent::<f64>::default());
        for row in &rendering.stages {
            rays[row.stage.component] += row.report.rays;
            seconds[row.stage.component] += row.report.seconds;
        }
        let each = |rays: u64, seconds: f64| if rays > 0 { seconds / rays as f64 } else { 0.0 };
        let ray_s = PerComponent::from_fn(|component| each(rays[component], seconds[component]));
        let primary_s = each(rendering.primary.rays, rendering.primary.seconds);
        let full = Picture::of_radiance(&full);
        let display = question.display.with_larger_pixels(asked.width as f64 / width as f64);
        let known = BTreeMap::new();
        let mut profile =
            Self { question, settings, display, exposure, full, primary_s, ray_s, scale, components, known };
        let seconds = scale * profile.small_seconds(&rendering);
        let whole = Forecast { small_loss_jod: 0.0, loss_jod: visibility::loss_jod(0.0), seconds };
        profile.known.insert(text, whole);
        Ok(profile)
    }

    /// The components that the scene can spawn.
    #[must_use]
    pub fn components(&self) -> ComponentSet {
        self.components
    }

    /// What radiance is multiplied by before it is shown.
    #[must_use]
    pub fn exposure(&self) -> f64 {
        self.exposure
    }

    /// What to expect of a crex. Each is rendered small once.
    ///
    /// # Errors
    /// If the settings are refused, or the display.
    pub fn forecast(&mut self, levels: &Levels) -> Result<Forecast, ProposeError> {
        let text = levels.crex();
        if let Some(known) = self.known.get(&text) {
            return Ok(*known);
        }
        let rendering = render(&self.question, &self.settings, &text)?;
        let fewer = Picture::of_radiance(&rendering.film.beauty());
        let jod = compare::jod(&self.full, &fewer, &self.display, self.exposure)?.jod;
        let small_loss_jod = (10.0 - jod).max(0.0);
        let loss_jod = visibility::loss_jod(small_loss_jod);
        let forecast = Forecast { small_loss_jod, loss_jod, seconds: self.scale * self.small_seconds(&rendering) };
        self.known.insert(text, forecast);
        Ok(forecast)
    }

    /// The small picture by a crex, and the full solution's, with the display that makes their pixels as large as theirs.
    ///
    /// # Errors
    /// If the settings are refused.
    pub fn small(&self, levels: &Levels) -> Result<(Picture, &Picture, &Display), ProposeError> {
        let rendering = render(&self.question, &self.settings, &levels.crex())?;
        Ok((Picture::of_radiance(&rendering.film.beauty()), &self.full, &self.display))
    }

    /// From rays counted, which do not waver, and the seconds that a ray of each kind took in the full solution.
    fn small_seconds(&self, rendering: &Rendering) -> f64 {
        let stages = rendering.stages.iter().map(|row| row.report.rays as f64 * self.ray_s[row.stage.component]);
        rendering.primary.rays as f64 * self.primary_s + stages.sum::<f64>()
    }
}

/// Settings for a small picture.
fn small(asked: &Settings, longest: f64, samples: u32) -> Settings {
    let factor = (asked.width.max(asked.height) as f64 / longest).max(1.0);
    let small = |pixels: usize| ((pixels as f64 / factor).round() as usize).max(1);
    Settings { width: small(asked.width), height: small(asked.height), samples, ..asked.clone() }
}

/// Renders by a crex that the module has spelled.
fn render(question: &Question<'_>, settings: &Settings, crex: &str) -> Result<Rendering, ProposeError> {
    let program = Program::new(&crex::parse(crex).expect("every spelling of levels parses"));
    let Question { scene, aggregate, view, clock, .. } = *question;
    Ok(Renderer::new(scene, aggregate, view, &program, clock, settings.clone())?.render()?)
}

/// The exposure that `pfilt(1)` of Radiance chooses: mean luminance of .5; 1 if the picture is black.
#[must_use]
pub fn usual_exposure(picture: &Raster<Vec3>) -> f64 {
    let sum: f64 = picture.values().iter().map(|pixel| brightness(pixel.as_dvec3())).sum();
    let mean = sum / picture.values().len() as f64;
    if mean > 0.0 { 0.5 / mean } else { 1.0 }
}
