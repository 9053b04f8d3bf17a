//! Proposals for small rooms: order, choices, thresholds.

#![allow(clippy::unwrap_used, reason = "a test that cannot start has failed")]

use std::sync::atomic::{AtomicU64, Ordering};

use renderer::component::{Component, ComponentSet};
use renderer::picture::display::Display;
use renderer::propose::{Level, Modulated, Profile, Question, modulate, propose_from, propose_while};
use renderer::rad::{self, MemoryFiles, Source, ViewSpec};
use renderer::render::Settings;
use renderer::scene::{Scene, View};
use renderer::schedule::Clock;

/// A clock by which everything takes as long as everything else: a millisecond passes at each look.
#[derive(Default)]
struct Even(AtomicU64);

impl Clock for Even {
    fn now_s(&self) -> f64 {
        self.0.fetch_add(1, Ordering::Relaxed) as f64 * 1e-3
    }
}

/// Proposes for a room from its text, seen along +y from the middle of a wall.
fn with_profile<T>(text: &str, work: impl FnOnce(&mut Profile<'_>) -> T) -> T {
    with_question(text, |question| work(&mut Profile::new(question).unwrap()))
}

fn with_question<T>(text: &str, work: impl FnOnce(Question<'_>) -> T) -> T {
    let document = rad::read(&[Source::new("test.rad", text)], &MemoryFiles::new(), &rad::Options::default()).unwrap();
    let scene = Scene::from_rad(&document).unwrap();
    let aggregate = scene.aggregate();
    let spec = ViewSpec {
        point: [0.0, -1.9, 1.5],
        direction: [0.0, 1.0, 0.0],
        up: [0.0, 0.0, 1.0],
        horizontal: 70.0,
        vertical: 70.0,
        ..ViewSpec::default()
    };
    let view = View::new(spec).unwrap();
    let mut settings = Settings::new(480, 480);
    settings.threads = Some(1);
    settings.limits.least_weight = 0.01;
    let (display, clock) = (Display::of_the_paper(), Even::default());
    let question = Question {
        scene: &scene,
        aggregate: &aggregate,
        view: &view,
        settings: &settings,
        display: &display,
        exposure: None,
        clock: &clock,
    };
    work(question)
}

/// Walls, floor and ceiling of a material `wall`, a lamp, and what else there is.
fn room(wall: &str, more: &str) -> String {
    format!(
        "void light lamp 0 0 3 20 20 20\nvoid plastic wall 0 0 5 {wall} 0 0\nwall bubble shell 0 0 4 0 0 1.5 3\n\
         lamp polygon l 0 0 12 -.5 -1 3 -.5 0 3 .5 0 3 .5 -1 3\n{more}"
    )
}

const MIRROR: &str = "void mirror silver 0 0 3 .9 .9 .9\nsilver polygon m 0 0 12 -2 1 0 2 1 0 2 1 3 -2 1 3\n";

#[test]
fn steps_lead_from_direct_light_to_the_full_solution() {
    let more = "void glass pane 0 0 3 .9 .9 .9\npane polygon p 0 0 12 -1 .5 0 1 .5 0 1 .5 2 -1 .5 2\n\
                void metal brass 0 0 5 .8 .6 .3 .9 .2\nbrass sphere b 0 0 4 0 1.5 1 .5\n";
    with_profile(&room(".5 .5 .5", more), |profile| {
        let proposal = propose_from(profile).unwrap();
        let (first, last) = (&proposal.steps[0], proposal.full());
        assert_eq!((first.crex.as_str(), first.levels.components()), ("", &[][..]));
        assert_eq!(last.forecast.loss_jod, 0.0);
        // All that the scene can spawn, and nothing else.
        let ran: ComponentSet = last.levels.components().iter().copied().collect();
        assert_eq!(ran, profile.components());
        assert!(!ran.contains(Component::Mirror) && !ran.contains(Component::Specular));
        assert!(last.levels.components().iter().all(|&component| last.levels.level(component) == Level::All));
        for pair in proposal.steps.windows(2) {
            assert!(pair[0].forecast.seconds < pair[1].forecast.seconds, "{} {}", pair[0].crex, pair[1].crex);
        }
        // The choices keep what they promise.
        let chosen = proposal.within_loss(0.3);
        assert!(chosen.forecast.loss_jod <= 0.3);
        assert_eq!(proposal.within_seconds(0.0), first);
        // Never above the bound, and never less gain with more time.
        let mut before = first.forecast.loss_jod;
        for part in 0..=64 {
            let bound = first.forecast.seconds
                * (1.01 + f64::from(part) / 16.0 * last.forecast.seconds / first.forecast.seconds);
            let chosen = proposal.within_seconds(bound).forecast;
            assert!(chosen.seconds <= bound && chosen.loss_jod <= before, "{part}: {chosen:?}");
            before = chosen.loss_jod;
        }
        assert_eq!(before, 0.0, "with time for all, the full solution");
        assert!(proposal.seen.len() > proposal.steps.len(), "candidates that were no step count too");
        assert_eq!(proposal.within_loss(0.0).forecast.loss_jod, 0.0);
    });
}

/// In a nearly black room a mirror shows the lamp and walls, and diffuse light is a hundredth; in a white one without a mirror
/// there is diffuse light alone.
#[test]
fn what_is_seen_most_comes_first() {
    with_profile(&room(".01 .01 .01", MIRROR), |profile| {
        let proposal = propose_from(profile).unwrap();
        assert_eq!(proposal.full().levels.components(), [Component::Mirror, Component::Diffuse]);
    });
    with_profile(&room(".9 .9 .9", ""), |profile| {
        let proposal = propose_from(profile).unwrap();
        assert_eq!(proposal.steps[1].crex, "D");
        let losses: Vec<f64> = proposal.steps.iter().map(|step| step.forecast.loss_jod).collect();
        assert!(losses.windows(2).all(|pair| pair[0] > pair[1]), "each diffuse event adds light: {losses:?}");
    });
}

#[test]
fn a_scene_that_spawns_nothing_is_one_step() {
    with_profile("void glow sky 0 0 4 1 1 1 0\nsky source s 0 0 4 0 1 0 360\n", |profile| {
        let proposal = propose_from(profile).unwrap();
        assert_eq!(proposal.steps.len(), 1);
        assert_eq!((proposal.full().crex.as_str(), proposal.full().forecast.loss_jod), ("", 0.0));
    });
}

#[test]
fn thresholds_fit_their_crex_and_rise_as_visibility_falls() {
    with_profile(&room(".4 .4 .4", MIRROR), |profile| {
        let full = propose_from(profile).unwrap().full().clone();
        let strict = modulate(profile, &full, 0.05).unwrap();
        let lax = modulate(profile, &full, 1e3).unwrap();
        let members = |made: &Modulated| {
            let program = renderer::crex::Program::new(&renderer::crex::parse(&made.crex).unwrap());
            renderer::schedule::Scheduler::new(&program, Some(&made.thresholds)).unwrap();
        };
        members(&strict);
        members(&lax);
        // With a tolerance beyond the scale nothing has to run below full importance.
        assert!(!lax.thresholds.is_empty() && lax.thresholds.iter().all(|&threshold| threshold == 1.0));
        assert!(strict.thresholds.iter().all(|&threshold| threshold > 0.0 && threshold < 1.0), "{strict:?}");
    });
}

/// The time for choosing ends after any number of looks: what was looked at until then is chosen from, and the full solution
/// always.
#[test]
fn a_choice_that_is_cut_short_still_knows_the_full_solution() {
    with_profile(&room(".4 .4 .4", MIRROR), |profile| {
        let whole = propose_from(profile).unwrap();
        for most in 0..whole.seen.len() as u64 {
            let looks = AtomicU64::new(0);
            let short = propose_while(profile, &|| looks.fetch_add(1, Ordering::Relaxed) < most).unwrap();
            assert_eq!(short.within_seconds(f64::INFINITY).forecast.loss_jod, 0.0);
            assert_eq!(short.within_seconds(0.0).crex, "");
            assert!(short.seen.len() as u64 <= most + 2);
            for step in &short.seen {
                assert!(whole.seen.iter().any(|known| known.crex == step.crex && known.forecast == step.forecast));
            }
        }
    });
}

/// Small pictures as small as the time allows, down to none.
#[test]
fn little_time_for_choosing_means_small_pictures_or_none() {
    let text = room(".5 .5 .5", "");
    with_question(&text, |question| {
        assert!(Profile::within(question, 0.0).unwrap().is_none());
        let mut profile = Profile::within(question, 1e6).unwrap().expect("there is time");
        assert_eq!(propose_from(&mut profile).unwrap().within_seconds(f64::INFINITY).forecast.loss_jod, 0.0);
    });
}
