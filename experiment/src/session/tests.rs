use proptest::prelude::*;

use super::*;
use crate::design::Plan;
use crate::draw::Draws;
use crate::{example, script};

const FRAME: f64 = 1.0 / 60.0;

fn steps() -> (Vec<Step>, Timing) {
    let study = example::study(4);
    let plan = Plan::draw(&study, 1);
    (script::steps(&study, &plan.slots[0]), study.timing)
}

fn begin() -> (Session, Effect) {
    let (steps, timing) = steps();
    Session::begin(steps, timing)
}

/// A driver that keeps what was saved and presses what each screen asks for.
struct Driver {
    session: Session,
    effect: Effect,
    now: f64,
    saved: Vec<Record>,
}

impl Driver {
    fn new((session, effect): (Session, Effect)) -> Self {
        let mut driver = Self { session, effect, now: 0.0, saved: Vec::new() };
        driver.settle();
        driver
    }

    /// Saves what is to be saved, until nothing is.
    fn settle(&mut self) {
        while let Effect::Save(record) = &self.effect {
            self.saved.push(record.clone());
            self.effect = self.session.step(Input::Saved);
        }
    }

    fn input(&mut self, input: Input) {
        self.effect = self.session.step(input);
        self.settle();
    }

    fn press(&mut self, key: Key) {
        self.input(Input::Key { key, now_s: self.now });
    }

    fn frame(&mut self) {
        self.now += FRAME;
        self.input(Input::Frame { shows_s: self.now, frame_s: FRAME });
        self.input(Input::Swapped { at_s: self.now, frame_s: FRAME });
    }

    /// One frame and, where a screen waits, the key that it waits for.
    fn go_on(&mut self) {
        self.frame();
        let key = match self.session.screen() {
            Screen::Consent | Screen::Worse | Screen::Confidence => Key::Digit(1),
            Screen::Page(_) => Key::Space,
            Screen::Count(_, "") => Key::Digit(7),
            Screen::Count(..) => Key::Enter,
            Screen::KnownTask => Key::Digit(2),
            Screen::Noticed => return self.input(Input::Text("a chair, \"blue\"\nand more".to_owned())),
            _ => return,
        };
        self.press(key);
    }

    fn until(&mut self, stop: impl Fn(&Screen<'_>) -> bool) {
        while !stop(&self.session.screen()) {
            self.go_on();
        }
    }

    fn trials(&self) -> Vec<(u32, Vec<Interruption>)> {
        let trial = |record: &Record| match record {
            Record::Trial { plan, observed, .. } => Some((plan.number, observed.interruptions.clone())),
            _ => None,
        };
        self.saved.iter().filter_map(trial).collect()
    }
}

fn is_end(screen: &Screen<'_>) -> bool {
    matches!(screen, Screen::End(_))
}

#[test]
fn a_session_goes_through_every_step_and_saves_in_order() {
    let mut driver = Driver::new(begin());
    driver.until(is_end);
    let kinds: Vec<&str> = driver
        .saved
        .iter()
        .map(|record| match record {
            Record::Consent(true) => "consent",
            Record::Consent(false) => "refusal",
            Record::PairStarts { .. } => "pair",
            Record::Trial { .. } => "row",
            Record::Noticed(_) => "noticed",
            Record::KnownTask(_) => "known",
            Record::Ended(Outcome::Completed) => "end",
            Record::Ended(_) => "broken",
        })
        .collect();
    assert_eq!(kinds, ["consent", "pair", "row", "pair", "row", "noticed", "known", "pair", "row", "end"]);
    driver.frame();
    driver.press(Key::Enter);
    assert_eq!(driver.effect, Effect::Finished(Outcome::Completed));
}

#[test]
fn nothing_is_shown_before_its_record_is_saved() {
    let (mut session, _) = begin();
    session.step(Input::Frame { shows_s: 0.0, frame_s: FRAME });
    session.step(Input::Swapped { at_s: 0.0, frame_s: FRAME });
    let effect = session.step(Input::Key { key: Key::Digit(1), now_s: 1.0 });
    assert_eq!(effect, Effect::Save(Record::Consent(true)));
    for input in [
        Input::Key { key: Key::Space, now_s: 2.0 },
        Input::Swapped { at_s: 2.0, frame_s: FRAME },
        Input::Frame { shows_s: 60.0, frame_s: FRAME },
        Input::Text("x".to_owned()),
        Input::Interrupted(Interruption::FocusLost),
    ] {
        assert_eq!(session.step(input), Effect::None);
        assert_eq!(session.screen(), Screen::Consent);
    }
    assert_eq!(session.step(Input::Saved), Effect::None);
    assert_eq!(session.screen(), Screen::Page(Page::Instructions));
}

#[test]
fn a_full_disk_stops_the_session_until_it_can_save() {
    let (mut session, _) = begin();
    session.step(Input::Frame { shows_s: 0.0, frame_s: FRAME });
    session.step(Input::Swapped { at_s: 0.0, frame_s: FRAME });
    session.step(Input::Key { key: Key::Digit(1), now_s: 1.0 });
    session.step(Input::NotSaved("no space left".to_owned()));
    assert_eq!(session.screen(), Screen::Trouble("no space left"));
    assert_eq!(session.step(Input::Key { key: Key::Space, now_s: 2.0 }), Effect::None);
    let again = session.step(Input::Key { key: Key::Enter, now_s: 3.0 });
    assert_eq!(again, Effect::Save(Record::Consent(true)));
    session.step(Input::Saved);
    assert_eq!(session.screen(), Screen::Page(Page::Instructions));
}

#[test]
fn who_does_not_agree_sees_no_picture() {
    let mut driver = Driver::new(begin());
    driver.frame();
    driver.press(Key::Digit(2));
    assert_eq!(driver.session.screen(), Screen::End(Outcome::Declined));
    assert_eq!(driver.saved, [Record::Consent(false), Record::Ended(Outcome::Declined)]);
}

#[test]
fn until_the_critical_answer_nothing_asks_about_quality() {
    let (steps, _) = steps();
    let critical = steps.iter().position(|step| matches!(step, Step::Trial(plan) if plan.phase == Phase::Critical));
    for step in &steps[..critical.unwrap()] {
        if let Step::Trial(plan) = step {
            assert!(!plan.asks.worse && !plan.asks.confidence && plan.asks.counts);
        }
    }
}

#[test]
fn one_escape_marks_a_trial_and_ends_nothing() {
    let mut driver = Driver::new(begin());
    driver.until(|screen| matches!(screen, Screen::Picture(_)));
    driver.press(Key::Escape);
    driver.input(Input::Released(Key::Escape));
    driver.press(Key::F10);
    driver.until(is_end);
    assert_eq!(driver.session.screen(), Screen::End(Outcome::Completed));
    let trials = driver.trials();
    assert_eq!(trials[0], (1, vec![Interruption::Escape]));
    assert!(trials[1..].iter().all(|(_, interruptions)| interruptions.is_empty()));
}

/// 500 sessions, each disturbed once, at a moment that the seed decides: one Escape, one theft of the keyboard, one press of
/// the window's close button, one cover over it. Every one goes through to its end with every row.
#[test]
fn no_single_disturbance_ends_a_session() {
    let what = [Interruption::Escape, Interruption::FocusLost, Interruption::CloseRequested, Interruption::Occluded];
    let mut marked = 0;
    for seed in 0..500 {
        let mut draws = Draws::new(seed, "disturbance");
        let (steps, _) = steps();
        let timing = Timing { fixation_s: 0.1, interval_s: 0.3, gap_s: 0.1 };
        let mut driver = Driver::new(Session::begin(steps, timing));
        let (mut left, what) = (draws.below(150), what[draws.below(4) as usize]);
        while !is_end(&driver.session.screen()) {
            driver.go_on();
            if left == 0 {
                if what == Interruption::Escape {
                    driver.press(Key::Escape);
                    driver.input(Input::Released(Key::Escape));
                } else {
                    driver.input(Input::Interrupted(what));
                }
            }
            left = left.wrapping_sub(1);
        }
        assert_eq!(driver.session.screen(), Screen::End(Outcome::Completed), "{what:?} in session {seed}");
        let trials = driver.trials();
        assert_eq!(trials.len(), 3);
        let found: Vec<_> = trials.into_iter().flat_map(|(_, interruptions)| interruptions).collect();
        assert!(found.is_empty() || found == [what]);
        marked += found.len();
    }
    assert!(marked > 250, "most of a session is trials: {marked}");
}

#[test]
fn the_two_steps_of_an_abort_keep_the_trial_as_far_as_it_came() {
    let mut driver = Driver::new(begin());
    driver.until(|screen| matches!(screen, Screen::Picture(_)));
    driver.press(Key::Escape);
    for _ in 0..130 {
        driver.frame(); // more than two seconds
    }
    assert!(driver.session.abort_asked());
    driver.press(Key::F10);
    assert_eq!(driver.session.screen(), Screen::End(Outcome::Aborted));
    assert_eq!(driver.trials(), [(1, vec![Interruption::Escape, Interruption::Aborted])]);
    assert_eq!(driver.saved.last(), Some(&Record::Ended(Outcome::Aborted)));
}

#[test]
fn an_abort_that_is_not_confirmed_passes() {
    for key in [Key::Space, Key::Digit(1), Key::Other] {
        let mut driver = Driver::new(begin());
        driver.frame();
        driver.press(Key::Escape);
        for _ in 0..130 {
            driver.frame();
        }
        driver.press(key);
        assert!(!driver.session.abort_asked());
        assert_eq!(driver.session.screen(), Screen::Consent, "the key that says no to the abort answers nothing else");
        driver.press(Key::F10);
        driver.until(is_end);
        assert_eq!(driver.session.screen(), Screen::End(Outcome::Completed));
    }
}

/// What is on disk after some records.
fn on_disk(records: &[Record]) -> Done {
    let mut done = Done::default();
    for record in records {
        match record {
            Record::Consent(agreed) => done.consent = Some(*agreed),
            Record::PairStarts { trial, .. } => drop(done.started.insert(*trial)),
            Record::Trial { plan, .. } => drop(done.finished.insert(plan.number)),
            Record::Noticed(_) => done.noticed = true,
            Record::KnownTask(known) => done.known_task = Some(*known),
            Record::Ended(outcome) => done.ended = Some(*outcome),
        }
    }
    done
}

proptest! {
    /// Cut off behind any of its records, a session taken up again ends with one row for every trial, in order: those cut
    /// off are marked, and no pair is started twice.
    #[test]
    fn a_resumed_session_loses_and_repeats_nothing(cuts in prop::collection::vec(0_usize..11, 0..6)) {
        let mut records: Vec<Record> = Vec::new();
        for cut in cuts.into_iter().map(Some).chain([None]) {
            let (steps, timing) = steps();
            let resumed = if records.is_empty() {
                Session::begin(steps, timing)
            } else {
                Session::resume(steps, timing, &on_disk(&records), 60.0)
            };
            let mut driver = Driver::new(resumed);
            while driver.saved.len() < cut.unwrap_or(usize::MAX) && !is_end(&driver.session.screen()) {
                driver.go_on();
            }
            driver.saved.truncate(cut.unwrap_or(usize::MAX));
            records.extend(driver.saved);
        }
        let rows: Vec<u32> = records.iter().filter_map(|record| match record {
            Record::Trial { plan, .. } => Some(plan.number),
            _ => None,
        }).collect();
        prop_assert_eq!(rows, [1, 2, 3]);
        let pairs: Vec<u32> = records.iter().filter_map(|record| match record {
            Record::PairStarts { trial, .. } => Some(*trial),
            _ => None,
        }).collect();
        prop_assert_eq!(pairs, [1, 2, 3]);
        for (i, record) in records.iter().enumerate() {
            if let Record::Trial { plan, observed, resume_gap_s } = record {
                let lost = observed.interruptions.contains(&Interruption::Crash);
                prop_assert_eq!(lost, resume_gap_s.is_some());
                prop_assert_eq!(lost, observed.worse.is_none() && observed.first_count.is_none());
                let starts = Record::PairStarts { trial: plan.number, phase: plan.phase };
                prop_assert_eq!(&records[i - 1], &starts);
            }
        }
        prop_assert_eq!(records.last(), Some(&Record::Ended(Outcome::Completed)));
    }

    /// Whatever happens in whatever order, the machine neither panics nor shows a picture whose start is not on disk.
    #[test]
    fn no_order_of_events_breaks_it(events in prop::collection::vec((0_u8..14, any::<bool>()), 0..400)) {
        let (mut session, mut effect) = begin();
        let (mut now, mut started) = (0.0, 0);
        for (event, short) in events {
            now += if short { FRAME } else { 1.0 };
            if let Effect::Save(Record::PairStarts { trial, .. }) = &effect {
                started = *trial;
            }
            effect = session.step(match event {
                0 | 1 => Input::Saved,
                2 => Input::NotSaved("full".to_owned()),
                3 => Input::Key { key: Key::Digit(1), now_s: now },
                4 => Input::Key { key: Key::Space, now_s: now },
                5 => Input::Key { key: Key::Enter, now_s: now },
                6 => Input::Key { key: Key::Escape, now_s: now },
                7 => Input::Key { key: Key::F10, now_s: now },
                8 => Input::Released(Key::Escape),
                9 => Input::Text("text".to_owned()),
                10 => Input::Interrupted(Interruption::FocusLost),
                11 | 12 => Input::Swapped { at_s: now, frame_s: FRAME },
                _ => Input::Frame { shows_s: now, frame_s: FRAME },
            });
            if let Screen::Picture(_) = session.screen() {
                prop_assert!(session.trial().is_some_and(|trial| trial.plan().number <= started));
            }
        }
    }
}
