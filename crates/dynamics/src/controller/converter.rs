//! Converters between a computer and what it controls.

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

/// The bits or the range are invalid. A converter has 1 to 32 bits and a finite range
/// `[minimum, maximum]` with minimum < maximum.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("a converter with {bits} bits from {minimum} to {maximum} is invalid")]
pub struct ConverterError {
    /// Bits.
    pub bits: u32,
    /// Lower end.
    pub minimum: f64,
    /// Upper end.
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

    /// q, in the unit of the signal.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The nearest level, limited to the range.
    pub fn rounded(&self, value: f64) -> f64 {
        let [minimum, maximum] = self.range;
        ((value / self.step).round() * self.step).clamp(minimum, maximum)
    }
}
