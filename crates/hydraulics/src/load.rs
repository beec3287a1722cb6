//! Load on the force sensor: a prescribed motion, a mass on a spring, or a mass in front of a wall.

mod keys;

use crate::contact::Contact;
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Load on the force sensor. Units: kg, N/m, N s/m, m, s/m.
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
pub enum Load<S = f64> {
    /// The load moves with its ground, for any force. The stiffness of the sensor is that in series
    /// with the environment.
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
        /// Mass m of all parts that move beyond the load cell, kg; without it nothing can be
        /// simulated.
        mass: Option<S>,
        /// Damping c of its guide, N s/m.
        damping: S,
        /// Stiffness of the wall, N/m.
        stiffness: S,
        /// Distance that x_L - x_0 covers before contact, m.
        gap: S,
        /// Damping of the wall relative to its elastic force, s/m.
        relative_damping: S,
    },
}

impl Load {
    /// Impossible parameters of this load; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        match *self {
            Load::Prescribed => {}
            Load::SpringMassDamper { mass, stiffness, damping } => {
                problems.key(keys::MASS_KEY, mass);
                problems.key(keys::STIFFNESS_KEY, stiffness);
                problems.key(keys::DAMPING_KEY, damping);
            }
            Load::Wall { mass, damping, gap, .. } => {
                if let Some(mass) = mass {
                    problems.key(keys::MASS_KEY, mass);
                }
                problems.key(keys::DAMPING_KEY, damping);
                problems.require("gap", gap, true, ParameterRequirement::FiniteNumber);
                problems.all(self.wall().map_or(Vec::new(), |wall| wall.problems()));
            }
        }
        problems.into_vec()
    }
}

phea_dynamics::parameters! {
    Load = Load::Prescribed
        | Load::SpringMassDamper { mass, stiffness, damping }
        | Load::Wall { mass, damping, stiffness, gap, relative_damping }
}

impl<S: Copy> Load<S> {
    /// True if the load's position and velocity are states.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::load::Load;
    /// assert!(Load::SpringMassDamper { mass: 5.0, stiffness: 0.0, damping: 10.0 }.moves());
    /// assert!(!Load::<f64>::Prescribed.moves());
    /// ```
    pub fn moves(&self) -> bool {
        self.mass().is_some()
    }

    /// Mass that can move, kg.
    pub fn mass(&self) -> Option<S> {
        match *self {
            Load::Prescribed => None,
            Load::SpringMassDamper { mass, .. } => Some(mass),
            Load::Wall { mass, .. } => mass,
        }
    }

    /// Surface of its wall; `None` for loads without one.
    #[inline(always)]
    pub fn wall(&self) -> Option<Contact<S>> {
        match *self {
            Load::Prescribed | Load::SpringMassDamper { .. } => None,
            Load::Wall { stiffness, relative_damping, .. } => Some(Contact { stiffness, relative_damping }),
        }
    }
}
