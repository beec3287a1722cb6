//! Limits of the rig that a run exceeds. Nothing is clamped by them: the real rig has these limits,
//! the simulated machine does not.

use phea_hydraulics::machine::SIGNALS;
use phea_hydraulics::series::ForceFrom;

use super::ControlledMachine;
use crate::quantity::{DisplayUnit, FORCE, VOLTAGE, display};

/// A limit of the rig, and how far a run exceeds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// Which.
    pub limit: RigLimit,
    /// N or V; the one that was exceeded first if there are two.
    pub limit_value: f64,
    /// The value farthest beyond it, N or V, and its time, s.
    pub peak: f64,
    /// s.
    pub peak_time_s: f64,
    /// When it was first exceeded, s.
    pub first_time_s: f64,
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
}

impl RigLimit {
    /// As an answer names it.
    pub fn word(self) -> &'static str {
        match self {
            RigLimit::SensorCapacity => "force_sensor_capacity",
            RigLimit::StallForce => "stall_force",
            RigLimit::NominalVoltage => "nominal_voltage",
        }
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
}

/// The force through the sensor, wherever the measured one is taken from.
#[derive(Clone, Copy)]
enum SensedForce {
    /// The measured force.
    Measured,
    /// From the deflection of the sensor, whose stiffness in N/m this is.
    Deflection(f64),
}

/// A limit in both directions.
struct WatchedLimit {
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
        }
    }

    /// Whether it needs the signals of the machine.
    pub(super) fn wants_signals(&self) -> bool {
        self.sensor.is_some()
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
    pub(super) fn take_signals(&mut self, time_s: f64, signals: &[f64; SIGNALS.len()]) {
        if let Some((limit, sensed)) = &mut self.sensor {
            let through = match sensed {
                SensedForce::Measured => signals[FORCE_PLACE],
                SensedForce::Deflection(stiffness) => *stiffness * signals[DEFLECTION_PLACE],
            };
            limit.take(time_s, through);
        }
    }

    /// The limits that were exceeded.
    pub(super) fn finish(self) -> Vec<Exceeded> {
        let sensor = self.sensor.and_then(|(limit, _)| limit.found);
        [sensor, self.stall.found, self.command.found].into_iter().flatten().collect()
    }
}

/// Places of the measured force and of the sensor's deflection in [`SIGNALS`].
const FORCE_PLACE: usize = 0;
const DEFLECTION_PLACE: usize = 7;
const _: () = assert!(matches!(SIGNALS[FORCE_PLACE].as_bytes(), b"force_n"));
const _: () = assert!(matches!(SIGNALS[DEFLECTION_PLACE].as_bytes(), b"deflection_m"));

impl WatchedLimit {
    fn new(limit: RigLimit, [low, high]: [f64; 2]) -> WatchedLimit {
        WatchedLimit { limit, low, high, found: None }
    }

    fn take(&mut self, time_s: f64, value: f64) {
        let WatchedLimit { limit, low, high, ref mut found } = *self;
        let excess = |value: f64| (value - high).max(low - value);
        if excess(value) <= ROUNDING * (high - low) {
            return;
        }
        let limit_value = if value > high { high } else { low };
        let first = Exceeded { limit, limit_value, peak: value, peak_time_s: time_s, first_time_s: time_s };
        let found = found.get_or_insert(first);
        if excess(value) > excess(found.peak) {
            (found.peak, found.peak_time_s) = (value, time_s);
        }
    }
}

/// In a sentence.
pub fn words(exceeded: &Exceeded) -> String {
    let unit = if exceeded.limit == RigLimit::NominalVoltage { &VOLTAGE } else { &FORCE };
    let [peak, limit] = [exceeded.peak, exceeded.limit_value].map(|value| display(value, unit, 4));
    let [at, first] =
        [exceeded.peak_time_s, exceeded.first_time_s].map(|time| DisplayUnit::SECOND.number(time, 4));
    match exceeded.limit {
        RigLimit::SensorCapacity => format!(
            "from {first} s on the force sensor is overloaded: its capacity is {limit}, the force comes to {peak} at {at} s"
        ),
        RigLimit::StallForce => format!(
            "from {first} s on the reference exceeds the force that the supply can produce: the piston stalls at {limit}, and {peak} is asked for at {at} s"
        ),
        RigLimit::NominalVoltage => format!(
            "from {first} s on the command is beyond the valve's {limit}, and comes to {peak} at {at} s: the rig clips it, so state \
             controller.saturation"
        ),
    }
}
