//! Uncertainty of a valve that recordings leave, in the coefficients on which the plant depends.

use nalgebra::{DMatrix, SymmetricEigen};
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable::{erfc, pow};
use phea_hydraulics::servovalve::OpeningShape;

use super::variables::{HYSTERESIS, Kind};
use super::{COEFFICIENT_NAMES, Identification};
use crate::family::{ProjectFamilyError, gain_slopes};
use crate::project::{NumberChanges, Project, UncertaintyDirection, ValveCoefficients, ValveLap};
use crate::setup::Setup;

/// Probability that the true coefficients are in the region.
pub const COVERAGE: f64 = 0.95;

/// Number of standard deviations of one recording by which two of one valve differ at most with 95
/// %: 1.96 sqrt 2.
const BETWEEN_TWO: f64 = 2.771_8;

/// Relative change of K_qU and K_c that the omitted directions may make together, if nothing else
/// is requested.
pub const SMALLEST_EFFECT: f64 = 0.01;

/// Joint 95 % region of the coefficients, as directions for a family.
#[derive(Clone, Debug, PartialEq)]
pub struct JointRegion {
    /// Independent directions, the one with the greatest effect first.
    pub directions: Vec<UncertaintyDirection>,
    /// Largest relative change of K_qU and K_c that each direction makes from its middle to an end.
    pub effects: Vec<f64>,
    /// Number of omitted directions: their coefficients remain as identified.
    pub left_out: usize,
    /// Largest relative change of K_qU or K_c that the omitted directions make together.
    pub effect_left_out: f64,
    /// Relative change of K_qU or K_c by the omitted directions between two recordings of one valve
    /// that is not exceeded with 95 %.
    pub change_left_out: f64,
    /// Half width of each direction in standard deviations.
    pub deviations: f64,
}

/// Reason why there is no such region.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointRegionError {
    /// A coefficient has no interval.
    #[error(
        "the recordings do not determine `{0}`, so that nothing is known of the plants that are possible"
    )]
    NotIdentifiable(&'static str),
    /// The region of a coefficient is not positive.
    #[error("the region of `{0}` begins below zero: the recordings cannot distinguish it from zero")]
    BelowZero(String),
    /// The rig with the identified valve has no operating point, or is not a rig.
    #[error(transparent)]
    Family(#[from] ProjectFamilyError),
    /// The project has no rig.
    #[error("the effect on the plant is that on a rig, and this project describes none")]
    NoRig,
}

/// Joint region of an identified valve for the rig of a project.
///
/// The estimates are normal with covariance C = D L L' D, D the standard deviations, L L' the
/// correlations. With c = c0 + D L z the components of z are independent and standard normal, and
/// remain so when z is rotated. It is rotated so that each component in its order has as great an
/// effect on ln K_qU and ln K_c at the operating points of the rig as the earlier ones left: by the
/// eigenvectors of M'M, M = J D L, J the derivatives.
///
/// ```text
/// P(|z_i| <= r for all n) = erf(r/sqrt 2)^n = 0.95          n = 9: r = 2.77
/// ```
///
/// so that the box of the directions, and not each interval separately, has 95 %. (Nine intervals
/// of 1.96 deviations have 63 % together; the ellipsoid of 95 % has the radius 4.11, and the box
/// around it 99.96 %.) The components at the end are omitted as long as they change no K_qU and no
/// K_c by more than `smallest_effect` together, each at its end.
///
/// # Errors
/// [`JointRegionError`] for coefficients that are not determined, and a rig that has no plant.
pub fn joint_region(
    found: &Identification,
    project: &Project,
    smallest_effect: f64,
) -> Result<JointRegion, JointRegionError> {
    let mut project = with_valve(project, found).ok_or(JointRegionError::NoRig)?;
    // the region is to replace ranges of parameters that follow from the coefficients
    project
        .uncertainty
        .retain(|one| !["flow_gain", "flow_pressure_coefficient"].contains(&one.name.as_str()));
    let plant: Vec<usize> = found.of_plant().collect();
    let name = |index: usize| COEFFICIENT_NAMES.get(index).map_or("", |(name, _)| *name);
    for index in &plant {
        let estimate = found.estimates.get(*index).copied().flatten();
        if estimate.is_none() || !found.deviations.get(*index).is_some_and(|one| one.is_finite()) {
            return Err(JointRegionError::NotIdentifiable(name(*index)));
        }
    }
    let paths: Vec<String> = plant.iter().map(|index| found.path(name(*index))).collect();
    let setup = Setup::new(&project).map_err(|_| JointRegionError::NoRig)?;
    let rows = gain_slopes(&setup, &paths.iter().map(String::as_str).collect::<Vec<_>>())?;
    let count = plant.len();
    let slopes = DMatrix::from_fn(rows.len(), count, |row, column| {
        rows.get(row).and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    });
    let spread = spread(found, &plant);
    let effects = &slopes * &spread;
    let turned = turned(&effects);
    let (effects, changes) = (effects * &turned, spread * turned);
    let deviations = deviations(count);
    let kept = kept(&effects, smallest_effect / deviations);
    let scatter = |row: usize| {
        (kept..count).map(|column| effects[(row, column)] * effects[(row, column)]).sum::<f64>().sqrt()
    };
    let left_out = |row: usize| (kept..count).map(|column| effects[(row, column)].abs()).sum::<f64>();
    let effect = |column: usize| effects.column(column).iter().map(|one| one.abs()).fold(0.0, f64::max);
    let region = JointRegion {
        directions: (0..kept).map(|column| direction(&paths, &changes, column, deviations)).collect(),
        effects: (0..kept).map(|column| deviations * effect(column)).collect(),
        left_out: count - kept,
        change_left_out: BETWEEN_TWO * (0..effects.nrows()).map(scatter).fold(0.0, f64::max),
        effect_left_out: deviations * (0..effects.nrows()).map(left_out).fold(0.0, f64::max),
        deviations,
    };
    match below_zero(&region, found, &plant) {
        Some(name) => Err(JointRegionError::BelowZero(name)),
        None => Ok(region),
    }
}

/// The project with the identified valve and the unchanged dynamics of its spool; `None` without a
/// rig.
pub fn with_valve(project: &Project, found: &Identification) -> Option<Project> {
    let mut project = project.clone();
    let valve = &mut project.actuator.as_mut()?.valve;
    let all = found.coefficients;
    let (flow, leakage) = (all.flow_coefficients, all.leakage_coefficients);
    valve.flow = ValveCoefficients::Edges { edges: flow, rating: valve.flow.rating().copied() };
    valve.leakage = ValveCoefficients::Edges { edges: leakage, rating: valve.leakage.rating().copied() };
    let shapes = all.leakage_shapes;
    valve.leakage_shape = shapes.supply_to_a;
    valve.leakage_shapes = found.tested.terms.leakage_by_edge.then_some(shapes);
    let OpeningShape { lap_positive: positive, lap_negative: negative, saturation } = all.opening;
    valve.lap = found.tested.terms.lap.then_some(ValveLap { positive, negative });
    valve.saturation = found.tested.terms.saturation.then_some(saturation);
    valve.leakage_model = found.tested.leakage_model;
    valve.transition_pressure = found.tested.transition_pressure;
    valve.nominal_voltage = found.tested.nominal_voltage;
    (valve.tare_flow, valve.tare_pressure) = (all.tare_flow, Some(found.tested.tare_reference_drop));
    valve.null_bias = all.null_bias;
    let width = found.estimates.get(HYSTERESIS).copied().flatten();
    let may_vanish = width.is_none_or(|width| width.interval[0] == 0.0);
    valve.hysteresis = (!may_vanish).then_some(all.hysteresis_width);
    Some(project)
}

/// Matrix D L: change of each coefficient of the plant with independent standard normal numbers.
fn spread(found: &Identification, plant: &[usize]) -> DMatrix<f64> {
    let all = COEFFICIENT_NAMES.len();
    let count = plant.len();
    let of = |place: usize| plant.get(place).copied().unwrap_or(0);
    let correlation = |i: usize, j: usize| {
        // a coefficient that is known exactly has no correlation
        let stated = found.correlations.get(of(i) * all + of(j)).copied().filter(|one| one.is_finite());
        stated.unwrap_or(f64::from(u8::from(i == j)))
    };
    let eigen = SymmetricEigen::new(DMatrix::from_fn(count, count, correlation));
    DMatrix::from_fn(count, count, |i, j| {
        let deviation = found.deviations.get(of(i)).copied().unwrap_or(0.0);
        deviation * eigen.eigenvectors[(i, j)] * eigen.eigenvalues[j].max(0.0).sqrt()
    })
}

/// Rotation after which each column of the effects has as much of them as remains after the earlier
/// ones.
fn turned(effects: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(effects.transpose() * effects);
    let count = eigen.eigenvalues.len();
    let mut order: Vec<usize> = (0..count).collect();
    sort_by_number(&mut order, |index| -eigen.eigenvalues[*index]);
    DMatrix::from_fn(count, count, |row, column| {
        order.get(column).map_or(0.0, |index| eigen.eigenvectors[(row, *index)])
    })
}

/// Number of leading columns that are needed so that the others together have less effect than this
/// on every row.
fn kept(effects: &DMatrix<f64>, smallest: f64) -> usize {
    let count = effects.ncols();
    let others = |from: usize| {
        let of_row = |row: usize| (from..count).map(|column| effects[(row, column)].abs()).sum::<f64>();
        (0..effects.nrows()).map(of_row).fold(0.0, f64::max)
    };
    (0..count).find(|from| others(*from) <= smallest).unwrap_or(count)
}

fn direction(
    paths: &[String],
    changes: &DMatrix<f64>,
    column: usize,
    deviations: f64,
) -> UncertaintyDirection {
    let changes = changes.column(column);
    let numbers = paths.iter().cloned().zip(changes.iter().copied());
    UncertaintyDirection {
        name: format!("valve_{}", column + 1),
        deviations,
        points: 2,
        changes: NumberChanges { numbers: numbers.filter(|(_, change)| *change != 0.0).collect() },
    }
}

/// A coefficient that is negative at the ends of the directions, although it must not be.
fn below_zero(region: &JointRegion, found: &Identification, plant: &[usize]) -> Option<String> {
    let reach = |path: &str| {
        let changes = region.directions.iter().flat_map(|direction| &direction.changes.numbers);
        changes.filter(|(name, _)| name == path).map(|(_, change)| change.abs()).sum::<f64>()
    };
    let numbers = found.coefficients.to_array();
    plant.iter().filter(|index| !Kind::of(**index).may_be_negative()).find_map(|index| {
        let path = found.path(COEFFICIENT_NAMES.get(*index)?.0);
        (*numbers.get(*index)? < region.deviations * reach(&path)).then_some(path)
    })
}

/// Half width r of the box that contains this many independent standard normal numbers together
/// with 95 %.
fn deviations(count: usize) -> f64 {
    let outside = 1.0 - pow(COVERAGE, 1.0 / count as f64);
    let [mut low, mut high] = [0.0_f64, 10.0];
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        if erfc(middle / std::f64::consts::SQRT_2) > outside {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
