//! Units for figures and sentences; values are given in SI.

use super::shortest::shortest;
use super::significant;

/// Display unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Symbol.
    pub symbol: &'static str,
    /// Size of the unit in SI.
    pub in_si: f64,
}

impl DisplayUnit {
    /// All constants.
    pub const ALL: [Self; 31] = [
        Self::MILLIMETRE,
        Self::METRE,
        Self::SQUARE_CENTIMETRE,
        Self::GIGAPASCAL,
        Self::MILLILITRE,
        Self::CUBIC_CENTIMETRE_PER_METRE,
        Self::SECOND,
        Self::MILLISECOND,
        Self::HERTZ,
        Self::LITRE_PER_MINUTE,
        Self::MEGANEWTON_PER_METRE,
        Self::METRE_PER_SECOND,
        Self::NEWTON,
        Self::KILONEWTON,
        Self::NEWTON_METRE,
        Self::DEGREE,
        Self::RADIAN_PER_SECOND,
        Self::KILONEWTON_METRE_PER_RADIAN,
        Self::MILLIVOLT_PER_NEWTON_METRE,
        Self::BAR,
        Self::DEGREE_CELSIUS,
        Self::JOULE,
        Self::WATT,
        Self::VOLT,
        Self::MILLIVOLT_PER_NEWTON,
        Self::DECIBEL,
        Self::PERCENT,
        Self::IN_HERTZ,
        Self::IN_PERCENT,
        Self::IN_DEGREES,
        Self::ONE,
    ];
    /// Length.
    pub const MILLIMETRE: Self = DisplayUnit { symbol: "mm", in_si: 1e-3 };
    /// Length.
    pub const METRE: Self = DisplayUnit { symbol: "m", in_si: 1.0 };
    /// Area.
    pub const SQUARE_CENTIMETRE: Self = DisplayUnit { symbol: "cm2", in_si: 1e-4 };
    /// Modulus.
    pub const GIGAPASCAL: Self = DisplayUnit { symbol: "GPa", in_si: 1e9 };
    /// Volume.
    pub const MILLILITRE: Self = DisplayUnit { symbol: "mL", in_si: 1e-6 };
    /// Volume to a length.
    pub const CUBIC_CENTIMETRE_PER_METRE: Self = DisplayUnit { symbol: "cm3/m", in_si: 1e-6 };
    /// Time.
    pub const SECOND: Self = DisplayUnit { symbol: "s", in_si: 1.0 };
    /// Time.
    pub const MILLISECOND: Self = DisplayUnit { symbol: "ms", in_si: 1e-3 };
    /// Frequency.
    pub const HERTZ: Self = DisplayUnit { symbol: "Hz", in_si: 2.0 * std::f64::consts::PI };
    /// Flow.
    pub const LITRE_PER_MINUTE: Self = DisplayUnit { symbol: "L/min", in_si: 1e-3 / 60.0 };
    /// Stiffness.
    pub const MEGANEWTON_PER_METRE: Self = DisplayUnit { symbol: "MN/m", in_si: 1e6 };
    /// Velocity.
    pub const METRE_PER_SECOND: Self = DisplayUnit { symbol: "m/s", in_si: 1.0 };
    /// Force.
    pub const NEWTON: Self = DisplayUnit { symbol: "N", in_si: 1.0 };
    /// Force.
    pub const KILONEWTON: Self = DisplayUnit { symbol: "kN", in_si: 1e3 };
    /// Torque.
    pub const NEWTON_METRE: Self = DisplayUnit { symbol: "N.m", in_si: 1.0 };
    /// Angle.
    pub const DEGREE: Self = DisplayUnit { symbol: "deg", in_si: std::f64::consts::PI / 180.0 };
    /// Angular velocity.
    pub const RADIAN_PER_SECOND: Self = DisplayUnit { symbol: "rad/s", in_si: 1.0 };
    /// Torsional stiffness.
    pub const KILONEWTON_METRE_PER_RADIAN: Self = DisplayUnit { symbol: "kN.m/rad", in_si: 1e3 };
    /// Voltage for a torque.
    pub const MILLIVOLT_PER_NEWTON_METRE: Self = DisplayUnit { symbol: "mV/(N.m)", in_si: 1e-3 };
    /// Pressure.
    pub const BAR: Self = DisplayUnit { symbol: "bar", in_si: 1e5 };
    /// Celsius temperature.
    pub const DEGREE_CELSIUS: Self = DisplayUnit { symbol: "degC", in_si: 1.0 };
    /// Energy.
    pub const JOULE: Self = DisplayUnit { symbol: "J", in_si: 1.0 };
    /// Power.
    pub const WATT: Self = DisplayUnit { symbol: "W", in_si: 1.0 };
    /// Control signal.
    pub const VOLT: Self = DisplayUnit { symbol: "V", in_si: 1.0 };
    /// Voltage for a force.
    pub const MILLIVOLT_PER_NEWTON: Self = DisplayUnit { symbol: "mV/N", in_si: 1e-3 };
    /// Ratio of magnitudes, stated in dB inside too.
    pub const DECIBEL: Self = DisplayUnit { symbol: "dB", in_si: 1.0 };
    /// Fraction.
    pub const PERCENT: Self = DisplayUnit { symbol: "%", in_si: 0.01 };
    /// Frequency that is in Hz inside too.
    pub const IN_HERTZ: Self = DisplayUnit { symbol: "Hz", in_si: 1.0 };
    /// Number that is in percent inside too.
    pub const IN_PERCENT: Self = DisplayUnit { symbol: "%", in_si: 1.0 };
    /// Angle that is in degrees inside too.
    pub const IN_DEGREES: Self = DisplayUnit { symbol: "deg", in_si: 1.0 };
    /// Ratio.
    pub const ONE: Self = DisplayUnit { symbol: "1", in_si: 1.0 };

    /// Value in this unit, from SI.
    pub fn of(self, value: f64) -> f64 {
        value / self.in_si
    }

    /// Number for an SI value in this unit with this number of significant digits, without the
    /// symbol.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::DisplayUnit;
    /// assert_eq!(DisplayUnit::LITRE_PER_MINUTE.number(1.6e-4, 3), "9.60");
    /// ```
    pub fn number(self, value: f64, digits: usize) -> String {
        significant(self.of(value), digits)
    }

    /// Number followed by the symbol.
    pub fn text(self, value: f64, digits: usize) -> String {
        self.with_symbol(self.number(value, digits))
    }

    /// Number followed by the symbol, without trailing zeros: for values entered by a user.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::DisplayUnit;
    /// assert_eq!(DisplayUnit::KILONEWTON.short(4000.0, 4), "4 kN");
    /// assert_eq!(DisplayUnit::KILONEWTON.short(80.0, 4), "0.08 kN");
    /// ```
    pub fn short(self, value: f64, digits: usize) -> String {
        self.with_symbol(shortest(self.of(value), digits))
    }

    /// Numbers followed by the symbol; a ratio has no symbol.
    pub fn with_symbol(self, numbers: String) -> String {
        if self.symbol == "1" { numbers } else { format!("{numbers} {}", self.symbol) }
    }

    /// Axis title `quantity (symbol)`.
    pub fn title(self, quantity: &str) -> String {
        if self.symbol == "1" { quantity.to_string() } else { format!("{quantity} ({})", self.symbol) }
    }
}
