//! Planes whose light and noise are known.

use super::*;

const SIZE: usize = 48;

/// SplitMix64, as numbers in [-1, 1).
fn noise(state: &mut u64) -> f32 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (((z ^ z >> 31) >> 40) as f64 / f64::from(1 << 23) - 1.0) as f32
}

fn raster(value: impl FnMut(usize, usize) -> Vec3) -> Raster<Vec3> {
    let mut value = value;
    let values = (0..SIZE * SIZE).map(|pixel| value(pixel % SIZE, pixel / SIZE)).collect();
    Raster::from_values(SIZE, SIZE, values).expect("square")
}

/// A wall that is looked at from the front, at distance 4, a pixel for each hundredth.
fn wall() -> [Raster<Vec3>; 2] {
    let point = raster(|x, y| Vec3::new(x as f32 * 0.01 - 0.24, y as f32 * 0.01 - 0.24, 4.0));
    [raster(|_, _| Vec3::NEG_Z), point]
}

/// Half buffers of a picture: uniform noise of this amplitude, relative.
fn halves(light: &Raster<Vec3>, amplitude: f32) -> [Raster<Vec3>; 2] {
    [1, 2].map(|seed| {
        let mut state = seed;
        raster(|x, y| *light.at(x, y) * (1.0 + amplitude * noise(&mut state)))
    })
}

fn smoothed(light: &Raster<Vec3>, amplitude: f32, albedo: Option<&Raster<Vec3>>) -> Smoothed {
    let [normal, point] = wall();
    let [first, second] = halves(light, amplitude);
    smooth([&first, &second], [0.5, 0.5], &Guides { normal: &normal, point: &point, albedo })
}

/// Root mean square of the relative difference.
fn error(found: &Raster<Vec3>, expected: &Raster<Vec3>) -> f64 {
    let squares = found
        .values()
        .iter()
        .zip(expected.values())
        .map(|(found, expected)| (brightness(found.as_dvec3()) / brightness(expected.as_dvec3()) - 1.0).powi(2));
    (squares.sum::<f64>() / (SIZE * SIZE) as f64).sqrt()
}

/// Noise of .2/sqrt(3) a half is .082 in the mean. Means of 17 x 17 pixels with equal weights would leave .005; weights that differ
/// leave more, here at most an eighth of the noise. The seed is fixed.
#[test]
fn noise_of_flat_light_falls_eightfold_and_its_mean_stays() {
    let light = raster(|_, _| Vec3::new(2.0, 1.0, 0.5));
    let found = smoothed(&light, 0.2, None);
    assert!(error(&found.plane, &light) < 0.082 / 8.0, "{}", error(&found.plane, &light));
    assert!((found.noise_before - 0.082).abs() < 0.004, "{}", found.noise_before);
    // What is said of the noise is no less than what it is: each half's weights follow the other half's noise, so the two
    // part more than their mean errs.
    assert!(found.noise_after < found.noise_before / 6.0, "{}", found.noise_after);
    assert!(found.noise_after > 0.8 * error(&found.plane, &light), "{}", found.noise_after);
    let mean = found.plane.values().iter().map(|pixel| pixel.as_dvec3()).sum::<glam::DVec3>() / (SIZE * SIZE) as f64;
    // .082/48 is its deviation; five of them.
    assert!((brightness(mean) / brightness(glam::DVec3::new(2.0, 1.0, 0.5)) - 1.0).abs() < 5.0 * 0.082 / 48.0);
}

#[test]
fn light_without_noise_stays() {
    let light = raster(|x, y| Vec3::splat(if x + y < SIZE { 1.0 } else { 1.5 }));
    let found = smoothed(&light, 0.0, None);
    assert!(error(&found.plane, &light) < 1e-6, "{}", error(&found.plane, &light));
    assert_eq!(found.noise_before, 0.0);
}

#[test]
fn shadows_that_stand_out_of_the_noise_stay() {
    let light = raster(|x, _| Vec3::splat(if x < SIZE / 2 { 1.0 } else { 2.0 }));
    let found = smoothed(&light, 0.1, None);
    // The noise alone would leave .041 of every pixel.
    assert!(error(&found.plane, &light) < 0.02, "{}", error(&found.plane, &light));
}

#[test]
fn textures_stay_whatever_the_noise() {
    let albedo = raster(|x, y| Vec3::splat(if (x / 4 + y / 4) % 2 == 0 { 0.8 } else { 0.1 }));
    let found = smoothed(&albedo, 0.2, Some(&albedo));
    assert!(error(&found.plane, &albedo) < 0.082 / 8.0, "{}", error(&found.plane, &albedo));
}

/// Two walls of different light that noise would not tell apart, parted by normals or by depth alone.
#[test]
fn surfaces_do_not_mix() {
    let light = raster(|x, _| Vec3::splat(if x < SIZE / 2 { 1.0 } else { 1.2 }));
    let [normal, point] = wall();
    let turned = raster(|x, _| if x < SIZE / 2 { Vec3::NEG_Z } else { Vec3::X });
    let behind = raster(|x, y| *point.at(x, y) + Vec3::Z * if x < SIZE / 2 { 0.0 } else { 0.5 });
    let [first, second] = halves(&light, 0.2);
    for guides in [
        Guides { normal: &turned, point: &point, albedo: None },
        Guides { normal: &normal, point: &behind, albedo: None },
    ] {
        let found = smooth([&first, &second], [0.5, 0.5], &guides).plane;
        for (from, expected) in [(0, 1.0), (SIZE / 2, 1.2)] {
            let columns = (from..from + SIZE / 2).flat_map(|x| (0..SIZE).map(move |y| (x, y)));
            let mean = columns.map(|(x, y)| f64::from(found.at(x, y).x)).sum::<f64>() / (SIZE * SIZE / 2) as f64;
            // Deviation of the mean of 1152 pixels: .0024 of the light; five of them.
            assert!((mean / expected - 1.0).abs() < 0.012, "{mean} for {expected}");
        }
    }
}

#[test]
fn what_is_not_met_and_pictures_of_one_pixel_are_smoothed_too() {
    let one = |value: Vec3| Raster::from_values(1, 1, vec![value]).expect("one pixel");
    let (normal, point) = (one(Vec3::ZERO), one(Vec3::ZERO));
    let (first, second) = (one(Vec3::ONE), one(Vec3::splat(3.0)));
    let guides = Guides { normal: &normal, point: &point, albedo: None };
    assert_eq!(*smooth([&first, &second], [0.25, 0.75], &guides).plane.at(0, 0), Vec3::splat(2.5));
}
