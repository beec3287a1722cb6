//! Friction of a cylinder or a motor from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredFriction, FrictionLaw, StribeckCurve};
use super::{Friction, FrictionLevels, LuGre, Stribeck};

impl<S: Scalar> DeclaredFriction<S> {
    /// Friction with the levels of retraction that it states, and otherwise those of extension.
    pub fn component(&self) -> Friction<S> {
        let viscous = self.viscous;
        let stribeck = |curve: &StribeckCurve<S>| Stribeck {
            coulomb: curve.coulomb,
            static_friction: curve.static_friction,
            stribeck_velocity: curve.stribeck_velocity,
            stribeck_exponent: curve.stribeck_exponent,
            viscous,
            retracting: self.retracting.map(|back| FrictionLevels {
                coulomb: back.coulomb.unwrap_or(curve.coulomb),
                static_friction: back.static_friction.unwrap_or(curve.static_friction),
                viscous: back.viscous.unwrap_or(viscous),
            }),
        };
        match &self.law {
            FrictionLaw::Viscous => Friction::Viscous { viscous },
            FrictionLaw::Stribeck { curve, regular_velocity } => {
                Friction::Stribeck { curve: stribeck(curve), regular_velocity: *regular_velocity }
            }
            FrictionLaw::LuGre { curve, bristle_stiffness, bristle_damping } => Friction::LuGre(LuGre {
                curve: stribeck(curve),
                bristle_stiffness: *bristle_stiffness,
                bristle_damping: *bristle_damping,
            }),
        }
    }
}
