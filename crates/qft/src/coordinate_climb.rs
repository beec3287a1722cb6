//! The largest value of a function over the unit box: a climb along its coordinates from one start.

/// The first step of a climb, as a fraction of the box.
pub(crate) const LONGEST_STEP: f64 = 0.25;
/// The smallest step of a climb, as a fraction of the box.
const SMALLEST_STEP: f64 = 1e-7;
/// The smallest step of a climb that ends in a corner, as a fraction of the box.
const SMALL_STEP: f64 = 1e-3;
/// Largest number of values that one climb may evaluate.
const VALUES_MAXIMUM: usize = 2000;

/// A function over the unit box and the best point known; NaN counts as the lowest value.
struct Climb<'a> {
    objective: &'a mut dyn FnMut(&[f64]) -> f64,
    fractions: Vec<f64>,
    value: f64,
    requested_values: usize,
}

/// Climbs to a local maximum: along one coordinate after the other, to the better of two neighbours
/// or to the top of the parabola over three values, with steps that shrink once they are longer
/// than the distance moved.
pub(crate) fn climb(start: &[f64], objective: &mut dyn FnMut(&[f64]) -> f64) -> (Vec<f64>, f64) {
    climb_by(LONGEST_STEP, start, objective)
}

/// Climbs as [`climb`] does, with another first step.
pub(crate) fn climb_by(
    first_step: f64,
    start: &[f64],
    objective: &mut dyn FnMut(&[f64]) -> f64,
) -> (Vec<f64>, f64) {
    let value = objective(start);
    let value = if value.is_nan() { f64::NEG_INFINITY } else { value };
    let mut climb = Climb { objective, fractions: start.to_vec(), value, requested_values: 1 };
    let mut step = first_step;
    while step >= SMALLEST_STEP && climb.requested_values < VALUES_MAXIMUM {
        let way = (0..start.len()).map(|coordinate| climb.along(coordinate, step)).fold(0.0, f64::max);
        let in_corner = climb.fractions.iter().all(|&fraction| fraction <= 0.0 || fraction >= 1.0);
        if way == 0.0 && in_corner && step < SMALL_STEP {
            break;
        }
        if way < 0.5 * step {
            step *= 0.25;
        }
    }
    (climb.fractions, climb.value)
}

impl Climb<'_> {
    /// Moves along one coordinate; returns the distance.
    fn along(&mut self, coordinate: usize, step: f64) -> f64 {
        let Some(&centre) = self.fractions.get(coordinate) else { return 0.0 };
        let here = self.value;
        let (low, high) = ((centre - step).max(0.0), (centre + step).min(1.0));
        let at_low = if low < centre { self.visit(coordinate, low) } else { f64::NEG_INFINITY };
        let at_high = if high > centre { self.visit(coordinate, high) } else { f64::NEG_INFINITY };
        if here >= at_low && here >= at_high {
            // Newton's form of the parabola through the three points
            let (left, right) = ((here - at_low) / (centre - low), (at_high - here) / (high - centre));
            let top = 0.5 * (low + centre) + 0.5 * (high - low) * left / (left - right);
            if top > low && top < high && top != centre {
                self.visit(coordinate, top);
            }
        }
        self.fractions.get(coordinate).map_or(0.0, |fraction| (fraction - centre).abs())
    }

    /// Evaluates the point with this fraction in one coordinate; retains it if it is the best.
    fn visit(&mut self, coordinate: usize, fraction: f64) -> f64 {
        let mut fractions = self.fractions.clone();
        if let Some(slot) = fractions.get_mut(coordinate) {
            *slot = fraction;
        }
        let value = (self.objective)(&fractions);
        self.requested_values += 1;
        if value > self.value {
            (self.fractions, self.value) = (fractions, value);
        }
        if value.is_nan() { f64::NEG_INFINITY } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::climb;

    /// A ridge with its top inside along one coordinate and on the border along the other.
    #[test]
    fn the_top_is_found_inside_and_at_the_border() {
        let mut requested = 0;
        let (fractions, value) = climb(&[0.9, 0.5], &mut |p| {
            requested += 1;
            let inside = p[0] - 0.3 - 0.1 * (1.0 - p[1]);
            -inside * inside * (1.0 + inside) - (p[1] - 1.2) * (p[1] - 1.2)
        });
        assert!((fractions[0] - 0.3).abs() < 1e-7, "{fractions:?}");
        assert_eq!(fractions[1], 1.0);
        assert!((value + 0.04).abs() < 1e-13);
        assert!(requested < 200, "{requested} values");
    }

    #[test]
    fn what_is_no_number_is_left_alone() {
        let (fractions, value) = climb(&[0.2], &mut |p| if p[0] > 0.5 { f64::NAN } else { p[0] });
        assert!((fractions[0] - 0.5).abs() < 1e-6 && value == fractions[0]);
    }
}
