//! The stiffness of a hose by other means for programs.

use super::super::{OtherMeans, OtherMeansError, SizedGas, SizedPipe, SizedSpring, SizedValve};
use crate::answer::Answer;

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
    pipe: SizedPipeAnswer,
    /// Equal accumulators at both chambers.
    gas: SizedGasAnswer,
    /// Spring between force sensor and load.
    spring: SizedSpringAnswer,
    #[answer(flatten)]
    valves: SizedValvesAnswer,
}

/// Pipe to each chamber, or the reason why there is none.
#[derive(Answer)]
enum SizedPipeAnswer {
    Sized {
        /// Bore of the pipe, that of the hose.
        bore_m: f64,
        /// Length of each pipe.
        length_m: f64,
        /// Volume of the oil in both pipes.
        oil_m3: f64,
    },
    Absent {
        /// Reason for which there is none.
        reason: String,
    },
}

/// Equal accumulators at both chambers, or the reason why there are none.
#[derive(Answer)]
enum SizedGasAnswer {
    Sized {
        /// Gas volume of each accumulator at its precharge.
        gas_volume_m3: f64,
        /// Gauge pressure of the precharge.
        precharge_pressure_pa: f64,
        /// Ratio of the supply pressure to the precharge, both absolute.
        pressure_ratio: f64,
        /// Softest and stiffest of the least hydraulic stiffnesses over the stroke, within the
        /// range of forces.
        stiffness_n_per_m: [f64; 2],
    },
    Absent {
        /// Reason for which there are none.
        reason: String,
    },
}

/// Spring between force sensor and load, or the reason why there is none.
#[derive(Answer)]
enum SizedSpringAnswer {
    Sized {
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
    },
    Absent {
        /// Reason for which there is none.
        reason: String,
    },
}

/// Laminar valve between the chambers, or the reason why there is none.
#[derive(Answer)]
enum SizedValvesAnswer {
    Sized {
        /// Laminar valve between the chambers: of the rig as declared, and of its chambers without
        /// lines.
        valves: [SizedValveAnswer; 2],
    },
    Absent {
        /// Reason for which there is no valve.
        valves_reason: String,
    },
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
        pipe: pipe(&found.pipe),
        gas: gas(&found.gas),
        spring: spring(&found.spring),
        valves: match &found.valves {
            Ok(valves) => SizedValvesAnswer::Sized { valves: valves.map(valve) },
            Err(reason) => SizedValvesAnswer::Absent { valves_reason: reason.to_string() },
        },
    }
}

fn pipe(found: &Result<SizedPipe, OtherMeansError>) -> SizedPipeAnswer {
    match found {
        Ok(pipe) => SizedPipeAnswer::Sized { bore_m: pipe.bore, length_m: pipe.length, oil_m3: pipe.oil },
        Err(reason) => SizedPipeAnswer::Absent { reason: reason.to_string() },
    }
}

fn gas(found: &Result<SizedGas, OtherMeansError>) -> SizedGasAnswer {
    match found {
        Ok(gas) => SizedGasAnswer::Sized {
            gas_volume_m3: gas.volume,
            precharge_pressure_pa: gas.precharge,
            pressure_ratio: gas.pressure_ratio,
            stiffness_n_per_m: gas.stiffness,
        },
        Err(reason) => SizedGasAnswer::Absent { reason: reason.to_string() },
    }
}

fn spring(found: &Result<SizedSpring, OtherMeansError>) -> SizedSpringAnswer {
    match found {
        Ok(spring) => {
            let coil = spring.coil.as_ref().ok();
            SizedSpringAnswer::Sized {
                stiffness_n_per_m: spring.stiffness,
                travel_m: spring.travel,
                installed_length_m: coil.map(|coil| coil.installed_length),
                mass_kg: coil.map(|coil| coil.mass),
                actuator_length_m: spring.actuator_length,
            }
        }
        Err(reason) => SizedSpringAnswer::Absent { reason: reason.to_string() },
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
