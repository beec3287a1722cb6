//! Recorded signals that are explained together, and their residuals.

use phea_dynamics::least_squares::{Linearised, Minimum, Settings, minimise};
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, report_progress};
use phea_hydraulics::servovalve::{Sensitive, TestOutput, TestedValve};

use super::recording::{RecordedSignal, Recording};
use super::variables::{NULL_BIAS, Variables};
use phea_dynamics::order::median;

/// Initial scale of a residual, relative to the range of its signal.
const FIRST_SCALE: f64 = 0.01;

/// Least scale relative to the range, which no instrument resolves.
const RESOLUTION: f64 = 1e-6;

/// Number of evaluations of a search whose end is the start of another.
const FEW_EVALUATIONS: usize = 60;

/// Number of evaluations after which a search is judged to be worth its time.
const FIRST_STEPS: usize = 6;

/// Number of evaluations of the last search. If the recordings hardly distinguish coefficients, the
/// sum has a long curved valley.
pub(super) const EVALUATIONS: usize = 1000;

/// Decrease of the negative logarithm of the likelihood that moves no coefficient by more than a
/// twentieth of its standard deviation.
const NO_EVIDENCE: f64 = 1e-3;

/// Damping of a search that begins near its end.
const UNDAMPED: f64 = 1e-10;

/// Fewest rows of a recording from which the noise of its command is estimated.
const FEWEST_STEEP: usize = 10;

/// Ratio of the contribution of command noise to the scale of a signal from which a row is steep.
const STEEP: f64 = 2.0;

/// Ratio of the median magnitude of normal numbers to their standard deviation, and the ratio up to
/// which they still count as normal.
const OF_NORMAL: [f64; 2] = [0.6745, 0.75];

/// Number of bisections to find the noise of a command.
const HALVINGS: usize = 30;

/// A row in which a signal depends steeply on the command.
struct SteepRow {
    residual: f64,
    slope: f64,
    scale: f64,
}

/// Noise of the command with which half of the residuals of steep rows are within the normal range;
/// at most the noise of its record.
fn noise_of_steep_rows(steep: &[SteepRow], most: f64) -> f64 {
    let middle = |noise: f64| {
        let of = |row: &SteepRow| row.residual.abs() / portable::hypot(row.scale, noise * row.slope);
        median(steep.iter().map(of).collect())
    };
    let [normal, no_more] = OF_NORMAL;
    if middle(0.0) <= no_more {
        return 0.0;
    }
    let [mut low, mut high] = [0.0, most];
    for _ in 0..HALVINGS {
        let noise = f64::midpoint(low, high);
        if middle(noise) > normal { low = noise } else { high = noise }
    }
    high
}

/// A signal and the scale of its residuals.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Channel {
    pub(super) recording: usize,
    pub(super) signal: usize,
    pub(super) scale: f64,
    /// Standard deviation of the signal due to the noise of the command, row by row; empty without
    /// such noise.
    pub(super) by_command: Vec<f64>,
    /// Difference between largest and smallest value.
    pub(super) range: f64,
    /// Step of the converter that is visible in the values.
    pub(super) step: f64,
}

impl Channel {
    /// Scale of the residual of a row: from the noise of the signal and that of the command
    /// together.
    ///
    /// ```text
    /// s_i^2 = s_c^2 + (sigma_U dy/dU)^2                                        Orear (1982)
    /// ```
    fn scale_at(&self, row: usize) -> f64 {
        self.by_command.get(row).map_or(self.scale, |own| portable::hypot(self.scale, *own))
    }

    /// Resolution of the instrument, and the standard deviation of rounding to the converter's
    /// steps: if most rows are rounded to one value, their residuals do not show the noise.
    pub(super) fn least_scale(&self) -> f64 {
        (RESOLUTION * self.range).max(self.step / 12.0_f64.sqrt())
    }
}

/// Recordings that are explained together.
#[derive(Clone, Debug)]
pub(super) struct Together<'a> {
    pub(super) recordings: &'a [Recording],
    pub(super) channels: Vec<Channel>,
    pub(super) tested: TestedValve,
    pub(super) variables: Variables,
}

impl<'a> Together<'a> {
    pub(super) fn new(
        recordings: &'a [Recording],
        tested: TestedValve,
        variables: &Variables,
    ) -> Together<'a> {
        let all = recordings.iter().enumerate();
        let channels = all.flat_map(|(recording, one)| {
            one.signals.iter().enumerate().filter_map(move |(signal, values)| {
                let [least, most] = values.range();
                let range = most - least;
                let scale = FIRST_SCALE * range;
                let by_command = Vec::new();
                (range > 0.0).then(|| Channel {
                    recording,
                    signal,
                    scale,
                    by_command,
                    range,
                    step: values.step(),
                })
            })
        });
        let variables = variables.with_terms(tested.terms);
        Together { recordings, channels: channels.collect(), tested, variables }
    }

    pub(super) fn signal(&self, channel: &Channel) -> Option<&RecordedSignal> {
        self.recordings.get(channel.recording)?.signals.get(channel.signal)
    }

    /// Residuals divided by their scales, channel by channel, with derivatives.
    pub(super) fn linearised(&self, variables: &[f64]) -> Linearised {
        let coefficients = self.variables.coefficients(variables);
        let slopes = self.variables.slopes(&coefficients);
        let of = |one: &Recording| self.tested.sensitive_outputs(&coefficients, one.circuit, &one.inputs);
        let outputs: Vec<_> = self.recordings.iter().map(of).collect();
        let mut found = Linearised { residuals: Vec::new(), jacobian: Vec::new() };
        for channel in &self.channels {
            let Some((signal, outputs)) = self.signal(channel).zip(outputs.get(channel.recording)) else {
                continue;
            };
            for (row, (output, value)) in outputs.iter().zip(&signal.values).enumerate() {
                let Some(value) = value else { continue };
                let shown = output.combined(signal.kind.weights(&output.values()));
                let scale = channel.scale_at(row);
                found.residuals.push((shown.value() - value) / scale);
                let gradient = shown.gradient().iter().zip(slopes);
                found.jacobian.extend(gradient.map(|(slope, own)| slope * own / scale));
            }
        }
        found
    }

    /// Residuals without derivatives.
    pub(super) fn residuals(&self, variables: &[f64]) -> Vec<f64> {
        let coefficients = self.variables.coefficients(variables);
        let of = |one: &Recording| self.tested.outputs(&coefficients, one.circuit, &one.inputs);
        let outputs: Vec<_> = self.recordings.iter().map(of).collect();
        let of_channel = |channel: &Channel| {
            let (signal, outputs) = self.signal(channel).zip(outputs.get(channel.recording))?;
            let one = |(row, (output, value)): (usize, (&TestOutput, &Option<f64>))| {
                Some((signal.kind.shown(output) - (*value)?) / channel.scale_at(row))
            };
            Some(outputs.iter().zip(&signal.values).enumerate().filter_map(one).collect::<Vec<f64>>())
        };
        self.channels.iter().filter_map(of_channel).flatten().collect()
    }

    /// Group of each residual: the readings of one instant, or of this number of rows whose
    /// residuals are alike.
    pub(super) fn groups(&self, block_rows: usize) -> Vec<usize> {
        let mut before = 0;
        let mut firsts = Vec::with_capacity(self.recordings.len());
        for recording in self.recordings {
            firsts.push(before);
            before += recording.inputs.len().div_ceil(block_rows);
        }
        let mut groups = Vec::new();
        for channel in &self.channels {
            let Some((signal, first)) = self.signal(channel).zip(firsts.get(channel.recording)) else {
                continue;
            };
            let read = signal.values.iter().enumerate().filter(|(_, value)| value.is_some());
            groups.extend(read.map(|(row, _)| first + row / block_rows));
        }
        groups
    }

    /// Minimum of a search from here, to this relative decrease of the sum, or after few
    /// evaluations.
    pub(super) fn searched(
        &self,
        start: &[f64],
        tolerance: f64,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let few = Settings { maximum_evaluations: FEW_EVALUATIONS, tolerance, ..Settings::default() };
        self.searched_with(start, few, watch)
    }

    /// End of the first steps of a search from here.
    pub(super) fn searched_briefly(&self, start: &[f64], watch: Watch<'_>) -> Result<Minimum, Stopped> {
        let brief = Settings { maximum_evaluations: FIRST_STEPS, ..Settings::default() };
        self.searched_with(start, brief, watch)
    }

    /// Minimum to which a search from here leads.
    pub(super) fn searched_to_the_end(&self, start: &[f64], watch: Watch<'_>) -> Result<Minimum, Stopped> {
        let many = Settings { maximum_evaluations: EVALUATIONS, ..Settings::default() };
        self.searched_with(start, many, watch)
    }

    /// Minimum near a start that differs from it by less than the noise.
    pub(super) fn searched_from_near(
        &self,
        start: &[f64],
        maximum_evaluations: usize,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let rows: usize = self.recordings.iter().map(|one| one.inputs.len()).sum();
        let tolerance = NO_EVIDENCE / rows.max(1) as f64;
        let many =
            Settings { maximum_evaluations, tolerance, first_damping: UNDAMPED, ..Settings::default() };
        self.searched_with(start, many, watch)
    }

    fn searched_with(&self, start: &[f64], settings: Settings, watch: Watch<'_>) -> Result<Minimum, Stopped> {
        let mut done = 0;
        minimise(start, &self.variables.bounds(), settings, &mut |variables| {
            done += 1;
            report_progress(watch, "fitting", done, settings.maximum_evaluations)?;
            Ok(Some(self.linearised(variables)))
        })
    }

    /// Residuals of each channel, divided by their scales.
    pub(super) fn by_channel<'r>(&self, residuals: &'r [f64]) -> Vec<&'r [f64]> {
        let mut rest = residuals;
        let count = |channel| self.signal(channel).map_or(0, |signal| signal.values.iter().flatten().count());
        let mut split = |channel| {
            let (own, others) = rest.split_at(count(channel).min(rest.len()));
            rest = others;
            own
        };
        self.channels.iter().map(&mut split).collect()
    }

    /// Scales of the residuals of a channel, for each row that was read.
    pub(super) fn scales<'c>(&'c self, channel: &'c Channel) -> impl Iterator<Item = f64> + 'c {
        let values = self.signal(channel).into_iter().flat_map(|signal| &signal.values);
        values.enumerate().filter(|(_, value)| value.is_some()).map(|(row, _)| channel.scale_at(row))
    }

    /// Takes the scale of each signal from its residuals: 1.4826 times their median magnitude,
    /// which outliers do not move; at least the resolution of the instrument. Then that of the
    /// command of each recording. Returns the largest relative change of the scale of a signal.
    pub(super) fn rescale(&mut self, variables: &[f64], residuals: &[f64]) -> f64 {
        let of = |own: &[f64]| median(own.iter().map(|residual| residual.abs()).collect());
        let medians: Vec<f64> = self.by_channel(residuals).into_iter().map(of).collect();
        let unscaled = self.unscaled(residuals);
        let mut change = 0.0_f64;
        for (channel, median) in self.channels.iter_mut().zip(medians) {
            let scale = (1.4826 * median * channel.scale).max(channel.least_scale());
            change = change.max((scale / channel.scale - 1.0).abs());
            channel.scale = scale;
        }
        let recordings = self.recordings;
        for (index, recording) in recordings.iter().enumerate().filter(|(_, one)| one.command_roughness > 0.0)
        {
            self.takes_command_noise(index, recording, variables, &unscaled);
        }
        change
    }

    /// Residuals of each channel for each row that was read, in the unit of the signal.
    fn unscaled(&self, residuals: &[f64]) -> Vec<Vec<f64>> {
        let own = self.channels.iter().zip(self.by_channel(residuals));
        own.map(|(channel, own)| {
            own.iter().zip(self.scales(channel)).map(|(one, scale)| one * scale).collect()
        })
        .collect()
    }

    /// Determines the standard deviation of the signals of a recording due to the noise of the
    /// command.
    ///
    /// The record of the command shows its roughness; the residuals at steep rows of a signal show
    /// that the valve did not follow it. The noise is the value with which half of the residuals
    /// are normal, at most that of the record; zero if they are normal without it: a command that
    /// was sent unchanged is rounded, and without noise.
    fn takes_command_noise(
        &mut self,
        index: usize,
        recording: &Recording,
        variables: &[f64],
        unscaled: &[Vec<f64>],
    ) {
        let slopes = self.command_slopes(recording, variables);
        let mut steep = Vec::new();
        let own = self.channels.iter().zip(unscaled).filter(|(channel, _)| channel.recording == index);
        for (channel, residuals) in own {
            let Some(signal) = recording.signals.get(channel.signal) else { continue };
            let read = signal.values.iter().zip(&slopes).filter(|(value, _)| value.is_some());
            let slopes = read.map(|(_, slopes)| slopes.get(channel.signal).copied().unwrap_or(0.0));
            let least = STEEP * channel.scale / recording.command_roughness;
            let rows = slopes.zip(residuals).filter(|(slope, _)| *slope > least);
            steep.extend(rows.map(|(slope, residual)| SteepRow {
                residual: *residual,
                slope,
                scale: channel.scale,
            }));
        }
        let are_enough = steep.len() >= FEWEST_STEEP;
        let rough = recording.command_roughness;
        let noise = if are_enough { noise_of_steep_rows(&steep, rough) } else { rough };
        for channel in self.channels.iter_mut().filter(|channel| channel.recording == index) {
            let signal = channel.signal;
            let of = |slopes: &Vec<f64>| noise * slopes.get(signal).copied().unwrap_or(0.0);
            channel.by_command = slopes.iter().map(of).collect();
        }
    }

    /// Magnitude of the slope of each signal of a recording with respect to the command, row by
    /// row.
    fn command_slopes(&self, recording: &Recording, variables: &[f64]) -> Vec<Vec<f64>> {
        let coefficients = self.variables.coefficients(variables);
        let outputs = self.tested.sensitive_outputs(&coefficients, recording.circuit, &recording.inputs);
        let of = |output: &TestOutput<Sensitive>| {
            let slope = |signal: &RecordedSignal| {
                let shown = output.combined(signal.kind.weights(&output.values()));
                // a command moves the edges as a null bias of opposite sign does
                shown.gradient().get(NULL_BIAS).map_or(0.0, |slope| slope.abs())
            };
            recording.signals.iter().map(slope).collect()
        };
        outputs.iter().map(of).collect()
    }
}
