//! Whether a rig moves along a line or turns: the one place that knows what this makes of
//! dimensions, units and words.
//!
//! The equations of both are the same: with its displacement in place of the areas, a motor's angle
//! is its position, its torque its force and its inertia its mass. Programs and equations therefore
//! use one set of names inside; what is read and written asks here.

mod words;

use crate::dimension::*;
use crate::display_unit::DisplayUnit;

pub use words::{MotionSymbols, MotionWords};

/// The motion of a rig.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionKind {
    /// A cylinder: positions in m, forces in N.
    #[default]
    Linear,
    /// A motor: angles in rad, torques in N m.
    Rotary,
}

/// Quantities of linear motion and those of rotary motion in their place.
static DIMENSIONS_OF_MOTION: [(&Dimension, &Dimension); 10] = [
    (&FORCE, &TORQUE),
    (&LENGTH, &ANGLE),
    (&VELOCITY, &ANGULAR_VELOCITY),
    (&MASS, &INERTIA),
    (&STIFFNESS, &TORSIONAL_STIFFNESS),
    (&DAMPING, &TORSIONAL_DAMPING),
    (&AREA, &DISPLACEMENT),
    (&INVERSE_VELOCITY, &INVERSE_ANGULAR_VELOCITY),
    (&VOLTAGE_PER_FORCE, &VOLTAGE_PER_TORQUE),
    (&VOLTAGE_PER_VELOCITY, &VOLTAGE_PER_ANGULAR_VELOCITY),
];

/// Units of display, likewise. Torques are shown in N m and stiffnesses in kN m/rad: the motors of
/// test benches give some hundred N m.
static UNITS_OF_MOTION: [(DisplayUnit, DisplayUnit); 7] = [
    (DisplayUnit::NEWTON, DisplayUnit::NEWTON_METRE),
    (DisplayUnit::KILONEWTON, DisplayUnit::NEWTON_METRE),
    (DisplayUnit::METRE, DisplayUnit::DEGREE),
    (DisplayUnit::MILLIMETRE, DisplayUnit::DEGREE),
    (DisplayUnit::METRE_PER_SECOND, DisplayUnit::RADIAN_PER_SECOND),
    (DisplayUnit::MEGANEWTON_PER_METRE, DisplayUnit::KILONEWTON_METRE_PER_RADIAN),
    (DisplayUnit::MILLIVOLT_PER_NEWTON, DisplayUnit::MILLIVOLT_PER_NEWTON_METRE),
];

impl MotionKind {
    /// Whether it turns.
    pub fn is_rotary(self) -> bool {
        self == MotionKind::Rotary
    }

    /// The dimension of a quantity of the motion, stated as that of linear motion.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{FORCE, MotionKind, VOLTAGE};
    /// assert_eq!(MotionKind::Rotary.dimension(&FORCE).si, "N.m");
    /// assert_eq!(MotionKind::Linear.dimension(&FORCE).si, "N");
    /// assert_eq!(MotionKind::Rotary.dimension(&VOLTAGE).si, "V");
    /// ```
    pub fn dimension(self, of: &'static Dimension) -> &'static Dimension {
        let pair =
            DIMENSIONS_OF_MOTION.iter().find(|(linear, _)| self.is_rotary() && std::ptr::eq(*linear, of));
        pair.map_or(of, |(_, rotary)| rotary)
    }

    /// The unit in which a quantity of the motion is shown, stated as that of linear motion.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{DisplayUnit, MotionKind};
    /// assert_eq!(MotionKind::Rotary.unit(DisplayUnit::KILONEWTON).text(120.0, 3), "120 N.m");
    /// assert_eq!(MotionKind::Rotary.unit(DisplayUnit::MILLIMETRE).text(std::f64::consts::PI, 3), "180 deg");
    /// assert_eq!(MotionKind::Linear.unit(DisplayUnit::KILONEWTON).text(120.0, 3), "0.120 kN");
    /// ```
    pub fn unit(self, of: DisplayUnit) -> DisplayUnit {
        let pair = UNITS_OF_MOTION.iter().find(|(linear, _)| self.is_rotary() && *linear == of);
        pair.map_or(of, |(_, rotary)| *rotary)
    }
}
