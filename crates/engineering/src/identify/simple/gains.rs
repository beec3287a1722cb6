//! Slopes at null: flow gain and pressure sensitivity.

use phea_dynamics::least_squares::{Linearised, Settings, minimise, uncertainty};
use phea_dynamics::order::sort_by_number;
use phea_hydraulics::servovalve::{PortCircuit, TestedValve, flow_coefficient_from_rating};

use super::straight_line::straight_line;
use super::{CurveReading, direction, largest_command};
use crate::identify::recording::{Recording, SignalKind};

/// Commands from null, over the nominal voltage, between which the flow gain is read: beyond the
/// leakage, and near null.
const GAIN_WINDOW: [f64; 2] = [0.03, 0.15];

/// Share of the greatest command beyond which a reversal is near.
const AWAY: f64 = 0.6;

/// Load pressure over the supply's up to which the pressure sensitivity is read.
const SENSITIVITY_WINDOW: f64 = 0.4;

/// Fewest rows of either.
const FEWEST: usize = 12;

/// dq/dU for positive and negative commands at this drop from supply to tank, by the test with the
/// smallest command that shows both.
///
/// ```text
/// K_qU = sqrt(p/2) d/dU (q/sqrt((p_S - p_T - |p_L|)/2))
/// ```
pub(super) fn flow_gains(
    recordings: &[Recording],
    tested: &TestedValve,
    null: Option<f64>,
    drop: f64,
) -> [Option<CurveReading>; 2] {
    let mut metered: Vec<&Recording> =
        recordings.iter().filter(|one| one.circuit == PortCircuit::Connected).collect();
    sort_by_number(&mut metered, |one| largest_command(std::slice::from_ref(*one)));
    let null = null.unwrap_or(0.0);
    let of = |recording: &Recording| {
        [1.0, -1.0].map(|sign| {
            let ways = [true, false].map(|rising| branch(recording, tested, null, (sign, rising)));
            let lines: Vec<CurveReading> = ways.into_iter().flatten().collect();
            CurveReading::mean(&lines).map(|slope| slope.times((drop / 2.0).sqrt()))
        })
    };
    let found = metered.into_iter().map(of).find(|found| found.iter().all(Option::is_some));
    found.unwrap_or_default()
}

/// Slope of q/sqrt(drop/2) over the command, on one side of null and one way.
fn branch(
    recording: &Recording,
    tested: &TestedValve,
    null: f64,
    (sign, rising): (f64, bool),
) -> Option<CurveReading> {
    let kinds = [SignalKind::PortFlow, SignalKind::PortFlowMagnitude];
    let signal = kinds.into_iter().find_map(|kind| recording.signal(kind))?;
    let values = signal.despiked();
    let [least, most] = GAIN_WINDOW.map(|share| share * tested.nominal_voltage);
    // away from the reversals, where the spool has not yet lost what it remembers
    let most = most.min(AWAY * largest_command(std::slice::from_ref(recording)));
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

/// d(p_A - p_B)/dU where both are equal, by the blocked test with the most rows around it, both
/// ways.
pub(super) fn pressure_sensitivity(recordings: &[Recording]) -> Option<CurveReading> {
    let blocked = recordings.iter().filter(|one| one.circuit == PortCircuit::Blocked);
    let of = |recording: &Recording| [true, false].map(|rising| around_null(recording, rising));
    let most = blocked.map(of).max_by_key(|ways| ways.iter().map(Vec::len).sum::<usize>())?;
    let slopes: Vec<CurveReading> = most.iter().filter_map(|points| inverse_slope(points)).collect();
    CurveReading::mean(&slopes)
}

/// Load pressure over the supply's, and command, one way.
fn around_null(recording: &Recording, rising: bool) -> Vec<(f64, f64, f64)> {
    let [Some(a), Some(b)] =
        [SignalKind::PressureA, SignalKind::PressureB].map(|kind| recording.signal(kind))
    else {
        return Vec::new();
    };
    let of_row = |row: usize| {
        let input = recording.inputs.get(row)?;
        let whole = input.supply.pressure - input.supply.tank_pressure;
        let load = (a.values.get(row).copied()?? - b.values.get(row).copied()??) / whole;
        let counts = load.abs() < SENSITIVITY_WINDOW && direction(recording, row) == Some(rising);
        counts.then_some((load, input.command, whole))
    };
    (0..recording.inputs.len()).filter_map(of_row).collect()
}

/// 1/(dU/dp_L) at p_L = 0, by U = c_0 + c_1 p_L + c_2 p_L |p_L| + c_3 p_L^3: an edge that opens
/// bends the curve, to either side alike.
fn inverse_slope(points: &[(f64, f64, f64)]) -> Option<CurveReading> {
    if points.len() < FEWEST {
        return None;
    }
    let scale = points.iter().map(|(_, command, _)| command.abs()).fold(1e-6, f64::max);
    let terms = |load: f64| [1.0, load, load * load.abs(), load * load * load];
    let mut bent = |x: &[f64]| {
        let shown = |load: f64| x.iter().zip(terms(load)).map(|(c, term)| c * term).sum::<f64>();
        let residuals = points.iter().map(|(load, command, _)| shown(*load) - command / scale).collect();
        let jacobian = points.iter().flat_map(|(load, _, _)| terms(*load)).collect();
        Ok(Some(Linearised { residuals, jacobian }))
    };
    let settings = Settings { robust_beyond: f64::INFINITY, tolerance: 1e-14, ..Settings::default() };
    let found = minimise(&[0.0; 4], &[[-1e3, 1e3]; 4], settings, &mut bent).ok()?;
    let groups: Vec<usize> = (0..points.len()).collect();
    let told = uncertainty(&found.linearised, &groups, 4, f64::INFINITY);
    let (slope, deviation) = (*found.variables.get(1)?, *told.deviations.get(1)?);
    let whole = points.iter().map(|(_, _, whole)| whole).sum::<f64>() / points.len() as f64;
    let value = whole / (slope * scale);
    (slope > 0.0).then(|| CurveReading::of(value, value * deviation / slope))
}
