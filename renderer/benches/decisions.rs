//! What a decision under a time limit costs: `cargo bench -p renderer --bench decisions`.

use divan::{Bencher, counter::ItemsCount};
use renderer::component::{Component, PerComponent};
use renderer::crex;
use renderer::schedule::{Budget, ManualClock, PictureCosts, ProfileCache, RayKind, TimedScheduler, TimedWork};
use renderer::work::WorkReport;

fn main() {
    divan::main();
}

/// A profile as full as it gets.
fn profile() -> ProfileCache {
    let mut profile = ProfileCache::new("scene", "machine");
    for kind in RayKind::ALL {
        (0..100).for_each(|_| profile.observe(kind, 1000, 1e-3));
    }
    let predicted = profile.predict(RayKind::Primary, 1000).expect("it was observed");
    (0..256).for_each(|index| profile.record(&predicted, 1e-3 + 1e-6 * f64::from(index)));
    profile
}

/// From one stage's report to the next stage: learning, remembering the error, and deciding about the next task, by its own
/// letters and in groups.
#[divan::bench(args = ["(TRSMGD)100", "(T[RS](GM)D)150", "D600"])]
fn decisions(bencher: Bencher, expression: &str) {
    let program = crex::compile(expression).expect("a crex");
    let clock = ManualClock::default();
    let occupancy = PerComponent::from_fn(|component| 1000 + component as u64);
    let report =
        WorkReport { rays: 1000, spawned: PerComponent::from_fn(|c| u64::from(c == Component::Diffuse)), seconds: 0.0 };
    let known = profile();
    bencher.counter(ItemsCount::new(600_usize)).with_inputs(|| known.clone()).bench_local_refs(|profile| {
        let budget = Budget::new(&clock, 1e6, 0.0);
        let mut costs = PictureCosts::new(profile, program.text());
        let mut scheduler = TimedScheduler::new(&program, None, budget, &mut costs).expect("its own thresholds");
        let mut ran = 0_u64;
        while let Some(work) = scheduler.next(|_| occupancy) {
            if let TimedWork::Run(_) = work {
                scheduler.report(&report);
                ran += 1;
            }
        }
        ran
    });
}
