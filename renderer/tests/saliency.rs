//! The saliency map against an independent transcription of the published formulas (`data/saliency/make.py`).

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use renderer::importance::saliency::saliency;
use renderer::raster::Raster;

const WIDTH: usize = 256;
const HEIGHT: usize = 192;
const STEP: usize = 8;

/// The generator of `make.py`.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = (self.0 * 1_103_515_245 + 12345) % (1 << 31);
        self.0 as f64 / (1_u64 << 31) as f64
    }
}

/// Picture `index` of `make.py`.
fn picture(index: u64) -> Raster<[f32; 3]> {
    let mut numbers = Numbers(index + 1);
    let spots: Vec<[f64; 6]> = (0..8)
        .map(|_| {
            let place = [numbers.next() * WIDTH as f64, numbers.next() * HEIGHT as f64, 4.0 + 20.0 * numbers.next()];
            let colour = [numbers.next() - 0.5, numbers.next() - 0.5, numbers.next() - 0.5];
            [place[0], place[1], place[2], colour[0], colour[1], colour[2]]
        })
        .collect();
    let (angle, period) = (std::f64::consts::PI * numbers.next(), 8.0 + 40.0 * numbers.next());
    let pixel = |x: f64, y: f64| {
        let wave = 0.05 * (std::f64::consts::TAU * (x * angle.cos() + y * angle.sin()) / period).cos();
        let mut out = [0.4 + wave; 3];
        for [cx, cy, size, colour @ ..] in &spots {
            let spot = (-((x - cx).powi(2) + (y - cy).powi(2)) / (2.0 * size * size)).exp();
            for (channel, part) in out.iter_mut().zip(colour) {
                *channel += part * spot;
            }
        }
        out.map(|value| value.clamp(0.0, 1.0) as f32)
    };
    let values = (0..WIDTH * HEIGHT).map(|i| pixel((i % WIDTH) as f64, (i / WIDTH) as f64)).collect();
    Raster::from_values(WIDTH, HEIGHT, values).unwrap()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(&x, &y)| f(x - ma, y - mb)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

#[test]
fn agrees_with_an_independent_transcription_on_twelve_pictures() {
    let table = include_str!("data/saliency/maps.csv");
    let mut lowest = f64::MAX;
    for (index, line) in table.lines().enumerate() {
        let expected: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        let map = saliency(&picture(index as u64));
        let found: Vec<f64> = (0..HEIGHT)
            .step_by(STEP)
            .flat_map(|y| (0..WIDTH).step_by(STEP).map(move |x| (x, y)))
            .map(|(x, y)| f64::from(*map.at(x, y)))
            .collect();
        assert_eq!(found.len(), expected.len());
        lowest = lowest.min(correlation(&found, &expected));
    }
    assert_eq!(table.lines().count(), 12);
    println!("lowest correlation {lowest:.6}");
    assert!(lowest >= 0.99, "lowest correlation {lowest}");
}
