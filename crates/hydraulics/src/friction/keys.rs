//! Tables `[cylinder.friction]` and `[motor.friction]`.

use phea_quantity::{DAMPING, FORCE, RATIO, STIFFNESS, VELOCITY};
use phea_table::{DeclaredMisfit, TableNumber, Variants, Visitor, key, plain};

/// Friction of seals and bearings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredFriction<S = f64> {
    /// Law of its non-viscous part.
    pub law: FrictionLaw<S>,
    /// Slope at high velocity (σ₂ of LuGre), N·s/m.
    pub viscous: S,
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

/// Friction law, without its viscous part.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FrictionLaw<S = f64> {
    /// No other part: proportional to velocity.
    #[default]
    Viscous,
    /// Coulomb and breakaway friction as a function of velocity.
    Stribeck {
        /// Curve over velocity.
        curve: StribeckCurve<S>,
        /// Velocity that smooths the jump at standstill for simulation, m/s.
        regular_velocity: Option<S>,
    },
    /// Bristles with a state of their own.
    LuGre {
        /// Friction at constant velocity.
        curve: StribeckCurve<S>,
        /// Bristle stiffness σ₀, N/m.
        bristle_stiffness: S,
        /// Bristle damping σ₁, N·s/m.
        bristle_damping: S,
    },
}

/// Friction that falls from breakaway to sliding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StribeckCurve<S = f64> {
    /// Sliding friction F_C, N.
    pub coulomb: S,
    /// Breakaway friction F_S, N.
    pub static_friction: S,
    /// Stribeck velocity, m/s.
    pub stribeck_velocity: S,
    /// Exponent.
    pub stribeck_exponent: S,
}

impl<S: TableNumber> StribeckCurve<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("coulomb", &FORCE, "Sliding friction F_C.").of_motion().positive();
        v.quantity(k, &mut self.coulomb);
        v.quantity(
            key("static", &FORCE, "Breakaway friction F_S.").of_motion().positive(),
            &mut self.static_friction,
        );
        let k = key("stribeck_velocity", &VELOCITY, "Velocity at which friction has fallen from F_S.")
            .of_motion();
        v.quantity(k.positive(), &mut self.stribeck_velocity);
        let k = key("stribeck_exponent", &RATIO, "Exponent of the Stribeck curve.").positive().or(2.0);
        v.quantity(k.at_most(10.0).above(0.0), &mut self.stribeck_exponent);
    }
}

impl<S: TableNumber> Variants<S> for FrictionLaw<S> {
    fn all(&self) -> Vec<FrictionLaw<S>> {
        let curve = StribeckCurve::default();
        vec![
            FrictionLaw::Viscous,
            FrictionLaw::Stribeck { curve, regular_velocity: None },
            FrictionLaw::LuGre { curve, bristle_stiffness: S::default(), bristle_damping: S::default() },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            FrictionLaw::Viscous => "viscous",
            FrictionLaw::Stribeck { .. } => "stribeck",
            FrictionLaw::LuGre { .. } => "lugre",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            FrictionLaw::Viscous => {}
            FrictionLaw::Stribeck { curve, regular_velocity } => {
                curve.visit(v);
                let k = key(
                    "regular_velocity",
                    &VELOCITY,
                    "Smooths the jump of a Stribeck curve, to simulate it.",
                )
                .of_motion();
                v.optional(k.positive(), regular_velocity);
            }
            FrictionLaw::LuGre { curve, bristle_stiffness, bristle_damping } => {
                curve.visit(v);
                let k = key("bristle_stiffness", &STIFFNESS, "σ₀ of LuGre.").of_motion().positive();
                v.quantity(k, bristle_stiffness);
                let k = key("bristle_damping", &DAMPING, "σ₁ of LuGre.").of_motion().not_negative();
                v.quantity(k, bristle_damping);
            }
        }
    }
}

impl<S: TableNumber> DeclaredFriction<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("model", "Which friction law."), &mut self.law, true);
        let k = key("viscous", &DAMPING, "Slope of friction over velocity, σ₂ of LuGre.")
            .of_motion()
            .not_negative();
        v.quantity(k.or(0.0), &mut self.viscous);
    }

    /// Visits the friction of a cylinder, which is identified from recordings.
    pub fn visit_of_cylinder<V: Visitor<S>>(&mut self, v: &mut V) {
        self.visit(v);
        let k = plain("retracting", "What differs while the rod retracts; absent: the same both ways.");
        v.table(k, &mut self.retracting, RetractingFriction::visit);
        DeclaredMisfit::visit(&mut self.misfit, v);
    }
}
