//! What `{ }` promises: below its threshold a component traces nothing, at it and above everything.

use proptest::prelude::*;
use renderer::component::{Component, PerComponent};
use renderer::raster::Raster;
use renderer::render::{Rendering, Settings};

use super::Stage;
use super::execution::room;

const EDGE: usize = 6;

fn settings() -> Settings {
    let mut settings = Settings::new(EDGE, EDGE);
    settings.samples = 2;
    settings.threads = Some(1);
    settings.limits.reflections = 4;
    settings
}

fn rendered(room: &Stage, crex: &str, map: &Raster<f32>, thresholds: &[f32]) -> Rendering {
    room.with(crex, settings(), |renderer| {
        renderer.with_importance(map).unwrap().with_thresholds(thresholds).unwrap().render().unwrap()
    })
}

/// Rays of each component in all stages.
fn rays(rendering: &Rendering) -> PerComponent<u64> {
    let mut rays = PerComponent::default();
    rendering.stages.iter().for_each(|row| rays[row.stage.component] += row.report.rays);
    rays
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// One important pixel after another: with only its own importance in the map, a pixel's rays of component i are those
    /// that the whole map has for it; so the rays of all pixels add up, and a pixel below i's threshold has exactly none.
    #[test]
    fn nothing_is_traced_below_a_threshold(
        values in prop::collection::vec(0.0_f32..=1.0, EDGE * EDGE),
        cuts in prop::collection::vec(0.01_f32..=1.0, 5),
        crex in prop::sample::select(vec!["T{RSGMD}", "(T{RSGMD})*", "{DSGRM}2"]),
    ) {
        let room = room();
        let map = Raster::from_values(EDGE, EDGE, values.clone()).unwrap();
        let whole = rendered(&room, crex, &map, &cuts);
        let members: Vec<Component> = crex
            .chars()
            .skip_while(|&letter| letter != '{')
            .filter_map(|letter| Component::ALL.into_iter().find(|component| component.letter() == letter))
            .take(5)
            .collect();
        // Pixels below a member's threshold, and that member alone in the braces' place: nothing at all is traced.
        let mut sum = PerComponent::<u64>::default();
        for pixel in 0..EDGE * EDGE {
            let mut alone = vec![0.0; EDGE * EDGE];
            alone[pixel] = values[pixel];
            let one = rendered(&room, crex, &Raster::from_values(EDGE, EDGE, alone).unwrap(), &cuts);
            let found = rays(&one);
            for (&member, &cut) in members.iter().zip(&cuts) {
                if values[pixel] < cut {
                    prop_assert_eq!(found[member], 0, "{} at {} below {}", member, values[pixel], cut);
                }
                sum[member] += found[member];
            }
        }
        let all = rays(&whole);
        for &member in &members {
            prop_assert_eq!(sum[member], all[member], "{} adds up", member);
        }
    }

    /// Where every pixel reaches every threshold the map changes no bit, and where none does only what is outside runs.
    #[test]
    fn ones_change_nothing_and_zeros_leave_nothing(cuts in prop::collection::vec(0.01_f32..=1.0, 5)) {
        let room = room();
        let of = |value: f32| rendered(&room, "T{RSGMD}", &Raster::filled(EDGE, EDGE, value), &cuts);
        let all = of(1.0);
        prop_assert_eq!(&all.film, &room.render("T{RSGMD}", settings()).film);
        let traced = rays(&all);
        prop_assert!(Component::ALL.into_iter().all(|component| traced[component] > 0));
        let none = of(0.0);
        prop_assert_eq!(none.film.beauty(), room.render("T", settings()).film.beauty());
        let inside = rays(&none);
        let unmoved = |component: Component| !"RSGMD".contains(component.letter()) || inside[component] == 0;
        prop_assert!(Component::ALL.into_iter().all(unmoved));
    }
}
