//! Limits of the rig that a run exceeds. Nothing is clamped by them: the real rig has these limits,
//! the simulated machine does not.

use phea_dynamics::simulation::Quartic;
use phea_hydraulics::machine::MachineSignals;
use phea_hydraulics::series::ForceFrom;

use super::ControlledMachine;

/// A limit of the rig, and how far a run exceeds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// Which.
    pub limit: RigLimit,
    /// N, V, Pa gauge or a Reynolds number; the one that was exceeded first if there are two.
    pub limit_value: f64,
    /// The value farthest beyond it, in the same unit, and its time, s.
    pub peak: f64,
    /// s.
    pub peak_time_s: f64,
    /// When it was first exceeded, s.
    pub first_time_s: f64,
    /// The place of the peak.
    pub place: LimitPlace,
}

/// Where a limit holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitPlace {
    /// At the rig as a whole.
    Rig,
    /// In chamber `a` or `b`, at the end of its line.
    Chamber(char),
    /// In a line.
    Line {
        /// `a` or `b`.
        side: char,
        /// m from the valve.
        distance_m: f64,
    },
    /// In the neck of the accumulator at chamber `a` or `b`.
    Neck(char),
    /// In the line of a transmission.
    Transmission {
        /// m from the rod's piston.
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
    /// The force at which the piston stalls, A_A p_S - A_B p_T one way and A_B p_S - A_A p_T the
    /// other: a reference beyond it is not reached.
    StallForce,
    /// The voltage of full opening, unless `saturation` keeps the command within it.
    NominalVoltage,
    /// `fluid.vapour_pressure`: below it the oil cavitates.
    VapourPressure,
    /// `working_pressure` of a hose or pipe.
    WorkingPressure,
    /// `burst_pressure` of a hose or pipe.
    BurstPressure,
    /// The Reynolds number of a line whose friction is that of laminar flow.
    LaminarFlow,
    /// The pressure at which the relief valve of a limited pump is shut: below it the rig takes
    /// more than the pump delivers.
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
    /// The name of its occurrence; `None` for limits that have none, and in a chamber for vapour
    /// pressure, of which the machine has an indicator.
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

/// Exceeding a limit by less than this share of it counts as rounding.
const ROUNDING: f64 = 1e-6;

/// Watches for the limits that a run exceeds, sample by sample.
pub(super) struct LimitWatch {
    /// Of the force sensor, and the force through it from the signals of the machine.
    sensor: Option<(WatchedLimit, SensedForce)>,
    stall: WatchedLimit,
    command: WatchedLimit,
    /// Of a limited pump.
    pump: Option<WatchedLimit>,
}

/// The force through the sensor, wherever the measured one is taken from.
#[derive(Clone, Copy)]
enum SensedForce {
    /// The measured force.
    Measured,
    /// From the deflection of the sensor, whose stiffness in N/m this is.
    Deflection(f64),
}

/// A limit in both directions, of which either may be infinite.
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

    /// Whether it needs the signals of the machine.
    pub(super) fn wants_signals(&self) -> bool {
        self.sensor.is_some() || self.pump.is_some()
    }

    /// Takes what the loop asks for and gives out at a time: reference in N, if there is one, and
    /// command in V.
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

    /// The limits that were exceeded.
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

    /// How far it was exceeded.
    pub(super) fn found(&self) -> Option<Exceeded> {
        self.found
    }

    /// The margin within which a value beyond a limit counts as rounding.
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

    /// Whether a value between these may be farther beyond it than those that were taken.
    pub(super) fn may_exceed(&self, [least, most]: [f64; 2]) -> bool {
        let ways = [(1.0, self.high, most), (-1.0, self.low, least)];
        ways.into_iter()
            .any(|(sign, limit, value)| limit.is_finite() && sign * value > self.edges(sign, limit)[1])
    }

    /// From where on a value counts as beyond this limit of a sign, and from where on as farther
    /// beyond it than any before; both times the sign.
    fn edges(&self, sign: f64, limit: f64) -> [f64; 2] {
        let edge = sign * limit + self.rounding();
        [edge, self.found.map_or(edge, |found| edge.max(sign * limit + self.excess(found.peak)))]
    }

    /// Notes a value beyond the limit, with the times of crossing it and of the value.
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
