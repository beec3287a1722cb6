//! The declared load, over any scalar.

use phea_dynamics::scalar::Scalar;

use super::numbers::Numbers;
use crate::project::Load;

/// Load declared in the table `[load]`.
pub(super) fn load<S: Scalar>(declared: &Load, numbers: &Numbers<'_, S>) -> Load<S> {
    let numbers = numbers.within("load");
    let at = |key: &str, value: f64| numbers.at(key, value);
    match *declared {
        Load::Prescribed => Load::Prescribed,
        Load::SpringMassDamper { mass, stiffness, damping } => Load::SpringMassDamper {
            mass: at("mass", mass),
            stiffness: at("stiffness", stiffness),
            damping: at("damping", damping),
        },
        Load::Wall { mass, damping, stiffness, gap, relative_damping } => Load::Wall {
            mass: mass.map(|mass| at("mass", mass)),
            damping: at("damping", damping),
            stiffness: at("stiffness", stiffness),
            gap: at("gap", gap),
            relative_damping: at("relative_damping", relative_damping),
        },
    }
}
