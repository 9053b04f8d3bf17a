//! Proportions with their intervals, one below the other.

use super::Figure;
use super::canvas::{Anchor, Canvas, NARROW, Scale, WIDE};
use crate::proportion::Proportion;
use crate::report::numbers::{percent, percent_range};

/// One line of the plot.
#[derive(Clone, Debug)]
pub struct Row {
    /// What was counted.
    pub label: String,
    /// The counts.
    pub counts: Proportion,
    /// The interval drawn.
    pub interval: [f64; 2],
    /// Whether it is one of the main results.
    pub main: bool,
}

/// Proportions with their intervals about one half, the planned bound as a band. `narrow`: it stands beside another plot.
#[must_use]
pub fn intervals(rows: &[Row], bound: Option<f64>, level: f64, narrow: bool) -> Figure {
    let (width, left) = if narrow { (NARROW, 170.0) } else { (WIDE, 250.0) };
    let (row_height, top) = (40.0, 24.0);
    let bottom = top + row_height * rows.len() as f64;
    let mut canvas = Canvas::new(width, bottom + 46.0);
    let x = Scale { values: [0.0, 1.0], positions: [left, width - 96.0] };
    if let Some(bound) = bound {
        let (left, right) = (x.at(0.5 - bound), x.at(0.5 + bound));
        canvas.rect("band", [left, top - 8.0], [right - left, bottom - top + 8.0]);
        canvas.text("tick", [x.at(0.5), top - 12.0], Anchor::Middle, "planned bound");
    }
    for tick in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let at = x.at(tick);
        canvas.line(if tick == 0.5 { "half" } else { "grid" }, [at, top - 8.0], [at, bottom]);
        canvas.text("tick", [at, bottom + 18.0], Anchor::Middle, &format!("{} %", 100.0 * tick));
    }
    canvas.text("title", [x.at(0.5), bottom + 38.0], Anchor::Middle, "share of people");
    let mut said = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let y = top + row_height * (i as f64 + 0.5);
        let class = if row.main { "mark" } else { "mark soft" };
        let [low, high] = row.interval.map(|limit| x.at(limit));
        canvas.line(class, [low, y], [high, y]);
        canvas.line(class, [low, y - 6.0], [low, y + 6.0]);
        canvas.line(class, [high, y - 6.0], [high, y + 6.0]);
        let share = row.counts.value();
        if let Some(share) = share {
            canvas.dot(class, [x.at(share), y], 5.5);
        }
        canvas.text(if row.main { "label strong" } else { "label" }, [8.0, y + 4.0], Anchor::Start, &row.label);
        // Very large counts would not fit beside the drawing; the table has them.
        let counts = Some(row.counts.to_string()).filter(|text| text.len() <= 13);
        let counts = counts.or_else(|| share.map(percent)).unwrap_or_default();
        canvas.text("tick", [width - 80.0, y + 4.0], Anchor::Start, &counts);
        let share = share.map(percent).unwrap_or_default();
        said.push(format!("{}: {}, {share}, interval {}", row.label, row.counts, percent_range(row.interval)));
    }
    Figure {
        svg: canvas.finish(),
        caption: format!(
            "Shares with their {} % Clopper-Pearson intervals; the line at 50 % is guessing.",
            crate::report::numbers::short(100.0 * level)
        ),
        description: said.join(". ") + ".",
    }
}
