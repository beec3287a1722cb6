//! Friction of the piston and rods: viscous, Stribeck or LuGre, and the one slope that a linear
//! model uses.

mod checks;
mod component;
mod keys;
mod lugre;
mod moving;
mod stribeck;
mod tested;

pub use keys::{DeclaredFriction, RetractingFriction};
pub use lugre::{LuGre, LuGrePassivity};
pub use moving::{FrictionForce, MovingFriction};
pub use stribeck::{FrictionLevels, Stribeck, StribeckShape};
pub use tested::{
    FRICTION_COEFFICIENTS, KnottedForce, MultisineForce, MultisineShapes, PressedMass, SLIDING_VARIABLES,
    SensitiveDisplacement, SlidBlock, TRENDS, trends,
};

use crate::parameter::{ParameterError, Problems};

/// Friction force that opposes the motion. Units: N, N s/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction<S = f64> {
    /// Viscous force F = f_v v.
    Viscous {
        /// Viscous coefficient f_v, N s/m.
        viscous: S,
    },
    /// Steady curve, including its jump at zero velocity.
    Stribeck {
        /// Steady curve.
        curve: Stribeck<S>,
        /// Velocity v_r that smooths the jump in motion, m/s; without it nothing can be simulated.
        regular_velocity: Option<S>,
    },
    /// Bristles: the steady curve with a spring-like beginning.
    LuGre(LuGre<S>),
}

impl<S: Default> Default for Friction<S> {
    fn default() -> Self {
        Friction::Viscous { viscous: S::default() }
    }
}

impl<S> Friction<S> {
    /// Steady curve; `None` for viscous friction.
    pub fn curve(&self) -> Option<&Stribeck<S>> {
        match self {
            Friction::Viscous { .. } => None,
            Friction::Stribeck { curve, .. } | Friction::LuGre(LuGre { curve, .. }) => Some(curve),
        }
    }

    /// Steady curve, mutable.
    pub fn curve_mut(&mut self) -> Option<&mut Stribeck<S>> {
        match self {
            Friction::Viscous { .. } => None,
            Friction::Stribeck { curve, .. } | Friction::LuGre(LuGre { curve, .. }) => Some(curve),
        }
    }

    /// Viscous coefficient f_v, mutable.
    pub fn viscous_mut(&mut self) -> &mut S {
        match self {
            Friction::Viscous { viscous } => viscous,
            Friction::Stribeck { curve, .. } | Friction::LuGre(LuGre { curve, .. }) => &mut curve.viscous,
        }
    }
}

impl<S: Copy> Friction<S> {
    /// Viscous coefficient f_v: the slope of the curve beyond its falling part, for positive
    /// velocity, N s/m.
    pub fn viscous(&self) -> S {
        match self {
            Friction::Viscous { viscous } => *viscous,
            Friction::Stribeck { curve, .. } => curve.viscous,
            Friction::LuGre(lugre) => lugre.curve.viscous,
        }
    }
}

impl Friction {
    /// Viscous coefficients for positive and for negative velocity, N s/m.
    pub fn viscous_by_direction(&self) -> [f64; 2] {
        match self {
            Friction::Viscous { viscous } => [*viscous; 2],
            Friction::Stribeck { curve, .. } | Friction::LuGre(LuGre { curve, .. }) => {
                curve.both_levels().map(|levels| levels.viscous)
            }
        }
    }

    /// Impossible parameters of this friction; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        match self {
            Friction::Viscous { viscous } => {
                let mut problems = Problems::default();
                problems.key(keys::VISCOUS_KEY, *viscous);
                problems.into_vec()
            }
            Friction::Stribeck { curve, regular_velocity } => {
                let mut problems = Problems::default();
                problems.all(curve.problems());
                if let Some(velocity) = regular_velocity {
                    problems.key(keys::REGULAR_VELOCITY_KEY, *velocity);
                }
                problems.into_vec()
            }
            Friction::LuGre(lugre) => lugre.problems(),
        }
    }
}
