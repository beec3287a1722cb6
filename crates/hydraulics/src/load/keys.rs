//! Table `[load]`.

use phea_quantity::{DAMPING, INVERSE_VELOCITY, LENGTH, MASS, STIFFNESS};
use phea_table::{Key, TableNumber, Variants, Visitor, key, plain};

use super::Load;

pub(super) const MASS_KEY: Key = key("mass", &MASS, "Mass of the load.").of_load().positive();
/// Zero for a free mass.
pub(super) const STIFFNESS_KEY: Key =
    key("stiffness", &STIFFNESS, "Stiffness of the load or of the wall.").of_load().not_negative();
pub(super) const DAMPING_KEY: Key =
    key("damping", &DAMPING, "Damping of the load or of its guide.").of_load().not_negative().or(0.0);

impl<S: TableNumber> Load<S> {
    /// Visits the table of the load.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("model", "Which load."), self, false);
    }
}

impl<S: TableNumber> Variants<S> for Load<S> {
    fn all(&self) -> Vec<Load<S>> {
        let (damping, stiffness) = (S::default(), S::default());
        vec![
            Load::Prescribed,
            Load::SpringMassDamper { mass: S::default(), stiffness, damping },
            Load::Wall { mass: None, damping, stiffness, gap: S::default(), relative_damping: S::default() },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            Load::Prescribed => "prescribed",
            Load::SpringMassDamper { .. } => "spring_mass_damper",
            Load::Wall { .. } => "wall",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            Load::Prescribed => {}
            Load::SpringMassDamper { mass, stiffness, damping } => {
                v.quantity(MASS_KEY, mass);
                v.quantity(STIFFNESS_KEY, stiffness);
                v.quantity(DAMPING_KEY, damping);
            }
            Load::Wall { mass, damping, stiffness, gap, relative_damping } => {
                v.optional(MASS_KEY, mass);
                v.quantity(STIFFNESS_KEY.positive(), stiffness);
                v.quantity(DAMPING_KEY, damping);
                let k = key("gap", &LENGTH, "Free play before the wall is touched.").of_load().not_negative();
                v.quantity(k.or(0.0), gap);
                let k = key(
                    "relative_damping",
                    &INVERSE_VELOCITY,
                    "Damping of the wall relative to its elastic force.",
                )
                .of_load();
                v.quantity(k.not_negative().or(0.0), relative_damping);
            }
        }
    }
}
