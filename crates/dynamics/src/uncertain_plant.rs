//! Interface of any plant to robust design: a rational function of s whose coefficients are
//! recorded expressions of named, bounded parameters; or, for a plant with waves, a response for
//! every value of the parameters.
//!
//! Robust design sees only this value, for any physical plant (valve, hose and cylinder, or a
//! formula in a file): it can evaluate a plant at any point of the parameter box, over numbers,
//! dual numbers or intervals, and so search and verify between the grid points.

mod followed;
mod numerators;
mod rational;
pub mod responding;

use numerators::RateLengths;
pub use numerators::RateNumerators;
pub use rational::RationalCoefficients;

use std::sync::Arc;

use num_complex::Complex64;

use crate::expression::{EvaluationMemo, Expression, Recorded};
use crate::portable;
use crate::scalar::{Interval, Scalar};
use crate::uncertain_plant::responding::{RespondingPlant, RespondingPlants};

/// Uncertain parameter: `minimum <= nominal <= maximum`, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertainParameter {
    /// Name in the project file.
    pub name: String,
    /// Value for plant 0.
    pub nominal: f64,
    /// Lower end of the box.
    pub minimum: f64,
    /// Upper end of the box.
    pub maximum: f64,
}

/// Spacing of the points of a parameter over its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Equal distances.
    #[default]
    Linear,
    /// Equal ratios; needs a positive lower bound.
    Logarithmic,
}

/// Member of an uncertain plant: command to force, load motion to force, dead time of the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantCoefficients<S> {
    /// Path from the command to the controlled output, P(s).
    pub command: RationalCoefficients<S>,
    /// Path from the disturbance (for an actuator: load position, Pd = F_e/X_L) to the output, if
    /// the plant has one.
    pub disturbance: Option<RationalCoefficients<S>>,
    /// Dead time in the command path, s.
    pub dead_time_s: S,
    /// The rate that a controller may feed forward, if the command moves it too (for an actuator:
    /// velocity of a load that yields); `None` if it is the derivative s of the disturbance.
    pub rate: Option<RateNumerators<S>>,
}

/// Error for an uncertain plant that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UncertainPlantError {
    /// A parameter's bounds do not enclose its nominal value, or are not finite.
    #[error("parameter `{name}`: {minimum} <= {nominal} <= {maximum} does not hold")]
    Bounds {
        /// Name of the parameter.
        name: String,
        /// Lower bound.
        minimum: f64,
        /// Nominal value.
        nominal: f64,
        /// Upper bound.
        maximum: f64,
    },
    /// Two parameters share a name.
    #[error("parameter `{0}` is listed twice")]
    Duplicate(String),
    /// A numerator or denominator without coefficients.
    #[error("the {0} has no coefficients")]
    Empty(&'static str),
}

/// Member of an uncertain plant.
#[derive(Clone, Debug)]
pub enum PlantMember {
    /// A quotient of polynomials with dead time.
    Rational(PlantCoefficients<f64>),
    /// A plant without polynomials.
    Responding(Arc<dyn RespondingPlant>),
}

/// Plant over a box of named parameters: rational with dead time, or known by its responses.
///
/// ```text
/// P(s, p) = (n_0(p) s^k + ... + n_k(p)) / (d_0(p) s^m + ... + d_m(p)) e^(-s T(p)),     p in the box
/// P(jw, p) = response of a [`RespondingPlant`]                                           p in the box
/// ```
///
/// # Example
/// P = k a/(s (s + a)) with a lag between 1 and 10 rad/s:
/// ```
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// let parameter = |name: &str| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 1.0, maximum: 10.0 };
/// let plant = UncertainPlant::record(vec![parameter("k"), parameter("a")], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0] * p[1]], denominator: vec![1.0.into(), p[1], 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let member = plant.coefficients(&[2.0, 5.0]).ok_or("a rational plant")?;
/// assert_eq!(member.command.denominator, vec![1.0, 5.0, 0.0]);
/// // |P(j 1)| = 2 * 5 / |j (j + 5)|
/// let response = plant.response(&[2.0, 5.0], 1.0).ok_or("a response")?;
/// assert!((response.norm_sqr() - 100.0 / 26.0).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct UncertainPlant {
    parameters: Vec<UncertainParameter>,
    equations: PlantEquations,
}

/// Equations of a plant.
#[derive(Clone, Debug)]
enum PlantEquations {
    Rational(RecordedPlant),
    Responding(Arc<dyn RespondingPlants>),
}

/// Recorded coefficients: command numerator, command denominator, then both of the disturbance
/// path, dead time, numerators of the rate.
#[derive(Clone, Debug, PartialEq)]
struct RecordedPlant {
    coefficients: Arc<Expression>,
    /// Coefficients by other operations, as tracked by polynomials; absent if the polynomials track
    /// `coefficients`.
    followed: Option<Arc<Expression>>,
    command: (usize, usize),
    disturbance: Option<(usize, usize)>,
    rate: Option<RateLengths>,
}

impl PartialEq for UncertainPlant {
    /// Plants without polynomials are equal if they are the same object.
    fn eq(&self, other: &UncertainPlant) -> bool {
        self.parameters == other.parameters
            && match (&self.equations, &other.equations) {
                (PlantEquations::Rational(one), PlantEquations::Rational(other)) => one == other,
                (PlantEquations::Responding(one), PlantEquations::Responding(other)) => {
                    Arc::ptr_eq(one, other)
                }
                _ => false,
            }
    }
}

impl UncertainPlant {
    /// Records the plant's coefficients as expressions of its parameters.
    ///
    /// # Errors
    /// Parameter whose bounds do not enclose its nominal value or that is listed twice; an empty
    /// polynomial.
    pub fn record<F>(
        parameters: Vec<UncertainParameter>,
        mut equations: F,
    ) -> Result<UncertainPlant, UncertainPlantError>
    where
        F: for<'tape> FnMut(&[Recorded<'tape>]) -> PlantCoefficients<Recorded<'tape>>,
    {
        UncertainPlant::recorded_by(parameters, &mut equations)
    }

    /// Plant without polynomials.
    ///
    /// # Errors
    /// Parameter whose bounds do not enclose its nominal value or that is listed twice.
    pub fn responding(
        parameters: Vec<UncertainParameter>,
        plants: Arc<dyn RespondingPlants>,
    ) -> Result<UncertainPlant, UncertainPlantError> {
        check_parameters(&parameters)?;
        Ok(UncertainPlant { parameters, equations: PlantEquations::Responding(plants) })
    }

    /// Parameters, in the order of their values.
    pub fn parameters(&self) -> &[UncertainParameter] {
        &self.parameters
    }

    /// True if it has polynomials.
    pub fn is_rational(&self) -> bool {
        matches!(self.equations, PlantEquations::Rational(_))
    }

    /// [`UncertainPlant::record`], compiled once for all equations.
    fn recorded_by(
        parameters: Vec<UncertainParameter>,
        equations: &mut dyn for<'tape> FnMut(&[Recorded<'tape>]) -> PlantCoefficients<Recorded<'tape>>,
    ) -> Result<UncertainPlant, UncertainPlantError> {
        check_parameters(&parameters)?;
        let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
        let mut command = (0, 0);
        let (mut disturbance, mut rate) = (None, None);
        let coefficients = Expression::record(&names, |recorded| {
            let plant = equations(recorded);
            command = lengths(&plant.command);
            disturbance = plant.disturbance.as_ref().map(lengths);
            rate = plant.rate.as_ref().map(RateNumerators::lengths);
            flatten(plant)
        });
        check_lengths(command)?;
        disturbance.map_or(Ok(()), check_lengths)?;
        let coefficients = Arc::new(coefficients);
        let recorded = RecordedPlant { coefficients, followed: None, command, disturbance, rate };
        Ok(UncertainPlant { parameters, equations: PlantEquations::Rational(recorded) })
    }

    fn recorded(&self) -> Option<&RecordedPlant> {
        match &self.equations {
            PlantEquations::Rational(recorded) => Some(recorded),
            PlantEquations::Responding(_) => None,
        }
    }

    /// Recorded coefficients: command numerator, command denominator, then both of the disturbance
    /// path, dead time, numerators of the rate. `None` for a plant without polynomials.
    pub fn expression(&self) -> Option<&Expression> {
        self.recorded().map(|recorded| &*recorded.coefficients)
    }

    /// Nominal values, plant 0 of every family.
    pub fn nominal(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.nominal).collect()
    }

    /// Plant with other nominal values, each limited to its bounds.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
    /// let gain = UncertainParameter { name: "k".into(), nominal: 2.0, minimum: 1.0, maximum: 3.0 };
    /// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
    ///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
    ///     disturbance: None,
    ///     dead_time_s: 0.0.into(),
    ///     rate: None,
    /// })?;
    /// assert_eq!(plant.with_nominal(&[9.0]).nominal(), vec![3.0]);
    /// # Ok::<(), phea_dynamics::uncertain_plant::UncertainPlantError>(())
    /// ```
    #[must_use]
    pub fn with_nominal(&self, values: &[f64]) -> UncertainPlant {
        let mut other = self.clone();
        for (parameter, value) in other.parameters.iter_mut().zip(values) {
            parameter.nominal = value.max(parameter.minimum).min(parameter.maximum);
        }
        other
    }

    /// Member at these parameter values; `None` if no plant exists. A rational plant exists for all
    /// values.
    pub fn member(&self, values: &[f64]) -> Option<PlantMember> {
        match &self.equations {
            PlantEquations::Rational(recorded) => Some(PlantMember::Rational(recorded.at(values))),
            PlantEquations::Responding(plants) => plants.at(values).map(PlantMember::Responding),
        }
    }

    /// Member at these parameter values, using stored results of earlier members.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::expression::EvaluationMemo;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
    /// let gain = UncertainParameter { name: "k".into(), nominal: 2.0, minimum: 1.0, maximum: 3.0 };
    /// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
    ///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
    ///     disturbance: None,
    ///     dead_time_s: 0.0.into(),
    ///     rate: None,
    /// })?;
    /// let member = plant.member_by(&mut EvaluationMemo::default(), &[1.5]).ok_or("a rational plant")?;
    /// assert_eq!(member.slow().command.numerator, vec![1.5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn member_by(&self, memo: &mut EvaluationMemo, values: &[f64]) -> Option<PlantMember> {
        match &self.equations {
            PlantEquations::Rational(recorded) => {
                let coefficients = recorded.sorted(memo.evaluate(&recorded.coefficients, values));
                Some(PlantMember::Rational(coefficients))
            }
            PlantEquations::Responding(_) => self.member(values),
        }
    }

    /// Member at these parameter values, over any scalar; `None` for a plant without polynomials.
    pub fn coefficients<S: Scalar>(&self, values: &[S]) -> Option<PlantCoefficients<S>> {
        self.recorded().map(|recorded| recorded.at(values))
    }

    /// Intervals that contain the coefficients of every member while the parameters vary over
    /// theirs; `None` for a plant without polynomials.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::scalar::Interval;
    /// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
    /// let mass = UncertainParameter { name: "m".into(), nominal: 1.0, minimum: 0.0, maximum: 2.0 };
    /// let plant = UncertainPlant::record(vec![mass], |p| PlantCoefficients {
    ///     command: RationalCoefficients { numerator: vec![1.0.into()], denominator: vec![p[0] - 0.5.into(), 1.0.into()] },
    ///     disturbance: None,
    ///     dead_time_s: 0.0.into(),
    ///     rate: None,
    /// })?;
    /// let enclosed = plant.enclosures(&[Interval::new(0.0, 2.0)]).ok_or("a rational plant")?;
    /// assert!(enclosed.command.denominator[0].has_both_signs()); // in between, a pole passes through infinity
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn enclosures(&self, parameters: &[Interval]) -> Option<PlantCoefficients<Interval>> {
        self.recorded().map(|recorded| recorded.sorted(recorded.coefficients.enclosures(parameters)))
    }

    /// P(j w) of the member at these parameter values, dead time included; `None` if there is no
    /// plant.
    pub fn response(&self, values: &[f64], frequency_rad_per_s: f64) -> Option<Complex64> {
        Some(match self.member(values)? {
            PlantMember::Responding(plant) => plant.response(frequency_rad_per_s)[0],
            PlantMember::Rational(plant) => {
                let angle = -frequency_rad_per_s * plant.dead_time_s;
                let delay = portable::exp_complex(Complex64::new(0.0, angle));
                plant.command.at_frequency(frequency_rad_per_s) * delay
            }
        })
    }
}

impl RecordedPlant {
    fn at<S: Scalar>(&self, values: &[S]) -> PlantCoefficients<S> {
        self.sorted(self.coefficients.evaluate(values))
    }

    fn sorted<S: Scalar>(&self, flat: Vec<S>) -> PlantCoefficients<S> {
        let mut flat = flat.into_iter();
        let mut rational = |(numerator, denominator): (usize, usize)| RationalCoefficients {
            numerator: flat.by_ref().take(numerator).collect(),
            denominator: flat.by_ref().take(denominator).collect(),
        };
        let command = rational(self.command);
        let disturbance = self.disturbance.map(&mut rational);
        let dead_time_s = flat.next().unwrap_or(S::from(0.0));
        let rate = self.rate.map(|lengths| RateNumerators::sorted(lengths, &mut flat));
        PlantCoefficients { command, disturbance, dead_time_s, rate }
    }
}

impl PlantMember {
    /// The plant itself, or the rational one to which it tends towards zero frequency.
    pub fn slow(&self) -> PlantCoefficients<f64> {
        match self {
            PlantMember::Rational(plant) => plant.clone(),
            PlantMember::Responding(plant) => plant.slow(),
        }
    }
}

fn check_parameters(parameters: &[UncertainParameter]) -> Result<(), UncertainPlantError> {
    for (index, parameter) in parameters.iter().enumerate() {
        let UncertainParameter { name, nominal, minimum, maximum } = parameter;
        let ordered = minimum <= nominal && nominal <= maximum && minimum.is_finite() && maximum.is_finite();
        if !ordered {
            return Err(UncertainPlantError::Bounds {
                name: name.clone(),
                minimum: *minimum,
                nominal: *nominal,
                maximum: *maximum,
            });
        }
        if parameters.iter().take(index).any(|earlier| earlier.name == *name) {
            return Err(UncertainPlantError::Duplicate(name.clone()));
        }
    }
    Ok(())
}

fn check_lengths((numerator, denominator): (usize, usize)) -> Result<(), UncertainPlantError> {
    match (numerator, denominator) {
        (0, _) => Err(UncertainPlantError::Empty("numerator")),
        (_, 0) => Err(UncertainPlantError::Empty("denominator")),
        _ => Ok(()),
    }
}

fn lengths<S>(rational: &RationalCoefficients<S>) -> (usize, usize) {
    (rational.numerator.len(), rational.denominator.len())
}

fn flatten<S>(plant: PlantCoefficients<S>) -> Vec<S> {
    let mut flat = plant.command.numerator;
    flat.extend(plant.command.denominator);
    if let Some(disturbance) = plant.disturbance {
        flat.extend(disturbance.numerator);
        flat.extend(disturbance.denominator);
    }
    flat.push(plant.dead_time_s);
    if let Some(rate) = plant.rate {
        flat.extend(rate.flat());
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(minimum: f64, nominal: f64, maximum: f64) -> UncertainParameter {
        UncertainParameter { name: "k".into(), nominal, minimum, maximum }
    }

    fn integrator<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![p[0]],
                denominator: vec![1.0.into(), 0.0.into()],
            },
            disturbance: Some(RationalCoefficients { numerator: vec![-p[0]], denominator: vec![2.0.into()] }),
            dead_time_s: 0.5.into(),
            rate: Some(RateNumerators {
                command: vec![p[0] + p[0]],
                disturbance: vec![3.0.into(), 0.0.into()],
                inner: Some([vec![p[0], 1.0.into()], vec![4.0.into()]]),
            }),
        }
    }

    #[test]
    fn all_paths_and_the_dead_time_come_back() {
        let plant = UncertainPlant::record(vec![parameter(1.0, 2.0, 3.0)], integrator).unwrap();
        let member = plant.coefficients(&[3.0]).unwrap();
        assert_eq!(
            member.command,
            RationalCoefficients { numerator: vec![3.0], denominator: vec![1.0, 0.0] }
        );
        assert_eq!(
            member.disturbance,
            Some(RationalCoefficients { numerator: vec![-3.0], denominator: vec![2.0] })
        );
        let inner = Some([vec![3.0, 1.0], vec![4.0]]);
        let rate = RateNumerators { command: vec![6.0], disturbance: vec![3.0, 0.0], inner };
        assert_eq!(member.rate, Some(rate));
        // ORIGIN: analytic, 3/(j pi) e^(-j pi/2) = -3/pi
        let response = plant.response(&[3.0], std::f64::consts::PI).unwrap();
        assert!((response - Complex64::new(-3.0 / std::f64::consts::PI, 0.0)).norm_sqr() < 1e-30);
    }

    #[test]
    fn impossible_boxes_are_refused() {
        for (minimum, nominal, maximum) in
            [(2.0, 1.0, 3.0), (1.0, 4.0, 3.0), (f64::NAN, 1.0, 2.0), (1.0, 2.0, f64::INFINITY)]
        {
            let refused = UncertainPlant::record(vec![parameter(minimum, nominal, maximum)], integrator);
            assert!(matches!(refused, Err(UncertainPlantError::Bounds { .. })));
        }
        let twice = vec![parameter(1.0, 2.0, 3.0); 2];
        assert_eq!(
            UncertainPlant::record(twice, integrator),
            Err(UncertainPlantError::Duplicate("k".into()))
        );
    }
}
