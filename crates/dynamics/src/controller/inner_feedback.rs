//! Feedback of a second measured signal to the command, inside the main loop.

use crate::analytic::Analytic;
use crate::linear::{LinearError, Polynomial, TransferFunction};

/// Feedback of a second measured signal of the plant, subtracted from the command.
///
/// ```text
/// u = G (F r - y) - H p,     H(s) = k s/(s + w_h) w_l/(s + w_l)         each of both filters optional
/// ```
///
/// For an actuator, p is the load pressure, and H adds to the flow-pressure coefficient of the
/// valve: active damping.
///
/// # Example
/// Far above the high-pass corner and far below the low-pass corner only the gain remains.
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::controller::InnerFeedback;
/// let feedback = InnerFeedback {
///     gain: 2.0, high_pass_rad_per_s: Some(1.0), low_pass_rad_per_s: Some(1e6),
/// };
/// let between: Complex64 = feedback.response(Complex64::new(0.0, 1e3));
/// assert!((between - 2.0).norm_sqr() < 1e-5);
/// assert_eq!(feedback.transfer_function()?.dc_gain(), 0.0);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InnerFeedback {
    /// Gain k, command per unit of the signal.
    pub gain: f64,
    /// High-pass corner w_h in rad/s; `None` if the signal at rest is fed back too.
    pub high_pass_rad_per_s: Option<f64>,
    /// Low-pass corner w_l in rad/s; `None` without a low pass.
    pub low_pass_rad_per_s: Option<f64>,
}

impl InnerFeedback {
    /// True if H is zero.
    pub fn is_zero(&self) -> bool {
        self.gain == 0.0
    }

    /// Coefficients of the numerator of H, highest power first.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::controller::InnerFeedback;
    /// let gain = InnerFeedback { gain: 3.0, ..InnerFeedback::default() };
    /// assert_eq!((gain.numerator(), gain.denominator()), (vec![3.0], vec![1.0]));
    /// let high = InnerFeedback { high_pass_rad_per_s: Some(5.0), ..gain };
    /// assert_eq!((high.numerator(), high.denominator()), (vec![3.0, 0.0], vec![1.0, 5.0]));
    /// let both = InnerFeedback { low_pass_rad_per_s: Some(2.0), ..high };
    /// assert_eq!((both.numerator(), both.denominator()), (vec![3.0, 0.0], vec![0.5, 3.5, 5.0]));
    /// ```
    pub fn numerator(&self) -> Vec<f64> {
        match self.high_pass_rad_per_s {
            None => vec![self.gain],
            Some(_) => vec![self.gain, 0.0],
        }
    }

    /// Coefficients of the denominator of H, highest power first.
    pub fn denominator(&self) -> Vec<f64> {
        let high = self.high_pass_rad_per_s.map_or(vec![1.0], |corner| vec![1.0, corner]);
        let low = self.low_pass_rad_per_s.map_or(vec![1.0], |corner| vec![1.0 / corner, 1.0]);
        Polynomial::new(high).product(&Polynomial::new(low)).coefficients().to_vec()
    }

    /// H(s).
    ///
    /// # Errors
    /// [`LinearError`] for a corner that is zero or not finite.
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        if self.is_zero() {
            return Ok(TransferFunction::gain_only(0.0));
        }
        TransferFunction::from_polynomials(
            &Polynomial::new(self.numerator()),
            &Polynomial::new(self.denominator()),
        )
    }

    /// H at s in rad/s, or over a set of values of s.
    pub fn response<A: Analytic>(&self, s: A) -> A {
        let gain = A::from(self.gain);
        let high = self.high_pass_rad_per_s.map_or(gain, |corner| gain * s / (s + A::from(corner)));
        self.low_pass_rad_per_s.map_or(high, |corner| high / (s.scaled(1.0 / corner) + A::from(1.0)))
    }

    /// Upper bound of |H(jv)| for every v at or above a frequency in rad/s.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::controller::InnerFeedback;
    /// let feedback = InnerFeedback {
    ///     gain: -2.0, high_pass_rad_per_s: Some(3.0), low_pass_rad_per_s: Some(40.0),
    /// };
    /// for frequency in [0.1, 10.0, 40.0, 1e4] {
    ///     let own: Complex64 = feedback.response(Complex64::new(0.0, frequency));
    ///     assert!(own.norm_sqr().sqrt() <= feedback.bound(frequency));
    /// }
    /// assert!(feedback.bound(4e4) < 2.1e-3);
    /// ```
    pub fn bound(&self, frequency_rad_per_s: f64) -> f64 {
        let falls = self.low_pass_rad_per_s.map_or(1.0, |corner| (corner / frequency_rad_per_s).min(1.0));
        self.gain.abs() * falls
    }

    /// The corners of both filters in rad/s.
    pub fn corners_rad_per_s(&self) -> impl Iterator<Item = f64> + Clone + use<> {
        self.high_pass_rad_per_s.into_iter().chain(self.low_pass_rad_per_s)
    }
}
