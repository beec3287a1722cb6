//! The frequencies to be examined: a margin has no feature between them that they miss.

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;

use super::asymptote;
use super::evaluator::Evaluator;
use crate::closed_loop::Member;
use crate::family::{COARSE, tabulated};
use crate::specification::{ClosedLoop, Limit};

/// Number of points per decade in the range of the roots, and beyond it.
const POINTS_PER_DECADE: f64 = 40.0;
const POINTS_PER_OUTER_DECADE: f64 = 8.0;
/// Number of decades beyond the roots that are examined before the limit at the end of the axis
/// applies.
const OUTER_DECADES: f64 = 3.0;
/// Damping ratio below which the peak of a root could be missed by the grid.
const LIGHTLY_DAMPED: f64 = 0.2;
/// Largest phase change of a loop from one point to the next due to dead time or sampling, rad.
const TURN: f64 = 0.3;
/// Largest number of points added because of dead time.
const TURNS_MAXIMUM: usize = 600;

/// The additional frequencies at which one plant is examined, and the range of its roots.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Features {
    pub(super) frequencies: Vec<f64>,
    /// Smallest and largest magnitude of a root, rad/s.
    pub(super) range: Option<[f64; 2]>,
    /// True if every resonance of the closed loop is among them; otherwise the phase changes of 1 +
    /// L are decisive.
    pub(super) complete: bool,
    pub(super) dead_time_s: f64,
}

impl Features {
    /// Features of a plant that has no response.
    pub(super) fn none() -> Features {
        Features { frequencies: Vec::new(), range: None, complete: true, dead_time_s: 0.0 }
    }

    /// Features of roots in the s plane.
    fn of_roots(roots: &[Complex64], complete: bool, dead_time_s: f64) -> Features {
        let frequencies = roots.iter().flat_map(|root| around(*root)).collect();
        let sizes = roots.iter().map(|root| portable::magnitude(*root));
        let sizes = sizes.filter(|size| *size > 0.0 && size.is_finite()).map(|size| [size, size]);
        Features { frequencies, range: sizes.reduce(joined), complete, dead_time_s }
    }
}

fn joined(left: [f64; 2], right: [f64; 2]) -> [f64; 2] {
    [left[0].min(right[0]), left[1].max(right[1])]
}

/// The frequency of a lightly damped root, and some about it at distances of its real part.
fn around(root: Complex64) -> Vec<f64> {
    let (centre, width) = (root.im, root.re.abs());
    if centre <= 0.0 || width > LIGHTLY_DAMPED * centre {
        return Vec::new();
    }
    let offsets = [0.0, 0.5, 1.0, 2.0, 4.0].into_iter().flat_map(|offset| [-offset, offset]);
    offsets.map(|offset| centre + offset * width).filter(|frequency| *frequency > 0.0).collect()
}

/// Features of one plant: the roots of P, of Pd, and of 1 + L if that is a polynomial.
pub(super) fn features(evaluator: &Evaluator<'_>, member: &Member) -> Features {
    match member {
        Member::Continuous { plant, .. } => {
            let numerator = Polynomial::new(plant.command.numerator.clone());
            let denominator = Polynomial::new(plant.command.denominator.clone());
            let characteristic = evaluator
                .compensator
                .as_ref()
                .map(|(n, d)| denominator.product(d).sum(&numerator.product(n)));
            let dead_time_s = plant.dead_time_s + evaluator.compensator_dead_time_s;
            let has_load_motion =
                evaluator.criteria.iter().any(|criterion| criterion.closed_loop == ClosedLoop::LoadMotion);
            let load = plant.disturbance.as_ref().filter(|_| has_load_motion);
            let load = load.filter(|path| path.denominator != plant.command.denominator);
            let load = load.map(|path| Polynomial::new(path.denominator.clone()));
            let rational = characteristic.is_some() && dead_time_s == 0.0;
            let polynomials = [Some(numerator), Some(denominator), characteristic, load];
            let roots: Option<Vec<Vec<Complex64>>> =
                polynomials.into_iter().flatten().map(|polynomial| roots(&polynomial)).collect();
            let complete = rational && roots.is_some();
            Features::of_roots(&roots.unwrap_or_default().concat(), complete, dead_time_s)
        }
        Member::Sampled { command, with_sensor, .. } => {
            let mut roots = roots_of(with_sensor);
            if command != with_sensor {
                roots.extend(roots_of(command));
            }
            let own = Features::of_roots(&roots, false, 0.0);
            let crossing = asymptote::crossing(evaluator.compensation, member);
            let crossing = crossing.map(|frequency| [frequency, frequency]);
            Features { range: [own.range, crossing].into_iter().flatten().reduce(joined), ..own }
        }
        Member::Responding { plant, delay_s, .. } => {
            let range = plant.range_rad_per_s();
            let bends = tabulated(plant.as_ref(), range, COARSE);
            Features {
                frequencies: bends.frequencies_rad_per_s,
                range: Some(range),
                complete: false,
                dead_time_s: delay_s + plant.echo_s() + evaluator.compensator_dead_time_s,
            }
        }
        Member::Measured { plant, delay_s, .. } => {
            let ends = plant.frequencies_rad_per_s.first().zip(plant.frequencies_rad_per_s.last());
            Features {
                frequencies: plant.frequencies_rad_per_s.clone(),
                range: ends.map(|(first, last)| [*first, *last]),
                complete: false,
                dead_time_s: *delay_s,
            }
        }
    }
}

fn roots(polynomial: &Polynomial) -> Option<Vec<Complex64>> {
    if polynomial.is_zero() { Some(Vec::new()) } else { polynomial.roots().ok() }
}

/// Zeros and poles; those of a sampled function as ln(z)/T.
fn roots_of(function: &TransferFunction) -> Vec<Complex64> {
    let roots = function.zeros().iter().chain(function.poles()).copied();
    match function.domain() {
        TimeDomain::Continuous => roots.collect(),
        TimeDomain::Discrete { sample_time_s } => roots
            .filter(|root| portable::magnitude(*root) > 0.0)
            .map(|root| {
                let size = portable::ln(portable::magnitude(root));
                Complex64::new(size, portable::argument(root)) / sample_time_s
            })
            .collect(),
    }
}

/// Features of controller, prefilter, sensor and limits.
pub(super) fn common_features(evaluator: &Evaluator<'_>) -> Features {
    let compensation = evaluator.compensation;
    let parts = [compensation.feedback(), compensation.prefilter(), compensation.sensor()];
    let limits = evaluator.criteria.iter().filter_map(|criterion| match &criterion.limit {
        Limit::Rational(function) => Some(function),
        Limit::Constant(_) | Limit::Table(_) => None,
    });
    let roots: Vec<Complex64> = parts.into_iter().chain(limits).flat_map(roots_of).collect();
    Features::of_roots(&roots, true, compensation.delay_s())
}

/// The frequencies at which every plant is evaluated: increasing, from zero (0) or to infinity if a
/// band extends there.
pub(super) fn common_grid<'a>(
    evaluator: &Evaluator<'_>,
    features: impl Iterator<Item = &'a Features>,
    given: &[f64],
) -> Vec<f64> {
    let own = common_features(evaluator);
    let (mut range, mut dead_time_s) = (own.range, own.dead_time_s);
    for plant in features {
        range = [range, plant.range].into_iter().flatten().reduce(joined);
        dead_time_s = dead_time_s.max(plant.dead_time_s);
    }
    let bands = evaluator.criteria.iter().map(|criterion| criterion.band);
    let Some(band) = bands.filter(|[from, to]| 0.0 <= *from && from <= to).reduce(joined) else {
        return Vec::new();
    };
    let mut grid = [own.frequencies, given.to_vec()].concat();
    for criterion in &evaluator.criteria {
        grid.extend(criterion.band);
        if let Limit::Table(table) = &criterion.limit {
            grid.extend(table.points().iter().map(|point| point.0));
        }
    }
    let range = range.unwrap_or([1.0, 1.0]);
    let beyond = portable::pow(10.0, OUTER_DECADES);
    let finite = [
        if band[0] > 0.0 { band[0] } else { range[0].min(band[1]) / beyond },
        if band[1] < f64::INFINITY { band[1] } else { range[1].max(band[0]) * beyond },
    ];
    let inner =
        [(range[0] / 10.0).clamp(finite[0], finite[1]), (range[1] * 10.0).clamp(finite[0], finite[1])];
    grid.extend(spaced([finite[0], inner[0]], POINTS_PER_OUTER_DECADE));
    grid.extend(spaced(inner, POINTS_PER_DECADE));
    grid.extend(spaced([inner[1], finite[1]], POINTS_PER_OUTER_DECADE));
    let turning = dead_time_s.max(evaluator.compensation.sample_time_s().unwrap_or(0.0));
    if turning > 0.0 {
        grid.extend((1..=TURNS_MAXIMUM).map(|turn| TURN / turning * turn as f64));
    }
    grid.retain(|frequency| band[0] <= *frequency && *frequency <= band[1]);
    sorted_distinct(grid)
}

fn spaced([from, to]: [f64; 2], per_decade: f64) -> Vec<f64> {
    if !(from > 0.0 && to > from && to < f64::INFINITY) {
        return Vec::new();
    }
    let points = portable::log10(to / from) * per_decade;
    logarithmic_grid(from, to, points as usize + 2).unwrap_or_default()
}
