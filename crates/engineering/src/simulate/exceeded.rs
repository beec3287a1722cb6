//! Limits of the rig that a run exceeds. They clamp nothing: the real rig has these limits, the
//! simulated machine does not.

use phea_dynamics::simulation::Quartic;
use phea_hydraulics::machine::MachineSignals;
use phea_hydraulics::series::ForceFrom;

use super::ControlledMachine;

/// A limit of the rig, and the extent to which a run exceeds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// Kind of the limit.
    pub limit: RigLimit,
    /// Value of the limit: force, N, voltage, V, gauge pressure, Pa, or a Reynolds number; the one
    /// that was exceeded first if there are two.
    pub limit_value: f64,
    /// Value farthest beyond the limit, in the unit of the limit.
    pub peak: f64,
    /// Time of the peak, s.
    pub peak_time_s: f64,
    /// Time at which the limit was first exceeded, s.
    pub first_time_s: f64,
    /// Place of the peak.
    pub place: LimitPlace,
}

/// Place of a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitPlace {
    /// The rig as a whole.
    Rig,
    /// Chamber `a` or `b`, at the end of its line.
    Chamber(char),
    /// A line.
    Line {
        /// Side, `a` or `b`.
        side: char,
        /// Distance from the valve, m.
        distance_m: f64,
    },
    /// Neck of the accumulator at chamber `a` or `b`.
    Neck(char),
    /// Line of a transmission.
    Transmission {
        /// Distance from the rod's piston, m.
        distance_m: f64,
    },
}

impl LimitPlace {
    /// m from the valve in a line, from the rod's piston in that of a transmission.
    pub fn distance_m(self) -> Option<f64> {
        match self {
            LimitPlace::Line { distance_m, .. } | LimitPlace::Transmission { distance_m } => Some(distance_m),
            LimitPlace::Rig | LimitPlace::Chamber(_) | LimitPlace::Neck(_) => None,
        }
    }
}

/// Limits of a rig: values that it cannot reach, or that damage it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigLimit {
    /// `force_sensor.capacity`, in both directions.
    SensorCapacity,
    /// Stall force of the piston, A_A p_S - A_B p_T in one direction and A_B p_S - A_A p_T in the
    /// other: a reference beyond it is not reached.
    StallForce,
    /// Voltage of full opening, unless `saturation` limits the command to it.
    NominalVoltage,
    /// `fluid.vapour_pressure`: below it the oil cavitates.
    VapourPressure,
    /// `working_pressure` of a hose or pipe.
    WorkingPressure,
    /// `burst_pressure` of a hose or pipe.
    BurstPressure,
    /// Transition Reynolds number of a line with laminar friction.
    LaminarFlow,
    /// Pressure at which the relief valve of a limited pump is shut: below it the rig takes more
    /// than the pump delivers.
    PumpFlow,
}

/// Names of the occurrences of lines: for each limit that of line A, then that of line B; then
/// those of necks and of a transmission.
pub const LINE_OCCURRENCES: [&str; 11] = [
    "cavitation_line_a",
    "cavitation_line_b",
    "working_pressure_a",
    "working_pressure_b",
    "burst_pressure_a",
    "burst_pressure_b",
    "turbulent_line_a",
    "turbulent_line_b",
    "turbulent_neck_a",
    "turbulent_neck_b",
    TURBULENT_TRANSMISSION,
];

const TURBULENT_TRANSMISSION: &str = "turbulent_transmission";

impl Exceeded {
    /// Name of the occurrence; `None` for limits that have none, and for vapour pressure in a
    /// chamber, for which the machine has an indicator.
    pub fn occurrence(&self) -> Option<&'static str> {
        let first = match (self.limit, self.place) {
            (RigLimit::VapourPressure, LimitPlace::Line { .. }) => 0,
            (RigLimit::WorkingPressure, _) => 2,
            (RigLimit::BurstPressure, _) => 4,
            (RigLimit::LaminarFlow, LimitPlace::Transmission { .. }) => return Some(TURBULENT_TRANSMISSION),
            (RigLimit::LaminarFlow, LimitPlace::Neck(_)) => 8,
            (RigLimit::LaminarFlow, _) => 6,
            _ => return None,
        };
        let is_b = matches!(
            self.place,
            LimitPlace::Chamber('b') | LimitPlace::Line { side: 'b', .. } | LimitPlace::Neck('b')
        );
        LINE_OCCURRENCES.get(first + usize::from(is_b)).copied()
    }
}

/// Fraction of a limit by which exceeding it counts as rounding.
const ROUNDING: f64 = 1e-6;

/// Monitor of the limits that a run exceeds, sample by sample.
pub(super) struct LimitWatch {
    /// Limit of the force sensor, and the force through it from the signals of the machine.
    sensor: Option<(WatchedLimit, SensedForce)>,
    stall: WatchedLimit,
    command: WatchedLimit,
    /// Limit of a limited pump.
    pump: Option<WatchedLimit>,
}

/// Force through the sensor, whatever the source of the measured force.
#[derive(Clone, Copy)]
enum SensedForce {
    /// The measured force.
    Measured,
    /// Force from the deflection of the sensor, with its stiffness, N/m.
    Deflection(f64),
}

/// A limit in both directions, either of which may be infinite.
pub(super) struct WatchedLimit {
    limit: RigLimit,
    low: f64,
    high: f64,
    found: Option<Exceeded>,
}

impl LimitWatch {
    pub(super) fn of(bench: &ControlledMachine) -> LimitWatch {
        let components = bench.rig.actuator.components();
        let (cylinder, supply) = (&components.cylinder, &components.supply);
        let voltage = components.valve.nominal_voltage;
        let sensed = match components.series.map(|series| series.force_from()) {
            Some(ForceFrom::Deflection) => SensedForce::Deflection(components.force_sensor.stiffness),
            Some(ForceFrom::Sensor) | None => SensedForce::Measured,
        };
        let of_sensor = |capacity: f64| WatchedLimit::new(RigLimit::SensorCapacity, [-capacity, capacity]);
        LimitWatch {
            sensor: bench.force_capacity_n.map(|capacity| (of_sensor(capacity), sensed)),
            stall: WatchedLimit::new(RigLimit::StallForce, cylinder.stall_forces(supply)),
            command: WatchedLimit::new(RigLimit::NominalVoltage, [-voltage, voltage]),
            pump: bench
                .relief_shut_pa
                .map(|shut| WatchedLimit::new(RigLimit::PumpFlow, [shut, f64::INFINITY])),
        }
    }

    /// True if the monitor needs the signals of the machine.
    pub(super) fn wants_signals(&self) -> bool {
        self.sensor.is_some() || self.pump.is_some()
    }

    /// Takes the signals of the loop at a time: reference, N, if there is one, and command, V.
    pub(super) fn take_loop(&mut self, time_s: f64, reference_n: Option<f64>, control_v: f64) {
        if let Some(reference_n) = reference_n {
            self.stall.take(time_s, reference_n);
        }
        self.command.take(time_s, control_v);
    }

    /// Takes the signals of the machine at a time.
    pub(super) fn take_signals(&mut self, time_s: f64, signals: &MachineSignals) {
        if let Some((limit, sensed)) = &mut self.sensor {
            let through = match sensed {
                SensedForce::Measured => signals.force,
                SensedForce::Deflection(stiffness) => *stiffness * signals.deflection,
            };
            limit.take(time_s, through);
        }
        if let Some(limit) = &mut self.pump {
            limit.take(time_s, signals.supply_pressure);
        }
    }

    /// Limits that were exceeded.
    pub(super) fn finish(self) -> Vec<Exceeded> {
        let sensor = self.sensor.and_then(|(limit, _)| limit.found);
        let pump = self.pump.and_then(|limit| limit.found);
        [sensor, self.stall.found, self.command.found, pump].into_iter().flatten().collect()
    }
}

impl WatchedLimit {
    pub(super) fn new(limit: RigLimit, [low, high]: [f64; 2]) -> WatchedLimit {
        WatchedLimit { limit, low, high, found: None }
    }

    /// Limit with its peak, if it was exceeded.
    pub(super) fn found(&self) -> Option<Exceeded> {
        self.found
    }

    /// Margin within which a value beyond a limit counts as rounding.
    fn rounding(&self) -> f64 {
        let largest = [self.low, self.high].into_iter().filter(|limit| limit.is_finite());
        ROUNDING * largest.fold(0.0, |largest, limit| limit.abs().max(largest))
    }

    fn excess(&self, value: f64) -> f64 {
        (value - self.high).max(self.low - value)
    }

    fn take(&mut self, time_s: f64, value: f64) {
        if self.excess(value) > self.rounding() {
            self.note([time_s; 2], value, LimitPlace::Rig);
        }
    }

    /// Takes a value over a step, at a place.
    pub(super) fn follow(&mut self, [start_s, end_s]: [f64; 2], value: &Quartic, place: LimitPlace) {
        let time_s = |part: f64| start_s + part * (end_s - start_s);
        for (sign, limit) in [(1.0, self.high), (-1.0, self.low)] {
            let [edge, worst] = self.edges(sign, limit);
            let beyond = Quartic::constant(0.0).plus(sign, value);
            if !limit.is_finite() || beyond.bounds()[1] <= worst {
                continue;
            }
            let [_, peak] = beyond.extremes([0.0, 1.0]);
            let first = beyond.first_above(edge, [0.0, 1.0]);
            let at = beyond.first_above(peak - ROUNDING * ROUNDING * peak.abs(), [0.0, 1.0]);
            if let (true, Some(first), Some(at)) = (peak > worst, first, at) {
                self.note([time_s(first), time_s(at)], sign * peak, place);
            }
        }
    }

    /// True if a value between these may be farther beyond the limit than those that were taken.
    pub(super) fn may_exceed(&self, [least, most]: [f64; 2]) -> bool {
        let ways = [(1.0, self.high, most), (-1.0, self.low, least)];
        ways.into_iter()
            .any(|(sign, limit, value)| limit.is_finite() && sign * value > self.edges(sign, limit)[1])
    }

    /// Values from which a value counts as beyond the limit of a sign, and as farther beyond it
    /// than any before; both multiplied by the sign.
    fn edges(&self, sign: f64, limit: f64) -> [f64; 2] {
        let edge = sign * limit + self.rounding();
        [edge, self.found.map_or(edge, |found| edge.max(sign * limit + self.excess(found.peak)))]
    }

    /// Records a value beyond the limit, with the times of crossing the limit and of the value.
    fn note(&mut self, [first_time_s, peak_time_s]: [f64; 2], peak: f64, place: LimitPlace) {
        let limit_value = if peak > self.high { self.high } else { self.low };
        let new = Exceeded { limit: self.limit, limit_value, peak, peak_time_s, first_time_s, place };
        let beyond = self.found.is_none_or(|found| self.excess(peak) > self.excess(found.peak));
        let found = self.found.get_or_insert(new);
        found.first_time_s = found.first_time_s.min(first_time_s);
        if beyond {
            (found.peak, found.peak_time_s, found.place) = (peak, peak_time_s, place);
        }
    }
}
