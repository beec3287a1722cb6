//! Errors of the equations, which are those of a cylinder, in the words of a rig's motion.

use std::fmt;

use phea_hydraulics::machine::MachineError;
use phea_hydraulics::operating_point::OperatingPointError;
use phea_quantity::MotionKind;

/// An error of a rig that moves so.
#[derive(Clone, Debug, PartialEq)]
pub struct OfMotion<E> {
    /// The motion of the rig.
    pub motion: MotionKind,
    /// The error of the equations.
    pub error: E,
}

impl fmt::Display for OfMotion<OperatingPointError> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.error {
            OperatingPointError::PositionOutsideStroke { position, stroke } if self.motion.is_rotary() => {
                write!(f, "angle {position} is outside the stroke of {stroke} (m, or rad of a motor)")
            }
            OperatingPointError::LoadOutOfReach { load, is_force: true, moves, minimum, maximum }
                if self.motion.is_rotary() =>
            {
                let [load, minimum, maximum] = [load, minimum, maximum].map(f64::round);
                let at = if moves { " at this velocity" } else { "" };
                write!(
                    f,
                    "a load torque of {load} N.m cannot be held{at}: the valve holds {minimum} to {maximum} N.m"
                )
            }
            error => write!(f, "{error}"),
        }
    }
}

impl fmt::Display for OfMotion<MachineError> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.error {
            MachineError::UnyieldingLoad if self.motion.is_rotary() => {
                write!(
                    f,
                    "an external torque moves no load whose motion is prescribed: it needs one with an inertia"
                )
            }
            MachineError::ChamberVanishes { penetration, compliance } if self.motion.is_rotary() => write!(
                f,
                "pressed {penetration} (m, or rad of a motor) into its end stop, the shaft leaves no fluid ({compliance} m3/Pa)"
            ),
            MachineError::ImpossibleStart { quantity: "force", value } if self.motion.is_rotary() => {
                write!(f, "a start with torque of {value} is impossible")
            }
            error => write!(f, "{error}"),
        }
    }
}
