//! Recorded points of a surface, interpolated bilinearly (gensurf(1)).

/// A grid of numbers, s fastest.
pub(super) struct HeightData {
    values: Vec<f64>,
    /// Points in s and in t.
    points: [usize; 2],
    /// Numbers a point: 1, or 3 for x, y and z.
    width: usize,
    /// Whether the grid's outer points lie on the surface's border, or half a step inside.
    has_border: bool,
}

impl HeightData {
    /// For a surface of so many steps: a value for each of their ends, or for each of their middles.
    pub(super) fn new(values: Vec<f64>, rows: usize, columns: usize, width: usize) -> Result<Self, String> {
        let (ends, middles) = ((rows + 1) * (columns + 1) * width, rows * columns * width);
        let has_border = values.len() == ends;
        let points = if has_border { [rows + 1, columns + 1] } else { [rows, columns] };
        if !has_border && values.len() != middles || points.iter().any(|&count| count < 2) {
            return Err(format!("expected {ends} numbers (or {middles} without border), found {}", values.len()));
        }
        Ok(Self { values, points, width, has_border })
    }

    /// The interpolated value of one of a point's numbers.
    pub(super) fn at(&self, s: f64, t: f64, column: usize) -> f64 {
        let place = |coordinate: f64, count: usize| {
            let place = if self.has_border { coordinate * (count - 1) as f64 } else { coordinate * count as f64 - 0.5 };
            // Beyond the outer points the outer cells go on.
            let cell = (place.max(0.0) as usize).min(count - 2);
            (cell, place - cell as f64)
        };
        let ((i, u), (j, v)) = (place(s, self.points[0]), place(t, self.points[1]));
        let value = |di: usize, dj: usize| self.values[((j + dj) * self.points[0] + i + di) * self.width + column];
        (1.0 - v) * ((1.0 - u) * value(0, 0) + u * value(1, 0)) + v * ((1.0 - u) * value(0, 1) + u * value(1, 1))
    }
}
