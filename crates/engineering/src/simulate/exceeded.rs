//! Limits of the rig that a run exceeds. Nothing is clamped by them: the real rig has these limits,
//! the simulated machine does not.

use phea_hydraulics::series::ForceFrom;

use super::{ControlledMachine, Record};
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

/// The limits that a run exceeds, by its samples.
pub(super) fn exceeded(bench: &ControlledMachine, record: &Record) -> Vec<Exceeded> {
    let components = bench.rig.actuator.components();
    let (cylinder, supply) = (&components.cylinder, &components.supply);
    let stalls_at = |pushed: f64, pulled: f64| pushed * supply.pressure - pulled * supply.tank_pressure;
    let extending = stalls_at(cylinder.area_a, cylinder.area_b);
    let retracting = -stalls_at(cylinder.area_b, cylinder.area_a);
    let voltage = components.valve.nominal_voltage;
    // the force through the sensor, wherever the measured one is taken from
    let deflections = record.signal("deflection_m");
    let forces: Vec<f64> = match components.series.map(|series| series.force_from) {
        Some(ForceFrom::Deflection) => {
            deflections.into_iter().map(|deflection| components.force_sensor.stiffness * deflection).collect()
        }
        Some(ForceFrom::Sensor) | None => record.signal("force_n"),
    };
    let sensor = bench.force_capacity_n.and_then(|capacity| {
        beyond(RigLimit::SensorCapacity, [-capacity, capacity], &record.times_s, &forces)
    });
    let stall = beyond(RigLimit::StallForce, [retracting, extending], &record.times_s, &record.reference_n);
    let command = beyond(RigLimit::NominalVoltage, [-voltage, voltage], &record.times_s, &record.control_v);
    [sensor, stall, command].into_iter().flatten().collect()
}

fn beyond(limit: RigLimit, [low, high]: [f64; 2], times_s: &[f64], values: &[f64]) -> Option<Exceeded> {
    let excess = |value: f64| (value - high).max(low - value);
    let mut found: Option<Exceeded> = None;
    for (&time_s, &value) in times_s.iter().zip(values) {
        if excess(value) <= ROUNDING * (high - low) {
            continue;
        }
        let limit_value = if value > high { high } else { low };
        let first = Exceeded { limit, limit_value, peak: value, peak_time_s: time_s, first_time_s: time_s };
        let found = found.get_or_insert(first);
        if excess(value) > excess(found.peak) {
            (found.peak, found.peak_time_s) = (value, time_s);
        }
    }
    found
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
            "from {first} s on the reference exceeds what the supply can push: the piston stalls at {limit}, asked for are {peak} at {at} s"
        ),
        RigLimit::NominalVoltage => format!(
            "from {first} s on the command is beyond the valve's {limit}, and comes to {peak} at {at} s: the rig clips it, so state \
             controller.saturation"
        ),
    }
}
