//! Transfer functions stored as gain, zeros, poles and dead time.

use num_complex::Complex64;

use super::{LinearError, LinearNumber, LinearOperation, Polynomial, TimeDomain, roots};
use crate::portable::{self, exp_complex};

/// A single-input, single-output system in factored form.
///
/// ```text
/// P(s) = k (s - z_1) (s - z_2) ... / ((s - p_1) (s - p_2) ...) exp(-s tau)
/// ```
///
/// In [`TimeDomain::Discrete`] the variable is z and the dead time, a whole number of samples, is
/// z^(-tau/T). The gain k is the leading coefficient, not the gain at zero frequency
/// ([`TransferFunction::dc_gain`]). Zeros and poles are sorted by magnitude in exact conjugate
/// pairs. Common factors are kept until [`TransferFunction::without_common_factors`] cancels them.
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let poles = vec![Complex64::new(-3.0, 4.0), Complex64::new(-3.0, -4.0)];
/// let resonance = TransferFunction::from_factors(50.0, vec![], poles)?;
/// assert_eq!(resonance.dc_gain(), 2.0);
/// assert_eq!(resonance.denominator().coefficients(), [1.0, 6.0, 25.0]);
/// assert_eq!(resonance.at_frequency(5.0), Complex64::new(0.0, -50.0 / 30.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    gain: f64,
    zeros: Vec<Complex64>,
    poles: Vec<Complex64>,
    dead_time_s: f64,
    domain: TimeDomain,
}

impl TransferFunction {
    /// A continuous system from its leading coefficient, zeros and poles (rad/s).
    ///
    /// # Errors
    /// [`LinearError::MissingConjugate`] when complex factors do not come in conjugate pairs
    /// (partners may differ by 1e-12 of their magnitude and are averaged),
    /// [`LinearError::NotFinite`].
    pub fn from_factors(
        gain: f64,
        zeros: Vec<Complex64>,
        poles: Vec<Complex64>,
    ) -> Result<Self, LinearError> {
        if !gain.is_finite() {
            return Err(LinearError::NotFinite { what: LinearNumber::Gain });
        }
        let (zeros, poles) = (roots::conjugate_pairs(&zeros)?, roots::conjugate_pairs(&poles)?);
        Ok(TransferFunction::assembled(gain, zeros, poles, TimeDomain::Continuous))
    }

    /// A continuous system from numerator and denominator; their roots are found here, once.
    ///
    /// # Errors
    /// [`LinearError::ZeroPolynomial`] for a zero denominator, and those of [`Polynomial::roots`].
    pub fn from_polynomials(numerator: &Polynomial, denominator: &Polynomial) -> Result<Self, LinearError> {
        let poles = denominator.roots()?;
        let zeros = if numerator.is_zero() { Vec::new() } else { numerator.roots()? };
        let gain = numerator.leading_coefficient() / denominator.leading_coefficient();
        if !gain.is_finite() {
            return Err(LinearError::NotFinite { what: LinearNumber::Gain });
        }
        Ok(TransferFunction::assembled(gain, zeros, poles, TimeDomain::Continuous))
    }

    /// Constant gain. One that is not finite gives responses that are not finite.
    pub fn gain_only(gain: f64) -> Self {
        TransferFunction::assembled(gain, Vec::new(), Vec::new(), TimeDomain::Continuous)
    }

    /// System of factors that are already sorted and in conjugate pairs. A system with zero gain
    /// has no zeros.
    pub(crate) fn assembled(
        gain: f64,
        mut zeros: Vec<Complex64>,
        mut poles: Vec<Complex64>,
        domain: TimeDomain,
    ) -> Self {
        if gain == 0.0 {
            zeros.clear();
        }
        super::refinement::sort(&mut zeros);
        super::refinement::sort(&mut poles);
        TransferFunction { gain, zeros, poles, dead_time_s: 0.0, domain }
    }

    /// System with this dead time in s, in place of its own.
    ///
    /// # Errors
    /// [`LinearError::DeadTime`] when negative or not finite; [`LinearError::FractionalDeadTime`]
    /// in a sampled system when it is not a whole number of samples.
    pub fn with_dead_time(mut self, dead_time_s: f64) -> Result<Self, LinearError> {
        if !(dead_time_s.is_finite() && dead_time_s >= 0.0) {
            return Err(LinearError::DeadTime { dead_time_s });
        }
        if let TimeDomain::Discrete { sample_time_s } = self.domain {
            let samples = dead_time_s / sample_time_s;
            if (samples - samples.round()).abs() > 1e-9 * samples.max(1.0) {
                return Err(LinearError::FractionalDeadTime { dead_time_s, sample_time_s });
            }
        }
        self.dead_time_s = dead_time_s;
        Ok(self)
    }

    /// Factors of this system, interpreted in another time domain.
    ///
    /// # Errors
    /// [`LinearError::SampleTime`], and [`LinearError::FractionalDeadTime`] when the dead time does
    /// not fit.
    pub fn in_domain(mut self, domain: TimeDomain) -> Result<Self, LinearError> {
        if let TimeDomain::Discrete { sample_time_s } = domain
            && !(sample_time_s.is_finite() && sample_time_s > 0.0)
        {
            return Err(LinearError::SampleTime { sample_time_s });
        }
        self.domain = domain;
        let dead_time_s = self.dead_time_s;
        self.with_dead_time(dead_time_s)
    }

    /// Leading coefficient k.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// Zeros, sorted by magnitude, in exact conjugate pairs.
    pub fn zeros(&self) -> &[Complex64] {
        &self.zeros
    }

    /// Poles, sorted by magnitude, in exact conjugate pairs.
    pub fn poles(&self) -> &[Complex64] {
        &self.poles
    }

    /// Dead time in s.
    pub fn dead_time_s(&self) -> f64 {
        self.dead_time_s
    }

    /// Time domain.
    pub fn domain(&self) -> TimeDomain {
        self.domain
    }

    /// Numerator k (s - z_1) (s - z_2) ..., without dead time.
    pub fn numerator(&self) -> Polynomial {
        Polynomial::expanded(self.gain, &self.zeros)
    }

    /// Denominator (s - p_1) (s - p_2) ..., leading coefficient one.
    pub fn denominator(&self) -> Polynomial {
        Polynomial::expanded(1.0, &self.poles)
    }

    /// True if the system has no more zeros than poles.
    pub(crate) fn is_proper(&self) -> bool {
        self.zeros.len() <= self.poles.len()
    }

    /// Value P(s), or P(z) for a sampled system, from the factors. At a pole the value is infinite.
    pub fn evaluate(&self, s: Complex64) -> Complex64 {
        let rational = self.evaluate_rational(s);
        if self.dead_time_s == 0.0 {
            return rational;
        }
        match self.domain {
            TimeDomain::Continuous => rational * exp_complex(-s * self.dead_time_s),
            TimeDomain::Discrete { sample_time_s } => {
                let samples = (self.dead_time_s / sample_time_s).round();
                let log = Complex64::new(portable::ln(portable::magnitude(s)), portable::argument(s));
                rational * exp_complex(-log * samples)
            }
        }
    }

    /// Response P(jw), or P(exp(jwT)) for a sampled system; `frequency` in rad/s. Dead time
    /// included.
    pub fn at_frequency(&self, frequency: f64) -> Complex64 {
        let rational = self.evaluate_rational(self.boundary_point(frequency));
        if self.dead_time_s == 0.0 {
            return rational;
        }
        let angle = -frequency * self.dead_time_s;
        rational * Complex64::new(portable::cos(angle), portable::sin(angle))
    }

    /// Point jw, or exp(jwT).
    pub(crate) fn boundary_point(&self, frequency: f64) -> Complex64 {
        match self.domain {
            TimeDomain::Continuous => Complex64::new(0.0, frequency),
            TimeDomain::Discrete { sample_time_s } => {
                let angle = frequency * sample_time_s;
                Complex64::new(portable::cos(angle), portable::sin(angle))
            }
        }
    }

    /// Rational part at s; zeros and poles are multiplied alternately, so that the product stays in
    /// range.
    pub(crate) fn evaluate_rational(&self, s: Complex64) -> Complex64 {
        if !s.is_finite() {
            return self.at_infinity();
        }
        let mut value = Complex64::new(self.gain, 0.0);
        let mut poles = self.poles.iter();
        let mut infinite = false;
        for zero in &self.zeros {
            value *= s - zero;
            if let Some(pole) = poles.next() {
                divide(&mut value, s - pole, &mut infinite);
            }
        }
        for pole in poles {
            divide(&mut value, s - pole, &mut infinite);
        }
        if infinite { Complex64::new(f64::INFINITY, 0.0) } else { value }
    }

    fn at_infinity(&self) -> Complex64 {
        match self.zeros.len().cmp(&self.poles.len()) {
            std::cmp::Ordering::Less => Complex64::new(0.0, 0.0),
            std::cmp::Ordering::Equal => Complex64::new(self.gain, 0.0),
            std::cmp::Ordering::Greater => Complex64::new(f64::INFINITY, 0.0),
        }
    }

    /// Gain at zero frequency: P(0), or P(z = 1). Infinite, with its sign, at an integrator.
    pub fn dc_gain(&self) -> f64 {
        if self.gain == 0.0 {
            return 0.0;
        }
        let point = self.boundary_point(0.0);
        let here = |roots: &[Complex64]| roots.iter().filter(|&&root| root == point).count();
        let (zeros, poles) = (here(&self.zeros), here(&self.poles));
        let elsewhere = |roots: &[Complex64]| roots.iter().copied().filter(|&root| root != point).collect();
        let (other_zeros, other_poles) = (elsewhere(&self.zeros), elsewhere(&self.poles));
        let rest = TransferFunction::assembled(self.gain, other_zeros, other_poles, self.domain);
        let value = rest.evaluate_rational(point).re;
        match zeros.cmp(&poles) {
            std::cmp::Ordering::Less => value * f64::INFINITY,
            std::cmp::Ordering::Equal => value,
            std::cmp::Ordering::Greater => 0.0,
        }
    }

    /// True if every pole lies strictly inside the stable region.
    pub fn is_stable(&self) -> bool {
        self.poles.iter().all(|&pole| is_stable_pole(pole, self.domain))
    }

    /// System without the poles and zeros that are within `relative_tolerance` of each other: real
    /// ones with real ones, complex pairs with complex pairs. The response is unchanged to about
    /// that tolerance.
    ///
    /// Their distance is relative to the magnitude of the pole in 1/s: a root z of a sampled system
    /// is compared as s = ln(z)/T. Near z = 1 all roots are close together, though one may decay a
    /// hundred times as fast as another.
    pub fn without_common_factors(&self, relative_tolerance: f64) -> Self {
        // each pair by its upper member
        let upper =
            |roots: &[Complex64]| roots.iter().copied().filter(|root| root.im >= 0.0).collect::<Vec<_>>();
        let (mut zeros, mut poles) = (upper(&self.zeros), Vec::new());
        for pole in upper(&self.poles) {
            let alike = |zero: &Complex64| (zero.im == 0.0) == (pole.im == 0.0);
            let distances = zeros.iter().enumerate().filter(|(_, zero)| alike(zero));
            let distances = distances.map(|(index, zero)| (index, self.relative_distance(*zero, pole)));
            match distances.min_by(|a, b| a.1.total_cmp(&b.1)) {
                Some((index, distance)) if distance <= relative_tolerance => {
                    zeros.remove(index);
                }
                _ => poles.push(pole),
            }
        }
        let mirrored = |roots: Vec<Complex64>| -> Vec<Complex64> {
            let lower = roots.iter().filter(|root| root.im > 0.0).map(|root| root.conj()).collect::<Vec<_>>();
            [roots, lower].concat()
        };
        let kept = TransferFunction::assembled(self.gain, mirrored(zeros), mirrored(poles), self.domain);
        TransferFunction { dead_time_s: self.dead_time_s, ..kept }
    }

    /// |s_zero - s_pole|/|s_pole|: 0 for equal roots, infinite where the pole is an integrator or a
    /// delay of whole samples.
    fn relative_distance(&self, zero: Complex64, pole: Complex64) -> f64 {
        if zero == pole {
            return 0.0;
        }
        let continuous = |root: Complex64| match self.domain {
            TimeDomain::Continuous => root,
            // ln z = s T: the sample time cancels in the ratio
            TimeDomain::Discrete { .. } => {
                Complex64::new(portable::ln(portable::magnitude(root)), portable::argument(root))
            }
        };
        let [zero, pole] = [zero, pole].map(continuous);
        let ratio = portable::magnitude(zero - pole) / portable::magnitude(pole);
        if ratio.is_nan() { f64::INFINITY } else { ratio }
    }

    /// Inverse 1/P; a system with dead time has none.
    ///
    /// # Errors
    /// [`LinearError::NoInverse`] for zero gain, [`LinearError::NotRational`] with dead time.
    pub fn inverse(&self) -> Result<Self, LinearError> {
        if self.dead_time_s != 0.0 {
            return Err(LinearError::NotRational { operation: LinearOperation::Inverse });
        }
        let gain = 1.0 / self.gain;
        if self.gain == 0.0 || !gain.is_finite() {
            return Err(LinearError::NoInverse);
        }
        Ok(TransferFunction::assembled(gain, self.poles.clone(), self.zeros.clone(), self.domain))
    }
}

fn divide(value: &mut Complex64, factor: Complex64, infinite: &mut bool) {
    if factor == Complex64::new(0.0, 0.0) {
        *infinite = true;
    } else {
        *value /= factor;
    }
}

/// True if a pole is in the open left half plane, or strictly inside the unit circle.
pub(crate) fn is_stable_pole(pole: Complex64, domain: TimeDomain) -> bool {
    match domain {
        TimeDomain::Continuous => pole.re < 0.0,
        TimeDomain::Discrete { .. } => portable::magnitude(pole) < 1.0,
    }
}
