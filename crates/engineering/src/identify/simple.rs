//! What section 5.2 of the thesis reads off the curves by hand.

mod gains;

use phea_hydraulics::servovalve::{PortCircuit, TestedValve, flow_coefficient_from_rating};

use super::recording::{Recording, SignalKind, median, usual_drop};

/// A number that was read off a curve, with its 95 % interval where there is one. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveReading {
    /// The number.
    pub value: f64,
    /// Ends of its interval.
    pub interval: Option<[f64; 2]>,
}

impl CurveReading {
    pub(super) fn of(value: f64, deviation: f64) -> CurveReading {
        let half = 1.96 * deviation;
        CurveReading { value, interval: half.is_finite().then_some([value - half, value + half]) }
    }

    fn deviation(&self) -> f64 {
        self.interval.map_or(f64::INFINITY, |[low, high]| (high - low) / 3.92)
    }

    fn times(&self, factor: f64) -> CurveReading {
        CurveReading::of(self.value * factor, self.deviation() * factor.abs())
    }

    fn plus(&self, offset: f64) -> CurveReading {
        CurveReading::of(self.value + offset, self.deviation())
    }

    /// Mean of several that err independently.
    fn mean(all: &[CurveReading]) -> Option<CurveReading> {
        let count = all.len() as f64;
        let sum: f64 = all.iter().map(|one| one.value).sum();
        let squares: f64 = all.iter().map(|one| one.deviation() * one.deviation()).sum();
        (!all.is_empty()).then(|| CurveReading::of(sum / count, squares.sqrt() / count))
    }

    /// Of two that err independently.
    fn over(&self, other: &CurveReading) -> CurveReading {
        let value = self.value / other.value;
        let [first, second] = [self, other].map(|one| one.deviation() / one.value);
        CurveReading::of(value, value.abs() * (first * first + second * second).sqrt())
    }
}

/// What the calculations of the thesis, section 5.2, give; `None` where the test for it is missing.
/// SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimpleCalculations {
    /// K_vp by (4.12), corrected, for positive commands (edges 3 and 6) and negative ones (4 and 5).
    pub flow_coefficients: [Option<CurveReading>; 2],
    /// Flow of this valve over the rated one at the rated drop.
    pub share_of_nominal: Option<CurveReading>,
    /// q_vin, the peak of the leakage above its base.
    pub null_leakage: Option<CurveReading>,
    /// p_S - p_T of the leakage test.
    pub leakage_pressure: Option<f64>,
    /// q_tare, the base of the leakage curve.
    pub tare_flow: Option<CurveReading>,
    /// lambda of (4.14), by the width of the curve at half its height.
    pub leakage_shape: Option<f64>,
    /// Command of null with a rising and a falling command, in V.
    pub nulls: [Option<f64>; 2],
    /// dq/dU near null at the usual supply pressure, for positive and negative commands, in m3/(s V).
    pub flow_gains: [Option<CurveReading>; 2],
    /// d(p_A - p_B)/dU at null with blocked ports, in Pa/V.
    pub pressure_sensitivity: Option<CurveReading>,
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

    /// K_vinp by (4.13).
    pub fn leakage_coefficient(&self) -> Option<CurveReading> {
        Some(self.null_leakage?.times(1.0 / (2.0 * self.leakage_pressure?).sqrt()))
    }

    /// Share of the tare flow in the whole leakage at null.
    pub fn tare_share(&self) -> Option<f64> {
        let tare = self.tare_flow?.value;
        Some(tare / (tare + self.null_leakage?.value))
    }

    /// Mean flow gain of both directions.
    pub fn flow_gain(&self) -> Option<CurveReading> {
        let [extending, retracting] = self.flow_gains;
        CurveReading::mean(&[extending?, retracting?])
    }

    /// K_c = K_qU/K_pU, in m3/(s Pa).
    pub fn flow_pressure_coefficient(&self) -> Option<CurveReading> {
        Some(self.flow_gain()?.over(&self.pressure_sensitivity?))
    }
}

/// The calculations, from whatever test allows them.
///
/// ```text
/// q_tare   median leakage beyond 60 % of the amplitude
/// q_vin    highest mean over a small part of the width at half height, less q_tare
/// nulls    commands of the greatest leakage, rising and falling; else between the zeros of the flow's lines; else of p_A = p_B
/// K_vinp = q_vin/sqrt(2 p_S)                                   thesis (4.13)
/// lambda = 1.317/u_half                                        sech(1.317) = 1/2
/// K_vp   = dq/du/sqrt(p_S/2), by a straight line               thesis (4.12), corrected
/// K_qU   = dq/dU within 15 % of the nominal voltage, over the root of the drop
/// K_pU   = 1/(dU/dp_L) within 40 % of p_S
/// K_c    = K_qU/K_pU
/// ```
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
        for (index, null) in found.nulls.iter_mut().enumerate() {
            *null = null.or_else(|| crossing(recording, index == 0));
        }
    }
    let usual_drop = usual_drop(recordings);
    found.flow_gains = gains::flow_gains(recordings, tested, found.null_bias(), usual_drop);
    found.pressure_sensitivity = gains::pressure_sensitivity(recordings);
    let both = found.flow_coefficients.into_iter().flatten().collect::<Vec<_>>();
    let mean = CurveReading::mean(&both).filter(|_| both.len() == 2);
    found.share_of_nominal =
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
    let tare = median(base.clone());
    let mut highest: Vec<f64> = rows().map(|(_, _, leak)| leak).collect();
    highest.sort_by(f64::total_cmp);
    // what only the noise of a hundredth of the rows exceeds
    let Some(high) = highest.get(highest.len() * 99 / 100).copied().filter(|high| *high > tare) else {
        return;
    };
    let pressure =
        median(rows().map(|(_, input, _)| input.supply.pressure - input.supply.tank_pressure).collect());
    found.tare_flow = Some(CurveReading::of(tare, deviation_of_median(&base, tare)));
    found.leakage_pressure = Some(pressure);
    let first_reversal = first_reversal(recording);
    // before its first reversal the spool does not have the memory of a full cycle
    let half = 0.5 * (high + tare);
    let branch = |rising: bool, from: usize| -> Vec<(f64, f64)> {
        let same = rows().filter(|(row, _, _)| *row >= from && direction(recording, *row) == Some(rising));
        same.map(|(_, input, leak)| (input.command, leak)).collect()
    };
    let edges = |rising: bool| {
        let late = half_height(&branch(rising, first_reversal), half);
        late.or_else(|| half_height(&branch(rising, 0), half))
    };
    let noise = deviation_of_median(&base, tare) * (base.len() as f64).sqrt();
    let peaks = [true, false].map(|rising| {
        peak(&branch(rising, 0).into_iter().filter(|(_, leak)| *leak > half).collect::<Vec<_>>(), noise)
    });
    let peaks: Vec<CurveReading> = peaks.into_iter().flatten().collect();
    found.null_leakage = CurveReading::mean(&peaks).map(|peak| peak.plus(-tare));
    let mut widths = Vec::new();
    for (null, rising) in found.nulls.iter_mut().zip([true, false]) {
        if let Some([low, high]) = edges(rising) {
            *null = Some(f64::midpoint(low, high));
            widths.push((high - low) / 2.0);
        }
    }
    if let Some(half) = widths.into_iter().reduce(f64::min) {
        found.leakage_shape = Some((1.317 * tested.nominal_voltage / half).clamp(2.0, 2000.0));
    }
}

/// Whether the command rises at a row; `None` where it stands.
pub(super) fn direction(recording: &Recording, row: usize) -> Option<bool> {
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
            let line = branch(sign, rising).filter(|line| sign * line.slope.value > 0.0);
            slopes.extend(line.map(|line| line.slope.times(sign * tested.nominal_voltage)));
            zeros.extend(line.map(|line| line.zero));
        }
        let middle = zeros.iter().sum::<f64>() / zeros.len() as f64;
        *null = null.or((zeros.len() == 2).then_some(middle));
    }
    for (coefficient, slopes) in found.flow_coefficients.iter_mut().zip(slopes) {
        *coefficient = coefficient.or(CurveReading::mean(&slopes));
    }
}

/// Row at which the command first turns round.
fn first_reversal(recording: &Recording) -> usize {
    let rows = 1..recording.inputs.len();
    let mut ways = rows.filter_map(|row| direction(recording, row).map(|way| (row, way)));
    let Some((_, first)) = ways.next() else { return 0 };
    ways.find(|(_, way)| *way != first).map_or(0, |(row, _)| row)
}

/// Commands at which a branch, from below through its peak and below again, crosses a height.
fn half_height(points: &[(f64, f64)], half: f64) -> Option<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|(first, _), (second, _)| first.total_cmp(second));
    let is_above = |(_, leak): &(f64, f64)| *leak > half;
    let [first, last] = [sorted.iter().position(is_above)?, sorted.iter().rposition(is_above)?];
    let crossing = |outside: usize, inside: usize| {
        let ((x, low), (to, high)) = (sorted.get(outside)?, sorted.get(inside)?);
        Some(x + (half - low) / (high - low) * (to - x))
    };
    let edges = [crossing(first.checked_sub(1)?, first)?, crossing(last + 1, last)?];
    (edges[1] > edges[0]).then_some(edges)
}

/// Highest mean of a twenty-fourth of these rows, neighbours over the command.
fn peak(points: &[(f64, f64)], noise: f64) -> Option<CurveReading> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|(first, _), (second, _)| first.total_cmp(second));
    let width = (sorted.len() / 24).max(1);
    let means =
        sorted.windows(width).map(|rows| rows.iter().map(|(_, leak)| leak).sum::<f64>() / width as f64);
    means.reduce(f64::max).map(|peak| CurveReading::of(peak, noise / (width as f64).sqrt()))
}

/// Standard deviation of a median, of noise that is normal: 1.2533 times that of the mean.
fn deviation_of_median(values: &[f64], middle: f64) -> f64 {
    let squares: f64 = values.iter().map(|value| (value - middle) * (value - middle)).sum();
    1.2533 * squares.sqrt() / values.len() as f64
}

/// A straight line through points.
#[derive(Clone, Copy)]
pub(super) struct StraightLine {
    /// Where it is zero.
    pub(super) zero: f64,
    pub(super) slope: CurveReading,
}

/// The straight line through points; points far from the others' line do not count.
pub(super) fn straight_line(points: &[(f64, f64)]) -> Option<StraightLine> {
    const FEWEST: usize = 5;
    let fitted = |points: &[(f64, f64)]| -> Option<StraightLine> {
        let count = points.len() as f64;
        let [x, y] = [points.iter().map(|(x, _)| x).sum::<f64>(), points.iter().map(|(_, y)| y).sum::<f64>()]
            .map(|sum| sum / count);
        let square: f64 = points.iter().map(|(at, _)| (at - x) * (at - x)).sum();
        let product: f64 = points.iter().map(|(at, value)| (at - x) * (value - y)).sum();
        let slope = product / square;
        let rest = |(at, value): &(f64, f64)| value - y - slope * (at - x);
        let residual: f64 = points.iter().map(|point| rest(point) * rest(point)).sum();
        let deviation = (residual / (count - 2.0) / square).sqrt();
        (points.len() >= FEWEST && square > 0.0 && slope != 0.0)
            .then(|| StraightLine { zero: x - y / slope, slope: CurveReading::of(slope, deviation) })
    };
    let StraightLine { zero, slope } = fitted(points)?;
    let away = |(x, y): &(f64, f64)| (y - slope.value * (x - zero)).abs();
    let usual = median(points.iter().map(away).collect());
    let near: Vec<(f64, f64)> = points.iter().filter(|point| away(point) <= 4.0 * usual).copied().collect();
    fitted(&near)
}
