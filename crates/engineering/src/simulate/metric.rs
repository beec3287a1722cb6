//! Table of metrics, which are computed for each event of a run.

use std::ops::{Index, IndexMut};

use phea_quantity::{Dimension, FORCE, MotionKind, PERCENT, QuantityName, TIME, VOLTAGE};

/// A number that is computed for each event of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Excess of the force over the new reference.
    Overshoot,
    /// Time from 10 % to 90 % of the step.
    RiseTime,
    /// Time until the force stays within the band around the reference.
    SettlingTime,
    /// Largest difference of force and reference while the load moves, and afterwards.
    DisturbancePeak,
    /// Largest difference of force and reference while the reference moves.
    TrackingErrorPeak,
    /// Largest magnitude of the force in the absence of a reference.
    ForcePeak,
    /// Reference minus force at the end of the event.
    SteadyStateError,
    /// Largest magnitude of the command.
    ControlPeak,
    /// Root mean square of the command.
    ControlRms,
}

struct MetricRow {
    quantity: QuantityName,
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
        let row = |quantity, label, dimension, digits| MetricRow { quantity, label, dimension, digits };
        let fixed = QuantityName::Fixed;
        let force = |names| QuantityName::OfMotion(names, &FORCE);
        match self {
            Metric::Overshoot => row(fixed("overshoot_percent"), "overshoot", &PERCENT, 3),
            Metric::RiseTime => row(fixed("rise_time_s"), "rise", &TIME, 3),
            Metric::SettlingTime => row(fixed("settling_time_s"), "settling", &TIME, 3),
            Metric::DisturbancePeak => row(force(["disturbance_peak"; 2]), "disturbance peak", &FORCE, 4),
            Metric::TrackingErrorPeak => {
                row(force(["tracking_error_peak"; 2]), "tracking error peak", &FORCE, 4)
            }
            Metric::ForcePeak => row(force(["force_peak", "torque_peak"]), "force peak", &FORCE, 4),
            Metric::SteadyStateError => {
                row(force(["steady_state_error"; 2]), "steady-state error", &FORCE, 2)
            }
            Metric::ControlPeak => row(fixed("control_peak_v"), "control peak", &VOLTAGE, 3),
            Metric::ControlRms => row(fixed("control_rms_v"), "control rms", &VOLTAGE, 3),
        }
    }

    /// Name of the metric in output for programs.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::simulate::Metric;
    /// use phea_quantity::MotionKind;
    /// assert_eq!(Metric::RiseTime.quantity().text(MotionKind::Linear), "rise_time_s");
    /// assert_eq!(Metric::ForcePeak.quantity().text(MotionKind::Rotary), "torque_peak_n_m");
    /// assert_eq!(Metric::RiseTime.dimension().si, "s");
    /// ```
    pub fn quantity(self) -> QuantityName {
        self.row().quantity
    }

    /// Heading of the metric, for a rig with this motion.
    pub fn label(self, motion: MotionKind) -> &'static str {
        match self {
            Metric::ForcePeak => motion.either("force peak", "torque peak"),
            _ => self.row().label,
        }
    }

    /// Dimension of the metric.
    pub fn dimension(self) -> &'static Dimension {
        self.row().dimension
    }

    /// Significant digits that are printed.
    pub fn digits(self) -> usize {
        self.row().digits
    }
}

// `PerMetric` holds the value of a metric at the place of its variant
const _: () = {
    let mut place = 0;
    while place < Metric::ALL.len() {
        assert!(Metric::ALL[place] as usize == place);
        place += 1;
    }
};

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

#[cfg(test)]
mod tests {
    use super::Metric;
    use phea_quantity::MotionKind;

    #[test]
    fn a_name_ends_in_the_unit() {
        for motion in [MotionKind::Linear, MotionKind::Rotary] {
            for metric in Metric::ALL {
                let name = metric.quantity().text(motion);
                let unit = motion.dimension(metric.dimension()).suffix();
                assert!(name.ends_with(&format!("_{unit}")), "{name}");
            }
        }
    }
}
