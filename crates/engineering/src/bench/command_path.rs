//! Command as a function of time in a test.

use phea_dynamics::portable;

use super::BenchSeries;
use crate::project::{Bench, BenchWaveform, Reversals};

/// Greatest commands before a small reversal, divided by the amplitude.
const LEVELS: [f64; 3] = [0.5, 0.7, 0.9];

/// Command divided by the nominal voltage, as a function of the completed fraction of a test.
pub(super) enum CommandPath {
    /// Cycles around zero.
    Cycles { waveform: BenchWaveform, cycles: f64, amplitude: f64 },
    /// Straight lines from corner to corner at one rate.
    Straight(Vec<f64>),
}

impl CommandPath {
    pub(super) fn of(series: BenchSeries, settings: &Bench) -> CommandPath {
        let cycles = |amplitude: f64| CommandPath::Cycles {
            waveform: settings.waveform,
            cycles: f64::from(settings.cycles),
            amplitude,
        };
        match (series, settings.reversals, settings.low_flow_meter) {
            (BenchSeries::Reversals, Some(reversals), _) => CommandPath::Straight(corners(&reversals)),
            (BenchSeries::PressureGain, _, _) => cycles(settings.pressure_gain_amplitude),
            (BenchSeries::LowFlowMetering, _, Some(small)) => cycles(small.amplitude),
            _ => cycles(settings.amplitude),
        }
    }

    /// Command after a fraction of the test.
    pub(super) fn at(&self, fraction: f64) -> f64 {
        match self {
            CommandPath::Cycles { waveform, cycles, amplitude } => {
                amplitude * wave(*waveform, fraction * cycles)
            }
            CommandPath::Straight(corners) => along(corners, fraction),
        }
    }
}

/// Corners of the path from zero to the amplitude and back, with a small reversal at each level in
/// either direction.
pub(super) fn corners(reversals: &Reversals) -> Vec<f64> {
    let Reversals { amplitude, size } = *reversals;
    let levels = LEVELS.map(|level| level * amplitude);
    let mut corners = vec![0.0];
    corners.extend(levels.iter().flat_map(|level| [*level, level - size]));
    corners.push(amplitude);
    corners.extend(levels.iter().rev().flat_map(|level| [level - size, *level]));
    corners.push(0.0);
    corners
}

/// Least command at which the flow is judged, divided by the nominal voltage: the lowest corner
/// except zero.
pub(super) fn least_judged(reversals: &Reversals) -> f64 {
    LEVELS.map(|level| level * reversals.amplitude - reversals.size).into_iter().fold(f64::INFINITY, f64::min)
}

/// Command after a fraction of the path from corner to corner.
fn along(corners: &[f64], fraction: f64) -> f64 {
    let pieces = || corners.iter().zip(corners.iter().skip(1));
    let whole: f64 = pieces().map(|(from, to)| (to - from).abs()).sum();
    let mut left = fraction * whole;
    for (from, to) in pieces() {
        let length = (to - from).abs();
        if left <= length {
            return from + (to - from).signum() * left;
        }
        left -= length;
    }
    corners.last().copied().unwrap_or(0.0)
}

/// Command divided by its amplitude after a number of cycles: first from zero upwards.
fn wave(waveform: BenchWaveform, cycles: f64) -> f64 {
    let phase = cycles - cycles.floor();
    match waveform {
        BenchWaveform::Sine => portable::sin(2.0 * std::f64::consts::PI * phase),
        BenchWaveform::Triangle if phase < 0.25 => 4.0 * phase,
        BenchWaveform::Triangle if phase < 0.75 => 2.0 - 4.0 * phase,
        BenchWaveform::Triangle => 4.0 * phase - 4.0,
    }
}
