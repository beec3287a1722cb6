//! The metrics of a run: one window for each step of the reference and for the motion of the load.

use phea_quantity::MotionKind;

use super::metric::Metric;

/// Part of a run that is evaluated separately.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Event at the beginning of the window.
    pub cause: Cause,
    /// Start, s.
    pub start_s: f64,
    /// End, s: at the beginning of the next window, or at the end of the scenario.
    pub end_s: f64,
}

/// Event that begins a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The reference changes.
    ReferenceStep {
        /// Reference before the step, N.
        from_n: f64,
        /// Reference after the step, N.
        to_n: f64,
    },
    /// A part of the reference begins to move.
    ReferenceMotion {
        /// Kind of part, as written.
        kind: &'static str,
    },
    /// The open-loop command changes.
    CommandStep {
        /// Command before the step, V.
        from_v: f64,
        /// Command after the step, V.
        to_v: f64,
    },
    /// A part of the open-loop command begins to move.
    CommandMotion {
        /// Kind of part, as written.
        kind: &'static str,
    },
    /// The load begins to move.
    LoadMotion,
    /// An external force on the load begins or changes.
    ExternalForce {
        /// True for a torque about the joint of a linkage.
        about_joint: bool,
    },
    /// The setting of accumulators begins to move, or steps.
    SettingChange,
}

impl Cause {
    /// The label of the moment in a figure, of a rig that moves so.
    pub fn label(&self, motion: MotionKind) -> &'static str {
        match self {
            Cause::ReferenceStep { .. } | Cause::CommandStep { .. } => "step",
            Cause::ReferenceMotion { kind } | Cause::CommandMotion { kind } => kind,
            Cause::LoadMotion => "load moves",
            Cause::ExternalForce { about_joint: false } => motion.either("external force", "external torque"),
            Cause::ExternalForce { about_joint: true } => "external torque",
            Cause::SettingChange => "setting",
        }
    }
}

/// A number, or the reason why it is absent.
pub type Measured = Result<f64, Unmeasured>;

/// Reason why a number of a run is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unmeasured {
    /// The run ended earlier.
    AfterEnd,
    /// The reference does not step.
    NoStep,
    /// The load does not begin to move.
    NoMotion,
    /// The force does not reach 90 % of the step.
    NotReached,
    /// The force is already beyond 10 % of the step when it begins.
    BegunBeyond,
    /// The force is outside the band in the last tenth of the window.
    NotSettled,
    /// The reference moves.
    ReferenceMoves,
    /// The loop is open and has no reference.
    OpenLoop,
    /// The reference states the force.
    ReferenceGiven,
    /// The reference does not move.
    ReferenceConstant,
    /// The reference is zero, so that a band around it has no width.
    ZeroReference,
    /// One of two compared runs has no such number.
    OneRunHasNone,
    /// No row of the file is within the simulated time.
    NoRow,
    /// The scenario has no such signal.
    NoSignal,
    /// The measured values do not change, so that there is no range as divisor.
    NoRange,
}

/// Metrics of a window: those of the solution over each step of the integration, independent of the
/// rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// Overshoot of the force over the new reference, percent of the step.
    pub overshoot_percent: Measured,
    /// Rise time from 10 % to 90 % of the step, each at the first crossing by the force, s.
    pub rise_time_s: Measured,
    /// Settling time from the start of the window until the force stays within the band around the
    /// reference, at least for the last tenth of the window, s.
    pub settling_time_s: Measured,
    /// Band of the settling time, percent of the step, or of the reference that a load motion
    /// disturbs.
    pub settling_band_percent: f64,
    /// Largest difference of force and reference while the load moves, or an external force acts,
    /// and afterwards, N.
    pub disturbance_peak_n: Measured,
    /// Largest difference of force and reference while the reference moves, N.
    pub tracking_error_peak_n: Measured,
    /// Largest magnitude of the force in the absence of a reference, N.
    pub force_peak_n: Measured,
    /// Reference minus force, mean over the last tenth of the window, N.
    pub steady_state_error_n: Measured,
    /// Largest magnitude of the command, V.
    pub control_peak_v: Measured,
    /// Root mean square of the command, V.
    pub control_rms_v: Measured,
}

/// Fraction of a window, at its end, in which a force that has settled stays within the band: one
/// that oscillates is within it at the end of some windows too.
const STAYS: f64 = 0.1;

/// True if a force that enters the band at this time stays there for long enough within a window of
/// this length, s.
pub fn stays_settled(settling_time_s: f64, window_s: f64) -> bool {
    settling_time_s < (1.0 - STAYS) * window_s
}

impl Metrics {
    /// The value of a metric.
    pub fn get(&self, metric: Metric) -> Measured {
        match metric {
            Metric::Overshoot => self.overshoot_percent,
            Metric::RiseTime => self.rise_time_s,
            Metric::SettlingTime => self.settling_time_s,
            Metric::DisturbancePeak => self.disturbance_peak_n,
            Metric::TrackingErrorPeak => self.tracking_error_peak_n,
            Metric::ForcePeak => self.force_peak_n,
            Metric::SteadyStateError => self.steady_state_error_n,
            Metric::ControlPeak => self.control_peak_v,
            Metric::ControlRms => self.control_rms_v,
        }
    }

    pub(super) fn none(reason: Unmeasured, settling_band_percent: f64) -> Metrics {
        Metrics {
            overshoot_percent: Err(reason),
            rise_time_s: Err(reason),
            settling_time_s: Err(reason),
            settling_band_percent,
            disturbance_peak_n: Err(reason),
            tracking_error_peak_n: Err(reason),
            force_peak_n: Err(reason),
            steady_state_error_n: Err(reason),
            control_peak_v: Err(reason),
            control_rms_v: Err(reason),
        }
    }
}
