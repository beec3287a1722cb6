//! The minimum of a function of one variable.

/// Part of an interval that each step leaves, (sqrt(5) - 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The minimum of a function that falls and then rises between two ends, by the golden section. The
/// error is at most half of the ends' distance times 0.618 to the power of the steps.
pub(crate) fn least_between([mut low, mut high]: [f64; 2], steps: usize, of: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..steps {
        let [left, right] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        if of(left) < of(right) { high = right } else { low = left }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::least_between;

    /// The vertex of a parabola within the ends, and the end nearer to one beyond them.
    #[test]
    fn the_least_is_the_vertex_or_an_end() {
        for (vertex, least) in [(0.3, 0.3), (-2.0, -1.0), (5.0, 4.0)] {
            let found = least_between([-1.0, 4.0], 30, |x| (x - vertex) * (x - vertex));
            // half of 5 times 0.618 to the power of 30, and as much again
            assert!((found - least).abs() < 2.7e-6, "{vertex}: {found}");
        }
    }
}
