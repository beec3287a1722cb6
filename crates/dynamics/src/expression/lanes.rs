//! An expression at many points, several at a time.

use pulp::{Arch, Simd, WithSimd};

use super::Expression;
use crate::scalar::{LANES, Lanes};

impl Expression {
    /// First result at each of these points, bit for bit that of [`Expression::number`]: each
    /// operation is read once for four points.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::Expression;
    /// let area = Expression::record(&["a", "b"], |p| vec![p[0] * p[1]]);
    /// assert_eq!(area.numbers(&[vec![2.0, 3.0], vec![4.0, 5.0]]), [6.0, 20.0]);
    /// ```
    pub fn numbers(&self, points: &[Vec<f64>]) -> Vec<f64> {
        Arch::new().dispatch(FirstResults { expression: self, points })
    }
}

struct FirstResults<'e> {
    expression: &'e Expression,
    points: &'e [Vec<f64>],
}

impl WithSimd for FirstResults<'_> {
    type Output = Vec<f64>;

    // inlined, so that it is compiled for the widest vectors of the processor
    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> Vec<f64> {
        let FirstResults { expression, points } = self;
        let mut values = vec![Lanes::from(0.0); expression.nodes.len()];
        let mut found = Vec::with_capacity(points.len());
        for points in points.chunks(LANES) {
            let parameters = parameters(points, expression.parameters.len());
            for (index, node) in expression.nodes.iter().enumerate() {
                values[index] = node.evaluate(&parameters, &values);
            }
            let first = expression.results.first().map_or(Lanes::from(f64::NAN), |&index| values[index]);
            found.extend(first.0.iter().take(points.len()));
        }
        found
    }
}

/// Each parameter at these points; unused lanes repeat the last point.
fn parameters(points: &[Vec<f64>], count: usize) -> Vec<Lanes> {
    let number = |lane: usize, parameter: usize| {
        let point = points.get(lane).or(points.last());
        point.and_then(|point| point.get(parameter)).copied().unwrap_or(f64::NAN)
    };
    (0..count).map(|parameter| Lanes(std::array::from_fn(|lane| number(lane, parameter)))).collect()
}
