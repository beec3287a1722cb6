//! Record of a sampled controller during a run.

use phea_dynamics::simulation::Amplification;

/// Record of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerSample {
    /// Time, s.
    pub time_s: f64,
    /// Reference after the prefilter, N.
    pub filtered_reference_n: f64,
    /// Output of the computer, V.
    pub command_v: f64,
    /// Command before limit and rounding, V.
    pub unlimited_v: f64,
    /// Part of the command held by the integral part of G, V.
    pub integral_v: f64,
    /// Measurement read by the computer, N.
    pub measurement_n: f64,
    /// True if the limit acted on the command.
    pub limited: bool,
}

/// Record of a sampled controller during a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControllerSamples {
    /// Last sample.
    pub last: Option<ControllerSample>,
    /// Times at which the command reached its limit (`true`) or left it, s.
    pub limits: Vec<(f64, bool)>,
    /// Largest amplification from sample to sample.
    pub amplification: Option<Amplification>,
}

impl ControllerSamples {
    pub(crate) fn take(&mut self, sample: ControllerSample) {
        let before = self.last.is_some_and(|last| last.limited);
        if before != sample.limited {
            self.limits.push((sample.time_s, sample.limited));
        }
        self.last = Some(sample);
    }
}
