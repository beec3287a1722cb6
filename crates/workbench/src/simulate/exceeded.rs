//! Limits of the rig that a run exceeds, in sentences.

use super::{Exceeded, LimitPlace, RigLimit};
use crate::answer::Word;
use crate::quantity::{DisplayUnit, LENGTH, MotionWords, Units, VOLTAGE, display, significant};

/// A limit of the rig that a run exceeds.
pub(crate) fn exceeded_words(exceeded: &Exceeded, units: Units) -> String {
    let in_unit = |value: f64| match exceeded.limit {
        RigLimit::SensorCapacity | RigLimit::StallForce => units.force.short(value, 4),
        RigLimit::NominalVoltage => display(value, &VOLTAGE, 4),
        RigLimit::VapourPressure
        | RigLimit::WorkingPressure
        | RigLimit::BurstPressure
        | RigLimit::PumpFlow => units.pressure.short(value, 4),
        RigLimit::LaminarFlow => significant(value.abs(), 4),
    };
    let [peak, limit] = [exceeded.peak, exceeded.limit_value].map(in_unit);
    let [at, first] =
        [exceeded.peak_time_s, exceeded.first_time_s].map(|time| DisplayUnit::SECOND.number(time, 4));
    let place = match exceeded.place {
        LimitPlace::Rig => String::new(),
        LimitPlace::Neck(side) => {
            format!("in the neck of the accumulator at chamber {}", side.to_ascii_uppercase())
        }
        LimitPlace::Transmission { distance_m } => {
            format!("in the transmission, {} from the rod's piston,", display(distance_m, &LENGTH, 3))
        }
        LimitPlace::Chamber(side) => format!("in chamber {}", side.to_ascii_uppercase()),
        LimitPlace::Line { side, distance_m } => {
            format!(
                "in line {}, {} from the valve,",
                side.to_ascii_uppercase(),
                display(distance_m, &LENGTH, 3)
            )
        }
    };
    let MotionWords { force, force_sensor, piston, .. } = units.motion.words();
    match exceeded.limit {
        RigLimit::SensorCapacity => format!(
            "from {first} s on the {force_sensor} is overloaded: its capacity is {limit}, the {force} comes to {peak} at {at} s"
        ),
        RigLimit::StallForce => format!(
            "from {first} s on the reference exceeds the {force} that the supply can produce: the {piston} stalls at {limit}, and {peak} is required at {at} s"
        ),
        RigLimit::NominalVoltage => format!(
            "from {first} s on the command is beyond the valve's {limit}, and comes to {peak} at {at} s: the rig clips it, so state \
             controller.saturation"
        ),
        RigLimit::VapourPressure => format!(
            "from {first} s on the pressure is below the vapour pressure of {limit}: {place} it falls to {peak} at {at} s, where real oil cavitates"
        ),
        RigLimit::WorkingPressure | RigLimit::BurstPressure => format!(
            "from {first} s on the pressure is above the {} of {limit}: {place} it comes to {peak} at {at} s",
            exceeded.limit.word().replace('_', " ")
        ),
        RigLimit::PumpFlow => format!(
            "from {first} s on the pump delivers less than the rig takes: its relief valve is shut below {limit}, and the supply falls to {peak} at {at} s"
        ),
        RigLimit::LaminarFlow => format!(
            "from {first} s on the flow is turbulent where laminar friction is computed: {place} the Reynolds number comes to {peak} at \
             {at} s, and above {limit} more pressure is lost"
        ),
    }
}
