/// Root of a falling function, sought outwards from a first bracket; `None` if it never changes
/// sign or is NaN.
pub(super) fn falling_root(function: impl Fn(f64) -> f64, lower: f64, upper: f64) -> Option<f64> {
    let width = upper - lower;
    let (mut lower, mut upper) = (lower, upper);
    let mut step = width;
    for _ in 0..200 {
        let (at_lower, at_upper) = (function(lower), function(upper));
        if at_lower.is_nan() || at_upper.is_nan() {
            return None;
        }
        match (at_lower >= 0.0, at_upper <= 0.0) {
            (true, true) => return falling_root_within(&function, lower, upper),
            (false, _) => lower -= step,
            (true, false) => upper += step,
        }
        step *= 2.0;
    }
    None
}

/// Root of a falling function between two points at which it is non-negative and non-positive, to
/// the last bit.
pub(super) fn falling_root_within(
    function: impl Fn(f64) -> f64,
    mut lower: f64,
    mut upper: f64,
) -> Option<f64> {
    if function(lower) == 0.0 {
        return Some(lower);
    }
    if function(upper) == 0.0 {
        return Some(upper);
    }
    // halving any interval of finite numbers ends within some two thousand steps, at neighbouring
    // numbers
    loop {
        let middle = 0.5 * (lower + upper);
        let value = function(middle);
        if value.is_nan() {
            return None;
        }
        if value == 0.0 || middle <= lower || middle >= upper {
            return Some(middle);
        }
        if value > 0.0 {
            lower = middle;
        } else {
            upper = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_roots_inside_outside_and_none() {
        let line = |root: f64| move |x: f64| root - x;
        assert_eq!(falling_root(line(0.3), 0.0, 1.0), Some(0.3));
        assert_eq!(falling_root(line(-1e6), 0.0, 1.0), Some(-1e6));
        assert_eq!(falling_root(line(1e9), 0.0, 1.0), Some(1e9));
        assert_eq!(falling_root(|_| 1.0, 0.0, 1.0), None);
        assert_eq!(falling_root(|_| f64::NAN, 0.0, 1.0), None);
        assert_eq!(falling_root_within(line(0.0), -1.0, 1.0), Some(0.0));
    }
}
