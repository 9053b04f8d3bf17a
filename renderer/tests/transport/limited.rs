//! Pictures within a time limit: whole at every bound, complete where they have samples, and repeatable. The clock is one
//! that ticks when it is looked at, so these limits fall anywhere in the work and nothing waits.

use std::sync::atomic::{AtomicU64, Ordering};

use renderer::component::Component;
use renderer::crex::{self, Program};
use renderer::film::Film;
use renderer::raster::Raster;
use renderer::render::{Renderer, RoundRecord, Settings, TimedRecord, TimedRendering};
use renderer::schedule::{Budget, Clock, ProfileCache};

use crate::Stage;
use crate::execution::{assert_same, room, settings};

/// A millisecond passes at every look, and more from some look on.
pub(crate) struct Ticking {
    looks: AtomicU64,
    /// From which look on the machine is slow.
    slow_from: u64,
}

/// Milliseconds that pass at a look when the machine is slow.
const SLOW: u64 = 20;

impl Default for Ticking {
    fn default() -> Self {
        Self { looks: AtomicU64::new(0), slow_from: u64::MAX }
    }
}

impl Clock for Ticking {
    fn now_s(&self) -> f64 {
        let looks = self.looks.fetch_add(1, Ordering::Relaxed);
        (looks.min(self.slow_from) + SLOW * looks.saturating_sub(self.slow_from)) as f64 * 1e-3
    }
}

impl Stage {
    fn within(&self, crex: &str, settings: Settings, seconds: f64, profile: &mut ProfileCache) -> TimedRendering {
        self.within_by(Ticking::default(), crex, settings, seconds, profile)
    }

    /// A profile of a few pictures with time for everything. Rays take no time by these clocks, only looks do; so what the sprinkle
    /// says of rounds must be learnt.
    fn taught(&self, crex: &str, samples: u32) -> ProfileCache {
        let mut profile = nothing_known();
        for _ in 0..3 {
            let settings = Settings { threads: Some(1), ..settings(samples) };
            let timed = self.within(crex, settings, 10.0, &mut profile);
            assert!(timed.record.rounds.iter().all(|round| !round.ran.contains(&false)));
        }
        profile
    }

    fn within_by(
        &self,
        clock: Ticking,
        crex: &str,
        settings: Settings,
        seconds: f64,
        profile: &mut ProfileCache,
    ) -> TimedRendering {
        let program = Program::new(&crex::parse(crex).unwrap());
        let renderer = Renderer::new(&self.scene, &self.aggregate, &self.view, &program, &clock, settings).unwrap();
        renderer.render_within(Budget::new(&clock, seconds, 0.0), profile).unwrap()
    }
}

fn nothing_known() -> ProfileCache {
    ProfileCache::new("scene", "machine")
}

/// Bounds from none at all to enough for several passes of nine tiles.
const BOUNDS: [f64; 12] = [0.0, 0.01, 0.05, 0.2, 0.6, 1.0, 1.6, 2.5, 4.0, 7.0, 12.0, 20.0];

/// Refinement runs single samples, so it cannot choose among them; what it may not do is run where nothing matters.
#[test]
fn continuous_importance_leaves_pixels_of_none_alone() {
    let room = room();
    let map = Raster::from_values(40, 40, (0..1600).map(|i| f32::from(u8::from(i % 40 >= 20))).collect()).unwrap();
    let program = Program::new(&crex::parse("{D}").unwrap());
    let clock = Ticking::default();
    let renderer = Renderer::new(&room.scene, &room.aggregate, &room.view, &program, &clock, settings(2)).unwrap();
    let renderer = renderer.with_importance(&map).unwrap().with_continuous_importance();
    let timed = renderer.render_within(Budget::new(&clock, 20.0, 0.0), &mut nothing_known()).unwrap();
    assert!(timed.refined_samples > 0.0);
    let layer = timed.rendering.film.layer(Component::Diffuse).unwrap();
    for row in layer.values().chunks_exact(40) {
        assert!(row[..20].iter().all(|pixel| *pixel == glam::Vec3::ZERO));
        assert!(row[20..].iter().any(|pixel| pixel.max_element() > 0.0));
    }
}

#[test]
fn every_bound_gives_a_whole_picture() {
    // Matt plastic in a furnace shows its albedo with any sample: a pixel that is not filled, that counts a sample twice, or
    // to which a skipped task gave a part of its light would differ from it.
    let text = "void glow white 0 0 4 1 1 1 0\nwhite source sky 0 0 4 0 0 1 360\n\
                void plastic stuff 0 0 5 .7 .5 .2 0 0\nstuff sphere ball 0 0 4 0 0 0 1\n";
    let ball = Stage::new(text, [0.0, -5.0, 0.0], [0.0, 1.0, 0.0], 5.0);
    let mut ran = 0;
    for (samples, seconds) in BOUNDS.into_iter().flat_map(|seconds| [(1, seconds), (3, seconds)]) {
        for crex in ["D", "[D]", "(TRSMGD)*"] {
            let timed = ball.within(crex, settings(samples), seconds, &mut nothing_known());
            for pixel in timed.rendering.film.beauty().values() {
                let error = (*pixel - glam::Vec3::new(0.7, 0.5, 0.2)).abs().max_element();
                assert!(error < 1e-6, "{crex}, {seconds} s: {pixel}");
            }
            ran += timed.record.rounds.len();
        }
    }
    assert!(ran > 0, "some bound left time for a round");
}

#[test]
fn rounds_have_more_samples_as_the_bound_grows() {
    let room = room();
    let settings = || Settings { threads: Some(1), ..settings(4) };
    let known = room.taught("TRSMGD", 4);
    let samples = |seconds: f64| -> u32 {
        let timed = room.within("TRSMGD", settings(), seconds, &mut known.clone());
        timed.record.rounds.iter().map(|round| round.samples).sum()
    };
    // From where the sprinkle is whole.
    let samples: Vec<u32> = (0..20).map(|step| samples(0.25 * 1.25_f64.powi(step))).collect();
    assert!(samples.is_sorted(), "{samples:?}");
    assert!(samples[0] < 2 && samples.contains(&2) && samples[19] == 4, "{samples:?}");
}

#[test]
fn a_record_repeats_its_picture_to_the_bit_with_any_number_of_threads() {
    let room = room();
    let crexes = ["T{RSGM}D", "(TRSMGD)*", "T[RS]<GD>M"];
    let known = crexes.map(|crex| room.taught(crex, 2));
    let mut records = Vec::new();
    // From too little for a round to several passes, close enough together that some end within one.
    for index in 0..30 {
        let seconds = 0.02 * 1.26_f64.powi(index);
        let crex = crexes[index as usize % 3];
        let mut profile = if index % 2 == 0 { nothing_known() } else { known[index as usize % 3].clone() };
        let timed = room.within(crex, settings(2), seconds, &mut profile);
        let again = |threads| {
            let settings = Settings { threads: Some(threads), ..settings(2) };
            room.with(crex, settings, |renderer| renderer.replay(&timed.record).unwrap())
        };
        for threads in [1, 3] {
            let again = again(threads);
            assert_same(&timed.rendering, &again.rendering);
            assert_eq!(timed.refined.rays, again.refined.rays);
        }
        records.push(timed.record);
    }
    let skipped = |record: &TimedRecord| record.rounds.iter().any(|round| round.ran.contains(&false));
    assert!(records.iter().any(skipped), "some task was skipped");
    assert!(records.iter().any(|record| record.rounds.is_empty()), "some bound was too small for a round");
}

/// All of 40 x 40 pixels in one round.
fn one_round(samples: u32, ran: &[bool]) -> TimedRecord {
    let round = RoundRecord { first_sample: 0, samples, tiles: 9, ran: ran.to_vec() };
    TimedRecord { rounds: vec![round], units: 0, missing: Vec::new() }
}

fn close(one: &Film, other: &Film) {
    for component in Component::ALL {
        let planes = (one.layer(component), other.layer(component));
        let (Some(one), Some(other)) = planes else {
            assert_eq!(planes, (None, None), "{component}");
            continue;
        };
        for (one, other) in one.values().iter().zip(other.values()) {
            assert!((*one - *other).abs().max_element() <= 1e-6 * (1.0 + one.abs().max_element()), "{one} {other}");
        }
    }
}

#[test]
fn a_round_of_everything_is_the_picture_without_a_limit() {
    let room = room();
    for crex in ["TRSMGD", "T{RSGM}<DG>2"] {
        // From eight samples on no pixel shares its neighbours' soft light.
        let replay = room.with(crex, settings(8), |renderer| renderer.replay(&one_round(8, &[true; 20])).unwrap());
        let plain = room.render(crex, settings(8));
        close(&replay.rendering.film, &plain.film);
        assert_eq!(replay.rendering.left, plain.left);
    }
}

#[test]
fn what_is_skipped_leaves_nothing_in_the_rounds() {
    // T and D run, [RS] does not: the same rays as those of TD.
    let room = room();
    let ran = [true, false, false, true];
    let replay = room.with("T[RS]D", settings(8), |renderer| renderer.replay(&one_round(8, &ran)).unwrap());
    let plain = room.render("TD", settings(8));
    close(&replay.rendering.film, &plain.film);
    assert_eq!(replay.rendering.left, plain.left);
}

#[test]
fn rounds_and_refinement_count_by_their_samples() {
    // Nothing is skipped: four samples of rounds and four whole passes of refinement (19 levels of nine tiles, which take the
    // sample numbers from 4 to 7) are the picture of eight samples, however they were traced.
    let room = room();
    let record = TimedRecord { units: 19 * 9, ..one_round(4, &[true; 6]) };
    let both = room.with("TRSMGD", settings(4), |renderer| renderer.replay(&record).unwrap());
    assert!((both.refined_samples - 4.0).abs() < 1e-12);
    close(&both.rendering.film, &room.render("TRSMGD", settings(8)).film);
    let refined = TimedRecord { rounds: Vec::new(), ..record };
    let alone = room.with("TRSMGD", settings(4), |renderer| renderer.replay(&refined).unwrap());
    assert_eq!(alone.rendering.primary.rays, 4 * 40 * 40);
}

#[test]
fn an_overrunning_task_is_cut_off_and_leaves_nothing_half_lit() {
    // The machine becomes slow somewhere in the work: tasks were admitted and overrun. What they leave must be what a record
    // without them leaves.
    let room = room();
    let mut cut = 0;
    let known = room.taught("DTRSMG", 1);
    for step in 0..60 {
        let clock = Ticking { slow_from: 10 * step, ..Ticking::default() };
        let timed = room.within_by(clock, "DTRSMG", settings(1), 2.0, &mut known.clone());
        let Some(round) = timed.record.rounds.first() else { continue };
        cut += u32::from(round.ran.contains(&false));
        let again = room.with("DTRSMG", settings(1), |renderer| renderer.replay(&timed.record).unwrap());
        assert_eq!(timed.rendering.film, again.rendering.film);
    }
    assert!(cut > 0, "no task was cut off or skipped");
}
