use super::problem::{SoonerRequirement, TimeConstantOrigin, UnlikeLines};
use super::{Branch, HoseName, SizedLoad};
use crate::rig::LargestFlow;

/// One step of the procedure, with the numbers of its decision; letters as in the flowchart,
/// section 6.3.2.
#[derive(Clone, Debug, PartialEq)]
pub enum SizingStep {
    /// Step a: the data of the system.
    SystemData(SizedSystem),
    /// Step b: the desired time constant.
    TimeConstant {
        /// Time constant tau_d, s.
        time_constant: f64,
        /// Origin of the time constant.
        origin: TimeConstantOrigin,
        /// Requirement in time that needs a shorter time constant.
        sooner: Option<SoonerRequirement>,
    },
    /// Step c.2: the lowest and the highest recommended oil velocity of pressure lines, m/s.
    OilVelocity([f64; 2]),
    /// Step c.2: the lines without pressure.
    LowPressureLines {
        /// Their lowest and highest recommended oil velocity, m/s.
        velocity: [f64; 2],
        /// Flow of the return line, m3/s.
        return_flow: f64,
        /// Least and greatest bore of the return line, m.
        return_bores: [f64; 2],
        /// Least and greatest bore of the suction line, m.
        suction_bores: [f64; 2],
    },
    /// Step c.3: the bores of the pressure lines.
    Bores {
        /// The largest flows.
        flow: LargestFlow,
        /// Least and greatest bore, m.
        range: [f64; 2],
        /// Names of the bores within this range that are on the market.
        feasible: Vec<HoseName>,
    },
    /// Step f: the search over the gain.
    Search {
        /// Initial gain, V/N.
        maximum_gain: f64,
        /// Greatest length of a line, m.
        available_length: f64,
        /// Least gain, V/N.
        minimum_gain: f64,
        /// Gain at the pole of equation 6.16, V/N.
        pole_gain: f64,
    },
    /// Steps g to l: a branch of the flowchart for a hose.
    Branch(HoseName, Branch),
}

/// Data of the system for which a hose is sized, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizedSystem {
    /// Useful area A_u, m2.
    pub useful_area: f64,
    /// Stroke, m.
    pub stroke: f64,
    /// Bulk modulus of the fluid beta_0, Pa.
    pub fluid_modulus: f64,
    /// Stiffness K_S without the load, N/m.
    pub sensor_without_load: f64,
    /// The load in series with it.
    pub load: SizedLoad,
    /// Stiffness K_S with the load in series, N/m.
    pub sensor_stiffness: f64,
    /// Flow gain K_qU, m3/(s V).
    pub flow_gain: f64,
    /// Flow-pressure coefficient K_c at null, with the leakage from chamber to chamber, m3/(s Pa).
    pub flow_pressure_coefficient: f64,
    /// Leakage from chamber to chamber, m3/(s Pa).
    pub internal_leakage: f64,
    /// Difference between the declared lines.
    pub unlike: Option<UnlikeLines>,
}
