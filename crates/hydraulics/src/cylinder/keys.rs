//! Table `[cylinder]`.

use std::f64::consts::FRAC_PI_4;

use crate::contact::Contact;
use crate::friction::DeclaredFriction;
use crate::stroke::{STAGE_TRANSITION_KEY, STROKE_KEY};
use phea_quantity::{AREA, FLOW_PRESSURE_COEFFICIENT, LENGTH, MASS, VOLUME};
use phea_table::{CatalogueKind, Key, TableNumber, Visitor, key, plain};

pub(super) const MOVING_MASS_KEY: Key =
    key("moving_mass", &MASS, "Mass of piston, rod and what moves with them.").positive().usual(
        0.1,
        1e4,
        "pistons with what is fixed to them",
    );
pub(super) const DEAD_VOLUME_KEY: Key =
    key("dead_volume", &VOLUME, "Volume of each chamber besides the swept volume and the line.")
        .not_negative();
pub(super) const INTERNAL_LEAKAGE_KEY: Key =
    key("internal_leakage", &FLOW_PRESSURE_COEFFICIENT, "Laminar leakage across the piston.").positive();

/// Cylinder; `a` is the end x = 0, and x grows from A to B.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredCylinder<S = f64> {
    /// Name of the catalogue's cylinder, if it supplied piston and rod.
    pub model: Option<String>,
    /// Piston diameter, m; this or `piston_area`.
    pub piston_diameter: Option<S>,
    /// Effective area, equal in both chambers, with rods already subtracted, m².
    pub piston_area: Option<S>,
    /// Effective areas in chamber A and in chamber B, m².
    pub piston_areas: Option<[S; 2]>,
    /// Diameter of the rod through both chambers, m; this or `rod_diameters`.
    pub rod_diameter: Option<S>,
    /// Diameters of the rod in chamber A and in chamber B, m; zero without a rod.
    pub rod_diameters: Option<[S; 2]>,
    /// Stroke, m.
    pub stroke: S,
    /// Further stages of a telescopic piston, after the first.
    pub stages: Vec<DeclaredStage<S>>,
    /// Distance over which the areas of one stage blend into those of the next, m.
    pub stage_transition: S,
    /// Mass of piston, rod and the parts that move with them, kg.
    pub moving_mass: S,
    /// Length of the retracted actuator from mount to mount in addition to its stroke, m.
    pub dead_length: Option<S>,
    /// Volume in each chamber in addition to the swept volume and the line, m³; this or
    /// `dead_volumes`.
    pub dead_volume: Option<S>,
    /// Volumes in chamber A and in chamber B, m³.
    pub dead_volumes: Option<[S; 2]>,
    /// Laminar leakage across the piston, m³/(s·Pa).
    pub internal_leakage: Option<S>,
    /// End stops of the piston; if absent, the ends are only reported.
    pub end_stops: Option<Contact<S>>,
    /// Friction of seals and bearings.
    pub friction: Option<DeclaredFriction<S>>,
}

/// Further stage of a telescopic piston.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredStage<S = f64> {
    /// Position of the piston from which this stage moves, m.
    pub from: S,
    /// Effective area, equal in both chambers, m²; this or `piston_areas`.
    pub piston_area: Option<S>,
    /// Effective areas in chamber A and in chamber B, m².
    pub piston_areas: Option<[S; 2]>,
}

impl<S: TableNumber> DeclaredStage<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("from", &LENGTH, "Position of the piston from which this stage moves.").positive();
        v.quantity(k, &mut self.from);
        let k = key("piston_area", &AREA, "Area the pressure acts on in each chamber; or `piston_areas`.");
        v.optional(k.positive(), &mut self.piston_area);
        let k = key("piston_areas", &AREA, "Areas the pressure acts on in chamber A and in chamber B.");
        v.pair(k.positive(), &mut self.piston_areas);
        v.one_of(&["piston_areas", "piston_area"], true);
    }
}

impl DeclaredCylinder {
    /// Diameter of the piston, m: declared, or from the larger area and the rod on its side.
    pub fn piston_diameter_m(&self) -> f64 {
        let faces = self.effective_areas_m2().into_iter().zip(self.rod_diameters_m());
        let by_area = faces.map(|(area, rod)| (area / FRAC_PI_4 + rod * rod).sqrt()).fold(0.0, f64::max);
        self.piston_diameter.unwrap_or(by_area)
    }

    /// Length of the longest stage, which determines the retracted length, m.
    pub fn longest_stage_m(&self) -> f64 {
        let ends = self.stages.iter().map(|stage| stage.from).chain([self.stroke]);
        let lengths = ends.scan(0.0, |before, end| Some(end - std::mem::replace(before, end)));
        lengths.fold(0.0, f64::max)
    }
}

impl<S: TableNumber> DeclaredCylinder<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("model", "Name of a cylinder of the catalogue.");
        v.catalogue(k, CatalogueKind::Cylinder, &mut self.model);
        let k =
            key("piston_diameter", &LENGTH, "Diameter of the piston; or `piston_area` or `piston_areas`.")
                .positive()
                .usual(0.01, 0.5, "pistons");
        v.optional(k, &mut self.piston_diameter);
        let k =
            key("piston_area", &AREA, "Area the pressure acts on in each chamber, rods already subtracted.")
                .usual(5e-5, 0.2, "pistons");
        v.optional(k.positive(), &mut self.piston_area);
        let k = key("piston_areas", &AREA, "Areas the pressure acts on in chamber A and in chamber B.");
        v.pair(k.positive(), &mut self.piston_areas);
        v.one_of(&["piston_areas", "piston_diameter", "piston_area"], true);
        let k = key("rod_diameter", &LENGTH, "Diameter of the rod through both chambers.")
            .not_negative()
            .usual(0.005, 0.4, "rods");
        v.optional(k, &mut self.rod_diameter);
        let k = key("rod_diameters", &LENGTH, "Diameters of the rods in chamber A and in chamber B.");
        v.pair(k.not_negative(), &mut self.rod_diameters);
        v.one_of(&["rod_diameter", "rod_diameters"], false);
        v.quantity(STROKE_KEY, &mut self.stroke);
        let k = plain("stage", "A stage of a telescopic piston that follows those before it; at most three.");
        v.tables(k, &mut self.stages, DeclaredStage::visit);
        v.quantity(STAGE_TRANSITION_KEY, &mut self.stage_transition);
        v.quantity(MOVING_MASS_KEY, &mut self.moving_mass);
        let k = key(
            "dead_length",
            &LENGTH,
            "Length of the retracted actuator from mount to mount, less its stroke: covers, rod ends, force sensor.",
        );
        v.optional(k.not_negative(), &mut self.dead_length);
        v.optional(DEAD_VOLUME_KEY, &mut self.dead_volume);
        let k = key("dead_volumes", &VOLUME, "Dead volumes of chamber A and of chamber B.").not_negative();
        v.pair(k, &mut self.dead_volumes);
        v.one_of(&["dead_volume", "dead_volumes"], false);
        v.optional(INTERNAL_LEAKAGE_KEY, &mut self.internal_leakage);
        let k = plain("end_stops", "End stops of the piston at both ends; absent: none.");
        v.table(k, &mut self.end_stops, Contact::visit);
        let k = plain("friction", "Friction of seals and bearings; absent: none.");
        v.table(k, &mut self.friction, DeclaredFriction::visit_of_cylinder);
    }
}
