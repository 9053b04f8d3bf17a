//! Curves: the posterior, and power.

use super::Figure;
use super::canvas::{Anchor, Canvas, Frame, NARROW, WIDE};
use crate::bayes::posterior_density;
use crate::binomial;
use crate::plan::Bound;
use crate::power::Question;
use crate::proportion::Proportion;
use crate::report::numbers::percent;

const HEIGHT: f64 = 280.0;

/// The posterior of the proportion under the uniform prior, the planned bound as a band.
#[must_use]
pub fn posterior(arm: &str, counts: Proportion, bound: Option<f64>) -> Figure {
    let (k, n) = counts.as_f64();
    let (a, b) = (k + 1.0, n - k + 1.0);
    let mean = a / (a + b);
    let sd = (a * b / ((a + b).powi(2) * (a + b + 1.0))).sqrt();
    // The whole range while the curve is wide enough to be seen there.
    let range = if sd > 0.02 { [0.0, 1.0] } else { [(mean - 8.0 * sd).max(0.0), (mean + 8.0 * sd).min(1.0)] };
    let steps = 240;
    let at = |i: i32| range[0] + (range[1] - range[0]) * (f64::from(i) + 0.5) / f64::from(steps);
    let densities: Vec<[f64; 2]> = (0..steps).map(|i| [at(i), posterior_density(counts, at(i))]).collect();
    let most = densities.iter().map(|[_, density]| *density).fold(0.0, f64::max);
    let mut canvas = Canvas::new(NARROW, HEIGHT);
    let titles = ["probability of telling the lower quality", "posterior density"];
    let frame = Frame::draw(&mut canvas, range, [0.0, 1.08 * most], titles, [true, false]);
    let floor = frame.y.at(0.0);
    if let Some(bound) = bound {
        let (left, right) = (frame.x.at(0.5 - bound), frame.x.at(0.5 + bound));
        canvas.rect("band", [left, 28.0], [right - left, floor - 28.0]);
    }
    let mut area: Vec<[f64; 2]> = densities.iter().map(|[x, y]| frame.point(*x, *y)).collect();
    canvas.path("curve", &area, false);
    area.push([frame.x.at(at(steps - 1)), floor]);
    area.insert(0, [frame.x.at(at(0)), floor]);
    canvas.path("area", &area, true);
    if range[0] < 0.5 && 0.5 < range[1] {
        canvas.line("half", [frame.x.at(0.5), 28.0], [frame.x.at(0.5), floor]);
    }
    let band = if bound.is_some() { "; the band is the planned bound" } else { "" };
    Figure {
        svg: canvas.finish(),
        caption: format!("{arm}: what {counts} leaves believable, from a uniform prior{band}."),
        description: format!(
            "Posterior density of the probability of telling the lower quality after {counts}: mean {}, standard deviation \
             {}.",
            percent(mean),
            percent(sd)
        ),
    }
}

/// Exact power of the exact test against the true probability, for `n` people; with a bound, the equivalence test's too.
#[must_use]
pub fn power_by_truth(n: u64, bound: Option<Bound>, alpha: f64) -> Figure {
    let mut canvas = Canvas::new(NARROW, HEIGHT);
    let titles = ["true probability of telling the lower quality", "power"];
    let frame = Frame::draw(&mut canvas, [0.5, 1.0], [0.0, 1.0], titles, [true, true]);
    let steps = 100;
    let truth = |i: i32| (0.5 + 0.5 * f64::from(i) / f64::from(steps)).min(1.0 - 1e-9);
    let curve = |power: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        (0..=steps).map(|i| frame.point(truth(i), power(truth(i)))).collect()
    };
    canvas.line("target", frame.point(0.5, 0.8), frame.point(1.0, 0.8));
    let superiority = |truth: f64| Question::Superiority { truth }.power(n, alpha);
    canvas.path("curve", &curve(&superiority), false);
    let mut caption = format!("What {n} people find: power of the exact test");
    let mut description = format!(
        "Exact power with {n} people: {} at 60 %, {} at 75 %, {} at 90 %",
        percent(superiority(0.6)),
        percent(superiority(0.75)),
        percent(superiority(0.9))
    );
    if let Some(bound) = bound {
        let equivalence = |truth: f64| Question::Equivalence { truth, bound: bound.proportion }.power(n, alpha);
        canvas.path("curve second", &curve(&equivalence), false);
        caption += " (solid) and of the equivalence test at the planned bound (dashed)";
        description += &format!("; the equivalence test passes with {} at 50 %", percent(equivalence(0.5)));
    }
    Figure { svg: canvas.finish(), caption: caption + ". The thin line is 80 %.", description: description + "." }
}

/// Exact power at a true probability of .75 against the number of people: the saw-tooth. `needed` is where 90 % is
/// reached for good.
#[must_use]
pub fn power_by_people(n: u64, needed: Option<u64>, alpha: f64) -> Figure {
    let most = n.max(needed.unwrap_or(0)).max(20);
    let most = (most + most / 4).min(2_000);
    let mut canvas = Canvas::new(NARROW, HEIGHT);
    let titles = ["people", "power where the truth is 75 %"];
    let frame = Frame::draw(&mut canvas, [0.0, most as f64], [0.0, 1.0], titles, [false, true]);
    let power = |n: u64| binomial::power(n, 0.75, alpha);
    let step = (most / 400).max(1);
    let points: Vec<[f64; 2]> = (1..=most).step_by(step as usize).map(|n| frame.point(n as f64, power(n))).collect();
    canvas.line("target", frame.point(0.0, 0.9), frame.point(most as f64, 0.9));
    canvas.path("curve", &points, false);
    if n <= most {
        canvas.dot("mark", frame.point(n as f64, power(n)), 5.5);
        let side = if n * 4 > most * 3 { Anchor::End } else { Anchor::Start };
        let [x, y] = frame.point(n as f64, power(n));
        let shift = if n * 4 > most * 3 { -10.0 } else { 10.0 };
        canvas.text("label strong", [x + shift, y + 16.0], side, &format!("{n} people: {}", percent(power(n))));
    }
    if let Some(needed) = needed.filter(|needed| *needed <= most) {
        let x = frame.x.at(needed as f64);
        canvas.line("half", [x, frame.y.at(0.0)], [x, frame.y.at(0.9)]);
        canvas.text("label", [x + 6.0, frame.y.at(0.0) - 8.0], Anchor::Start, &format!("{needed} for 90 %"));
    }
    let needed = needed.map(|needed| format!("; 90 % is held from {needed} people on")).unwrap_or_default();
    Figure {
        svg: canvas.finish(),
        caption:
            "Exact power is a saw-tooth: plan with the number from which it stays above the target (thin line, 90 %)."
                .to_owned(),
        description: format!("Power with {n} people where the truth is 75 %: {}{needed}.", percent(power(n))),
    }
}

/// A curve of exact power by number of people, with lines at the powers aimed at.
#[must_use]
pub fn power_curve(curve: &[(u64, f64)], targets: &[f64]) -> Figure {
    let most = curve.last().map_or(1, |(n, _)| *n);
    let mut canvas = Canvas::new(WIDE, 340.0);
    let frame = Frame::draw(&mut canvas, [0.0, most as f64], [0.0, 1.0], ["people in an arm", "power"], [false, true]);
    for target in targets {
        canvas.line("target", frame.point(0.0, *target), frame.point(most as f64, *target));
    }
    let points: Vec<[f64; 2]> = curve.iter().map(|(n, power)| frame.point(*n as f64, *power)).collect();
    canvas.path("curve", &points, false);
    let ends = curve.last().map(|(n, power)| format!("{} at {n} people", percent(*power))).unwrap_or_default();
    Figure {
        svg: canvas.finish(),
        caption: "Exact power is a saw-tooth: plan with the number from which it stays above the target.".to_owned(),
        description: format!("Power by number of people in an arm, up to {ends}."),
    }
}
