//! A static test as it was recorded.

use phea_dynamics::order::{ends, median, sort_numbers};
use phea_hydraulics::servovalve::{PortCircuit, TestInput, TestOutput};

use crate::project::{Accuracy, TestSignal};

/// Differences of values, over their range, that are the rounding of their digits.
const ROUNDING: f64 = 1e-9;

/// Greatest distance of a value from a multiple of the step, in steps.
const OFF_STEP: f64 = 0.02;

/// A recorded test, rows in the order of time. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Path of the file.
    pub file: String,
    /// Circuit of the ports.
    pub circuit: PortCircuit,
    /// V, deviation of what differs from row to row in a command with noise; zero without.
    pub command_roughness: f64,
    /// s, of each row.
    pub times: Vec<f64>,
    /// Inputs of the valve.
    pub inputs: Vec<TestInput>,
    /// degC, of the oil in each row, where it was recorded.
    pub oil_temperature: Option<Vec<f64>>,
    /// The stated accuracies of its instruments.
    pub accuracies: Vec<(TestSignal, Accuracy)>,
    /// Recorded signals of the valve.
    pub signals: Vec<RecordedSignal>,
}

/// A part of a test in which the command goes one way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TestBranch {
    /// True where it rises.
    pub rises: bool,
    /// The rows.
    pub rows: std::ops::Range<usize>,
}

/// A signal over the rows of a recording. SI.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedSignal {
    /// Which.
    pub kind: SignalKind,
    /// A value for each row; `None` where the instrument showed nothing.
    pub values: Vec<Option<f64>>,
}

/// Kind of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// p_A.
    PressureA,
    /// p_B.
    PressureB,
    /// (p_A + p_B)/2 of joined ports, whose difference is an input.
    MeanPressure,
    /// Flow from the supply, tare flow included.
    LeakFlow,
    /// Flow from port A to port B.
    PortFlow,
    /// Flow by a meter that does not indicate the direction.
    PortFlowMagnitude,
}

impl SignalKind {
    /// As columns and JSON call it.
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

    /// Output of the model: weights of p_A, p_B, leakage and port flow.
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

    /// The combination of these.
    pub(super) fn shown(self, output: &TestOutput) -> f64 {
        let all = [output.pressure_a, output.pressure_b, output.leak_flow, output.port_flow];
        all.iter().zip(self.weights(output)).map(|(signal, weight)| signal * weight).sum()
    }
}

impl Recording {
    /// A signal of it.
    pub fn signal(&self, kind: SignalKind) -> Option<&RecordedSignal> {
        self.signals.iter().find(|signal| signal.kind == kind)
    }

    /// The lag of earlier cycles that the spool brings along, in V; zero of a test that begins
    /// without, as far as its rows show it.
    pub fn memory_at_start(&self) -> f64 {
        self.inputs.first().map_or(0.0, |input| input.memory)
    }

    /// The branches of the test: rows in a row whose command goes one way, rows at which it rests
    /// among those before them.
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
        // what rests before the first change belongs to it
        if let Some(first) = branches.first_mut() {
            first.rows.start = 0;
        }
        branches
    }

    /// The rows of these indices only.
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
    /// Smallest and largest value, single rows that their neighbours contradict left out.
    pub fn range(&self) -> [f64; 2] {
        ends(self.despiked().into_iter().flatten())
    }

    /// The step of the converter, or of the digits, that all values are multiples of from the least
    /// one on; zero where they have none.
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

    /// Each value, or its neighbour where that is between it and its other neighbour: the median
    /// of three.
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

/// Median drop from supply to tank, in Pa.
pub(super) fn usual_drop(recordings: &[Recording]) -> f64 {
    let inputs = recordings.iter().flat_map(|recording| &recording.inputs);
    median(inputs.map(|input| input.supply.pressure - input.supply.tank_pressure).collect())
}
