//! Friction of a cylinder or a motor from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredFriction, FrictionLaw, RetractingFriction, StribeckCurve};
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
            retracting: self.retracting.map(|back| back.levels(self.levels(curve))),
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

    /// Levels in extension, with a curve over velocity.
    pub(super) fn levels(&self, curve: &StribeckCurve<S>) -> FrictionLevels<S> {
        FrictionLevels {
            coulomb: curve.coulomb,
            static_friction: curve.static_friction,
            viscous: self.viscous,
        }
    }
}

impl<S: Scalar> RetractingFriction<S> {
    /// Levels in retraction; those that are not stated are the levels in extension.
    pub(super) fn levels(&self, extending: FrictionLevels<S>) -> FrictionLevels<S> {
        FrictionLevels {
            coulomb: self.coulomb.unwrap_or(extending.coulomb),
            static_friction: self.static_friction.unwrap_or(extending.static_friction),
            viscous: self.viscous.unwrap_or(extending.viscous),
        }
    }
}
