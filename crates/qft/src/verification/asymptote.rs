//! Limits at zero and infinite frequency, where every function behaves like a power of s.

use phea_dynamics::controller::RateSensor;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::RationalCoefficients;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use num_complex::Complex64;

use super::criterion::{Criterion, MarginSide};
use crate::closed_loop::{Compensation, FedForward, InnerPath, Member, closed, closed_at_rest};
use crate::specification::{ClosedLoop, Limit};

/// End of the frequency axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AxisEnd {
    /// Zero frequency, w -> 0.
    Zero,
    /// Infinite frequency, w -> infinity.
    Infinity,
}

/// Asymptote coefficient s^power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PowerTerm {
    pub(crate) coefficient: f64,
    pub(crate) power: i32,
}

/// Fraction of either asymptote below which a cancelled sum is not resolved.
const CANCELLED: f64 = 1e-12;

impl PowerTerm {
    const ONE: PowerTerm = PowerTerm { coefficient: 1.0, power: 0 };

    fn times(self, other: PowerTerm) -> PowerTerm {
        PowerTerm { coefficient: self.coefficient * other.coefficient, power: self.power + other.power }
    }

    fn over(self, other: PowerTerm) -> PowerTerm {
        PowerTerm { coefficient: self.coefficient / other.coefficient, power: self.power - other.power }
    }

    /// The sum at an end: the dominant term; for equal powers their sum, or its largest magnitude
    /// if the phase of one of them changes without limit. If two cancel, the remainder is smaller
    /// than either.
    fn plus(self, other: PowerTerm, spun: bool, end: AxisEnd) -> PowerTerm {
        if other.coefficient == 0.0 {
            return self;
        }
        let by_power = match end {
            AxisEnd::Zero => other.power.cmp(&self.power),
            AxisEnd::Infinity => self.power.cmp(&other.power),
        };
        match by_power {
            _ if self.coefficient == 0.0 => other,
            std::cmp::Ordering::Greater => self,
            std::cmp::Ordering::Less => other,
            std::cmp::Ordering::Equal if spun => {
                PowerTerm { coefficient: self.coefficient.abs() + other.coefficient.abs(), ..self }
            }
            std::cmp::Ordering::Equal => {
                PowerTerm { coefficient: self.coefficient + other.coefficient, ..self }
            }
        }
    }

    /// The asymptote of a polynomial, highest power first; zero if it is zero.
    fn of_polynomial(coefficients: &[f64], end: AxisEnd) -> PowerTerm {
        let degree = coefficients.len() as i32 - 1;
        let mut powers = coefficients.iter().zip(0..).filter(|(coefficient, _)| **coefficient != 0.0);
        let dominant = match end {
            AxisEnd::Zero => powers.last(),
            AxisEnd::Infinity => powers.next(),
        };
        dominant.map_or(PowerTerm { coefficient: 0.0, power: 0 }, |(&coefficient, index)| PowerTerm {
            coefficient,
            power: degree - index,
        })
    }

    /// The asymptote of a transfer function; for a sampled one z - 1 counts as s T, and there is no
    /// infinite frequency.
    pub(super) fn of_transfer_function(function: &TransferFunction, end: AxisEnd) -> Option<PowerTerm> {
        let (point, step) = match (function.domain(), end) {
            (TimeDomain::Continuous, AxisEnd::Infinity) => {
                let power = function.zeros().len() as i32 - function.poles().len() as i32;
                return Some(PowerTerm { coefficient: function.gain(), power });
            }
            (TimeDomain::Continuous, AxisEnd::Zero) => (Complex64::new(0.0, 0.0), 1.0),
            (TimeDomain::Discrete { sample_time_s }, AxisEnd::Zero) => {
                (Complex64::new(1.0, 0.0), sample_time_s)
            }
            (TimeDomain::Discrete { .. }, AxisEnd::Infinity) => return None,
        };
        let product = |roots: &[Complex64]| {
            let factor =
                |root: &Complex64| if *root == point { Complex64::new(step, 0.0) } else { point - root };
            roots.iter().map(factor).product::<Complex64>().re
        };
        let here = |roots: &[Complex64]| roots.iter().filter(|&&root| root == point).count() as i32;
        let coefficient = function.gain() * product(function.zeros()) / product(function.poles());
        Some(PowerTerm { coefficient, power: here(function.zeros()) - here(function.poles()) })
    }

    fn of_limit(limit: &Limit, end: AxisEnd) -> Option<PowerTerm> {
        match limit {
            Limit::Constant(value) => Some(PowerTerm { coefficient: *value, power: 0 }),
            Limit::Rational(function) => PowerTerm::of_transfer_function(function, end),
            Limit::Table(_) => None,
        }
    }

    /// Comparison with a constant at the end: greater, of equal order, or less.
    fn order(self, end: AxisEnd) -> std::cmp::Ordering {
        match end {
            AxisEnd::Zero => 0.cmp(&self.power),
            AxisEnd::Infinity => self.power.cmp(&0),
        }
    }
}

/// Asymptotes of P, Pd, G, F, H for one plant at an end; `spun` if dead time changes the phase of
/// the loop without limit.
struct LoopAsymptotes {
    plant: PowerTerm,
    load_motion: PowerTerm,
    feedback: PowerTerm,
    prefilter: PowerTerm,
    open_loop: PowerTerm,
    spun: bool,
}

/// The limit of a margin at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EndMargin {
    pub(super) margin_db: f64,
    /// The power of s of the closed loop's asymptote.
    pub(super) power: i32,
}

/// The limit of the margin; `None` if it does not exist.
///
/// Without a prefilter, tracking is assessed by its spread, for which all prefilters are
/// equivalent: the one used makes |T| as steep as its upper limit. Plants of equal power share this
/// prefilter, and only these can be compared.
pub(super) fn margin(
    criterion: &Criterion,
    compensation: &Compensation,
    member: &Member,
    with_prefilter: bool,
    end: AxisEnd,
) -> Option<EndMargin> {
    if criterion.side == MarginSide::Above
        && end == AxisEnd::Infinity
        && matches!(member, Member::Responding { .. })
    {
        // an upper bound gives no conclusion about a magnitude that must not fall
        return None;
    }
    let parts = parts(compensation, member, with_prefilter, end)?;
    let numerator = match criterion.closed_loop {
        ClosedLoop::RobustStability => parts.open_loop,
        ClosedLoop::Sensitivity => PowerTerm::ONE,
        ClosedLoop::PlantInputDisturbance => parts.plant,
        ClosedLoop::ControlEffort => parts.feedback,
        ClosedLoop::LoadMotion => parts.load_motion,
        ClosedLoop::Tracking => parts.prefilter.times(parts.plant).times(parts.feedback),
    };
    let mut closed = numerator.over(parts.one_plus_loop(criterion.side, end)?);
    let power = closed.power;
    if let (false, Some(upper)) = (with_prefilter, &criterion.upper) {
        closed.power = PowerTerm::of_limit(upper, end)?.power;
    }
    let limit = PowerTerm::of_limit(&criterion.limit, end)?;
    let ratio = match criterion.side {
        MarginSide::Below => limit.over(closed),
        MarginSide::Above => closed.over(limit),
    };
    let size = ratio.coefficient.abs();
    if size.is_nan() {
        return None;
    }
    let margin_db = match ratio.order(end) {
        _ if size == 0.0 => f64::NEG_INFINITY,
        _ if size == f64::INFINITY => f64::INFINITY,
        std::cmp::Ordering::Less => f64::NEG_INFINITY,
        std::cmp::Ordering::Equal => 20.0 * portable::log10(size),
        std::cmp::Ordering::Greater => f64::INFINITY,
    };
    Some(EndMargin { margin_db, power })
}

/// Ratio of a limit to P G/(1+L) at an end, to its largest value if dead time changes the phase of
/// the loop; `None` if there is none.
pub(crate) fn tracking_ratio(
    compensation: &Compensation,
    member: &Member,
    limit: &Limit,
    end: AxisEnd,
) -> Option<PowerTerm> {
    let parts = parts(compensation, member, false, end)?;
    let closed = parts.plant.times(parts.feedback).over(parts.one_plus_loop(MarginSide::Below, end)?);
    Some(PowerTerm::of_limit(limit, end)?.over(closed))
}

/// Frequency at which the asymptote of the loop at zero frequency has unit magnitude, rad/s.
pub(super) fn crossing(compensation: &Compensation, member: &Member) -> Option<f64> {
    let open_loop = parts(compensation, member, false, AxisEnd::Zero)?.open_loop;
    let frequency = portable::pow(open_loop.coefficient.abs(), -1.0 / f64::from(open_loop.power));
    (open_loop.power != 0 && frequency > 0.0 && frequency < f64::INFINITY).then_some(frequency)
}

impl LoopAsymptotes {
    /// Return difference 1 + L. If L neither grows nor vanishes and dead time changes its phase,
    /// the magnitude that is worse for this side.
    fn one_plus_loop(&self, side: MarginSide, end: AxisEnd) -> Option<PowerTerm> {
        let open_loop = self.open_loop;
        if open_loop.coefficient == 0.0 {
            return Some(PowerTerm::ONE);
        }
        match open_loop.order(end) {
            std::cmp::Ordering::Less => Some(PowerTerm::ONE),
            std::cmp::Ordering::Greater => Some(open_loop),
            std::cmp::Ordering::Equal => {
                let size = open_loop.coefficient.abs();
                let sum = match (self.spun, side) {
                    (false, _) => 1.0 + open_loop.coefficient,
                    (true, MarginSide::Below) => 1.0 - size,
                    (true, MarginSide::Above) => 1.0 + size,
                };
                (sum.abs() > CANCELLED * size.max(1.0)).then_some(PowerTerm { coefficient: sum, power: 0 })
            }
        }
    }
}

fn parts(
    compensation: &Compensation,
    member: &Member,
    with_prefilter: bool,
    end: AxisEnd,
) -> Option<LoopAsymptotes> {
    let zero = PowerTerm { coefficient: 0.0, power: 0 };
    let of = |function: &TransferFunction| PowerTerm::of_transfer_function(function, end);
    let rational = |numerator: &[f64], denominator: &[f64]| {
        PowerTerm::of_polynomial(numerator, end).over(PowerTerm::of_polynomial(denominator, end))
    };
    let path = |path: &Option<RationalCoefficients<f64>>| {
        path.as_ref().map_or(zero, |path| rational(&path.numerator, &path.denominator))
    };
    let forward = |fed: &FedForward| {
        let gain = PowerTerm { coefficient: fed.gain, power: 0 };
        let path = fed.path.as_ref().map(|path| rational(&path.numerator, &path.denominator));
        let shown = rational(&[1.0], &fed.sensor.filter.denominator());
        let forward = gain.times(path.unwrap_or(PowerTerm { coefficient: 1.0, power: 1 })).times(shown);
        let Some(InnerPath { feedback, path }) = &fed.inner else { return Some(forward) };
        let minus = PowerTerm { coefficient: -1.0, power: 0 };
        let back = of(feedback)?.times(rational(&path.numerator, &path.denominator)).times(minus);
        Some(forward.plus(back, false, end))
    };
    let (plant, load_motion, with_sensor, forward, turns) = match member {
        Member::Continuous { plant, sensor, fed_forward } => {
            let command = rational(&plant.command.numerator, &plant.command.denominator);
            let with_sensor = command.times(of(sensor)?);
            let turns = plant.dead_time_s > 0.0;
            (command, path(&plant.disturbance), with_sensor, forward(fed_forward)?, turns)
        }
        Member::Sampled { command, with_sensor, disturbance, fed_forward, .. } => {
            (of(command)?, path(disturbance), of(with_sensor)?, forward(fed_forward)?, false)
        }
        Member::Responding { plant, sensor, rate_feed_forward, rate_sensor, inner_feedback, .. } => {
            // the load-motion path has the asymptotes of the slow plant
            let at_once = RateSensor { delay_s: 0.0, ..*rate_sensor };
            let inner = inner_feedback.as_ref();
            let slow = closed_at_rest(inner, closed(*rate_feed_forward, at_once, plant.slow()).ok()?);
            let fed = FedForward::of(*rate_feed_forward, *rate_sensor, inner, &plant.slow());
            let command = match end {
                AxisEnd::Zero => rational(&slow.command.numerator, &slow.command.denominator),
                AxisEnd::Infinity => rolled_off(plant.as_ref())?,
            };
            (command, path(&slow.disturbance), command.times(of(sensor)?), forward(&fed)?, true)
        }
        Member::Measured { .. } => return None,
    };
    let apart = (turns || fed_late(member)) && end == AxisEnd::Infinity;
    let load_motion = load_motion.plus(plant.times(forward), apart, end);
    let feedback = of(compensation.feedback())?;
    Some(LoopAsymptotes {
        plant,
        load_motion,
        feedback,
        prefilter: if with_prefilter { of(compensation.prefilter())? } else { PowerTerm::ONE },
        open_loop: with_sensor.times(feedback),
        spun: turns && end == AxisEnd::Infinity,
    })
}

/// True if the sensor of a rate that is fed forward shifts its phase relative to the rest of the
/// loop.
fn fed_late(member: &Member) -> bool {
    match member {
        Member::Continuous { fed_forward, .. } | Member::Sampled { fed_forward, .. } => {
            fed_forward.gain != 0.0 && fed_forward.sensor.delay_s > 0.0
        }
        Member::Responding { .. } | Member::Measured { .. } => false,
    }
}

/// A bound on the gain of a plant without polynomials towards infinite frequency.
fn rolled_off(plant: &dyn RespondingPlant) -> Option<PowerTerm> {
    let [_, from] = plant.range_rad_per_s();
    Some(PowerTerm { coefficient: plant.roll_off(from)? * from * from * from, power: -3 })
}
