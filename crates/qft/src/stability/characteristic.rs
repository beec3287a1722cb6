use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::PlantCoefficients;

use super::product::{RootProduct, products};
use super::{Compensation, Irresolution};

/// The path from the output back to the plant, as polynomials: G H in a continuous loop, G in a
/// sampled one (whose sensor is sampled together with the plant).
#[derive(Clone, Debug)]
pub(crate) struct FeedbackPath {
    numerator: Polynomial,
    denominator: Polynomial,
    /// Root products of a sampled loop.
    products: Option<[RootProduct; 2]>,
    dead_time_s: f64,
    domain: TimeDomain,
}

/// The characteristic equation of one loop, without cancelled factors.
///
/// ```text
/// continuous:  c(s) + n(s) e^(-s T) = 0            c = D Gd Hd,  n = N Gn Hn
/// sampled:     c(v) + n(v) z^(-k) = 0,  v = z - 1
/// ```
///
/// Around z = 1, where slow poles are crowded, v retains the digits that z would lose. `delay` is T
/// in s or k in samples; the stability boundary is parametrised by an angle, w in rad/s or w T in
/// rad. A sampled loop is evaluated by its products; its polynomials provide the starting points of
/// searches for roots.
#[derive(Clone, Debug)]
pub(super) struct Characteristic {
    pub(super) denominator: Polynomial,
    pub(super) numerator: Polynomial,
    /// Numerator and denominator of a sampled loop.
    pub(super) products: Option<[RootProduct; 2]>,
    pub(super) delay: f64,
    pub(super) domain: TimeDomain,
}

impl FeedbackPath {
    pub(crate) fn new(compensation: &Compensation) -> Result<FeedbackPath, Irresolution> {
        let (feedback, sensor) = (compensation.feedback(), compensation.sensor());
        let domain = feedback.domain();
        let (numerator, denominator) = polynomials(feedback)?;
        if domain != TimeDomain::Continuous {
            let products = Some(products(feedback));
            let dead_time_s = feedback.dead_time_s();
            return Ok(FeedbackPath { numerator, denominator, products, dead_time_s, domain });
        }
        let (sensor_numerator, sensor_denominator) = polynomials(sensor)?;
        Ok(FeedbackPath {
            numerator: numerator.product(&sensor_numerator),
            denominator: denominator.product(&sensor_denominator),
            products: None,
            dead_time_s: feedback.dead_time_s() + sensor.dead_time_s(),
            domain,
        })
    }

    /// The loop around a continuous plant, whose dead time includes that of the loop.
    pub(super) fn around(&self, plant: &PlantCoefficients<f64>) -> Result<Characteristic, Irresolution> {
        if self.domain != TimeDomain::Continuous {
            return Err(Irresolution::Linear(LinearError::DomainMismatch));
        }
        let denominator = Polynomial::new(plant.command.denominator.clone()).product(&self.denominator);
        let numerator = Polynomial::new(plant.command.numerator.clone()).product(&self.numerator);
        self.closed(numerator, denominator, plant.dead_time_s + self.dead_time_s)
    }

    /// The loop around a plant with its sensor, held and sampled.
    pub(super) fn around_sampled(&self, plant: &TransferFunction) -> Result<Characteristic, Irresolution> {
        let TimeDomain::Discrete { sample_time_s } = self.domain else {
            return Err(Irresolution::Linear(LinearError::DomainMismatch));
        };
        if plant.domain() != self.domain {
            return Err(Irresolution::Linear(LinearError::DomainMismatch));
        }
        let (numerator, denominator) = polynomials(plant)?;
        let samples = ((plant.dead_time_s() + self.dead_time_s) / sample_time_s).round();
        let closed =
            self.closed(numerator.product(&self.numerator), denominator.product(&self.denominator), samples)?;
        let own = products(plant);
        let joined = self.products.as_ref().map(|[n, c]| [own[0].times(n), own[1].times(c)]);
        Ok(Characteristic { products: joined, ..closed })
    }

    fn closed(
        &self,
        numerator: Polynomial,
        denominator: Polynomial,
        delay: f64,
    ) -> Result<Characteristic, Irresolution> {
        if denominator.is_zero() {
            return Err(Irresolution::Linear(LinearError::ZeroPolynomial));
        }
        if !(delay.is_finite() && delay >= 0.0) {
            let dead_time_s = delay * time_unit(self.domain);
            return Err(Irresolution::Linear(LinearError::DeadTime { dead_time_s }));
        }
        Ok(Characteristic { denominator, numerator, products: None, delay, domain: self.domain })
    }
}

/// Numerator and denominator in s, or in v = z - 1.
fn polynomials(function: &TransferFunction) -> Result<(Polynomial, Polynomial), Irresolution> {
    if function.domain() == TimeDomain::Continuous {
        return Ok((function.numerator(), function.denominator()));
    }
    let shifted = |roots: &[Complex64]| roots.iter().map(|root| root - 1.0).collect::<Vec<_>>();
    Ok((
        Polynomial::from_roots(function.gain(), &shifted(function.zeros())).map_err(Irresolution::Linear)?,
        Polynomial::from_roots(1.0, &shifted(function.poles())).map_err(Irresolution::Linear)?,
    ))
}

impl Characteristic {
    /// Boundary point s = j w, or v = e^(j w T) - 1 without cancellation.
    pub(super) fn boundary_point(&self, angle: f64) -> Complex64 {
        match self.domain {
            TimeDomain::Continuous => Complex64::new(0.0, angle),
            TimeDomain::Discrete { .. } => {
                let half = portable::sin(angle / 2.0);
                Complex64::new(-2.0 * half * half, portable::sin(angle))
            }
        }
    }

    /// Phase factor e^(-j angle delay).
    pub(super) fn lag(&self, angle: f64) -> Complex64 {
        if self.delay == 0.0 {
            return Complex64::new(1.0, 0.0);
        }
        let turn = -angle * self.delay;
        Complex64::new(portable::cos(turn), portable::sin(turn))
    }

    /// Values of c, and of n with its delay, on the stability boundary.
    pub(super) fn at(&self, angle: f64) -> (Complex64, Complex64) {
        let point = self.boundary_point(angle);
        let (denominator, numerator) = match &self.products {
            Some([numerator, denominator]) => (denominator.at(point), numerator.at(point)),
            None => (evaluate(&self.denominator, point), evaluate(&self.numerator, point)),
        };
        (denominator, numerator * self.lag(angle))
    }

    /// Frequency, rad/s.
    pub(super) fn frequency(&self, angle: f64) -> f64 {
        angle / self.time_unit()
    }

    /// Unit of `delay`, and inverse of the unit of the angle: 1 s, or the sample time, s.
    pub(super) fn time_unit(&self) -> f64 {
        time_unit(self.domain)
    }

    /// Ratio n_0/c_0, the gain of the loop at infinite frequency; `None` for an improper loop.
    pub(super) fn gain_at_infinity(&self) -> Option<f64> {
        match self.numerator.degree().cmp(&self.denominator.degree()) {
            std::cmp::Ordering::Less => Some(0.0),
            std::cmp::Ordering::Equal => {
                Some(self.numerator.leading_coefficient() / self.denominator.leading_coefficient())
            }
            std::cmp::Ordering::Greater => None,
        }
    }

    /// Degree of f in z, including the (signed) contribution of the delay.
    pub(super) fn sampled_degree(&self) -> f64 {
        let numerator = self.numerator.degree() as f64 - self.delay;
        let numerator = if self.numerator.is_zero() { 0.0 } else { numerator };
        (self.denominator.degree() as f64).max(numerator)
    }

    /// True if a dead time makes infinitely many poles unstable.
    pub(super) fn has_gain_above_one_at_infinity(&self) -> bool {
        self.domain == TimeDomain::Continuous
            && self.delay > 0.0
            && self.gain_at_infinity().is_none_or(|gain| gain.abs() > 1.0)
    }
}

impl Characteristic {
    /// The equation whose poles have real parts reduced by this, 1/s.
    ///
    /// ```text
    /// continuous:  s = a + s'                    sampled:  z = r z', v = (r - 1) + r v', r = e^(a T)
    /// ```
    pub(super) fn moved(&self, real_part: f64) -> Characteristic {
        let growth = real_part * self.time_unit();
        let (shift, scale) = match self.domain {
            TimeDomain::Continuous => (real_part, 1.0),
            TimeDomain::Discrete { .. } => (portable::expm1(growth), portable::exp(growth)),
        };
        let products = self.products.as_ref().map(|[numerator, denominator]| {
            let excess = numerator.roots.len() as f64 - denominator.roots.len() as f64 - self.delay;
            let moved = numerator.moved(shift);
            let gain = moved.gain * portable::exp(growth * excess);
            [RootProduct { gain, ..moved }, denominator.moved(shift)]
        });
        Characteristic {
            denominator: substituted(&self.denominator, shift, scale),
            numerator: substituted(&self.numerator, shift, scale)
                .scaled(portable::exp(-real_part * self.delay * self.time_unit())),
            products,
            ..*self
        }
    }
}

/// Polynomial p(shift + scale s) by Horner's rule.
fn substituted(polynomial: &Polynomial, shift: f64, scale: f64) -> Polynomial {
    let factor = Polynomial::new(vec![scale, shift]);
    polynomial
        .coefficients()
        .iter()
        .fold(Polynomial::new(vec![0.0]), |sum, &c| sum.product(&factor).sum(&Polynomial::new(vec![c])))
}

fn time_unit(domain: TimeDomain) -> f64 {
    match domain {
        TimeDomain::Continuous => 1.0,
        TimeDomain::Discrete { sample_time_s } => sample_time_s,
    }
}

/// Evaluates a polynomial by Horner's rule in working precision.
pub(super) fn evaluate(polynomial: &Polynomial, point: Complex64) -> Complex64 {
    polynomial.coefficients().iter().fold(Complex64::new(0.0, 0.0), |sum, &c| sum * point + c)
}
