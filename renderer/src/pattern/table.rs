//! Tables of numbers over a grid, and pictures, which are tables of colours.
//!
//! Between the grid's points values are interpolated linearly in each dimension; beyond its ends they go on linearly for
//! one division and then fall harmonically to 0 (Radiance reference manual, "Data Files").

/// A dimension of a table.
#[derive(Clone, Debug, PartialEq)]
enum Axis {
    /// Points at equal distances.
    Even { first: f64, last: f64, count: usize },
    /// Points in ascending or descending order.
    Uneven(Vec<f64>),
}

impl Axis {
    fn count(&self) -> usize {
        match self {
            Self::Even { count, .. } => *count,
            Self::Uneven(points) => points.len(),
        }
    }

    /// The division that counts at `x`, and the weights of its two ends.
    fn weights(&self, x: f64) -> (usize, f64, f64) {
        let count = self.count();
        if count < 2 {
            return (0, 1.0, 0.0);
        }
        let last = count - 2;
        let (division, at) = match self {
            Self::Even { first, last: end, count } => {
                let at = (x - first) / (end - first) * (count - 1) as f64;
                (if at >= 1.0 { (at as usize).min(last) } else { 0 }, at)
            }
            Self::Uneven(points) => {
                let ascending = points[0] <= points[count - 1];
                let before = points.partition_point(|&point| if ascending { point <= x } else { point >= x });
                let division = before.saturating_sub(1).min(last);
                let width = points[division + 1] - points[division];
                (division, division as f64 + if width == 0.0 { 0.0 } else { (x - points[division]) / width })
            }
        };
        let start = division as f64;
        if at > start + 2.0 {
            let near = 1.0 / (start - 1.0 - at);
            (division, near, -2.0 * near)
        } else if at < start - 1.0 {
            let near = 1.0 / (at - start);
            (division, -2.0 * near, near)
        } else {
            (division, start + 1.0 - at, at - start)
        }
    }
}

/// Numbers (or colours) over a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    axes: Vec<Axis>,
    /// The last axis fastest; of a picture three to a point.
    values: Vec<f32>,
    channels: usize,
}

impl Table {
    /// Dimensions that Radiance's files have at most.
    pub const MOST_DIMENSIONS: usize = 5;

    /// Values of all tables at most: 1 GB.
    const MOST_VALUES: usize = 1 << 28;

    /// Reads a data file: the number of dimensions; for each the first and the last point and their number, or `0 0
    /// number` and all points; then the values, the last dimension fastest.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut words = text.lines().flat_map(|line| line.split('#').next().unwrap_or_default().split_whitespace());
        let mut number = |what: &str| -> Result<f64, String> {
            let word = words.next().ok_or_else(|| format!("the file ends where {what} should be"))?;
            let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| format!("`{word}` is no number, expected {what}"))
        };
        let dimensions = number("the number of dimensions")?;
        if !(1.0..=Self::MOST_DIMENSIONS as f64).contains(&dimensions) {
            return Err(format!("{dimensions} dimensions, expected 1 to {}", Self::MOST_DIMENSIONS));
        }
        let mut axes = Vec::new();
        let mut size = 1_usize;
        for _ in 0..dimensions as usize {
            let (first, last) = (number("where a dimension starts")?, number("where a dimension ends")?);
            let count = number("how many points a dimension has")?;
            if !(1.0..=Self::MOST_VALUES as f64).contains(&count) {
                return Err(format!("a dimension of {count} points, expected 1 or more"));
            }
            let count = count as usize;
            size = size.saturating_mul(count);
            if size > Self::MOST_VALUES {
                return Err(format!("more than {} values", Self::MOST_VALUES));
            }
            axes.push(if first == last {
                let points = (0..count).map(|_| number("a point of a dimension")).collect::<Result<Vec<_>, _>>()?;
                if !(points.is_sorted() || points.is_sorted_by(|a, b| a >= b)) {
                    return Err("the points of a dimension are not in order".to_owned());
                }
                Axis::Uneven(points)
            } else {
                Axis::Even { first, last, count }
            });
        }
        let values = (0..size).map(|_| number("a value").map(|value| value as f32)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { axes, values, channels: 1 })
    }

    /// A picture of `width` pixels a row as a table over v (up) and u (to the right); its shorter side spans 0 to 1. As
    /// Radiance 6.0 has it, the first and the last pixel of a row stand at its ends (later versions may put them half a pixel
    /// inward). `rows` come from the top. `None` if there is no pixel.
    #[must_use]
    pub fn of_picture(width: usize, rows: &[[f32; 3]]) -> Option<Self> {
        let height = rows.len().checked_div(width).filter(|&height| height > 0 && height * width == rows.len())?;
        let side = width.min(height) as f64;
        let axis = |count: usize| match count {
            1 => Axis::Uneven(vec![0.0]),
            _ => Axis::Even { first: 0.0, last: count as f64 / side, count },
        };
        let values = rows.chunks_exact(width).rev().flatten().flatten().copied().collect();
        Some(Self { axes: vec![axis(height), axis(width)], values, channels: 3 })
    }

    /// Bytes that its values take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }

    /// How many dimensions it has.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// Where the last dimension starts and ends, and how many points it has.
    #[must_use]
    pub fn last_axis(&self) -> (f64, f64, usize) {
        match self.axes.last() {
            Some(Axis::Even { first, last, count }) => (*first, *last, *count),
            Some(Axis::Uneven(points)) if !points.is_empty() => (points[0], points[points.len() - 1], points.len()),
            _ => (0.0, 0.0, 0),
        }
    }

    /// The value at a point, which has as many coordinates as the table dimensions; of a picture red, green and blue, of
    /// a table of numbers the number first.
    #[must_use]
    pub fn value(&self, point: &[f64]) -> [f64; 3] {
        self.interpolated(&self.axes, point, 0)
    }

    fn interpolated(&self, axes: &[Axis], point: &[f64], start: usize) -> [f64; 3] {
        let (Some((axis, inner)), Some((&x, rest))) = (axes.split_first(), point.split_first()) else {
            let mut value = [0.0; 3];
            let at = start * self.channels;
            for (value, &stored) in value.iter_mut().zip(&self.values[at..at + self.channels]) {
                *value = f64::from(stored);
            }
            return value;
        };
        let (division, near, far) = axis.weights(x);
        let index = start * axis.count() + division;
        let mut value = self.interpolated(inner, rest, index);
        value.iter_mut().for_each(|value| *value *= near);
        if far != 0.0 {
            let next = self.interpolated(inner, rest, index + 1);
            value.iter_mut().zip(next).for_each(|(value, next)| *value += far * next);
        }
        value
    }
}
