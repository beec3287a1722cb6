//! Recorded tests from CSV files, as loggers and spreadsheets write them.
//!
//! Columns are known by their names; the unit belongs to the name (`supply_pressure_bar`, `pressure_a
//! [bar]`) or stands in a row of units. Separators are commas, semicolons or tabs; with the last two
//! a decimal sign may be a comma. Rows above the names, and empty ones, are left out.

mod column;
mod sheet;

use phea_hydraulics::servovalve::{PortCircuit, Supply, TestInput};

use self::column::{Quantity, columns};
use self::sheet::Sheet;
use super::Known;
use super::recording::{RecordedSignal, Recording, SignalKind};
use crate::project::{Findings, RawFinding, Refusal};
use crate::source::Source;

/// Fewest rows of a test.
const FEWEST_ROWS: usize = 20;

/// The recordings of these files, in their order.
///
/// # Errors
/// Everything that is wrong in the files, with its places.
pub fn recordings(
    source: &dyn Source,
    paths: &[String],
    known: &Known,
) -> Result<Vec<Recording>, Box<Refusal>> {
    let mut findings = Findings::default();
    let mut found = Vec::with_capacity(paths.len());
    for path in paths {
        match source.read(path) {
            Ok(bytes) => found.extend(recording(path, &bytes, known, &mut findings)),
            Err(error) => findings.unreadable(path, &error.to_string()),
        }
    }
    if findings.error_count() > 0 { Err(Box::new(findings.report())) } else { Ok(found) }
}

fn recording(path: &str, bytes: &[u8], known: &Known, findings: &mut Findings) -> Option<Recording> {
    let sheet = Sheet::read(path, bytes, findings)?;
    let columns = columns(&sheet, findings)?;
    let before = findings.error_count();
    let mut times: Vec<f64> = Vec::with_capacity(sheet.rows.len());
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(sheet.rows.len()); columns.len()];
    for row in &sheet.rows {
        if !sheet.is_complete(row, findings) {
            continue;
        }
        for (column, values) in columns.iter().zip(&mut values) {
            let Some(value) = column.value(row, &sheet, known.nominal_voltage, findings) else { continue };
            if column.quantity == Quantity::Time {
                if let Some(last) = times.last().filter(|last| value <= **last) {
                    let message = if value == *last {
                        "the time of the row before"
                    } else {
                        "a time before that of the row before"
                    };
                    findings.push(
                        RawFinding::error(column.place(row), message)
                            .expected("times that increase from row to row"),
                    );
                }
                times.push(value);
            }
            values.push(value);
        }
    }
    if findings.error_count() > before {
        return None;
    }
    let whole = sheet.header_place();
    if sheet.rows.len() < FEWEST_ROWS {
        let found = RawFinding::error(whole, format!("{} rows are too few for a test", sheet.rows.len()));
        findings.push(found.expected(format!("at least {FEWEST_ROWS} rows below the names of the columns")));
        return None;
    }
    let of = |quantity: Quantity| {
        columns.iter().position(|column| column.quantity == quantity).and_then(|index| values.get(index))
    };
    let (supplies, has_supply) = match (of(Quantity::SupplyPressure), known.supply_pressure) {
        (Some(values), _) => (values.clone(), true),
        (None, Some(pressure)) => (vec![pressure; sheet.rows.len()], true),
        (None, None) => (vec![], false),
    };
    if !has_supply {
        let found = RawFinding::error(whole, "there is no supply pressure");
        findings.push(found.expected("a column such as `supply_pressure_bar`, or a project that states it"));
        return None;
    }
    let assembled = assembled(path, &of, &supplies, known);
    checked(assembled, whole, findings)
}

/// The columns, as what acted on the valve and what was recorded of it.
fn assembled<'v>(
    path: &str,
    of: &impl Fn(Quantity) -> Option<&'v Vec<f64>>,
    supplies: &[f64],
    known: &Known,
) -> Recording {
    let [a, b] = [of(Quantity::PressureA), of(Quantity::PressureB)];
    let flow = of(Quantity::Flow);
    let circuit = if flow.is_some() { PortCircuit::Connected } else { PortCircuit::Blocked };
    let at = |values: Option<&Vec<f64>>, row: usize| values.and_then(|values| values.get(row).copied());
    let input = |(row, pressure): (usize, &f64)| {
        let load = at(a, row).zip(at(b, row)).map_or(0.0, |(a, b)| a - b);
        TestInput {
            command: at(of(Quantity::Command), row).unwrap_or(0.0),
            supply: Supply {
                pressure: *pressure,
                tank_pressure: at(of(Quantity::TankPressure), row).unwrap_or(known.tank_pressure),
            },
            load_pressure: if circuit == PortCircuit::Connected { load } else { 0.0 },
        }
    };
    let inputs: Vec<TestInput> = supplies.iter().enumerate().map(input).collect();
    let shown = |kind, values: Option<&Vec<f64>>| {
        values.map(|values| RecordedSignal { kind, values: values.iter().copied().map(Some).collect() })
    };
    let mut signals = Vec::new();
    match circuit {
        PortCircuit::Blocked => {
            signals.extend(shown(SignalKind::PressureA, a));
            signals.extend(shown(SignalKind::PressureB, b));
            signals.extend(shown(SignalKind::LeakFlow, of(Quantity::LeakFlow)));
        }
        PortCircuit::Connected => {
            let mean = a.zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::midpoint(*a, *b)).collect());
            signals.extend(shown(SignalKind::MeanPressure, mean.as_ref()));
            signals.extend(flow.map(|flow| port_flow(flow)));
        }
    }
    Recording { file: path.to_string(), circuit, inputs, signals }
}

/// A flow between the ports: by a meter that tells the direction if some of it is negative. What such
/// a meter shows while it stands still is no reading.
fn port_flow(values: &[f64]) -> RecordedSignal {
    let signed = values.iter().any(|value| *value < 0.0);
    let kind = if signed { SignalKind::PortFlow } else { SignalKind::PortFlowMagnitude };
    RecordedSignal { kind, values: values.iter().map(|value| (*value != 0.0).then_some(*value)).collect() }
}

/// Whether a test is one.
fn checked(recording: Recording, whole: crate::project::Place, findings: &mut Findings) -> Option<Recording> {
    let commands = || recording.inputs.iter().map(|input| input.command);
    let moves = commands().any(|command| commands().next() != Some(command));
    let dry = recording.inputs.iter().any(|input| input.supply.pressure <= input.supply.tank_pressure);
    let message = if !moves {
        "the command never moves: this is no test of a valve"
    } else if dry {
        "the supply pressure is not above the tank pressure in every row"
    } else if recording.signals.is_empty() {
        "there is nothing but inputs: neither a flow nor the pressure of a port"
    } else {
        return Some(recording);
    };
    findings.push(RawFinding::error(whole, message));
    None
}
