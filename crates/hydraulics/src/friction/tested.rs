//! Friction from tests on a rig: sliding of the piston at constant velocities, and a force that
//! presses it without breaking it away.

mod multisine;
mod pressed;
mod sliding;

pub use multisine::{MultisineForce, MultisineShapes, TRENDS, trends};
pub use pressed::{KnottedForce, PressedMass, SensitiveDisplacement};
pub use sliding::{SLIDING_VARIABLES, SlidBlock};

use super::{FrictionLevels, LuGre, Stribeck};

/// Number of coefficients of LuGre friction, including the levels of the other direction.
pub const FRICTION_COEFFICIENTS: usize = 10;

impl<S: Copy> LuGre<S> {
    /// Coefficients F_C, F_S, v_S, alpha, sigma_2, sigma_0, sigma_1; then F_C, F_S and sigma_2 of
    /// negative velocity.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::friction::LuGre;
    /// let numbers = [80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3, 90.0, 150.0, 110.0];
    /// let lugre = LuGre::from_array(numbers);
    /// assert_eq!((lugre.curve.static_friction, lugre.bristle_damping), (120.0, 2e3));
    /// assert_eq!(lugre.to_array(), numbers);
    /// let same = LuGre::same_both_ways([80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3]);
    /// assert_eq!(same.to_array()[7..], [80.0, 120.0, 100.0]);
    /// ```
    pub fn to_array(&self) -> [S; FRICTION_COEFFICIENTS] {
        let Stribeck { coulomb, static_friction, viscous, .. } = self.curve;
        let extending = FrictionLevels { coulomb, static_friction, viscous };
        let back = self.curve.retracting.unwrap_or(extending);
        [
            coulomb,
            static_friction,
            self.curve.stribeck_velocity,
            self.curve.stribeck_exponent,
            viscous,
            self.bristle_stiffness,
            self.bristle_damping,
            back.coulomb,
            back.static_friction,
            back.viscous,
        ]
    }

    /// Friction with these coefficients, in the order of [`LuGre::to_array`].
    pub fn from_array(numbers: [S; FRICTION_COEFFICIENTS]) -> LuGre<S> {
        let [both @ .., coulomb, static_friction, viscous] = numbers;
        let LuGre { curve, bristle_stiffness, bristle_damping } = LuGre::same_both_ways(both);
        let retracting = Some(FrictionLevels { coulomb, static_friction, viscous });
        LuGre { curve: Stribeck { retracting, ..curve }, bristle_stiffness, bristle_damping }
    }

    /// Friction with the first seven of these coefficients, equal in both directions.
    pub fn same_both_ways(numbers: [S; 7]) -> LuGre<S> {
        let [
            coulomb,
            static_friction,
            stribeck_velocity,
            stribeck_exponent,
            viscous,
            bristle_stiffness,
            bristle_damping,
        ] = numbers;
        let curve = Stribeck {
            coulomb,
            static_friction,
            stribeck_velocity,
            stribeck_exponent,
            viscous,
            retracting: None,
        };
        LuGre { curve, bristle_stiffness, bristle_damping }
    }
}
