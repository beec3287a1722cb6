//! The response of a structure, and its slopes, at fixed frequencies.

use num_complex::Complex64;
use phea_dynamics::controller::Timing;
use phea_dynamics::linear::{Discretization, LinearError, LinearOperation, TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::{Factor, NumberedFactor, Structure, StructureFactor};

/// Step of x for slopes of a controller sampled at each x.
const DIFFERENCE: f64 = 1e-5;

/// A structure in a loop, prepared for evaluation at its frequencies.
///
/// ```text
/// continuous                s = j w
/// Tustin                    s = j (2/T) tan(w T/2)       prewarped at v: 2/T becomes v/tan(v T/2)
/// zero-order hold, matched  the controller is sampled at each x, and its slopes are central differences
/// ```
///
/// # Example
/// Controller k/(s + 1) at 1 rad/s, and its change with ln k and with ln of its corner:
/// ```
/// use phea_dynamics::controller::Timing;
/// use phea_qft::loop_shaping::{StructureFactor, Structure};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let parts = vec![StructureFactor::RealPole { frequency: [0.1, 10.0] }];
/// let structure = Structure { sign: 1.0, gain: [0.1, 10.0], parts };
/// let response = structure.response(&Timing::default(), &[1.0])?;
/// let x = [0.0, 0.0];
/// let g = response.values(&x)?[0];
/// assert!((g.re - 0.5).abs() < 1e-15 && (g.im + 0.5).abs() < 1e-15);
/// let slopes = &response.slopes(&x)?[0]; // d ln G/d ln k = 1, d ln G/d ln p = s/(s + p)
/// assert!((slopes[0].re - 1.0).abs() < 1e-15 && (slopes[1].re - 0.5).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StructureResponse {
    structure: Structure,
    frequencies_rad_per_s: Vec<f64>,
    evaluation: Evaluation,
}

#[derive(Clone, Debug, PartialEq)]
enum Evaluation {
    /// Evaluation of the factors at points of the s plane, with the response of the fixed parts and
    /// the sign there.
    Factors(Vec<(Complex64, Complex64)>),
    /// Sampling of the controller.
    Sampling { sample_time_s: f64, discretization: Discretization },
}

impl Structure {
    /// Prepares this structure in a loop with this timing at these frequencies, rad/s, up to pi/T.
    ///
    /// # Errors
    /// A fixed element that is not a continuous transfer function; a sampled loop whose controller
    /// would have more zeros than poles, or whose sample time or prewarping frequency is invalid.
    pub fn response(
        &self,
        timing: &Timing,
        frequencies_rad_per_s: &[f64],
    ) -> Result<StructureResponse, LinearError> {
        let fixed = self.fixed()?;
        if fixed.domain() != TimeDomain::Continuous {
            return Err(LinearError::WrongDomain {
                operation: LinearOperation::LoopShaping,
                needed: "continuous",
            });
        }
        let [zeros, poles] = self.degrees()?;
        if timing.sample_time_s.is_some() && zeros > poles {
            return Err(LinearError::Improper { zeros, poles });
        }
        if let Some(period) = timing.sample_time_s {
            // rejects an invalid sample time or prewarping frequency
            TransferFunction::gain_only(1.0).discretized(period, timing.discretization)?;
        }
        let rational = fixed.clone().with_dead_time(0.0)?;
        let at = |frequency: f64, s: Complex64| {
            let turn = portable::exp_complex(Complex64::new(0.0, -frequency * fixed.dead_time_s()));
            (s, rational.evaluate(s) * turn * self.sign)
        };
        let factors = |point: &dyn Fn(f64) -> f64| {
            let points = frequencies_rad_per_s.iter().map(|&w| at(w, Complex64::new(0.0, point(w))));
            Evaluation::Factors(points.collect())
        };
        let warped = |scale: f64, sample_time_s: f64| {
            factors(&move |w: f64| scale * portable::tan(0.5 * w * sample_time_s))
        };
        let discretization = timing.discretization;
        let evaluation = match timing.sample_time_s {
            None => factors(&|w: f64| w),
            Some(sample_time_s) => match discretization.bilinear_rate(sample_time_s)? {
                Some(rate) => warped(rate, sample_time_s),
                None => Evaluation::Sampling { sample_time_s, discretization },
            },
        };
        Ok(StructureResponse {
            structure: self.clone(),
            frequencies_rad_per_s: frequencies_rad_per_s.to_vec(),
            evaluation,
        })
    }
}

impl StructureResponse {
    /// Response G at each frequency.
    ///
    /// # Errors
    /// A controller that cannot be sampled.
    pub fn values(&self, x: &[f64]) -> Result<Vec<Complex64>, LinearError> {
        match &self.evaluation {
            Evaluation::Factors(points) => {
                let (gain, numbers) = self.numbers(x);
                let at = |&(s, fixed): &(Complex64, Complex64)| {
                    numbers.iter().fold(fixed * gain, |product, (factor, [frequency, damping])| {
                        let value = factor.value(s / frequency, *damping);
                        if factor.power > 0.0 { product * value } else { product / value }
                    })
                };
                Ok(points.iter().map(at).collect())
            }
            &Evaluation::Sampling { sample_time_s, discretization } => {
                let continuous = self.structure.compensator(x).transfer_function()?;
                let sampled = continuous.discretized(sample_time_s, discretization)?;
                Ok(self.frequencies_rad_per_s.iter().map(|&w| sampled.at_frequency(w)).collect())
            }
        }
    }

    /// Slopes d ln G/dx at each frequency, for each x.
    ///
    /// # Errors
    /// A controller that cannot be sampled.
    pub fn slopes(&self, x: &[f64]) -> Result<Vec<Vec<Complex64>>, LinearError> {
        match &self.evaluation {
            Evaluation::Factors(points) => {
                let (_, numbers) = self.numbers(x);
                let own = |s| self.structure.of_free(self.factor_slopes(&numbers, s));
                Ok(points.iter().map(|(s, _)| own(*s)).collect())
            }
            Evaluation::Sampling { .. } => self.differences(x),
        }
    }

    fn differences(&self, x: &[f64]) -> Result<Vec<Vec<Complex64>>, LinearError> {
        let mut slopes = vec![Vec::with_capacity(x.len()); self.frequencies_rad_per_s.len()];
        for moved in 0..x.len() {
            let at = |step: f64| {
                let x: Vec<f64> =
                    x.iter().enumerate().map(|(k, &x)| if k == moved { x + step } else { x }).collect();
                self.values(&x)
            };
            let (below, above) = (at(-DIFFERENCE)?, at(DIFFERENCE)?);
            for ((slopes, below), above) in slopes.iter_mut().zip(below).zip(above) {
                slopes.push((above - below) / (above + below) / DIFFERENCE);
            }
        }
        Ok(slopes)
    }

    /// The gain, and the factors with frequency and damping ratio.
    fn numbers(&self, x: &[f64]) -> (f64, Vec<NumberedFactor>) {
        let mut numbers = self.structure.numbers(x).into_iter();
        let gain = numbers.next().unwrap_or(f64::NAN);
        let parts = self.structure.parts.iter();
        (gain, parts.flat_map(|part| part.numbered(&mut numbers)).collect())
    }

    /// Slopes of the factors: 1 for ln k; for a factor of power m
    ///
    /// ```text
    /// d ln q^m/d ln w = -m u q'(u)/q(u),      d ln q^m/d ln zeta = m 2 zeta u/q(u)
    /// ```
    ///
    /// The zeros of a notch have the natural frequency of its poles, and their damping ratio times
    /// the depth.
    fn factor_slopes(&self, numbers: &[NumberedFactor], s: Complex64) -> Vec<Complex64> {
        let mut slopes = Vec::with_capacity(1 + 2 * numbers.len());
        slopes.push(Complex64::ONE);
        let mut factors = numbers.iter().map(|&(factor, [frequency, damping])| {
            let u = s / frequency;
            let relative = factor.power * u / factor.value(u, damping);
            match factor.pair {
                true => [-relative * (2.0 * (u + damping)), relative * (2.0 * damping)],
                false => [-relative, Complex64::ZERO],
            }
        });
        let mut next = || factors.next().unwrap_or([Complex64::ZERO; 2]);
        for part in &self.structure.parts {
            match part {
                StructureFactor::Fixed(_) => {}
                StructureFactor::RealZero { .. } | StructureFactor::RealPole { .. } => slopes.push(next()[0]),
                StructureFactor::ZeroPair { .. } | StructureFactor::PolePair { .. } => slopes.extend(next()),
                StructureFactor::Notch { .. } => {
                    let [of_poles, of_zeros] = [next(), next()];
                    slopes.extend([of_poles[0] + of_zeros[0], of_poles[1] + of_zeros[1], of_zeros[1]]);
                }
            }
        }
        slopes
    }
}

impl Factor {
    /// Polynomial q(u) of u = s/w: u + 1, or u^2 + 2 zeta u + 1.
    fn value(self, u: Complex64, damping: f64) -> Complex64 {
        if self.pair { u * u + 2.0 * damping * u + 1.0 } else { u + 1.0 }
    }
}
