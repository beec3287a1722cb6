//! Quotients of polynomials by their coefficients.

use num_complex::Complex64;

use crate::linear::{LinearError, Polynomial, TransferFunction};

/// Quotient of polynomials, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct RationalCoefficients<S> {
    /// Numerator coefficients.
    pub numerator: Vec<S>,
    /// Denominator coefficients.
    pub denominator: Vec<S>,
}

impl RationalCoefficients<f64> {
    /// Quotient at s = j w, by Horner's rule.
    pub fn at_frequency(&self, frequency_rad_per_s: f64) -> Complex64 {
        let s = Complex64::new(0.0, frequency_rad_per_s);
        let polynomial =
            |coefficients: &[f64]| coefficients.iter().fold(Complex64::new(0.0, 0.0), |sum, &c| sum * s + c);
        polynomial(&self.numerator) / polynomial(&self.denominator)
    }

    /// Quotient by its zeros, poles and gain.
    ///
    /// # Errors
    /// [`LinearError`] for a zero denominator, and for roots that are not found.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::uncertain_plant::RationalCoefficients;
    /// let lag = RationalCoefficients { numerator: vec![6.0], denominator: vec![1.0, 3.0] };
    /// assert_eq!(lag.transfer_function().unwrap().dc_gain(), 2.0);
    /// ```
    pub fn transfer_function(&self) -> Result<TransferFunction, LinearError> {
        let [numerator, denominator] =
            [&self.numerator, &self.denominator].map(|coefficients| Polynomial::new(coefficients.clone()));
        TransferFunction::from_polynomials(&numerator, &denominator)
    }
}
