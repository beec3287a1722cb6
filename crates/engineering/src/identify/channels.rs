//! The recorded signals that are explained together, and their residuals.

use phea_dynamics::least_squares::{Linearised, Minimum, Settings, minimise};
use phea_dynamics::watch::{Stopped, Watch, tell};
use phea_hydraulics::servovalve::{TestOutput, TestedValve};

use super::recording::{RecordedSignal, Recording, median};
use super::variables::Variables;

/// Initial scale of a residual, over the range of its signal.
const FIRST_SCALE: f64 = 0.01;

/// Least scale over the range, which no instrument resolves.
const RESOLUTION: f64 = 1e-6;

/// Evaluations of a search whose end is the start of another.
const FEW_EVALUATIONS: usize = 60;

/// Evaluations of the last search. Where the recordings hardly distinguish coefficients, the sum
/// has a long curved valley.
pub(super) const EVALUATIONS: usize = 1000;

/// Decrease of the negative logarithm of the likelihood that moves no coefficient by more than a
/// twentieth of its standard deviation.
const NO_EVIDENCE: f64 = 1e-3;

/// Damping of a search that begins near its end.
const UNDAMPED: f64 = 1e-10;

/// A signal and the scale of its residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Channel {
    pub(super) recording: usize,
    pub(super) signal: usize,
    pub(super) scale: f64,
    /// Largest less smallest value.
    pub(super) range: f64,
    /// Step of the converter that the values show.
    pub(super) step: f64,
}

impl Channel {
    /// What no instrument resolves, and the standard deviation of rounding to the converter's
    /// steps: where most rows are rounded to one value, their residuals say nothing of the noise.
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
    pub(super) variables: &'a Variables,
}

impl<'a> Together<'a> {
    pub(super) fn new(
        recordings: &'a [Recording],
        tested: TestedValve,
        variables: &'a Variables,
    ) -> Together<'a> {
        let all = recordings.iter().enumerate();
        let channels = all.flat_map(|(recording, one)| {
            one.signals.iter().enumerate().filter_map(move |(signal, values)| {
                let [least, most] = values.range();
                let range = most - least;
                let scale = FIRST_SCALE * range;
                (range > 0.0).then(|| Channel { recording, signal, scale, range, step: values.step() })
            })
        });
        Together { recordings, channels: channels.collect(), tested, variables }
    }

    pub(super) fn signal(&self, channel: &Channel) -> Option<&RecordedSignal> {
        self.recordings.get(channel.recording)?.signals.get(channel.signal)
    }

    /// Residuals over their scales, channel by channel, with derivatives.
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
            for (output, value) in outputs.iter().zip(&signal.values) {
                let Some(value) = value else { continue };
                let shown = output.combined(signal.kind.weights(&output.values()));
                found.residuals.push((shown.value() - value) / channel.scale);
                let gradient = shown.gradient().iter().zip(slopes);
                found.jacobian.extend(gradient.map(|(slope, own)| slope * own / channel.scale));
            }
        }
        found
    }

    /// The same residuals without derivatives.
    pub(super) fn residuals(&self, variables: &[f64]) -> Vec<f64> {
        let coefficients = self.variables.coefficients(variables);
        let of = |one: &Recording| self.tested.outputs(&coefficients, one.circuit, &one.inputs);
        let outputs: Vec<_> = self.recordings.iter().map(of).collect();
        let of_channel = |channel: &Channel| {
            let (signal, outputs) = self.signal(channel).zip(outputs.get(channel.recording))?;
            let one = |(output, value): (&TestOutput, &Option<f64>)| {
                Some((signal.kind.shown(output) - (*value)?) / channel.scale)
            };
            Some(outputs.iter().zip(&signal.values).filter_map(one).collect::<Vec<f64>>())
        };
        self.channels.iter().filter_map(of_channel).flatten().collect()
    }

    /// The group of each residual: the readings of one instant.
    pub(super) fn groups(&self) -> Vec<usize> {
        let mut before = 0;
        let mut firsts = Vec::with_capacity(self.recordings.len());
        for recording in self.recordings {
            firsts.push(before);
            before += recording.inputs.len();
        }
        let mut groups = Vec::new();
        for channel in &self.channels {
            let Some((signal, first)) = self.signal(channel).zip(firsts.get(channel.recording)) else {
                continue;
            };
            let read = signal.values.iter().enumerate().filter(|(_, value)| value.is_some());
            groups.extend(read.map(|(row, _)| first + row));
        }
        groups
    }

    /// Where a search from here ends, at this relative decrease of the sum, or soon.
    pub(super) fn searched(
        &self,
        start: &[f64],
        tolerance: f64,
        watch: Watch<'_>,
    ) -> Result<Minimum, Stopped> {
        let few = Settings { maximum_evaluations: FEW_EVALUATIONS, tolerance, ..Settings::default() };
        self.searched_with(start, few, watch)
    }

    /// The minimum that a search from here leads to.
    pub(super) fn searched_to_the_end(&self, start: &[f64], watch: Watch<'_>) -> Result<Minimum, Stopped> {
        let many = Settings { maximum_evaluations: EVALUATIONS, ..Settings::default() };
        self.searched_with(start, many, watch)
    }

    /// The minimum near a start that differs from it by less than the noise.
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
            tell(watch, "fitting", done, settings.maximum_evaluations)?;
            Ok(Some(self.linearised(variables)))
        })
    }

    /// Residuals of each channel, over their scales.
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

    /// Takes the scale of each signal from its residuals: 1.4826 times their median magnitude,
    /// which outliers do not move; at least what the instrument resolves. Returns the largest
    /// relative change.
    pub(super) fn rescale(&mut self, residuals: &[f64]) -> f64 {
        let of = |own: &[f64]| median(own.iter().map(|residual| residual.abs()).collect());
        let medians: Vec<f64> = self.by_channel(residuals).into_iter().map(of).collect();
        let mut change = 0.0_f64;
        for (channel, median) in self.channels.iter_mut().zip(medians) {
            let scale = (1.4826 * median * channel.scale).max(channel.least_scale());
            change = change.max((scale / channel.scale - 1.0).abs());
            channel.scale = scale;
        }
        change
    }
}
