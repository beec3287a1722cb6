//! Friction as tests on a rig show it: while the piston slides at a constant velocity, and while a
//! force presses it that does not yet break it away.

mod multisine;
mod pressed;
mod sliding;

pub use multisine::{MultisineForce, MultisineShapes, TRENDS, trends};
pub use pressed::{KnottedForce, PressedMass, SensitiveDisplacement};
pub use sliding::{SLIDING_VARIABLES, SlidBlock};

use super::{LuGre, Stribeck};

/// Number of coefficients of LuGre friction.
pub const FRICTION_COEFFICIENTS: usize = 7;

impl<S: Copy> LuGre<S> {
    /// F_C, F_S, v_S, alpha, sigma_2, sigma_0, sigma_1.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::LuGre;
    /// let numbers = [80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3];
    /// let lugre = LuGre::from_array(numbers);
    /// assert_eq!((lugre.curve.static_friction, lugre.bristle_damping), (120.0, 2e3));
    /// assert_eq!(lugre.to_array(), numbers);
    /// ```
    pub fn to_array(&self) -> [S; FRICTION_COEFFICIENTS] {
        let Stribeck { coulomb, static_friction, stribeck_velocity, stribeck_exponent, viscous } = self.curve;
        [
            coulomb,
            static_friction,
            stribeck_velocity,
            stribeck_exponent,
            viscous,
            self.bristle_stiffness,
            self.bristle_damping,
        ]
    }

    /// The friction of these coefficients, in the order of [`LuGre::to_array`].
    pub fn from_array(numbers: [S; FRICTION_COEFFICIENTS]) -> LuGre<S> {
        let [
            coulomb,
            static_friction,
            stribeck_velocity,
            stribeck_exponent,
            viscous,
            bristle_stiffness,
            bristle_damping,
        ] = numbers;
        let curve = Stribeck { coulomb, static_friction, stribeck_velocity, stribeck_exponent, viscous };
        LuGre { curve, bristle_stiffness, bristle_damping }
    }
}
