//! Friction of a cylinder or a motor from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredFriction, RetractingFriction};
use super::{Friction, FrictionLevels};

impl<S: Scalar> DeclaredFriction<S> {
    /// Friction with the levels of retraction that it states, and otherwise those of extension.
    pub fn component(&self) -> Friction<S> {
        let mut law = self.law;
        if let Some(curve) = law.curve_mut() {
            curve.retracting = self.retracting.map(|back| back.levels(curve.extending()));
        }
        law
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
