//! Pictures and views at the ends of their ranges.

use std::f64::consts::PI;

use renderer::rad::{ViewKind, ViewSpec};
use renderer::render::RenderError;
use renderer::scene::View;

use crate::look::{Look, first_bad};
use crate::table::{Case, Row, group};

const DOME: &str = "void glow white 0 0 4 1 1 1 0\nwhite source sky 0 0 4 0 0 1 360\n";

/// How many of 1000 pixels in a row show a strip 1 before the eye that fills the middle half of the view.
fn half_of_a_view(degrees: f64) -> Row {
    let half = 0.5 * (degrees.to_radians() / 2.0).tan();
    let text = format!(
        "void glow white 0 0 4 1 1 1 0\nwhite polygon strip 0 0 12 {:e} 1 -9 {half:e} 1 -9 {half:e} 1 9 {:e} 1 9\n",
        -half, -half
    );
    let mut look = Look::new(text, [0.0; 3], [0.0, 1.0, 0.0]).size(1000, 1);
    look.view.horizontal = degrees;
    look.view.vertical = 1e-6;
    look.settings.jitter = 0.0;
    Row::same(500, lit(&look))
}

/// Pixels that are 1.
fn lit(look: &Look) -> usize {
    look.picture().values().iter().filter(|pixel| pixel.x == 1.0).count()
}

fn sized(width: usize, height: usize) -> Row {
    Row::same(width * height, lit(&Look::new(DOME, [0.0; 3], [0.0, 1.0, 0.0]).degrees(90.0).size(width, height)))
}

/// Which part of a square picture a projection of some angle fills.
fn filled(kind: ViewKind, degrees: f64, expected: f64) -> Row {
    let mut look = Look::new(DOME, [0.0; 3], [0.0, 1.0, 0.0]).degrees(degrees).size(200, 200);
    look.view.kind = kind;
    Row::near(expected, lit(&look) as f64 / 40_000.0, 5e-3)
}

fn refused(words: &str, change: impl Fn(&mut ViewSpec)) -> Row {
    let mut spec = ViewSpec::default();
    change(&mut spec);
    Row::message(words, View::new(spec).map(|_| ()).map_err(|error| error.to_string()))
}

/// A parallel view of a disc that fills a square view of some size but for its corners.
fn parallel(size: f64) -> Row {
    let text = format!("void glow white 0 0 4 1 1 1 0\nwhite ring disc 0 0 8 0 {size:e} 0 0 -1 0 0 {:e}\n", 0.5 * size);
    let mut look = Look::new(text, [0.0; 3], [0.0, 1.0, 0.0]).degrees(size).size(200, 200);
    look.view.kind = ViewKind::Parallel;
    Row::near(PI / 4.0, lit(&look) as f64 / 40_000.0, 5e-3)
}

/// A wall at 1, behind or before clipping planes.
fn clipped(fore: f64, aft: f64) -> f64 {
    let text = "void glow white 0 0 4 1 1 1 0\nwhite polygon wall 0 0 12 -9 1 -9 9 1 -9 9 1 9 -9 1 9\n";
    let mut look = Look::new(text, [0.0; 3], [0.0, 1.0, 0.0]);
    (look.view.fore, look.view.aft) = (fore, aft);
    look.red()
}

pub(crate) fn cases() -> Vec<Case> {
    group(
        "views",
        &[
            ("a field of .001 degrees", || half_of_a_view(0.001)),
            ("a field of 1e-9 degrees", || half_of_a_view(1e-9)),
            ("a field of 90 degrees", || half_of_a_view(90.0)),
            ("a field of 179.99 degrees", || half_of_a_view(179.99)),
            ("1 x 1 pixel", || sized(1, 1)),
            ("32768 x 1 pixels", || sized(32_768, 1)),
            ("1 x 32768 pixels", || sized(1, 32_768)),
            ("0 x 1 pixels", || {
                let made = Look::new(DOME, [0.0; 3], [0.0, 1.0, 0.0]).size(0, 1).try_render();
                let refused = matches!(made, Err(RenderError::Setting { name: "the picture's size", .. }));
                Row::says("refused", if refused { "refused" } else { "rendered" }, refused)
            }),
            ("a fisheye of 360 degrees", || filled(ViewKind::Angular, 360.0, PI / 4.0)),
            ("a fisheye of 1e-6 degrees", || filled(ViewKind::Angular, 1e-6, 1.0)),
            ("a hemisphere of 180 degrees", || filled(ViewKind::Hemispherical, 180.0, PI / 4.0)),
            ("a planisphere of 359 degrees", || filled(ViewKind::Planispheric, 359.0, 1.0)),
            ("a panorama of 360 degrees", || {
                let mut look = Look::new(DOME, [0.0; 3], [0.0, 1.0, 0.0]).degrees(360.0).size(200, 200);
                (look.view.kind, look.view.vertical) = (ViewKind::Cylindrical, 179.0);
                Row::same(40_000, lit(&look))
            }),
            ("a parallel view 1e-6 wide", || parallel(1e-6)),
            ("a parallel view 1e8 wide", || parallel(1e8)),
            ("clipping planes close around a wall", || Row::same(1.0, clipped(1.0 - 1e-9, 1.0 + 1e-9))),
            ("a fore plane just behind it", || Row::same(0.0, clipped(1.0 + 1e-9, 0.0))),
            ("an aft plane just before it", || Row::same(0.0, clipped(0.0, 1.0 - 1e-9))),
            ("a fore plane at 1e-300", || Row::same(1.0, clipped(1e-300, 1e30))),
            ("up along the direction", || {
                refused("not parallel to the view direction", |spec| spec.up = [0.0, -2.0, 0.0])
            }),
            ("up within 1e-7 of it", || refused("not parallel", |spec| spec.up = [1e-7, 1.0, 0.0])),
            ("no direction", || refused("other than zero", |spec| spec.direction = [0.0; 3])),
            ("a direction of 1e-300", || {
                let mut look = Look::new(DOME, [0.0; 3], [0.0, 1e-300, 0.0]);
                look.view.up = [0.0, 0.0, 1e300];
                Row::same((None, 1.0), (first_bad(&look.render()), look.red()))
            }),
            ("a field of 180 degrees", || refused("less than 180", |spec| spec.horizontal = 180.0)),
            ("a field of 0 degrees", || refused("more than 0", |spec| spec.vertical = 0.0)),
            ("a field that is no number", || refused("more than 0", |spec| spec.horizontal = f64::NAN)),
            ("a view point at 1e300", || refused("at most 1e75", |spec| spec.point[0] = 1e300)),
            ("a shift by 1e300 pictures", || refused("at most 1e75", |spec| spec.shift = 1e300)),
            ("an aft plane before the fore plane", || {
                refused("must be 0 or lie behind it", |spec| (spec.fore, spec.aft) = (2.0, 1.0))
            }),
        ],
    )
}
