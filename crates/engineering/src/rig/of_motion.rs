//! Errors of the equations, which are those of a cylinder, in the words of a rig's motion.

use std::fmt;

use phea_hydraulics::machine::MachineError;
use phea_hydraulics::operating_point::OperatingPointError;
use phea_quantity::MotionKind;

/// Error of a rig of this motion.
#[derive(Clone, Debug, PartialEq)]
pub struct OfMotion<E> {
    /// Motion of the rig.
    pub motion: MotionKind,
    /// Error of the equations.
    pub error: E,
}

/// Errors of the equations in the words of a motor.
#[derive(Debug, thiserror::Error)]
enum MotorError {
    #[error("angle {angle} is outside the stroke of {stroke} (m, or rad of a motor)")]
    AngleOutsideStroke { angle: f64, stroke: f64 },
    #[error("a load torque of {load} N.m cannot be held: the valve holds {minimum} to {maximum} N.m")]
    LoadOutOfReach { load: f64, minimum: f64, maximum: f64 },
    #[error(
        "a load torque of {load} N.m cannot be held at this velocity: the valve holds {minimum} to {maximum} N.m"
    )]
    MovingLoadOutOfReach { load: f64, minimum: f64, maximum: f64 },
    #[error("an external torque moves no load whose motion is prescribed: it needs one with an inertia")]
    UnyieldingLoad,
    #[error(
        "pressed {penetration} (m, or rad of a motor) into its end stop, the shaft leaves no fluid ({compliance} m3/Pa)"
    )]
    ChamberVanishes { penetration: f64, compliance: f64 },
    #[error("a start with torque of {0} is impossible")]
    ImpossibleStart(f64),
}

impl fmt::Display for OfMotion<OperatingPointError> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of_motor = match self.error {
            OperatingPointError::PositionOutsideStroke { position, stroke } => {
                MotorError::AngleOutsideStroke { angle: position, stroke }
            }
            OperatingPointError::LoadOutOfReach { load, is_force: true, moves, minimum, maximum } => {
                let [load, minimum, maximum] = [load, minimum, maximum].map(f64::round);
                match moves {
                    true => MotorError::MovingLoadOutOfReach { load, minimum, maximum },
                    false => MotorError::LoadOutOfReach { load, minimum, maximum },
                }
            }
            error => return write!(f, "{error}"),
        };
        if self.motion.is_rotary() { write!(f, "{of_motor}") } else { write!(f, "{}", self.error) }
    }
}

impl fmt::Display for OfMotion<MachineError> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of_motor = match &self.error {
            MachineError::UnyieldingLoad => MotorError::UnyieldingLoad,
            MachineError::ChamberVanishes { penetration, compliance } => {
                MotorError::ChamberVanishes { penetration: *penetration, compliance: *compliance }
            }
            MachineError::ImpossibleStart { quantity: "force", value } => MotorError::ImpossibleStart(*value),
            error => return write!(f, "{error}"),
        };
        if self.motion.is_rotary() { write!(f, "{of_motor}") } else { write!(f, "{}", self.error) }
    }
}
