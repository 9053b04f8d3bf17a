use proptest::prelude::*;

use super::*;

const FRAME: f64 = 1.0 / 60.0;

fn plan(asks: Asks) -> TrialPlan {
    let shown = |quality: &str, rank| Shown {
        stimulus: Stimulus { layout: "a".to_owned(), quality: quality.to_owned() },
        count: Some(3),
        rank,
    };
    TrialPlan { number: 2, phase: Phase::Critical, first: shown("HQ", 2), second: shown("CBQ", 1), asks }
}

const ALL: Asks = Asks { counts: true, worse: true, confidence: true };

fn timing() -> Timing {
    Timing { fixation_s: 1.0, interval_s: 6.0, gap_s: 0.5 }
}

/// Draws the present screen and hands it over.
fn seen(trial: &mut Trial, at_s: f64) {
    trial.frame(f64::NEG_INFINITY, FRAME);
    trial.swapped(at_s, FRAME);
}

/// Shows frames until a question stands; returns the time.
fn show(trial: &mut Trial, mut now: f64) -> f64 {
    while !matches!(trial.moment(), Moment::Count(_) | Moment::Worse | Moment::Confidence | Moment::Done) {
        trial.swapped(now, FRAME);
        trial.frame(now + FRAME, FRAME);
        now += FRAME;
    }
    trial.swapped(now, FRAME);
    now
}

#[test]
fn a_trial_shows_both_pictures_for_their_time_and_asks_in_order() {
    let mut trial = Trial::new(plan(ALL), timing());
    let now = show(&mut trial, 0.0);
    assert_eq!(trial.moment(), Moment::Count(Interval::First));
    for key in [Key::Digit(1), Key::Digit(2), Key::Backspace, Key::Enter] {
        trial.key(key, now);
    }
    seen(&mut trial, now);
    for key in [Key::Digit(4), Key::Enter] {
        trial.key(key, now);
    }
    assert_eq!(trial.moment(), Moment::Worse);
    seen(&mut trial, now);
    trial.key(Key::Digit(2), now + 1.25);
    seen(&mut trial, now);
    trial.key(Key::Digit(4), now);
    assert!(trial.is_over());
    let seen = trial.observed();
    assert_eq!((seen.first_count, seen.second_count), (Some(1), Some(4)));
    assert_eq!((seen.worse, seen.confidence), (Some(Interval::Second), Some(4)));
    assert!((seen.rt_s.unwrap() - 1.25).abs() < 1e-9);
    for frames in [seen.first.unwrap(), seen.second.unwrap()] {
        assert!((frames.duration_s.unwrap() - 6.0).abs() < 1e-6, "360 frames of 1/60 s");
        assert_eq!(frames.missed, 0);
    }
    assert!((seen.second.unwrap().onset_s - seen.first.unwrap().onset_s - 6.5).abs() < 1e-6);
}

#[test]
fn what_has_no_time_is_not_shown() {
    let none = Timing { fixation_s: 0.0, interval_s: 1.0, gap_s: 0.0 };
    let mut trial = Trial::new(plan(Asks::default()), none);
    assert_eq!(trial.moment(), Moment::Picture(Interval::First));
    seen(&mut trial, 0.0);
    trial.frame(1.0, FRAME);
    assert_eq!(trial.moment(), Moment::Picture(Interval::Second));
    trial.swapped(1.0, FRAME);
    trial.frame(2.0, FRAME);
    assert!(!trial.is_over(), "the second picture's end was not seen yet");
    trial.swapped(2.0, FRAME);
    assert!(trial.is_over());
    assert_eq!(trial.observed().first.unwrap().duration_s, Some(1.0));
    assert_eq!(trial.observed().second.unwrap().duration_s, Some(1.0));
}

/// The swap that returns after a key shows the screen from before that key: neither does it start the next question's
/// response time, nor may a key answer that question yet.
#[test]
fn a_question_is_seen_one_frame_after_the_key_that_brought_it() {
    let mut trial = Trial::new(plan(Asks { counts: false, ..ALL }), timing());
    let now = show(&mut trial, 0.0);
    trial.key(Key::Digit(1), now);
    assert_eq!(trial.moment(), Moment::Confidence);
    trial.swapped(now, FRAME);
    assert!(!trial.is_shown());
    trial.key(Key::Digit(4), now);
    assert_eq!(trial.moment(), Moment::Confidence);
    seen(&mut trial, now + FRAME);
    assert!(trial.is_shown());
}

#[test]
fn a_broken_trial_keeps_what_was_seen() {
    let mut trial = Trial::new(plan(ALL), timing());
    seen(&mut trial, 0.0);
    trial.frame(1.0, FRAME);
    trial.swapped(1.0, FRAME);
    trial.swapped(3.0, FRAME);
    let (_, seen) = trial.break_off(Interruption::Aborted);
    assert_eq!(seen.interruptions, [Interruption::Aborted]);
    let first = seen.first.unwrap();
    assert_eq!((first.onset_s, first.duration_s), (1.0, None));
    assert_eq!(first.missed, 119);
    assert_eq!(seen.second, None);
}

fn any_key() -> impl Strategy<Value = Key> {
    prop_oneof![
        (0_u8..10).prop_map(Key::Digit),
        Just(Key::Enter),
        Just(Key::Space),
        Just(Key::Backspace),
        Just(Key::Escape),
        Just(Key::F10),
        Just(Key::Other),
    ]
}

proptest! {
    /// No key whatever changes what is shown when, and none is taken for an answer before its question was seen.
    #[test]
    fn keys_before_a_question_answer_nothing(keys in prop::collection::vec((any_key(), 0.0_f64..13.5), 0..60)) {
        let mut trial = Trial::new(plan(ALL), timing());
        let mut now = 0.0;
        while !matches!(trial.moment(), Moment::Count(_)) {
            trial.swapped(now, FRAME);
            for (key, _) in keys.iter().filter(|(_, at)| (now..now + FRAME).contains(at)) {
                trial.key(*key, now);
            }
            trial.frame(now + FRAME, FRAME);
            now += FRAME;
        }
        for (key, _) in &keys {
            trial.key(*key, now); // drawn, but not yet seen
        }
        prop_assert_eq!(trial.moment(), Moment::Count(Interval::First));
        prop_assert_eq!(trial.typed(), "");
        trial.swapped(now, FRAME);
        let seen = trial.observed();
        prop_assert_eq!((seen.first_count, seen.worse, seen.confidence), (None, None, None));
        prop_assert!((seen.first.unwrap().duration_s.unwrap() - 6.0).abs() < 1e-6);
    }

    /// Frames of any length: each picture lasts its time to within half a frame either way.
    #[test]
    fn durations_are_right_to_half_a_frame(frame in 0.004_f64..0.1) {
        let mut trial = Trial::new(plan(ALL), timing());
        let mut now = 0.0;
        while !matches!(trial.moment(), Moment::Count(_)) {
            trial.swapped(now, frame);
            trial.frame(now + frame, frame);
            now += frame;
        }
        trial.swapped(now, frame);
        for frames in [trial.observed().first.unwrap(), trial.observed().second.unwrap()] {
            prop_assert!((frames.duration_s.unwrap() - 6.0).abs() <= frame / 2.0 + 1e-9);
            prop_assert_eq!(frames.missed, 0);
        }
    }
}
