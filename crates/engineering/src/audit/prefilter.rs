//! Detection of a prefilter that amplifies: the reference then compensates in advance for a deficit
//! of the loop.

use phea_dynamics::frequency::{decibels, logarithmic_grid};
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_qft::closed_loop::Compensation;

/// Gain of a prefilter F.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrefilterGain {
    /// Gain |F(0)|.
    pub at_zero: f64,
    /// Largest |F|.
    pub largest: f64,
    /// Frequency of the largest |F|, rad/s.
    pub frequency_rad_per_s: f64,
}

/// Ratio of the largest gain to that at zero frequency, and to 1, from which a prefilter amplifies,
/// dB.
const AMPLIFIES_DB: f64 = 1.0;
const AMPLIFIES_AT_ZERO_DB: f64 = 6.0;
/// Number of points of the grid in addition to the magnitudes of the roots, and its range beyond
/// these.
const POINTS: usize = 200;
const BEYOND: f64 = 100.0;

impl PrefilterGain {
    /// Gain of the prefilter of a loop; `None` if it does not amplify.
    pub fn amplifying(compensation: &Compensation) -> Option<PrefilterGain> {
        let gain = PrefilterGain::of_loop(compensation);
        let above = |one: f64, other: f64, most_db: f64| decibels(one / other) > most_db;
        let amplifies =
            above(gain.largest, gain.at_zero, AMPLIFIES_DB) || above(gain.at_zero, 1.0, AMPLIFIES_AT_ZERO_DB);
        amplifies.then_some(gain)
    }

    /// The gain of the prefilter of a loop.
    pub fn of_loop(compensation: &Compensation) -> PrefilterGain {
        PrefilterGain::of(compensation.prefilter(), compensation.highest_frequency_rad_per_s())
    }

    fn of(prefilter: &TransferFunction, highest: f64) -> PrefilterGain {
        let at_zero = prefilter.dc_gain().abs();
        let mut gain = PrefilterGain { at_zero, largest: at_zero, frequency_rad_per_s: 0.0 };
        for frequency in frequencies(prefilter, highest) {
            let magnitude = portable::magnitude(prefilter.at_frequency(frequency));
            if magnitude > gain.largest {
                gain = PrefilterGain { largest: magnitude, frequency_rad_per_s: frequency, ..gain };
            }
        }
        gain
    }

    /// Ratio of the largest gain to that at zero frequency, dB.
    pub fn rise_db(&self) -> f64 {
        decibels(self.largest / self.at_zero)
    }
}

/// Frequencies of a grid around the roots, and magnitudes of the roots.
fn frequencies(prefilter: &TransferFunction, highest: f64) -> Vec<f64> {
    let sample_time_s = match prefilter.domain() {
        TimeDomain::Continuous => None,
        TimeDomain::Discrete { sample_time_s } => Some(sample_time_s),
    };
    let size = |root: &num_complex::Complex64| match sample_time_s {
        None => portable::magnitude(*root),
        // s = ln(z)/T
        Some(sample_time_s) => {
            let [real, imaginary] =
                [portable::ln(portable::magnitude(*root).max(1e-9)), portable::argument(*root)];
            portable::magnitude(num_complex::Complex64::new(real, imaginary)) / sample_time_s
        }
    };
    let roots: Vec<f64> = prefilter.zeros().iter().chain(prefilter.poles()).map(size).collect();
    let within = |frequency: &f64| *frequency > 0.0 && frequency.is_finite() && *frequency <= highest;
    let known: Vec<f64> = roots.into_iter().filter(within).collect();
    let low = known.iter().copied().fold(f64::INFINITY, f64::min) / BEYOND;
    let high = (known.iter().copied().fold(0.0, f64::max) * BEYOND).min(highest);
    let grid = logarithmic_grid(low, high, POINTS).unwrap_or_default();
    sorted_distinct(grid.into_iter().chain(known).filter(within).collect())
}
