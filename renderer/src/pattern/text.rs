//! Text painted on a plane: `brighttext`, `colortext`, `mixtext` (Radiance reference manual).

use std::sync::Arc;

use glam::DVec3;

use super::Font;

/// Extent of a character's square in the font's units.
const SQUARE: i32 = 255;

/// How characters follow each other: the primitive's spacing argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spacing {
    /// None given: each takes a square.
    Uniform,
    /// Above 0: that much between characters, set so that columns of a table line up. Below 0: that much, no more. 0 is
    /// uniform, in the font's mean width.
    Given(f64),
}

/// Lines of text on a plane.
#[derive(Clone, Debug)]
pub struct Text {
    font: Arc<Font>,
    anchor: DVec3,
    /// Times a way from the anchor: how many characters to the right.
    right: DVec3,
    /// Times a way from the anchor: how many lines down.
    down: DVec3,
    /// The font's units to a character's step.
    pitch: f64,
    lines: Vec<Line>,
}

#[derive(Clone, Debug)]
struct Line {
    codes: Vec<u8>,
    /// The step to each character from the one before, and after the last.
    steps: Vec<i32>,
    width: i32,
}

impl Text {
    /// Text whose first line starts at `anchor`; `right` is the step from character to character, `down` from line to
    /// line. `None` if the two are parallel. What is no Latin-1 character is left out.
    #[must_use]
    pub fn new(font: Arc<Font>, [anchor, right, down]: [DVec3; 3], spacing: Spacing, lines: &[String]) -> Option<Self> {
        let across = down.cross(right);
        let to_right = across.cross(down);
        let to_down = right.cross(across);
        let (right_squared, down_squared) = (to_right.length_squared(), to_down.length_squared());
        if !(right_squared > 1e-24 && down_squared > 0.0) {
            return None;
        }
        let pitch = match spacing {
            Spacing::Uniform => f64::from(SQUARE),
            Spacing::Given(gap) => f64::from(font.mean_width) + f64::from(SQUARE) * gap.abs(),
        };
        let gap = match spacing {
            Spacing::Uniform => 0,
            Spacing::Given(gap) => (gap * f64::from(SQUARE)) as i32,
        };
        let lines = lines.iter().map(|line| Line::new(line, &font, gap)).collect();
        Some(Self {
            anchor,
            right: to_right * (down.length_squared() / right_squared),
            down: to_down * (right.length_squared() / down_squared),
            pitch,
            lines,
            font,
        })
    }

    /// Whether a point lies in a letter.
    #[must_use]
    pub fn covers(&self, point: DVec3) -> bool {
        let from_anchor = point - self.anchor;
        let x = from_anchor.dot(self.right) * self.pitch;
        let y = from_anchor.dot(self.down);
        // Also false for NaN.
        if !(x >= 0.0 && y >= 0.0) {
            return false;
        }
        let Some(line) = self.lines.get(y as usize) else { return false };
        if x >= f64::from(line.width) {
            return false;
        }
        let mut left = x;
        let height = (y.floor() + 1.0 - y) * f64::from(SQUARE);
        // Letters may reach beyond the start of the next.
        for (index, &step) in line.steps.iter().enumerate() {
            left -= f64::from(step);
            if left < 0.0 {
                return false;
            }
            let glyph = line.codes.get(index).and_then(|&code| self.font.glyph(code));
            if left < f64::from(SQUARE) && glyph.is_some_and(|glyph| glyph.covers(left, height)) {
                return true;
            }
        }
        false
    }
}

impl Line {
    fn new(text: &str, font: &Font, gap: i32) -> Self {
        let codes: Vec<u8> = text.chars().filter_map(|letter| u8::try_from(u32::from(letter)).ok()).collect();
        let (steps, width) = match gap {
            0 => uniform(&codes, font),
            1.. => proportional(&codes, font, gap),
            _ => squeezed(&codes, font, -gap),
        };
        Self { codes, steps, width }
    }
}

fn uniform(codes: &[u8], font: &Font) -> (Vec<i32>, i32) {
    let mut steps = vec![0];
    steps.extend(codes.iter().map(|&code| if font.glyph(code).is_some() { SQUARE } else { 0 }));
    let width = steps.iter().sum();
    (steps, width)
}

/// Characters as wide as they are, `gap` apart; blanks have the mean width.
fn squeezed(codes: &[u8], font: &Font, gap: i32) -> (Vec<i32>, i32) {
    let half = gap / 2;
    let mut steps = Vec::with_capacity(codes.len() + 1);
    let (mut width, mut before, mut begun) = (0, half, false);
    for &code in codes {
        match font.glyph(code) {
            Some(glyph) if glyph.is_blank() => {
                steps.push(before);
                before = font.mean_width;
                begun = true;
            }
            Some(glyph) => {
                steps.push(before + half - glyph.left);
                before = glyph.right + half;
                begun = true;
            }
            None if begun => {
                steps.push(before);
                before = 0;
            }
            None => steps.push(0),
        }
        width += steps.last().copied().unwrap_or_default();
    }
    steps.push(before + half);
    (steps, width + before + half)
}

/// As squeezed, then stretched so that each stretch of text between wide gaps takes the room of that many mean
/// characters.
fn proportional(codes: &[u8], font: &Font, gap: i32) -> (Vec<i32>, i32) {
    /// Blanks that make a wide gap, and one more.
    const WIDE: usize = 3;
    let (mut steps, _) = squeezed(codes, font, gap);
    let is_blank =
        |at: usize| codes.get(at).and_then(|&code| font.glyph(code)).is_some_and(super::font::Glyph::is_blank);
    let mut width = steps[0];
    // Step n + 1 follows character n.
    let mut first = 0;
    while first < codes.len() {
        let (mut characters, mut end) = (0_usize, first);
        while end < codes.len() {
            let start = end;
            end += 1;
            if font.glyph(codes[start]).is_some() {
                while end < codes.len() && is_blank(end) {
                    end += 1;
                }
                characters += end - start;
            }
            if end - start > WIDE {
                break;
            }
        }
        let room = characters as i32 * (font.mean_width + gap);
        width += room;
        let mut missing = room - steps[first + 1..=end].iter().sum::<i32>();
        let count = end - first;
        for (done, step) in steps[first + 1..=end].iter_mut().enumerate() {
            let share = missing / (count - done) as i32;
            *step += share;
            missing -= share;
        }
        first = end;
    }
    (steps, width)
}
