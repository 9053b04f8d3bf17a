//! Local orientation: the energy of a pair of Gabor filters in quadrature at 0, 45, 90 and 135 degrees.
//!
//! A Gabor with a round envelope is the real part of a product of two one-dimensional complex filters, so a pixel
//! costs 2 x 9 complex taps instead of 81. Wavelength 4 px and standard deviation 2 px at each scale, so that the scales
//! follow each other by an octave below the pyramid's cut-off; the paper of 1998 leaves both open.

use super::pyramid::{Plane, mirrored};
use crate::raster::Raster;

/// Degrees of the gratings' normals, counter-clockwise from the picture's right.
pub(super) const ANGLES_DEG: [f64; 4] = [0.0, 45.0, 90.0, 135.0];
/// Pixels a cycle.
const WAVELENGTH_PX: f64 = 4.0;
/// Standard deviation of the envelope.
const DEVIATION_PX: f64 = WAVELENGTH_PX / 2.0;
/// Taps on each side of the centre.
const REACH: usize = 4;
const TAPS: usize = 2 * REACH + 1;

/// exp(i k t) times the envelope at t = -4..4.
fn complex_taps(cycles_per_px: f64) -> [(f32, f32); TAPS] {
    std::array::from_fn(|i| {
        let t = i as f64 - REACH as f64;
        let envelope = (-t * t / (2.0 * DEVIATION_PX * DEVIATION_PX)).exp();
        let (sin, cos) = (std::f64::consts::TAU * cycles_per_px * t).sin_cos();
        ((envelope * cos) as f32, (envelope * sin) as f32)
    })
}

/// Square root of even squared plus odd squared response to a grating of `angle_deg` at every pixel. The even filter
/// is made free of its mean, so that an even surface answers 0.
pub(super) fn gabor_energy(plane: &Plane, angle_deg: f64) -> Plane {
    let (width, height) = (plane.width(), plane.height());
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    // Rows run down, so the vertical frequency changes its sign.
    let across = complex_taps(cos / WAVELENGTH_PX);
    let down = complex_taps(-sin / WAVELENGTH_PX);
    let flat = complex_taps(0.0);
    let total = |taps: &[(f32, f32); TAPS]| taps.iter().map(|tap| f64::from(tap.0)).sum::<f64>();
    // The one-dimensional sums of the imaginary parts vanish, so the even filter's mean is a product of two sums.
    let envelope = total(&flat) * total(&flat);
    let mean = (total(&across) * total(&down) / envelope) as f32;
    let scale = (1.0 / envelope) as f32;

    // A plane for each of the three sums, so that the innermost loops run along rows.
    let mut rows = [(); 3].map(|()| vec![0.0_f32; width * height]);
    let mut padded = vec![0.0_f32; width + 2 * REACH];
    for (y, source) in plane.values().chunks_exact(width).enumerate() {
        for (i, value) in padded.iter_mut().enumerate() {
            *value = source[mirrored(0, i as isize - REACH as isize, width)];
        }
        for k in 0..TAPS {
            for (sums, tap) in rows.iter_mut().zip([across[k].0, across[k].1, flat[k].0]) {
                add_scaled(&mut sums[y * width..(y + 1) * width], &padded[k..k + width], tap);
            }
        }
    }
    let [even, odd, round] = rows;
    let mut out = vec![0.0_f32; width * height];
    let mut sums = [(); 3].map(|()| vec![0.0_f32; width]);
    for (y, out) in out.chunks_exact_mut(width).enumerate() {
        sums.iter_mut().for_each(|sum| sum.fill(0.0));
        for k in 0..TAPS {
            let from = mirrored(y, k as isize - REACH as isize, height) * width;
            let row = from..from + width;
            let [sum_even, sum_odd, sum_round] = &mut sums;
            add_scaled(sum_even, &even[row.clone()], down[k].0);
            add_scaled(sum_even, &odd[row.clone()], -down[k].1);
            add_scaled(sum_odd, &even[row.clone()], down[k].1);
            add_scaled(sum_odd, &odd[row.clone()], down[k].0);
            add_scaled(sum_round, &round[row], flat[k].0);
        }
        let [even, odd, round] = &sums;
        for (((value, even), odd), round) in out.iter_mut().zip(even).zip(odd).zip(round) {
            let (even, odd) = ((even - mean * round) * scale, odd * scale);
            *value = (even * even + odd * odd).sqrt();
        }
    }
    Raster::from_values(width, height, out).expect("one value a pixel was made")
}

/// `sums` + `factor` x `values`, term by term.
fn add_scaled(sums: &mut [f32], values: &[f32], factor: f32) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grating(angle_deg: f64) -> Plane {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let values = (0..64 * 64).map(|i| {
            let (x, y) = (f64::from(i % 64), f64::from(i / 64));
            (0.5 + 0.5 * (std::f64::consts::TAU * (x * cos - y * sin) / WAVELENGTH_PX).cos()) as f32
        });
        Raster::from_values(64, 64, values.collect()).unwrap()
    }

    #[test]
    fn a_grating_answers_most_to_its_own_angle_and_evenly_along_it() {
        for own in ANGLES_DEG {
            let plane = grating(own);
            let at_centre = |angle| *gabor_energy(&plane, angle).at(32, 32);
            for other in ANGLES_DEG {
                assert!(other == own || at_centre(own) > 3.0 * at_centre(other), "{own} against {other}");
            }
            let energy = gabor_energy(&plane, own);
            let inside: Vec<f32> = (16..48).map(|i| *energy.at(i, 20)).collect();
            let (low, high) = inside.iter().fold((f32::MAX, 0.0_f32), |(l, h), &v| (l.min(v), h.max(v)));
            assert!(high / low < 1.1, "quadrature leaves no ripple: {low} to {high}");
        }
    }

    #[test]
    fn an_even_surface_answers_nothing() {
        let energy = gabor_energy(&Raster::filled(30, 20, 0.8), 45.0);
        assert!(energy.values().iter().all(|&value| value < 1e-5));
    }
}
