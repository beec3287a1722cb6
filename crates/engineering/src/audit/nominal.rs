//! Margins of the nominal loop.

use phea_dynamics::frequency::decibels;

use super::margins::{margins_of, nominal_point};
use crate::quantity::significant;
use crate::robust::RobustProblem;

/// Margins of the nominal loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NominalMargins {
    /// The factor by which the gain may grow, dB.
    pub gain_margin_db: f64,
    /// The factor to which it may fall, dB; minus infinity where it may vanish.
    pub gain_reduction_db: f64,
    /// Degrees.
    pub phase_margin_deg: f64,
    /// The highest frequency at which |L| = 1, rad/s; zero if |L| never is 1.
    pub crossover_rad_per_s: f64,
    /// The least delay that makes it unstable, s.
    pub delay_margin_s: f64,
}

impl NominalMargins {
    /// How far the gain may fall, in a sentence: a loop around an unstable plant needs it; `None`
    /// where it may vanish.
    pub fn reduction_sentence(&self) -> Option<String> {
        let db = self.gain_reduction_db;
        db.is_finite().then(|| {
            format!(
                "the nominal loop needs its gain: it becomes unstable where that falls by {} dB",
                significant(-db, 3)
            )
        })
    }
}

/// Margins of the loop of the nominal plant, which must be stable, by its polynomials or else its
/// response; `None` where its response is not known.
pub(crate) fn nominal_margins(problem: &RobustProblem) -> Option<NominalMargins> {
    let found = margins_of(problem, &nominal_point(problem))?;
    let crossover = found.phase_margins.iter().map(|margin| margin.frequency_rad_per_s).fold(0.0, f64::max);
    Some(NominalMargins {
        gain_margin_db: decibels(found.gain_increase_factor()),
        gain_reduction_db: decibels(found.gain_decrease_factor()),
        phase_margin_deg: found.phase_margin_deg(),
        crossover_rad_per_s: crossover,
        delay_margin_s: found.delay_margin_s(),
    })
}
