//! Linear or rotary motion of a rig: the one place that defines its effect on dimensions, units and
//! names for programs.
//!
//! The equations of both are identical: with its displacement in place of the areas, a motor's
//! angle is its position, its torque its force and its inertia its mass. Programs and equations
//! therefore use one set of names inside; input and output are translated here.

mod formulae;
mod names;

use std::borrow::Cow;

use crate::dimension::*;
use crate::display_unit::DisplayUnit;

/// Motion of a rig.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionKind {
    /// A cylinder: positions in m, forces in N.
    #[default]
    Linear,
    /// A motor: angles in rad, torques in N m.
    Rotary,
}

/// Quantities of linear motion, and their rotary counterparts.
static DIMENSIONS_OF_MOTION: [(&Dimension, &Dimension); 9] = [
    (&FORCE, &TORQUE),
    (&LENGTH, &ANGLE),
    (&VELOCITY, &ANGULAR_VELOCITY),
    (&MASS, &INERTIA),
    (&STIFFNESS, &TORSIONAL_STIFFNESS),
    (&DAMPING, &TORSIONAL_DAMPING),
    (&AREA, &DISPLACEMENT),
    (&INVERSE_VELOCITY, &INVERSE_ANGULAR_VELOCITY),
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
    /// True if the rig turns.
    pub fn is_rotary(self) -> bool {
        self == MotionKind::Rotary
    }

    /// Dimension of a quantity of the motion, given that of linear motion.
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

    /// Display unit of a quantity of the motion, given that of linear motion.
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

    /// SI unit of a quantity of the motion, given that of linear motion.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// assert_eq!(MotionKind::Rotary.symbol("N/m"), "N.m/rad");
    /// assert_eq!(MotionKind::Rotary.symbol("Pa"), "Pa");
    /// ```
    pub fn symbol(self, of: &'static str) -> &'static str {
        if self.is_rotary() { names::symbol(of) } else { of }
    }

    /// Name of a quantity for programs, given that of linear motion: a key of JSON, a column of a
    /// table.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// assert_eq!(MotionKind::Rotary.name("force_n"), "torque_n_m");
    /// assert_eq!(MotionKind::Rotary.name("load_position_m"), "load_angle_rad");
    /// assert_eq!(MotionKind::Rotary.name("bore_m"), "bore_m");
    /// assert_eq!(MotionKind::Linear.name("force_n"), "force_n");
    /// ```
    pub fn name(self, of: &str) -> Cow<'_, str> {
        if self.is_rotary() { names::name(of) } else { Cow::Borrowed(of) }
    }

    /// Formula or symbol, given that of linear motion.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// let stiffness = "K_H = A_A^2/C_A + A_B^2/C_B";
    /// assert_eq!(MotionKind::Rotary.formula(stiffness), "K_θ = D^2 (1/C_A + 1/C_B)");
    /// assert_eq!(MotionKind::Rotary.formula("F_H = A_A p_A - A_B p_B"), "T_H = D (p_A - p_B)");
    /// assert_eq!(MotionKind::Rotary.formula("max(x, M v^2)"), "max(θ, J ω^2)");
    /// assert_eq!(MotionKind::Linear.formula(stiffness), stiffness);
    /// ```
    pub fn formula(self, of: &str) -> Cow<'_, str> {
        if self.is_rotary() { formulae::of_a_motor(of) } else { Cow::Borrowed(of) }
    }
}
