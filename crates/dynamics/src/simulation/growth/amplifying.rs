//! Growth of an error along a run.

use crate::simulation::{Amplification, GrowthCause};

/// Present growth, and the largest so far.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::simulation) struct Amplifying {
    /// Time and growth rate of the last recorded step.
    before: Option<(f64, f64)>,
    from_s: f64,
    logarithm: f64,
    largest: Option<Amplification>,
    cause: GrowthCause,
}

impl Amplifying {
    /// Growth of the closed loop.
    pub(in crate::simulation) fn of_loop() -> Amplifying {
        Amplifying { cause: GrowthCause::Loop, ..Amplifying::default() }
    }

    /// Integrates the growth rate by the trapezoidal rule.
    pub(super) fn advance(&mut self, time_s: f64, growth_per_s: f64, frequency_rad_per_s: f64) {
        let (before_s, before) = self.before.replace((time_s, growth_per_s)).unwrap_or((time_s, 0.0));
        self.add(time_s, 0.5 * (before + growth_per_s) * (time_s - before_s), frequency_rad_per_s);
    }

    /// Adds growth until a time, as a logarithm; decay below the initial amplitude is forgotten.
    pub(in crate::simulation) fn add(&mut self, time_s: f64, grown: f64, frequency_rad_per_s: f64) {
        let logarithm = self.logarithm + grown;
        if logarithm > 0.0 {
            self.logarithm = logarithm;
        } else {
            (self.logarithm, self.from_s) = (0.0, time_s);
        }
        if self.logarithm > self.largest.map_or(0.0, |largest| largest.logarithm) {
            let Amplifying { logarithm, from_s, cause, .. } = *self;
            let until_s = time_s;
            self.largest = Some(Amplification { logarithm, from_s, until_s, frequency_rad_per_s, cause });
        }
    }

    /// Largest amplification.
    pub(in crate::simulation) fn largest(&self) -> Option<Amplification> {
        self.largest
    }
}
