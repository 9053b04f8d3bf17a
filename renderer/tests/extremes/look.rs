//! A scene, looked at.

use renderer::color::Rgb;
use renderer::component::ComponentSet;
use renderer::crex::{self, Program};
use renderer::rad::{self, MemoryFiles, Source, ViewSpec};
use renderer::raster::Raster;
use renderer::render::{RenderError, Renderer, Rendering, Settings};
use renderer::scene::{Scene, View};
use renderer::schedule::ManualClock;

/// Every component, until nothing is left.
pub(crate) const EVERYTHING: &str = "(TRSGMD)*";

/// A scene and how to look at it.
#[derive(Clone)]
pub(crate) struct Look {
    pub(crate) text: String,
    pub(crate) view: ViewSpec,
    pub(crate) crex: &'static str,
    pub(crate) settings: Settings,
}

impl Look {
    /// One sample of one pixel, nearly a ray, from `eye` along `towards`; paths end only where nothing is left.
    pub(crate) fn new(text: impl Into<String>, eye: [f64; 3], towards: [f64; 3]) -> Self {
        let up = if towards[0] == 0.0 && towards[1] == 0.0 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let view =
            ViewSpec { point: eye, direction: towards, up, horizontal: 1e-6, vertical: 1e-6, ..ViewSpec::default() };
        let mut settings = Settings::new(1, 1);
        settings.threads = Some(1);
        settings.limits.reflections = 0;
        settings.limits.least_weight = 0.0;
        Self { text: text.into(), view, crex: "", settings }
    }

    pub(crate) fn crex(self, crex: &'static str) -> Self {
        Self { crex, ..self }
    }

    pub(crate) fn degrees(mut self, degrees: f64) -> Self {
        (self.view.horizontal, self.view.vertical) = (degrees, degrees);
        self
    }

    pub(crate) fn size(mut self, width: usize, height: usize) -> Self {
        (self.settings.width, self.settings.height) = (width, height);
        self
    }

    pub(crate) fn samples(mut self, samples: u32) -> Self {
        self.settings.samples = samples;
        self
    }

    pub(crate) fn reflections(mut self, most: i32) -> Self {
        self.settings.limits.reflections = most;
        self
    }

    pub(crate) fn render(&self) -> Rendering {
        self.try_render().unwrap()
    }

    pub(crate) fn try_render(&self) -> Result<Rendering, RenderError> {
        let scene = scene(&self.text).unwrap();
        let (aggregate, view) = (scene.aggregate(), View::new(self.view).unwrap());
        let program = Program::new(&crex::parse(self.crex).unwrap());
        let clock = ManualClock::default();
        Renderer::new(&scene, &aggregate, &view, &program, &clock, self.settings.clone())?.render()
    }

    pub(crate) fn picture(&self) -> Raster<Rgb> {
        let film = self.render().film.beauty();
        let pixels = film.values().iter().map(|pixel| pixel.as_dvec3()).collect();
        Raster::from_values(film.width(), film.height(), pixels).unwrap()
    }

    /// The first pixel.
    pub(crate) fn pixel(&self) -> Rgb {
        self.picture().values()[0]
    }

    /// The red of the first pixel.
    pub(crate) fn red(&self) -> f64 {
        self.pixel().x
    }
}

/// A scene from its text; the first error in words.
pub(crate) fn scene(text: &str) -> Result<Scene, String> {
    let files = MemoryFiles::new();
    let document = rad::read(&[Source::new("scene.rad", text)], &files, &rad::Options::default());
    let built = document.and_then(|document| Scene::from_rad(&document));
    built.map_err(|errors| errors[0].to_string())
}

/// The first value of a plane that is no radiance: NaN, infinite or negative.
pub(crate) fn first_bad(rendering: &Rendering) -> Option<String> {
    let film = &rendering.film;
    let layers = ComponentSet::ALL.iter().filter_map(|component| film.layer(component));
    let beauty = film.beauty();
    let planes = [film.direct(), &beauty].into_iter().chain(layers).chain(film.ambient());
    let mut pixels = planes.flat_map(|plane| plane.values());
    pixels.find(|pixel| !pixel.is_finite() || pixel.min_element() < 0.0).map(|pixel| format!("{pixel}"))
}

/// A square of side 2 `half` around (x, y, z), facing up.
pub(crate) fn square(modifier: &str, name: &str, [x, y, z]: [f64; 3], half: f64) -> String {
    let (west, east, south, north) = (x - half, x + half, y - half, y + half);
    format!(
        "{modifier} polygon {name} 0 0 12 {west:e} {south:e} {z:e} {east:e} {south:e} {z:e} {east:e} {north:e} {z:e} {west:e} {north:e} {z:e}\n"
    )
}

/// White matt paint, and a lamp of radiance 1e6.
pub(crate) const PAINT: &str = "void plastic paint 0 0 5 .5 .5 .5 0 0\nvoid light lamp 0 0 3 1e6 1e6 1e6\n";
