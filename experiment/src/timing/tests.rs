use proptest::prelude::*;

use super::*;

#[test]
fn an_undisturbed_interval_has_no_missed_frame() {
    let frame = 1.0 / 60.0;
    let mut watch = FrameWatch::new(10.0);
    for i in 1..360 {
        watch.frame(10.0 + f64::from(i) * frame, frame);
    }
    let seen = watch.end(16.0, frame);
    assert_eq!((seen.missed, seen.drawn), (0, 360));
    assert!((seen.duration_s.unwrap() - 6.0).abs() < 1e-9);
    assert!((seen.longest_ms - 1000.0 / 60.0).abs() < 1e-6);
}

#[test]
fn a_stall_is_counted_in_frames() {
    let mut watch = FrameWatch::new(0.0);
    watch.frame(0.010, 0.010);
    watch.frame(0.060, 0.010); // four frames are missing in 50 ms
    watch.frame(0.070, 0.010);
    let seen = watch.end(0.086, 0.010); // one frame is missing in 16 ms
    assert_eq!(seen.missed, 5);
    assert!((seen.longest_ms - 50.0).abs() < 1e-9);
}

#[test]
fn a_night_asleep_does_not_overflow() {
    let mut watch = FrameWatch::new(0.0);
    watch.frame(1e12, 0.001);
    watch.frame(2e12, 0.001);
    assert_eq!(watch.so_far().missed, u32::MAX);
}

#[test]
fn on_a_display_a_frame_is_seen_at_the_next_refresh() {
    let mut pacer = Pacer::new(Pace::Display(0.016));
    pacer.drawn(0.99, 1.0);
    let plan = pacer.plan(1.001, Some(2.0));
    assert_eq!(plan.start_s, 1.001);
    assert!((plan.shows_s - 1.016).abs() < 1e-12);
}

/// Draws frames of the given costs until the deadline's frame was seen; returns when that was, and how many were missed.
fn run(pacer: &mut Pacer, costs: &[f64], due_s: f64) -> (f64, u32) {
    let mut now = 0.0;
    let mut watch = FrameWatch::new(0.0);
    pacer.drawn(-costs[0], 0.0);
    for cost in costs.iter().cycle() {
        let plan = pacer.plan(now, Some(due_s));
        let start = plan.start_s.max(now);
        let swap = start + cost;
        pacer.drawn(start, swap);
        now = swap;
        if plan.shows_s + plan.frame_s / 2.0 >= due_s {
            return (swap, watch.end(swap, plan.frame_s).missed);
        }
        watch.frame(swap, plan.frame_s);
    }
    unreachable!("the loop above has no end but its return")
}

proptest! {
    /// Whatever a frame costs, the last one is seen when it is due, and none before it counts as missed.
    #[test]
    fn steady_frames_meet_the_deadline_and_are_never_flagged(cost in 0.0005_f64..0.08, due in 0.3_f64..7.0) {
        let mut pacer = Pacer::new(Pace::Clock(1.0 / 60.0));
        let (seen, missed) = run(&mut pacer, &[cost], due);
        prop_assert!((seen - due).abs() < 1e-9, "seen {seen}, due {due}");
        prop_assert_eq!(missed, 0);
    }

    /// Frames whose cost varies by a fifth miss the deadline by no more than that variation.
    #[test]
    fn uneven_frames_miss_the_deadline_by_their_own_spread(cost in 0.001_f64..0.05, spread in prop::collection::vec(0.9_f64..1.1, 40)) {
        let costs: Vec<f64> = spread.iter().map(|s| s * cost).collect();
        let (seen, _) = run(&mut Pacer::new(Pace::Clock(1.0 / 60.0)), &costs, 6.0);
        prop_assert!((seen - 6.0).abs() <= 0.22 * cost + 1e-9, "{}", seen - 6.0);
    }
}
