//! Traces the rays of the bench suite's room on one thread, and leaves mesh and rays for another tracer:
//!
//! ```text
//! cargo run --release -p renderer --example ray_rates -- FOLDER [SIDE]
//! ```
//!
//! writes `triangles.f32` (nine numbers each) and `primary.f32`, `diffuse.f32`, `shadow.f32` (origin, direction, end: seven
//! numbers a ray), and prints million rays per CPU second with the number of hits, as JSON. SIDE x SIDE primary rays.

#[path = "../benches/room/mod.rs"]
mod room;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use renderer::geometry::{Ray, Shadow};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some(folder) = words.first() else {
        eprintln!("usage: ray_rates FOLDER [SIDE]");
        return ExitCode::from(2);
    };
    let side = words.get(1).and_then(|word| word.parse().ok()).unwrap_or(500);
    match run(Path::new(folder), side) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, side: u32) -> std::io::Result<()> {
    let triangles = room::triangles();
    let aggregate = room::aggregate(&triangles);
    let rays = room::rays(&aggregate, side);
    let corners = triangles.iter().flatten().flat_map(|corner| corner.to_array().map(|x| x as f32));
    write(&folder.join("triangles.f32"), corners)?;
    let closest = |rays: &[Ray]| rays.iter().filter(|ray| aggregate.closest(ray).is_some()).count();
    let mut crossings = Vec::new();
    let mut rows = vec![
        measured("primary", &rays.primary, || closest(&rays.primary)),
        measured("diffuse", &rays.diffuse, || closest(&rays.diffuse)),
    ];
    rows.push(measured("shadow", &rays.shadow, || {
        rays.shadow.iter().filter(|ray| aggregate.shadow(ray, None, &mut crossings) != Shadow::Clear).count()
    }));
    for (name, rays) in [("primary", &rays.primary), ("diffuse", &rays.diffuse), ("shadow", &rays.shadow)] {
        let numbers = rays.iter().flat_map(|ray| {
            let ([a, b, c], [d, e, f]) = (ray.origin.to_array(), ray.dir.to_array());
            [a, b, c, d, e, f, ray.t_max].map(|x| x as f32)
        });
        write(&folder.join(format!("{name}.f32")), numbers)?;
    }
    println!("{{{}}}", rows.join(","));
    Ok(())
}

fn write(path: &Path, numbers: impl Iterator<Item = f32>) -> std::io::Result<()> {
    std::fs::write(path, numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
}

/// Seconds that this thread has been on a processor, where the system tells; else a clock's.
fn cpu_s(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |it| it * 1e-9)
}

fn measured(name: &str, rays: &[Ray], trace: impl FnOnce() -> usize) -> String {
    let clock = Instant::now();
    let start = cpu_s(clock);
    let hits = trace();
    let rate = rays.len() as f64 / (cpu_s(clock) - start) / 1e6;
    format!("\"{name}\":{{\"rays\":{},\"hits\":{hits},\"mrays_per_cpu_s\":{rate:.4}}}", rays.len())
}
