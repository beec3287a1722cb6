//! Polynomials with real coefficients.

use num_complex::Complex64;

use super::double_double::{ComplexDoubleDouble, DoubleDouble};
use super::{LinearError, LinearNumber, roots};
use crate::portable::magnitude;

/// A polynomial with real coefficients, highest power first, without leading zeros.
///
/// ```text
/// p(s) = c_0 s^n + c_1 s^(n-1) + ... + c_n
/// ```
///
/// Products and sums are rounded once, from twice the working precision. The zero polynomial has
/// the single coefficient 0 and degree 0. Coefficients that are not finite are accepted here and
/// rejected when roots are requested.
///
/// # Example
/// ```
/// use phea_dynamics::linear::Polynomial;
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let p = Polynomial::new(vec![1.0, 3.0, 2.0]); // s^2 + 3 s + 2
/// let roots: Vec<f64> = p.roots()?.iter().map(|root| root.re).collect();
/// assert_eq!(roots, [-1.0, -2.0]);
/// assert_eq!(p.product(&p).coefficients(), [1.0, 6.0, 13.0, 12.0, 4.0]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Polynomial with these coefficients, highest power first; leading zeros are dropped.
    pub fn new(coefficients: Vec<f64>) -> Self {
        let first = coefficients.iter().position(|&c| c != 0.0).unwrap_or(coefficients.len());
        let kept: Vec<f64> = coefficients.into_iter().skip(first).collect();
        Polynomial { coefficients: if kept.is_empty() { vec![0.0] } else { kept } }
    }

    /// gain (s - r_1) (s - r_2) ...
    ///
    /// # Errors
    /// [`LinearError::MissingConjugate`] when the roots do not come in conjugate pairs,
    /// [`LinearError::NotFinite`].
    pub fn from_roots(gain: f64, roots: &[Complex64]) -> Result<Self, LinearError> {
        let roots = roots::conjugate_pairs(roots)?;
        if !gain.is_finite() {
            return Err(LinearError::NotFinite { what: LinearNumber::Gain });
        }
        Ok(Polynomial::expanded(gain, &roots))
    }

    /// Expansion of factors whose conjugate symmetry is already known.
    pub(crate) fn expanded(gain: f64, roots: &[Complex64]) -> Self {
        let wide = expand(gain, roots);
        Polynomial::new(wide.iter().map(|c| c.value()).collect())
    }

    /// Coefficients, highest power first.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Degree; zero for a constant, the zero polynomial included.
    pub fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// True if the polynomial is zero everywhere.
    pub fn is_zero(&self) -> bool {
        self.coefficients == [0.0]
    }

    /// Coefficient of the highest power.
    pub fn leading_coefficient(&self) -> f64 {
        self.coefficients.first().copied().unwrap_or(0.0)
    }

    /// Value p(s), by Horner's rule in twice the working precision.
    pub fn evaluate(&self, s: Complex64) -> Complex64 {
        self.evaluate_wide(s).value()
    }

    pub(crate) fn evaluate_wide(&self, s: Complex64) -> ComplexDoubleDouble {
        let point = ComplexDoubleDouble::from(s);
        let mut sum = ComplexDoubleDouble::default();
        for &coefficient in &self.coefficients {
            sum = sum * point + ComplexDoubleDouble::from(coefficient);
        }
        sum
    }

    /// Sum of |c_i| |s|^(n-i): the scale by which a value of p at s is judged as small or not.
    pub(crate) fn evaluate_magnitudes(&self, s: Complex64) -> f64 {
        let radius = magnitude(s);
        self.coefficients.iter().fold(0.0, |sum, c| sum * radius + c.abs())
    }

    /// Product of two polynomials.
    pub fn product(&self, other: &Polynomial) -> Polynomial {
        let mut sums = vec![DoubleDouble::ZERO; self.degree() + other.degree() + 1];
        for (i, &a) in self.coefficients.iter().enumerate() {
            for (j, &b) in other.coefficients.iter().enumerate() {
                if let Some(sum) = sums.get_mut(i + j) {
                    *sum = *sum + DoubleDouble::product_of(a, b);
                }
            }
        }
        Polynomial::new(sums.iter().map(|sum| sum.value()).collect())
    }

    /// Sum of two polynomials.
    pub fn sum(&self, other: &Polynomial) -> Polynomial {
        let length = self.coefficients.len().max(other.coefficients.len());
        let mut sums = vec![0.0; length];
        for polynomial in [self, other] {
            let offset = length - polynomial.coefficients.len();
            for (sum, c) in sums.iter_mut().skip(offset).zip(&polynomial.coefficients) {
                *sum += c;
            }
        }
        Polynomial::new(sums)
    }

    /// Polynomial times a number.
    pub fn scaled(&self, factor: f64) -> Polynomial {
        Polynomial::new(self.coefficients.iter().map(|c| c * factor).collect())
    }

    /// Derivative dp/ds.
    pub fn derivative(&self) -> Polynomial {
        let mut power = self.degree() as f64;
        let mut coefficients = Vec::with_capacity(self.degree());
        for c in self.coefficients.iter().take(self.degree()) {
            coefficients.push(c * power);
            power -= 1.0;
        }
        Polynomial::new(coefficients)
    }

    /// All roots, sorted by magnitude, in exact conjugate pairs.
    ///
    /// Zeros at the origin are exact. The others are found by the iteration of Ehrlich and Aberth
    /// from starting radii from the Newton polygon (Bini 1996), which finds roots of 1e-3 and 1e6
    /// together, and are polished with residuals in twice the working precision. Roots that a
    /// rounding of the coefficients makes indistinguishable are returned as one multiple root, and
    /// those that become indistinguishable from imaginary ones are on the axis.
    ///
    /// # Errors
    /// [`LinearError::ZeroPolynomial`], [`LinearError::NotFinite`],
    /// [`LinearError::RootsNotConverged`].
    pub fn roots(&self) -> Result<Vec<Complex64>, LinearError> {
        roots::of_polynomial(self)
    }

    /// All roots from points near them, such as those of a polynomial with nearly the same
    /// coefficients, for a fraction of the work; `None` if the iteration does not converge from
    /// there. A multiple root stays a cluster.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::linear::Polynomial;
    /// let [one, other] = [26.0, 27.0].map(|last| Polynomial::new(vec![1.0, 2.0, last]));
    /// let near = other.roots_near(&one.roots()?).ok_or("a pair again")?;
    /// assert!((near[1] - other.roots()?[1]).norm_sqr() < 1e-29);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn roots_near(&self, guesses: &[Complex64]) -> Option<Vec<Complex64>> {
        roots::near(self, guesses)
    }
}

/// Coefficients of gain (s - r_1) (s - r_2) ... in twice the working precision, conjugate pairs
/// adjacent.
pub(crate) fn expand(gain: f64, roots: &[Complex64]) -> Vec<DoubleDouble> {
    let mut coefficients = vec![DoubleDouble::from(gain)];
    for root in roots.iter().filter(|root| root.im >= 0.0) {
        let factor: &[DoubleDouble] = if root.im == 0.0 {
            &[1.0.into(), (-root.re).into()]
        } else {
            let squares =
                DoubleDouble::product_of(root.re, root.re) + DoubleDouble::product_of(root.im, root.im);
            &[1.0.into(), (-2.0 * root.re).into(), squares]
        };
        coefficients = multiply(&coefficients, factor);
    }
    coefficients
}

/// Product of two polynomials in twice the working precision.
pub(crate) fn multiply(left: &[DoubleDouble], right: &[DoubleDouble]) -> Vec<DoubleDouble> {
    let mut product = vec![DoubleDouble::ZERO; (left.len() + right.len()).saturating_sub(1)];
    for (i, &a) in left.iter().enumerate() {
        for (j, &b) in right.iter().enumerate() {
            if let Some(sum) = product.get_mut(i + j) {
                *sum = *sum + a * b;
            }
        }
    }
    product
}
