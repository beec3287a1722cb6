//! Display units of the quantities of one project.

use super::dimension::*;
use super::display_unit::DisplayUnit;
use super::motion::MotionKind;
use super::parse::parse;

/// Unit of each quantity of a project, for tables, sentences and axes.
///
/// Equality compares only the motion: a value does not depend on its display unit.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Motion of the rig.
    pub motion: MotionKind,
    /// Unit of forces, or of torques of a rig that turns.
    pub force: DisplayUnit,
    /// Unit of positions of piston and load, or of angles.
    pub position: DisplayUnit,
    /// Unit of pressures.
    pub pressure: DisplayUnit,
    /// Unit of flows.
    pub flow: DisplayUnit,
}

/// Symbols of the possible display units of projects.
pub(super) static SYMBOLS: [&str; 19] = [
    "N", "kN", "MN", "lbf", "N.m", "kN.m", "mm", "cm", "m", "in", "deg", "rad", "bar", "MPa", "kPa", "psi",
    "L/min", "m3/s", "gpm",
];

impl Units {
    /// Customary units for a project that states none.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{MotionKind, Units};
    /// assert_eq!(Units::customary(MotionKind::Linear).force.short(1100.0, 3), "1.1 kN");
    /// assert_eq!(Units::customary(MotionKind::Rotary).force.short(120.0, 3), "120 N.m");
    /// ```
    pub fn customary(motion: MotionKind) -> Units {
        Units {
            motion,
            force: motion.unit(DisplayUnit::KILONEWTON),
            position: motion.unit(DisplayUnit::MILLIMETRE),
            pressure: DisplayUnit::BAR,
            flow: DisplayUnit::LITRE_PER_MINUTE,
        }
    }

    /// Display unit for quantities of a dimension; the SI unit if none is customary.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{FLOW, Units, VOLTAGE};
    /// assert_eq!(Units::default().of(&FLOW).symbol, "L/min");
    /// assert_eq!(Units::default().of(&VOLTAGE).symbol, "V");
    /// ```
    pub fn of(&self, dimension: &'static Dimension) -> DisplayUnit {
        let customary = [
            (&FORCE, self.force),
            (&LENGTH, self.position),
            (&PRESSURE, self.pressure),
            (&FLOW, self.flow),
            (&VELOCITY, self.motion.unit(DisplayUnit::METRE_PER_SECOND)),
            (&ANGLE, DisplayUnit::DEGREE),
            (&TEMPERATURE, DisplayUnit::DEGREE_CELSIUS),
        ];
        let found = customary.into_iter().find(|(known, _)| std::ptr::eq(*known, dimension));
        found.map_or(DisplayUnit { symbol: dimension.si, in_si: 1.0 }, |(_, unit)| unit)
    }

    /// Unit of this symbol, if quantities of the dimension can be shown in it.
    pub fn known(symbol: &str, dimension: &Dimension) -> Option<DisplayUnit> {
        let symbol = *SYMBOLS.iter().find(|known| **known == symbol)?;
        let in_si = parse(&format!("1 {symbol}"), dimension).ok()?;
        Some(DisplayUnit { symbol, in_si })
    }
}

impl Default for Units {
    fn default() -> Units {
        Units::customary(MotionKind::Linear)
    }
}

impl PartialEq for Units {
    fn eq(&self, other: &Units) -> bool {
        self.motion == other.motion
    }
}
