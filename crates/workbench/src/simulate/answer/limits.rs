//! The limits of the rig that a run exceeds.

use phea_engineering::simulate::{Exceeded, LimitPlace, RigLimit};

use crate::answer::{Answer, Reasoned, words};

/// Limit of the rig that a run exceeds, with values in the SI unit of the limit.
#[derive(Answer)]
pub(super) struct ExceededRigLimitAnswer {
    /// Kind of the limit.
    what: RigLimit,
    /// Value of the limit, a gauge pressure if it is a pressure; the one that is exceeded first if
    /// there are two.
    limit: f64,
    /// Value farthest beyond the limit.
    peak: f64,
    /// Time of that value.
    peak_time_s: f64,
    /// Time at which the limit is first exceeded.
    first_time_s: f64,
    /// Part of the rig with the peak.
    place: Reasoned<LimitedPart>,
    /// Distance of the peak from the valve in a line, from the piston of the rod in a transmission.
    distance_m: Reasoned<f64>,
}

words! {
    /// Kind of a limit of the rig: the capacity of the force sensor, the force at which the piston
    /// stalls, the voltage of full opening, the vapour pressure, the working and the burst pressure
    /// of a line, the Reynolds number of laminar flow, or the pressure at which the relief valve of
    /// a limited pump is shut.
    RigLimit {
        SensorCapacity => "force_sensor_capacity",
        StallForce => "stall_force",
        NominalVoltage => "nominal_voltage",
        VapourPressure => "vapour_pressure",
        WorkingPressure => "working_pressure",
        BurstPressure => "burst_pressure",
        LaminarFlow => "laminar_flow",
        PumpFlow => "pump_flow",
    }
}

/// Part of the rig in which a limit is exceeded.
enum LimitedPart {
    ChamberA,
    ChamberB,
    LineA,
    LineB,
    NeckA,
    NeckB,
    Transmission,
}

words! {
    /// Part of the rig in which a limit is exceeded; a neck is that of the accumulator at a
    /// chamber.
    LimitedPart {
        ChamberA => "chamber_a",
        ChamberB => "chamber_b",
        LineA => "line_a",
        LineB => "line_b",
        NeckA => "neck_a",
        NeckB => "neck_b",
        Transmission => "transmission",
    }
}

impl LimitedPart {
    /// The part; `None` for the rig as a whole.
    fn of(place: LimitPlace) -> Option<LimitedPart> {
        match place {
            LimitPlace::Rig => None,
            LimitPlace::Chamber('a') => Some(LimitedPart::ChamberA),
            LimitPlace::Chamber(_) => Some(LimitedPart::ChamberB),
            LimitPlace::Line { side: 'a', .. } => Some(LimitedPart::LineA),
            LimitPlace::Line { .. } => Some(LimitedPart::LineB),
            LimitPlace::Neck('a') => Some(LimitedPart::NeckA),
            LimitPlace::Neck(_) => Some(LimitedPart::NeckB),
            LimitPlace::Transmission { .. } => Some(LimitedPart::Transmission),
        }
    }
}

/// A limit of the rig that a run exceeds.
pub(super) fn exceeded(exceeded: &Exceeded) -> ExceededRigLimitAnswer {
    let place = LimitedPart::of(exceeded.place);
    ExceededRigLimitAnswer {
        what: exceeded.limit,
        limit: exceeded.limit_value,
        peak: exceeded.peak,
        peak_time_s: exceeded.peak_time_s,
        first_time_s: exceeded.first_time_s,
        place: Reasoned::new(place, "it is a limit of the rig as a whole"),
        distance_m: Reasoned::new(exceeded.place.distance_m(), "it is not within a line"),
    }
}
