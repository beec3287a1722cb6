//! Tables `[cylinder.friction]` and `[motor.friction]`.

use phea_quantity::{DAMPING, FORCE, RATIO, STIFFNESS, VELOCITY};
use phea_table::{DeclaredMisfit, Key, TableNumber, Variants, Visitor, key, plain};

use super::{Friction, LuGre, Stribeck};

pub(super) const COULOMB_KEY: Key = key("coulomb", &FORCE, "Sliding friction F_C.").of_motion().positive();
pub(super) const STRIBECK_VELOCITY_KEY: Key =
    key("stribeck_velocity", &VELOCITY, "Velocity at which friction has fallen from F_S.")
        .of_motion()
        .positive();
pub(super) const STRIBECK_EXPONENT_KEY: Key =
    key("stribeck_exponent", &RATIO, "Exponent of the Stribeck curve.")
        .positive()
        .or(2.0)
        .at_most(10.0)
        .above(0.0);
pub(super) const REGULAR_VELOCITY_KEY: Key =
    key("regular_velocity", &VELOCITY, "Smooths the jump of a Stribeck curve, to simulate it.")
        .of_motion()
        .positive();
pub(super) const BRISTLE_STIFFNESS_KEY: Key =
    key("bristle_stiffness", &STIFFNESS, "σ₀ of LuGre.").of_motion().positive();
pub(super) const BRISTLE_DAMPING_KEY: Key =
    key("bristle_damping", &DAMPING, "σ₁ of LuGre.").of_motion().not_negative();
pub(super) const VISCOUS_KEY: Key = key("viscous", &DAMPING, "Slope of friction over velocity, σ₂ of LuGre.")
    .of_motion()
    .not_negative()
    .or(0.0);

/// Friction of seals and bearings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredFriction<S = f64> {
    /// Law with the levels in extension.
    pub law: Friction<S>,
    /// Levels in retraction, if different.
    pub retracting: Option<RetractingFriction<S>>,
    /// Residual of the recordings from which it was identified.
    pub misfit: Option<DeclaredMisfit<S>>,
}

/// Levels of friction in retraction; absent ones equal those in extension.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RetractingFriction<S = f64> {
    /// Sliding friction F_C, N.
    pub coulomb: Option<S>,
    /// Breakaway friction F_S, N.
    pub static_friction: Option<S>,
    /// Slope at high velocity, N·s/m.
    pub viscous: Option<S>,
}

impl RetractingFriction {
    /// Stated levels, mutable.
    pub fn each_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        [&mut self.coulomb, &mut self.static_friction, &mut self.viscous].into_iter().flatten()
    }
}

impl<S: TableNumber> RetractingFriction<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("coulomb", &FORCE, "Sliding friction F_C; absent: as while it extends.").of_motion();
        v.optional(k.positive(), &mut self.coulomb);
        let k = key("static", &FORCE, "Breakaway friction F_S; absent: as while it extends.").of_motion();
        v.optional(k.positive(), &mut self.static_friction);
        let k = key("viscous", &DAMPING, "Slope of friction over velocity; absent: as while it extends.");
        v.optional(k.of_motion().not_negative(), &mut self.viscous);
    }
}

impl<S: TableNumber> Stribeck<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(COULOMB_KEY, &mut self.coulomb);
        v.quantity(
            key("static", &FORCE, "Breakaway friction F_S.").of_motion().positive(),
            &mut self.static_friction,
        );
        v.quantity(STRIBECK_VELOCITY_KEY, &mut self.stribeck_velocity);
        v.quantity(STRIBECK_EXPONENT_KEY, &mut self.stribeck_exponent);
    }
}

impl<S: TableNumber> Variants<S> for Friction<S> {
    fn all(&self) -> Vec<Friction<S>> {
        let curve = Stribeck::default();
        vec![
            Friction::default(),
            Friction::Stribeck { curve, regular_velocity: None },
            Friction::LuGre(LuGre::default()),
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            Friction::Viscous { .. } => "viscous",
            Friction::Stribeck { .. } => "stribeck",
            Friction::LuGre(_) => "lugre",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            Friction::Viscous { .. } => {}
            Friction::Stribeck { curve, regular_velocity } => {
                curve.visit(v);
                v.optional(REGULAR_VELOCITY_KEY, regular_velocity);
            }
            Friction::LuGre(LuGre { curve, bristle_stiffness, bristle_damping }) => {
                curve.visit(v);
                v.quantity(BRISTLE_STIFFNESS_KEY, bristle_stiffness);
                v.quantity(BRISTLE_DAMPING_KEY, bristle_damping);
            }
        }
    }
}

impl<S: TableNumber> DeclaredFriction<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("model", "Which friction law."), &mut self.law, true);
        v.quantity(VISCOUS_KEY, self.law.viscous_mut());
    }

    /// Visits the friction of a cylinder, which is identified from recordings.
    pub fn visit_of_cylinder<V: Visitor<S>>(&mut self, v: &mut V) {
        self.visit(v);
        let k = plain("retracting", "What differs while the rod retracts; absent: the same both ways.");
        v.table(k, &mut self.retracting, RetractingFriction::visit);
        DeclaredMisfit::visit(&mut self.misfit, v);
    }
}
