//! The coefficients of predicted visibility are what their rows say, and predict scenes that had no part in them.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

#[path = "../examples/fit_visibility/least_squares.rs"]
mod least_squares;
#[path = "../examples/fit_visibility/predictors.rs"]
mod predictors;
#[path = "../examples/fit_visibility/rows.rs"]
mod rows;

use std::path::Path;

use glam::Vec3;
use predictors::Predictors;
use renderer::picture::Picture;
use renderer::picture::display::Display;
use renderer::propose::{CONSTANT, EXPONENT, LEAST_LOSS_JOD, loss_jod};
use renderer::raster::Raster;

fn kept() -> Vec<rows::Row> {
    rows::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/visibility/rows.csv"))).unwrap()
}

/// The one predictor that has a coefficient: `jod`, the last.
const USED: u32 = 1 << (Predictors::NAMES.len() - 1);

#[test]
fn least_squares_solves_what_has_a_closed_form() {
    // A plane through its points exactly; and the line through (0, 0), (1, 1), (2, 1): y = 1/6 + x/2.
    let rows: Vec<Vec<f64>> = (0..9).map(|i| vec![f64::from(i % 3), f64::from(i / 3)]).collect();
    let plane: Vec<f64> = rows.iter().map(|row| 3.0 - 2.0 * row[0] + 0.5 * row[1]).collect();
    let found = least_squares::fit(&rows, &plane).unwrap();
    assert!(found.iter().zip([3.0, -2.0, 0.5]).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    let found = least_squares::fit(&[vec![0.0], vec![1.0], vec![2.0]], &[0.0, 1.0, 1.0]).unwrap();
    assert!((found[0] - 1.0 / 6.0).abs() < 1e-14 && (found[1] - 0.5).abs() < 1e-14, "{found:?}");
    assert_eq!(least_squares::fit(&[vec![1.0], vec![1.0]], &[0.0, 1.0]), None);
}

#[test]
fn the_coefficients_in_the_code_are_the_fit_of_the_rows() {
    let rows = kept();
    let x: Vec<Vec<f64>> = rows.iter().map(|row| row.logs(USED)).collect();
    let y: Vec<f64> = rows.iter().map(rows::Row::log_loss).collect();
    let found = least_squares::fit(&x, &y).unwrap();
    // They have four digits behind the point.
    for (found, kept) in found.iter().zip([CONSTANT, EXPONENT]) {
        assert!((found - kept).abs() < 6e-5, "{found} {kept}");
    }
    // And the code applies them as the fit does.
    for (row, x) in rows.iter().zip(&x) {
        let expected = least_squares::apply(&[CONSTANT, EXPONENT], x).exp() - LEAST_LOSS_JOD;
        assert!((loss_jod(row.predictors[4]) - expected.clamp(0.0, 9.0)).abs() < 1e-12);
    }
    assert_eq!(loss_jod(0.0), 0.0);
}

/// What `docs/auto.md` promises of scenes that the fit has not seen: R2 of ln(loss), and the error of a prediction.
#[test]
fn scenes_left_out_are_predicted_as_the_documentation_says() {
    let rows = kept();
    let x: Vec<Vec<f64>> = rows.iter().map(|row| row.logs(USED)).collect();
    let y: Vec<f64> = rows.iter().map(rows::Row::log_loss).collect();
    let groups: Vec<String> = rows.iter().map(|row| row.group.clone()).collect();
    let predicted = least_squares::left_out(&x, &y, &groups).unwrap();
    let r2 = least_squares::r2(&y, &predicted);
    assert!(r2 > 0.97, "{r2}");
    for (row, (y, predicted)) in rows.iter().zip(y.iter().zip(&predicted)) {
        let factor = (y - predicted).abs().exp();
        assert!(factor < 2.0, "{} by {:?}: off by a factor of {factor}", row.scene, row.crex);
    }
}

fn measure(full: impl Fn(usize, usize) -> f32, fewer: impl Fn(usize, usize) -> f32) -> Predictors {
    let raster = |value: &dyn Fn(usize, usize) -> f32| {
        let pixels = (0..32 * 24).map(|i| Vec3::splat(value(i % 32, i / 32))).collect();
        Picture::of_radiance(&Raster::from_values(32, 24, pixels).unwrap())
    };
    let display = Display { ambient_lux: 0.0, black_cd_m2: 1e-6, ..Display::of_the_paper() };
    Predictors::measure(&raster(&full), &raster(&fewer), &display, 1.0).unwrap()
}

#[test]
fn a_picture_lacks_nothing_of_itself() {
    let picture = |x: usize, y: usize| (x + y) as f32 / 60.0;
    assert_eq!(measure(picture, picture).values(), [0.0; 5]);
}

#[test]
fn half_the_light_is_a_log_of_two() {
    let found = measure(|_, _| 0.8, |_, _| 0.4);
    assert!((found.energy - 0.5).abs() < 1e-6, "{found:?}");
    assert!((found.contrast - 2.0_f64.ln()).abs() < 1e-5 && found.detail < 1e-6, "{found:?}");
    assert_eq!(found.coverage, 1.0);
}

#[test]
fn details_are_told_from_smooth_light() {
    // Every other pixel halved: mean log -ln(2)/2 in each block, and as much deviation from it.
    let found = measure(|_, _| 0.8, |x, y| if (x + y) % 2 == 0 { 0.4 } else { 0.8 });
    let half = 0.5 * 2.0_f64.ln();
    assert!((found.contrast - half).abs() < 1e-5 && (found.detail - half).abs() < 1e-5, "{found:?}");
    assert_eq!(found.coverage, 0.5);
    // One corner of one pixel in 768.
    let found = measure(|_, _| 0.8, |x, y| if x + y == 0 { 0.4 } else { 0.8 });
    assert!((found.coverage * 768.0 - 1.0).abs() < 1e-12);
    assert!((found.energy - 0.5 / 768.0).abs() < 1e-6);
}
