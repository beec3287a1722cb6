use super::{LoadModel, PowerUnit};
use crate::line::{DynamicLine, StiffeningMember};
use crate::parameter::{ParameterError, Problems};
use crate::servovalve::SpoolImperfection;

/// Absolute vapour pressure of mineral oil in Pa: a few pascals at working temperatures, negligible
/// against an atmosphere.
pub(crate) const VAPOUR_PRESSURE_ABSOLUTE: f64 = 0.0;

/// The parts of a machine other than its actuator. The default adds nothing: a prescribed load on a
/// constant supply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineOptions {
    /// Null bias, hysteresis, threshold and rate limit of the spool.
    pub spool: SpoolImperfection,
    /// Drop p_S - p_T in Pa at which the valve's tare flow is stated; absent, that of the
    /// actuator's own supply.
    pub tare_reference_drop: Option<f64>,
    /// Velocity in m/s that smooths the jump of a static friction curve; needed for such a curve
    /// alone.
    pub friction_regular_velocity: Option<f64>,
    /// Where the supply pressure comes from.
    pub power_unit: PowerUnit,
    /// What the force sensor pushes on.
    pub load: LoadModel,
    /// Velocity of the load as its sensor shows it, over the true one: 1 + e, e the error of its
    /// gain.
    pub velocity_gain: f64,
    /// phi of the pressure signal p_A - phi p_B that a controller may feed back.
    pub pressure_ratio: f64,
    /// True if a force from outside acts on the load, as an input of the machine; it needs a load
    /// that has a mass.
    pub external_force: bool,
    /// True if the setting of accumulators that are adjusted moves, as an input of the machine: by
    /// how much it has moved from rest, and at which rate. Without it they stand at their setting
    /// at rest.
    pub moving_setting: bool,
    /// Pressure in Pa absolute below which a chamber is reported to cavitate. Fluid with entrained
    /// air expands before it boils and comes to no vacuum: for it, state the pressure at which
    /// dissolved air comes out.
    pub vapour_pressure_absolute: f64,
    /// Which member of the hoses' stiffening interval.
    pub member: StiffeningMember,
    /// Pressures in Pa gauge that the gas of the accumulators at A and B must not exceed: beyond
    /// them a run reports it.
    pub gas_pressure_limits: [Option<f64>; 2],
    /// Lines between valve and chambers with dynamics of their own, A first; absent, one pressure
    /// for a chamber with its line.
    pub lines: Option<[DynamicLine; 2]>,
}

impl Default for MachineOptions {
    fn default() -> MachineOptions {
        MachineOptions {
            spool: SpoolImperfection::default(),
            tare_reference_drop: None,
            friction_regular_velocity: None,
            power_unit: PowerUnit::Constant,
            load: LoadModel::Prescribed,
            velocity_gain: 1.0,
            pressure_ratio: 1.0,
            external_force: false,
            moving_setting: false,
            vapour_pressure_absolute: VAPOUR_PRESSURE_ABSOLUTE,
            member: StiffeningMember::Nominal,
            gas_pressure_limits: [None; 2],
            lines: None,
        }
    }
}

impl MachineOptions {
    /// Impossible ones among these options; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.component("valve", self.spool.problems());
        if let Some(drop) = self.tare_reference_drop {
            problems.positive("valve.tare_reference_drop", drop);
        }
        if let Some(velocity) = self.friction_regular_velocity {
            problems.positive("cylinder.friction.regular_velocity", velocity);
        }
        if let PowerUnit::PumpLimited(unit) = self.power_unit {
            problems.component("supply", unit.problems());
        }
        let limits = self.gas_pressure_limits.iter().zip(["line.a", "line.b"]);
        for (limit, line) in limits.filter_map(|(limit, line)| Some(((*limit)?, line))) {
            problems.positive(&format!("{line}.accumulator.maximum_pressure"), limit);
        }
        problems.component("load", self.load.problems());
        problems.positive("velocity_sensor.gain", self.velocity_gain);
        problems.not_negative("controller.pressure_feedback.ratio", self.pressure_ratio);
        problems.not_negative("fluid.vapour_pressure_absolute", self.vapour_pressure_absolute);
        problems.into_vec()
    }
}

/// Why there is no such machine, or no such start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MachineError {
    /// Parameters outside physics.
    #[error("{}", problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Impossible {
        /// All of them.
        problems: Vec<ParameterError>,
    },
    /// A static friction curve has a jump, which no integrator can hold; it needs a velocity that
    /// smooths it, or bristles.
    #[error("static Stribeck friction jumps at standstill: state a regular velocity, or use LuGre friction")]
    StaticFriction,
    /// A force from outside on a load whose motion is prescribed: it would move nothing.
    #[error("an external force moves no load whose motion is prescribed: it needs one with a mass")]
    UnyieldingLoad,
    /// Pressed into its end stop by the whole supply pressure, the piston would leave no fluid in
    /// the chamber.
    #[error(
        "pressed {penetration} (m, or rad of a motor) into its end stop, the piston leaves no fluid ({compliance} m3/Pa)"
    )]
    ChamberVanishes {
        /// How far into the stop, in m.
        penetration: f64,
        /// The remaining compliance of the smaller chamber with its line, in m3/Pa.
        compliance: f64,
    },
    /// The start lies outside the stroke.
    #[error("a start at {position} is outside the stroke of {stroke} (m, or rad of a motor)")]
    StartOutsideStroke {
        /// Position asked for, in m.
        position: f64,
        /// The stroke, in m.
        stroke: f64,
    },
    /// A starting value is not a number, or below vacuum.
    #[error("a start with {quantity} of {value} is impossible")]
    ImpossibleStart {
        /// Which quantity.
        quantity: &'static str,
        /// Its value in SI units.
        value: f64,
    },
    /// No state of rest was found near the operating point.
    #[error(
        "the machine does not rest at this operating point: a residual of {residual} scales per second remains"
    )]
    NoRest {
        /// The greatest rate that remains, each over the scale of its state, in 1/s.
        residual: f64,
    },
    /// Machines that are to run side by side do not have the same components.
    #[error("machine {index} does not have the components of the first")]
    DifferentStructure {
        /// Which machine, counted from 0.
        index: usize,
    },
}
