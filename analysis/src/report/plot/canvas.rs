//! An SVG under construction, and linear axes.

use std::fmt::Write;

use crate::report::escape::escape;
use crate::report::numbers::short;

/// Width of a plot that stands alone, in its own units: about as many as the pixels it gets, so that type keeps its size.
pub(super) const WIDE: f64 = 720.0;

/// Width of a plot that stands beside another.
pub(super) const NARROW: f64 = 500.0;

/// An SVG element that grows. Looks come from classes.
pub(super) struct Canvas {
    body: String,
    size: [f64; 2],
}

/// Where a text hangs on its position.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Canvas {
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { body: String::new(), size: [width, height] }
    }

    pub(super) fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(round);
        let _ = write!(self.body, "<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>");
    }

    pub(super) fn rect(&mut self, class: &str, at: [f64; 2], size: [f64; 2]) {
        let [x, y, width, height] = [at[0], at[1], size[0].max(0.0), size[1].max(0.0)].map(round);
        let _ =
            write!(self.body, "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>");
    }

    pub(super) fn dot(&mut self, class: &str, at: [f64; 2], radius: f64) {
        let [x, y, r] = [at[0], at[1], radius].map(round);
        let _ = write!(self.body, "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"/>");
    }

    pub(super) fn path(&mut self, class: &str, points: &[[f64; 2]], closed: bool) {
        let mut d = String::new();
        for (at, [x, y]) in points.iter().enumerate() {
            let letter = if at == 0 { 'M' } else { 'L' };
            let _ = write!(d, "{letter}{} {}", round(*x), round(*y));
        }
        let end = if closed { "Z" } else { "" };
        let _ = write!(self.body, "<path class=\"{class}\" d=\"{d}{end}\"/>");
    }

    pub(super) fn text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let [x, y] = at.map(round);
        let text = escape(text);
        let _ = write!(self.body, "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>");
    }

    /// The whole element. It is hidden from assistive technology, which reads the figure's description instead.
    pub(super) fn finish(self) -> String {
        format!(
            "<svg viewBox=\"0 0 {} {}\" aria-hidden=\"true\" focusable=\"false\">{}</svg>",
            round(self.size[0]),
            round(self.size[1]),
            self.body
        )
    }
}

/// A hundredth of a unit is finer than any screen.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A linear map from values to positions.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    pub(super) values: [f64; 2],
    pub(super) positions: [f64; 2],
}

impl Scale {
    pub(super) fn at(&self, value: f64) -> f64 {
        let share = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.positions[0] + share.clamp(0.0, 1.0) * (self.positions[1] - self.positions[0])
    }

    /// About `wanted` round values within the scale.
    pub(super) fn ticks(&self, wanted: f64) -> Vec<f64> {
        let span = self.values[1] - self.values[0];
        let raw = span / wanted;
        let power = 10.0_f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 2.5, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= raw * 0.999);
        let step = step.unwrap_or(span);
        let first = (self.values[0] / step - 1e-9).ceil() as i64;
        let last = (self.values[1] / step + 1e-9).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }
}

/// Ticks for the logarithms to the base 10 of positive values: 1, 2 and 5 in every power of ten, only the ones where there
/// would be too many, labelled with the values.
pub(super) fn log_ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let factors: &[f64] = if high - low > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let powers = low.floor().max(-300.0) as i32..=high.ceil().min(300.0) as i32;
    let values = powers.flat_map(|power| factors.iter().map(move |factor| factor * 10.0_f64.powi(power)));
    let inside = values.map(|value| (value.log10(), short(value)));
    inside.filter(|(at, _)| (low..=high).contains(at)).collect()
}

/// A number on an axis: as many digits as its neighbours need to differ.
pub(super) fn tick_label(value: f64, ticks: &[f64], percent: bool) -> String {
    let factor = if percent { 100.0 } else { 1.0 };
    let step = ticks.windows(2).map(|pair| (pair[1] - pair[0]) * factor).fold(f64::INFINITY, f64::min);
    let digits = if step.is_finite() { (-step.log10().floor()).clamp(0.0, 9.0) as usize } else { 0 };
    let digits = if step.is_finite() && ((step * 10.0_f64.powi(digits as i32)).fract() - 0.5).abs() < 1e-6 {
        digits + 1
    } else {
        digits
    };
    let text = format!("{:.digits$}", value * factor);
    let text = if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    };
    if percent { format!("{text} %") } else { text }
}

/// A frame with both axes, ticks and titles: what the curves share.
pub(super) struct Frame {
    pub(super) x: Scale,
    pub(super) y: Scale,
}

impl Frame {
    /// Draws the frame that fills a canvas. `percent` says which axes are shares.
    pub(super) fn draw(canvas: &mut Canvas, x: [f64; 2], y: [f64; 2], titles: [&str; 2], percent: [bool; 2]) -> Self {
        let ticks = Scale { values: x, positions: x }.ticks(6.0);
        let labels = ticks.iter().map(|&tick| (tick, tick_label(tick, &ticks, percent[0]))).collect();
        Self::with_ticks(canvas, [x, y], titles, labels, percent[1])
    }

    /// The same with ticks of one's own along x: where, and what is written there.
    pub(super) fn with_ticks(
        canvas: &mut Canvas,
        [x, y]: [[f64; 2]; 2],
        titles: [&str; 2],
        x_ticks: Vec<(f64, String)>,
        percent: bool,
    ) -> Self {
        let [width, height] = canvas.size;
        let (left, right, top, bottom) = (60.0, width - 24.0, 28.0, height - 46.0);
        let frame =
            Self { x: Scale { values: x, positions: [left, right] }, y: Scale { values: y, positions: [bottom, top] } };
        let ticks = frame.y.ticks(5.0);
        for &tick in &ticks {
            let at = frame.y.at(tick);
            canvas.line("grid", [left, at], [right, at]);
            canvas.text("tick", [left - 8.0, at + 4.0], Anchor::End, &tick_label(tick, &ticks, percent));
        }
        for (tick, label) in x_ticks {
            let at = frame.x.at(tick);
            canvas.line("axis", [at, bottom], [at, bottom + 5.0]);
            canvas.text("tick", [at, bottom + 19.0], Anchor::Middle, &label);
        }
        canvas.line("axis", [left, bottom], [right, bottom]);
        canvas.text("title", [0.5 * (left + right), height - 6.0], Anchor::Middle, titles[0]);
        canvas.text("title", [8.0, 14.0], Anchor::Start, titles[1]);
        frame
    }

    pub(super) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks = |low, high| Scale { values: [low, high], positions: [0.0, 1.0] }.ticks(5.0);
        assert_eq!(ticks(0.0, 1.0), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(ticks(0.0, 100.0).len(), 6);
        assert!(ticks(0.499, 0.501).iter().all(|tick| (0.499..=0.501).contains(tick)));
    }

    #[test]
    fn labels_have_the_digits_that_they_need() {
        assert_eq!(tick_label(0.2, &[0.0, 0.2, 0.4], true), "20 %");
        assert_eq!(tick_label(0.2, &[0.0, 0.2, 0.4], false), "0.2");
        assert_eq!(tick_label(0.25, &[0.0, 0.25, 0.5], false), "0.25");
        assert_eq!(tick_label(-0.0, &[-1.0, 0.0, 1.0], false), "0");
    }

    #[test]
    fn logarithmic_ticks_are_labelled_with_their_values() {
        let labels = |range| -> Vec<String> { log_ticks(range).into_iter().map(|(_, label)| label).collect() };
        assert_eq!(labels([0.4, 2.1]), ["5", "10", "20", "50", "100"]);
        assert_eq!(labels([-1.5, 2.5]), ["0.1", "1", "10", "100"]);
        assert!((log_ticks([0.4, 2.1])[0].0 - 5.0_f64.log10()).abs() < 1e-15);
    }

    #[test]
    fn names_are_text() {
        let mut canvas = Canvas::new(10.0, 10.0);
        canvas.text("t", [0.0, 0.0], Anchor::Start, "<b>&");
        assert!(canvas.finish().contains("&lt;b&gt;&amp;</text>"));
    }
}
