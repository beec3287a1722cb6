//! Names of printed quantities for programs: keys of JSON, columns of tables.

use std::borrow::Cow;

use crate::dimension::Dimension;
use crate::motion::MotionKind;

/// Name of a printed quantity, which ends in its SI unit.
///
/// # Example
/// ```
/// use phea_quantity::{FORCE, MotionKind, QuantityName, VELOCITY};
/// let peak = QuantityName::OfMotion(["force_peak", "torque_peak"], &FORCE);
/// assert_eq!(peak.text(MotionKind::Linear), "force_peak_n");
/// assert_eq!(peak.text(MotionKind::Rotary), "torque_peak_n_m");
/// let velocity = QuantityName::moving("velocity", &VELOCITY);
/// assert_eq!(velocity.text(MotionKind::Rotary), "velocity_rad_per_s");
/// assert_eq!(QuantityName::Fixed("bore_m").text(MotionKind::Rotary), "bore_m");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuantityName {
    /// Quantity of oil, lines, housings or commands: the whole name, for every rig.
    Fixed(&'static str),
    /// Quantity of the rig's motion: the name without its unit for a rig with a cylinder and for
    /// one with a motor, and the dimension in linear motion.
    OfMotion([&'static str; 2], &'static Dimension),
}

impl QuantityName {
    /// Quantity of the motion whose name without its unit is common to both motions.
    pub const fn moving(name: &'static str, dimension: &'static Dimension) -> QuantityName {
        QuantityName::OfMotion([name; 2], dimension)
    }

    /// Name for a rig of this motion.
    pub fn text(self, motion: MotionKind) -> Cow<'static, str> {
        match self {
            QuantityName::Fixed(name) => Cow::Borrowed(name),
            QuantityName::OfMotion([linear, rotary], dimension) => {
                let name = if motion.is_rotary() { rotary } else { linear };
                Cow::Owned(format!("{name}_{}", motion.dimension(dimension).suffix()))
            }
        }
    }
}
