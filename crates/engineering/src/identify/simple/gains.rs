//! Slopes at null: flow gain and pressure sensitivity.

use phea_dynamics::least_squares::{Linearised, Settings, minimise, uncertainty};
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;
use phea_hydraulics::servovalve::{PortCircuit, TestedValve, flow_coefficient_from_rating};

use super::straight_line::straight_line;
use super::{direction, largest_command};
use crate::estimate::Estimate;
use crate::identify::evidence::DECISIVE;
use crate::identify::recording::{Recording, SignalKind};

/// Commands from null, divided by the nominal voltage, between which the flow gain is read: beyond
/// the leakage, and near null.
const GAIN_WINDOW: [f64; 2] = [0.03, 0.15];

/// Fraction of the greatest command beyond which a reversal is near.
const AWAY: f64 = 0.6;

/// Ratio of load pressure to supply pressure up to which the pressure sensitivity is read.
const SENSITIVITY_WINDOW: f64 = 0.4;

/// Fewest rows for either gain.
const FEWEST: usize = 12;

/// Slope dq/dU for positive and negative commands, and the commands from null between which it is
/// read, V, at this drop from supply to tank, from the test with the smallest command that shows
/// both.
///
/// ```text
/// K_qU = sqrt(p/2) d/dU (q/sqrt((p_S - p_T - |p_L|)/2))
/// ```
pub(super) fn flow_gains(
    recordings: &[Recording],
    tested: &TestedValve,
    null: Option<f64>,
    drop: f64,
) -> ([Option<Estimate>; 2], Option<[f64; 2]>) {
    let mut metered: Vec<&Recording> =
        recordings.iter().filter(|one| one.circuit == PortCircuit::Connected).collect();
    sort_by_number(&mut metered, |one| largest_command(std::slice::from_ref(*one)));
    let null = null.unwrap_or(0.0);
    let of = |recording: &Recording| {
        [1.0, -1.0].map(|sign| {
            let ways = [true, false].map(|rising| branch(recording, tested, null, sign, rising));
            let lines: Vec<Estimate> = ways.into_iter().flatten().collect();
            Estimate::mean(&lines).map(|slope| slope.times((drop / 2.0).sqrt()))
        })
    };
    let mut found = metered.into_iter().map(|one| (of(one), Some(gain_window(one, tested))));
    found.find(|(gains, _)| gains.iter().all(Option::is_some)).unwrap_or_default()
}

/// Commands from null between which the flow gain is read, V: far from the reversals, where the
/// memory of the spool still has an effect.
fn gain_window(recording: &Recording, tested: &TestedValve) -> [f64; 2] {
    let [least, most] = GAIN_WINDOW.map(|fraction| fraction * tested.nominal_voltage);
    [least, most.min(AWAY * largest_command(std::slice::from_ref(recording)))]
}

/// Slope of q/sqrt(drop/2) as a function of the command, on one side of null and in one direction.
fn branch(
    recording: &Recording,
    tested: &TestedValve,
    null: f64,
    sign: f64,
    rising: bool,
) -> Option<Estimate> {
    let kinds = [SignalKind::PortFlow, SignalKind::PortFlowMagnitude];
    let signal = kinds.into_iter().find_map(|kind| recording.signal(kind))?;
    let values = signal.despiked();
    let [least, most] = gain_window(recording, tested);
    let of_row = |(row, value): (usize, &Option<f64>)| {
        let input = recording.inputs.get(row)?;
        let drop = input.supply.pressure - input.supply.tank_pressure - input.load_pressure.abs();
        let counts = (least..most).contains(&(sign * (input.command - null)))
            && direction(recording, row) == Some(rising)
            && drop > 0.0;
        let edge = flow_coefficient_from_rating((*value)?.abs(), drop);
        counts.then_some((sign * input.command, edge))
    };
    let points: Vec<(f64, f64)> = values.iter().enumerate().filter_map(of_row).collect();
    if points.len() < FEWEST {
        return None;
    }
    straight_line(&points).map(|line| line.slope).filter(|slope| slope.value > 0.0)
}

/// A row near equal pressures: ratio of load pressure to supply pressure, command, and the supply's
/// drop.
type NearNull = (f64, f64, f64);

/// Slope d(p_A - p_B)/dU at equal pressures, from all rows around it of all tests with shut ports.
///
/// ```text
/// U = c_b + c_1 p_L + bends(p_L)        K_pU = 1/c_1
/// ```
///
/// An opening edge bends the curve. Each branch b has its own null: the hysteresis is between those
/// of the two directions, and a branch that begins without the memory of a reversal has another.
/// Such a branch is omitted if others have enough rows, as its spool may begin at rest.
pub(super) fn pressure_sensitivity(recordings: &[Recording]) -> Option<Estimate> {
    let blocked = || recordings.iter().filter(|one| one.circuit == PortCircuit::Blocked);
    let near_null = |first: usize| -> Vec<Vec<NearNull>> {
        let all = blocked().flat_map(|one| {
            one.branches().into_iter().skip(first).map(|branch| around_null(one, branch.rows))
        });
        all.filter(|points| points.len() > FEWEST_OF_BRANCH).collect()
    };
    let later = near_null(1);
    let is_enough = later.iter().map(Vec::len).sum::<usize>() >= FEWEST;
    inverse_slope(&if is_enough { later } else { near_null(0) })
}

/// Number of rows of a branch that its null consumes.
const FEWEST_OF_BRANCH: usize = 1;

fn around_null(recording: &Recording, rows: std::ops::Range<usize>) -> Vec<NearNull> {
    let [Some(a), Some(b)] =
        [SignalKind::PressureA, SignalKind::PressureB].map(|kind| recording.signal(kind))
    else {
        return Vec::new();
    };
    let of_row = |row: usize| {
        let input = recording.inputs.get(row)?;
        let whole = input.supply.pressure - input.supply.tank_pressure;
        let load = (a.values.get(row).copied()?? - b.values.get(row).copied()??) / whole;
        (load.abs() < SENSITIVITY_WINDOW).then_some((load, input.command, whole))
    };
    rows.filter_map(of_row).collect()
}

/// Bend of the command as a function of the load pressure, in addition to its slope.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NullBend {
    /// Terms p_L^2 and p_L^3.
    Smooth,
    /// Terms p_L |p_L| and p_L^3, for equal edges, which open at equal pressures.
    Even,
    /// Terms p_L^2, p_L^3 and max(p_L - p_0, 0), for unequal edges, which open elsewhere.
    KinkAt(f64),
}

impl NullBend {
    /// All compared bends: kinks in steps of the window.
    fn all() -> impl Iterator<Item = NullBend> {
        let kink = |step: i32| NullBend::KinkAt(f64::from(step) / f64::from(KINKS) * SENSITIVITY_WINDOW);
        [NullBend::Smooth, NullBend::Even].into_iter().chain((1 - KINKS..KINKS).map(kink))
    }

    fn terms(self, load: f64) -> Vec<f64> {
        let cube = load * load * load;
        match self {
            NullBend::Smooth => vec![load * load, cube],
            NullBend::Even => vec![load * load.abs(), cube],
            NullBend::KinkAt(place) => vec![load * load, cube, (load - place).max(0.0)],
        }
    }

    /// Number of its parameters, including the place of a kink.
    fn numbers(self) -> usize {
        if matches!(self, NullBend::KinkAt(_)) { 4 } else { 2 }
    }

    /// Slope at zero from these numbers, with that of the load pressure before those of the terms.
    fn slope(self, numbers: &[f64]) -> Option<f64> {
        let beyond = matches!(self, NullBend::KinkAt(place) if place < 0.0);
        let kink = if beyond { *numbers.get(3)? } else { 0.0 };
        Some(numbers.first()? + kink)
    }
}

/// Number of places of a kink on each side.
const KINKS: i32 = 10;

/// Slope 1/(dU/dp_L) at p_L = 0 over these branches, with the bend that the information criterion
/// favours.
fn inverse_slope(branches: &[Vec<NearNull>]) -> Option<Estimate> {
    let rows = branches.iter().map(Vec::len).sum::<usize>();
    let fits = NullBend::all().filter(|bend| rows > bend.numbers() + 1 + branches.len());
    let found: Vec<(Estimate, f64)> = fits.filter_map(|bend| bent(branches, bend)).collect();
    let (best, least) = found.iter().copied().min_by(|one, other| one.1.total_cmp(&other.1))?;
    // the value of another bend that explains the rows about as well is possible too
    let likely = found.iter().filter(|(_, criterion)| criterion - least < DECISIVE);
    let ends = likely.filter_map(|(reading, _)| reading.bounds());
    let [low, high] = ends.fold(best.bounds()?, |[low, high], [from, to]| [low.min(from), high.max(to)]);
    (rows >= FEWEST).then_some(Estimate { interval: [low, high], ..best })
}

/// Slope with this bend, and the criterion of Schwarz.
fn bent(branches: &[Vec<NearNull>], bend: NullBend) -> Option<(Estimate, f64)> {
    let all = branches.iter().enumerate();
    let points: Vec<(usize, NearNull)> =
        all.flat_map(|(branch, points)| points.iter().map(move |point| (branch, *point))).collect();
    let scale = points.iter().map(|(_, (_, command, _))| command.abs()).fold(1e-6, f64::max);
    let count = 1 + bend.terms(0.0).len() + branches.len();
    let terms = |branch: usize, load: f64| {
        let mut terms = vec![load];
        terms.extend(bend.terms(load));
        terms.extend((0..branches.len()).map(|other| f64::from(u8::from(other == branch))));
        terms
    };
    let mut linear = |x: &[f64]| {
        let of = |branch, load| terms(branch, load).iter().zip(x).map(|(term, c)| term * c).sum::<f64>();
        let residual =
            |(branch, (load, command, _)): &(usize, NearNull)| of(*branch, *load) - command / scale;
        let jacobian = points.iter().flat_map(|(branch, (load, ..))| terms(*branch, *load)).collect();
        Ok(Some(Linearised { residuals: points.iter().map(residual).collect(), jacobian }))
    };
    let settings = Settings { robust_beyond: f64::INFINITY, tolerance: 1e-14, ..Settings::default() };
    let found = minimise(&vec![0.0; count], &vec![[-1e3, 1e3]; count], settings, &mut linear).ok()?;
    let groups: Vec<usize> = (0..points.len()).collect();
    let uncertainty = uncertainty(&found.linearised, &groups, count, f64::INFINITY);
    let (slope, deviation) = (bend.slope(&found.variables)?, *uncertainty.deviations.first()?);
    let whole = points.iter().map(|(_, (.., whole))| whole).sum::<f64>() / points.len() as f64;
    let value = whole / (slope * scale);
    let rows = points.len() as f64;
    let mean_square = (2.0 * found.cost / rows).max(f64::MIN_POSITIVE);
    let numbers = (1 + bend.numbers() + branches.len()) as f64;
    let criterion = rows * portable::ln(mean_square) + numbers * portable::ln(rows);
    (slope > 0.0).then(|| (Estimate::of(value, value * deviation / slope), criterion))
}
