use phea_dynamics::scalar::Scalar;

use crate::contact::Contact;
use crate::load::Load;

/// Position and velocity of the load or of its ground. Units: m, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion<S = f64> {
    /// Position, m.
    pub position: S,
    /// Velocity, m/s.
    pub velocity: S,
}

impl<S: Scalar> Load<S> {
    /// Acceleration of the load in m/s2 under the sum of sensor and external forces in N; zero for
    /// a prescribed motion, which does not yield.
    #[inline(always)]
    pub fn acceleration(&self, pushing: S, load: &Motion<S>, ground: &Motion<S>) -> S {
        let relative = relative(load, ground);
        match *self {
            Load::SpringMassDamper { mass, stiffness, damping } => {
                (pushing - stiffness * relative.position - damping * relative.velocity) / mass
            }
            Load::Wall { mass: Some(mass), damping, stiffness, gap, relative_damping } => {
                let wall = Contact { stiffness, relative_damping };
                let pressed = wall.force(relative.position - gap, relative.velocity);
                (pushing - pressed - damping * relative.velocity) / mass
            }
            Load::Prescribed | Load::Wall { mass: None, .. } => S::from(0.0),
        }
    }

    /// Energy of the load in J, power that its ground takes from it in W, and its dissipation in W.
    pub(super) fn powers(&self, load: &Motion<S>, ground: &Motion<S>) -> [S; 3] {
        let (zero, half) = (S::from(0.0), S::from(0.5));
        let relative = relative(load, ground);
        match *self {
            Load::SpringMassDamper { mass, stiffness, damping } => {
                let held = stiffness * relative.position + damping * relative.velocity;
                let stored = mass * load.velocity.squared() + stiffness * relative.position.squared();
                [half * stored, held * ground.velocity, damping * relative.velocity.squared()]
            }
            Load::Wall { mass: Some(mass), damping, stiffness, gap, relative_damping } => {
                let wall = Contact { stiffness, relative_damping };
                let penetration = relative.position - gap;
                let held = wall.force(penetration, relative.velocity) + damping * relative.velocity;
                [
                    half * mass * load.velocity.squared() + wall.stored_energy(penetration),
                    held * ground.velocity,
                    damping * relative.velocity.squared() + wall.dissipated(penetration, relative.velocity),
                ]
            }
            Load::Prescribed | Load::Wall { mass: None, .. } => [zero; 3],
        }
    }

    /// Remaining gap, m; negative in contact. One metre for loads without a wall.
    pub fn clearance(&self, load: &Motion<S>, ground: &Motion<S>) -> S {
        match self {
            Load::Wall { gap, .. } => *gap - relative(load, ground).position,
            _ => S::from(1.0),
        }
    }
}

/// Motion of the load relative to its ground.
#[inline(always)]
fn relative<S: Scalar>(load: &Motion<S>, ground: &Motion<S>) -> Motion<S> {
    Motion { position: load.position - ground.position, velocity: load.velocity - ground.velocity }
}
