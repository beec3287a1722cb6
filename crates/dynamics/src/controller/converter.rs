//! Converters between a computer and the plant, and the number formats of coefficients.

use crate::portable;

/// A converter that rounds to the nearest of 2^bits levels over its range.
///
/// ```text
/// q = (maximum - minimum)/2^bits
/// ```
///
/// # Example
/// 12 bits over a valve command of -10 V to 10 V: steps of 4.9 mV.
/// ```
/// use phea_dynamics::controller::Converter;
/// let converter = Converter::new(12, [-10.0, 10.0])?;
/// assert_eq!(converter.step(), 0.0048828125);
/// // ORIGIN: analytic, 2/q = 409.6, so that 2 lies between levels 409 and 410
/// assert_eq!(converter.rounded(2.0), 410.0 * converter.step());
/// # Ok::<(), phea_dynamics::controller::ConverterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    step: f64,
    range: [f64; 2],
}

/// Error for an invalid number of bits or range. A converter has 1 to 32 bits and a finite range
/// `[minimum, maximum]` with minimum < maximum.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a converter with {bits} bits from {minimum} to {maximum} is invalid")]
pub struct ConverterError {
    /// Number of bits.
    pub bits: u32,
    /// Lower end of the range.
    pub minimum: f64,
    /// Upper end of the range.
    pub maximum: f64,
}

impl Converter {
    /// A converter with this number of bits over a range `[minimum, maximum]`.
    ///
    /// # Errors
    /// [`ConverterError`].
    pub fn new(bits: u32, range: [f64; 2]) -> Result<Converter, ConverterError> {
        let [minimum, maximum] = range;
        let levels =
            f64::from(bits.checked_sub(1).map_or(0, |rest| 1_u32.checked_shl(rest).unwrap_or(0))) * 2.0;
        let step = (maximum - minimum) / levels;
        if levels == 0.0 || !(step.is_finite() && step > 0.0) {
            return Err(ConverterError { bits, minimum, maximum });
        }
        Ok(Converter { step, range })
    }

    /// Step q, in the unit of the signal.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Lower and upper end of the range, in the unit of the signal.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// The nearest level, limited to the range.
    pub fn rounded(&self, value: f64) -> f64 {
        let [minimum, maximum] = self.range;
        ((value / self.step).round() * self.step).clamp(minimum, maximum)
    }
}

/// Number format of a coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CoefficientFormat {
    /// IEEE 754 with 53 bits: unchanged.
    #[default]
    Double,
    /// IEEE 754 with 24 bits.
    Single,
    /// A multiple of 2^-fraction_bits, below 2^integer_bits in magnitude.
    Fixed {
        /// Bits before the point, without the sign.
        integer_bits: u8,
        /// Bits after the point.
        fraction_bits: u8,
    },
}

/// Error for a coefficient beyond the range of its format.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the coefficient {value} is beyond the largest of its format, {largest}")]
pub struct CoefficientTooLarge {
    /// The coefficient.
    pub value: f64,
    /// Largest number that can be represented.
    pub largest: f64,
}

impl CoefficientFormat {
    /// Nearest number that can be represented; halves are rounded away from zero in fixed point,
    /// and to even in floating point.
    ///
    /// # Errors
    /// [`CoefficientTooLarge`].
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::CoefficientFormat;
    /// let format = CoefficientFormat::Fixed { integer_bits: 1, fraction_bits: 3 };
    /// assert_eq!(format.rounded(-1.3), Ok(-1.25));
    /// assert!(format.rounded(1.95).is_err()); // 2 would be the nearest
    /// ```
    pub fn rounded(self, value: f64) -> Result<f64, CoefficientTooLarge> {
        let (kept, largest) = match self {
            CoefficientFormat::Double => (value, f64::MAX),
            CoefficientFormat::Single => (f64::from(value as f32), f64::from(f32::MAX)),
            CoefficientFormat::Fixed { integer_bits, fraction_bits } => {
                let unit = power_of_two(-f64::from(fraction_bits));
                ((value / unit).round() * unit, power_of_two(f64::from(integer_bits)) - unit)
            }
        };
        // also rejects NaN
        if kept.abs() <= largest { Ok(kept) } else { Err(CoefficientTooLarge { value, largest }) }
    }
}

fn power_of_two(exponent: f64) -> f64 {
    portable::pow(2.0, exponent)
}
