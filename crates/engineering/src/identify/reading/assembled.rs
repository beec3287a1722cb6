//! Assembly of columns into a test: inputs of the valve, and recorded signals.

use phea_hydraulics::servovalve::{PortCircuit, Supply, TestInput, WarmOil};

use super::error::{RecordedTestError, RecordedTestHint};
use super::turns::turns;
use super::{Known, Taken};
use crate::followed::{followed, roughness};
use crate::identify::recording::{RecordedSignal, Recording, SignalKind};
use crate::project::{Accuracy, Findings, Place, RawFinding, RecordedTest, TestSignal};

/// Test with these columns.
pub(super) fn assembled(
    declared: &RecordedTest,
    taken: &Taken,
    circuit: PortCircuit,
    known: &Known,
) -> Recording {
    let [a, b] = [TestSignal::PressureA, TestSignal::PressureB].map(|signal| taken.of(signal));
    let flow = taken.of(TestSignal::Flow);
    let [command, supply, tank] =
        [TestSignal::Command, TestSignal::SupplyPressure, TestSignal::TankPressure].map(|one| taken.of(one));
    let (command_roughness, followed) = command.map_or((0.0, Vec::new()), without_noise);
    let times = taken.of(TestSignal::Time).unwrap_or_default();
    let turns = turns(times, &followed);
    let input = |row: usize| {
        let at = |values: Option<&[f64]>| values.and_then(|values| values.get(row).copied());
        TestInput {
            command: at(command).unwrap_or(0.0),
            followed_command: at(Some(&followed)).unwrap_or(0.0),
            turn: turns.get(row).copied().flatten(),
            supply: Supply {
                pressure: at(supply).or(known.supply_pressure).unwrap_or(0.0),
                tank_pressure: at(tank).unwrap_or(known.tank_pressure),
            },
            load_pressure: match circuit {
                PortCircuit::Connected => at(a).zip(at(b)).map_or(0.0, |(a, b)| a - b),
                PortCircuit::Blocked => 0.0,
            },
            oil: WarmOil::STATED,
            memory: 0.0,
            lag: known.spool_delay * rate(times, &followed, row).unwrap_or(0.0),
        }
    };
    let inputs: Vec<TestInput> = (0..taken.rows()).map(input).collect();
    let shown = |kind, values: Option<&[f64]>| {
        values.map(|values| RecordedSignal {
            kind,
            values: values.iter().map(|value| Some(*value).filter(|value| !value.is_nan())).collect(),
        })
    };
    let mut signals = Vec::new();
    match circuit {
        PortCircuit::Blocked => {
            signals.extend(shown(SignalKind::PressureA, a));
            signals.extend(shown(SignalKind::PressureB, b));
            signals.extend(
                taken
                    .of(TestSignal::LeakFlow)
                    .map(|values| RecordedSignal { kind: SignalKind::LeakFlow, values: turning(values) }),
            );
        }
        PortCircuit::Connected => {
            let mean = a.zip(b).map(means);
            signals.extend(shown(SignalKind::MeanPressure, mean.as_deref()));
            signals.extend(flow.map(port_flow));
        }
    }
    Recording {
        file: declared.file.clone(),
        circuit,
        command_roughness,
        times: times.to_vec(),
        inputs,
        oil_temperature: taken.of(TestSignal::OilTemperature).map(<[f64]>::to_vec),
        accuracies: accuracies(declared, taken),
        signals,
    }
}

fn means((one, other): (&[f64], &[f64])) -> Vec<f64> {
    one.iter().zip(other).map(|(one, other)| f64::midpoint(*one, *other)).collect()
}

/// Rate of change of a command from the row before.
fn rate(times: &[f64], command: &[f64], row: usize) -> Option<f64> {
    let before = row.checked_sub(1)?;
    let difference = |values: &[f64]| Some(values.get(row)? - values.get(before)?);
    Some(difference(command)? / difference(times)?)
}

/// Standard deviation of a command's noise, and the command without it. A record without small
/// reversals has rounding at most: the valve followed it.
fn without_noise(command: &[f64]) -> (f64, Vec<f64>) {
    let rough = roughness(command);
    let followed = followed(command, rough);
    (if followed == command { 0.0 } else { rough }, followed)
}

/// Stated accuracies of the instruments whose columns exist.
fn accuracies(declared: &RecordedTest, taken: &Taken) -> Vec<(TestSignal, Accuracy)> {
    let of = |signal: TestSignal| {
        taken.of(signal)?;
        Some((signal, declared.column(signal)?.stated_accuracy(signal.dimension())?))
    };
    TestSignal::ALL.into_iter().filter_map(of).collect()
}

/// A flow between the ports: from a meter that indicates the direction if some of it is negative.
fn port_flow(values: &[f64]) -> RecordedSignal {
    let signed = values.iter().any(|value| *value < 0.0);
    let kind = if signed { SignalKind::PortFlow } else { SignalKind::PortFlowMagnitude };
    RecordedSignal { kind, values: turning(values) }
}

/// Reading of a flow meter while it turns.
fn turning(values: &[f64]) -> Vec<Option<f64>> {
    values.iter().map(|value| Some(*value).filter(|value| *value != 0.0 && !value.is_nan())).collect()
}

/// True if a signal other than inputs was recorded.
pub(super) fn is_test(taken: &Taken, circuit: PortCircuit, whole: Place, findings: &mut Findings) -> bool {
    let has = |signal: TestSignal| taken.of(signal).is_some();
    let [a, b] = [TestSignal::PressureA, TestSignal::PressureB].map(has);
    let is_test = match circuit {
        PortCircuit::Blocked => a || b || has(TestSignal::LeakFlow),
        PortCircuit::Connected => (a && b) || has(TestSignal::Flow),
    };
    if !is_test {
        findings.push(RawFinding::error(whole, RecordedTestError::OnlyInputs.to_string()));
    }
    is_test
}

/// Warns of joined ports between which the drop was not recorded: the meter takes it, and the valve
/// then appears to have less flow.
pub(super) fn warn_of_unknown_drop(
    taken: &Taken,
    circuit: PortCircuit,
    whole: Place,
    findings: &mut Findings,
) {
    let lacks = |signal: &TestSignal| taken.of(*signal).is_none();
    let absent = [TestSignal::PressureA, TestSignal::PressureB].into_iter().filter(lacks);
    let absent: Vec<String> = absent.map(|signal| format!("`{}`", signal.name())).collect();
    if circuit == PortCircuit::Blocked || absent.is_empty() {
        return;
    }
    let message = RecordedTestError::UnknownDrop { absent: absent.join(" and ") };
    let found = RawFinding::warning(whole, message.to_string());
    findings.push(found.help(RecordedTestHint::BothPressures.to_string()));
}
