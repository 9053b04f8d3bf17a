//! How far durations missed their plan.

use super::Figure;
use super::canvas::{Anchor, Canvas, Frame, WIDE};
use crate::report::numbers::short;
use crate::timing::{BIN_MS, Timing};

const HEIGHT: f64 = 240.0;

/// The histogram of durations less planned duration; none without a planned duration or pictures.
#[must_use]
pub fn timing(timing: &Timing) -> Option<Figure> {
    let most = timing.error_bins.iter().copied().max().filter(|most| *most > 0)?;
    let side = (timing.error_bins.len() / 2) as f64 * BIN_MS;
    let mut canvas = Canvas::new(WIDE, HEIGHT);
    let titles = ["duration less planned duration, ms", "pictures"];
    let frame = Frame::draw(&mut canvas, [-side, side], [0.0, 1.05 * most as f64], titles, [false, false]);
    let floor = frame.y.at(0.0);
    for (i, count) in timing.error_bins.iter().enumerate().filter(|(_, count)| **count > 0) {
        let middle = i as f64 * BIN_MS - side;
        let (left, right) = (frame.x.at(middle - 0.5 * BIN_MS), frame.x.at(middle + 0.5 * BIN_MS));
        let top = frame.y.at(*count as f64);
        canvas.rect("bar", [left, top], [(right - left - 1.0).max(1.5), floor - top]);
    }
    let beyond = timing.error_bins.first().unwrap_or(&0) + timing.error_bins.last().unwrap_or(&0);
    if beyond > 0 {
        canvas.text("tick", [frame.x.at(side), 22.0], Anchor::End, &format!("{beyond} at the ends or beyond"));
    }
    let worst = timing.worst_error_ms.map(short).unwrap_or_default();
    Some(Figure {
        svg: canvas.finish(),
        caption: format!(
            "Durations of {} pictures against the plan; the outermost bars hold all beyond.",
            timing.pictures
        ),
        description: format!(
            "{} pictures; the farthest from the planned duration missed it by {worst} ms.",
            timing.pictures
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timing::Gathering;
    use crate::trial_log::Trial;

    #[test]
    fn nothing_is_drawn_of_nothing() {
        assert_eq!(timing(&Gathering::new(Some(6.0)).finish()), None);
        assert_eq!(timing(&Gathering::new(None).finish()), None);
        let mut gathering = Gathering::new(Some(6.0));
        gathering.add(&Trial { first_duration_s: Some(6.1), second_duration_s: Some(6.0), ..Trial::default() });
        let figure = timing(&gathering.finish()).unwrap();
        assert!(figure.svg.contains("1 at the ends or beyond"));
        assert_eq!(figure.description, "2 pictures; the farthest from the planned duration missed it by 100 ms.");
    }
}
