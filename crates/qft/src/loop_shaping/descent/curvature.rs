//! The curvature of a Lagrangian, estimated from changes of its slopes.

use super::super::subproblem::dot;

/// Fraction of the present curvature that a change of slopes must show; otherwise it is mixed with
/// the expected change (Powell 1978).
const DAMPING: f64 = 0.2;

/// Largest entry due to curvature, dB per square neper; a larger one indicates a kink.
const LARGEST: f64 = 1e6;

/// A positive definite matrix B, updated by the damped BFGS formula.
///
/// ```text
/// B' = B - B d d.B/(d.B d) + y y./(d.y),      y -> theta y + (1 - theta) B d so that d.y >= 0.2 d.B d
/// ```
///
/// Source: Powell (1978); Nocedal and Wright (2006), procedure 18.2.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curvature {
    rows: Vec<Vec<f64>>,
}

impl Curvature {
    /// Initial curvature |d.y|/(d.d), equal in every direction; `None` if step or change carry no
    /// information.
    pub(crate) fn first(step: &[f64], change: &[f64]) -> Option<Curvature> {
        let size = dot(step, change).abs() / dot(step, step);
        let row = |at: usize| (0..step.len()).map(|column| if column == at { size } else { 0.0 }).collect();
        (size.is_finite() && size > 0.0).then(|| Curvature { rows: (0..step.len()).map(row).collect() })
    }

    /// Entry of a row and a column.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column]
    }

    /// Product B d.
    pub(crate) fn times(&self, step: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| dot(row, step)).collect()
    }

    /// Updated matrix B', from a step d and the change y of the slopes along it; `None` if a kink
    /// or rounding makes it useless.
    pub(super) fn updated(&self, step: &[f64], change: &[f64]) -> Option<Curvature> {
        let expected = self.times(step);
        let before = dot(step, &expected);
        let seen = dot(step, change);
        let fraction =
            if seen >= DAMPING * before { 1.0 } else { (1.0 - DAMPING) * before / (before - seen) };
        let mixed: Vec<f64> =
            change.iter().zip(&expected).map(|(y, b)| fraction * y + (1.0 - fraction) * b).collect();
        let along = dot(step, &mixed);
        let entry = |row: usize, column: usize, old: f64| {
            old - expected[row] * expected[column] / before + mixed[row] * mixed[column] / along
        };
        let rows: Vec<Vec<f64>> = self
            .rows
            .iter()
            .enumerate()
            .map(|(row, entries)| {
                entries.iter().enumerate().map(|(column, &old)| entry(row, column, old)).collect()
            })
            .collect();
        let is_sound =
            |(at, row): (usize, &Vec<f64>)| row[at] > 0.0 && row.iter().all(|entry| entry.abs() < LARGEST);
        let sound = rows.iter().enumerate().all(is_sound);
        sound.then_some(Curvature { rows })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along conjugate steps of a quadratic function the formula finds its matrix, from any start.
    #[test]
    fn a_quadratic_function_is_learnt_exactly() {
        let hessian = |d: &[f64]| vec![4.0 * d[0] + d[1], d[0] + 3.0 * d[1]];
        let conjugate = [[1.0, 0.0], [-1.0, 4.0]];
        assert_eq!(dot(&conjugate[0], &hessian(&conjugate[1])), 0.0);
        let mut learnt = Curvature::first(&[1.0, 1.0], &[10.0, 3.0]).unwrap();
        assert_eq!(learnt.times(&[2.0, -2.0]), [13.0, -13.0]);
        for step in conjugate {
            learnt = learnt.updated(&step, &hessian(&step)).unwrap();
        }
        for step in [[1.0, 2.0], [-3.0, 0.5]] {
            let (found, expected) = (learnt.times(&step), hessian(&step));
            assert!(
                found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12),
                "{found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn negative_curvature_is_not_believed() {
        let learnt =
            Curvature::first(&[1.0, 0.0], &[2.0, 0.0]).unwrap().updated(&[1.0, 0.0], &[-8.0, 1.0]).unwrap();
        let along = learnt.at(0, 0);
        assert!((along - 0.2 * 2.0).abs() < 1e-12, "{along}");
        assert!(along * learnt.at(1, 1) > learnt.at(0, 1) * learnt.at(1, 0));
    }

    #[test]
    fn no_step_says_nothing() {
        assert_eq!(Curvature::first(&[0.0, 0.0], &[1.0, 0.0]), None);
        assert_eq!(Curvature::first(&[1.0, 0.0], &[0.0, 1.0]), None);
    }
}
