//! Readings of the curves by hand, as in section 5.2 of the thesis.

mod gains;
mod half_height;
mod straight_line;

use phea_dynamics::order::{median, sort_numbers};
use phea_hydraulics::servovalve::{PortCircuit, TestedValve, flow_coefficient_from_rating};

use self::half_height::{Flank, peak};
use self::straight_line::straight_line;
use super::recording::{Recording, SignalKind, usual_drop};
use crate::estimate::Estimate;

/// Feature of the curves that shows null.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NullMethod {
    /// Middle of the leakage curve at half of its height. For unequal edges it is not quite null.
    LeakageCentre,
    /// Middle between the zeros of straight lines through both branches of the flow.
    FlowLines,
    /// Command at which both ports have equal pressures.
    EqualPressures,
}

/// Null, and the feature that shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NullReading {
    /// Command at null, V.
    pub command: Estimate,
    /// Feature that shows the null.
    pub method: NullMethod,
}

/// Results of the calculations of the thesis, section 5.2; `None` if the test for it is missing. SI
/// units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimpleCalculations {
    /// Flow coefficient K_vp by (4.12), corrected, for positive commands (edges 3 and 6) and
    /// negative ones (4 and 5).
    pub flow_coefficients: [Option<Estimate>; 2],
    /// Ratio of the flow of this valve to the rated one at the rated drop.
    pub fraction_of_nominal: Option<Estimate>,
    /// Null leakage q_vin, the peak of the leakage above its base.
    pub null_leakage: Option<Estimate>,
    /// Pressure drop p_S - p_T of the leakage test.
    pub leakage_pressure: Option<f64>,
    /// Tare flow q_tare, the base of the leakage curve.
    pub tare_flow: Option<Estimate>,
    /// Leakage shape lambda of (4.14), from the width of the curve at half its height.
    pub leakage_shape: Option<f64>,
    /// Command at null with a rising and a falling command, V.
    pub nulls: [Option<NullReading>; 2],
    /// Slope dq/dU near null at the usual supply pressure, for positive and negative commands,
    /// m3/(s V).
    pub flow_gains: [Option<Estimate>; 2],
    /// Commands from null, to either side, between which the flow gains are read, V.
    pub flow_gain_commands: Option<[f64; 2]>,
    /// Pressure drop p_S - p_T for which they are stated.
    pub flow_gain_pressure: f64,
    /// Slope d(p_A - p_B)/dU at null with blocked ports, Pa/V.
    pub pressure_sensitivity: Option<Estimate>,
}

impl SimpleCalculations {
    /// Mean of both nulls.
    pub fn null_bias(&self) -> Option<Estimate> {
        let [rising, falling] = self.nulls;
        Estimate::mean(&[rising?.command, falling?.command])
    }

    /// Adds a null if no better feature has shown it before.
    fn add_null(&mut self, rising: bool, method: NullMethod, read: impl FnOnce() -> Option<Estimate>) {
        let null = &mut self.nulls[usize::from(!rising)];
        *null = null.or_else(|| read().map(|command| NullReading { command, method }));
    }

    /// Difference of both nulls.
    pub fn hysteresis(&self) -> Option<Estimate> {
        let [rising, falling] = self.nulls;
        Some(rising?.command.minus(&falling?.command))
    }

    /// Leakage coefficient K_vinp by (4.13).
    pub fn leakage_coefficient(&self) -> Option<Estimate> {
        Some(self.null_leakage?.times(1.0 / (2.0 * self.leakage_pressure?).sqrt()))
    }

    /// Fraction of the tare flow in the whole leakage at null, with the error of the peak.
    pub fn tare_fraction(&self) -> Option<Estimate> {
        let tare = self.tare_flow?;
        Some(tare.over(&self.null_leakage?.plus(tare.value)))
    }

    /// Mean flow gain of both directions.
    pub fn flow_gain(&self) -> Option<Estimate> {
        let [extending, retracting] = self.flow_gains;
        Estimate::mean(&[extending?, retracting?])
    }

    /// Flow-pressure coefficient K_c = K_qU/K_pU, m3/(s Pa).
    pub fn flow_pressure_coefficient(&self) -> Option<Estimate> {
        Some(self.flow_gain()?.over(&self.pressure_sensitivity?))
    }
}

/// Calculations, from any test that permits them.
///
/// ```text
/// q_tare   median leakage beyond 60 % of the amplitude; below the least reading if the meter reads zero there
/// q_vin    highest mean over a small part of the width at half height, minus q_tare
/// nulls    middle of the half height of the leakage, rising and falling; else between the zeros of the flow's lines; else of p_A = p_B
/// K_vinp = q_vin/sqrt(2 p_S)                                   thesis (4.13)
/// lambda = 1.317/u_half                                        sech(1.317) = 1/2
/// K_vp   = dq/du/sqrt(p_S/2), by a straight line               thesis (4.12), corrected
/// K_qU   = dq/dU within 15 % of the nominal voltage, over the root of the drop
/// K_pU   = 1/(dU/dp_L) within 40 % of p_S
/// K_c    = K_qU/K_pU
/// ```
///
/// A crossing of half the height has an error of at most the noise divided by the slope of the
/// flank between its quarters; a zero of a straight line y = b (x - x_0) has
///
/// ```text
/// sigma_0 = sigma/|b| sqrt(1/n + (x_0 - mean x)^2/sum (x - mean x)^2)
/// ```
///
/// and a row at which both pressures cross by the step of the command.
pub(super) fn simple_calculations(
    recordings: &[Recording],
    tested: &TestedValve,
    rated_flow: Option<[f64; 2]>,
) -> SimpleCalculations {
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
        for rising in [true, false] {
            found.add_null(rising, NullMethod::EqualPressures, || crossing(recording, rising));
        }
    }
    let usual_drop = usual_drop(recordings);
    (found.flow_gains, found.flow_gain_commands) =
        gains::flow_gains(recordings, tested, found.null_bias().map(|one| one.value), usual_drop);
    found.flow_gain_pressure = usual_drop;
    found.pressure_sensitivity = gains::pressure_sensitivity(recordings);
    let both = found.flow_coefficients.into_iter().flatten().collect::<Vec<_>>();
    let mean = Estimate::mean(&both).filter(|_| both.len() == 2);
    found.fraction_of_nominal =
        mean.zip(rated_flow).map(|(mean, [flow, drop])| mean.times((drop / 2.0).sqrt() / flow));
    found
}

/// Greatest magnitude of a command.
pub(super) fn largest_command(recordings: &[Recording]) -> f64 {
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
    let base: Vec<f64> = base.map(|(_, _, leak)| leak).collect();
    let mut highest: Vec<f64> = rows().map(|(_, _, leak)| leak).collect();
    sort_numbers(&mut highest);
    let Some(least) = highest.first().copied() else { return };
    let (tare_flow, noise) = base_flow(&base, least);
    let tare = tare_flow.value;
    // values exceeded only by the noise of a hundredth of the rows
    let Some(high) = highest.get(highest.len() * 99 / 100).copied().filter(|high| *high > tare) else {
        return;
    };
    let pressure =
        median(rows().map(|(_, input, _)| input.supply.pressure - input.supply.tank_pressure).collect());
    found.tare_flow = Some(tare_flow);
    found.leakage_pressure = Some(pressure);
    let first_reversal = first_reversal(recording);
    // before its first reversal the spool does not have the memory of a full cycle
    let flank = Flank { base: tare, peak: high, noise };
    let half = flank.height(0.5);
    let branch = |rising: bool, from: usize| -> Vec<(f64, f64)> {
        let same = rows().filter(|(row, _, _)| *row >= from && direction(recording, *row) == Some(rising));
        same.map(|(_, input, leak)| (input.command, leak)).collect()
    };
    let edges = |rising: bool| {
        let late = flank.half_height(&branch(rising, first_reversal));
        late.or_else(|| flank.half_height(&branch(rising, 0)))
    };
    let peaks = [true, false].map(|rising| {
        peak(&branch(rising, 0).into_iter().filter(|(_, leak)| *leak > half).collect::<Vec<_>>(), noise)
    });
    let peaks: Vec<Estimate> = peaks.into_iter().flatten().collect();
    found.null_leakage = Estimate::mean(&peaks).map(|peak| peak.plus(-tare));
    let mut widths = Vec::new();
    for (null, rising) in found.nulls.iter_mut().zip([true, false]) {
        if let Some([low, high]) = edges(rising) {
            let centre = Estimate::mean(&[low, high]);
            *null = centre.map(|command| NullReading { command, method: NullMethod::LeakageCentre });
            widths.push((high.value - low.value) / 2.0);
        }
    }
    if let Some(half) = widths.into_iter().reduce(f64::min) {
        found.leakage_shape = Some((1.317 * tested.nominal_voltage / half).clamp(2.0, 2000.0));
    }
}

/// Flow of the base, and the noise of one of its rows. If the meter reads zero there, it is below
/// the least flow that the meter shows anywhere.
fn base_flow(base: &[f64], least: f64) -> (Estimate, f64) {
    if base.is_empty() {
        let estimate = Estimate { value: 0.0, interval: [0.0, least.max(0.0)] };
        return (estimate, f64::INFINITY);
    }
    let middle = median(base.to_vec());
    let deviation = deviation_of_median(base, middle);
    (Estimate::of(middle, deviation), deviation * (base.len() as f64).sqrt())
}

/// True if the command rises at a row; `None` if it does not change.
pub(super) fn direction(recording: &Recording, row: usize) -> Option<bool> {
    let before = recording.inputs.get(row.checked_sub(1)?)?.followed_command;
    let now = recording.inputs.get(row)?.followed_command;
    (now != before).then_some(now > before)
}

/// Command at which p_A and p_B are equal, rising or falling, V.
fn crossing(recording: &Recording, rising: bool) -> Option<Estimate> {
    let a = recording.signal(SignalKind::PressureA)?;
    let b = recording.signal(SignalKind::PressureB)?;
    let load = |row: usize| Some((*a.values.get(row)?)? - (*b.values.get(row)?)?);
    let crossed = (1..recording.inputs.len()).filter(|row| {
        let Some((before, now)) = load(row - 1).zip(load(*row)) else { return false };
        direction(recording, *row) == Some(rising) && (before < 0.0) != (now < 0.0)
    });
    let at = |row: usize| recording.inputs.get(row).map(|input| input.command);
    let crossed: Vec<usize> = crossed.collect();
    // before its first reversal the spool does not have the memory of a full cycle
    let first = first_reversal(recording);
    let from = if crossed.iter().any(|row| *row >= first) { first } else { 0 };
    let crossed = crossed.into_iter().filter(|row| *row >= from);
    let crossed: Vec<(f64, f64)> = crossed.filter_map(|row| at(row).zip(at(row - 1))).collect();
    let middle = median(crossed.iter().map(|(now, _)| *now).collect());
    // the crossings are apart if noise makes the pressures cross more than once
    let square = |one: f64| one * one;
    let apart = |(now, before): &(f64, f64)| square(now - middle) + square(now - before);
    let deviation = (crossed.iter().map(apart).sum::<f64>() / crossed.len() as f64).sqrt();
    (!crossed.is_empty()).then(|| Estimate::of(middle, deviation))
}

/// Both branches of the flow as straight lines, rising and falling: their slopes are the flow
/// coefficients, and between their zeros is null.
fn flow(recording: &Recording, tested: &TestedValve, found: &mut SimpleCalculations) {
    let kinds = [SignalKind::PortFlow, SignalKind::PortFlowMagnitude];
    let Some(signal) = kinds.into_iter().find_map(|kind| recording.signal(kind)) else { return };
    let largest = largest_command(std::slice::from_ref(recording));
    let values = signal.despiked();
    let branch = |sign: f64, rising: bool| {
        let of_row = |(row, value): (usize, &Option<f64>)| {
            let input = recording.inputs.get(row)?;
            let drop = input.supply.pressure - input.supply.tank_pressure - input.load_pressure.abs();
            let fraction = sign * input.command / largest;
            // far from the leakage and from the reversals
            let counts = (0.3..0.95).contains(&fraction) && direction(recording, row) == Some(rising);
            let edge = flow_coefficient_from_rating((*value)?.abs(), drop);
            (counts && drop > 0.0).then_some((input.command, edge))
        };
        straight_line(&values.iter().enumerate().filter_map(of_row).collect::<Vec<_>>())
    };
    let mut slopes = [vec![], vec![]];
    for rising in [true, false] {
        let mut zeros = vec![];
        for (slopes, sign) in slopes.iter_mut().zip([1.0, -1.0]) {
            let line = branch(sign, rising).filter(|line| sign * line.slope.value > 0.0);
            slopes.extend(line.map(|line| line.slope.times(sign * tested.nominal_voltage)));
            zeros.extend(line.map(|line| line.zero));
        }
        let middle = Estimate::mean(&zeros).filter(|_| zeros.len() == 2);
        found.add_null(rising, NullMethod::FlowLines, || middle);
    }
    for (coefficient, slopes) in found.flow_coefficients.iter_mut().zip(slopes) {
        *coefficient = coefficient.or(Estimate::mean(&slopes));
    }
}

/// Row at which the command first reverses.
fn first_reversal(recording: &Recording) -> usize {
    let rows = 1..recording.inputs.len();
    let mut ways = rows.filter_map(|row| direction(recording, row).map(|way| (row, way)));
    let Some((_, first)) = ways.next() else { return 0 };
    ways.find(|(_, way)| *way != first).map_or(0, |(row, _)| row)
}

/// Standard deviation of a median, for normal noise: 1.2533 times that of the mean.
fn deviation_of_median(values: &[f64], middle: f64) -> f64 {
    let squares: f64 = values.iter().map(|value| (value - middle) * (value - middle)).sum();
    1.2533 * squares.sqrt() / values.len() as f64
}
