use phea_dynamics::spectrum::{Blocks, SpectralPoint, least_coherence, period, periods, segments};

use super::{ResponseSettings, SampledPair};

/// How the blocks of a record were made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Averaging {
    /// The last whole periods.
    Periods {
        /// s.
        period: f64,
        /// How many are averaged.
        count: usize,
    },
    /// Segments that overlap by half, with a Hann window.
    Segments {
        /// s.
        length: f64,
        /// How many there are.
        count: usize,
        /// As how many without overlap they count.
        independent: f64,
    },
}

/// A frequency response from one record.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseMember {
    /// The file it is from.
    pub file: String,
    /// What the columns are called: input and output.
    pub signals: [&'static str; 2],
    /// Units of them in SI.
    pub units: [&'static str; 2],
    /// Rows of the file.
    pub rows: usize,
    /// s between rows.
    pub time_step: f64,
    /// How the blocks were made.
    pub method: Averaging,
    /// Squared coherence that a point must have.
    pub least_coherence: f64,
    /// Points that are known well enough, the lowest frequency first.
    pub points: Vec<SpectralPoint>,
    /// The others.
    pub left_out: Vec<LeftOut>,
}

/// A frequency that is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftOut {
    /// rad/s.
    pub frequency: f64,
    /// Squared coherence there.
    pub coherence: f64,
    /// Why.
    pub reason: Unusable,
}

/// Why a frequency is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unusable {
    /// The input has no power there.
    NotExcited,
    /// Noise, or what is not linear, hides the response.
    Incoherent,
}

/// Share of the strongest line's power below which the input does not excite: 60 dB.
const UNEXCITED: f64 = 1e-6;

/// Segments that a record is cut into where nobody says, at least.
const SEGMENTS: usize = 8;

pub(super) fn member(record: &SampledPair, settings: &ResponseSettings) -> Result<ResponseMember, String> {
    let file = &record.file;
    let steps = |seconds: f64| (seconds / record.time_step).round() as usize;
    if record.input.iter().all(|value| Some(value) == record.input.first()) {
        return Err(format!("{file}: the input never moves, so that it excites nothing"));
    }
    let settling = settings.settling.map(steps);
    let found = match (settings.period, settings.segment) {
        (Some(stated), _) => Some(whole_steps(record, stated)?),
        (None, Some(_)) => None,
        (None, None) => period(record.input.get(settling.unwrap_or(0)..).unwrap_or_default()),
    };
    let signals = [record.input.as_slice(), record.output.as_slice()];
    let (blocks, method) = match found {
        Some(period) => {
            let blocks = periods(signals, record.time_step, period, settling.unwrap_or(period));
            let blocks = blocks.ok_or_else(|| too_short(record, period, settling.unwrap_or(period)))?;
            let count = blocks.count();
            (blocks, Averaging::Periods { period: period as f64 * record.time_step, count })
        }
        None => {
            let start = settling.unwrap_or(0);
            let later = signals.map(|signal| signal.get(start..).unwrap_or_default());
            let length = settings.segment.map_or(usual_segment(later[0].len()), steps);
            let blocks = segments(later, record.time_step, length).ok_or_else(|| {
                format!("{file}: {} rows are too few for segments of {length} rows", later[0].len())
            })?;
            let (count, independent) = (blocks.count(), blocks.independent());
            (blocks, Averaging::Segments { length: length as f64 * record.time_step, count, independent })
        }
    };
    let least = settings.coherence.max(least_coherence(blocks.independent()));
    let (points, left_out) = sorted(&blocks, &method, least);
    if points.is_empty() {
        return Err(format!(
            "{file}: at no frequency does the output depend on the input with a squared coherence of {least:.2}"
        ));
    }
    Ok(ResponseMember {
        file: file.clone(),
        signals: record.signals,
        units: record.units,
        rows: record.input.len(),
        time_step: record.time_step,
        method,
        least_coherence: least,
        points,
        left_out,
    })
}

/// Points that are known well enough, and the others.
fn sorted(blocks: &Blocks, method: &Averaging, least: f64) -> (Vec<SpectralPoint>, Vec<LeftOut>) {
    // a window spreads what is left of the mean over two lines
    let first = if matches!(method, Averaging::Segments { .. }) { 1 } else { 0 };
    let (mut points, mut left_out) = (Vec::new(), Vec::new());
    for point in blocks.points().into_iter().skip(first) {
        let reason = match point {
            SpectralPoint { excitation, .. } if excitation < UNEXCITED => Unusable::NotExcited,
            SpectralPoint { coherence, .. } if coherence < least => Unusable::Incoherent,
            _ => {
                points.push(point);
                continue;
            }
        };
        left_out.push(LeftOut { frequency: point.frequency, coherence: point.coherence, reason });
    }
    (points, left_out)
}

/// A power of two, so that the record has at least [`SEGMENTS`].
fn usual_segment(rows: usize) -> usize {
    let most = (rows / SEGMENTS).max(8);
    if most.is_power_of_two() { most } else { most.next_power_of_two() / 2 }
}

/// A stated period in steps of the record.
fn whole_steps(record: &SampledPair, stated: f64) -> Result<usize, String> {
    let exact = stated / record.time_step;
    let steps = exact.round();
    // half a step off at the end of the record leaks as much as one off in a period
    let periods = record.input.len() as f64 / steps.max(1.0);
    if (exact - steps).abs() * periods > 0.5 || steps < 4.0 {
        // to a nanosecond: the step is a mean of rounded stamps
        let seconds = |rows: f64| (rows * record.time_step * 1e9).round() / 1e9;
        return Err(format!(
            "{}: a period of {stated} s is {exact:.4} rows of {} s; a period of whole rows has no leakage: {} s or {} s",
            record.file,
            seconds(1.0),
            seconds(exact.floor()),
            seconds(exact.ceil())
        ));
    }
    Ok(steps as usize)
}

fn too_short(record: &SampledPair, period: usize, settling: usize) -> String {
    let seconds = |rows: usize| rows as f64 * record.time_step;
    format!(
        "{}: {:.4} s are too short: after {:.4} s for the transient, at least two periods of {:.4} s are needed, whose difference shows how much is noise",
        record.file,
        seconds(record.input.len()),
        seconds(settling),
        seconds(period)
    )
}
