//! Words and symbols of linear motion, and those of rotary motion.

use super::MotionKind;

/// Words for the quantities and parts of a rig, in sentences, headings and axes.
#[derive(Clone, Copy, Debug)]
pub struct MotionWords {
    /// Force or torque.
    pub force: &'static str,
    /// Its plural.
    pub forces: &'static str,
    /// Position or angle.
    pub position: &'static str,
    /// Its plural.
    pub positions: &'static str,
    /// Mass or inertia.
    pub mass: &'static str,
    /// Piston or shaft, as the moving part of the actuator.
    pub piston: &'static str,
    /// Rod or shaft, as the end that the load is on.
    pub rod: &'static str,
    /// Cylinder or motor.
    pub cylinder: &'static str,
    /// Load cell or torque sensor, as a product.
    pub load_cell: &'static str,
    /// Force sensor or torque sensor, as the declared part of the rig.
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
    /// Hydraulic stiffness.
    pub stiffness: &'static str,
    /// Mass or inertia.
    pub mass: &'static str,
    /// Position of the piston, angle of the shaft.
    pub position: &'static str,
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
    stiffness: "K_H",
    mass: "M",
    position: "x_p",
    impedance: "-F_e/(s X_L)",
};

static ROTARY_SYMBOLS: MotionSymbols = MotionSymbols {
    measured: "T_e",
    hydraulic: "T_H",
    reference: "T_ref",
    stiffness: "K_θ",
    mass: "J",
    position: "θ",
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

    /// Words for its quantities and parts.
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
