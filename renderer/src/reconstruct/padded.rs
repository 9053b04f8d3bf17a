//! Planes of single numbers with a margin, over which filters walk without asking where the picture ends.

use rayon::prelude::*;

/// `width` x `height` numbers and a margin of repeated edge values on all sides.
pub(super) struct Padded {
    margin: usize,
    /// Of a row, margins included.
    stride: usize,
    values: Vec<f32>,
}

impl Padded {
    /// The value of every pixel of a picture, by its number.
    pub(super) fn new(width: usize, height: usize, margin: usize, value: impl Fn(usize) -> f32 + Sync) -> Self {
        let (stride, rows) = (width + 2 * margin, height + 2 * margin);
        let inside = |at: usize, size: usize| at.saturating_sub(margin).min(size - 1);
        let mut values = vec![0.0; stride * rows];
        values.par_chunks_exact_mut(stride).enumerate().for_each(|(row, values)| {
            let start = inside(row, height) * width;
            values.iter_mut().enumerate().for_each(|(x, it)| *it = value(start + inside(x, width)));
        });
        Self { margin, stride, values }
    }

    /// `length` values from column `x` of row `y` on; both may lie in the margins.
    pub(super) fn row(&self, x: isize, y: isize, length: usize) -> &[f32] {
        let start = (y + self.margin as isize) * self.stride as isize + x + self.margin as isize;
        &self.values[start as usize..start as usize + length]
    }
}

/// Mean over squares of (2 `radius` + 1) pixels on a side, of values in rows of `width` + 2 `radius`; as many rows and
/// columns as are inside come out in `means`. `sums` is room to work in.
pub(super) fn box_means(values: &[f32], width: usize, radius: usize, sums: &mut Vec<f32>, means: &mut [f32]) {
    let (stride, side) = (width + 2 * radius, 2 * radius + 1);
    let rows = means.len() / width;
    let share = 1.0 / (side * side) as f32;
    sums.clear();
    sums.resize(stride, 0.0);
    for (row, means) in means.chunks_exact_mut(width).enumerate().take(rows) {
        sums.fill(0.0);
        for line in values[row * stride..(row + side) * stride].chunks_exact(stride) {
            sums.iter_mut().zip(line).for_each(|(sum, value)| *sum += value);
        }
        means.fill(0.0);
        for shift in 0..side {
            means.iter_mut().zip(&sums[shift..]).for_each(|(mean, sum)| *mean += sum);
        }
        means.iter_mut().for_each(|mean| *mean *= share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_repeat_the_edge_and_means_are_of_squares() {
        let plane = Padded::new(3, 2, 2, |pixel| pixel as f32);
        assert_eq!(plane.row(-2, -1, 7), [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]);
        assert_eq!(plane.row(1, 3, 2), [4.0, 5.0]);
        let mut means = [0.0; 3];
        let rows: Vec<f32> = (-1..2).flat_map(|y| plane.row(-1, y, 5).to_vec()).collect();
        box_means(&rows, 3, 1, &mut Vec::new(), &mut means);
        let by_hand = [4.0 / 3.0, 2.0, 8.0 / 3.0];
        means.iter().zip(by_hand).for_each(|(found, expected)| assert!((found - expected).abs() < 1e-6));
    }
}
