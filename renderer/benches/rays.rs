//! Rays per second by kind, on one thread: `cargo bench -p renderer --bench rays`.

mod room;

use std::sync::LazyLock;

use divan::Bencher;
use divan::counter::ItemsCount;
use renderer::geometry::{Aggregate, Ray, Shadow};
use room::Rays;

static ROOM: LazyLock<(Aggregate, Rays)> = LazyLock::new(|| {
    let aggregate = room::aggregate(&room::triangles());
    let rays = room::rays(&aggregate, 200);
    (aggregate, rays)
});

fn main() {
    divan::main();
}

fn closest(bencher: Bencher, rays: &[Ray]) {
    let aggregate = &ROOM.0;
    bencher
        .counter(ItemsCount::new(rays.len()))
        .bench(|| rays.iter().filter(|ray| aggregate.closest(divan::black_box(ray)).is_some()).count());
}

#[divan::bench]
fn closest_primary(bencher: Bencher) {
    closest(bencher, &ROOM.1.primary);
}

#[divan::bench]
fn closest_diffuse(bencher: Bencher) {
    closest(bencher, &ROOM.1.diffuse);
}

#[divan::bench]
fn any_hit_shadow(bencher: Bencher) {
    let (aggregate, rays) = &*ROOM;
    let mut crossings = Vec::new();
    bencher.counter(ItemsCount::new(rays.shadow.len())).bench_local(|| {
        let clear = |ray: &&Ray| aggregate.shadow(divan::black_box(ray), None, &mut crossings) == Shadow::Clear;
        rays.shadow.iter().filter(clear).count()
    });
}

#[divan::bench(sample_count = 5)]
fn build_hierarchy(bencher: Bencher) {
    let triangles = room::triangles();
    bencher.counter(ItemsCount::new(triangles.len())).bench(|| room::aggregate(&triangles));
}
