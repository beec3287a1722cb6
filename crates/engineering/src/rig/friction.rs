//! The declared friction of a cylinder or a motor, over any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::friction::{Friction, FrictionLevels, LuGre, Stribeck};

use super::numbers::Numbers;
use crate::project::{self, FrictionLaw, StribeckCurve};

/// Friction declared in the part that `numbers` are within; without one, none.
pub(super) fn friction<S: Scalar>(
    declared: Option<&project::DeclaredFriction>,
    numbers: &Numbers<'_, S>,
) -> Friction<S> {
    let Some(declared) = declared else { return Friction::Viscous { viscous: S::from(0.0) } };
    let numbers = numbers.within("friction");
    let at = |key: &str, value: f64| numbers.at(key, value);
    let viscous = at("viscous", declared.viscous);
    let stribeck = |curve: &StribeckCurve| Stribeck {
        coulomb: at("coulomb", curve.coulomb),
        static_friction: at("static", curve.static_friction),
        stribeck_velocity: at("stribeck_velocity", curve.stribeck_velocity),
        stribeck_exponent: at("stribeck_exponent", curve.stribeck_exponent),
        viscous,
        retracting: declared.retracting.map(|back| {
            let numbers = numbers.within("retracting");
            let or = |key: &str, own: Option<f64>, extending: S| {
                own.map_or(extending, |value| numbers.at(key, value))
            };
            FrictionLevels {
                coulomb: or("coulomb", back.coulomb, at("coulomb", curve.coulomb)),
                static_friction: or("static", back.static_friction, at("static", curve.static_friction)),
                viscous: or("viscous", back.viscous, viscous),
            }
        }),
    };
    match &declared.law {
        FrictionLaw::Viscous => Friction::Viscous { viscous },
        FrictionLaw::Stribeck { curve, regular_velocity } => Friction::Stribeck {
            curve: stribeck(curve),
            regular_velocity: regular_velocity.map(|velocity| at("regular_velocity", velocity)),
        },
        FrictionLaw::LuGre { curve, bristle_stiffness, bristle_damping } => Friction::LuGre(LuGre {
            curve: stribeck(curve),
            bristle_stiffness: at("bristle_stiffness", *bristle_stiffness),
            bristle_damping: at("bristle_damping", *bristle_damping),
        }),
    }
}
