/// Where a function with one minimum between `low` and `high` has it, and its value there, by
/// golden section.
pub(super) fn minimum_between<F: FnMut(f64) -> f64>(low: f64, high: f64, mut function: F) -> (f64, f64) {
    const STEPS: usize = 60;
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (low, high);
    let (mut left, mut right) = (high - share * (high - low), low + share * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    for _ in 0..STEPS {
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - share * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + share * (high - low);
            at_right = function(right);
        }
    }
    if at_left <= at_right { (left, at_left) } else { (right, at_right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_and_a_kink_are_found() {
        let (at, value) = minimum_between(-1.0, 5.0, |x| (x - 2.0) * (x - 2.0) + 3.0);
        assert!((at - 2.0).abs() < 1e-7 && value == 3.0);
        let (at, _) = minimum_between(0.0, 1.0, |x: f64| (x - 0.3).abs());
        assert!((at - 0.3).abs() < 1e-12);
    }
}
