//! Constant errors of instruments throughout the tests, and their effect on the residuals.

use nalgebra::DMatrix;
use phea_dynamics::least_squares::{Linearised, Settings};

use super::channels::Together;
use super::recording::{Recording, SignalKind};
use super::warm::TestOil;
use crate::project::{Accuracy, TestSignal};

/// An error of an instrument that is equal in all rows, of one standard deviation.
#[derive(Clone, Copy, Debug)]
enum SharedError {
    /// Error as a fraction of the reading.
    Gain(f64),
    /// Error in the unit of the signal.
    Zero(f64),
}

impl SharedError {
    fn on(self, value: f64) -> f64 {
        match self {
            SharedError::Gain(fraction) => value * fraction,
            SharedError::Zero(size) => size,
        }
    }
}

/// Change of every residual by one standard deviation of each stated error of the instruments.
///
/// An accuracy bounds the error, whose value within the bounds is unknown: its standard deviation
/// is the bound over sqrt(3) (GUM, 4.3.7). Columns of one signal with equal accuracies belong to
/// one instrument.
pub(super) fn shared_changes(
    together: &Together<'_>,
    variables: &[f64],
    oil: Option<&TestOil>,
) -> Vec<Vec<f64>> {
    let undisturbed = together.residuals(variables);
    let change = |(signal, accuracy, error): &(TestSignal, Accuracy, SharedError)| {
        let disturbed = |recording: &Recording| match recording.accuracies.contains(&(*signal, *accuracy)) {
            true => disturbed(recording, *signal, *error, oil),
            false => recording.clone(),
        };
        let recordings: Vec<Recording> = together.recordings.iter().map(disturbed).collect();
        let moved = Together { recordings: &recordings, ..together.clone() }.residuals(variables);
        moved.iter().zip(&undisturbed).map(|(moved, own)| moved - own).collect()
    };
    errors(together.recordings).iter().map(change).collect()
}

/// Remaining residuals of a minimum if the errors of the instruments are those that explain most of
/// them, within their stated accuracies, and the coefficients follow.
///
/// ```text
/// r - J x - D a        x, a by least squares,    |a| <= sqrt(3) standard deviations
/// ```
pub(super) fn without_errors(at: &Linearised, shared: &[Vec<f64>]) -> Vec<f64> {
    if shared.is_empty() {
        return at.residuals.clone();
    }
    let beyond = Settings::default().robust_beyond;
    let rows = at.residuals.len();
    let own = at.jacobian.len().checked_div(rows).unwrap_or(0);
    let count = own + shared.len();
    let row = |index: usize| {
        let slopes = at.jacobian.iter().skip(index * own).take(own).copied();
        slopes.chain(shared.iter().map(move |change| change.get(index).copied().unwrap_or(0.0)))
    };
    let [mut normal, mut score] = [DMatrix::<f64>::zeros(count, count), DMatrix::zeros(count, 1)];
    for (index, residual) in at.residuals.iter().enumerate().filter(|(_, one)| one.abs() <= beyond) {
        let slopes: Vec<f64> = row(index).collect();
        for (i, first) in slopes.iter().enumerate().filter(|(_, first)| **first != 0.0) {
            score[(i, 0)] += first * residual;
            slopes.iter().enumerate().for_each(|(j, second)| normal[(i, j)] += first * second);
        }
    }
    // an error has its stated standard deviation if the residuals do not determine it
    for index in 0..count {
        normal[(index, index)] += if index < own { 1e-9 * normal[(index, index)] + 1e-12 } else { 1.0 };
    }
    let Some(normal) = normal.cholesky() else { return at.residuals.clone() };
    let mut found = normal.solve(&score);
    let bound = 3.0_f64.sqrt();
    for index in own..count {
        found[(index, 0)] = found[(index, 0)].clamp(-bound, bound);
    }
    let explained = |index: usize| row(index).zip(found.iter()).map(|(slope, one)| slope * one).sum::<f64>();
    at.residuals.iter().enumerate().map(|(index, residual)| residual - explained(index)).collect()
}

/// All errors of all instruments, each once.
fn errors(recordings: &[Recording]) -> Vec<(TestSignal, Accuracy, SharedError)> {
    let mut instruments: Vec<(TestSignal, Accuracy)> = Vec::new();
    for instrument in recordings.iter().flat_map(|one| &one.accuracies) {
        if !instruments.contains(instrument) {
            instruments.push(*instrument);
        }
    }
    let of = |(signal, accuracy): (TestSignal, Accuracy)| {
        let root = 3.0_f64.sqrt();
        let found = match accuracy {
            Accuracy::OfReading(fraction) => vec![SharedError::Gain(fraction / root)],
            Accuracy::OfRange(size) => {
                let own = recordings.iter().filter(|one| one.accuracies.contains(&(signal, accuracy)));
                let greatest = own.map(|one| greatest(one, signal)).fold(0.0, f64::max);
                let gain = if greatest > 0.0 { size / root / greatest } else { 0.0 };
                vec![SharedError::Zero(size / root), SharedError::Gain(gain)]
            }
        };
        found.into_iter().map(move |error| (signal, accuracy, error))
    };
    instruments.into_iter().flat_map(of).collect()
}

/// Greatest recorded magnitude of a signal.
fn greatest(recording: &Recording, signal: TestSignal) -> f64 {
    let of_inputs = |of: fn(&phea_hydraulics::servovalve::TestInput) -> f64| {
        recording.inputs.iter().map(of).fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    let of_signal = |kinds: &[SignalKind]| {
        let values = kinds.iter().filter_map(|kind| recording.signal(*kind)).flat_map(|one| &one.values);
        values.flatten().fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    match signal {
        TestSignal::Command => of_inputs(|input| input.command),
        TestSignal::SupplyPressure => of_inputs(|input| input.supply.pressure),
        TestSignal::TankPressure => of_inputs(|input| input.supply.tank_pressure),
        TestSignal::PressureA => of_signal(&[SignalKind::PressureA, SignalKind::MeanPressure]),
        TestSignal::PressureB => of_signal(&[SignalKind::PressureB, SignalKind::MeanPressure]),
        TestSignal::LeakFlow => of_signal(&[SignalKind::LeakFlow]),
        TestSignal::Flow => of_signal(&[SignalKind::PortFlow, SignalKind::PortFlowMagnitude]),
        TestSignal::OilTemperature | TestSignal::Time => 0.0,
    }
}

/// The recording with this additional error of a signal.
fn disturbed(
    recording: &Recording,
    signal: TestSignal,
    error: SharedError,
    oil: Option<&TestOil>,
) -> Recording {
    let mut found = recording.clone();
    match signal {
        TestSignal::Command => found.inputs.iter_mut().for_each(|input| {
            input.command += error.on(input.command);
            input.followed_command += error.on(input.followed_command);
            input.turn = input.turn.map(|turn| turn + error.on(turn));
        }),
        TestSignal::SupplyPressure => {
            found
                .inputs
                .iter_mut()
                .for_each(|input| input.supply.pressure += error.on(input.supply.pressure));
        }
        TestSignal::TankPressure => found
            .inputs
            .iter_mut()
            .for_each(|input| input.supply.tank_pressure += error.on(input.supply.tank_pressure)),
        TestSignal::PressureA => port_pressure(&mut found, SignalKind::PressureA, 1.0, error),
        TestSignal::PressureB => port_pressure(&mut found, SignalKind::PressureB, -1.0, error),
        TestSignal::LeakFlow => values(&mut found, &[SignalKind::LeakFlow], error),
        TestSignal::Flow => {
            values(&mut found, &[SignalKind::PortFlow, SignalKind::PortFlowMagnitude], error);
        }
        TestSignal::OilTemperature => warmer(&mut found, error, oil),
        TestSignal::Time => {}
    }
    found
}

fn values(recording: &mut Recording, kinds: &[SignalKind], error: SharedError) {
    let signals = recording.signals.iter_mut().filter(|one| kinds.contains(&one.kind));
    for value in signals.flat_map(|one| &mut one.values).flatten() {
        *value += error.on(*value);
    }
}

/// Adds an error to the pressure of a port: to this pressure if the ports are shut; for joined
/// ports to the mean, and with its sign to the drop across the meter.
fn port_pressure(recording: &mut Recording, kind: SignalKind, sign: f64, error: SharedError) {
    values(recording, &[kind], error);
    let means = recording.signals.iter_mut().find(|one| one.kind == SignalKind::MeanPressure);
    let Some(means) = means else { return };
    for (mean, input) in means.values.iter_mut().zip(&mut recording.inputs) {
        let Some(mean) = mean else { continue };
        let change = error.on(*mean + sign * input.load_pressure / 2.0);
        *mean += change / 2.0;
        input.load_pressure += sign * change;
    }
}

fn warmer(recording: &mut Recording, error: SharedError, oil: Option<&TestOil>) {
    let Some((oil, temperatures)) = oil.zip(recording.oil_temperature.as_ref()) else { return };
    let read = recording.inputs.iter_mut().zip(temperatures).filter(|(_, one)| one.is_finite());
    for (input, temperature) in read {
        input.oil = oil.law.warmer(temperature + error.on(*temperature) - oil.reference);
    }
}
