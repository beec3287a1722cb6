//! The units in which the quantities of one project are shown.

use super::dimension::*;
use super::display_unit::DisplayUnit;
use super::motion::MotionKind;
use super::parse::parse;

/// One unit for each quantity of a project, in tables, sentences and axes alike.
///
/// Two are equal if the motion is: a value remains the same in whichever unit it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// How the rig moves.
    pub motion: MotionKind,
    /// Forces, or torques of a rig that turns.
    pub force: DisplayUnit,
    /// Positions of piston and load, or angles.
    pub position: DisplayUnit,
    /// Pressures.
    pub pressure: DisplayUnit,
    /// Flows.
    pub flow: DisplayUnit,
}

/// Symbols of the units in which projects can be shown.
static SYMBOLS: [&str; 19] = [
    "N", "kN", "MN", "lbf", "N.m", "kN.m", "mm", "cm", "m", "in", "deg", "rad", "bar", "MPa", "kPa", "psi",
    "L/min", "m3/s", "gpm",
];

impl Units {
    /// The units that people expect where a project writes none.
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

    /// The unit in which quantities of a dimension are shown; the SI unit where none is customary.
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

    /// The unit of this symbol, if quantities of the dimension can be shown in it.
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
