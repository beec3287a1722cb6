use phea_dynamics::spectrum::{
    Distortion, LOCAL_BLOCKS, SpectralPoint, WithinRow, feedback, least_coherence, local_polynomials, period,
    periods, segments,
};

use super::{ReferenceSignal, ReferenceSource, Resampled, ResponseSettings, SampledPair};
use crate::identify_error::{MovingSignal, RecordFault};
use crate::project::RecordedLoop;

/// Division of a record into blocks for averaging.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Averaging {
    /// The last whole periods.
    Periods {
        /// Period, s.
        period: f64,
        /// Number of periods that are averaged.
        count: usize,
    },
    /// Local polynomials over bands of the whole record.
    LocalPolynomials {
        /// Length of the record, s.
        length: f64,
        /// Number of bands.
        bands: usize,
    },
    /// Segments that overlap by half, with a Hann window.
    Segments {
        /// Length of a segment, s.
        length: f64,
        /// Number of segments.
        count: usize,
        /// Equivalent number of segments without overlap.
        independent: f64,
    },
}

/// A frequency response from one record.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseMember {
    /// File of the record.
    pub file: String,
    /// Names of the columns: input and output.
    pub signals: [&'static str; 2],
    /// SI units of the columns.
    pub units: [&'static str; 2],
    /// Number of rows of the file.
    pub rows: usize,
    /// Time between rows, s.
    pub time_step: f64,
    /// Operating point of the test, if the project names it.
    pub operating_point: Option<String>,
    /// Root mean square of the input around its mean.
    pub input_rms: f64,
    /// Averaging of the blocks.
    pub method: Averaging,
    /// Signal from which the response of a closed loop follows.
    pub reference: Option<ReferenceSource>,
    /// Output at lines of the period that are not excited by the input.
    pub distortion: Distortion,
    /// Resampling of unevenly spaced rows.
    pub resampled: Option<Resampled>,
    /// Least squared coherence of a point.
    pub least_coherence: f64,
    /// Points that are sufficiently well known, the lowest frequency first.
    pub points: Vec<SpectralPoint>,
    /// Omitted points.
    pub left_out: Vec<LeftOut>,
}

/// An omitted frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// Frequency, rad/s.
    pub frequency: f64,
    /// Squared coherence at this frequency.
    pub coherence: f64,
    /// Reason for the omission.
    pub reason: Unusable,
}

/// Reason why a frequency is omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unusable {
    /// The input has no power at this frequency.
    NotExcited,
    /// Noise, or nonlinearity, hides the response.
    Incoherent,
}

/// Fraction of the strongest line's power below which the input does not excite: 60 dB.
const UNEXCITED: f64 = 1e-6;

pub(super) fn member(
    record: &SampledPair,
    settings: &ResponseSettings,
) -> Result<ResponseMember, RecordFault> {
    let steps = |seconds: f64| (seconds / record.time_step).round() as usize;
    if record.input.iter().all(|value| Some(value) == record.input.first()) {
        return Err(RecordFault::InputNeverMoves);
    }
    let settling = settings.settling.map(steps);
    let recorded = reference_of(record);
    let moving = recorded.map_or(&record.input, |reference| &reference.values);
    let found = match (settings.period, settings.segment) {
        (Some(stated), _) => Some(whole_steps(record, stated)?),
        (None, Some(_)) => None,
        (None, None) => period(moving.get(settling.unwrap_or(0)..).unwrap_or_default()),
    };
    let controller = record.controller.as_ref().filter(|_| found.is_none() && recorded.is_none());
    let calculated = controller.map(|controller| controller.reference(record)).transpose()?;
    let reference = recorded.or(calculated.as_ref());
    if found.is_none() && reference.is_none() {
        loop_is_open(record)?;
    }
    let mut estimated = match (found, settings.segment) {
        (Some(period), _) => of_periods(record, reference, period, settling.unwrap_or(period))?,
        (None, Some(length)) if reference.is_none() => {
            of_segments(record, steps(length), settling.unwrap_or(0))?
        }
        (None, _) => of_bands(record, reference, settling.unwrap_or(0))?,
    };
    for point in &mut estimated.points {
        if controller.is_some_and(|controller| controller.is_negative_inverse(point, record.time_step)) {
            point.excitation = 0.0;
        }
    }
    if let Some(resampled) = record.resampled {
        estimated.points.retain(|point| point.frequency <= resampled.highest());
    }
    let least = settings.coherence.max(least_coherence(estimated.independent));
    let (points, left_out) = sorted(estimated.points, least);
    if points.is_empty() {
        return Err(no_points(reference, &left_out, least));
    }
    Ok(ResponseMember {
        file: record.file.clone(),
        signals: record.signals,
        units: record.units,
        rows: record.input.len(),
        time_step: record.time_step,
        operating_point: record.operating_point.clone(),
        input_rms: (power(&record.input) / record.input.len().max(1) as f64).sqrt(),
        method: estimated.method,
        reference: reference.map(|reference| reference.source),
        distortion: estimated.distortion,
        resampled: record.resampled,
        least_coherence: least,
        points,
        left_out,
    })
}

/// Sum of squares around the mean.
pub(super) fn power(signal: &[f64]) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    signal.iter().map(|value| (value - mean) * (value - mean)).sum()
}

/// Response of a record before any omission.
struct Estimated {
    method: Averaging,
    points: Vec<SpectralPoint>,
    independent: f64,
    distortion: Distortion,
}

/// Signal that excites the loop from outside, unless the project states that it was open.
fn reference_of(record: &SampledPair) -> Option<&ReferenceSignal> {
    record.reference.as_ref().filter(|_| record.recorded_loop != Some(RecordedLoop::Open))
}

/// Rejects a record whose input follows the noise of its output: the quotient of both would tend to
/// the negative inverse of the controller.
fn loop_is_open(record: &SampledPair) -> Result<(), RecordFault> {
    let [input, output] = record.signals;
    match record.recorded_loop {
        Some(RecordedLoop::Open) => Ok(()),
        Some(RecordedLoop::Closed) => Err(RecordFault::NoReference { input, output }),
        None => match feedback(&record.input, &record.output, WithinRow::Possible) {
            fraction if fraction > 0.0 => Err(RecordFault::FollowsNoise { input, output, fraction }),
            _ => Ok(()),
        },
    }
}

fn of_periods(
    record: &SampledPair,
    reference: Option<&ReferenceSignal>,
    period: usize,
    settling: usize,
) -> Result<Estimated, RecordFault> {
    let signals = [record.input.as_slice(), record.output.as_slice()];
    let blocks = periods(signals, record.time_step, period, settling)
        .ok_or_else(|| too_short(record, period, settling))?;
    let mut points = blocks.points();
    if let Some(reference) = reference {
        // noise that the controller returns is no excitation, however large it is
        let moved = periods([&reference.values, &record.input], record.time_step, period, settling);
        let moved = moved.map(|blocks| blocks.points()).unwrap_or_default();
        for (point, moved) in points.iter_mut().zip(moved) {
            point.excitation = if moved.excitation < UNEXCITED { 0.0 } else { point.excitation };
        }
    }
    let method = Averaging::Periods { period: period as f64 * record.time_step, count: blocks.count() };
    let distortion = blocks.distortion();
    Ok(Estimated { method, points, independent: blocks.independent(), distortion })
}

fn of_segments(record: &SampledPair, length: usize, settling: usize) -> Result<Estimated, RecordFault> {
    let [input, output] =
        [&record.input, &record.output].map(|signal| signal.get(settling..).unwrap_or_default());
    let blocks = segments([input, output], record.time_step, length)
        .ok_or(RecordFault::TooFewForSegments { rows: input.len(), length })?;
    let (count, independent) = (blocks.count(), blocks.independent());
    let method = Averaging::Segments { length: length as f64 * record.time_step, count, independent };
    // the window spreads the remainder of the mean over two lines
    let points = blocks.points().into_iter().skip(1).collect();
    Ok(Estimated { method, points, independent, distortion: Distortion::default() })
}

fn of_bands(
    record: &SampledPair,
    reference: Option<&ReferenceSignal>,
    settling: usize,
) -> Result<Estimated, RecordFault> {
    let later = |signal: &'_ [f64]| signal.get(settling..).unwrap_or_default().to_vec();
    let [input, output] = [&record.input, &record.output].map(|signal| later(signal));
    let reference = reference.map_or_else(|| input.clone(), |one| later(&one.values));
    let points = local_polynomials(&reference, [&input, &output], record.time_step);
    if points.is_empty() && (record.controller.is_none() || settling > 0) {
        return Err(RecordFault::TooFewRows { rows: input.len() });
    }
    let length = input.len() as f64 * record.time_step;
    let method = Averaging::LocalPolynomials { length, bands: points.len() };
    Ok(Estimated { method, points, independent: LOCAL_BLOCKS, distortion: Distortion::default() })
}

/// Points that are sufficiently well known, and the others.
fn sorted(estimated: Vec<SpectralPoint>, least: f64) -> (Vec<SpectralPoint>, Vec<LeftOut>) {
    let (mut points, mut left_out) = (Vec::new(), Vec::new());
    for point in estimated {
        let reason = match point {
            SpectralPoint { excitation, .. } if excitation < UNEXCITED => Unusable::NotExcited,
            SpectralPoint { coherence, .. } if coherence < least => Unusable::Incoherent,
            SpectralPoint { radius, .. } if !radius.is_finite() => Unusable::Incoherent,
            _ => {
                points.push(point);
                continue;
            }
        };
        left_out.push(LeftOut { frequency: point.frequency, coherence: point.coherence, reason });
    }
    (points, left_out)
}

/// Reason why a record has no response at any frequency.
fn no_points(reference: Option<&ReferenceSignal>, left_out: &[LeftOut], least: f64) -> RecordFault {
    let moving = reference.map(|reference| match reference.source {
        ReferenceSource::Column(name) => MovingSignal::Column(name),
        ReferenceSource::Controller => MovingSignal::Calculated,
    });
    match moving {
        Some(moving) if left_out.iter().all(|one| one.reason == Unusable::NotExcited) => {
            RecordFault::NotMoved { moving }
        }
        Some(moving) => RecordFault::MovedTooLittle { moving, least },
        None => RecordFault::Incoherent { least },
    }
}

/// A stated period in steps of the record.
fn whole_steps(record: &SampledPair, stated: f64) -> Result<usize, RecordFault> {
    let exact = stated / record.time_step;
    let steps = exact.round();
    // half a step off at the end of the record causes as much leakage as one off in a period
    let periods = record.input.len() as f64 / steps.max(1.0);
    if (exact - steps).abs() * periods > 0.5 || steps < 4.0 {
        // to a nanosecond: the step is a mean of rounded stamps
        let seconds = |rows: f64| (rows * record.time_step * 1e9).round() / 1e9;
        return Err(RecordFault::PeriodOfPartRows {
            stated,
            rows: exact,
            time_step: seconds(1.0),
            whole: [exact.floor(), exact.ceil()].map(seconds),
        });
    }
    Ok(steps as usize)
}

fn too_short(record: &SampledPair, period: usize, settling: usize) -> RecordFault {
    let seconds = |rows: usize| rows as f64 * record.time_step;
    RecordFault::TooShort {
        length: seconds(record.input.len()),
        settling: seconds(settling),
        period: seconds(period),
    }
}
