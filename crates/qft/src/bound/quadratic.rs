//! Gains at which a quadratic is negative.

/// Empty interval of gains.
const NONE: [f64; 2] = [0.0, 0.0];

/// The positive gains g at which a quadratic is negative, as up to two open intervals; an interval
/// without width is dropped.
///
/// ```text
/// a g^2 + 2 b g + c < 0,      discriminant = b^2 - a c
/// ```
///
/// `discriminant` is computed by the caller from the geometry, free of cancellation; it is needed
/// only where a and c have the same sign, since otherwise b^2 - a c is a sum. The roots are
/// (sqrt(D) - b)/a and c/(sqrt(D) - b), or their mirror images, using the form that adds
/// magnitudes: a may pass through zero (a limit of exactly 1), where a root goes to infinity.
pub(super) fn negative_gains(a: f64, b: f64, c: f64, discriminant: f64) -> [[f64; 2]; 2] {
    let discriminant = if a * c < 0.0 { b * b - a * c } else { discriminant };
    if discriminant.is_nan() || discriminant <= 0.0 {
        let everywhere = a <= 0.0 && c <= 0.0 && (a < 0.0 || c < 0.0);
        return [if everywhere { [0.0, f64::INFINITY] } else { NONE }, NONE];
    }
    let root = discriminant.sqrt();
    if b < 0.0 {
        let sum = root - b;
        let last = if a > 0.0 { sum / a } else { f64::INFINITY };
        return [[(c / sum).max(0.0), last], NONE];
    }
    let sum = -(root + b);
    let first = if c < 0.0 { [0.0, c / sum] } else { NONE };
    let second = if a < 0.0 { [sum / a, f64::INFINITY] } else { NONE };
    [first, second]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(a: f64, b: f64, c: f64, expected: &[[f64; 2]]) {
        let found = negative_gains(a, b, c, b * b - a * c);
        let found: Vec<[f64; 2]> = found.into_iter().filter(|[low, high]| low < high).collect();
        assert_eq!(found, expected, "{a} g^2 + 2 {b} g + {c}");
    }

    /// The polynomial (g - 1)(g - 2), its mirror images, and its limits as each coefficient in turn
    /// vanishes.
    #[test]
    fn every_sign_pattern_gives_the_gains_of_its_parabola() {
        let end = f64::INFINITY;
        check(1.0, -1.5, 2.0, &[[1.0, 2.0]]);
        check(1.0, 1.5, 2.0, &[]);
        check(-1.0, 1.5, -2.0, &[[0.0, 1.0], [2.0, end]]);
        check(-1.0, -1.5, -2.0, &[[0.0, end]]);
        check(1.0, -0.5, -2.0, &[[0.0, 2.0]]);
        check(1.0, 0.5, -2.0, &[[0.0, 1.0]]);
        check(-1.0, 0.5, 2.0, &[[2.0, end]]);
        check(-1.0, -0.5, 2.0, &[[1.0, end]]);
        check(0.0, -1.0, 4.0, &[[2.0, end]]);
        check(0.0, -1.0, -4.0, &[[0.0, end]]);
        check(0.0, 1.0, -4.0, &[[0.0, 2.0]]);
        check(0.0, 0.0, -4.0, &[[0.0, end]]);
        check(0.0, 1.0, 4.0, &[]);
        check(0.0, 0.0, 0.0, &[]);
        check(1.0, 0.0, 1.0, &[]);
        check(-1.0, 0.5, -1.0, &[[0.0, end]]);
    }

    /// The product of the roots is c/a, and the small root stays exact while the large one goes to
    /// infinity.
    #[test]
    fn a_root_leaves_for_infinity_without_disturbing_the_other() {
        for a in [1e-3, 1e-9, 1e-15, 1e-300] {
            let [[low, high], _] = negative_gains(a, -1.0, 1.0, 1.0 - a);
            assert!((low * high * a - 1.0).abs() < 4e-16 && (low - 0.5 - a / 8.0).abs() < a * a + 1e-16);
        }
        assert_eq!(negative_gains(0.0, -1.0, 1.0, 1.0)[0], [0.5, f64::INFINITY]);
        assert_eq!(negative_gains(-1e-15, -1.0, 1.0, 1.0)[0][1], f64::INFINITY);
    }
}
