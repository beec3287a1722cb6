//! Check of flows between the ports against the declared valve: a difference means another unit, or
//! another valve.

use phea_dynamics::order::sort_numbers;
use phea_hydraulics::servovalve::PortCircuit;

use super::error::{ColumnSetting, RecordedTestError, RecordedTestHint};
use super::{Known, Taken};
use crate::project::{Findings, RawFinding, TestSignal};
use crate::quantity::{FLOW, UnitScale};
use crate::table::{Column, MeasuredTable};

/// Ratio of recorded to declared flow beyond which there is a warning.
const UNUSUAL: f64 = 2.0;
/// Ratio beyond which the recording is rejected.
const IMPOSSIBLE: f64 = 30.0;
/// Ratio within which another unit explains the flow.
const EXPLAINED: f64 = 1.6;
/// Fraction of the greatest command beyond which a row counts: far from null and leakage.
const FAR_FROM_NULL: f64 = 0.5;
/// Fewest such rows.
const FEWEST_ROWS: usize = 5;

/// Common units of a flow.
const UNITS: [&str; 6] = ["L/min", "mL/min", "L/s", "cm3/s", "m3/s", "gpm"];

/// Compares the flow of a metering test with the flow of the declared valve at these commands and
/// pressures, by the median over the rows far from null:
///
/// ```text
/// q = K |U|/U_n sqrt(p_S - p_T - |p_A - p_B|)        1/K^2 = 1/K_first^2 + 1/K_second^2
/// ```
///
/// with K of the two open edges in series.
pub(super) fn check(
    table: &MeasuredTable,
    columns: &[(TestSignal, Column)],
    taken: &Taken,
    circuit: PortCircuit,
    known: &Known,
    findings: &mut Findings,
) {
    let column = columns.iter().find(|(signal, _)| *signal == TestSignal::Flow);
    let (PortCircuit::Connected, Some((_, column))) = (circuit, column) else { return };
    let Some(ratio) = ratio(taken, known) else { return };
    if (1.0 / UNUSUAL..=UNUSUAL).contains(&ratio) {
        return;
    }
    let heading = table.heading(column).to_string();
    let place = table.headings.get(column.index).map(|heading| heading.place).unwrap_or_default();
    let message = RecordedTestError::FlowOfOtherValve { heading: heading.clone(), ratio }.to_string();
    let found = match (1.0 / IMPOSSIBLE..=IMPOSSIBLE).contains(&ratio) {
        true => RawFinding::warning(place, message),
        false => RawFinding::error(place, message),
    };
    let hint = match unit_that_fits(column, ratio) {
        Some(unit) => RecordedTestHint::UnitOfDeclaredValve {
            setting: ColumnSetting { key: "flow", heading, unit: unit.to_string() },
        },
        None => RecordedTestHint::DeclaredValve,
    };
    findings.push(found.help(hint.to_string()));
}

/// Median of the ratio of recorded to declared flow.
fn ratio(taken: &Taken, known: &Known) -> Option<f64> {
    let [positive, negative] = known.path_coefficients?;
    let [command, flow] = [TestSignal::Command, TestSignal::Flow].map(|signal| taken.of(signal));
    let [supply, tank, a, b] =
        [TestSignal::SupplyPressure, TestSignal::TankPressure, TestSignal::PressureA, TestSignal::PressureB]
            .map(|signal| taken.of(signal));
    let (command, flow) = (command?, flow?);
    let greatest = command.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let of_row = |(row, (command, flow)): (usize, (&f64, &f64))| {
        let at = |values: Option<&[f64]>| values.and_then(|values| values.get(row).copied());
        let load = at(a).zip(at(b)).map_or(0.0, |(a, b)| (a - b).abs());
        let drop = at(supply).or(known.supply_pressure)? - at(tank).unwrap_or(known.tank_pressure) - load;
        let path = if *command < 0.0 { negative } else { positive };
        let declared = path * command.abs() / known.nominal_voltage * drop.sqrt();
        let ratio = flow.abs() / declared;
        let is_read = command.abs() >= FAR_FROM_NULL * greatest && *flow != 0.0;
        (is_read && ratio.is_finite()).then_some(ratio)
    };
    let mut ratios: Vec<f64> = command.iter().zip(flow).enumerate().filter_map(of_row).collect();
    sort_numbers(&mut ratios);
    ratios.get(ratios.len() / 2).copied().filter(|_| ratios.len() >= FEWEST_ROWS)
}

/// Unit in which the flow is nearest to the declared one, if it is near.
fn unit_that_fits(column: &Column, ratio: f64) -> Option<&'static str> {
    let in_si = |unit: &str| UnitScale::new(unit, &FLOW).ok()?.read("1");
    let stated = in_si(&column.unit)?;
    let off = |unit: &&'static str| {
        let ratio = ratio * in_si(unit)? / stated;
        Some((ratio.max(1.0 / ratio), *unit)).filter(|(off, _)| *off < EXPLAINED)
    };
    let near = UNITS.iter().filter_map(off).reduce(|best, one| if one.0 < best.0 { one } else { best });
    near.map(|(_, unit)| unit)
}
