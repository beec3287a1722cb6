//! `[force_sensor]` and `[load]`.

use super::key::{key, plain};
use super::visitor::Visitor;
use crate::quantity::{DAMPING, FORCE, INVERSE_VELOCITY, LENGTH, MASS, STIFFNESS};

/// The load cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceSensor {
    /// N/m, K_S: the cell in series with its environment when the load is a prescribed motion.
    pub stiffness: f64,
    /// N, root mean square of the white noise that a sampled controller sees.
    pub noise: f64,
    /// N, the force that it survives, in both directions.
    pub capacity: Option<f64>,
}

impl ForceSensor {
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
pub struct Load {
    /// Which load.
    pub model: LoadModel,
    /// kg.
    pub mass: Option<f64>,
    /// N/m.
    pub stiffness: Option<f64>,
    /// N·s/m.
    pub damping: Option<f64>,
    /// m, free play before a wall is touched.
    pub gap: Option<f64>,
    /// s/m, damping of the wall relative to its elastic force.
    pub relative_damping: f64,
}

/// Which load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadModel {
    /// It moves as the scenario says, whatever the force.
    #[default]
    Prescribed,
    /// Mass, spring and damper.
    SpringMassDamper,
    /// A guided mass; nothing up to the gap, then the wall.
    Wall,
}

impl Load {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[
            ("prescribed", LoadModel::Prescribed),
            ("spring_mass_damper", LoadModel::SpringMassDamper),
            ("wall", LoadModel::Wall),
        ];
        v.choice(plain("model", "Which load."), words, &mut self.model, false);
        v.optional(key("mass", &MASS, "Mass of the load.").positive(), &mut self.mass);
        v.optional(
            key("stiffness", &STIFFNESS, "Stiffness of the load or of the wall.").positive(),
            &mut self.stiffness,
        );
        v.optional(
            key("damping", &DAMPING, "Damping of the load or of its guide.").not_negative(),
            &mut self.damping,
        );
        let k = key("gap", &LENGTH, "Free play before the wall is touched.").not_negative();
        v.optional(k, &mut self.gap);
        let k =
            key("relative_damping", &INVERSE_VELOCITY, "Damping of the wall relative to its elastic force.");
        v.quantity(k.not_negative().or(0.0), &mut self.relative_damping);
    }
}
