//! Transformation of dependent rows into independent ones.

/// Columns at the output of the filter.
pub(super) struct Whitened {
    /// Columns, each with one row fewer.
    pub(super) columns: Vec<Vec<f64>>,
    /// Logarithm of the determinant of the covariance, relative to that of the white noise.
    pub(super) determinant: f64,
}

/// Removes from each column the prediction by the preceding rows, for white noise of variance 1 on
/// top of a random walk of this variance per row.
///
/// ```text
/// P_1 = 1,  a_1 = y_1:    F = P + r + 1,  v = y - a,  K = (P + r)/F,  a + K v -> a,  (P + r)/F -> P        v/sqrt(F)
/// ```
///
/// Kalman filter of the local level with an unknown first level: Harvey (1989), section 3.
pub(super) fn whitened(columns: &[Vec<f64>], ratio: f64) -> Whitened {
    let rows = columns.first().map_or(0, Vec::len);
    let mut gains = Vec::with_capacity(rows);
    let (mut variance, mut determinant) = (1.0, 0.0);
    for _ in 1..rows {
        let predicted = variance + ratio;
        let innovation: f64 = predicted + 1.0;
        variance = predicted / innovation;
        determinant += phea_dynamics::portable::ln(innovation);
        gains.push([variance, 1.0 / innovation.sqrt()]);
    }
    let of = |column: &Vec<f64>| {
        let mut level = column.first().copied().unwrap_or(0.0);
        let later = column.iter().skip(1).zip(&gains);
        later
            .map(|(value, [gain, weight])| {
                let new = value - level;
                level += gain * new;
                weight * new
            })
            .collect()
    };
    Whitened { columns: columns.iter().map(of).collect(), determinant }
}
