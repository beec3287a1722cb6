//! `[series]` and `[series.coil]`: the spring between force sensor and load.

use phea_hydraulics::series::ForceFrom;

use super::cost::PartCost;
use super::key::{key, plain};
use super::visitor::Visitor;
use phea_quantity::{DAMPING, DENSITY, INVERSE_VELOCITY, LENGTH, MASS, PRESSURE, PricedBy, RATIO, STIFFNESS};

/// The spring between force sensor and load, with its damper, the mass before it and the ends of
/// its travel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSeries {
    /// N/m, of the spring; of a progressive one at rest.
    pub stiffness: f64,
    /// N·s/m, beside the spring.
    pub damping: f64,
    /// kg, between force sensor and spring.
    pub mass: f64,
    /// m, to either side; absent: as far as it is pressed.
    pub travel: Option<f64>,
    /// Share by which the force at the end of the travel exceeds that of a linear spring.
    pub progression: f64,
    /// N/m, of the stops at both ends of the travel; absent: the ends are reported, and nothing
    /// stops it.
    pub stop_stiffness: Option<f64>,
    /// s/m, damping of the stops relative to their elastic force.
    pub stop_damping: f64,
    /// What the measured force is taken from.
    pub force_from: ForceFrom,
    /// How it is wound.
    pub coil: Option<SpringCoil>,
    /// What the spring costs and weighs, with its housing; without a mass that of its coils.
    pub cost: PartCost,
}

/// What a coil spring is wound from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringCoil {
    /// Mean diameter of the coil over that of the wire.
    pub index: f64,
    /// Pa, greatest shear stress in the wire.
    pub allowed_shear_stress: f64,
    /// Pa, of the wire.
    pub shear_modulus: f64,
    /// kg/m³, of the wire.
    pub density: f64,
}

/// Pa and kg/m³, spring steel (EN 10270-1).
const STEEL_SHEAR_MODULUS: f64 = 81.5e9;
const STEEL_DENSITY: f64 = 7850.0;

impl DeclaredSeries {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("stiffness", &STIFFNESS, "Of the spring between force sensor and load, at rest.");
        v.quantity(k.positive(), &mut self.stiffness);
        let k = key("damping", &DAMPING, "Damping beside the spring.").not_negative();
        v.quantity(k.or(0.0), &mut self.damping);
        let k = key("mass", &MASS, "Mass between force sensor and spring.").not_negative();
        v.quantity(k.or(0.0), &mut self.mass);
        let k = key("travel", &LENGTH, "Travel of the spring to either side; absent: not limited.");
        v.optional(k.positive(), &mut self.travel);
        let k = key(
            "progression",
            &RATIO,
            "Share by which the force at the end of the travel exceeds `stiffness` times `travel`; needs `travel`.",
        );
        v.quantity(k.not_negative().or(0.0), &mut self.progression);
        let k = key(
            "stop_stiffness",
            &STIFFNESS,
            "Of the stops at both ends of the travel; absent: the ends are reported, and nothing stops the spring.",
        );
        v.optional(k.positive(), &mut self.stop_stiffness);
        let k = key(
            "stop_damping",
            &INVERSE_VELOCITY,
            "Damping of the stops relative to their elastic force; needs `damping` or `mass`.",
        );
        v.quantity(k.not_negative().or(0.0), &mut self.stop_damping);
        let words = &[("sensor", ForceFrom::Sensor), ("deflection", ForceFrom::Deflection)];
        let k = plain(
            "force_from",
            "What the measured force is taken from: the force sensor, or the deflection of the spring.",
        );
        v.choice(k, words, &mut self.force_from, false);
        let k = plain("coil", "How a coil spring is wound for it; absent: it is not sized.");
        v.table(k, &mut self.coil, SpringCoil::visit);
        v.price(plain("price", "What the spring costs."), PricedBy::Piece, &mut self.cost.price);
        let k = key("spring_mass", &MASS, "Mass of the spring as a part; absent: that of its `coil`.");
        v.optional(k.not_negative(), &mut self.cost.mass);
    }
}

impl SpringCoil {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("index", &RATIO, "Mean diameter of the coil over the diameter of the wire.");
        v.quantity(k.at_least(3.0).at_most(20.0), &mut self.index);
        let k =
            key("allowed_shear_stress", &PRESSURE, "Greatest shear stress in the wire, by Wahl's factor.");
        v.quantity(k.positive(), &mut self.allowed_shear_stress);
        let k = key("shear_modulus", &PRESSURE, "Of the wire.").positive().or(STEEL_SHEAR_MODULUS);
        v.quantity(k, &mut self.shear_modulus);
        let k = key("density", &DENSITY, "Of the wire.").positive().or(STEEL_DENSITY);
        v.quantity(k, &mut self.density);
    }
}
