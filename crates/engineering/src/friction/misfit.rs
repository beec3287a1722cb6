//! Misfit of the friction: residuals of the recordings that are not noise.
//!
//! ```text
//! m_k = mean residual of a constant velocity, s_k its standard deviation by the noise of the rows
//! misfit^2 = mean of m_k^2 - s_k^2                reported if sum m_k^2/s_k^2 is beyond chance and both halves agree
//! misfit^2 = r rms^2                                  of what is pressed or shaken, r the correlation of neighbours
//! ```

use phea_dynamics::order::ends;

use super::directions::DirectionModel;
use super::problem::{FrictionChannel, FrictionProblem};

/// A signal that the friction does not explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionMisfit {
    /// Index of the recording.
    pub recording: usize,
    /// Signal of the recording.
    pub signal: FrictionSignal,
    /// Correlation of neighbouring residuals: of both halves of each constant velocity, or of rows.
    pub correlation: f64,
    /// Root mean square of the misfit divided by the range of the signal.
    pub fraction: f64,
    /// Constant velocity at which the misfit is greatest, m/s, and the force of the model there
    /// minus the recorded one, N; `None` for a press or a shake.
    pub place: Option<[f64; 2]>,
}

/// A signal that friction explains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionSignal {
    /// Force A_A p_A - A_B p_B - F_e.
    Force,
    /// Position of the piston.
    Position,
}

impl FrictionSignal {
    /// Name in JSON and in text.
    pub fn name(self) -> &'static str {
        match self {
            FrictionSignal::Force => "force",
            FrictionSignal::Position => "position",
        }
    }
}

/// Correlation of neighbouring residuals up to which they count as noise, as for a valve.
const OF_NOISE: f64 = 0.4;

/// Number of standard deviations up to which a correlation of rows is chance, as for a valve.
const CHANCE: f64 = 5.0;

/// Number of standard deviations up to which a sum of squares is chance, as for a line.
const SUM_BY_CHANCE: f64 = 4.0;

/// Fraction of the range below which misfits are not reported, as for a valve.
const SMALLEST_FRACTION: f64 = 1e-3;

/// Number of constant velocities that the steady curve and the zero error, or the curves of both
/// directions, always explain.
fn explained_by(directions: DirectionModel) -> usize {
    match directions {
        DirectionModel::SameBothWays => 6,
        DirectionModel::DiffersByDirection => 8,
    }
}

/// Signals that are not explained, from these residuals, the greatest misfit first.
pub(super) fn misfits(problem: &FrictionProblem<'_>, residuals: &[f64]) -> Vec<FrictionMisfit> {
    let mut found = Vec::new();
    let mut channels = problem.channels.iter();
    for slides in problem.slides.chunk_by(|one, next| one.recording == next.recording) {
        let Some(channel) = channels.next() else { break };
        found.extend(of_slides(slides, channel, residuals, explained_by(problem.directions)));
    }
    let presses = problem.presses.iter().map(|press| (press.recording, press.rows));
    let shakes = problem.shakes.iter().map(|shake| (shake.recording, shake.force.rows));
    for (recording, rows) in presses.chain(shakes) {
        let Some(own) = problem.recordings.get(recording) else { continue };
        for (signal, values) in
            [(FrictionSignal::Force, &own.forces), (FrictionSignal::Position, &own.positions)]
        {
            let Some(channel) = channels.next() else { break };
            let values = values.get(..rows).unwrap_or_default();
            let misfit = of_rows(values, channel, residuals);
            found.extend(misfit.map(|[correlation, fraction]| FrictionMisfit {
                recording,
                signal,
                correlation,
                fraction,
                place: None,
            }));
        }
    }
    found.sort_by(|one, other| other.fraction.total_cmp(&one.fraction));
    found
}

fn own<'a>(channel: &FrictionChannel, residuals: &'a [f64]) -> &'a [f64] {
    let [from, to] = channel.residuals;
    residuals.get(from..to).unwrap_or_default()
}

/// Mean residual of a slide over all rows and over both halves, N, and the standard deviation of
/// the first due to noise.
struct SlideResidual {
    velocity: f64,
    mean: f64,
    halves: [f64; 2],
    deviation: f64,
}

fn of_slides(
    slides: &[super::ConstantVelocity],
    channel: &FrictionChannel,
    residuals: &[f64],
    explained: usize,
) -> Option<FrictionMisfit> {
    let recording = slides.first()?.recording;
    let mut rest = own(channel, residuals).iter();
    let of = |slide: &super::ConstantVelocity| {
        let blocks = slide.blocks.len();
        let mut sums = [(0.0, 0.0); 2];
        for (index, block) in slide.blocks.iter().enumerate() {
            let rows = block.rows as f64;
            let residual = rest.next().copied().unwrap_or(0.0) * channel.effective_scale() / rows.sqrt();
            let half = &mut sums[usize::from(2 * index >= blocks)];
            *half = (half.0 + rows * residual, half.1 + rows);
        }
        let [first, second] = sums;
        let rows = first.1 + second.1;
        SlideResidual {
            velocity: slide.velocity,
            mean: (first.0 + second.0) / rows,
            halves: sums.map(|(sum, rows)| if rows > 0.0 { sum / rows } else { 0.0 }),
            deviation: channel.noise / rows.sqrt(),
        }
    };
    let all: Vec<SlideResidual> = slides.iter().map(of).collect();
    let freedom = all.len().checked_sub(explained).filter(|freedom| *freedom > 0)? as f64;
    let square = |value: f64| value * value;
    let sum: f64 = all.iter().map(|one| square(one.mean / one.deviation)).sum();
    let product: f64 = all.iter().map(|one| 2.0 * one.halves[0] * one.halves[1]).sum();
    let squares: f64 = all.iter().map(|one| square(one.halves[0]) + square(one.halves[1])).sum();
    let correlation = if squares > 0.0 { product / squares } else { 0.0 };
    let excess: f64 = all.iter().map(|one| square(one.mean) - square(one.deviation)).sum();
    let forces = slides.iter().flat_map(|slide| slide.blocks.iter().map(|block| block.force));
    let [least, greatest] = ends(forces);
    let fraction = (excess.max(0.0) / all.len() as f64).sqrt() / (greatest - least);
    let is_chance = sum <= freedom + SUM_BY_CHANCE * (2.0 * freedom).sqrt();
    let most = all.iter().max_by(|one, other| one.mean.abs().total_cmp(&other.mean.abs()))?;
    (!is_chance && correlation > OF_NOISE && fraction >= SMALLEST_FRACTION).then_some(FrictionMisfit {
        recording,
        signal: FrictionSignal::Force,
        correlation,
        fraction,
        place: Some([most.velocity, most.mean]),
    })
}

/// Correlation of neighbours, and misfit divided by the range, if it is more than noise.
fn of_rows(values: &[f64], channel: &FrictionChannel, residuals: &[f64]) -> Option<[f64; 2]> {
    let own = own(channel, residuals);
    let squares: f64 = own.iter().map(|residual| residual * residual).sum();
    let products: f64 = own.iter().zip(own.iter().skip(1)).map(|(one, next)| one * next).sum();
    let correlation = if squares > 0.0 { products / squares } else { 0.0 };
    let rms = channel.effective_scale() * (squares / own.len().max(1) as f64).sqrt();
    let [least, greatest] = ends(values.iter().copied());
    let fraction = rms * correlation.max(0.0).sqrt() / (greatest - least);
    let is_chance = correlation * (own.len() as f64).sqrt() <= CHANCE;
    (correlation > OF_NOISE && !is_chance && fraction >= SMALLEST_FRACTION).then_some([correlation, fraction])
}
