//! The declared friction of a cylinder or a motor, over any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::friction::{Friction, FrictionLevels, LuGre, Stribeck};

use crate::project::{self, FrictionLaw, StribeckCurve};

/// Declared friction; none without a declaration.
pub(super) fn friction<S: Scalar>(declared: Option<&project::DeclaredFriction<S>>) -> Friction<S> {
    let Some(declared) = declared else { return Friction::Viscous { viscous: S::from(0.0) } };
    let viscous = declared.viscous;
    let stribeck = |curve: &StribeckCurve<S>| Stribeck {
        coulomb: curve.coulomb,
        static_friction: curve.static_friction,
        stribeck_velocity: curve.stribeck_velocity,
        stribeck_exponent: curve.stribeck_exponent,
        viscous,
        retracting: declared.retracting.map(|back| FrictionLevels {
            coulomb: back.coulomb.unwrap_or(curve.coulomb),
            static_friction: back.static_friction.unwrap_or(curve.static_friction),
            viscous: back.viscous.unwrap_or(viscous),
        }),
    };
    match &declared.law {
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
