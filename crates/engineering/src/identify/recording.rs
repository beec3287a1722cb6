//! A recorded static test.

use phea_dynamics::order::{ends, median, sort_numbers};
use phea_hydraulics::servovalve::{PortCircuit, TestInput, TestOutput};

use crate::project::{Accuracy, TestSignal};

/// Differences of values, relative to their range, that are the rounding of their digits.
const ROUNDING: f64 = 1e-9;

/// Greatest distance of a value from a multiple of the step, in steps.
const OFF_STEP: f64 = 0.02;

/// A recorded test, rows in the order of time, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Path of the file.
    pub file: String,
    /// Circuit of the ports.
    pub circuit: PortCircuit,
    /// Standard deviation of the row-to-row differences of a command with noise, V; zero without
    /// noise.
    pub command_roughness: f64,
    /// Time of each row, s.
    pub times: Vec<f64>,
    /// Inputs of the valve.
    pub inputs: Vec<TestInput>,
    /// Temperature of the oil in each row, degC, if it was recorded.
    pub oil_temperature: Option<Vec<f64>>,
    /// Stated accuracies of its instruments.
    pub accuracies: Vec<(TestSignal, Accuracy)>,
    /// Recorded signals of the valve.
    pub signals: Vec<RecordedSignal>,
}

/// Part of a test in which the command moves in one direction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestBranch {
    /// True if the command rises.
    pub rises: bool,
    /// Rows of the branch.
    pub rows: std::ops::Range<usize>,
}

/// A signal over the rows of a recording, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedSignal {
    /// Kind of the signal.
    pub kind: SignalKind,
    /// Value for each row; `None` if the instrument showed nothing.
    pub values: Vec<Option<f64>>,
}

/// Kind of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// Pressure p_A.
    PressureA,
    /// Pressure p_B.
    PressureB,
    /// Mean pressure (p_A + p_B)/2 of joined ports, whose difference is an input.
    MeanPressure,
    /// Flow from the supply, including the tare flow.
    LeakFlow,
    /// Flow from port A to port B.
    PortFlow,
    /// Flow from a meter that does not indicate the direction.
    PortFlowMagnitude,
}

impl SignalKind {
    /// Name in columns and JSON.
    pub fn name(self) -> &'static str {
        match self {
            SignalKind::PressureA => "pressure_a",
            SignalKind::PressureB => "pressure_b",
            SignalKind::MeanPressure => "mean_pressure",
            SignalKind::LeakFlow => "leak_flow",
            SignalKind::PortFlow | SignalKind::PortFlowMagnitude => "flow",
        }
    }

    /// True for a pressure.
    pub fn is_pressure(self) -> bool {
        matches!(self, SignalKind::PressureA | SignalKind::PressureB | SignalKind::MeanPressure)
    }

    /// Weights of p_A, p_B, leakage and port flow in the output of the model.
    pub(super) fn weights(self, output: &TestOutput) -> [f64; 4] {
        match self {
            SignalKind::PressureA => [1.0, 0.0, 0.0, 0.0],
            SignalKind::PressureB => [0.0, 1.0, 0.0, 0.0],
            SignalKind::MeanPressure => [0.5, 0.5, 0.0, 0.0],
            SignalKind::LeakFlow => [0.0, 0.0, 1.0, 0.0],
            SignalKind::PortFlow => [0.0, 0.0, 0.0, 1.0],
            SignalKind::PortFlowMagnitude => [0.0, 0.0, 0.0, output.port_flow.signum()],
        }
    }

    /// Weighted combination of these outputs.
    pub(super) fn shown(self, output: &TestOutput) -> f64 {
        let all = [output.pressure_a, output.pressure_b, output.leak_flow, output.port_flow];
        all.iter().zip(self.weights(output)).map(|(signal, weight)| signal * weight).sum()
    }
}

impl Recording {
    /// A signal of the recording.
    pub fn signal(&self, kind: SignalKind) -> Option<&RecordedSignal> {
        self.signals.iter().find(|signal| signal.kind == kind)
    }

    /// Lag of the spool from earlier cycles, V; zero for a test whose rows show none.
    pub fn memory_at_start(&self) -> f64 {
        self.inputs.first().map_or(0.0, |input| input.memory)
    }

    /// Branches of the test: consecutive rows whose command moves in one direction, with rows at
    /// rest belonging to those before them.
    pub fn branches(&self) -> Vec<TestBranch> {
        let command = |row: usize| self.inputs.get(row).map(|input| input.followed_command);
        let mut branches: Vec<TestBranch> = Vec::new();
        for row in 1..self.inputs.len() {
            let Some((before, now)) = command(row - 1).zip(command(row)) else { continue };
            let last = branches.last_mut();
            match last {
                Some(last) if now == before || (now > before) == last.rises => last.rows.end = row + 1,
                None if now == before => {}
                _ => branches.push(TestBranch { rises: now > before, rows: row..row + 1 }),
            }
        }
        // rest before the first change belongs to the first branch
        if let Some(first) = branches.first_mut() {
            first.rows.start = 0;
        }
        branches
    }

    /// The recording reduced to the rows of these indices.
    pub(super) fn only(&self, rows: &[usize]) -> Recording {
        let inputs = rows.iter().filter_map(|row| self.inputs.get(*row).copied()).collect();
        let signals = self.signals.iter().map(|signal| RecordedSignal {
            kind: signal.kind,
            values: rows.iter().map(|row| signal.values.get(*row).copied().flatten()).collect(),
        });
        let these = |values: &Vec<f64>| rows.iter().filter_map(|row| values.get(*row).copied()).collect();
        Recording {
            file: self.file.clone(),
            circuit: self.circuit,
            command_roughness: self.command_roughness,
            times: these(&self.times),
            inputs,
            oil_temperature: self.oil_temperature.as_ref().map(these),
            accuracies: self.accuracies.clone(),
            signals: signals.collect(),
        }
    }
}

impl RecordedSignal {
    /// Smallest and largest value, without single rows that their neighbours contradict.
    pub fn range(&self) -> [f64; 2] {
        ends(self.despiked().into_iter().flatten())
    }

    /// Step of the converter, or of the digits, of which all values are multiples from the least
    /// one on; zero if they have none.
    pub(super) fn step(&self) -> f64 {
        let mut sorted: Vec<f64> = self.values.iter().flatten().copied().collect();
        sort_numbers(&mut sorted);
        let (Some(least), Some(most)) = (sorted.first().copied(), sorted.last().copied()) else { return 0.0 };
        let gaps = sorted.windows(2).filter_map(|pair| Some(pair.last()? - pair.first()?));
        let step = gaps.filter(|gap| *gap > ROUNDING * (most - least)).fold(f64::INFINITY, f64::min);
        let off = |value: &f64| ((value - least) / step - ((value - least) / step).round()).abs();
        let is_multiple = step.is_finite() && sorted.iter().all(|value| off(value) < OFF_STEP);
        if is_multiple { step } else { 0.0 }
    }

    /// Each value, or its neighbour if that is between it and its other neighbour: the median of
    /// three.
    pub(super) fn despiked(&self) -> Vec<Option<f64>> {
        let at = |row: Option<usize>| row.and_then(|row| self.values.get(row).copied().flatten());
        let of = |(row, value): (usize, &Option<f64>)| {
            let value = (*value)?;
            let [before, after] = [at(row.checked_sub(1)), at(row.checked_add(1))];
            Some(before.zip(after).map_or(value, |(before, after)| {
                let [low, high] = [before.min(after), before.max(after)];
                value.max(low).min(high)
            }))
        };
        self.values.iter().enumerate().map(of).collect()
    }
}

/// Median pressure drop from supply to tank, Pa.
pub(super) fn usual_drop(recordings: &[Recording]) -> f64 {
    let inputs = recordings.iter().flat_map(|recording| &recording.inputs);
    median(inputs.map(|input| input.supply.pressure - input.supply.tank_pressure).collect())
}
