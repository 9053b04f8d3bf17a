//! Fonts of polygons, as Radiance's text patterns use them.

/// Where a glyph's box begins and ends that has no vertex beyond.
const MIDDLE: i32 = 128;

/// The outline of a character in a square of 0 to 255.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Glyph {
    outline: Vec<[i32; 2]>,
    pub(super) left: i32,
    pub(super) right: i32,
    bottom: i32,
    top: i32,
}

impl Glyph {
    fn new(outline: Vec<[i32; 2]>) -> Self {
        let bound = |axis: usize, pick: fn(i32, i32) -> i32| outline.iter().map(|at| at[axis]).fold(MIDDLE, pick);
        Self {
            left: bound(0, i32::min),
            right: bound(0, i32::max),
            bottom: bound(1, i32::min),
            top: bound(1, i32::max),
            outline,
        }
    }

    /// Whether nothing is drawn: a space.
    pub(super) fn is_blank(&self) -> bool {
        self.outline.is_empty()
    }

    /// Whether a point of the square lies within, by the even-odd rule.
    pub(super) fn covers(&self, x: f64, y: f64) -> bool {
        let (column, row) = (x as i32, y as i32);
        if self.left > column || self.right <= column || self.bottom > row || self.top <= row {
            return false;
        }
        let Some(mut from) = self.outline.last() else { return false };
        let mut inside = false;
        for to in &self.outline {
            // Vertices lie at whole numbers: a unit square's middle is never level with one.
            if (from[1] > row) != (to[1] > row) {
                let right = [from[0] > column, to[0] > column];
                inside ^= if right[0] == right[1] {
                    right[0]
                } else {
                    let [x0, y0, x1, y1] = [from[0], from[1], to[0], to[1]].map(f64::from);
                    (y1 > y0) != ((y0 - y) * (x1 - x) > (x0 - x) * (y1 - y))
                };
            }
            from = to;
        }
        inside
    }
}

/// A font.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Font {
    glyphs: Vec<Option<Glyph>>,
    pub(super) mean_width: i32,
}

impl Font {
    /// Bytes that its outlines take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.glyphs.iter().flatten().map(|glyph| size_of_val(&glyph.outline[..])).sum()
    }

    /// Reads a font file: for each character its code, the number of vertices of its outline, and their coordinates; `#`
    /// starts a comment.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut words = text.lines().flat_map(|line| line.split('#').next().unwrap_or_default().split_whitespace());
        let mut glyphs: Vec<Option<Glyph>> = vec![None; 256];
        let (mut width, mut drawn) = (0, 0);
        let whole = |word: &str, least: i32, most: i32, what: &str| {
            let number = word.parse::<i32>().ok().filter(|number| (least..=most).contains(number));
            number.ok_or_else(|| format!("`{word}` is not {what}, a whole number from {least} to {most}"))
        };
        while let Some(word) = words.next() {
            let code = whole(word, 1, 255, "the code of a character")?;
            let mut next = |most: i32, what: &str| {
                let word = words.next().ok_or_else(|| format!("the file ends within character {code}"))?;
                whole(word, 0, most, what)
            };
            let count = next(32_000, "the number of vertices")?;
            let outline = (0..count)
                .map(|_| Ok([next(255, "a coordinate")?, next(255, "a coordinate")?]))
                .collect::<Result<Vec<_>, String>>()?;
            let glyph = Glyph::new(outline);
            if glyph.right > glyph.left && glyph.top > glyph.bottom {
                drawn += 1;
                width += glyph.right - glyph.left;
            }
            if glyphs[code as usize].replace(glyph).is_some() {
                return Err(format!("character {code} is there twice"));
            }
        }
        Ok(Self { glyphs, mean_width: if drawn == 0 { 0 } else { width / drawn } })
    }

    pub(super) fn glyph(&self, code: u8) -> Option<&Glyph> {
        self.glyphs[usize::from(code)].as_ref()
    }
}
