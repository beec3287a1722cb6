//! `[force_sensor]` and `[load]`.

use super::key::{key, plain};
use super::visitor::{Variants, Visitor};
use phea_quantity::{DAMPING, FORCE, INVERSE_VELOCITY, LENGTH, MASS, STIFFNESS};

/// The load cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredForceSensor {
    /// N/m, K_S: the cell in series with its environment when the load is a prescribed motion.
    pub stiffness: f64,
    /// N, root mean square of the white noise that a sampled controller sees.
    pub noise: f64,
    /// N, the largest force that it tolerates, in both directions.
    pub capacity: Option<f64>,
}

impl DeclaredForceSensor {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("stiffness", &STIFFNESS, "K_S: with a prescribed load motion, of cell and environment.");
        v.quantity(k.positive(), &mut self.stiffness);
        let k =
            key("noise", &FORCE, "Root mean square of the white noise in what a sampled controller sees.");
        v.quantity(k.not_negative().or(0.0), &mut self.noise);
        let k = key("capacity", &FORCE, "The force that it survives, in both directions.").positive();
        v.optional(k, &mut self.capacity);
    }
}

/// What the force acts on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Load {
    /// It moves as the scenario states, whatever the force.
    #[default]
    Prescribed,
    /// Mass, spring and damper.
    SpringMassDamper {
        /// kg.
        mass: f64,
        /// N/m.
        stiffness: f64,
        /// N·s/m.
        damping: f64,
    },
    /// A guided mass; nothing up to the gap, then the wall.
    Wall {
        /// kg; needed only for a load that moves freely.
        mass: Option<f64>,
        /// N·s/m, of its guide.
        damping: f64,
        /// N/m, of the wall.
        stiffness: f64,
        /// m, free play before the wall is touched.
        gap: f64,
        /// s/m, damping of the wall relative to its elastic force.
        relative_damping: f64,
    },
}

impl Load {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.variant(plain("model", "Which load."), self, false);
    }
}

impl Variants for Load {
    fn all(&self) -> Vec<Load> {
        let (damping, stiffness) = (0.0, 0.0);
        vec![
            Load::Prescribed,
            Load::SpringMassDamper { mass: 0.0, stiffness, damping },
            Load::Wall { mass: None, damping, stiffness, gap: 0.0, relative_damping: 0.0 },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            Load::Prescribed => "prescribed",
            Load::SpringMassDamper { .. } => "spring_mass_damper",
            Load::Wall { .. } => "wall",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let kilograms = key("mass", &MASS, "Mass of the load.").positive();
        let spring = key("stiffness", &STIFFNESS, "Stiffness of the load or of the wall.").positive();
        let damper = key("damping", &DAMPING, "Damping of the load or of its guide.").not_negative().or(0.0);
        match self {
            Load::Prescribed => {}
            Load::SpringMassDamper { mass, stiffness, damping } => {
                v.quantity(kilograms, mass);
                v.quantity(spring, stiffness);
                v.quantity(damper, damping);
            }
            Load::Wall { mass, damping, stiffness, gap, relative_damping } => {
                v.optional(kilograms, mass);
                v.quantity(spring, stiffness);
                v.quantity(damper, damping);
                let k = key("gap", &LENGTH, "Free play before the wall is touched.").not_negative();
                v.quantity(k.or(0.0), gap);
                let k = key(
                    "relative_damping",
                    &INVERSE_VELOCITY,
                    "Damping of the wall relative to its elastic force.",
                );
                v.quantity(k.not_negative().or(0.0), relative_damping);
            }
        }
    }
}
