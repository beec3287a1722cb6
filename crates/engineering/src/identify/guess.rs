//! First guesses: the values that section 5.2 of the thesis reads from the curves by hand.

use phea_hydraulics::servovalve::{
    Edges, PortCircuit, StaticCoefficients, TestedValve, flow_coefficient_from_rating,
};

use super::recording::{Recording, SignalKind, median};

/// The results of the calculations of the thesis, section 5.2; `None` where the test for it is
/// missing. SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimpleCalculations {
    /// K_vp by (4.12), corrected, for positive commands (edges 3 and 6) and negative ones (4 and 5).
    pub flow_coefficients: [Option<f64>; 2],
    /// K_vinp by (4.13).
    pub leakage_coefficient: Option<f64>,
    /// q_tare, the base of the leakage curve.
    pub tare_flow: Option<f64>,
    /// lambda of (4.14), by the width of the curve at half its height.
    pub leakage_shape: Option<f64>,
    /// Command of null with a rising and a falling command, in V.
    pub nulls: [Option<f64>; 2],
}

impl SimpleCalculations {
    /// Mean of both nulls.
    pub fn null_bias(&self) -> Option<f64> {
        let [rising, falling] = self.nulls;
        Some(f64::midpoint(rising?, falling?))
    }

    /// Their difference.
    pub fn hysteresis(&self) -> Option<f64> {
        let [rising, falling] = self.nulls;
        Some(rising? - falling?)
    }
}

/// The calculations, from the tests that allow them.
///
/// ```text
/// q_tare   mean leakage beyond 60 % of the amplitude
/// nulls    commands of the greatest leakage, rising and falling; else between the zeros of the flow's lines; else of p_A = p_B
/// K_vinp = (q_peak - q_tare)/sqrt(2 p_S)                       thesis (4.13)
/// lambda = 1.317/u_half                                        sech(1.317) = 1/2
/// K_vp   = dq/du/sqrt(p_S/2), by a straight line               thesis (4.12), corrected
/// ```
pub(super) fn simple_calculations(recordings: &[Recording], tested: &TestedValve) -> SimpleCalculations {
    let mut found = SimpleCalculations::default();
    for recording in recordings {
        if recording.signal(SignalKind::LeakFlow).is_some() {
            leakage(recording, tested, &mut found);
        }
        if recording.circuit == PortCircuit::Connected {
            flow(recording, tested, &mut found);
        }
    }
    let pressures = recordings.iter().filter(|one| one.circuit == PortCircuit::Blocked);
    for recording in pressures {
        for (index, null) in found.nulls.iter_mut().enumerate() {
            *null = null.or_else(|| crossing(recording, index == 0));
        }
    }
    found
}

/// The starting point of all coefficients: the calculations, or usual values where there are none.
/// A coefficient that may be zero starts at a value that would matter.
pub(super) fn first_guess(
    recordings: &[Recording],
    tested: &TestedValve,
    simple: &SimpleCalculations,
) -> StaticCoefficients {
    let [forward, backward] = simple.flow_coefficients;
    let leak = simple.leakage_coefficient;
    // leakage at null is about a hundredth of full flow
    let usual = forward.or(backward).or(leak.map(|leak| 120.0 * leak)).unwrap_or(3e-7);
    let [forward, backward] = [forward.unwrap_or(usual), backward.unwrap_or(usual)];
    let mean = f64::midpoint(forward, backward);
    let leak = leak.unwrap_or(mean / 120.0).max(mean / 2000.0);
    let null_leakage = leak * (2.0 * tested.tare_reference_drop).sqrt();
    let largest = largest_command(recordings);
    StaticCoefficients {
        flow_coefficients: Edges::from_array([forward, backward, backward, forward]),
        leakage_coefficients: Edges::equal(leak),
        leakage_shape: simple.leakage_shape.unwrap_or(100.0),
        tare_flow: simple.tare_flow.unwrap_or(0.8 * null_leakage).max(0.1 * null_leakage),
        null_bias: simple.null_bias().unwrap_or(0.0),
        hysteresis_width: simple
            .hysteresis()
            .unwrap_or(0.0)
            .max(0.002 * tested.nominal_voltage)
            .min(largest / 2.0),
    }
}

/// Greatest magnitude of a command.
fn largest_command(recordings: &[Recording]) -> f64 {
    let inputs = recordings.iter().flat_map(|recording| &recording.inputs);
    inputs.map(|input| input.command.abs()).fold(0.0, f64::max)
}

fn leakage(recording: &Recording, tested: &TestedValve, found: &mut SimpleCalculations) {
    let Some(signal) = recording.signal(SignalKind::LeakFlow) else { return };
    let largest = largest_command(std::slice::from_ref(recording));
    let values = signal.despiked();
    let rows = || {
        let known = values.iter().enumerate();
        known.filter_map(|(row, value)| Some((row, recording.inputs.get(row)?, (*value)?)))
    };
    let base = rows().filter(|(_, input, _)| input.command.abs() > 0.6 * largest);
    let tare = median(base.map(|(_, _, leak)| leak).collect());
    let mut highest: Vec<f64> = rows().map(|(_, _, leak)| leak).collect();
    highest.sort_by(f64::total_cmp);
    // a level that only a hundredth of the rows exceeds by noise
    let Some(peak) = highest.get(highest.len() * 99 / 100).copied().filter(|peak| *peak > tare) else {
        return;
    };
    let pressure =
        median(rows().map(|(_, input, _)| input.supply.pressure - input.supply.tank_pressure).collect());
    found.tare_flow = Some(tare);
    found.leakage_coefficient = Some((peak - tare) / (2.0 * pressure).sqrt());
    let above_half = |rising: bool| -> Vec<f64> {
        let high = rows().filter(|(_, _, leak)| *leak - tare > 0.5 * (peak - tare));
        let same = high.filter(|(row, _, _)| direction(recording, *row) == Some(rising));
        same.map(|(_, input, _)| input.command).collect()
    };
    let mut widths = Vec::new();
    for (null, rising) in found.nulls.iter_mut().zip([true, false]) {
        let commands = above_half(rising);
        let low = commands.iter().copied().fold(f64::INFINITY, f64::min);
        let high = commands.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if high > low {
            *null = Some(median(commands));
            widths.push((high - low) / 2.0);
        }
    }
    if let Some(half) = widths.into_iter().reduce(f64::min) {
        found.leakage_shape = Some((1.317 * tested.nominal_voltage / half).clamp(2.0, 2000.0));
    }
}

/// Whether the command rises at a row; `None` where it is constant.
fn direction(recording: &Recording, row: usize) -> Option<bool> {
    let before = recording.inputs.get(row.checked_sub(1)?)?.command;
    let now = recording.inputs.get(row)?.command;
    (now != before).then_some(now > before)
}

/// Command at which p_A and p_B are equal, going up or down, in V.
fn crossing(recording: &Recording, rising: bool) -> Option<f64> {
    let a = recording.signal(SignalKind::PressureA)?;
    let b = recording.signal(SignalKind::PressureB)?;
    let load = |row: usize| Some((*a.values.get(row)?)? - (*b.values.get(row)?)?);
    let crossed = (1..recording.inputs.len()).filter(|row| {
        let Some((before, now)) = load(row - 1).zip(load(*row)) else { return false };
        direction(recording, *row) == Some(rising) && (before < 0.0) != (now < 0.0)
    });
    let commands: Vec<f64> =
        crossed.filter_map(|row| recording.inputs.get(row).map(|input| input.command)).collect();
    (!commands.is_empty()).then(|| median(commands))
}

/// Both branches of the flow as straight lines, going up and down: their slopes are the flow
/// coefficients, and null is midway between their zeros.
fn flow(recording: &Recording, tested: &TestedValve, found: &mut SimpleCalculations) {
    let kinds = [SignalKind::PortFlow, SignalKind::PortFlowMagnitude];
    let Some(signal) = kinds.into_iter().find_map(|kind| recording.signal(kind)) else { return };
    let largest = largest_command(std::slice::from_ref(recording));
    let values = signal.despiked();
    let branch = |sign: f64, rising: bool| {
        let of_row = |(row, value): (usize, &Option<f64>)| {
            let input = recording.inputs.get(row)?;
            let drop = input.supply.pressure - input.supply.tank_pressure - input.load_pressure.abs();
            let share = sign * input.command / largest;
            // away from the leakage and from the reversals
            let counts = (0.3..0.95).contains(&share) && direction(recording, row) == Some(rising);
            let edge = flow_coefficient_from_rating((*value)?.abs(), drop);
            (counts && drop > 0.0).then_some((input.command, edge))
        };
        straight_line(&values.iter().enumerate().filter_map(of_row).collect::<Vec<_>>())
    };
    let mut slopes = [vec![], vec![]];
    for (null, rising) in found.nulls.iter_mut().zip([true, false]) {
        let mut zeros = vec![];
        for (slopes, sign) in slopes.iter_mut().zip([1.0, -1.0]) {
            let line = branch(sign, rising).filter(|[_, slope]| sign * slope > 0.0);
            slopes.extend(line.map(|[_, slope]| slope.abs() * tested.nominal_voltage));
            zeros.extend(line.map(|[zero, _]| zero));
        }
        let middle = zeros.iter().sum::<f64>() / zeros.len() as f64;
        *null = null.or((zeros.len() == 2).then_some(middle));
    }
    for (coefficient, slopes) in found.flow_coefficients.iter_mut().zip(slopes) {
        let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
        *coefficient = coefficient.or((!slopes.is_empty()).then_some(mean));
    }
}

/// Where the straight line through points is zero, and its slope; points far from the others' line
/// do not count.
fn straight_line(points: &[(f64, f64)]) -> Option<[f64; 2]> {
    const FEWEST: usize = 5;
    let fitted = |points: &[(f64, f64)]| -> Option<[f64; 2]> {
        let count = points.len() as f64;
        let [x, y] = [points.iter().map(|(x, _)| x).sum::<f64>(), points.iter().map(|(_, y)| y).sum::<f64>()]
            .map(|sum| sum / count);
        let square: f64 = points.iter().map(|(at, _)| (at - x) * (at - x)).sum();
        let product: f64 = points.iter().map(|(at, value)| (at - x) * (value - y)).sum();
        let slope = product / square;
        (points.len() >= FEWEST && square > 0.0 && slope != 0.0).then_some([x - y / slope, slope])
    };
    let [zero, slope] = fitted(points)?;
    let away = |(x, y): &(f64, f64)| (y - slope * (x - zero)).abs();
    let usual = median(points.iter().map(away).collect());
    let near: Vec<(f64, f64)> = points.iter().filter(|point| away(point) <= 4.0 * usual).copied().collect();
    fitted(&near)
}
