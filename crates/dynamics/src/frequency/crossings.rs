//! Sign changes of a function of frequency, and its minima, bracketed on a grid and refined by
//! bisection.

/// A function of frequency with its slope (only the slope's sign is used).
pub(super) struct SlopedFunction<V, S> {
    pub(super) value: V,
    pub(super) slope: S,
}

impl<V: Fn(f64) -> f64, S: Fn(f64) -> f64> SlopedFunction<V, S> {
    /// All frequencies at which the value changes sign or touches zero. Two crossings between
    /// neighbouring grid points are found by the extremum that must lie between them.
    pub(super) fn zeros(&self, grid: &[f64]) -> Vec<f64> {
        let mut found = Vec::new();
        for pair in grid.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let (at_low, at_high) = ((self.value)(low), (self.value)(high));
            if !(at_low.is_finite() && at_high.is_finite()) {
                continue;
            }
            if (at_low < 0.0) != (at_high < 0.0) {
                found.push(bisect(&self.value, low, high));
            } else if let Some(extremum) = self.extremum_towards_zero(low, high, at_low) {
                let there = (self.value)(extremum);
                if (there < 0.0) != (at_low < 0.0) {
                    found.push(bisect(&self.value, low, extremum));
                    found.push(bisect(&self.value, extremum, high));
                } else if there.abs() <= 1e-13 {
                    found.push(extremum);
                }
            }
        }
        found
    }

    fn extremum_towards_zero(&self, low: f64, high: f64, at_low: f64) -> Option<f64> {
        let sign = if at_low < 0.0 { -1.0 } else { 1.0 };
        let approaches = sign * (self.slope)(low) < 0.0 && sign * (self.slope)(high) > 0.0;
        approaches.then(|| bisect(&self.slope, low, high))
    }

    /// All interior local minima on the grid.
    pub(super) fn minima(&self, grid: &[f64]) -> Vec<f64> {
        let falls_then_rises = |pair: &&[f64]| (self.slope)(pair[0]) < 0.0 && (self.slope)(pair[1]) >= 0.0;
        grid.windows(2).filter(falls_then_rises).map(|pair| bisect(&self.slope, pair[0], pair[1])).collect()
    }
}

/// Point between two positive frequencies where the sign of a function changes, to the last bit.
pub(super) fn bisect(function: &impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let below = function(low) < 0.0;
    // halving in logarithm first, then in value
    while high > 2.0 * low && low > 0.0 {
        let middle = low.sqrt() * high.sqrt();
        if (function(middle) < 0.0) == below { low = middle } else { high = middle }
    }
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return middle;
        }
        if (function(middle) < 0.0) == below { low = middle } else { high = middle }
    }
}
