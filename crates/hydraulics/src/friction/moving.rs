use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

use super::{Friction, LuGre, Stribeck, StribeckShape};

/// Friction within equations of motion: every variant is smooth enough to be integrated, and knows
/// its own shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MovingFriction<S = f64> {
    /// Viscous force F = f_v v.
    Viscous {
        /// Viscous coefficient f_v, N s/m.
        viscous: S,
    },
    /// Steady curve with its jump at zero velocity smoothed: [`Stribeck::regular_force`].
    Stribeck {
        /// Steady curve.
        curve: Stribeck<S>,
        /// Evaluation of its exponent.
        shape: StribeckShape,
        /// Velocity v_r that smooths the jump, m/s.
        regular_velocity: S,
    },
    /// Bristles, with their deflection as a state.
    LuGre {
        /// LuGre model.
        lugre: LuGre<S>,
        /// Evaluation of the exponent of its curve.
        shape: StribeckShape,
    },
}

/// Friction at one instant. Units: N, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionForce<S> {
    /// Force that opposes the motion, N.
    pub force: S,
    /// Rate dz/dt of the bristles, m/s; zero for a model without bristles.
    pub bristle_rate: S,
}

impl MovingFriction {
    /// Friction that can be integrated; `None` for a static curve without the velocity that smooths
    /// its jump.
    pub fn new(friction: &Friction) -> Option<MovingFriction> {
        match *friction {
            Friction::Viscous { viscous } => Some(MovingFriction::Viscous { viscous }),
            Friction::Stribeck { curve, regular_velocity } => Some(MovingFriction::Stribeck {
                curve,
                shape: curve.shape(),
                regular_velocity: regular_velocity?,
            }),
            Friction::LuGre(lugre) => Some(MovingFriction::LuGre { lugre, shape: lugre.curve.shape() }),
        }
    }
}

phea_dynamics::parameters! {
    MovingFriction = MovingFriction::Viscous { viscous }
        | MovingFriction::Stribeck { curve, shape: kept, regular_velocity }
        | MovingFriction::LuGre { lugre, shape: kept }
}

impl<S: Copy> MovingFriction<S> {
    /// True if its bristles are a state.
    pub(crate) fn has_bristles(&self) -> bool {
        self.bristle_stiffness().is_some()
    }

    /// Stiffness sigma_0 of its bristles, N/m, if it has any.
    pub fn bristle_stiffness(&self) -> Option<S> {
        match self {
            MovingFriction::LuGre { lugre, .. } => Some(lugre.bristle_stiffness),
            _ => None,
        }
    }
}

/// Force in N and rate of the bristles in m/s, as functions of velocity and deflection.
impl<S: Scalar> LocalFunction<S, 2, 2> for MovingFriction<S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [velocity, bristle]: [T; 2], constant: impl Fn(S) -> T + Copy) -> [T; 2] {
        let FrictionForce { force, bristle_rate } =
            MovingFriction::at(&self.convert(&mut |parameter| constant(parameter)), velocity, bristle);
        [force, bristle_rate]
    }
}

impl<S: Scalar> MovingFriction<S> {
    /// Force and rate of the bristles at a velocity in m/s and a deflection of the bristles in m.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::{Friction, MovingFriction};
    /// let friction = MovingFriction::new(&Friction::Viscous { viscous: 100.0 }).unwrap();
    /// assert_eq!(friction.at(0.25, 0.0).force, 25.0);
    /// ```
    #[inline(always)]
    pub fn at(&self, velocity: S, bristle: S) -> FrictionForce<S> {
        let none = S::from(0.0);
        match self {
            MovingFriction::Viscous { viscous } => {
                FrictionForce { force: *viscous * velocity, bristle_rate: none }
            }
            MovingFriction::Stribeck { curve, shape, regular_velocity } => FrictionForce {
                force: curve.regular_force(*shape, velocity, *regular_velocity),
                bristle_rate: none,
            },
            MovingFriction::LuGre { lugre, shape } => {
                let (force, bristle_rate) = lugre.force_and_rate(*shape, velocity, bristle);
                FrictionForce { force, bristle_rate }
            }
        }
    }

    /// Energy sigma_0 z^2/2 of the bristles, J.
    pub(crate) fn stored_energy(&self, bristle: S) -> S {
        match self {
            MovingFriction::LuGre { lugre, .. } => S::from(0.5) * lugre.bristle_stiffness * bristle.squared(),
            _ => S::from(0.0),
        }
    }

    /// Power that friction turns into heat: the power of the motion less the rate of the energy in
    /// the bristles, W.
    ///
    /// ```text
    /// F v - sigma_0 z dz/dt = sigma_0^2 |v| z^2/g(v) + sigma_1 v dz/dt + sigma_2 v^2              LuGre
    /// ```
    ///
    /// Never negative, except for LuGre outside [`super::LuGre::passivity`].
    pub(crate) fn dissipated(&self, velocity: S, bristle: S) -> S {
        let FrictionForce { force, bristle_rate } = self.at(velocity, bristle);
        match self {
            MovingFriction::LuGre { lugre, shape } => {
                let spring = lugre.bristle_stiffness * bristle;
                let sliding = lugre.curve.sliding_force_of(*shape, velocity);
                spring.squared() * velocity.abs() / sliding
                    + lugre.bristle_damping * velocity * bristle_rate
                    + lugre.curve.levels(velocity).viscous * velocity.squared()
            }
            _ => force * velocity,
        }
    }
}
