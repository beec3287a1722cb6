//! The stiffness of a hose by other means for programs.

use phea_engineering::sizing::{OtherMeans, OtherMeansError, SizedGas, SizedPipe, SizedSpring, SizedValve};

use crate::answer::{Answer, OrReason};

/// Other means with the stiffness of a hose.
#[derive(Answer)]
pub(super) struct OtherMeansAnswer {
    /// Hydraulic stiffness that is required of them.
    stiffness_n_per_m: f64,
    /// Least hydraulic stiffness over the stroke of the chambers without lines.
    chambers_n_per_m: f64,
    /// Retracted length of the actuator from mount to mount, without the spring; null if
    /// `cylinder.dead_length` is not stated.
    actuator_length_m: Option<f64>,
    /// Pipe to each chamber.
    pipe: OrReason<SizedPipeAnswer>,
    /// Equal accumulators at both chambers.
    gas: OrReason<SizedGasAnswer>,
    /// Spring between force sensor and load.
    spring: OrReason<SizedSpringAnswer>,
    /// Laminar valve between the chambers: of the rig as declared, and of its chambers without
    /// lines.
    valves: OrReason<[SizedValveAnswer; 2]>,
}

/// Pipe to each chamber.
#[derive(Answer)]
struct SizedPipeAnswer {
    /// Bore of the pipe, that of the hose.
    bore_m: f64,
    /// Length of each pipe.
    length_m: f64,
    /// Volume of the oil in both pipes.
    oil_m3: f64,
}

/// Equal accumulators at both chambers.
#[derive(Answer)]
struct SizedGasAnswer {
    /// Gas volume of each accumulator at its precharge.
    gas_volume_m3: f64,
    /// Gauge pressure of the precharge.
    precharge_pressure_pa: f64,
    /// Ratio of the supply pressure to the precharge, both absolute.
    pressure_ratio: f64,
    /// Softest and stiffest of the least hydraulic stiffnesses over the stroke, within the
    /// range of forces.
    #[answer(interval)]
    stiffness_n_per_m: [f64; 2],
}

/// Spring between force sensor and load.
#[derive(Answer)]
struct SizedSpringAnswer {
    /// Stiffness of the spring.
    stiffness_n_per_m: f64,
    /// Travel to either side under the stall force.
    travel_m: f64,
    /// Length of both coil springs in their housing, at rest; null if the coils are not known.
    installed_length_m: Option<f64>,
    /// Mass of both coil springs; null if the coils are not known.
    mass_kg: Option<f64>,
    /// Retracted length of the actuator with the spring, from mount to mount; null if it is not
    /// known.
    actuator_length_m: Option<f64>,
}

/// Laminar valve between the chambers, which damps the mode of the load cell.
#[derive(Answer)]
struct SizedValveAnswer {
    /// Hydraulic stiffness of the rig that it damps.
    stiffness_n_per_m: f64,
    /// Damping ratio without the valve.
    damping_ratio_without_valve: f64,
    /// Conductance with the required damping ratio; null if none has it.
    conductance_m3_per_s_pa: Option<f64>,
    /// Greatest damping ratio of all conductances.
    damping_ratio_at_most: f64,
    /// Conductance with the greatest damping ratio.
    at_conductance_m3_per_s_pa: f64,
    /// Loss of the valve at the greatest force of the range; null if no range is stated.
    loss_w: Option<f64>,
}

pub(super) fn other_means(found: &OtherMeans) -> OtherMeansAnswer {
    OtherMeansAnswer {
        stiffness_n_per_m: found.stiffness,
        chambers_n_per_m: found.chambers,
        actuator_length_m: found.actuator_length,
        pipe: or_reason(&found.pipe, pipe),
        gas: or_reason(&found.gas, gas),
        spring: or_reason(&found.spring, spring),
        valves: or_reason(&found.valves, |valves| valves.map(valve)),
    }
}

fn or_reason<Found, Of>(
    found: &Result<Found, OtherMeansError>,
    answer: impl FnOnce(&Found) -> Of,
) -> OrReason<Of> {
    OrReason(found.as_ref().map(answer).map_err(OtherMeansError::to_string))
}

fn pipe(pipe: &SizedPipe) -> SizedPipeAnswer {
    SizedPipeAnswer { bore_m: pipe.bore, length_m: pipe.length, oil_m3: pipe.oil }
}

fn gas(gas: &SizedGas) -> SizedGasAnswer {
    SizedGasAnswer {
        gas_volume_m3: gas.volume,
        precharge_pressure_pa: gas.precharge,
        pressure_ratio: gas.pressure_ratio,
        stiffness_n_per_m: gas.stiffness,
    }
}

fn spring(spring: &SizedSpring) -> SizedSpringAnswer {
    let coil = spring.coil.as_ref().ok();
    SizedSpringAnswer {
        stiffness_n_per_m: spring.stiffness,
        travel_m: spring.travel,
        installed_length_m: coil.map(|coil| coil.installed_length),
        mass_kg: coil.map(|coil| coil.mass),
        actuator_length_m: spring.actuator_length,
    }
}

fn valve(valve: SizedValve) -> SizedValveAnswer {
    SizedValveAnswer {
        stiffness_n_per_m: valve.stiffness,
        damping_ratio_without_valve: valve.damping_ratio_without_valve,
        conductance_m3_per_s_pa: valve.conductance,
        damping_ratio_at_most: valve.most[0],
        at_conductance_m3_per_s_pa: valve.most[1],
        loss_w: valve.loss,
    }
}
