//! Sum of several sines.

use super::piece::{PieceShape, ProfilePiece};
use super::{Profile, ProfileError, ProfileNumber, finite, positive};

/// One sine of a multisine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// Amplitude, in the unit of the function.
    pub amplitude: f64,
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Phase at the start, rad.
    pub phase_rad: f64,
}

/// Phases in rad that keep the peak of a multisine low, for amplitudes in the order of rising
/// frequency.
///
/// ```text
/// phi_k = -2 pi sum over n < k of (k - n) p_n,      p_n = a_n^2/(sum of all a^2);      equal amplitudes: -pi k (k - 1)/N
/// ```
///
/// The first phase is zero, as for a single sine. Intended for equidistant frequencies. Source:
/// Schroeder 1970, synthesis of low-peak-factor signals and binary sequences with low
/// autocorrelation.
///
/// # Example
/// The peak of twenty equal sines is 14.8 times one amplitude with equal phases, and 6.0 times with
/// these:
/// ```
/// use phea_dynamics::simulation::{Harmonic, Profile, schroeder_phases};
/// let phases = schroeder_phases(&[1.0; 20]);
/// let peak = |phases: &[f64]| {
///     let harmonic = |(k, phase_rad): (usize, &f64)| Harmonic {
///         amplitude: 1.0,
///         frequency_rad_per_s: 1.0 + k as f64,
///         phase_rad: *phase_rad,
///     };
///     let sum = Profile::multisine(0.0, &phases.iter().enumerate().map(harmonic).collect::<Vec<_>>());
///     sum.map(|sum| (0..6284).map(|k| sum.value(1e-3 * f64::from(k)).abs()).fold(0.0, f64::max))
/// };
/// assert!((peak(&phases)? - 6.03).abs() < 0.01 && (peak(&[0.0; 20])? - 14.85).abs() < 0.01);
/// # Ok::<(), phea_dynamics::simulation::ProfileError>(())
/// ```
pub fn schroeder_phases(amplitudes: &[f64]) -> Vec<f64> {
    let power: f64 = amplitudes.iter().map(|amplitude| amplitude * amplitude).sum();
    // sum over n < k of (k - n) p_n is the sum of the partial sums of p before k
    let (mut below, mut phase) = (0.0, 0.0);
    let step = |amplitude: &f64| {
        let this = phase;
        below += amplitude * amplitude / power;
        phase -= 2.0 * std::f64::consts::PI * below;
        this
    };
    amplitudes.iter().map(step).collect()
}

impl Profile {
    /// Zero, and the sum of sines from its start on.
    ///
    /// ```text
    /// w = sum over k of a_k sin(omega_k (t - t_0) + phi_k),     t >= t_0;      omega in rad/s
    /// ```
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`] unless all frequencies are positive and all numbers are finite.
    pub fn multisine(start_s: f64, harmonics: &[Harmonic]) -> Result<Profile, ProfileError> {
        finite(ProfileNumber::MultisineStart, start_s)?;
        for harmonic in harmonics {
            finite(ProfileNumber::MultisineAmplitude, harmonic.amplitude)?;
            positive(ProfileNumber::MultisineFrequency, harmonic.frequency_rad_per_s)?;
            finite(ProfileNumber::MultisinePhase, harmonic.phase_rad)?;
        }
        let shape = |harmonic: &Harmonic| PieceShape::Sine {
            origin_s: start_s,
            amplitude: harmonic.amplitude,
            frequency_rad_per_s: harmonic.frequency_rad_per_s,
            sweep_rad_per_s2: 0.0,
            span_s: 0.0,
            phase_rad: harmonic.phase_rad,
        };
        let sum = ProfilePiece::of(harmonics.iter().map(shape).collect());
        Ok(Profile { later: vec![(start_s, sum)], ..Profile::constant(0.0) })
    }
}
