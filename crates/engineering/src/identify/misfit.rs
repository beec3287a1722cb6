//! Residuals of the recordings under the model of the valve that are not noise.
//!
//! ```text
//! residual = misfit + noise,       misfit correlated in neighbouring rows, noise not
//! misfit^2 = r rms^2               rms of the residuals, r the correlation of neighbours
//! ```

use phea_dynamics::order::ends;

use super::recording::{SignalKind, TestBranch};
use super::{Identification, SignalFit};

/// Correlation of neighbouring residuals up to which they count as noise: those of recordings that
/// the model explains reach 0.23.
const OF_NOISE: f64 = 0.4;
/// Number of standard deviations of the correlation of independent residuals, 1/sqrt(rows), up to
/// which it is chance.
const CHANCE: f64 = 5.0;
/// Fraction of the range below which misfits are not reported.
const SMALLEST_FRACTION: f64 = 1e-3;
/// Number of ranges of the command in which a misfit is evaluated, for either direction.
const RANGES: usize = 10;

/// A signal that the model does not explain.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Index of the recording.
    pub recording: usize,
    /// Kind of the signal.
    pub kind: SignalKind,
    /// Correlation of neighbouring residuals.
    pub correlation: f64,
    /// Root mean square of the misfit divided by the range of the signal.
    pub fraction: f64,
    /// Place of the greatest misfit; `None` if no row shows it.
    pub place: Option<MisfitPlace>,
}

/// Place at which a misfit is greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MisfitPlace {
    /// True if the command rises.
    pub is_rising: bool,
    /// Range of the command, V.
    pub command: [f64; 2],
    /// Mean of the model's output minus the recorded signal in this range, divided by the range of
    /// the signal.
    pub fraction: f64,
}

impl SignalFit {
    /// Root mean square of the unexplained part, divided by the range of the signal; `None` if that
    /// is noise.
    pub(super) fn misfit(&self) -> Option<f64> {
        let fraction = self.rms * self.correlation.max(0.0).sqrt() / self.range;
        let is_chance = self.correlation * (self.rows as f64).sqrt() <= CHANCE;
        (self.correlation > OF_NOISE && !is_chance && fraction >= SMALLEST_FRACTION).then_some(fraction)
    }
}

impl Identification {
    /// Signals that the model does not explain, the greatest misfit first.
    pub fn misfits(&self) -> Vec<Misfit> {
        let of = |signal: &SignalFit| {
            let fraction = signal.misfit()?;
            Some(Misfit {
                recording: signal.recording,
                kind: signal.kind,
                correlation: signal.correlation,
                fraction,
                place: self.place(signal),
            })
        };
        let mut found: Vec<Misfit> = self.signals.iter().filter_map(of).collect();
        found.sort_by(|one, other| other.fraction.total_cmp(&one.fraction));
        found
    }

    /// Part of the branches in which the residuals of a signal have the greatest mean.
    fn place(&self, signal: &SignalFit) -> Option<MisfitPlace> {
        let recording = self.recordings.get(signal.recording)?;
        let inputs = &recording.inputs;
        let [least, greatest] = ends(inputs.iter().map(|input| input.command));
        let width = (greatest - least) / RANGES as f64;
        let mut sums = [[(0.0, 0_usize); RANGES]; 2];
        let residuals = self.residuals(signal, &self.coefficients);
        for TestBranch { rises, rows } in recording.branches() {
            let own = inputs.iter().zip(&residuals).skip(rows.start).take(rows.len());
            for (input, residual) in own {
                let range = (((input.command - least) / width) as usize).min(RANGES - 1);
                let sum = sums.get_mut(usize::from(rises)).and_then(|branch| branch.get_mut(range));
                if let (Some((sum, rows)), Some(residual)) = (sum, residual) {
                    *sum += residual;
                    *rows += 1;
                }
            }
        }
        let all = [false, true].into_iter().zip(sums).flat_map(|(is_rising, branch)| {
            branch.into_iter().enumerate().map(move |(range, found)| (is_rising, range, found))
        });
        let places = all.filter(|(.., (_, rows))| *rows > 0).map(|(is_rising, range, (sum, rows))| {
            // the end at null is exactly null, not the rounding of a sum
            let end = |steps: usize| ((least + steps as f64 * width) / width * 1e6).round() * 1e-6 * width;
            MisfitPlace {
                is_rising,
                command: [end(range), end(range + 1)],
                fraction: sum / rows as f64 / signal.range,
            }
        });
        places.max_by(|one, other| one.fraction.abs().total_cmp(&other.fraction.abs()))
    }
}
