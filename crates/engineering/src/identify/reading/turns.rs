//! Corners of a command between two rows of its record.
//!
//! ```text
//! u_1 + r_1 (t - t_1) = u_2 + r_2 (t - t_2)
//! ```
//!
//! The rows before the turn are on one straight line and those after it on another: the command
//! turned at their intersection. The memory of the spool follows that path, which is longer than
//! that from row to row by up to one step.

/// Relative difference of two rates up to which three rows are on a straight line.
const STRAIGHT: f64 = 0.01;

/// Distance beyond both rows that counts as rounding, relative to the step between them and their
/// neighbours.
const ROUNDING: f64 = 1e-6;

/// Turning value of the command between the row before and each row; `None` if it did not turn
/// beyond both, or if the rows around do not show it. Without times, the rows are evenly spaced.
pub(super) fn turns(times: &[f64], command: &[f64]) -> Vec<Option<f64>> {
    let rows = times.iter().copied().chain((times.len()..command.len()).map(|row| row as f64));
    let points: Vec<(f64, f64)> = rows.zip(command.iter().copied()).collect();
    (0..command.len()).map(|row| turn_before(&points, row)).collect()
}

fn turn_before(points: &[(f64, f64)], row: usize) -> Option<f64> {
    let before = points.get(row.checked_sub(3)?..row)?;
    let after = points.get(row..row + 3)?;
    let (into, out) = (rate(before)?, rate(after)?);
    if into * out >= 0.0 {
        return None;
    }
    let ((time_1, value_1), (time_2, value_2)) = (*before.last()?, *after.first()?);
    let from_first = (value_2 - value_1 - out * (time_2 - time_1)) / (into - out);
    let turned = value_1 + into * from_first;
    let least = ROUNDING * (into * (time_2 - time_1)).abs();
    let is_beyond = |value: f64| into.signum() * (turned - value) > least;
    (is_beyond(value_1) && is_beyond(value_2)).then_some(turned)
}

/// Rate of three rows on a straight line.
fn rate(points: &[(f64, f64)]) -> Option<f64> {
    let [(t_0, u_0), (t_1, u_1), (t_2, u_2)] = *points else { return None };
    let [first, second] = [(u_1 - u_0) / (t_1 - t_0), (u_2 - u_1) / (t_2 - t_1)];
    let whole = (u_2 - u_0) / (t_2 - t_0);
    ((first - second).abs() <= STRAIGHT * whole.abs()).then_some(whole)
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable;
    use phea_dynamics::random::{stream, uniform};

    use super::turns;

    /// A triangle of 3 V in 240 s.
    fn triangle(time: f64) -> f64 {
        let part = (time / 240.0 + 0.75).fract();
        3.0 * (4.0 * (part - 0.5).abs() - 1.0)
    }

    /// Each turn of a triangle is found, with even rows and with uneven ones, and beyond a gap.
    #[test]
    fn a_triangle_turns_at_its_corners() {
        let mut state = stream(3, 0);
        let even = |row: usize| 0.37 * row as f64;
        let uneven: Vec<f64> = (0..1300).map(|row| even(row) + 0.2 * uniform(&mut state)).collect();
        let with_gap = (0..1300).filter(|row| !(155..170).contains(row)).map(even).collect();
        for times in [(0..1300).map(even).collect(), uneven, with_gap] {
            let times: Vec<f64> = times;
            let command: Vec<f64> = times.iter().map(|time| triangle(*time)).collect();
            let found: Vec<f64> = turns(&times, &command).into_iter().flatten().collect();
            assert_eq!(found.len(), 4, "{found:?}");
            for (found, corner) in found.iter().zip([3.0, -3.0, 3.0, -3.0]) {
                assert!((found - corner).abs() < 1e-9, "{found} {corner}");
            }
        }
    }

    /// Nothing is added if a row is at the corner, to a sine, or to a command that steps.
    #[test]
    fn nothing_is_added_elsewhere() {
        let times: Vec<f64> = (0..1200).map(|row| 0.4 * f64::from(row)).collect();
        let sine = |time: &f64| portable::sin(std::f64::consts::TAU * time / 240.0 + 0.001);
        let stairs = |time: &f64| (time / 10.0).floor() % 7.0;
        let corners: Vec<f64> = times.iter().map(|time| triangle(*time)).collect();
        for command in [corners, times.iter().map(sine).collect(), times.iter().map(stairs).collect()] {
            assert!(turns(&times, &command).iter().all(Option::is_none));
        }
    }
}
