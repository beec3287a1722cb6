use num_complex::Complex64;
use phea_dynamics::portable;

/// Largest differences between two frequency responses on a grid. Units: dB, degrees, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseDifference {
    /// Largest difference of the magnitudes, as a positive number of dB.
    pub magnitude_db: f64,
    /// Frequency of this difference, rad/s.
    pub magnitude_frequency: f64,
    /// Largest difference of the phases, as a positive number of degrees up to 180.
    pub phase_deg: f64,
    /// Frequency of this difference, rad/s.
    pub phase_frequency: f64,
}

/// Largest magnitude and phase differences of `other/reference` over these frequencies in rad/s;
/// zeros without frequencies.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_hydraulics::linear::response_difference;
/// let lag = |w: f64| 1.0 / Complex64::new(1.0, w);
/// let difference = response_difference(&[0.1, 1.0], |_| Complex64::new(1.0, 0.0), lag);
/// assert!((difference.magnitude_db - 3.0103).abs() < 1e-4 && (difference.phase_deg - 45.0).abs() < 1e-12);
/// assert_eq!(difference.magnitude_frequency, 1.0);
/// ```
pub fn response_difference(
    frequencies: &[f64],
    reference: impl Fn(f64) -> Complex64,
    other: impl Fn(f64) -> Complex64,
) -> ResponseDifference {
    let mut largest = ResponseDifference {
        magnitude_db: 0.0,
        magnitude_frequency: frequencies.first().copied().unwrap_or(0.0),
        phase_deg: 0.0,
        phase_frequency: frequencies.first().copied().unwrap_or(0.0),
    };
    for &frequency in frequencies {
        let ratio = other(frequency) / reference(frequency);
        let magnitude_db = (20.0 * portable::log10(portable::magnitude(ratio))).abs();
        let phase_deg = portable::argument(ratio).to_degrees().abs();
        // a NaN ratio is the largest possible difference and must not be ignored
        if magnitude_db > largest.magnitude_db || magnitude_db.is_nan() {
            (largest.magnitude_db, largest.magnitude_frequency) = (magnitude_db, frequency);
        }
        if phase_deg > largest.phase_deg || phase_deg.is_nan() {
            (largest.phase_deg, largest.phase_frequency) = (phase_deg, frequency);
        }
    }
    largest
}
