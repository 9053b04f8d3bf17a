//! Times the saliency map of a picture of 1280 x 1024 pixels (or of a file) on one thread.
//!
//! `cargo run --release -p renderer --example saliency_time -- [PICTURE]`
//!
//! The map uses one thread whatever the machine has. Prints the least and the median of 21 runs, wall-clock: on a busy
//! machine the least is the one to quote.

use std::process::ExitCode;
use std::time::Instant;

use renderer::importance::saliency::saliency;
use renderer::picture;
use renderer::raster::Raster;

const RUNS: usize = 21;

fn main() -> ExitCode {
    let picture = match std::env::args_os().nth(1) {
        Some(path) => match picture::read(path.as_ref()) {
            Ok(picture) => picture.codes(1.0),
            Err(error) => {
                eprintln!("error: {error}");
                return ExitCode::from(2);
            }
        },
        None => textured(1280, 1024),
    };
    let mut times_s: Vec<f64> = (0..RUNS)
        .map(|_| {
            let begun = Instant::now();
            std::hint::black_box(saliency(std::hint::black_box(&picture)));
            begun.elapsed().as_secs_f64()
        })
        .collect();
    times_s.sort_by(f64::total_cmp);
    let (width, height) = (picture.width(), picture.height());
    println!(
        "{width} x {height}: least {:.1} ms, median {:.1} ms of {RUNS}",
        1e3 * times_s[0],
        1e3 * times_s[RUNS / 2]
    );
    ExitCode::SUCCESS
}

/// A picture with detail at every scale and of every hue.
fn textured(width: usize, height: usize) -> Raster<[f32; 3]> {
    let value = |i: usize| {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        let wave = |scale: f32, phase: f32| 0.5 + 0.5 * (x / scale + phase).sin() * (y / (1.3 * scale) - phase).cos();
        [wave(5.0, 0.0), wave(40.0, 1.0), wave(220.0, 2.0)]
    };
    let values = (0..width * height).map(value).collect();
    Raster::from_values(width, height, values).expect("one value a pixel was made")
}
