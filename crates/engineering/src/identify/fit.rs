//! Least squares over all signals of all recordings.

use phea_dynamics::least_squares::{Ending, Linearised, Minimum, Settings, minimise, uncertainty};
use phea_dynamics::portable;
use phea_dynamics::random::{normal, stream};
use phea_dynamics::watch::{Stopped, Watch, tell};
use phea_hydraulics::servovalve::{STATIC_COEFFICIENTS, StaticCoefficients, TestedValve};

use super::guess::SimpleCalculations;
use super::recording::{RecordedSignal, Recording, median};
use super::told::untold;
use super::{COEFFICIENT_NAMES, Identification, IdentifyError, Search, SignalFit};

const COUNT: usize = STATIC_COEFFICIENTS;

/// Where the null bias stands: the one coefficient that may be negative.
const NULL_BIAS: usize = 10;

/// Step of the null bias that counts as much as a factor of e in another, over the nominal voltage.
const BIAS_SCALE: f64 = 0.01;

/// Half width of a 95 % interval of a normal distribution, in standard deviations.
pub(super) const NORMAL_95: f64 = 1.96;

/// Scale of a residual, over the range of its signal, before the data say.
const FIRST_SCALE: f64 = 0.01;

/// Rounds in which the scale of each signal follows from its residuals.
const ROUNDS: usize = 4;

/// Variables of order one: logarithms of the coefficients over a reference, the null bias in steps.
pub(super) struct Variables {
    reference: [f64; COUNT],
    bias_step: f64,
}

impl Variables {
    fn around(reference: &StaticCoefficients, nominal_voltage: f64) -> Variables {
        Variables { reference: reference.to_array(), bias_step: BIAS_SCALE * nominal_voltage }
    }

    /// The coefficients.
    fn coefficients(&self, variables: &[f64]) -> StaticCoefficients {
        let mut numbers = self.reference;
        for (index, (number, x)) in numbers.iter_mut().zip(variables).enumerate() {
            *number = self.moved(index, *number, *x);
        }
        StaticCoefficients::from_array(numbers)
    }

    fn moved(&self, index: usize, from: f64, by: f64) -> f64 {
        if index == NULL_BIAS { from + by * self.bias_step } else { from * portable::exp(by) }
    }

    /// Derivative of each coefficient with respect to its variable.
    fn slopes(&self, coefficients: &StaticCoefficients) -> [f64; COUNT] {
        let mut slopes = coefficients.to_array();
        slopes[NULL_BIAS] = self.bias_step;
        slopes
    }

    /// How far each may go: a factor of a hundred, the shape and the width as far as they have a
    /// meaning, the null within a tenth of the nominal voltage.
    fn bounds(&self, nominal_voltage: f64) -> [[f64; 2]; COUNT] {
        let mut bounds = [[-4.6, 4.6]; COUNT];
        let [.., shape, tare, bias, width] = &self.reference;
        let within = |from: f64, ends: [f64; 2]| ends.map(|end| portable::ln(end / from));
        bounds[8] = within(*shape, [1.0, 5000.0]);
        bounds[9] = within(*tare, [1e-10, 1e-2]);
        let end = 0.1 * nominal_voltage;
        bounds[NULL_BIAS] = [(-end - bias) / self.bias_step, (end - bias) / self.bias_step];
        bounds[11] = within(*width, [1e-4 * nominal_voltage, 0.2 * nominal_voltage]);
        bounds
    }
}

/// A signal and the scale of its residuals.
struct Channel {
    recording: usize,
    signal: usize,
    scale: f64,
}

/// Recordings that are explained together.
struct Together<'a> {
    recordings: &'a [Recording],
    channels: Vec<Channel>,
    tested: TestedValve,
    variables: &'a Variables,
}

impl<'a> Together<'a> {
    fn new(recordings: &'a [Recording], tested: TestedValve, variables: &'a Variables) -> Together<'a> {
        let all = recordings.iter().enumerate();
        let channels = all.flat_map(|(recording, one)| {
            one.signals.iter().enumerate().filter_map(move |(signal, values)| {
                let [least, most] = values.range();
                (most > least).then_some(Channel { recording, signal, scale: FIRST_SCALE * (most - least) })
            })
        });
        Together { recordings, channels: channels.collect(), tested, variables }
    }

    fn signal(&self, channel: &Channel) -> Option<(&Recording, &RecordedSignal)> {
        let recording = self.recordings.get(channel.recording)?;
        Some((recording, recording.signals.get(channel.signal)?))
    }

    /// Residuals over their scales, channel by channel, with derivatives.
    fn linearised(&self, variables: &[f64]) -> Linearised {
        let coefficients = self.variables.coefficients(variables);
        let slopes = self.variables.slopes(&coefficients);
        let of = |one: &Recording| self.tested.sensitive_outputs(&coefficients, one.circuit, &one.inputs);
        let outputs: Vec<_> = self.recordings.iter().map(of).collect();
        let mut found = Linearised { residuals: Vec::new(), jacobian: Vec::new() };
        for channel in &self.channels {
            let Some(((_, signal), outputs)) = self.signal(channel).zip(outputs.get(channel.recording))
            else {
                continue;
            };
            for (output, value) in outputs.iter().zip(&signal.values) {
                let Some(value) = value else { continue };
                let weights = signal.kind.weights(&output.values());
                let shown = output.combined(weights);
                found.residuals.push((shown.value() - value) / channel.scale);
                let gradient = shown.gradient().iter().zip(slopes);
                found.jacobian.extend(gradient.map(|(slope, own)| slope * own / channel.scale));
            }
        }
        found
    }

    fn searched(&self, start: &[f64], evaluations: usize, watch: Watch<'_>) -> Result<Minimum, Stopped> {
        let settings = Settings { maximum_evaluations: evaluations, ..Settings::default() };
        let bounds = self.variables.bounds(self.tested.nominal_voltage);
        let mut done = 0;
        minimise(start, &bounds, settings, &mut |variables| {
            done += 1;
            tell(watch, "fitting", done, evaluations)?;
            Ok(Some(self.linearised(variables)))
        })
    }

    /// Residuals of each channel, over their scales.
    fn by_channel<'r>(&self, residuals: &'r [f64]) -> Vec<&'r [f64]> {
        let mut rest = residuals;
        let counts = self.channels.iter().map(|channel| {
            self.signal(channel).map_or(0, |(_, signal)| signal.values.iter().flatten().count())
        });
        counts
            .map(|count| {
                let (own, others) = rest.split_at(count.min(rest.len()));
                rest = others;
                own
            })
            .collect()
    }

    /// Takes the scale of each signal from its residuals: 1.4826 times their median magnitude, which
    /// outliers do not move; not below a resolution of 1e-6 of the range.
    fn rescale(&mut self, residuals: &[f64]) {
        let medians: Vec<f64> = self
            .by_channel(residuals)
            .into_iter()
            .map(|own| median(own.iter().map(|residual| residual.abs()).collect()))
            .collect();
        for (index, median) in medians.into_iter().enumerate() {
            let Some(range) = self.channels.get(index).and_then(|one| Some(self.signal(one)?.1.range()))
            else {
                continue;
            };
            if let Some(channel) = self.channels.get_mut(index) {
                channel.scale = (1.4826 * median * channel.scale).max(1e-6 * (range[1] - range[0]));
            }
        }
    }
}

/// The coefficients that explain all recordings.
pub(super) fn fitted(
    recordings: Vec<Recording>,
    tested: TestedValve,
    (simple, start): (SimpleCalculations, StaticCoefficients),
    search: Search,
    watch: Watch<'_>,
) -> Result<Identification, IdentifyError> {
    let variables = Variables::around(&start, tested.nominal_voltage);
    let (best, agreeing) = best_start(&recordings, tested, &variables, search, watch)?;
    let mut together = Together::new(&recordings, tested, &variables);
    if together.channels.is_empty() {
        return Err(IdentifyError::Data("no recorded signal changes: there is nothing to fit".to_string()));
    }
    let mut minimum = together.searched(&best, 60, watch)?;
    for _ in 0..ROUNDS {
        together.rescale(&minimum.linearised.residuals);
        minimum = together.searched(&minimum.variables, 60, watch)?;
    }
    if minimum.ending == Ending::NoStart || minimum.linearised.residuals.len() <= COUNT {
        return Err(IdentifyError::Data("the recordings have too few rows to fit a valve".to_string()));
    }
    let told = uncertainty(&minimum.linearised, COUNT, Settings::default().robust_beyond);
    let coefficients = variables.coefficients(&minimum.variables);
    let signals = signal_fits(&together, &minimum.linearised.residuals);
    let squares: f64 =
        signals.iter().map(|one| one.rows as f64 * (one.rms / one.range) * (one.rms / one.range)).sum();
    let rows: usize = signals.iter().map(|one| one.rows).sum();
    let intervals = intervals(&variables, &coefficients, &told.deviations);
    // what is not told may have ended anywhere: a further test is judged where it usually is
    let mut usual = coefficients.to_array();
    for ((number, interval), start) in usual.iter_mut().zip(intervals).zip(start.to_array()) {
        *number = if interval.is_some() { *number } else { start };
    }
    let usual = StaticCoefficients::from_array(usual);
    Ok(Identification {
        coefficients,
        intervals,
        untold: untold(&told, &usual, &variables.slopes(&usual), (&recordings, &tested)),
        correlations: told.correlations,
        simple,
        residual_rms: (squares / rows as f64).sqrt(),
        signals,
        at_bounds: at_bounds(&minimum, &variables.bounds(tested.nominal_voltage)),
        starts: [search.starts.max(1), agreeing],
        ending: minimum.ending,
        tested,
        recordings,
    })
}

/// The best of several starts, over fewer rows, and how many of them lead there.
fn best_start(
    recordings: &[Recording],
    tested: TestedValve,
    variables: &Variables,
    search: Search,
    watch: Watch<'_>,
) -> Result<(Vec<f64>, usize), Stopped> {
    if search.starts < 2 {
        return Ok((vec![0.0; COUNT], 1));
    }
    let fewer: Vec<Recording> = recordings.iter().map(thinned).collect();
    let together = Together::new(&fewer, tested, variables);
    let mut found: Vec<Minimum> = Vec::with_capacity(search.starts);
    for index in 0..search.starts {
        let mut state = stream(u64::from(search.seed), index as u64);
        let spread = if index == 0 { 0.0 } else { 0.7 };
        let start: Vec<f64> = (0..COUNT).map(|_| spread * normal(&mut state)).collect();
        found.push(together.searched(&start, 60, watch)?);
    }
    let lowest = found.iter().map(|minimum| minimum.cost).fold(f64::INFINITY, f64::min);
    let agreeing = found.iter().filter(|minimum| minimum.cost <= 1.01 * lowest + 1e-9).count();
    let best = found.into_iter().find(|minimum| minimum.cost <= lowest);
    Ok((best.map_or(vec![0.0; COUNT], |minimum| minimum.variables), agreeing))
}

/// Rows that a first search needs: all near null, and some of the others.
fn thinned(recording: &Recording) -> Recording {
    const OTHERS: usize = 150;
    let largest = recording.inputs.iter().map(|input| input.command.abs()).fold(0.0, f64::max);
    let near =
        |row: &usize| recording.inputs.get(*row).is_some_and(|input| input.command.abs() < 0.1 * largest);
    let stride = (recording.inputs.len() / OTHERS).max(1);
    let rows: Vec<usize> =
        (0..recording.inputs.len()).filter(|row| row % stride == 0 || (near(row) && row % 2 == 0)).collect();
    recording.only(&rows)
}

/// 95 % intervals: of what is positive, with ends that are positive too.
fn intervals(
    variables: &Variables,
    coefficients: &StaticCoefficients,
    deviations: &[f64],
) -> [Option<[f64; 2]>; COUNT] {
    let numbers = coefficients.to_array();
    std::array::from_fn(|index| {
        let half = NORMAL_95 * deviations.get(index).copied().unwrap_or(f64::INFINITY);
        // a factor beyond a million says nothing
        (half < 14.0).then(|| [-half, half].map(|by| variables.moved(index, numbers[index], by)))
    })
}

fn at_bounds(minimum: &Minimum, bounds: &[[f64; 2]; COUNT]) -> Vec<&'static str> {
    let all = minimum.variables.iter().zip(bounds).zip(COEFFICIENT_NAMES);
    let at = all.filter(|((x, [lower, upper]), _)| *x <= lower || *x >= upper);
    at.map(|(_, (name, _))| name).collect()
}

fn signal_fits(together: &Together<'_>, residuals: &[f64]) -> Vec<SignalFit> {
    let all = together.channels.iter().zip(together.by_channel(residuals));
    let one = |(channel, own): (&Channel, &[f64])| {
        let (_, signal) = together.signal(channel)?;
        let [least, most] = signal.range();
        let squares: f64 = own.iter().map(|residual| residual * residual).sum();
        let neighbours: f64 = own.iter().zip(own.iter().skip(1)).map(|(one, next)| one * next).sum();
        Some(SignalFit {
            recording: channel.recording,
            kind: signal.kind,
            rows: own.len(),
            rms: channel.scale * (squares / own.len().max(1) as f64).sqrt(),
            scale: channel.scale,
            range: most - least,
            correlation: if squares > 0.0 { neighbours / squares } else { 0.0 },
        })
    };
    all.filter_map(one).collect()
}
