//! The margin of one plant to one specification at one frequency.

use crate::verdict::PlantPoint;

/// The margin of one plant to one specification at one frequency.
///
/// ```text
/// margin = 20 log10(limit/|closed loop|)                       its negative for a lower limit
/// margin = 20 log10(upper/lower) - 20 log10(max |T|/min |T|)    for the spread of |T| of two plants
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationMargin {
    /// Index of the specification.
    pub specification: usize,
    /// Frequency, rad/s; zero or infinite for a limit.
    pub frequency_rad_per_s: f64,
    /// Margin, dB; negative if the specification is violated.
    pub margin_db: f64,
    /// The plant; for a spread, the one with the greatest |T|.
    pub plant: PlantPoint,
    /// The plant with the least |T|, for a spread.
    pub other: Option<PlantPoint>,
}

impl SpecificationMargin {
    /// The plant, or both plants of a spread.
    pub fn plants(&self) -> impl Iterator<Item = &PlantPoint> {
        std::iter::once(&self.plant).chain(&self.other)
    }
}
