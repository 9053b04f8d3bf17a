//! What runs and what is skipped: tasks in the crex's order, `[ ]` whole or not at all, nothing left of what is skipped.

use std::collections::BTreeMap;

use proptest::prelude::*;
use renderer::component::{Component, PerComponent};
use renderer::crex::{Program, compile};
use renderer::schedule::{
    Budget, LEAST_PROBE, ManualClock, PROBE_SHARE, PROBES, PictureCosts, ProfileCache, Skipped, StageRow,
    TimedScheduler, TimedWork, executed,
};

use renderer::work::WorkReport;

use crate::scene::{self, Scene, Spawning};
use crate::tracer::{Prices, Timed, execute, knowing};
use crate::trees::{Forms, sequence, text};

/// So many pixels of importance 1, whose hits spawn one ray of each component up to words of `length`.
fn even(pixels: usize, length: usize) -> Scene {
    Scene { importance: vec![1.0; pixels], spawning: Spawning::Each { length } }
}

/// Prices in milliseconds a ray, by letter.
fn prices(given: &[(char, u64)]) -> Prices {
    let of = |component: Component| given.iter().find(|(letter, _)| *letter == component.letter());
    Prices {
        micros: PerComponent::from_fn(|component| of(component).map_or(1000, |(_, ms)| ms * 1000)),
        noise: 0.0,
        deeper: 1.0,
    }
}

fn run(crex: &str, scene: &Scene, prices: &Prices, seconds: f64) -> Timed {
    let program = compile(crex).expect(crex);
    execute(&program, scene, prices, seconds, &mut knowing(prices), 1)
}

#[test]
fn what_does_not_fit_is_skipped_and_the_next_task_considered() {
    // A hundred rays each. T and R cost .1 s, D costs 10 s.
    let prices = prices(&[('D', 100)]);
    let scene = even(100, 1);
    assert_eq!(run("TDR", &scene, &prices, 1.0).counts(), "T100 D- R100");
    assert_eq!(run("TDR", &scene, &prices, 11.0).counts(), "T100 D100 R100");
    assert_eq!(run("TDR", &scene, &prices, 0.15).counts(), "T100 D- R-");
    assert_eq!(run("TDR", &scene, &prices, 0.0).counts(), "T- D- R-");
    assert_eq!(run("TDR", &scene, &prices, -1.0).counts(), "T- D- R-");
    // Skipped rays stay where they were.
    assert_eq!(run("TDR", &scene, &prices, 1.0).left[Component::Diffuse], 100);
}

#[test]
fn a_group_in_brackets_runs_whole_or_not_at_all() {
    let prices = prices(&[('R', 10), ('S', 10)]);
    let scene = even(100, 1);
    // R alone would take 1 s, R and S take 2.
    assert_eq!(run("[RS]T", &scene, &prices, 1.5).counts(), "R- S- T100");
    assert_eq!(run("[RS]T", &scene, &prices, 2.5).counts(), "R100 S100 T100");
    assert_eq!(run("<RS>T", &scene, &prices, 1.5).counts(), "R100 S- T100");
    // Each member of a skipped group has the group's prediction.
    let skipped = run("[RS]T", &scene, &prices, 1.5);
    for row in &skipped.rows[..2] {
        assert_eq!(row.skipped, Some(Skipped::Time));
        assert!(row.predicted_s.is_some_and(|seconds| (seconds - 2.0).abs() < 1e-9));
    }
    // Groups inside are part of it; inside `< >` it is a task among others.
    assert_eq!(run("[R[S]<T>]D", &scene, &prices, 2.0).counts(), "R- S- T- D100");
    assert_eq!(run("<D[RS]T>", &scene, &prices, 1.5).counts(), "D100 R- S- T100");
    // D3 in brackets traces D once: three runs are predicted to take what the first one takes.
    assert_eq!(run("[D3]", &scene, &prices, 0.12).counts(), "D100 D0 D0");
}

#[test]
fn brackets_in_braces_are_predicted_on_what_the_map_admits() {
    // A hundred rays of a hundred pixels, ten of which are important enough.
    let importance = (0..100).map(|pixel| if pixel < 10 { 1.0 } else { 0.0 }).collect();
    let scene = Scene { importance, spawning: Spawning::Each { length: 1 } };
    let prices = prices(&[('R', 10), ('S', 10)]);
    assert_eq!(run("{[RS]}", &scene, &prices, 0.3).counts(), "R10 S10");
    assert_eq!(run("[RS]", &scene, &prices, 0.3).counts(), "R- S-");
    assert_eq!(run("{[RS]}", &scene, &prices, 0.1).counts(), "R- S-");
    assert_eq!(run("{R}", &scene, &prices, 0.12).counts(), "R10");
}

#[test]
fn a_star_ends_when_all_that_is_left_is_skipped() {
    let prices = prices(&[('D', 1000)]);
    assert_eq!(run("(TD)*", &even(10, 2), &prices, 1.0).counts(), "T10 D- T10 D- T0 D-");
    assert_eq!(run("([TD])*", &even(10, 2), &prices, 1.0).counts(), "T- D-");
    // However often: a skipped run leaves the next one nothing new.
    assert!(run("D4294967295", &even(10, 2), &prices, 1.0).rows.len() <= 1000);
}

#[test]
fn nothing_is_known_so_a_hundredth_is_probed() {
    let scene = even(20_000, 1);
    let program = compile("TD").expect("a crex");
    let mut profile = ProfileCache::new("scene", "machine");
    let timed = execute(&program, &scene, &prices(&[('D', 1)]), 1e6, &mut profile, 1);
    assert_eq!(timed.counts(), "T20000 D20000", "probed rays are the stage's, and counted once");
    for component in [Component::Transmitted, Component::Diffuse] {
        let probes: Vec<_> = timed.probes.iter().filter(|probe| probe.0 == component).collect();
        assert_eq!(probes.len(), PROBES as usize);
        let rays: u64 = probes.iter().map(|probe| probe.1).sum();
        assert!((rays as f64 - 20_000.0 * PROBE_SHARE).abs() <= f64::from(PROBES), "{rays}");
    }
    // The second time all is known.
    let again = execute(&program, &scene, &prices(&[('D', 1)]), 1e6, &mut profile, 1);
    assert!(again.probes.is_empty());
    // A bin smaller than its probes is all probed, and runs.
    let small = execute(&program, &even(50, 1), &Prices::flat(10), 1.0, &mut ProfileCache::new("", ""), 1);
    assert_eq!(small.counts(), "T50 D50");
    assert_eq!(small.probes[0].1, LEAST_PROBE);
}

#[test]
fn every_place_is_predicted_by_what_it_cost_before() {
    // Rays cost thrice as much from generation to generation, R ten times what T and S do.
    let mut given = prices(&[('R', 10)]);
    given.deeper = 3.0;
    let scene = even(200, 3);
    let program = compile("T[RS]T[RS]").expect("a crex");
    let mut profile = knowing(&given);
    (0..20).for_each(|seed| drop(execute(&program, &scene, &given, 1e6, &mut profile, seed)));
    let timed = execute(&program, &scene, &given, 1e6, &mut profile, 1);
    assert_eq!(timed.rows.len(), 6);
    for row in &timed.rows {
        let predicted = row.predicted_s.expect("it was predicted");
        // Members of a group each by themselves.
        assert!((predicted / row.report.seconds - 1.0).abs() < 1e-6, "{} {predicted}", row.stage.component);
    }
    // The bound is the whole group's.
    assert_eq!(timed.rows[1].bound_s, timed.rows[2].bound_s);
    assert!(timed.rows[1].bound_s > timed.rows[1].predicted_s);
    // By component alone the two T would have had one cost a ray.
    let a_ray = |row: &StageRow| row.report.seconds / row.report.rays as f64;
    assert!(a_ray(&timed.rows[3]) > 1.5 * a_ray(&timed.rows[0]));
}

#[test]
fn probes_of_a_skipped_task_leave_nothing_behind() {
    let scene = even(20_000, 2);
    let program = compile("D[GS]T").expect("a crex");
    // T is a thousand times cheaper than the rest, of which each takes 20 s.
    let prices = Prices {
        micros: PerComponent::from_fn(|c| if c == Component::Transmitted { 1 } else { 1000 }),
        noise: 0.0,
        deeper: 1.0,
    };
    let timed = execute(&program, &scene, &prices, 5.0, &mut ProfileCache::new("scene", "machine"), 1);
    assert_eq!(timed.counts(), "D- G- S- T20000");
    assert!(timed.wasted > 0, "it was probed");
    assert_eq!(timed.words(), BTreeMap::from([("T".to_owned(), 20_000)]));
    assert_eq!(timed.left[Component::Diffuse], 40_000, "all its own rays, and what T spawned");
    assert!(timed.end_s < 5.0);
}

#[test]
fn probes_ask_for_little_time_when_little_is_left() {
    // A second for a ray and nothing known but that: a hundredth of 3000 rays would be thirty seconds.
    let mut profile = ProfileCache::new("scene", "machine");
    profile.observe(renderer::schedule::RayKind::Primary, 100, 100.0);
    let program = compile("TD").expect("a crex");
    let timed = execute(&program, &even(3000, 1), &Prices::flat(1_000_000), 10.0, &mut profile, 1);
    assert_eq!(timed.counts(), "T- D-");
    assert_eq!(timed.probes.iter().map(|probe| probe.1).sum::<u64>(), 2 * u64::from(PROBES));
}

fn scenes() -> impl Strategy<Value = Scene> {
    let importance = prop::collection::vec((0..=8u8).prop_map(|i| f32::from(i) / 8.0), 1..12);
    (importance, any::<u64>(), 1..5usize)
        .prop_map(|(importance, seed, length)| Scene { importance, spawning: Spawning::Random { seed, length } })
}

/// Rows of the runs of outermost `[ ]`, each run by itself.
fn groups<'r>(program: &Program, rows: &'r [StageRow]) -> Vec<Vec<&'r StageRow>> {
    let mut groups: Vec<Vec<&StageRow>> = Vec::new();
    let mut last = None;
    for row in rows {
        let run = row.stage.group.map(|group| (group, program.holding(&row.stage)));
        match groups.last_mut() {
            Some(group) if run.is_some() && run == last => group.push(row),
            _ if run.is_some() => groups.push(vec![row]),
            _ => {}
        }
        last = run;
    }
    groups
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn with_time_to_spare_all_runs_as_without_a_limit(items in sequence(3, 3, Forms::ALL), scene in scenes()) {
        let crex = text(&items);
        let program = compile(&crex).expect("a crex");
        let timed = execute(&program, &scene, &Prices::flat(1), 1e9, &mut ProfileCache::new("", ""), 1);
        let untimed = scene::execute(&program, None, &scene, 0..scene.importance.len() as u32);
        prop_assert_eq!(timed.counts(), untimed.counts(), "{}", crex);
        prop_assert_eq!(timed.sorted(), untimed.sorted());
        prop_assert_eq!(timed.left, untimed.left);
        for (one, other) in timed.rows.iter().zip(&untimed.rows) {
            prop_assert_eq!(&one.stage, &other.stage);
            prop_assert_eq!(one.report.spawned, other.report.spawned);
        }
    }

    #[test]
    fn what_ran_is_a_crex_of_its_own(
        items in sequence(3, 3, Forms::ALL),
        scene in scenes(),
        costs in prop::collection::vec(1..5000u64, 6),
        bound_ms in 0..400u32,
        known in any::<bool>(),
    ) {
        let crex = text(&items);
        let program = compile(&crex).expect("a crex");
        let prices = Prices { micros: PerComponent::from_fn(|component| costs[component as usize]), noise: 0.0, deeper: 1.0 };
        let mut profile = if known { knowing(&prices) } else { ProfileCache::new("", "") };
        let bound = f64::from(bound_ms) / 1000.0;
        let timed = execute(&program, &scene, &prices, bound, &mut profile, 1);

        // Whole groups or nothing of them, runs without rays apart.
        for group in groups(&program, &timed.rows) {
            prop_assert!(group.iter().all(|row| row.skipped == group[0].skipped), "{}: {}", crex, timed.counts());
        }
        // The rays traced are those of the crex that it amounts to: skipped tasks left no light, and lost no ray.
        let amounts = executed(&program, &timed.rows);
        let short = compile(&amounts.crex).expect("a crex");
        let untimed = scene::execute(&short, Some(&amounts.thresholds), &scene, 0..scene.importance.len() as u32);
        prop_assert_eq!(timed.sorted(), untimed.sorted(), "{} for {}", amounts.crex, crex);
        prop_assert_eq!(timed.left, untimed.left);
        if known {
            // Costs known exactly are kept to exactly.
            prop_assert!(timed.end_s <= bound, "{} > {bound}: {} {}", timed.end_s, crex, timed.counts());
            prop_assert!(timed.probes.is_empty());
        }
    }
}

#[test]
fn a_task_that_is_cut_off_is_undone_whole_and_nothing_follows() {
    let program = compile("T[RS]D").expect("a crex");
    let prices = Prices::flat(1000);
    let mut profile = knowing(&prices);
    let clock = ManualClock::default();
    let budget = Budget::new(&clock, 100.0, 0.0);
    let mut costs = PictureCosts::new(&mut profile, program.text());
    let mut scheduler = TimedScheduler::new(&program, None, budget, &mut costs).expect("own thresholds");
    let hundred = |_| PerComponent::from_fn(|_| 100);
    let done = WorkReport { rays: 100, ..WorkReport::default() };
    let mut begun = Vec::new();
    while let Some(work) = scheduler.next(hundred) {
        let TimedWork::Run(stage) = work else { continue };
        begun.push((stage.component.letter(), scheduler.begins_task()));
        // S takes far longer than it was predicted to, and is cut off.
        if stage.component == Component::Specular {
            clock.advance_ns(99_000_000_000);
            scheduler.cut_off(&WorkReport { rays: 40, ..WorkReport::default() });
        } else {
            clock.advance_ns(100_000_000);
            scheduler.report(&done);
        }
    }
    assert_eq!(begun, [('T', true), ('R', true), ('S', false)], "a group is begun once");
    let rows = scheduler.into_rows();
    let rows: Vec<_> = rows.iter().map(|row| (row.stage.component.letter(), row.report.rays, row.skipped)).collect();
    let time = Some(Skipped::Time);
    assert_eq!(rows, [('T', 100, None), ('R', 0, time), ('S', 0, time), ('D', 0, time)]);
}
