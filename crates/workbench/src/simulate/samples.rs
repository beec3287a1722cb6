//! What is kept of a sampled controller on the way.

/// What happened at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) time_s: f64,
    /// Behind the prefilter, N.
    pub(crate) filtered_reference_n: f64,
    /// What the computer gives out, V.
    pub(crate) command_v: f64,
    /// The same before its limit and its rounding, V.
    pub(crate) unlimited_v: f64,
    /// Part of the command that the integral part of G holds, V.
    pub(crate) integral_v: f64,
    /// What the computer read, N.
    pub(crate) measurement_n: f64,
    pub(crate) limited: bool,
}

/// What is kept of a sampled controller on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Samples {
    /// The last one.
    pub(crate) last: Option<Sample>,
    /// When the command came to its limit (`true`) or left it, s.
    pub(crate) limits: Vec<(f64, bool)>,
}

impl Samples {
    pub(super) fn take(&mut self, sample: Sample) {
        let before = self.last.is_some_and(|last| last.limited);
        if before != sample.limited {
            self.limits.push((sample.time_s, sample.limited));
        }
        self.last = Some(sample);
    }
}
