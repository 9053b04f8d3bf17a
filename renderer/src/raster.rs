//! A rectangle of values, row 0 at the top.

/// `width` x `height` values in rows, the top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T> {
    width: usize,
    height: usize,
    values: Vec<T>,
}

impl<T: Clone> Raster<T> {
    /// A raster with the same value everywhere.
    #[must_use]
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, values: vec![value; width * height] }
    }
}

impl<T> Raster<T> {
    /// A raster of `values` in rows from the top; `None` if their number is not `width` x `height`.
    #[must_use]
    pub fn from_values(width: usize, height: usize, values: Vec<T>) -> Option<Self> {
        (values.len() == width.checked_mul(height)?).then_some(Self { width, height, values })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All values, row by row from the top.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The value at column `x`, row `y` from the top. Panics outside the raster.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> &T {
        assert!(x < self.width, "column {x} of {}", self.width);
        &self.values[y * self.width + x]
    }

    /// The value at column `x`, row `y` from the top, to change. Panics outside the raster.
    pub fn at_mut(&mut self, x: usize, y: usize) -> &mut T {
        assert!(x < self.width, "column {x} of {}", self.width);
        &mut self.values[y * self.width + x]
    }
}
