use phea_dynamics::scalar::Scalar;

use crate::contact::Contact;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Load on the force sensor. Units: kg, N/m, N s/m, m.
///
/// Each has a ground, whose position x_0 in m and velocity v_0 in m/s are the two inputs of the
/// machine.
///
/// ```text
/// prescribed motion      x_L = x_0                                           thesis (4.45): the load does not yield
/// spring, mass, damper   m dv_L/dt = F_e + F_x - k (x_L - x_0) - c (v_L - v_0)     relaxed on its ground
/// wall                   m dv_L/dt = F_e + F_x - F_wall - c (v_L - v_0)            F_wall(d = x_L - x_0 - gap), see Contact
/// ```
///
/// F_x is an external force in N, positive in the direction of positive position; it is an input of
/// a machine that has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LoadModel<S = f64> {
    /// The load moves with its ground. The stiffness of the sensor is that in series with the
    /// environment.
    #[default]
    Prescribed,
    /// Mass on a spring. The stiffness of the sensor is that of the load cell only.
    SpringMassDamper {
        /// Mass m of all parts that move beyond the load cell, kg.
        mass: S,
        /// Stiffness k, N/m.
        stiffness: S,
        /// Damping c, N s/m.
        damping: S,
    },
    /// Mass guided towards a wall.
    Wall {
        /// Mass m of all parts that move beyond the load cell, kg.
        mass: S,
        /// Damping c of its guide, N s/m.
        damping: S,
        /// Distance that x_L - x_0 covers before contact, m.
        gap: S,
        /// Wall contact.
        contact: Contact<S>,
    },
}

/// Position and velocity of the load or of its ground. Units: m, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<S = f64> {
    /// Position, m.
    pub position: S,
    /// Velocity, m/s.
    pub velocity: S,
}

impl LoadModel {
    /// Impossible parameters of this load; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        match *self {
            LoadModel::Prescribed => {}
            LoadModel::SpringMassDamper { mass, stiffness, damping } => {
                problems.positive("mass", mass);
                problems.not_negative("stiffness", stiffness);
                problems.not_negative("damping", damping);
            }
            LoadModel::Wall { mass, damping, gap, contact } => {
                problems.positive("mass", mass);
                problems.not_negative("damping", damping);
                problems.require("gap", gap, true, ParameterRequirement::FiniteNumber);
                problems.component("contact", contact.problems());
            }
        }
        problems.into_vec()
    }
}

phea_dynamics::parameters! {
    LoadModel = LoadModel::Prescribed
        | LoadModel::SpringMassDamper { mass, stiffness, damping }
        | LoadModel::Wall { mass, damping, gap, contact }
}

impl<S: Copy> LoadModel<S> {
    /// True if the load's position and velocity are states.
    pub fn moves(&self) -> bool {
        !matches!(self, LoadModel::Prescribed)
    }

    /// Mass that can move, kg.
    pub fn mass(&self) -> Option<S> {
        match *self {
            LoadModel::Prescribed => None,
            LoadModel::SpringMassDamper { mass, .. } | LoadModel::Wall { mass, .. } => Some(mass),
        }
    }
}

impl<S: Scalar> LoadModel<S> {
    /// Acceleration of the load in m/s2 under the sum of sensor and external forces in N; zero for
    /// a prescribed motion, which does not yield.
    #[inline(always)]
    pub fn acceleration(&self, pushing: S, load: &Motion<S>, ground: &Motion<S>) -> S {
        let relative = relative(load, ground);
        match self {
            LoadModel::Prescribed => S::from(0.0),
            LoadModel::SpringMassDamper { mass, stiffness, damping } => {
                (pushing - *stiffness * relative.position - *damping * relative.velocity) / *mass
            }
            LoadModel::Wall { mass, damping, gap, contact } => {
                let pressed = contact.force(relative.position - *gap, relative.velocity);
                (pushing - pressed - *damping * relative.velocity) / *mass
            }
        }
    }

    /// Energy of the load in J, power that its ground takes from it in W, and its dissipation in W.
    pub(super) fn powers(&self, load: &Motion<S>, ground: &Motion<S>) -> [S; 3] {
        let (zero, half) = (S::from(0.0), S::from(0.5));
        let relative = relative(load, ground);
        match self {
            LoadModel::Prescribed => [zero; 3],
            LoadModel::SpringMassDamper { mass, stiffness, damping } => {
                let held = *stiffness * relative.position + *damping * relative.velocity;
                let stored = *mass * load.velocity.squared() + *stiffness * relative.position.squared();
                [half * stored, held * ground.velocity, *damping * relative.velocity.squared()]
            }
            LoadModel::Wall { mass, damping, gap, contact } => {
                let penetration = relative.position - *gap;
                let held = contact.force(penetration, relative.velocity) + *damping * relative.velocity;
                [
                    half * *mass * load.velocity.squared() + contact.stored_energy(penetration),
                    held * ground.velocity,
                    *damping * relative.velocity.squared()
                        + contact.dissipated(penetration, relative.velocity),
                ]
            }
        }
    }

    /// Remaining gap, m; negative in contact. One metre for loads without a wall.
    pub fn clearance(&self, load: &Motion<S>, ground: &Motion<S>) -> S {
        match self {
            LoadModel::Wall { gap, .. } => *gap - relative(load, ground).position,
            _ => S::from(1.0),
        }
    }
}

/// Motion of the load relative to its ground.
#[inline(always)]
fn relative<S: Scalar>(load: &Motion<S>, ground: &Motion<S>) -> Motion<S> {
    Motion { position: load.position - ground.position, velocity: load.velocity - ground.velocity }
}
