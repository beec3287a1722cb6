//! Friction of the piston and rods: viscous, Stribeck or LuGre, and the one slope a linear model
//! can keep of it.

mod lugre;
mod moving;
mod stribeck;
mod tested;

pub use lugre::{LuGre, LuGrePassivity};
pub use moving::{FrictionForce, MovingFriction};
pub use stribeck::{Stribeck, StribeckShape};
pub use tested::{
    FRICTION_COEFFICIENTS, KnottedForce, PressedMass, SLIDING_VARIABLES, SensitiveDisplacement, SlidBlock,
};

use phea_dynamics::scalar::{Dual, Scalar};

use crate::parameter::{ParameterError, Problems};

/// A friction force that opposes the motion. Units: N, N s/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction<S = f64> {
    /// F = f_v v.
    Viscous {
        /// Viscous coefficient f_v in N s/m.
        viscous: S,
    },
    /// The steady curve alone, a jump at zero velocity included.
    Stribeck(Stribeck<S>),
    /// Bristles: the steady curve with a spring-like start.
    LuGre(LuGre<S>),
}

/// Which slope dF/dv stands for the friction in a linear model. Friction has none at zero velocity
/// that is right for every purpose, so the choice is explicit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViscousSlope {
    /// The viscous part alone, sigma_2: right when sliding fast; the least damping.
    Viscous,
    /// Steady force over velocity, F(v)/v, at this speed in m/s: the coefficient of an equivalent
    /// damper.
    Secant(f64),
    /// Slope of the steady curve at this speed in m/s; negative on the falling part of the Stribeck
    /// curve.
    Tangent(f64),
    /// Bristles stuck: sigma_1 + sigma_2 (LuGre alone; their spring sigma_0 has no place in a
    /// viscous coefficient).
    Sticking,
}

impl<S: Copy> Friction<S> {
    /// Viscous coefficient f_v in N s/m: the slope of the curve where it no longer falls.
    pub fn viscous(&self) -> S {
        match self {
            Friction::Viscous { viscous } => *viscous,
            Friction::Stribeck(curve) => curve.viscous,
            Friction::LuGre(lugre) => lugre.curve.viscous,
        }
    }
}

impl Friction {
    /// Impossible parameters of this friction; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        match self {
            Friction::Viscous { viscous } => {
                let mut problems = Problems::default();
                problems.not_negative("viscous", *viscous);
                problems.into_vec()
            }
            Friction::Stribeck(curve) => curve.problems(),
            Friction::LuGre(lugre) => lugre.problems(),
        }
    }

    /// Force in N at a steady velocity in m/s: thesis (4.33).
    pub fn steady_force<S: Scalar>(&self, velocity: S) -> S {
        match self {
            Friction::Viscous { viscous } => S::from(*viscous) * velocity,
            Friction::Stribeck(curve) => curve.convert(&mut S::from).steady_force(velocity),
            Friction::LuGre(lugre) => lugre.curve.convert(&mut S::from).steady_force(velocity),
        }
    }

    /// Viscous friction coefficient f_v in N s/m for a linear model, as chosen; `None` where the
    /// choice has no value (a secant through zero velocity, sticking without bristles).
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::{Friction, Stribeck, ViscousSlope};
    /// let friction = Friction::Stribeck(Stribeck {
    ///     coulomb: 80.0, static_friction: 120.0, stribeck_velocity: 0.01, stribeck_exponent: 2.0, viscous: 100.0,
    /// });
    /// assert_eq!(friction.viscous_slope(ViscousSlope::Viscous), Some(100.0));
    /// assert_eq!(friction.viscous_slope(ViscousSlope::Secant(1.0)), Some(180.0));
    /// assert!(friction.viscous_slope(ViscousSlope::Tangent(0.005)).unwrap() < 0.0);
    /// assert_eq!(friction.viscous_slope(ViscousSlope::Sticking), None);
    /// ```
    pub fn viscous_slope(&self, choice: ViscousSlope) -> Option<f64> {
        match (choice, self) {
            (ViscousSlope::Viscous, _) => Some(self.viscous()),
            (ViscousSlope::Secant(speed), _) => (speed != 0.0).then(|| self.steady_force(speed) / speed),
            (ViscousSlope::Tangent(speed), _) => {
                Some(self.steady_force(Dual::<1>::variable(speed, 0)).gradient()[0])
            }
            (ViscousSlope::Sticking, Friction::Viscous { viscous }) => Some(*viscous),
            (ViscousSlope::Sticking, Friction::LuGre(lugre)) => {
                Some(lugre.bristle_damping + lugre.curve.viscous)
            }
            (ViscousSlope::Sticking, Friction::Stribeck(_)) => None,
        }
    }
}
