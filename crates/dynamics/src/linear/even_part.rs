//! Real part of a rational function on the imaginary axis, as an even polynomial.

use num_complex::Complex64;

use super::double_double::DoubleDouble;
use super::polynomial::{expand, multiply};
use super::{LinearError, Polynomial};
use crate::order::sort_numbers;
use crate::portable::magnitude;

/// Polynomial with the sign of the real part of a response N/D; coefficients in twice the working
/// precision, highest power first.
///
/// ```text
/// R(x) = Re (N(jw) conj D(jw)),     x = w^2
/// ```
///
/// For real polynomials conj D(jw) = D(-jw), so R is the even part of N(s) D(-s) with s^2 = -x.
pub(crate) struct EvenPart {
    coefficients: Vec<DoubleDouble>,
}

impl EvenPart {
    /// Even part for N = gain prod (s - zero), D = prod (s - pole).
    pub(crate) fn of_product(gain: f64, zeros: &[Complex64], poles: &[Complex64]) -> Self {
        let numerator = expand(gain, zeros);
        let mut reflected = expand(1.0, poles);
        let degree = reflected.len() - 1;
        for (index, coefficient) in reflected.iter_mut().enumerate() {
            if (degree - index) % 2 == 1 {
                *coefficient = -*coefficient;
            }
        }
        let product = multiply(&numerator, &reflected);
        let absolute = |c: &[DoubleDouble]| c.iter().map(|c| c.abs()).collect::<Vec<_>>();
        let scales = multiply(&absolute(&numerator), &absolute(&reflected));
        let top = product.len() - 1;
        let mut coefficients = Vec::with_capacity(top / 2 + 1);
        for (index, (&value, scale)) in product.iter().zip(&scales).enumerate() {
            let power = top - index;
            if power.is_multiple_of(2) {
                // s^(2k) = (-x)^k; a sum that cancels to rounding is zero
                let signed = if (power / 2) % 2 == 1 { -value } else { value };
                let noise = 1e4 * f64::EPSILON * f64::EPSILON * scale.value();
                let kept = if value.value().abs() <= noise { DoubleDouble::ZERO } else { signed };
                coefficients.push(kept);
            }
        }
        EvenPart { coefficients }
    }

    /// Frequencies that include every sign change: the square roots of the magnitudes of all roots
    /// in x, sorted.
    pub(crate) fn candidate_frequencies(&self) -> Result<Vec<f64>, LinearError> {
        let polynomial = Polynomial::new(self.coefficients.iter().map(|c| c.value()).collect());
        if polynomial.is_zero() {
            return Ok(Vec::new());
        }
        let roots = polynomial.roots()?;
        let mut frequencies: Vec<f64> = roots.iter().map(|root| magnitude(*root).sqrt()).collect();
        sort_numbers(&mut frequencies);
        Ok(frequencies)
    }

    /// Sign of R at a frequency; zero when the value is no larger than its rounding error.
    pub(crate) fn sign_at(&self, frequency: f64) -> i8 {
        let x = DoubleDouble::product_of(frequency, frequency);
        let (mut value, mut scale) = (DoubleDouble::ZERO, 0.0);
        for &coefficient in &self.coefficients {
            value = value * x + coefficient;
            scale = scale * x.high + coefficient.high.abs();
        }
        let value = value.value();
        let noise = 1e4 * f64::EPSILON * f64::EPSILON * scale;
        if value > noise {
            1
        } else if value < -noise {
            -1
        } else {
            0
        }
    }

    /// End of a band, refined by bisection on the sign in its immediate neighbourhood; zero and
    /// infinity stay.
    pub(crate) fn sign_change_near(&self, frequency: f64) -> f64 {
        let (mut low, mut high) = (frequency * (1.0 - 1e-7), frequency * (1.0 + 1e-7));
        if frequency == 0.0 || frequency.is_infinite() || self.sign_at(low) == self.sign_at(high) {
            return frequency;
        }
        let below = self.sign_at(low);
        loop {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                return middle;
            }
            if self.sign_at(middle) == below { low = middle } else { high = middle }
        }
    }
}
