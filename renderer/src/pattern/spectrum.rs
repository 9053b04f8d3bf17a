//! Spectra as the red, green and blue that Radiance makes of them where it does not compute in spectra (`-cs 3`, rpict's
//! default): the colour that the CIE's standard observer sees in light of equal energy, what the spectrum does not cover
//! being 0.

use std::sync::Arc;

use super::Table;
use super::place::Local;
use crate::cal::{Evaluator, Lambda};

/// The wavelengths that count, nm.
const SHORTEST: f64 = 380.0;
const LONGEST: f64 = 780.0;

/// Pieces in which a function's wavelengths are looked at, at most one in this many nm; three points a piece.
const LEAST_PIECE: f64 = (LONGEST - SHORTEST) / 12.0;
const MOST_PIECES: f64 = 24.0;

/// Parts of a spectrum that rpict tells apart, at most.
const MOST_PARTS: usize = 24;

/// A spectrum at a hit.
#[derive(Clone, Debug)]
pub enum Spectrum {
    /// A function of the wavelength, between two wavelengths in nm.
    Function {
        /// The function.
        function: Lambda,
        /// The shorter one.
        from: f64,
        /// The longer one.
        to: f64,
    },
    /// A table whose last dimension is the wavelength, each value of which goes through a function.
    Data {
        /// The table, of at least 2 dimensions.
        table: Arc<Table>,
        /// Of the value and the wavelength.
        function: Lambda,
    },
}

/// The colour matching functions of the CIE 1931 standard observer (CIE 018:2019), every 10 nm from 380 to 780.
#[rustfmt::skip]
const OBSERVER: [[f64; 3]; 41] = [
    [0.001368, 0.000039, 0.006450],
    [0.004243, 0.000120, 0.020050],
    [0.014310, 0.000396, 0.067850],
    [0.043510, 0.001210, 0.207400],
    [0.134380, 0.004000, 0.645600],
    [0.283900, 0.011600, 1.385600],
    [0.348280, 0.023000, 1.747060],
    [0.336200, 0.038000, 1.772110],
    [0.290800, 0.060000, 1.669200],
    [0.195360, 0.090980, 1.287640],
    [0.095640, 0.139020, 0.812950],
    [0.032010, 0.208020, 0.465180],
    [0.004900, 0.323000, 0.272000],
    [0.009300, 0.503000, 0.158200],
    [0.063270, 0.710000, 0.078250],
    [0.165500, 0.862000, 0.042160],
    [0.290400, 0.954000, 0.020300],
    [0.433450, 0.994950, 0.008750],
    [0.594500, 0.995000, 0.003900],
    [0.762100, 0.952000, 0.002100],
    [0.916300, 0.870000, 0.001650],
    [1.026300, 0.757000, 0.001100],
    [1.062200, 0.631000, 0.000800],
    [1.002600, 0.503000, 0.000340],
    [0.854450, 0.381000, 0.000190],
    [0.642400, 0.265000, 0.000050],
    [0.447900, 0.175000, 0.000020],
    [0.283500, 0.107000, 0.000000],
    [0.164900, 0.061000, 0.000000],
    [0.087400, 0.032000, 0.000000],
    [0.046770, 0.017000, 0.000000],
    [0.022700, 0.008210, 0.000000],
    [0.011359, 0.004102, 0.000000],
    [0.005790, 0.002091, 0.000000],
    [0.002899, 0.001047, 0.000000],
    [0.001440, 0.000520, 0.000000],
    [0.000690, 0.000249, 0.000000],
    [0.000332, 0.000120, 0.000000],
    [0.000166, 0.000060, 0.000000],
    [0.000083, 0.000030, 0.000000],
    [0.000042, 0.000015, 0.000000],
];

/// Nanometres between them.
const STEP: f64 = 10.0;

/// Their integrals from 380 nm on, as if linear in between.
const INTEGRALS: [[f64; 3]; 41] = {
    let mut sums = [[0.0; 3]; 41];
    let mut row = 1;
    while row < 41 {
        let mut channel = 0;
        while channel < 3 {
            let mean = 0.5 * (OBSERVER[row - 1][channel] + OBSERVER[row][channel]);
            sums[row][channel] = sums[row - 1][channel] + STEP * mean;
            channel += 1;
        }
        row += 1;
    }
    sums
};

/// From X, Y, Z to red, green and blue of Radiance's primaries, (.64, .33), (.29, .6) and (.15, .06), and its white of equal
/// energy.
const FROM_XYZ: [[f64; 3]; 3] = [
    [2.565312843030, -1.166849615807, -0.398463227223],
    [-1.022108172128, 1.978286616660, 0.043821555468],
    [0.074724377297, -0.251939567170, 1.177215189873],
];

/// The part of each matching function's integral below a wavelength.
fn observed(wavelength: f64) -> [f64; 3] {
    let at = ((wavelength - SHORTEST) / STEP).clamp(0.0, 40.0);
    let row = (at as usize).min(39);
    let t = at - row as f64;
    [0, 1, 2].map(|channel| {
        let (near, far) = (OBSERVER[row][channel], OBSERVER[row + 1][channel]);
        let part = STEP * t * (near + 0.5 * t * (far - near));
        (INTEGRALS[row][channel] + part) / INTEGRALS[40][channel]
    })
}

/// Red, green and blue of values over as many equal parts of the wavelengths between `from` and `to` (in nm, either way
/// round), as rpict makes them: means over its own parts, weighed by the standard observer. Three parts of its own are taken
/// as red, green and blue.
#[must_use]
pub fn to_rgb(values: &[f64], from: f64, to: f64) -> [f64; 3] {
    let count = values.len();
    if from > to && count <= MOST_PARTS {
        return of_parts(values, from, to);
    }
    let parts = (count as f64 * (LONGEST - SHORTEST) / (to - from).abs() + 0.99) as usize;
    let parts = parts.clamp(3, MOST_PARTS);
    let width = (LONGEST - SHORTEST) / parts as f64;
    let part = (to - from) / count as f64;
    let mut means = [0.0; MOST_PARTS];
    for (index, value) in values.iter().enumerate() {
        let ends = [from + part * index as f64, from + part * (index + 1) as f64];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        for (number, mean) in means[..parts].iter_mut().enumerate() {
            let top = LONGEST - width * number as f64;
            *mean += value * (high.min(top) - low.max(top - width)).max(0.0) / width;
        }
    }
    of_parts(&means[..parts], LONGEST, SHORTEST)
}

/// The same for equal parts from the longest wavelength to the shortest.
fn of_parts(values: &[f64], longest: f64, shortest: f64) -> [f64; 3] {
    if let Ok(rgb) = <[f64; 3]>::try_from(values) {
        return rgb;
    }
    let width = (longest - shortest) / values.len() as f64;
    let mut xyz = [0.0; 3];
    // rpict's parts end at whole nanometres.
    let mut above = observed(longest.floor());
    for (index, value) in values.iter().enumerate() {
        let below = observed((longest - width * (index + 1) as f64).floor());
        for channel in 0..3 {
            xyz[channel] += value * (above[channel] - below[channel]);
        }
        above = below;
    }
    let mut rgb = FROM_XYZ.map(|row| row.iter().zip(xyz).map(|(factor, value)| factor * value).sum::<f64>());
    // Colours beyond the primaries are mixed with the grey of their luminance.
    let grey = xyz[1].max(0.0);
    let least = rgb.iter().copied().fold(0.0, f64::min);
    if least < 0.0 {
        let keep = grey / (grey - least);
        rgb = rgb.map(|value| (keep * value + (1.0 - keep) * grey).max(0.0));
    }
    rgb
}

/// Where values at `count` points from `first` to `last` have their parts begin and end: half a step beyond.
#[must_use]
pub fn around(first: f64, last: f64, count: usize) -> [f64; 2] {
    let half = 0.5 * (last - first) / (count.max(2) - 1) as f64;
    [first - half, last + half]
}

impl Spectrum {
    /// Red, green and blue; `point` is where a table is asked, without the wavelength. `None` where a function fails.
    pub(super) fn value(&self, point: &[f64], at: &Local<'_>, evaluator: &mut Evaluator<'_>) -> Option<[f64; 3]> {
        match self {
            Self::Function { function, from, to } => {
                let (low, high) = (from.max(SHORTEST), to.min(LONGEST));
                let width = high - low;
                if width <= 0.0 {
                    return None;
                }
                let count = (width / (width / MOST_PIECES).max(LEAST_PIECE) + 0.1) as usize;
                let piece = width / count.max(1) as f64;
                let mut values = Vec::with_capacity(count.max(1));
                for index in 0..count.max(1) {
                    let middle = low + piece * (index as f64 + 0.5);
                    let mut sum = 0.0;
                    // rpict draws a point from the middle nine tenths of each piece.
                    for offset in [-0.3, 0.0, 0.3] {
                        sum += evaluator.apply_at(*function, &[middle + offset * piece], at).ok()?;
                    }
                    values.push(sum / 3.0);
                }
                Some(to_rgb(&values, low, high))
            }
            Self::Data { table, function } => {
                let (first, last, count) = table.last_axis();
                let step = (last - first) / (count.max(2) - 1) as f64;
                let mut full = [0.0; Table::MOST_DIMENSIONS];
                let inner = point.len();
                full[..inner].copy_from_slice(point);
                let mut values = Vec::with_capacity(count);
                for index in 0..count {
                    full[inner] = first + step * index as f64;
                    let [value, ..] = table.value(&full[..=inner]);
                    values.push(evaluator.apply_at(*function, &[value, full[inner]], at).ok()?);
                }
                let [from, to] = around(first, last, count);
                Some(to_rgb(&values, from, to))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_energy_is_white_and_luminance_is_the_observers() {
        // Sums of the CIE's table for Y: half of it lies below about 560 nm.
        for flat in [to_rgb(&[2.0; 7], 380.0, 780.0), to_rgb(&[2.0; 30], 780.0, 380.0), to_rgb(&[2.0; 5], 300.0, 800.0)]
        {
            assert!(flat.iter().all(|value| (value - 2.0).abs() < 1e-9), "{flat:?}");
        }
        // Radiance's weights of luminance fit its primaries' matrix to 1e-4.
        let luminance = |rgb: [f64; 3]| 0.265_074_126 * rgb[0] + 0.670_114_631 * rgb[1] + 0.064_811_243 * rgb[2];
        let mut half = [0.0; 20];
        half[..9].fill(1.0);
        // From 380 to 560 nm.
        let below: f64 = OBSERVER[..18].iter().map(|row| row[1]).sum::<f64>() + 0.5 * OBSERVER[18][1];
        let all: f64 = OBSERVER.iter().map(|row| row[1]).sum();
        let found = luminance(to_rgb(&half, 380.0, 780.0));
        assert!((found - below / all).abs() < 1e-4, "{found}, not {}", below / all);
        // A narrow green lies beyond the primaries: it keeps its luminance, and no channel is negative.
        let mut line = [0.0; 20];
        line[6] = 1.0;
        let green = to_rgb(&line, 380.0, 780.0);
        assert!(green[0] >= 0.0 && green[2] >= 0.0 && green[1] > green[0] && green[1] > green[2], "{green:?}");
        let expected = (observed(520.0)[1] - observed(500.0)[1]).abs();
        assert!((luminance(green) - expected).abs() < 1e-4);
    }

    #[test]
    fn what_is_not_covered_is_dark_and_three_parts_are_colours() {
        let third = 400.0 / 3.0;
        for (found, expected) in [
            (to_rgb(&[1.0, 2.0, 3.0], 780.0, 380.0), [1.0, 2.0, 3.0]),
            (to_rgb(&[3.0, 2.0, 1.0], 380.0, 780.0), [1.0, 2.0, 3.0]),
            (to_rgb(&[1.0], 380.0, 380.0 + third), [0.0, 0.0, 1.0]),
            (to_rgb(&[1.0; 9], 100.0, 200.0), [0.0; 3]),
        ] {
            let off = found.iter().zip(expected).map(|(a, b): (&f64, f64)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12, "{found:?}, not {expected:?}");
        }
        assert_eq!(around(400.0, 700.0, 4), [350.0, 750.0]);
    }
}
