//! Schedule of the evaluations of a linearised loop's modes, and their growth.

use super::FrozenMode;
use crate::simulation::Amplification;
use crate::simulation::growth::Amplifying;

/// Steps between two evaluations while a mode grows.
const GROWING: u64 = 32;
/// Steps between two evaluations without growth: each interval is four times the previous one, from
/// the first up to the last.
const CALM: [u64; 2] = [64, 4096];

/// Growth since the last evaluation, as a logarithm, that requires the next one.
const MOST_GROWN: f64 = 0.5;

/// Growth of the least stable mode along a run.
///
/// ```text
/// between two evaluations the mean of both growths, or zero if one grows and the other decays
/// ```
///
/// A mode that grows only for an instant, as friction causes at one velocity, is not counted.
#[derive(Clone, Debug)]
pub struct FrozenWatch {
    steps: u64,
    due: u64,
    interval: u64,
    before: Option<(f64, f64)>,
    /// Growth and frequency of a mode that grew at the last two evaluations, in 1/s and rad/s.
    grows_on: Option<[f64; 2]>,
    growing: Amplifying,
}

impl Default for FrozenWatch {
    fn default() -> FrozenWatch {
        let growing = Amplifying::of_loop();
        FrozenWatch { steps: 0, due: 0, interval: 0, before: None, grows_on: None, growing }
    }
}

impl FrozenWatch {
    /// Counts steps until a time in s; returns true if the modes are to be evaluated now.
    pub fn passes(&mut self, steps: u64, time_s: f64) -> bool {
        self.steps += steps;
        self.steps > self.due || self.grows_until(time_s) > MOST_GROWN
    }

    /// Counts steps if the modes are also evaluated for another reason, as long as nothing grows.
    pub(in crate::simulation) fn grows(&mut self, steps: u64, time_s: f64) -> bool {
        self.passes(steps, time_s) && self.grows_until(time_s) > 0.0
    }

    /// Growth since the last evaluation, as a logarithm, if its rate has not changed.
    fn grows_until(&self, time_s: f64) -> f64 {
        self.before.map_or(0.0, |(before_s, growth)| growth * (time_s - before_s))
    }

    /// Records the least stable mode at a time in s.
    ///
    /// # Example
    /// A growth of 3 1/s for two seconds; a growth seen only once does not count.
    /// ```
    /// use phea_dynamics::simulation::{FrozenMode, FrozenWatch};
    /// let mode = |growth_per_s| Some(FrozenMode { growth_per_s, frequency_rad_per_s: 40.0 });
    /// let mut watch = FrozenWatch::default();
    /// for (time_s, growth) in [(0.0, -1.0), (1.0, 3.0), (2.0, -1.0), (3.0, 3.0), (5.0, 3.0)] {
    ///     watch.take(time_s, mode(growth));
    /// }
    /// let grown = watch.amplification().unwrap();
    /// assert_eq!((grown.logarithm, grown.from_s, grown.until_s), (6.0, 3.0, 5.0));
    /// ```
    pub fn take(&mut self, time_s: f64, mode: Option<FrozenMode>) {
        let growth = mode.map_or(0.0, |mode| mode.growth_per_s);
        let frequency_rad_per_s = mode.map_or(0.0, |mode| mode.frequency_rad_per_s);
        let (before_s, before) = self.before.replace((time_s, growth)).unwrap_or((time_s, growth));
        let both = if before * growth > 0.0 { 0.5 * (before + growth) } else { 0.0 };
        self.growing.add(time_s, both * (time_s - before_s), frequency_rad_per_s);
        self.grows_on = (before > 0.0 && growth > 0.0).then_some([growth, frequency_rad_per_s]);
        let [least, most] = CALM;
        self.interval = if growth > 0.0 { 0 } else { (4 * self.interval).clamp(least, most) };
        self.due = self.steps + self.interval.max(GROWING);
    }

    /// Largest amplification by the end of a run, in s: a mode that grew at the last two
    /// evaluations is continued to the end.
    pub(in crate::simulation) fn amplification_at_end(&self, end_s: f64) -> Option<Amplification> {
        let mut growing = self.growing;
        if let (Some([growth, frequency_rad_per_s]), Some((before_s, _))) = (self.grows_on, self.before) {
            growing.add(end_s, growth * (end_s - before_s), frequency_rad_per_s);
        }
        growing.largest()
    }

    /// Largest amplification.
    pub fn amplification(&self) -> Option<Amplification> {
        self.growing.largest()
    }
}
