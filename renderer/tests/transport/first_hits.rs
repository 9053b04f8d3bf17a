//! The low-level pass against geometry worked out by hand.

use glam::Vec3;
use proptest::prelude::*;
use renderer::features::Wanted;
use renderer::transport::{Samples, Tracer};

use super::Stage;

/// A wall at y = 4 with a sphere before it, an illum between them that is looked through, and nothing else.
const WALL: &str = "void plastic red 0 0 5 .6 .2 .1 .05 0
void mirror shiny 0 0 3 .9 .9 .9
void illum window 0 0 3 1 1 1
red polygon wall.1 0 0 12  -3 4 -3  -3 4 0  3 4 0  3 4 -3
shiny sphere ball.1 0 0 4  0 2.5 -.5 .25
window polygon pane.1 0 0 12  -3 3.5 -3  -3 3.5 3  3 3.5 3  3 3.5 -3
";

fn samples(stage: &Stage, size: usize) -> Samples<'_> {
    Samples { view: &stage.view, width: size, height: size, jitter: 1.0, aperture: 0.0 }
}

#[test]
fn depth_normal_albedo_and_object_are_those_of_the_geometry() {
    let stage = Stage::new(WALL, [0.0; 3], [0.0, 1.0, 0.0], 60.0);
    let tracer = Tracer::new(&stage.scene, &stage.aggregate);
    let size = 40;
    let features = tracer.first_hits(&samples(&stage, size), Wanted::ALL, 1);
    let (depth, normal) = (features.depth.unwrap(), features.normal.unwrap());
    let (albedo, object) = (features.albedo.unwrap(), features.object.unwrap());
    let name = |x: usize, y: usize| object.at(x, y).map(|id| stage.scene.name(stage.scene.surface(id).name));
    // Above the wall's upper edge (z = 0) there is nothing.
    assert_eq!((name(20, 5), *depth.at(20, 5)), (None, f32::INFINITY));
    assert_eq!((*normal.at(20, 5), *albedo.at(20, 5)), (Vec3::ZERO, Vec3::ZERO));
    for (x, y) in [(3, 30), (36, 38), (5, 21)] {
        assert_eq!(name(x, y), Some("wall.1"));
        let tangent = |i: usize| (2.0 * (i as f64 + 0.5) / size as f64 - 1.0) * 30_f64.to_radians().tan();
        let expected = 4.0 * (1.0 + tangent(x).powi(2) + tangent(y).powi(2)).sqrt();
        assert!((f64::from(*depth.at(x, y)) - expected).abs() < 1e-5 * expected, "{x} {y}");
        assert!((*normal.at(x, y) + Vec3::Y).length() < 1e-6, "the side of the eye");
        // A smooth plastic of specularity .05 leaves (1 - .05)(1 - F) of its colour; F is nothing near head-on.
        assert!((albedo.at(x, y).x / albedo.at(x, y).y - 3.0).abs() < 1e-5 && albedo.at(x, y).x <= 0.95 * 0.6 + 1e-6);
    }
    // The ball's centre lies atan(.5 / 2.5) below the axis.
    let row = ((0.2 / 30_f64.to_radians().tan() + 1.0) / 2.0 * size as f64) as usize;
    assert_eq!(name(20, row), Some("ball.1"));
    assert_eq!(*albedo.at(20, row), Vec3::ZERO, "a mirror has no diffuse lobe");
}

#[test]
fn only_what_is_asked_for_is_made() {
    let stage = Stage::new(WALL, [0.0; 3], [0.0, 1.0, 0.0], 60.0);
    let tracer = Tracer::new(&stage.scene, &stage.aggregate);
    let features = tracer.first_hits(&samples(&stage, 8), Wanted { depth: true, ..Wanted::default() }, 2);
    assert!(features.depth.is_some());
    assert!(features.object.is_none() && features.normal.is_none() && features.albedo.is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A pixel shows a surface exactly if one of the rays of its grid meets it, and then so does a picture of single rays
    /// that is as many times larger.
    #[test]
    fn a_grid_is_a_larger_picture(a_side in 1_usize..5, size in 1_usize..12, z in -1.0..0.2_f64) {
        let stage = Stage::new(WALL, [0.0, 0.0, z], [0.0, 1.0, 0.0], 50.0);
        let tracer = Tracer::new(&stage.scene, &stage.aggregate);
        let is_ball = |id| stage.scene.name(stage.scene.surface(id).name) == "ball.1";
        let shown = tracer.pixels_showing(&samples(&stage, size), a_side, is_ball);
        let wanted = Wanted { object: true, depth: true, ..Wanted::default() };
        let fine = tracer.first_hits(&samples(&stage, size * a_side), wanted, 1);
        let coarse = tracer.first_hits(&samples(&stage, size), wanted, a_side);
        let (fine_object, fine_depth) = (fine.object.unwrap(), fine.depth.unwrap());
        for y in 0..size {
            for x in 0..size {
                let cells = (0..a_side * a_side).map(|i| (x * a_side + i % a_side, y * a_side + i / a_side));
                let any = cells.clone().any(|(u, v)| fine_object.at(u, v).is_some_and(is_ball));
                prop_assert_eq!(*shown.at(x, y), any);
                let met: Vec<f32> = cells.map(|(u, v)| *fine_depth.at(u, v)).filter(|d| d.is_finite()).collect();
                let mean = met.iter().sum::<f32>() / met.len() as f32;
                let here = *coarse.depth.as_ref().unwrap().at(x, y);
                let agrees = if met.is_empty() { here.is_infinite() } else { (here - mean).abs() < 1e-4 * mean };
                prop_assert!(agrees, "{} for {}", here, mean);
            }
        }
    }
}
