//! Intervals from repeated fits with resampled noise.

use phea_dynamics::least_squares::Ending;
use phea_dynamics::order::sort_numbers;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::watch::{Stopped, Watch, report_progress, unwatched};

use super::channels::Together;
use super::fit::Fit;
use super::recording::{RecordedSignal, Recording};
use super::variables::{COUNT, Kind};

/// Least number of repetitions, so that the 2.5 % quantile is not the outermost value.
pub const FEWEST_REPETITIONS: usize = 50;

/// Relative decrease of the sum at which a repetition ends.
const TOLERANCE: f64 = 1e-7;

/// Intervals by the bootstrap.
#[derive(Clone, Debug, PartialEq)]
pub struct Bootstrap {
    /// 95 % interval of each coefficient, from the 2.5th to the 97.5th percentile.
    pub intervals: [[f64; 2]; COUNT],
    /// Number of completed repetitions.
    pub repetitions: usize,
    /// Number of repetitions whose fit did not converge: they are omitted.
    pub failed: usize,
    /// Number of rows of a block.
    pub block_rows: usize,
}

/// The wild bootstrap of blocks: each repetition fits recordings composed of the model's values and
/// its residuals with random signs, one sign for all signals of a block of neighbouring rows.
///
/// ```text
/// y* = y(K) + s_b r sqrt(n/(n - m))        s_b = +-1
/// ```
///
/// Thus noise that differs from row to row stays in its row, signals of a row stay together, and
/// the correlation of neighbouring residuals stays within a block (Liu 1988, Shao 2010). A block is
/// as long as the correlation of the residuals of any signal: up to the lag at which it is below
/// 2/sqrt(n).
pub(super) fn bootstrap(
    fit: &Fit<'_>,
    repetitions: usize,
    seed: u32,
    watch: Watch<'_>,
) -> Result<Bootstrap, Stopped> {
    let together = &fit.together;
    let block_rows = fit.block_rows();
    let residuals = fit.minimum.linearised.residuals.len() as f64;
    let widening = (residuals / (residuals - together.variables.count() as f64)).sqrt();
    let mut estimates: [Vec<f64>; COUNT] = std::array::from_fn(|_| Vec::with_capacity(repetitions));
    let mut failed = 0;
    for repetition in 0..repetitions {
        report_progress(watch, "bootstrap", repetition, repetitions)?;
        let mut state = stream(u64::from(seed), repetition as u64);
        let recordings = repeated(fit, widening, block_rows, &mut state);
        let again = Together { recordings: &recordings, ..together.clone() };
        let found = again.searched(&fit.minimum.variables, TOLERANCE, &mut unwatched)?;
        if found.ending != Ending::Converged {
            failed += 1;
            continue;
        }
        let numbers = together.variables.coefficients(&found.variables).to_array();
        for (estimates, number) in estimates.iter_mut().zip(numbers) {
            estimates.push(number);
        }
    }
    let lowest = together.variables.bounds().map(|[lower, _]| lower);
    let lowest = together.variables.coefficients(&lowest).to_array();
    let mut intervals = [[f64::NAN; 2]; COUNT];
    for (index, ((ends, estimates), least)) in
        intervals.iter_mut().zip(&mut estimates).zip(lowest).enumerate()
    {
        sort_numbers(estimates);
        *ends = [0.025, 0.975].map(|fraction| percentile(estimates, fraction));
        // a coefficient that ends at the bound of the search may be zero
        if Kind::vanishes(index) && ends[0] <= least {
            ends[0] = 0.0;
        }
    }
    Ok(Bootstrap { intervals, repetitions, failed, block_rows })
}

/// Recordings with the signs of their residuals drawn anew.
fn repeated(fit: &Fit<'_>, widening: f64, block_rows: usize, state: &mut u64) -> Vec<Recording> {
    let together = &fit.together;
    let mut recordings = together.recordings.to_vec();
    let signs: Vec<Vec<f64>> = recordings
        .iter()
        .map(|recording| {
            let blocks = recording.inputs.len().div_ceil(block_rows);
            (0..blocks).map(|_| if uniform(state) < 0.5 { -widening } else { widening }).collect()
        })
        .collect();
    let residuals = together.by_channel(&fit.minimum.linearised.residuals);
    for (channel, residuals) in together.channels.iter().zip(residuals) {
        let Some((recording, signs)) =
            recordings.get_mut(channel.recording).zip(signs.get(channel.recording))
        else {
            continue;
        };
        let Some(signal) = recording.signals.get_mut(channel.signal) else { continue };
        let signs = signs.iter().flat_map(|sign| std::iter::repeat_n(sign, block_rows));
        replace(signal, residuals, together.scales(channel), signs);
    }
    recordings
}

/// Replaces each value by the model's value (the value minus the residual) plus the residual
/// multiplied by a sign.
fn replace<'s>(
    signal: &mut RecordedSignal,
    residuals: &[f64],
    scales: impl Iterator<Item = f64>,
    signs: impl Iterator<Item = &'s f64>,
) {
    let read = signal.values.iter_mut().zip(signs).filter_map(|(value, sign)| Some((value.as_mut()?, sign)));
    for (((value, sign), residual), scale) in read.zip(residuals).zip(scales) {
        *value += residual * scale * (1.0 - sign);
    }
}

/// Percentile of sorted numbers; NaN if there are none.
fn percentile(sorted: &[f64], fraction: f64) -> f64 {
    let place = fraction * sorted.len().saturating_sub(1) as f64;
    let below = place.floor();
    let at = |index: usize| sorted.get(index).or(sorted.last()).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(below as usize), at(below as usize + 1));
    low + (place - below) * (high - low)
}
