//! The table of metrics: what is computed of each event of a run.

use std::ops::{Index, IndexMut};

use phea_quantity::{Dimension, FORCE, MotionKind, PERCENT, TIME, VOLTAGE};

/// A number that is computed of each event of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Excess of the force over the new reference.
    Overshoot,
    /// From 10 % to 90 % of the step.
    RiseTime,
    /// Until the force stays within the band around the reference.
    SettlingTime,
    /// Largest difference of force and reference while the load moves, and afterwards.
    DisturbancePeak,
    /// Largest difference of force and reference while the reference moves.
    TrackingErrorPeak,
    /// Largest magnitude of the force where there is no reference.
    ForcePeak,
    /// Reference less force at the end of the event.
    SteadyStateError,
    /// Largest magnitude of the command.
    ControlPeak,
    /// Root mean square of the command.
    ControlRms,
}

struct MetricRow {
    name: &'static str,
    label: &'static str,
    dimension: &'static Dimension,
    digits: usize,
}

impl Metric {
    /// All metrics in the order in which they are printed.
    pub const ALL: [Metric; 9] = [
        Metric::Overshoot,
        Metric::RiseTime,
        Metric::SettlingTime,
        Metric::DisturbancePeak,
        Metric::TrackingErrorPeak,
        Metric::ForcePeak,
        Metric::SteadyStateError,
        Metric::ControlPeak,
        Metric::ControlRms,
    ];

    fn row(self) -> MetricRow {
        let row = |name, label, dimension, digits| MetricRow { name, label, dimension, digits };
        match self {
            Metric::Overshoot => row("overshoot_percent", "overshoot", &PERCENT, 3),
            Metric::RiseTime => row("rise_time_s", "rise", &TIME, 3),
            Metric::SettlingTime => row("settling_time_s", "settling", &TIME, 3),
            Metric::DisturbancePeak => row("disturbance_peak_n", "disturbance peak", &FORCE, 4),
            Metric::TrackingErrorPeak => row("tracking_error_peak_n", "tracking error peak", &FORCE, 4),
            Metric::ForcePeak => row("force_peak_n", "force peak", &FORCE, 4),
            Metric::SteadyStateError => row("steady_state_error_n", "steady-state error", &FORCE, 2),
            Metric::ControlPeak => row("control_peak_v", "control peak", &VOLTAGE, 3),
            Metric::ControlRms => row("control_rms_v", "control rms", &VOLTAGE, 3),
        }
    }

    /// Its name for programs.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::simulate::Metric;
    /// assert_eq!(Metric::RiseTime.name(), "rise_time_s");
    /// assert_eq!(Metric::RiseTime.dimension().si, "s");
    /// ```
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Its heading, of a rig that moves so.
    pub fn label(self, motion: MotionKind) -> &'static str {
        match self {
            Metric::ForcePeak => motion.either("force peak", "torque peak"),
            _ => self.row().label,
        }
    }

    /// Its dimension.
    pub fn dimension(self) -> &'static Dimension {
        self.row().dimension
    }

    /// Significant digits that are printed.
    pub fn digits(self) -> usize {
        self.row().digits
    }
}

/// A value for each metric.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerMetric<T>([T; Metric::ALL.len()]);

impl<T> PerMetric<T> {
    /// The value of each metric by a function.
    pub fn of(value: impl FnMut(Metric) -> T) -> PerMetric<T> {
        PerMetric(Metric::ALL.map(value))
    }
}

impl<T> Index<Metric> for PerMetric<T> {
    type Output = T;

    fn index(&self, metric: Metric) -> &T {
        &self.0[metric as usize]
    }
}

impl<T> IndexMut<Metric> for PerMetric<T> {
    fn index_mut(&mut self, metric: Metric) -> &mut T {
        &mut self.0[metric as usize]
    }
}
