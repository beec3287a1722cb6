//! Position of a linkage of given lengths at an extension of the cylinder.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::portable;

use super::chebyshev::{ChebyshevSeries, TERMS, in_powers};
use super::{FourBar, LinkageError, LinkageTable, PivotTriangle};

/// Halvings to the last bit.
const HALVINGS: usize = 64;
/// Highest degree of the polynomial through a table.
const HIGHEST_DEGREE: usize = 11;
/// Range beyond its ends in which a table's polynomial is searched, as a fraction of its angles.
const BEYOND_TABLE: f64 = 0.2;

impl PivotTriangle {
    /// Angle at the joint between both pivots, in rad; `None` if no such triangle exists.
    ///
    /// ```text
    /// l = l_0 + x,     cos(phi) = (a^2 + b^2 - l^2)/(2 a b)
    /// ```
    pub(super) fn opening(&self, position: f64) -> Option<f64> {
        let (a, b, l) = (self.cylinder_pivot, self.rod_pivot, self.retracted_length + position);
        let cosine = (a * a + b * b - l * l) / (2.0 * a * b);
        (l > 0.0 && cosine.abs() < 1.0).then(|| portable::acos(cosine))
    }
}

impl FourBar {
    /// Angle of the output link from the fixed link in rad, counted from its joint away from the
    /// input's; `None` if the links do not meet.
    ///
    /// ```text
    /// A = r (cos alpha, sin alpha),   D = (d, 0),   e = |A - D|
    /// cos(beta) = (e^2 + o^2 - c^2)/(2 e o),   psi = arg(A - D) -+ beta         - open, + crossed
    /// ```
    pub(super) fn output(&self, position: f64) -> Option<f64> {
        let alpha = self.triangle.opening(position)? + self.input_angle;
        let (r, d, c, o) = (self.input_link, self.fixed_link, self.coupler, self.output_link);
        let across = r * portable::cos(alpha) - d;
        let up = r * portable::sin(alpha);
        let e = portable::hypot(across, up);
        let cosine = (e * e + o * o - c * c) / (2.0 * e * o);
        let beta = (cosine.abs() < 1.0).then(|| portable::acos(cosine))?;
        let seen = portable::atan2(up, across);
        Some(if self.crossed { seen + beta } else { seen - beta })
    }
}

/// Polynomial of least degree that passes every row of a table within its tolerance, and the
/// largest distance of a row from it in m.
pub(super) fn through_table(table: &LinkageTable) -> Result<(ChebyshevSeries, f64), LinkageError> {
    let rows = table.angles.len().min(table.extensions.len());
    let (Some(first), Some(last)) = (table.angles.first(), table.angles.get(rows.saturating_sub(1))) else {
        return Err(LinkageError::FewRows { rows });
    };
    if rows < 2 {
        return Err(LinkageError::FewRows { rows });
    }
    let (middle, half_width) = (0.5 * (first + last), 0.5 * (last - first));
    let highest = (2 * (rows - 1) / 3).clamp(1, HIGHEST_DEGREE);
    let mut residual = f64::INFINITY;
    for degree in 1..=highest {
        let polynomial = |angle: f64| {
            let t = (angle - middle) / half_width;
            let mut values = vec![1.0, t];
            while values.len() <= degree {
                let [.., before, last] = values.as_slice() else { break };
                values.push(2.0 * t * last - before);
            }
            values
        };
        let basis: Vec<Vec<f64>> = table.angles.iter().take(rows).map(|angle| polynomial(*angle)).collect();
        let matrix = DMatrix::from_fn(rows, degree + 1, |row, column| basis[row][column]);
        let wanted = DVector::from_fn(rows, |row, _| table.extensions[row]);
        let factors = matrix.clone().qr();
        let projected = factors.q().transpose() * &wanted;
        let Some(found) = factors.r().solve_upper_triangular(&projected) else { continue };
        residual = (matrix * &found - wanted).amax();
        if residual <= table.tolerance {
            let mut coefficients = [0.0; TERMS];
            coefficients.iter_mut().zip(found.iter()).for_each(|(place, value)| *place = *value);
            let series = ChebyshevSeries { coefficients: in_powers(&coefficients), middle, half_width };
            return Ok((series, residual));
        }
    }
    Err(LinkageError::TableRough { residual, tolerance: table.tolerance, degree: highest })
}

/// Angle in rad at which a rising series has this value, to the last bit; `None` if it has the
/// value nowhere near its range.
pub(super) fn where_it_is(series: &ChebyshevSeries, value: f64) -> Option<f64> {
    let reach = series.half_width * (1.0 + BEYOND_TABLE);
    rising_root(|angle| Some(series.at(angle)[0] - value), [series.middle - reach, series.middle + reach])
}

/// Root of a rising function, to the last bit; `None` if the function does not change its sign, or
/// has no value.
pub(super) fn rising_root(of: impl Fn(f64) -> Option<f64>, [from, to]: [f64; 2]) -> Option<f64> {
    let (mut low, mut high) = (from, to);
    if of(low)? > 0.0 || of(high)? < 0.0 {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if of(middle)? < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}
