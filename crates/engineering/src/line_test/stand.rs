//! Virtual tests of a line whose far end is blocked: a slow rise of the pressure, and a flow of
//! many frequencies.
//!
//! ```text
//! flow over time -> phea_hydraulics::line::BlockedLine -> pressure at the open end -> instruments -> rows
//! ```

use std::f64::consts::PI;

use phea_dynamics::portable;
use phea_dynamics::random::{normal, stream};
use phea_dynamics::simulation::{
    Harmonic, Input, InputSchedule, Profile, SimulationSettings, Status, schroeder_phases, simulate,
};
use phea_dynamics::watch::{Watch, report_progress};
use phea_hydraulics::line::{BlockedLine, StiffeningMember};

use super::KnownLine;
use crate::bench::{BenchError, BenchLineError, Instruments, MOST_ROWS};
use crate::project::{Bench, LineBench};
use crate::setup::Setup;

/// A test of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineSeries {
    /// The pressure rises slowly, and falls again.
    PressureRise,
    /// The flow has many frequencies.
    FrequencyResponse,
}

impl LineSeries {
    /// Name in file names.
    pub fn name(self) -> &'static str {
        match self {
            LineSeries::PressureRise => "line_pressure_rise",
            LineSeries::FrequencyResponse => "line_frequency_response",
        }
    }
}

/// A recorded test of a line, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct LineRun {
    /// Kind of the test.
    pub series: LineSeries,
    /// Times, s.
    pub times: Vec<f64>,
    /// Input into the open end: volume since the first row of a rise, m3, flow of a response, m3/s.
    pub inputs: Vec<f64>,
    /// Pressures at the open end, Pa.
    pub pressures: Vec<f64>,
}

/// Number of pieces of the integral over the pressure, which is smooth.
const PIECES: u32 = 200;

/// Fraction of the rise during which the flow sets in.
const ONSET: f64 = 0.05;

/// Tests of `[bench.line]`, with noise and converters; empty if it is absent.
///
/// # Errors
/// The errors of [`clean_line_runs`].
pub fn line_runs(setup: &Setup<'_>, watch: Watch<'_>) -> Result<Vec<LineRun>, BenchError> {
    let bench = &setup.project.bench;
    let mut runs = clean_line_runs(setup, watch)?;
    runs.iter_mut().for_each(|run| recorded(run, bench));
    Ok(runs)
}

/// True values of the tests, without noise and converters.
///
/// # Errors
/// [`BenchError`] for a project whose line cannot be simulated.
pub fn clean_line_runs(setup: &Setup<'_>, watch: Watch<'_>) -> Result<Vec<LineRun>, BenchError> {
    let Some(bench) = setup.project.bench.line else { return Ok(Vec::new()) };
    let known = KnownLine::of(setup, bench.side).map_err(BenchLineError::from)?;
    let line = |pressure: f64| {
        let model = known.stand_model();
        BlockedLine::new(&known.line, &known.fluid, pressure, StiffeningMember::Nominal, &model)
            .map_err(BenchLineError::from)
    };
    let [low, high] = bench.pressures;
    let rise = rise(&line(f64::midpoint(low, high))?, &bench, watch)?;
    let mean = bench.pressure.unwrap_or(known.pressure);
    Ok(vec![rise, shaken(&line(mean)?, mean, &bench, watch)?])
}

/// Passes a run through the instruments.
pub fn recorded(run: &mut LineRun, bench: &Bench) {
    let mut noise = stream(u64::from(bench.seed), 100 + run.series as u64);
    let mut instruments = Instruments::new(bench, 1.0);
    let input_noise = bench.line.map_or(0.0, |line| match run.series {
        LineSeries::PressureRise => line.volume_noise,
        LineSeries::FrequencyResponse => line.flow_noise,
    });
    for (input, pressure) in run.inputs.iter_mut().zip(&mut run.pressures) {
        *pressure = instruments.pressure(*pressure, &mut noise);
        *input += input_noise * normal(&mut noise);
    }
}

/// Standstill, a steady inflow, standstill, an equal outflow, standstill.
fn rise(line: &BlockedLine, bench: &LineBench, watch: Watch<'_>) -> Result<LineRun, BenchError> {
    let [low, high] = bench.pressures;
    let step = (high - low) / f64::from(PIECES);
    let middles = (0..PIECES).map(|piece| low + (f64::from(piece) + 0.5) * step);
    let volume: f64 = middles.map(|pressure| step * line.static_compliance(pressure)).sum();
    let onset = ONSET * bench.rise_time;
    let flow = volume / (bench.rise_time - onset);
    let (rise, rest) = (bench.rise_time, bench.standstill);
    let mut times = vec![0.0];
    let mut flows = vec![0.0];
    let mut at = rest;
    for direction in [1.0, -1.0] {
        times.extend([at, at + onset, at + rise - onset, at + rise]);
        flows.extend([0.0, direction * flow, direction * flow, 0.0]);
        at += rise + rest;
    }
    times.push(at);
    flows.push(0.0);
    let profile = Profile::table(&times, &flows).map_err(BenchLineError::from)?;
    let mut found =
        run(line, LineSeries::PressureRise, (profile.clone(), low), [at, bench.rise_sample_time], watch)?;
    found.inputs = integral(&found.times, |time| profile.value(time));
    Ok(found)
}

/// Integral of a function from the first of some times to each, by Simpson's rule: exact for cubic
/// pieces.
fn integral(times: &[f64], function: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    for pair in times.windows(2) {
        if let [from, to] = pair {
            let middle = function(f64::midpoint(*from, *to));
            sum += (to - from) / 6.0 * (function(*from) + 4.0 * middle + function(*to));
            sums.push(sum);
        }
    }
    sums
}

/// A multisine at lines of its period, with equal flow amplitudes.
fn shaken(
    line: &BlockedLine,
    pressure: f64,
    bench: &LineBench,
    watch: Watch<'_>,
) -> Result<LineRun, BenchError> {
    let frequencies = excited(bench);
    if frequencies.len() < 3 {
        return Err(BenchLineError::FewFrequencies.into());
    }
    let compliance = line.static_compliance(pressure);
    let per_flow: f64 = frequencies.iter().map(|w| 0.5 / (w * compliance * w * compliance)).sum();
    let amplitude = bench.swing / per_flow.sqrt();
    let phases = schroeder_phases(&vec![amplitude; frequencies.len()]);
    let both = frequencies.iter().zip(phases);
    let harmonics: Vec<Harmonic> = both
        .map(|(frequency, phase_rad)| Harmonic { amplitude, frequency_rad_per_s: *frequency, phase_rad })
        .collect();
    // volume displaced by the sines when they begin, so that the mean is as stated
    let begun = |one: &Harmonic| portable::cos(one.phase_rad) / one.frequency_rad_per_s;
    let first = pressure - amplitude / compliance * harmonics.iter().map(begun).sum::<f64>();
    let profile = Profile::multisine(0.0, &harmonics).map_err(BenchLineError::from)?;
    let duration = bench.period * f64::from(bench.periods) - bench.sample_time;
    let times = [duration, bench.sample_time];
    run(line, LineSeries::FrequencyResponse, (profile, first), times, watch)
}

/// Lines of the period, at approximately equal ratios between the ends, below half of the sampling
/// frequency.
fn excited(bench: &LineBench) -> Vec<f64> {
    let spacing = 2.0 * PI / bench.period;
    let [low, high] = bench.frequencies;
    let high = high.min(0.9 * PI / bench.sample_time);
    let ratio = portable::ln(high / low) / f64::from(bench.lines - 1);
    let mut lines: Vec<u64> = (0..bench.lines)
        .map(|index| (low * portable::exp(ratio * f64::from(index)) / spacing).round() as u64)
        .filter(|line| *line > 0)
        .collect();
    lines.dedup();
    lines.into_iter().map(|line| line as f64 * spacing).collect()
}

/// Simulates the line from rest.
fn run(
    line: &BlockedLine,
    series: LineSeries,
    (profile, pressure): (Profile, f64),
    [duration, sample_time]: [f64; 2],
    watch: Watch<'_>,
) -> Result<LineRun, BenchError> {
    let rows = (duration / sample_time).floor() + 1.0;
    if rows > MOST_ROWS as f64 {
        return Err(BenchError::TooManyRows { rows, most: MOST_ROWS });
    }
    let flows = profile.clone();
    let schedule = InputSchedule {
        duration_s: duration,
        output_step_s: sample_time,
        inputs: vec![Input::Value(profile)],
    };
    let (state, waves) = line.rest(pressure);
    let settings = SimulationSettings { tolerance: 1e-7, ..SimulationSettings::default() };
    let mut reported = 0;
    let mut stopped = false;
    let simulated = simulate(line, &[state, waves].concat(), &schedule, None, &settings, &mut |time: f64| {
        let row = (time / sample_time) as usize;
        if row >= reported + 64 {
            reported = row;
            stopped = report_progress(watch, series.name(), row, rows as usize).is_err();
        }
        !stopped
    })
    .map_err(BenchLineError::from)?;
    if stopped {
        return Err(BenchError::Stopped);
    }
    if simulated.outcome.status != Status::Completed {
        return Err(BenchLineError::Unfinished.into());
    }
    let trajectory = simulated.trajectory;
    Ok(LineRun {
        series,
        inputs: trajectory.times_s.iter().map(|time| flows.value(*time)).collect(),
        pressures: trajectory.states.iter().map(|state| line.open_end(state)).collect(),
        times: trajectory.times_s,
    })
}
