use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;

/// The limit of a magnitude over frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// Limit that is equal at every frequency.
    Constant(f64),
    /// The magnitude of a rational function of s.
    Rational(TransferFunction),
    /// Values at given frequencies; interpolated linearly in a double logarithmic diagram.
    Table(LimitTable),
}

/// Magnitudes at increasing frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitTable {
    points: Vec<(f64, f64)>,
}

/// Reason why a table of limits is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LimitError {
    /// A table without points.
    #[error("a table of limits needs at least one point")]
    Empty,
    /// A point that violates the rules (counted from 0): frequencies must be positive and increase,
    /// magnitudes must be positive.
    #[error(
        "point {0} of the table: frequencies must be positive and increase, magnitudes be positive and finite"
    )]
    Point(usize),
}

impl LimitTable {
    /// A table of pairs (frequency, rad/s; magnitude).
    ///
    /// # Errors
    /// A table without points, a frequency that does not increase, a value that is not positive and
    /// finite.
    pub fn new(points: Vec<(f64, f64)>) -> Result<LimitTable, LimitError> {
        if points.is_empty() {
            return Err(LimitError::Empty);
        }
        let mut previous = 0.0;
        for (index, &(frequency, magnitude)) in points.iter().enumerate() {
            let sound =
                frequency > previous && frequency.is_finite() && magnitude > 0.0 && magnitude.is_finite();
            if !sound {
                return Err(LimitError::Point(index));
            }
            previous = frequency;
        }
        Ok(LimitTable { points })
    }

    /// The pairs (frequency, rad/s; magnitude).
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    fn magnitude(&self, frequency: f64) -> Option<f64> {
        let exact = self.points.iter().find(|point| point.0 == frequency).map(|point| point.1);
        let between = self.points.windows(2).find_map(|pair| match *pair {
            [(low, low_value), (high, high_value)] if low < frequency && frequency < high => {
                let fraction = portable::ln(frequency / low) / portable::ln(high / low);
                Some(low_value * portable::exp(fraction * portable::ln(high_value / low_value)))
            }
            _ => None,
        });
        exact.or(between)
    }
}

impl Limit {
    /// The limit at this frequency; `None` beyond the ends of a table, where no limit applies.
    ///
    /// # Example
    /// ```
    /// use phea_qft::specification::{Limit, LimitTable};
    /// let table = Limit::Table(LimitTable::new(vec![(1.0, 1.0), (100.0, 4.0)])?);
    /// assert!((table.magnitude(10.0).unwrap() - 2.0).abs() < 1e-14);
    /// assert_eq!(table.magnitude(1000.0), None);
    /// # Ok::<(), phea_qft::specification::LimitError>(())
    /// ```
    pub fn magnitude(&self, frequency_rad_per_s: f64) -> Option<f64> {
        match self {
            Limit::Constant(value) => Some(*value),
            Limit::Rational(function) => {
                Some(portable::magnitude(function.at_frequency(frequency_rad_per_s)))
            }
            Limit::Table(table) => table.magnitude(frequency_rad_per_s),
        }
    }

    /// Multiplies the limit by a factor at every frequency.
    ///
    /// # Errors
    /// [`LinearError`] for a factor that is not finite.
    pub fn scaled(&self, factor: f64) -> Result<Limit, LinearError> {
        Ok(match self {
            Limit::Constant(value) => Limit::Constant(factor * value),
            Limit::Rational(function) => {
                Limit::Rational(function.series(&TransferFunction::gain_only(factor))?)
            }
            Limit::Table(LimitTable { points }) => {
                let scaled = |(frequency, magnitude): &(f64, f64)| (*frequency, factor * magnitude);
                Limit::Table(LimitTable { points: points.iter().map(scaled).collect() })
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_out_of_order_or_out_of_physics_are_refused() {
        assert_eq!(LimitTable::new(vec![]), Err(LimitError::Empty));
        assert_eq!(LimitTable::new(vec![(1.0, 1.0), (1.0, 2.0)]), Err(LimitError::Point(1)));
        assert_eq!(LimitTable::new(vec![(0.0, 1.0)]), Err(LimitError::Point(0)));
        assert_eq!(LimitTable::new(vec![(1.0, -1.0)]), Err(LimitError::Point(0)));
        assert_eq!(LimitTable::new(vec![(f64::NAN, 1.0)]), Err(LimitError::Point(0)));
    }

    #[test]
    fn a_table_passes_through_its_points_and_ends_there() {
        let table = Limit::Table(LimitTable::new(vec![(0.1, 3.0), (1.0, 1.0), (10.0, 2.0)]).unwrap());
        assert_eq!(
            [0.1, 1.0, 10.0].map(|frequency| table.magnitude(frequency)),
            [Some(3.0), Some(1.0), Some(2.0)]
        );
        assert_eq!([0.09, 10.1].map(|frequency| table.magnitude(frequency)), [None, None]);
    }
}
