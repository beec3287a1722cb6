//! The record of a sampled controller during a run.

use phea_dynamics::simulation::Amplification;

/// The events of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerSample {
    /// s
    pub time_s: f64,
    /// Behind the prefilter, N.
    pub filtered_reference_n: f64,
    /// The output of the computer, V.
    pub command_v: f64,
    /// The same before limit and rounding, V.
    pub unlimited_v: f64,
    /// Part of the command that the integral part of G holds, V.
    pub integral_v: f64,
    /// The measurement that the computer read, N.
    pub measurement_n: f64,
    /// True if its limit held the command.
    pub limited: bool,
}

/// The record of a sampled controller during a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControllerSamples {
    /// The last one.
    pub last: Option<ControllerSample>,
    /// When the command reached its limit (`true`) or left it, s.
    pub limits: Vec<(f64, bool)>,
    /// What grew most from sample to sample.
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
