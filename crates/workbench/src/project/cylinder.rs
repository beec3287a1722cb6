//! `[cylinder]` and `[cylinder.friction]`.

use std::f64::consts::FRAC_PI_4;

use super::key::{key, plain};
use super::visitor::Visitor;
use crate::quantity::{AREA, DAMPING, FORCE, LENGTH, MASS, RATIO, STIFFNESS, VELOCITY, VOLUME};

/// The cylinder; `a` is the end x = 0, and x grows from A to B.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cylinder {
    /// m; this or `piston_area`.
    pub piston_diameter: Option<f64>,
    /// m², of the whole piston face, from which the rods are subtracted.
    pub piston_area: Option<f64>,
    /// m, of the rod through both chambers; this or `rod_diameters`.
    pub rod_diameter: Option<f64>,
    /// m, of the rod in chamber A and in chamber B; zero where there is none.
    pub rod_diameters: Option<[f64; 2]>,
    /// m.
    pub stroke: f64,
    /// kg, piston, rod and what moves with them.
    pub moving_mass: f64,
    /// m³, in each chamber beside the swept volume and the line; this or `dead_volumes`.
    pub dead_volume: Option<f64>,
    /// m³, in chamber A and in chamber B.
    pub dead_volumes: Option<[f64; 2]>,
    /// Friction of seals and bearings.
    pub friction: Option<Friction>,
}

impl Cylinder {
    /// m², of the whole piston face.
    pub fn piston_area_m2(&self) -> f64 {
        let by_diameter = self.piston_diameter.map(|diameter| FRAC_PI_4 * diameter * diameter);
        self.piston_area.or(by_diameter).unwrap_or(0.0)
    }

    /// m, of the rods in chamber A and B.
    pub fn rod_diameters_m(&self) -> [f64; 2] {
        let rod = self.rod_diameter.unwrap_or(0.0);
        self.rod_diameters.unwrap_or([rod, rod])
    }

    /// m², of the piston less the rod, in chamber A and B.
    pub fn effective_areas_m2(&self) -> [f64; 2] {
        self.rod_diameters_m().map(|rod| self.piston_area_m2() - FRAC_PI_4 * rod * rod)
    }

    /// m³, of chamber A and B.
    pub fn dead_volumes_m3(&self) -> [f64; 2] {
        let volume = self.dead_volume.unwrap_or(0.0);
        self.dead_volumes.unwrap_or([volume, volume])
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("piston_diameter", &LENGTH, "Diameter of the piston; or `piston_area`.").positive();
        v.optional(k, &mut self.piston_diameter);
        let k = key("piston_area", &AREA, "Area of the whole piston face; the rods are subtracted from it.");
        v.optional(k.positive(), &mut self.piston_area);
        let k = key("rod_diameter", &LENGTH, "Diameter of the rod through both chambers.").not_negative();
        v.optional(k, &mut self.rod_diameter);
        let k = key("rod_diameters", &LENGTH, "Diameters of the rods in chamber A and in chamber B.");
        v.pair(k.not_negative(), &mut self.rod_diameters);
        let k = key("stroke", &LENGTH, "Stroke; x = 0 is the end of chamber A.").positive();
        v.quantity(k, &mut self.stroke);
        let k = key("moving_mass", &MASS, "Mass of piston, rod and what moves with them.").positive();
        v.quantity(k, &mut self.moving_mass);
        let k = key("dead_volume", &VOLUME, "Volume of each chamber beside the swept volume and the line.");
        v.optional(k.not_negative(), &mut self.dead_volume);
        let k = key("dead_volumes", &VOLUME, "Dead volumes of chamber A and of chamber B.").not_negative();
        v.pair(k, &mut self.dead_volumes);
        let k = plain("friction", "Friction of seals and bearings; absent: none.");
        v.table(k, &mut self.friction, Friction::visit);
    }
}

/// Friction; which numbers are needed depends on the model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Friction {
    /// Which law.
    pub model: FrictionModel,
    /// N·s/m, slope at high velocity (σ₂ of LuGre).
    pub viscous: f64,
    /// N, sliding friction F_C.
    pub coulomb: Option<f64>,
    /// N, breakaway friction F_S.
    pub static_friction: Option<f64>,
    /// m/s.
    pub stribeck_velocity: Option<f64>,
    /// Exponent of the Stribeck curve.
    pub stribeck_exponent: f64,
    /// N/m, σ₀.
    pub bristle_stiffness: Option<f64>,
    /// N·s/m, σ₁.
    pub bristle_damping: Option<f64>,
}

/// Which friction law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionModel {
    /// Proportional to velocity.
    #[default]
    Viscous,
    /// Coulomb, breakaway and viscous part as a function of velocity.
    Stribeck,
    /// Bristles with a state of their own.
    LuGre,
}

impl Friction {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let words = &[
            ("viscous", FrictionModel::Viscous),
            ("stribeck", FrictionModel::Stribeck),
            ("lugre", FrictionModel::LuGre),
        ];
        v.choice(plain("model", "Which friction law."), words, &mut self.model, true);
        let k = key("viscous", &DAMPING, "Slope of friction over velocity, σ₂ of LuGre.").not_negative();
        v.quantity(k.or(0.0), &mut self.viscous);
        let k = key("coulomb", &FORCE, "Sliding friction F_C.").positive();
        v.optional(k, &mut self.coulomb);
        v.optional(key("static", &FORCE, "Breakaway friction F_S.").positive(), &mut self.static_friction);
        let k = key("stribeck_velocity", &VELOCITY, "Velocity at which friction has fallen from F_S.");
        v.optional(k.positive(), &mut self.stribeck_velocity);
        let k = key("stribeck_exponent", &RATIO, "Exponent of the Stribeck curve.").positive().or(2.0);
        v.quantity(k.at_most(10.0).above(0.0), &mut self.stribeck_exponent);
        let k = key("bristle_stiffness", &STIFFNESS, "σ₀ of LuGre.").positive();
        v.optional(k, &mut self.bristle_stiffness);
        let k = key("bristle_damping", &DAMPING, "σ₁ of LuGre.").not_negative();
        v.optional(k, &mut self.bristle_damping);
    }
}
