//! Dimensions of physical quantities, and the customary units of each.

/// Exponents of (mass, length, time, voltage, angle, temperature), counted in halves so that
/// m³/(s·√Pa) is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exponents(pub [i8; 6]);

impl Exponents {
    /// Whole exponents of kg, m, s, V and rad.
    pub const fn whole(mass: i8, length: i8, time: i8, voltage: i8, angle: i8) -> Self {
        Exponents([2 * mass, 2 * length, 2 * time, 2 * voltage, 2 * angle, 0])
    }

    /// Exponent of degrees Celsius, a whole number.
    pub const fn celsius(temperature: i8) -> Self {
        Exponents([0, 0, 0, 0, 0, 2 * temperature])
    }

    /// Exponents of a pure number.
    pub const NONE: Exponents = Exponents([0; 6]);

    /// Exponents of the power `halves`/2; `None` if one of them is not a multiple of one half.
    pub(crate) fn to_halves(self, halves: i8) -> Option<Exponents> {
        let mut exponents = [0; 6];
        for (power, exponent) in exponents.iter_mut().zip(self.0) {
            let scaled = i32::from(exponent) * i32::from(halves);
            *power = if scaled % 2 == 0 { i8::try_from(scaled / 2).ok()? } else { return None };
        }
        Some(Exponents(exponents))
    }

    /// Text in SI base units, such as `kg/(m.s^2)`; `1` for a pure number.
    pub(crate) fn in_base_units(self) -> String {
        let symbols = ["kg", "m", "s", "V", "rad", "degC"];
        let side = |positive: bool| -> Vec<String> {
            let mut factors = Vec::new();
            for (symbol, &halves) in symbols.iter().zip(&self.0) {
                if halves == 0 || (halves > 0) != positive {
                    continue;
                }
                let halves = halves.unsigned_abs();
                factors.push(match (halves, halves % 2) {
                    (2, _) => (*symbol).to_string(),
                    (_, 0) => format!("{symbol}^{}", halves / 2),
                    _ => format!("{symbol}^{}.5", halves / 2),
                });
            }
            factors
        };
        let (over, under) = (side(true), side(false));
        let numerator = if over.is_empty() { "1".to_string() } else { over.join(".") };
        match under.len() {
            0 => numerator,
            1 => format!("{numerator}/{}", under[0]),
            _ => format!("{numerator}/({})", under.join(".")),
        }
    }
}

/// Kind of quantity: its name, its exponents, and its display units.
#[derive(Debug, PartialEq)]
pub struct Dimension {
    /// Name with its article, as in "expected a pressure".
    pub name: &'static str,
    /// Name without its article.
    pub noun: &'static str,
    /// Exponents of the base units.
    pub exponents: Exponents,
    /// Display units, smallest first. The first is used for zero; empty means a bare SI number.
    pub units: &'static [&'static str],
    /// Examples of valid texts for error messages.
    pub examples: &'static str,
    /// SI unit in this grammar.
    pub si: &'static str,
}

impl Dimension {
    /// SI unit in this grammar; empty for a pure number.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{FLOW, RATIO};
    /// assert_eq!([FLOW.si_unit(), RATIO.si_unit()], ["m3/s", ""]);
    /// ```
    pub fn si_unit(&self) -> &'static str {
        if self.si == "1" { "" } else { self.si }
    }

    /// Ending of names of quantities in SI: of a key of JSON, or of a column of a table.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::{FLOW, RATIO, TORQUE, VOLTAGE_PER_TORQUE};
    /// assert_eq!([FLOW.suffix(), TORQUE.suffix(), RATIO.suffix()], ["m3_per_s", "n_m", "ratio"]);
    /// assert_eq!(VOLTAGE_PER_TORQUE.suffix(), "v_per_n_m");
    /// ```
    pub fn suffix(&self) -> String {
        match self.si {
            "1" => "ratio".to_string(),
            "%" => "percent".to_string(),
            "degC" => "degC".to_string(),
            si => si.to_lowercase().replace('/', "_per_").replace('.', "_").replace(['(', ')'], ""),
        }
    }
}

macro_rules! dimensions {
    ($($(#[$doc:meta])* $identifier:ident = $article:literal $noun:literal, $exponents:expr, $units:expr, $si:literal, $examples:literal;)*) => {
        $($(#[$doc])* pub static $identifier: Dimension =
            Dimension {
                name: concat!($article, " ", $noun),
                noun: $noun,
                exponents: $exponents,
                units: &$units,
                si: $si,
                examples: $examples,
            };)*
        /// All named dimensions, to identify the dimension of a wrong unit.
        pub static DIMENSIONS: &[&Dimension] = &[$(&$identifier),*];
    };
}

const fn whole(mass: i8, length: i8, time: i8, voltage: i8, angle: i8) -> Exponents {
    Exponents::whole(mass, length, time, voltage, angle)
}

dimensions! {
    /// Pa; gauge pressure unless a key says otherwise.
    PRESSURE = "a" "pressure", whole(1, -1, -2, 0, 0), ["Pa", "kPa", "bar", "GPa"], "Pa",
        r#""70 bar", "7 MPa", "1000 psi""#;
    /// kg/m³.
    DENSITY = "a" "density", whole(1, -3, 0, 0, 0), ["kg/m3"], "kg/m3", r#""870 kg/m3", "0.87 g/cm3", "0.87 kg/L""#;
    /// m²/s.
    KINEMATIC_VISCOSITY = "a" "kinematic viscosity", whole(0, 2, -1, 0, 0), ["cSt"], "m2/s",
        r#""46 cSt", "46 mm2/s""#;
    /// m³/s.
    FLOW = "a" "volume flow", whole(0, 3, -1, 0, 0), ["L/min"], "m3/s", r#""9.8 L/min", "10 gpm", "1.6e-4 m3/s""#;
    /// V.
    VOLTAGE = "a" "voltage", whole(0, 0, 0, 1, 0), ["mV", "V"], "V", r#""10 V", "50 mV""#;
    /// A, of a command to a valve.
    CURRENT = "a" "current", whole(1, 2, -3, -1, 0), ["mA", "A"], "A", r#""40 mA", "0.3 A""#;
    /// rad/s; a text in Hz is a number of cycles and is multiplied by 2π.
    ANGULAR_FREQUENCY = "an" "angular frequency", whole(0, 0, -1, 0, 1), ["rad/s"], "rad/s",
        r#""1099 rad/s", "175 Hz""#;
    /// W.
    POWER = "a" "power", whole(1, 2, -3, 0, 0), ["W"], "W", r#""50 W", "1.2 kW""#;
    /// A pure number.
    RATIO = "a" "pure number", Exponents::NONE, [], "1", r#"0.9, "20 %""#;
    /// Percent: the value is the number of percent, with or without the sign.
    PERCENT = "a" "percentage", Exponents::NONE, [], "%", r#"2, "2 %""#;
    /// A gain as a ratio; its text may be in dB.
    GAIN = "a" "gain", Exponents::NONE, [], "1", r#"1.3, "6 dB""#;
    /// m³/(s·√Pa).
    FLOW_COEFFICIENT = "a" "flow coefficient", Exponents([-1, 7, 0, 0, 0, 0]), [], "m3/(s.Pa^0.5)",
        r#"3.2e-7, "3.2e-7 m3/(s.Pa^0.5)", "6.07 L/(min.bar^0.5)""#;
    /// m³/(s·V).
    FLOW_GAIN = "a" "flow gain", whole(0, 3, -1, -1, 0), [], "m3/(s.V)", r#"5.6e-5, "5.6e-5 m3/(s.V)", "3.4 L/(min.V)""#;
    /// m³/(s·Pa).
    FLOW_PRESSURE_COEFFICIENT = "a" "flow-pressure coefficient", whole(-1, 4, 1, 0, 0), [], "m3/(s.Pa)",
        r#"6.42e-13, "6.42e-13 m3/(s.Pa)", "0.004 L/(min.bar)""#;
    /// m.
    LENGTH = "a" "length", whole(0, 1, 0, 0, 0), ["mm", "m"], "m", r#""12.7 mm", "1.5 m", "0.5 in""#;
    /// m².
    AREA = "an" "area", whole(0, 2, 0, 0, 0), ["mm2"], "m2", r#""1583 mm2", "15.83 cm2""#;
    /// m³.
    VOLUME = "a" "volume", whole(0, 3, 0, 0, 0), ["mL", "L"], "m3", r#""190 mL", "0.19 L", "190 cc""#;
    /// m³/m, the volume a metre of hose gains.
    VOLUME_PER_LENGTH = "a" "volume per length", whole(0, 2, 0, 0, 0), ["mL/m"], "m3/m",
        r#""4.7 cc/ft", "15.4 mL/m""#;
    /// m³/(m·Pa).
    EXPANSION_SLOPE = "a" "volumetric expansion slope", whole(-1, 3, 2, 0, 0), [], "m3/(m.Pa)",
        r#"2.236e-12, "0.0047 cc/(ft.psi)", "0.22 mL/(m.bar)""#;
    /// m³/Pa.
    CAPACITY = "a" "hydraulic capacity", whole(-1, 4, 2, 0, 0), [], "m3/Pa", r#"1e-12, "1e-12 m3/Pa", "0.1 mL/bar""#;
    /// kg.
    MASS = "a" "mass", whole(1, 0, 0, 0, 0), ["g", "kg", "t"], "kg", r#""13.1 kg", "200 g""#;
    /// N.
    FORCE = "a" "force", whole(1, 1, -2, 0, 0), ["N", "kN", "MN"], "N", r#""80 N", "4 kN""#;
    /// m/s.
    VELOCITY = "a" "velocity", whole(0, 1, -1, 0, 0), ["mm/s", "m/s"], "m/s", r#""2.1 m/s", "10 mm/s""#;
    /// N/m.
    STIFFNESS = "a" "stiffness", whole(1, 0, -2, 0, 0), ["N/m", "N/mm", "kN/mm"], "N/m",
        r#""20 MN/m", "20 kN/mm", "2e7 N/m""#;
    /// N·s/m.
    DAMPING = "a" "viscous friction", whole(1, 0, -1, 0, 0), ["N.s/m"], "N.s/m", r#""100 N.s/m", "0.1 N.s/mm""#;
    /// s.
    TIME = "a" "time", whole(0, 0, 1, 0, 0), ["us", "ms", "s"], "s", r#""50 ms", "5 s""#;
    /// V/N, the gain of a force controller.
    VOLTAGE_PER_FORCE = "a" "gain in V/N", whole(-1, -1, 2, 1, 0), [], "V/N", r#"0.001, "1e-3 V/N", "1 V/kN""#;
    /// V/s, of a spool.
    VOLTAGE_RATE = "a" "voltage rate", whole(0, 0, -1, 1, 0), [], "V/s", r#"2000, "2000 V/s", "2 V/ms""#;
    /// V·s/m, from a velocity to a command.
    VOLTAGE_PER_VELOCITY = "a" "gain in V.s/m", whole(0, -1, 1, 1, 0), [], "V.s/m", r#"28, "28 V.s/m", "28 V/(m/s)""#;
    /// V/Pa, from a pressure to a command.
    VOLTAGE_PER_PRESSURE = "a" "gain in V/Pa", whole(-1, 1, 2, 1, 0), ["V/bar"], "V/Pa",
        r#""0.02 V/bar", "2e-7 V/Pa""#;
    /// s/m, damping of a contact relative to its elastic force.
    INVERSE_VELOCITY = "an" "inverse velocity", whole(0, -1, 1, 0, 0), [], "s/m", r#"0.5, "0.5 s/m""#;
    /// kg/m, of a hose's wall.
    MASS_PER_LENGTH = "a" "mass per length", whole(1, -1, 0, 0, 0), ["g/m", "kg/m"], "kg/m", r#""0.23 kg/m", "230 g/m""#;
    /// 1/Pa, how a wall yields to pressure.
    STRAIN_PER_PRESSURE = "a" "strain per pressure", whole(-1, 1, 2, 0, 0), [], "1/Pa", r#"8e-9, "8e-9 1/Pa", "0.8 1/kbar""#;
    /// 1/N, how a wall yields to tension.
    STRAIN_PER_FORCE = "a" "strain per force", whole(-1, -1, 2, 0, 0), [], "1/N", r#"2e-5, "2e-5 1/N", "0.02 1/kN""#;
    /// rad.
    ANGLE = "an" "angle", whole(0, 0, 0, 0, 1), ["deg"], "rad", r#""30 deg", "0.5 rad""#;
    /// N·m.
    TORQUE = "a" "torque", whole(1, 2, -2, 0, 0), ["N.m", "kN.m", "MN.m"], "N.m", r#""40 N.m", "1.2 kN.m""#;
    /// rad/s, how fast a shaft turns.
    ANGULAR_VELOCITY = "an" "angular velocity", whole(0, 0, -1, 0, 1), ["rad/s"], "rad/s",
        r#""2 rad/s", "30 rpm", "10 deg/s""#;
    /// kg·m².
    INERTIA = "an" "inertia", whole(1, 2, 0, 0, 0), ["kg.m2"], "kg.m2", r#""0.02 kg.m2", "200 kg.cm2""#;
    /// N·m/rad.
    TORSIONAL_STIFFNESS = "a" "torsional stiffness", whole(1, 2, -2, 0, -1), ["N.m/rad", "kN.m/rad", "MN.m/rad"],
        "N.m/rad", r#""20 kN.m/rad", "350 N.m/deg""#;
    /// N·m·s/rad.
    TORSIONAL_DAMPING = "a" "torsional friction", whole(1, 2, -1, 0, -1), ["N.m.s/rad"], "N.m.s/rad",
        r#""1.5 N.m.s/rad", "0.16 N.m/rpm""#;
    /// m³/rad, what a motor takes for an angle.
    DISPLACEMENT = "a" "displacement", whole(0, 3, 0, 0, -1), ["cc/rev"], "m3/rad", r#""100 cc/rev", "16 mL/rad""#;
    /// s/rad, damping of a contact relative to its elastic torque.
    INVERSE_ANGULAR_VELOCITY = "an" "inverse angular velocity", whole(0, 0, 1, 0, -1), [], "s/rad",
        r#"0.5, "0.5 s/rad""#;
    /// V/(N·m), the gain of a torque controller.
    VOLTAGE_PER_TORQUE = "a" "gain in V/(N.m)", whole(-1, -2, 2, 1, 0), [], "V/(N.m)", r#"0.05, "0.05 V/(N.m)""#;
    /// V·s/rad, from an angular velocity to a command.
    VOLTAGE_PER_ANGULAR_VELOCITY = "a" "gain in V.s/rad", whole(0, 0, 1, 1, -1), [], "V.s/rad",
        r#"0.8, "0.8 V.s/rad", "0.8 V/(rad/s)""#;
    /// Celsius temperature in degC: the thermodynamic temperature less 273.15 K.
    TEMPERATURE = "a" "temperature", Exponents::celsius(1), ["degC"], "degC", r#""37 degC""#;
    /// Relative change per degree, 1/degC.
    TEMPERATURE_COEFFICIENT = "a" "fraction per degree", Exponents::celsius(-1), [], "1/degC",
        r#"0.045, "4.5 %/degC""#;
}
