//! Margins of the nominal loop.

use phea_dynamics::frequency::decibels;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;

use super::margins::{margins_of, nominal_point};
use crate::robust::RobustProblem;

/// Margins of the nominal loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NominalMargins {
    /// Factor by which the gain may grow, dB.
    pub gain_margin_db: f64,
    /// Factor to which the gain may fall, dB; minus infinity if it may vanish.
    pub gain_reduction_db: f64,
    /// Phase margin, degrees.
    pub phase_margin_deg: f64,
    /// Highest frequency at which |L| = 1, rad/s; zero if |L| never is 1.
    pub crossover_rad_per_s: f64,
    /// Frequencies at which |L| falls below 1, and between which it is above 1 again.
    pub crossovers: Crossovers,
    /// Least delay that makes the loop unstable, s.
    pub delay_margin_s: f64,
}

/// The crossover of a loop, and a resonance beyond it that reaches |L| = 1 again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crossovers {
    /// First frequency at which |L| falls through 1, rad/s; `None` if it does not.
    pub first_rad_per_s: Option<f64>,
    /// Lowest and highest frequency beyond it at which |L| = 1, rad/s, the highest infinite if |L|
    /// remains above 1; `None` if |L| remains below 1.
    pub again_rad_per_s: Option<[f64; 2]>,
}

impl Crossovers {
    /// Crossovers from the frequencies at which |L| = 1, rad/s, and from |L| between them.
    ///
    /// ```text
    /// |L| > 1 below w_1, |L| < 1 above       w_1 is the crossover
    /// |L| > 1 within (w_2, w_3), ...         from w_2 to the last of them |L| reaches 1 again
    /// ```
    pub fn of(crossings_rad_per_s: Vec<f64>, magnitude: impl Fn(f64) -> Option<f64>) -> Crossovers {
        let crossings = sorted_distinct(crossings_rad_per_s);
        let next = |index: usize| crossings.get(index).copied();
        // above[k] is between crossing k - 1 and crossing k
        let is_above = |index: usize| {
            let inside = match (index.checked_sub(1).and_then(next), next(index)) {
                (None, Some(first)) => 0.5 * first,
                (Some(low), Some(high)) => (low * high).sqrt(),
                (Some(last), None) => BEYOND_LAST * last,
                (None, None) => return None,
            };
            magnitude(inside).map(|size| size > 1.0)
        };
        let above: Vec<Option<bool>> = (0..=crossings.len()).map(is_above).collect();
        let falls = above.windows(2).position(|pair| pair == [Some(true), Some(false)]);
        let Some(first) = falls else { return Crossovers::default() };
        let beyond = above.iter().enumerate().skip(first + 1).filter(|(_, above)| **above == Some(true));
        let beyond: Vec<usize> = beyond.map(|(index, _)| index).collect();
        let again = beyond
            .first()
            .zip(beyond.last())
            .and_then(|(low, high)| Some([next(low.checked_sub(1)?)?, next(*high).unwrap_or(f64::INFINITY)]));
        Crossovers { first_rad_per_s: next(first), again_rad_per_s: again }
    }
}

/// Factor by which a frequency beyond the last crossing of |L| = 1 exceeds it.
const BEYOND_LAST: f64 = 1.001;

/// Margins of the loop of the nominal plant, which must be stable, by its polynomials or else by
/// its response; `None` if its response is not known.
pub(crate) fn nominal_margins(problem: &RobustProblem) -> Option<NominalMargins> {
    let found = margins_of(problem, &nominal_point(problem))?;
    let crossings: Vec<f64> = found.phase_margins.iter().map(|margin| margin.frequency_rad_per_s).collect();
    let member = problem.member(&nominal_point(problem))?;
    let magnitude = |frequency: f64| {
        let response = problem.response(&member, frequency)?;
        Some(portable::magnitude(response.plant * response.sensor * response.controller))
    };
    Some(NominalMargins {
        gain_margin_db: decibels(found.gain_increase_factor()),
        gain_reduction_db: decibels(found.gain_decrease_factor()),
        phase_margin_deg: found.phase_margin_deg(),
        crossover_rad_per_s: crossings.iter().copied().fold(0.0, f64::max),
        crossovers: Crossovers::of(crossings, magnitude),
        delay_margin_s: found.delay_margin_s(),
    })
}
