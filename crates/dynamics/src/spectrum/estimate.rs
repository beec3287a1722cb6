use num_complex::Complex64;

use crate::portable::pow;

/// Response at one frequency, and its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralPoint {
    /// Frequency, rad/s.
    pub frequency: f64,
    /// Response Y/U.
    pub response: Complex64,
    /// Squared coherence gamma^2, from 0 to 1: the fraction of the output's power that depends
    /// linearly on the input.
    pub coherence: f64,
    /// Standard deviation sigma of the response: the mean of |estimate - truth|^2 is sigma^2.
    pub deviation: f64,
    /// Radius of the disc around the response that contains the true response with 95 % confidence.
    pub radius: f64,
    /// Complex degrees of freedom q of the deviation: the radius is that of F(2, 2 q).
    pub freedom: f64,
    /// Power of the input at this frequency, over that at the strongest one.
    pub excitation: f64,
}

/// Probability outside the disc.
pub(super) const OUTSIDE: f64 = 0.05;

/// Radius of the disc that contains the true response with 95 % confidence, from the standard
/// deviation of an estimate that is based on this many independent blocks.
///
/// ```text
/// r^2 = F(2, 2 n - 2) sigma^2        F(2, m) = (m/2) (0.05^(-2/m) - 1)
/// ```
///
/// The quantile of Fisher's F with two degrees of freedom above has this closed form. Infinite for
/// a single block. Sources: Bendat and Piersol (2010), section 9.2; Pintelon and Schoukens (2012),
/// section 2.
///
/// # Example
/// For many blocks the error is normal in both directions: -2 ln 0.05 of half the variance.
/// ```
/// use phea_dynamics::spectrum::disc_radius;
/// assert!((disc_radius(1.0, 1e9) - (20.0_f64.ln()).sqrt()).abs() < 1e-7);
/// // ORIGIN: analytic, F(2, 2) = 1/0.05 - 1
/// assert!((disc_radius(1.0, 2.0).powi(2) - 19.0).abs() < 1e-12);
/// assert!(disc_radius(1.0, 1.0).is_infinite());
/// ```
pub fn disc_radius(deviation: f64, blocks: f64) -> f64 {
    if blocks <= 1.0 { f64::INFINITY } else { fisher(blocks - 1.0, OUTSIDE).sqrt() * deviation }
}

/// Value that Fisher's F with two degrees of freedom above and 2 m below exceeds with this
/// probability.
///
/// ```text
/// F = m (p^(-1/m) - 1)
/// ```
pub(super) fn fisher(half: f64, probability: f64) -> f64 {
    half * (pow(probability, -1.0 / half) - 1.0)
}

/// Squared coherence that two signals without any relation exceed in one case out of twenty, for
/// this many independent blocks: Carter, Knapp and Nuttall (1973).
///
/// ```text
/// gamma^2 = 1 - 0.05^(1/(n - 1))
/// ```
pub fn least_coherence(blocks: f64) -> f64 {
    if blocks > 1.0 { 1.0 - pow(OUTSIDE, 1.0 / (blocks - 1.0)) } else { 1.0 }
}
