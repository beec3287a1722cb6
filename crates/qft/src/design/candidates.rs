//! Candidate structures, and their order.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Element};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::RationalCoefficients;

use super::feedback_sign::opposing_sign;
use super::problem::PoleRange;
use super::stabilising::stabilising;
use crate::family::Family;
use crate::family::corners;
use crate::loop_shaping::DesignProblem;
use crate::loop_shaping::{Structure, StructureFactor};
use crate::specification::{ClosedLoop, Limit, Specification};

/// Factors by which the corners of a controller may be below and above the highest frequency of the
/// specifications, and below the lowest.
const BELOW_HIGHEST: f64 = 1e-4;
const ABOVE: f64 = 200.0;
const BELOW_LOWEST: f64 = 0.1;
/// Corners at which a factor is added to a simpler controller.
const CORNERS: usize = 9;
/// Corners of factors added to a pole-placement controller, relative to its fastest root.
const BEYOND_FASTEST: [f64; 2] = [3.0, 20.0];
/// Damping ratios of free pairs; beyond 1 a pair is two real roots.
const DAMPING_RATIOS: [f64; 2] = [0.1, 20.0];
/// Factor by which the gain may exceed, or fall below, the values that put the crossover at a
/// frequency of the specifications.
const GAIN_ROOM: f64 = 100.0;
/// Relative difference of two limits at low frequency below which they require a specific gain.
const SAME: f64 = 1e-6;

/// The sign that feedback needs to oppose the nominal plant, and a wide range for the gain k of a
/// controller with unit corners: it includes every value that puts the crossover at a frequency of
/// the specifications, with a reserve at both ends.
///
/// # Example
/// Plant 4/s with a specification from 1 to 10 rad/s: k = 1/4 crosses over at 1 rad/s.
/// ```
/// # use phea_dynamics::controller::Timing;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
/// # use phea_qft::family::{Extent, Family, UncertainFamily};
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::design::{DesignProblem, gain_range};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![4.0.into()], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let problem = DesignProblem {
/// #     family: Family::Uncertain(UncertainFamily::new(plant, vec![], vec![], Extent::Box)?),
/// #     additional_plants: vec![],
/// #     sensor: TransferFunction::gain_only(1.0),
/// #     timing: Timing::default(),
/// #     specifications: vec![Specification {
/// #         requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
/// #         frequencies_rad_per_s: vec![1.0, 10.0],
/// #         band_rad_per_s: [1.0, 10.0],
/// #     }],
/// #     minimum_delay_margin_s: 0.0,
/// # };
/// let (sign, [least, greatest]) = gain_range(&problem);
/// assert!(sign == 1.0 && least < 0.25 && greatest > 2.5);
/// # Ok(())
/// # }
/// ```
pub fn gain_range(problem: &DesignProblem) -> (f64, [f64; 2]) {
    let ground = Ground::new(problem);
    (ground.sign, ground.gain)
}

/// Data common to all structures of a problem.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ground {
    /// Integrators that the specifications require beyond those of the plants.
    pub(super) integrators: usize,
    sign: f64,
    corner: [f64; 2],
    gain: [f64; 2],
    /// Range of the gain of a controller without an integrator.
    pure_gain: [f64; 2],
    poles: PoleRange,
}

impl Ground {
    /// Common starting data of every structure that may solve the problem.
    pub(super) fn new(problem: &DesignProblem) -> Ground {
        let span = span(&problem.specifications);
        let low = LowFrequency::of(problem, span[0]);
        let wanted = problem.specifications.iter().map(wanted_type).max().unwrap_or(0);
        // an integrator would cancel a zero of the plant at the origin, and the loop would retain a
        // pole there
        let integrators = usize::try_from(wanted - low.plant_type.max(0)).unwrap_or(0);
        let corner = [(BELOW_LOWEST * span[0]).max(BELOW_HIGHEST * span[1]), ABOVE * span[1]];
        let along = logarithmic_grid(span[0], span[1] * ABOVE.sqrt(), 30).unwrap_or_default();
        // Gain k = w^integrators / |P(jw)|, for which the loop of unit corners crosses over at w.
        let gains = |integrators: usize| {
            let crossover = |frequency: &f64| {
                let plant = portable::magnitude(low.response(problem, *frequency)?);
                let gain = portable::exp(integrators as f64 * portable::ln(*frequency)) / plant;
                (gain.is_finite() && gain > 0.0).then_some([gain, gain])
            };
            let [least, greatest] = along.iter().filter_map(crossover).reduce(joined).unwrap_or([1.0, 1.0]);
            [least / GAIN_ROOM, greatest * GAIN_ROOM]
        };
        let [gain, pure_gain] = [integrators, 0].map(gains);
        Ground { integrators, sign: low.sign, corner, gain, pure_gain, poles: PoleRange::default() }
    }

    /// Copy of this data with poles in this range.
    pub(super) fn with_poles(self, poles: PoleRange) -> Ground {
        Ground { poles, ..self }
    }

    /// Points at which a structure is equal to a simpler controller, or nearly: poles and zeros are
    /// added at one corner each, where they cancel if there are equally many; a surplus zero is
    /// omitted.
    pub(super) fn grown(&self, structure: &Structure, simpler: &TransferFunction) -> Vec<Vec<f64>> {
        let middle =
            [self.corner[0].max(10.0 * BELOW_HIGHEST * self.corner[1] / ABOVE), 0.3 * self.corner[1]];
        let corners = logarithmic_grid(middle[0], middle[1], CORNERS).unwrap_or_default();
        corners.iter().filter_map(|corner| grown_at(structure, simpler, *corner)).collect()
    }

    /// Points of a structure at which it stabilises the nominal plant, or nearly; see
    /// [`stabilising`].
    pub(super) fn stabilising(&self, structure: &Structure, problem: &DesignProblem) -> Vec<Vec<f64>> {
        let simpler = stabilising(problem, self.integrators, structure.roots(-1.0));
        let at = |function: &TransferFunction| {
            let roots = function.poles().iter().chain(function.zeros());
            let fastest = roots.map(|root| portable::magnitude(*root)).fold(self.corner[0], f64::max);
            BEYOND_FASTEST.map(|factor| grown_at(structure, function, (factor * fastest).min(self.corner[1])))
        };
        let mut points: Vec<Vec<f64>> = simpler.iter().flat_map(at).flatten().collect();
        points.dedup();
        points
    }

    /// The structure of a pure gain.
    pub(super) fn pure_gain(&self) -> Structure {
        Structure { sign: self.sign, gain: self.pure_gain, parts: vec![] }
    }

    /// The structure of these parts.
    pub(super) fn with_gain(&self, parts: Vec<StructureFactor>) -> Structure {
        Structure { sign: self.sign, gain: self.gain, parts }
    }

    /// Range of corners and natural frequencies.
    pub(super) fn corners(&self) -> Corners {
        let [lowest, highest] = self.corner;
        let fastest = highest.min(self.poles.fastest_rad_per_s).max(lowest);
        Corners { of_zeros: self.corner, of_poles: [lowest, fastest] }
    }

    /// The structure of this order with this number of zeros.
    pub(super) fn structure(&self, order: usize, zeros: usize) -> Structure {
        let integrator = std::iter::repeat_n(StructureFactor::Fixed(Element::Integrator), self.integrators);
        let poles = order.saturating_sub(self.integrators);
        let Corners { of_zeros, of_poles } = self.corners();
        let [least, greatest] = DAMPING_RATIOS;
        // of two real poles one would be faster than the natural frequency
        let greatest_of_poles = if self.poles.fastest_rad_per_s.is_finite() { 1.0 } else { greatest };
        let pair = |is_pole: bool| match is_pole {
            true => {
                let damping_ratio = [least.max(self.poles.least_damping_ratio), greatest_of_poles];
                StructureFactor::PolePair { natural_frequency: of_poles, damping_ratio }
            }
            false => StructureFactor::ZeroPair { natural_frequency: of_zeros, damping_ratio: DAMPING_RATIOS },
        };
        let single = |is_pole: bool| match is_pole {
            true => StructureFactor::RealPole { frequency: of_poles },
            false => StructureFactor::RealZero { frequency: of_zeros },
        };
        let factors = |count: usize, is_pole: bool| {
            std::iter::repeat_n(pair(is_pole), count / 2)
                .chain(std::iter::repeat_n(single(is_pole), count % 2))
                .collect::<Vec<StructureFactor>>()
        };
        let parts = integrator.chain(factors(zeros, false)).chain(factors(poles, true)).collect();
        self.with_gain(parts)
    }
}

/// Least and greatest corner or natural frequency, rad/s.
pub(super) struct Corners {
    pub(super) of_zeros: [f64; 2],
    pub(super) of_poles: [f64; 2],
}

/// The point of a structure at which it equals a simpler controller with poles and zeros added at
/// this corner; a surplus zero is omitted.
fn grown_at(structure: &Structure, simpler: &TransferFunction, corner: f64) -> Option<Vec<f64>> {
    let mut gain = simpler.gain();
    let (mut zeros, mut poles) = (simpler.zeros().to_vec(), simpler.poles().to_vec());
    sort_by_number(&mut zeros, |zero| zero.norm_sqr());
    let [wanted_zeros, wanted_poles] = [structure.roots(1.0), structure.roots(-1.0)];
    while zeros.len() > wanted_zeros {
        gain *= portable::magnitude(zeros.pop()?);
    }
    let added = Complex64::new(-corner, 0.0);
    while zeros.len() < wanted_zeros {
        zeros.push(added);
        gain /= corner;
    }
    while poles.len() < wanted_poles {
        poles.push(added);
        gain *= corner;
    }
    let function = TransferFunction::from_factors(gain, zeros, poles).ok()?;
    structure.point_of(&Compensator::new(vec![Element::General(function)]))
}

fn joined(left: [f64; 2], right: [f64; 2]) -> [f64; 2] {
    [left[0].min(right[0]), left[1].max(right[1])]
}

/// Least and greatest finite positive frequency that a specification names.
fn span(specifications: &[Specification]) -> [f64; 2] {
    let named = specifications.iter().flat_map(|one| {
        one.frequencies_rad_per_s.iter().chain(&one.band_rad_per_s).map(|frequency| [*frequency; 2])
    });
    let inside = named.filter(|[frequency, _]| *frequency > 0.0 && frequency.is_finite());
    inside.reduce(joined).unwrap_or([0.1, 10.0])
}

/// The exponent of w with which the loop must grow as w tends to zero to satisfy this
/// specification.
fn wanted_type(specification: &Specification) -> i64 {
    match (specification.requirement.closed_loop(), specification.requirement.limits()) {
        (ClosedLoop::Sensitivity, (_, limit)) => order_at_zero(limit).max(0),
        (ClosedLoop::Tracking, (Some(lower), upper)) => {
            let at_zero = |limit: &Limit| match limit {
                Limit::Constant(value) => Some(*value),
                Limit::Rational(function) => Some(function.dc_gain().abs()),
                // a table sets no limit below its first point
                Limit::Table(_) => None,
            };
            let narrow = at_zero(lower).zip(at_zero(upper));
            i64::from(narrow.is_some_and(|(low, high)| high - low <= SAME * high))
        }
        _ => 0,
    }
}

/// Exponent n if the limit tends to zero as w^n.
fn order_at_zero(limit: &Limit) -> i64 {
    let Limit::Rational(function) = limit else { return 0 };
    let at_origin = |roots: &[Complex64]| roots.iter().filter(|root| root.norm_sqr() == 0.0).count() as i64;
    at_origin(function.zeros()) - at_origin(function.poles())
}

/// The behaviour of the plants at low frequency.
struct LowFrequency {
    /// Least number of integrators of a plant.
    plant_type: i64,
    sign: f64,
}

impl LowFrequency {
    fn of(problem: &DesignProblem, lowest: f64) -> LowFrequency {
        match &problem.family {
            Family::Uncertain(family) => {
                let nominal = family.plant().nominal();
                let corners = corners(family);
                let values = std::iter::once(&nominal).chain(&corners);
                let slow = |values: &Vec<f64>| Some(family.plant().member(values)?.slow().command);
                let types = values.filter_map(|values| slow(values).map(|command| plant_type(&command)));
                let sign = slow(&nominal).map_or(1.0, |command| opposing_sign(&command));
                LowFrequency { plant_type: types.min().unwrap_or(0), sign }
            }
            Family::Measured(family) => {
                let first = family.plants().first();
                let response = first.and_then(|plant| {
                    let start = plant.frequencies_rad_per_s.first().copied().unwrap_or(lowest);
                    plant.response(start)
                });
                let sign = response.map_or(1.0, |(command, _)| if command.re < 0.0 { -1.0 } else { 1.0 });
                LowFrequency { plant_type: 0, sign }
            }
        }
    }

    /// Response P of the nominal plant.
    fn response(&self, problem: &DesignProblem, frequency: f64) -> Option<Complex64> {
        match &problem.family {
            Family::Uncertain(family) => {
                let command = family.plant().member(&family.plant().nominal())?.slow().command;
                Some(command.at_frequency(frequency))
            }
            Family::Measured(family) => Some(family.plants().first()?.response(frequency)?.0),
        }
    }
}

/// Number of poles less zeros at the origin.
fn plant_type(command: &RationalCoefficients<f64>) -> i64 {
    let at_origin = |coefficients: &[f64]| coefficients.iter().rev().take_while(|one| **one == 0.0).count();
    at_origin(&command.denominator) as i64 - at_origin(&command.numerator) as i64
}
