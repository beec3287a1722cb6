//! Discretisation of continuous systems.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::held::Held;
use super::matrix_exponential::ExactStep;
use super::realization::delay_states;
use super::structure::{Resolvent, widened};
use super::transfer_function::TransferFunction;
use super::{LinearError, LinearNumber, LinearOperation, StateSpace, TimeDomain, realization, zeros};
use crate::portable::{cos, exp, expm1, sin, tan};

/// Method that discretises a continuous system.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Discretization {
    /// Trapezoidal rule, s = (2/T) (z - 1)/(z + 1).
    #[default]
    Tustin,
    /// Trapezoidal rule, scaled so that the response is exact at one frequency.
    PrewarpedTustin {
        /// Frequency in rad/s at which the responses agree, below pi/T.
        frequency_rad_per_s: f64,
    },
    /// Hold, exact at the samples for an input that is constant between them (a converter's
    /// output).
    ZeroOrderHold,
    /// Zeros and poles mapped by z = exp(sT); all but one zero at infinity go to z = -1; the gain
    /// agrees at low frequency.
    Matched,
}

impl TransferFunction {
    /// Sampled system; poles are mapped one by one, never through coefficients.
    ///
    /// A dead time must be a whole number of samples, except for the zero-order hold, which takes
    /// any: a fraction of a sample adds a pole at z = 0.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`], [`LinearError::SampleTime`], [`LinearError::Improper`],
    /// [`LinearError::FractionalDeadTime`], [`LinearError::Frequency`] for a prewarping frequency
    /// at or above pi/T, [`LinearError::NoImage`] when a root has no image under Tustin's map.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_dynamics::linear::{Discretization, TransferFunction};
    /// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
    /// let integrator = TransferFunction::from_factors(1.0, vec![], vec![Complex64::new(0.0, 0.0)])?;
    /// let sampled = integrator.discretized(0.5, Discretization::ZeroOrderHold)?;
    /// assert_eq!((sampled.gain(), sampled.poles()[0].re), (0.5, 1.0)); // 0.5/(z - 1)
    /// let trapezoidal = integrator.discretized(0.5, Discretization::Tustin)?;
    /// assert_eq!((trapezoidal.gain(), trapezoidal.zeros()[0].re), (0.25, -1.0)); // 0.25 (z + 1)/(z - 1)
    /// # Ok(())
    /// # }
    /// ```
    pub fn discretized(&self, sample_time_s: f64, method: Discretization) -> Result<Self, LinearError> {
        check_continuous(self.domain(), sample_time_s)?;
        if !self.is_proper() {
            return Err(LinearError::Improper { zeros: self.zeros().len(), poles: self.poles().len() });
        }
        match method {
            Discretization::Tustin => self.bilinear(2.0 / sample_time_s, sample_time_s),
            Discretization::PrewarpedTustin { frequency_rad_per_s } => {
                self.bilinear(prewarped(frequency_rad_per_s, sample_time_s)?, sample_time_s)
            }
            Discretization::ZeroOrderHold => self.held(sample_time_s),
            Discretization::Matched => self.matched(sample_time_s),
        }
    }

    /// Bilinear image of every zero and pole.
    ///
    /// ```text
    /// z = (kappa + s)/(kappa - s)          s - r contributes (kappa - r)/(z + 1) to the gain
    /// ```
    fn bilinear(&self, kappa: f64, sample_time_s: f64) -> Result<Self, LinearError> {
        let centre = Complex64::new(kappa, 0.0);
        if self.zeros().iter().chain(self.poles()).any(|root| *root == centre) {
            return Err(LinearError::NoImage { root_rad_per_s: kappa });
        }
        let image = |root: &Complex64| (centre + root) / (centre - root);
        let mut zeros: Vec<Complex64> = self.zeros().iter().map(image).collect();
        zeros.resize(self.poles().len(), Complex64::new(-1.0, 0.0));
        let poles: Vec<Complex64> = self.poles().iter().map(image).collect();
        self.sampled_with(self.evaluate_rational(centre).re, zeros, poles, sample_time_s)
    }

    fn matched(&self, sample_time_s: f64) -> Result<Self, LinearError> {
        let image = |root: &Complex64| exponential_of(root * sample_time_s);
        let mut zeros: Vec<Complex64> = self.zeros().iter().map(image).collect();
        let at_infinity = self.poles().len() - zeros.len();
        zeros.extend(std::iter::repeat_n(Complex64::new(-1.0, 0.0), at_infinity.saturating_sub(1)));
        let poles: Vec<Complex64> = self.poles().iter().map(image).collect();
        // low-frequency asymptotes: a factor s - r is -r, its image 1 - exp(rT); a factor s is s,
        // its image sT
        let mut gain = Complex64::new(self.gain(), 0.0);
        for index in 0..self.poles().len() {
            if let Some(zero) = self.zeros().get(index) {
                gain /= low_frequency_ratio(*zero, sample_time_s);
            }
            gain *= low_frequency_ratio(self.poles()[index], sample_time_s);
        }
        (1..at_infinity).for_each(|_| gain /= 2.0);
        self.sampled_with(gain.re, zeros, poles, sample_time_s)
    }

    fn held(&self, sample_time_s: f64) -> Result<Self, LinearError> {
        let (whole, fraction) = split_dead_time(self.dead_time_s(), sample_time_s);
        let held = Held::new(realization::chain_of(self)?, self.poles(), sample_time_s, fraction)?;
        let own: Vec<Complex64> =
            self.poles().iter().map(|pole| exponential_of(pole * sample_time_s)).collect();
        let mut poles = own.clone();
        poles.extend((fraction != 0.0).then_some(Complex64::new(0.0, 0.0)));
        let factors = match held.factors(&own)? {
            _ if self.gain() == 0.0 => (0.0, Vec::new()),
            Some(factors) => factors,
            None => {
                let states = realization::cascade(&self.clone().with_dead_time(0.0)?)?;
                let system = held_with_fraction(&states, sample_time_s, fraction)?;
                let (gain, zeros) = zeros::of_channel(&system, &poles)?;
                if !held.agrees_with(gain, &zeros, &own) {
                    return Err(LinearError::SampledZeros { order: poles.len() });
                }
                (gain, zeros)
            }
        };
        let (gain, zeros) = factors;
        TransferFunction::assembled(gain, zeros, poles, TimeDomain::Discrete { sample_time_s })
            .with_dead_time(whole * sample_time_s)
    }

    fn sampled_with(
        &self,
        gain: f64,
        zeros: Vec<Complex64>,
        poles: Vec<Complex64>,
        sample_time_s: f64,
    ) -> Result<Self, LinearError> {
        if !gain.is_finite() {
            return Err(LinearError::NotFinite { what: LinearNumber::SampledGain });
        }
        let domain = TimeDomain::Discrete { sample_time_s };
        TransferFunction::assembled(gain, zeros, poles, domain).with_dead_time(self.dead_time_s())
    }
}

impl StateSpace {
    /// Sampled system by Tustin's rule (prewarped or not) or an exact zero-order hold.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`] (also for [`Discretization::Matched`], which is for transfer
    /// functions), [`LinearError::SampleTime`], [`LinearError::Frequency`],
    /// [`LinearError::NoImage`].
    pub fn discretized(&self, sample_time_s: f64, method: Discretization) -> Result<Self, LinearError> {
        check_continuous(self.domain(), sample_time_s)?;
        match method {
            Discretization::Tustin => self.trapezoidal(2.0 / sample_time_s, sample_time_s),
            Discretization::PrewarpedTustin { frequency_rad_per_s } => {
                self.trapezoidal(prewarped(frequency_rad_per_s, sample_time_s)?, sample_time_s)
            }
            Discretization::ZeroOrderHold => held_with_fraction(self, sample_time_s, 0.0),
            Discretization::Matched => Err(LinearError::WrongDomain {
                operation: LinearOperation::MatchedDiscretisation,
                needed: "factored",
            }),
        }
    }

    /// Exact zero-order hold of the system, with input dead time that becomes states.
    ///
    /// # Errors
    /// [`LinearError::WrongDomain`], [`LinearError::SampleTime`], [`LinearError::DeadTime`],
    /// [`LinearError::TooManyDelayStates`].
    pub fn held_with_dead_time(&self, sample_time_s: f64, dead_time_s: f64) -> Result<Self, LinearError> {
        check_continuous(self.domain(), sample_time_s)?;
        if !(dead_time_s.is_finite() && dead_time_s >= 0.0) {
            return Err(LinearError::DeadTime { dead_time_s });
        }
        let (whole, fraction) = split_dead_time(dead_time_s, sample_time_s);
        let mut result = held_with_fraction(self, sample_time_s, fraction)?;
        let inputs = self.inputs();
        let identity = DMatrix::identity(inputs, inputs);
        for _ in 0..delay_states(whole)? {
            let none = DMatrix::zeros(inputs, inputs);
            let sample =
                StateSpace::new(none.clone(), identity.clone(), identity.clone(), none, result.domain())?;
            result = sample.series(&result)?;
        }
        Ok(result)
    }

    /// Bilinear image of the states, with matching inputs and outputs.
    ///
    /// ```text
    /// A_d = (kappa + A)(kappa - A)^-1,     kappa = 2/T
    /// ```
    fn trapezoidal(&self, kappa: f64, sample_time_s: f64) -> Result<Self, LinearError> {
        let order = self.order();
        let resolvent = Resolvent::new(self.a(), Complex64::new(kappa, 0.0));
        let solve = |right: &DMatrix<f64>| -> Result<DMatrix<f64>, LinearError> {
            let mut solution = DMatrix::zeros(order, right.ncols());
            for (index, column) in right.column_iter().enumerate() {
                let states = resolvent.solve(&widened(column.iter()));
                let states = states.ok_or(LinearError::NoImage { root_rad_per_s: kappa })?;
                solution
                    .set_column(index, &DVector::from_iterator(order, states.iter().map(|x| x.value().re)));
            }
            Ok(solution)
        };
        // (kappa + A)(kappa - A)^-1 = 2 kappa (kappa - A)^-1 - I
        let identity = DMatrix::<f64>::identity(order, order);
        let inverse = solve(&identity)?;
        let inputs = solve(self.b())?;
        let a = &inverse * (2.0 * kappa) - &identity;
        let d = self.d() + self.c() * &inputs;
        let outputs = self.c() * &inverse * (2.0 * kappa);
        StateSpace::new(a, inputs, outputs, d, TimeDomain::Discrete { sample_time_s })
    }
}

/// Exact zero-order hold with an input dead time of a fraction of a sample.
fn held_with_fraction(
    system: &StateSpace,
    sample_time_s: f64,
    fraction_s: f64,
) -> Result<StateSpace, LinearError> {
    let domain = TimeDomain::Discrete { sample_time_s };
    let (order, inputs) = (system.order(), system.inputs());
    let whole = ExactStep::new(system.a(), system.b(), sample_time_s);
    if fraction_s == 0.0 {
        return StateSpace::new(
            whole.transition(),
            whole.constant,
            system.c().clone(),
            system.d().clone(),
            domain,
        );
    }
    // the previous input acts until the fraction has passed, the current one for the rest
    let early = ExactStep::new(system.a(), system.b(), fraction_s);
    let rest_s = sample_time_s - fraction_s;
    let other = (rest_s != fraction_s).then(|| ExactStep::new(system.a(), system.b(), rest_s));
    let late = other.as_ref().unwrap_or(&early);
    let mut a = DMatrix::zeros(order + inputs, order + inputs);
    a.view_mut((0, 0), (order, order)).copy_from(&whole.transition());
    a.view_mut((0, order), (order, inputs)).copy_from(&(late.transition() * &early.constant));
    let mut b = DMatrix::zeros(order + inputs, inputs);
    b.view_mut((0, 0), (order, inputs)).copy_from(&late.constant);
    b.view_mut((order, 0), (inputs, inputs)).fill_with_identity();
    let mut c = DMatrix::zeros(system.outputs(), order + inputs);
    c.view_mut((0, 0), (system.outputs(), order)).copy_from(system.c());
    c.view_mut((0, order), (system.outputs(), inputs)).copy_from(system.d());
    StateSpace::new(a, b, c, DMatrix::zeros(system.outputs(), inputs), domain)
}

fn check_continuous(domain: TimeDomain, sample_time_s: f64) -> Result<(), LinearError> {
    if domain != TimeDomain::Continuous {
        return Err(LinearError::WrongDomain {
            operation: LinearOperation::Discretisation,
            needed: "continuous",
        });
    }
    if !(sample_time_s.is_finite() && sample_time_s > 0.0) {
        return Err(LinearError::SampleTime { sample_time_s });
    }
    Ok(())
}

/// Factor kappa with which the bilinear image is exact at w.
///
/// ```text
/// s = kappa (z - 1)/(z + 1),     kappa = w/tan(w T/2)
/// ```
pub(super) fn prewarped(frequency_rad_per_s: f64, sample_time_s: f64) -> Result<f64, LinearError> {
    let half_angle = frequency_rad_per_s * sample_time_s / 2.0;
    if !(half_angle > 0.0 && half_angle < std::f64::consts::FRAC_PI_2) {
        return Err(LinearError::Frequency { frequency_rad_per_s, operation: LinearOperation::Prewarping });
    }
    Ok(frequency_rad_per_s / tan(half_angle))
}

/// Whole samples of dead time, and the remainder in s; a remainder within rounding counts as none.
pub(super) fn split_dead_time(dead_time_s: f64, sample_time_s: f64) -> (f64, f64) {
    let samples = dead_time_s / sample_time_s;
    if (samples - samples.round()).abs() <= 1e-9 * samples.max(1.0) {
        return (samples.round(), 0.0);
    }
    (samples.floor(), dead_time_s - samples.floor() * sample_time_s)
}

pub(super) fn exponential_of(z: Complex64) -> Complex64 {
    let size = exp(z.re);
    if z.im == 0.0 { Complex64::new(size, 0.0) } else { Complex64::new(size * cos(z.im), size * sin(z.im)) }
}

/// Low-frequency value of the image of a factor over that of the factor.
///
/// ```text
/// (1 - exp(r T))/(-r),     T for r = 0
/// ```
fn low_frequency_ratio(root: Complex64, sample_time_s: f64) -> Complex64 {
    if root == Complex64::new(0.0, 0.0) {
        return Complex64::new(sample_time_s, 0.0);
    }
    let z = root * sample_time_s;
    let half = sin(z.im / 2.0);
    let growth = exp(z.re);
    Complex64::new(expm1(z.re) - 2.0 * growth * half * half, growth * sin(z.im)) / root
}
