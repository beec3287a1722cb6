//! Words and symbols of linear motion, and those of rotary motion.

use super::MotionKind;

/// What sentences, headings and axes call the quantities and parts of a rig.
#[derive(Clone, Copy, Debug)]
pub struct MotionWords {
    /// What acts on the load.
    pub force: &'static str,
    /// Several of them.
    pub forces: &'static str,
    /// Where the actuator is.
    pub position: &'static str,
    /// Several of them.
    pub positions: &'static str,
    /// What resists acceleration.
    pub mass: &'static str,
    /// What moves in the actuator.
    pub piston: &'static str,
    /// What it drives.
    pub rod: &'static str,
    /// The actuator.
    pub cylinder: &'static str,
    /// The instrument in the loop, as a product.
    pub load_cell: &'static str,
    /// The same as part of the rig.
    pub force_sensor: &'static str,
}

/// Symbols of a rig, as in the notation.
#[derive(Clone, Copy, Debug)]
pub struct MotionSymbols {
    /// Measured force or torque.
    pub measured: &'static str,
    /// Hydraulic force or torque.
    pub hydraulic: &'static str,
    /// Reference of force or torque.
    pub reference: &'static str,
    /// External force or torque.
    pub external: &'static str,
    /// Hydraulic stiffness.
    pub stiffness: &'static str,
    /// Mass or inertia.
    pub mass: &'static str,
    /// Position of the piston, angle of the shaft.
    pub position: &'static str,
    /// Position or angle of the load.
    pub load: &'static str,
    /// Driving-point impedance.
    pub impedance: &'static str,
}

static LINEAR_WORDS: MotionWords = MotionWords {
    force: "force",
    forces: "forces",
    position: "position",
    positions: "positions",
    mass: "mass",
    piston: "piston",
    rod: "rod",
    cylinder: "cylinder",
    load_cell: "load cell",
    force_sensor: "force sensor",
};

static ROTARY_WORDS: MotionWords = MotionWords {
    force: "torque",
    forces: "torques",
    position: "angle",
    positions: "angles",
    mass: "inertia",
    piston: "shaft",
    rod: "shaft",
    cylinder: "motor",
    load_cell: "torque sensor",
    force_sensor: "torque sensor",
};

static LINEAR_SYMBOLS: MotionSymbols = MotionSymbols {
    measured: "F_e",
    hydraulic: "F_H",
    reference: "F_ref",
    external: "F_x",
    stiffness: "K_H",
    mass: "M",
    position: "x_p",
    load: "x_L",
    impedance: "-F_e/(s X_L)",
};

static ROTARY_SYMBOLS: MotionSymbols = MotionSymbols {
    measured: "T_e",
    hydraulic: "T_H",
    reference: "T_ref",
    external: "T_x",
    stiffness: "K_θ",
    mass: "J",
    position: "θ",
    load: "θ_L",
    impedance: "-T_e/(s Θ_L)",
};

impl MotionKind {
    /// The one of two that holds for this motion.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// assert_eq!(MotionKind::Rotary.either("K_H = A^2/C", "K_θ = D^2/C"), "K_θ = D^2/C");
    /// assert_eq!(MotionKind::Linear.either("K_H = A^2/C", "K_θ = D^2/C"), "K_H = A^2/C");
    /// ```
    pub fn either<T>(self, linear: T, rotary: T) -> T {
        if self.is_rotary() { rotary } else { linear }
    }

    /// What sentences call its quantities and parts.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// assert_eq!(MotionKind::Linear.words().force, "force");
    /// assert_eq!(MotionKind::Rotary.words().force, "torque");
    /// ```
    pub fn words(self) -> &'static MotionWords {
        self.either(&LINEAR_WORDS, &ROTARY_WORDS)
    }

    /// Its symbols.
    ///
    /// # Example
    /// ```
    /// use phea_quantity::MotionKind;
    /// assert_eq!(MotionKind::Linear.symbols().stiffness, "K_H");
    /// assert_eq!(MotionKind::Rotary.symbols().stiffness, "K_θ");
    /// ```
    pub fn symbols(self) -> &'static MotionSymbols {
        self.either(&LINEAR_SYMBOLS, &ROTARY_SYMBOLS)
    }
}
