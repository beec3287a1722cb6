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
    shares: Vec<f64>,
    value: f64,
    values_asked: usize,
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
    let mut climb = Climb { objective, shares: start.to_vec(), value, values_asked: 1 };
    let mut step = first_step;
    while step >= SMALLEST_STEP && climb.values_asked < VALUES_MAXIMUM {
        let way = (0..start.len()).map(|coordinate| climb.along(coordinate, step)).fold(0.0, f64::max);
        let in_corner = climb.shares.iter().all(|&share| share <= 0.0 || share >= 1.0);
        if way == 0.0 && in_corner && step < SMALL_STEP {
            break;
        }
        if way < 0.5 * step {
            step *= 0.25;
        }
    }
    (climb.shares, climb.value)
}

impl Climb<'_> {
    /// Moves along one coordinate; returns the distance.
    fn along(&mut self, coordinate: usize, step: f64) -> f64 {
        let Some(&centre) = self.shares.get(coordinate) else { return 0.0 };
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
        self.shares.get(coordinate).map_or(0.0, |share| (share - centre).abs())
    }

    /// Evaluates the point with this fraction in one coordinate; retains it if it is the best.
    fn visit(&mut self, coordinate: usize, share: f64) -> f64 {
        let mut shares = self.shares.clone();
        if let Some(slot) = shares.get_mut(coordinate) {
            *slot = share;
        }
        let value = (self.objective)(&shares);
        self.values_asked += 1;
        if value > self.value {
            (self.shares, self.value) = (shares, value);
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
        let mut asked = 0;
        let (shares, value) = climb(&[0.9, 0.5], &mut |p| {
            asked += 1;
            let inside = p[0] - 0.3 - 0.1 * (1.0 - p[1]);
            -inside * inside * (1.0 + inside) - (p[1] - 1.2) * (p[1] - 1.2)
        });
        assert!((shares[0] - 0.3).abs() < 1e-7, "{shares:?}");
        assert_eq!(shares[1], 1.0);
        assert!((value + 0.04).abs() < 1e-13);
        assert!(asked < 200, "{asked} values");
    }

    #[test]
    fn what_is_no_number_is_left_alone() {
        let (shares, value) = climb(&[0.2], &mut |p| if p[0] > 0.5 { f64::NAN } else { p[0] });
        assert!((shares[0] - 0.5).abs() < 1e-6 && value == shares[0]);
    }
}
