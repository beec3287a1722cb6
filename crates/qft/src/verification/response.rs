//! Closed-loop magnitudes of one plant at one frequency, from numerators and denominators, so that
//! a pole of the plant on the imaginary axis is an ordinary point.
//!
//! ```text
//! L = N_l/D_l N_g/D_g,    a = D_l D_g,    b = N_l N_g,    1 + L = (a + b)/a
//! ```

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::criterion::{Criterion, MarginSide};
use crate::closed_loop::{Compensation, DiscFactors, Member, ModalPlant};
use crate::specification::ClosedLoop;

/// A complex number as a quotient whose denominator may be zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fraction {
    pub(super) numerator: Complex64,
    pub(super) denominator: Complex64,
}

/// Data common to all plants at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LoopAt {
    pub(super) frequency: f64,
    feedback: Fraction,
    prefilter: Complex64,
    sensor: Complex64,
    /// The square of the limit of each criterion; `None` without a limit there.
    limits_squared: Vec<Option<f64>>,
    load_motion: bool,
}

/// The closed loop around one plant at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LoopAround {
    /// Sum a + b, whose zeros are the poles of the closed loop.
    pub(super) characteristic: Complex64,
    a: Complex64,
    b: Complex64,
    plant_numerator: Complex64,
    loop_denominator: Complex64,
    load_motion: Fraction,
    /// Factors of the magnitudes for a plant known within a disc.
    disc: DiscFactors,
}

/// The squared ratio of a magnitude to its limit, over all plants that one response may represent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excess {
    /// Excess of the worst plant.
    pub(super) worst: f64,
    /// Excess of every plant.
    pub(super) certain: f64,
}

impl Fraction {
    fn of_value(value: Complex64) -> Fraction {
        Fraction { numerator: value, denominator: Complex64::new(1.0, 0.0) }
    }

    /// Value of a quotient of polynomials at s = j w.
    fn of_coefficients(coefficients: &RationalCoefficients<f64>, frequency: f64) -> Fraction {
        Fraction {
            numerator: at_imaginary(&coefficients.numerator, frequency),
            denominator: at_imaginary(&coefficients.denominator, frequency),
        }
    }

    /// Value of a factored function at s = j w, or z = e^(j w T).
    pub(super) fn of_transfer_function(function: &TransferFunction, frequency: f64) -> Fraction {
        let point = match function.domain() {
            TimeDomain::Continuous => Complex64::new(0.0, frequency),
            TimeDomain::Discrete { sample_time_s } => turned(frequency * sample_time_s),
        };
        let product = |roots: &[Complex64]| roots.iter().map(|root| point - root).product::<Complex64>();
        let delay = function.dead_time_s();
        let turn = if delay == 0.0 { Complex64::new(1.0, 0.0) } else { turned(-frequency * delay) };
        Fraction {
            numerator: product(function.zeros()) * function.gain() * turn,
            denominator: product(function.poles()),
        }
    }
}

/// Horner's rule at s = j w: one multiplication for each part.
fn at_imaginary(coefficients: &[f64], frequency: f64) -> Complex64 {
    let mut value = Complex64::new(0.0, 0.0);
    for coefficient in coefficients {
        value = Complex64::new(coefficient - value.im * frequency, value.re * frequency);
    }
    value
}

fn turned(angle: f64) -> Complex64 {
    Complex64::new(portable::cos(angle), portable::sin(angle))
}

impl LoopAround {
    /// Quantity nearly zero where a criterion has a peak: the characteristic value, with the
    /// denominator of a Pd that has a separate one; the plant's numerator for a magnitude with a
    /// lower limit.
    pub(super) fn vanishing(&self, criterion: &Criterion) -> Complex64 {
        let own = self.load_motion.denominator != self.loop_denominator;
        match (criterion.side, criterion.closed_loop) {
            (MarginSide::Above, _) => self.plant_numerator,
            (MarginSide::Below, ClosedLoop::LoadMotion) if own => {
                self.characteristic * self.load_motion.denominator
            }
            (MarginSide::Below, _) => self.characteristic,
        }
    }
}

impl LoopAt {
    /// Responses G, F, H and the limits at a frequency that is neither zero nor infinite. Without a
    /// prefilter F counts as 1.
    pub(super) fn new(
        compensation: &Compensation,
        criteria: &[Criterion],
        with_prefilter: bool,
        frequency: f64,
    ) -> LoopAt {
        let limit = |criterion: &Criterion| {
            let limit = criterion.demands(frequency).then(|| criterion.limit.magnitude(frequency)).flatten();
            limit.map(|limit| limit * limit)
        };
        let one = Complex64::new(1.0, 0.0);
        let own = |function: &TransferFunction| {
            let found = Fraction::of_transfer_function(function, frequency);
            let vanishes = compensation.vanishes(function, frequency);
            Fraction { numerator: if vanishes { Complex64::ZERO } else { found.numerator }, ..found }
        };
        let prefilter = match compensation.vanishes(compensation.prefilter(), frequency) {
            true => Complex64::ZERO,
            false => compensation.prefilter().at_frequency(frequency),
        };
        LoopAt {
            frequency,
            feedback: own(compensation.feedback()),
            prefilter: if with_prefilter { prefilter } else { one },
            sensor: compensation.sensor().at_frequency(frequency),
            limits_squared: criteria.iter().map(limit).collect(),
            load_motion: criteria.iter().any(|criterion| criterion.closed_loop == ClosedLoop::LoadMotion),
        }
    }

    /// The loop closed around a plant; `None` beyond the range of a measurement.
    pub(super) fn closed(&self, member: &Member) -> Option<LoopAround> {
        let frequency = self.frequency;
        let none = Fraction::of_value(Complex64::new(0.0, 0.0));
        let load = |path: &Option<RationalCoefficients<f64>>| match path {
            Some(path) if self.load_motion => Fraction::of_coefficients(path, frequency),
            _ => none,
        };
        let mut radius = 0.0;
        let (plant_numerator, around, load_motion) = match member {
            Member::Continuous { plant, fed_forward, .. } => {
                let Fraction { mut numerator, denominator } =
                    Fraction::of_coefficients(&plant.command, frequency);
                if plant.dead_time_s != 0.0 {
                    numerator *= turned(-frequency * plant.dead_time_s);
                }
                (
                    numerator,
                    Fraction { numerator: numerator * self.sensor, denominator },
                    self.fed(
                        load(&plant.disturbance),
                        Fraction { numerator, denominator },
                        fed_forward.at(frequency),
                    ),
                )
            }
            Member::Sampled { command, with_sensor, disturbance, fed_forward, .. } => {
                let around = Fraction::of_transfer_function(with_sensor, frequency);
                let plant = Fraction::of_transfer_function(command, frequency);
                let same = command.poles() == with_sensor.poles();
                let numerator = if same {
                    plant.numerator
                } else {
                    plant.numerator * around.denominator / plant.denominator
                };
                (numerator, around, self.fed(load(disturbance), plant, fed_forward.at(frequency)))
            }
            Member::Responding { .. } | Member::Measured { .. } => {
                let response = member.response(frequency)?;
                let around = Fraction::of_value(response.plant * response.sensor);
                radius = member.radius(frequency, &response) * portable::magnitude(response.sensor);
                (response.plant, around, Fraction::of_value(response.load_motion))
            }
        };
        Some(self.around(plant_numerator, around, load_motion, radius))
    }

    /// The loop closed around a sampled plant by its modes; `None` if these do not determine it.
    pub(super) fn closed_held(&self, held: &ModalPlant) -> Option<LoopAround> {
        let found = held.at(self.frequency)?;
        let over = |response: Complex64| Fraction {
            numerator: response * found.denominator,
            denominator: found.denominator,
        };
        let plant = over(found.plant);
        let load = match &held.disturbance {
            Some(path) if self.load_motion => Fraction::of_coefficients(path, self.frequency),
            _ => Fraction::of_value(Complex64::ZERO),
        };
        let load = self.fed(load, plant, held.fed_forward.at(self.frequency));
        Some(self.around(plant.numerator, over(found.with_sensor), load, 0.0))
    }

    /// The loop with `around` = P H, known within a disc.
    fn around(
        &self,
        plant_numerator: Complex64,
        around: Fraction,
        load_motion: Fraction,
        radius: f64,
    ) -> LoopAround {
        let a = around.denominator * self.feedback.denominator;
        let b = around.numerator * self.feedback.numerator;
        let loop_denominator = around.denominator;
        // for a plant known within a disc, a belongs only to the controller
        let disc = DiscFactors::of(b / a, radius * portable::magnitude(self.feedback.numerator / a));
        let characteristic = a + b;
        LoopAround { characteristic, a, b, plant_numerator, loop_denominator, load_motion, disc }
    }

    /// Sum Pd + K V_d P over the denominator of Pd.
    fn fed(&self, load_motion: Fraction, plant: Fraction, forward: Complex64) -> Fraction {
        if !self.load_motion || forward == Complex64::ZERO {
            return load_motion;
        }
        let numerator = forward * plant.numerator;
        let shared = if load_motion.denominator == plant.denominator {
            numerator
        } else {
            numerator / plant.denominator * load_motion.denominator
        };
        Fraction { numerator: load_motion.numerator + shared, ..load_motion }
    }

    /// The squared ratio of a magnitude to its limit: (quantity/limit)^2 for an upper limit, its
    /// inverse for a lower one. `None` without a limit there; NaN if it is undefined.
    pub(super) fn excess(&self, index: usize, criterion: &Criterion, closed: &LoopAround) -> Option<Excess> {
        let limit = (*self.limits_squared.get(index)?)?;
        let numerator = match criterion.closed_loop {
            ClosedLoop::RobustStability => closed.b.norm_sqr(),
            ClosedLoop::Sensitivity => closed.a.norm_sqr(),
            ClosedLoop::PlantInputDisturbance => {
                (closed.plant_numerator * self.feedback.denominator).norm_sqr()
            }
            ClosedLoop::ControlEffort => (closed.loop_denominator * self.feedback.numerator).norm_sqr(),
            ClosedLoop::LoadMotion => self.load_motion_squared(closed),
            ClosedLoop::Tracking => {
                (self.prefilter * closed.plant_numerator * self.feedback.numerator).norm_sqr()
            }
        };
        let characteristic = closed.characteristic.norm_sqr();
        let [least, most] = closed.disc.of_closed_loop(criterion.closed_loop);
        Some(match criterion.side {
            MarginSide::Below => {
                let excess = numerator / (characteristic * limit);
                Excess { worst: excess * most, certain: excess * least }
            }
            MarginSide::Above => {
                let excess = characteristic * limit / numerator;
                Excess { worst: excess / least, certain: excess / most }
            }
        })
    }

    /// Squared magnitude |Pd a|^2; a denominator shared by Pd and P cancels.
    fn load_motion_squared(&self, closed: &LoopAround) -> f64 {
        let Fraction { numerator, denominator } = closed.load_motion;
        if denominator == closed.loop_denominator {
            return (numerator * self.feedback.denominator).norm_sqr();
        }
        numerator.norm_sqr() / denominator.norm_sqr() * closed.a.norm_sqr()
    }
}

/// The margin of a squared excess, dB.
pub(super) fn decibels(excess: f64) -> f64 {
    0.0 - 10.0 * portable::log10(excess)
}
