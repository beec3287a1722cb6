//! The work of accumulators that are adjusted in a run.

use phea_hydraulics::machine::SIGNALS;

/// What the adjustment of accumulators does over a run, in J.
///
/// ```text
/// work: integral of the power of the adjustment, of what the oil can get back from the gas: 1/2 dK/dt x^2 of a spring
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdjustmentWork {
    /// While its power is positive.
    pub brought_j: f64,
    /// While it is negative.
    pub taken_j: f64,
}

/// Sums the power over the samples, by the trapezoidal rule.
#[derive(Debug, Default)]
pub(super) struct AdjustmentWatch {
    last: Option<[f64; 2]>,
    work: AdjustmentWork,
}

/// Place of the power in [`SIGNALS`], the last.
const POWER_PLACE: usize = SIGNALS.len() - 1;
const _: () = assert!(matches!(SIGNALS[POWER_PLACE].as_bytes(), b"adjustment_power_w"));

impl AdjustmentWatch {
    /// Takes the signals of the machine at a time.
    pub(super) fn take(&mut self, time_s: f64, signals: &[f64; SIGNALS.len()]) {
        let power_w = signals[POWER_PLACE];
        if let Some([before_s, before_w]) = self.last {
            let half_s = 0.5 * (time_s - before_s);
            for power_w in [before_w, power_w] {
                self.work.brought_j += half_s * power_w.max(0.0);
                self.work.taken_j -= half_s * power_w.min(0.0);
            }
        }
        self.last = Some([time_s, power_w]);
    }

    pub(super) fn finish(self) -> AdjustmentWork {
        self.work
    }
}
