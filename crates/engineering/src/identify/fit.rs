//! Least squares over all signals of all recordings, with one model of the leakage.

use phea_dynamics::least_squares::{Ending, Minimum, Settings};
use phea_dynamics::random::stream;
use phea_dynamics::watch::{Stopped, Watch};
use phea_hydraulics::servovalve::{StaticCoefficients, TestedValve};

use super::averaged::averaged;
use super::channels::{Channel, EVALUATIONS, Together};
use super::recording::Recording;
use super::variables::{COUNT, Kind, Variables, over};
use super::{COEFFICIENT_NAMES, Search, SignalFit};
use crate::identify_error::{IdentifyError, ValveFitError};

/// Number of rounds in which the scale of each signal is computed from its residuals.
const ROUNDS: usize = 4;

/// Relative decrease of the sum at which an intermediate search ends.
const ROUGH: f64 = 1e-5;

/// Relative change of the scales below which no further round is made.
const SAME_SCALE: f64 = 1e-3;

/// Rows of the first search: spread over a recording, and near null.
const OTHERS: usize = 150;
const NEAR: usize = 1500;

/// Number of rows of all recordings above which the minimum is first found over averages of rows.
/// The last search is over all rows from there, and ends after few evaluations.
const MANY_ROWS: usize = 20_000;

/// Number of evaluations over all of many rows for a model that need not be the requested one.
const ROUGH_EVALUATIONS: usize = 12;

/// Least number of blocks of a recording, which limits their length.
const LONGEST_BLOCK: usize = 10;

/// Extent of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// Search until the sum falls by less than a hundred-thousandth of it: enough to compare
    /// models.
    ToCompare,
    /// Search until no further improvement is possible.
    ToTheEnd,
}

/// Valve that explains the recordings best, with the signals and their scales.
pub(super) struct Fit<'a> {
    pub(super) together: Together<'a>,
    pub(super) minimum: Minimum,
    /// Number of starting points, and number of those that lead here.
    pub(super) starts: [usize; 2],
}

impl Fit<'_> {
    pub(super) fn coefficients(&self) -> StaticCoefficients {
        self.together.variables.coefficients(&self.minimum.variables)
    }

    /// Coefficients that ended at a bound of the search, except those that may vanish and did.
    pub(super) fn at_bounds(&self) -> Vec<&'static str> {
        let bounds = self.together.variables.bounds();
        let all = self.minimum.variables.iter().zip(bounds).zip(COEFFICIENT_NAMES).enumerate();
        let at = all.filter(|(index, ((x, [lower, upper]), _))| {
            **x >= *upper || (**x <= *lower && !Kind::vanishes(*index))
        });
        at.map(|(_, (_, (name, _)))| name).collect()
    }

    /// Number of rows after which the residuals of no signal are correlated.
    pub(super) fn block_rows(&self) -> usize {
        let beyond = Settings::default().robust_beyond;
        let residuals = self.together.by_channel(&self.minimum.linearised.residuals);
        let of = |own: &[f64]| {
            // a single outlier has no effect on its neighbours
            let own: Vec<f64> = own.iter().map(|residual| residual.max(-beyond).min(beyond)).collect();
            let squares: f64 = own.iter().map(|residual| residual * residual).sum();
            let limit = 2.0 / (own.len() as f64).sqrt() * squares;
            let alike = |lag: &usize| {
                let products = own.iter().zip(own.iter().skip(*lag)).map(|(one, next)| one * next);
                products.sum::<f64>() < limit
            };
            let longest = (own.len() / LONGEST_BLOCK).max(1);
            (1..longest).find(alike).unwrap_or(longest)
        };
        residuals.into_iter().map(of).max().unwrap_or(1)
    }

    /// Fit of each signal.
    pub(super) fn signals(&self) -> Vec<SignalFit> {
        self.signals_with(&self.minimum.linearised.residuals)
    }

    /// True if a signal remains unexplained.
    pub(super) fn has_misfit(&self) -> bool {
        self.signals().iter().any(|signal| signal.misfit().is_some())
    }

    /// Fit of each signal with these residuals.
    pub(super) fn signals_with(&self, residuals: &[f64]) -> Vec<SignalFit> {
        let residuals = self.together.by_channel(residuals);
        let one = |(channel, own): (&Channel, &[f64])| {
            let squares: f64 = own.iter().map(|residual| residual * residual).sum();
            let unscaled = own.iter().zip(self.together.scales(channel)).map(|(one, scale)| one * scale);
            let mean_square = unscaled.map(|one| one * one).sum::<f64>() / own.len().max(1) as f64;
            let neighbours: f64 = own.iter().zip(own.iter().skip(1)).map(|(one, next)| one * next).sum();
            Some(SignalFit {
                recording: channel.recording,
                kind: self.together.signal(channel)?.kind,
                rows: own.len(),
                rms: mean_square.sqrt(),
                scale: channel.scale,
                range: channel.range,
                correlation: if squares > 0.0 { neighbours / squares } else { 0.0 },
            })
        };
        self.together.channels.iter().zip(residuals).filter_map(one).collect()
    }
}

/// Coefficients that explain all recordings best, from several starting points.
pub(super) fn fitted<'a>(
    recordings: &'a [Recording],
    tested: TestedValve,
    variables: &Variables,
    search: Search,
    watch: Watch<'_>,
) -> Result<Fit<'a>, IdentifyError> {
    let starts = (0..search.starts.max(1)).map(|index| {
        let mut state = stream(u64::from(search.seed), index as u64);
        if index == 0 { variables.start() } else { variables.scattered(&mut state) }
    });
    fitted_from(
        &starts.collect::<Vec<_>>(),
        Together::new(recordings, tested, variables),
        Depth::ToTheEnd,
        watch,
    )
}

/// Recordings explained by another model of the valve, from the end of this fit or from an initial
/// estimate, whichever leads further; with the effort that is needed to compare the two.
pub(super) fn with_another_model<'a>(
    first: &Fit<'a>,
    tested: TestedValve,
    watch: Watch<'_>,
) -> Result<Fit<'a>, IdentifyError> {
    let together = Together::new(first.together.recordings, tested, &first.together.variables);
    let mut starts = together.variables.starts();
    starts.insert(0, together.variables.of(&first.coefficients()));
    fitted_from(&starts, together, Depth::ToCompare, watch)
}

/// Recordings explained by one model from near the end of another fit.
pub(super) fn from_near<'a>(
    recordings: &'a [Recording],
    like: &Fit<'_>,
    start: &[f64],
    depth: Depth,
    watch: Watch<'_>,
) -> Result<Fit<'a>, IdentifyError> {
    let together = Together::new(recordings, like.together.tested, &like.together.variables);
    fitted_from(&[start.to_vec()], together, depth, watch)
}

/// A few steps towards the minimum, near this one, of a model of the valve with another term, with
/// these scales: enough to judge whether the term is worth a fit.
pub(super) fn a_few_steps_with<'a>(
    first: &Fit<'a>,
    tested: TestedValve,
    watch: Watch<'_>,
) -> Result<Fit<'a>, IdentifyError> {
    let variables = first.together.variables.with_terms(tested.terms);
    let together = Together { tested, variables, ..first.together.clone() };
    let start = together.variables.of(&first.coefficients());
    let minimum = together.searched_briefly(&start, watch)?;
    Ok(Fit { together, minimum, starts: [1, 1] })
}

fn fitted_from<'a>(
    starts: &[Vec<f64>],
    mut together: Together<'a>,
    depth: Depth,
    watch: Watch<'_>,
) -> Result<Fit<'a>, IdentifyError> {
    if together.channels.is_empty() {
        return Err(ValveFitError::NothingChanges.into());
    }
    let (start, agreeing) = best_start(starts, &together, watch)?;
    let minimum = if has_many_rows(together.recordings) {
        let fewer: Vec<Recording> = together.recordings.iter().map(averaged).collect();
        let mut few = Together::new(&fewer, together.tested, &together.variables);
        let near = settled(&mut few, &start, depth, watch)?.variables;
        together.rescale(&near, &together.residuals(&near));
        let most = match depth {
            Depth::ToCompare => ROUGH_EVALUATIONS,
            Depth::ToTheEnd => EVALUATIONS,
        };
        near_minimum(&together, &near, most, watch)?
    } else {
        settled(&mut together, &start, depth, watch)?
    };
    if minimum.ending == Ending::NoStart || minimum.linearised.residuals.len() <= together.variables.count() {
        return Err(ValveFitError::TooFewRows.into());
    }
    Ok(Fit { together, minimum, starts: [starts.len(), agreeing] })
}

/// True if the minimum is first found over averages.
fn has_many_rows(recordings: &[Recording]) -> bool {
    recordings.iter().map(|one| one.inputs.len()).sum::<usize>() > MANY_ROWS
}

impl Fit<'_> {
    /// Fit at its minimum, with the scale of each signal from its residuals there: a search with
    /// few evaluations has those of another model.
    pub(super) fn searched_to_the_end(mut self, watch: Watch<'_>) -> Result<Self, IdentifyError> {
        let near = self.minimum.variables.clone();
        self.minimum = if has_many_rows(self.together.recordings) {
            self.together.rescale(&near, &self.minimum.linearised.residuals);
            near_minimum(&self.together, &near, EVALUATIONS, watch)?
        } else {
            settled(&mut self.together, &near, Depth::ToTheEnd, watch)?
        };
        Ok(self)
    }
}

/// Minimum over all rows near a start, searched with the flow coefficients as in series.
fn near_minimum(
    together: &Together<'_>,
    near: &[f64],
    most: usize,
    watch: Watch<'_>,
) -> Result<Minimum, Stopped> {
    let usual = &together.variables;
    let begun = usual.coefficients(near);
    let variables = usual.in_series(&begun);
    let start = variables.of(&begun);
    let in_series =
        Together { variables: variables.clone(), channels: together.channels.clone(), ..*together };
    let mut minimum = in_series.searched_from_near(&start, most, watch)?;
    let coefficients = variables.coefficients(&minimum.variables);
    let mut factors = usual.slopes(&coefficients);
    for (factor, slope) in factors.iter_mut().zip(variables.slopes(&coefficients)) {
        *factor = over(*factor, slope);
    }
    for row in minimum.linearised.jacobian.chunks_exact_mut(COUNT) {
        row.iter_mut().zip(factors).for_each(|(slope, factor)| *slope *= factor);
    }
    Ok(Minimum { variables: usual.of(&coefficients), ..minimum })
}

/// Minimum to which a start leads, with the scale of each signal from its residuals there.
fn settled(
    together: &mut Together<'_>,
    start: &[f64],
    depth: Depth,
    watch: Watch<'_>,
) -> Result<Minimum, Stopped> {
    let mut minimum = together.searched(start, ROUGH, watch)?;
    for _ in 0..ROUNDS {
        let change = together.rescale(&minimum.variables, &minimum.linearised.residuals);
        minimum = together.searched(&minimum.variables, ROUGH, watch)?;
        if change < SAME_SCALE {
            break;
        }
    }
    match depth {
        Depth::ToCompare => Ok(minimum),
        Depth::ToTheEnd => together.searched_to_the_end(&minimum.variables, watch),
    }
}

/// Best end of several starts, over fewer rows, and number of those that lead there.
fn best_start(
    starts: &[Vec<f64>],
    together: &Together<'_>,
    watch: Watch<'_>,
) -> Result<(Vec<f64>, usize), Stopped> {
    let fewer: Vec<Recording> = together.recordings.iter().map(|one| thinned(one, OTHERS, NEAR)).collect();
    let together = Together::new(&fewer, together.tested, &together.variables);
    let mut found: Vec<Minimum> = Vec::with_capacity(starts.len());
    for start in starts {
        found.push(together.searched(start, ROUGH, watch)?);
    }
    let lowest = found.iter().map(|minimum| minimum.cost).fold(f64::INFINITY, f64::min);
    let agreeing = found.iter().filter(|minimum| minimum.cost <= 1.01 * lowest + 1e-9).count();
    let best = found.into_iter().find(|minimum| minimum.cost <= lowest);
    Ok((best.map_or(together.variables.start(), |minimum| minimum.variables), agreeing))
}

/// Rows for a first search: those near null, every second one or about `most_near` of them, and
/// about `others` from all.
fn thinned(recording: &Recording, others: usize, most_near: usize) -> Recording {
    let largest = recording.inputs.iter().map(|input| input.command.abs()).fold(0.0, f64::max);
    let near =
        |row: &usize| recording.inputs.get(*row).is_some_and(|input| input.command.abs() < 0.1 * largest);
    let stride = (recording.inputs.len() / others).max(1);
    let near_stride = ((0..recording.inputs.len()).filter(near).count() / most_near).max(2);
    let rows: Vec<usize> = (0..recording.inputs.len())
        .filter(|row| row % stride == 0 || (near(row) && row % near_stride == 0))
        .collect();
    recording.only(&rows)
}
