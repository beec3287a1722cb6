use crate::line::{LineError, StiffeningMember};
use crate::parameter::{ParameterError, Problems};

/// Inputs of a machine in a run, the pressure signal that a controller reads, and the member of the
/// stiffening of its hoses. The default adds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineOptions {
    /// Factor phi of the pressure signal p_A - phi p_B that a controller may feed back.
    pub pressure_ratio: f64,
    /// True if an external force acts on the load, as an input of the machine; requires a load with
    /// a mass.
    pub external_force: bool,
    /// True if the setting of adjusted accumulators moves, as an input of the machine: its change
    /// from rest, and its rate. Otherwise they remain at their setting at rest.
    pub moving_setting: bool,
    /// Member of the hoses' stiffening interval.
    pub member: StiffeningMember,
}

impl Default for MachineOptions {
    fn default() -> MachineOptions {
        MachineOptions {
            pressure_ratio: 1.0,
            external_force: false,
            moving_setting: false,
            member: StiffeningMember::Nominal,
        }
    }
}

impl MachineOptions {
    /// Impossible options; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.not_negative("controller.pressure_feedback.ratio", self.pressure_ratio);
        problems.into_vec()
    }
}

/// Error for an impossible machine, or an impossible start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MachineError {
    /// Impossible parameters.
    #[error("{}", problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Impossible {
        /// All impossible parameters.
        problems: Vec<ParameterError>,
    },
    /// A line that its model does not fit.
    #[error(transparent)]
    Line(#[from] LineError),
    /// A static friction curve with a jump, which no integrator can resolve; it needs a velocity
    /// that smooths it, or bristles.
    #[error("static Stribeck friction jumps at standstill: state a regular velocity, or use LuGre friction")]
    StaticFriction,
    /// A load in front of a wall without a mass: nothing determines its motion.
    #[error("a load in front of a wall is simulated with the mass that moves beyond the force sensor")]
    LoadWithoutMass,
    /// An external force on a load whose motion is prescribed: it would have no effect.
    #[error("an external force moves no load whose motion is prescribed: it needs one with a mass")]
    UnyieldingLoad,
    /// An end stop that is too soft: pressed into it by the whole supply pressure, the piston would
    /// leave no fluid in the chamber.
    #[error(
        "pressed {penetration} (m, or rad of a motor) into its end stop, the piston leaves no fluid ({compliance} m3/Pa)"
    )]
    ChamberVanishes {
        /// Penetration into the stop, m.
        penetration: f64,
        /// Remaining compliance of the smaller chamber with its line, m3/Pa.
        compliance: f64,
    },
    /// A start outside the stroke.
    #[error("a start at {position} is outside the stroke of {stroke} (m, or rad of a motor)")]
    StartOutsideStroke {
        /// Requested position, m.
        position: f64,
        /// Stroke, m.
        stroke: f64,
    },
    /// A starting value that is NaN, or below vacuum.
    #[error("a start with {quantity} of {value} is impossible")]
    ImpossibleStart {
        /// Name of the quantity.
        quantity: &'static str,
        /// Value in SI units.
        value: f64,
    },
    /// An operating point near which no state of rest was found.
    #[error(
        "the machine does not rest at this operating point: a residual of {residual} scales per second remains"
    )]
    NoRest {
        /// Greatest remaining rate over the scale of its state, 1/s.
        residual: f64,
    },
    /// Machines for parallel lanes that do not have equal components.
    #[error("machine {index} does not have the components of the first")]
    DifferentStructure {
        /// Index of the machine, counted from 0.
        index: usize,
    },
}
