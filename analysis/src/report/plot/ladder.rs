//! The psychometric function over the time spent on a picture.

use super::Figure;
use super::canvas::{Anchor, Canvas, Frame, WIDE, log_ticks};
use crate::interval::clopper_pearson;
use crate::report::ladder::Ladder;
use crate::report::numbers::{percent, short};

/// The steps with their Clopper-Pearson intervals and the fitted cumulative Gaussian; none without a fit.
#[must_use]
pub fn ladder(ladder: &Ladder, level: f64) -> Option<Figure> {
    let fit = ladder.fits.first()?;
    let place = |seconds: f64| seconds.log10();
    let (first, last) = (place(ladder.steps.first()?.seconds), place(ladder.steps.last()?.seconds));
    let margin = 0.08 * (last - first);
    let mut canvas = Canvas::new(WIDE, 340.0);
    let titles = ["seconds spent on a picture", "told the lower quality"];
    let range = [first - margin, last + margin];
    let frame = Frame::with_ticks(&mut canvas, [range, [0.0, 1.0]], titles, log_ticks(range), true);
    canvas.line("half", frame.point(first - margin, 0.5), frame.point(last + margin, 0.5));
    let [low, high] = fit.threshold_interval.map(|x| frame.x.at(-x));
    canvas.rect("band", [high.min(low), 28.0], [(high - low).abs(), frame.y.at(0.0) - 28.0]);
    let curve: Vec<[f64; 2]> = (0..=120)
        .map(|i| {
            let x = first - margin + (last - first + 2.0 * margin) * f64::from(i) / 120.0;
            frame.point(x, fit.curve.at(-x))
        })
        .collect();
    canvas.path("curve", &curve, false);
    let mut said = Vec::new();
    for step in &ladder.steps {
        let share = step.counts.value()?;
        let x = place(step.seconds);
        let [low, high] = clopper_pearson(step.counts, level);
        canvas.line("mark", frame.point(x, low), frame.point(x, high));
        canvas.dot("mark", frame.point(x, share), 5.0);
        let [at, y] = frame.point(x, low);
        canvas.text("tick", [at, y + 16.0], Anchor::Middle, &step.quality);
        said.push(format!("{} at {} s: {}", step.quality, short(step.seconds), percent(share)));
    }
    Some(Figure {
        svg: canvas.finish(),
        caption: "Right answers against the time on a picture, with the fitted cumulative Gaussian; the band is the \
                  threshold's interval."
            .to_owned(),
        description: said.join("; ") + ".",
    })
}
