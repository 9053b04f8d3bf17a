//! Ordinary least squares with a constant, by the normal equations, and its test on groups left out.

/// Solves min |y - a - X b|. `rows` hold the predictors. Returns a, then b; `None` if the equations are singular.
pub(crate) fn fit(rows: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
    let columns = rows.first()?.len() + 1;
    let with_constant = |row: &Vec<f64>| -> Vec<f64> { std::iter::once(1.0).chain(row.iter().copied()).collect() };
    let mut matrix = vec![vec![0.0; columns + 1]; columns];
    for (row, y) in rows.iter().zip(y) {
        let row = with_constant(row);
        for i in 0..columns {
            for j in 0..columns {
                matrix[i][j] += row[i] * row[j];
            }
            matrix[i][columns] += row[i] * y;
        }
    }
    // Gauss-Jordan elimination with partial pivoting.
    for column in 0..columns {
        let pivot = (column..columns).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))?;
        matrix.swap(column, pivot);
        let scale = matrix[column][column];
        if scale.abs() < 1e-12 * rows.len() as f64 {
            return None;
        }
        matrix[column].iter_mut().for_each(|value| *value /= scale);
        let pivot_row = matrix[column].clone();
        for (other, row) in matrix.iter_mut().enumerate() {
            if other != column {
                let factor = row[column];
                row.iter_mut().zip(&pivot_row).for_each(|(value, pivot)| *value -= factor * pivot);
            }
        }
    }
    Some(matrix.iter().map(|row| row[columns]).collect())
}

/// a + b x.
pub(crate) fn apply(coefficients: &[f64], row: &[f64]) -> f64 {
    coefficients[0] + coefficients[1..].iter().zip(row).map(|(b, x)| b * x).sum::<f64>()
}

/// For every row the prediction of a fit in which its group had no part; `None` if a fit is singular.
pub(crate) fn left_out(rows: &[Vec<f64>], y: &[f64], groups: &[String]) -> Option<Vec<f64>> {
    let mut predicted = vec![0.0; y.len()];
    let mut names = groups.to_vec();
    names.sort();
    names.dedup();
    for name in names {
        let others: Vec<usize> = (0..y.len()).filter(|&index| groups[index] != name).collect();
        let (x, known): (Vec<_>, Vec<_>) = others.iter().map(|&index| (rows[index].clone(), y[index])).unzip();
        let coefficients = fit(&x, &known)?;
        for index in (0..y.len()).filter(|&index| groups[index] == name) {
            predicted[index] = apply(&coefficients, &rows[index]);
        }
    }
    Some(predicted)
}

/// 1 - sum of squared errors / sum of squares about the mean.
pub(crate) fn r2(y: &[f64], predicted: &[f64]) -> f64 {
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let errors: f64 = y.iter().zip(predicted).map(|(y, p)| (y - p).powi(2)).sum();
    1.0 - errors / y.iter().map(|y| (y - mean).powi(2)).sum::<f64>()
}
