//! Table `[series]` with `[series.coil]` or `[series.line]`: the spring or the hydraulic
//! transmission between force sensor and load.

use crate::series::{ForceFrom, MOST_SEGMENTS};

use crate::line::DeclaredLine;
use phea_quantity::{
    AREA, DAMPING, DENSITY, INVERSE_VELOCITY, LENGTH, MASS, PRESSURE, PricedBy, RATIO, STIFFNESS, VOLUME,
};
use phea_table::{Key, PartCost, TableNumber, Variants, Visitor, key, plain};

pub(super) const STOP_DAMPING_KEY: Key = key(
    "stop_damping",
    &INVERSE_VELOCITY,
    "Damping of the stops relative to their elastic force; needs `damping` or `mass`.",
)
.not_negative()
.or(0.0);
pub(super) const SEGMENTS_KEY: Key =
    key("segments", &RATIO, "Into how many segments its line is cut; absent: 4.")
        .at_least(1.0)
        .at_most(MOST_SEGMENTS as f64);
pub(super) const PISTON_AREA_KEY: Key = key("piston_area", &AREA, "Of either piston of the transmission.")
    .positive()
    .usual(5e-5, 0.02, "pistons of transmissions");
pub(super) const END_VOLUME_KEY: Key =
    key("end_volume", &VOLUME, "Oil at either piston, in addition to that of the line.")
        .not_negative()
        .or(0.0);
pub(super) const STIFFNESS_KEY: Key =
    key("stiffness", &STIFFNESS, "Of the spring between force sensor and load, at rest.").positive().usual(
        1e4,
        1e8,
        "series springs",
    );
pub(super) const TRAVEL_KEY: Key =
    key("travel", &LENGTH, "Travel of the spring to either side; absent: not limited.").positive().usual(
        1e-3,
        0.1,
        "series springs",
    );
pub(super) const PROGRESSION_KEY: Key = key(
    "progression",
    &RATIO,
    "Share by which the force at the end of the travel exceeds `stiffness` times `travel`; needs `travel`.",
)
.not_negative()
.or(0.0);
pub(super) const STOP_STIFFNESS_KEY: Key = key(
    "stop_stiffness",
    &STIFFNESS,
    "Of the stops at both ends of the travel; absent: the ends are reported, and nothing stops the spring.",
)
.positive();

/// Element between force sensor and load.
#[derive(Clone, Debug, PartialEq)]
pub enum DeclaredSeries<S = f64> {
    /// Spring.
    Spring(DeclaredSpring<S>),
    /// Two pistons with a line between them.
    Transmission(Box<DeclaredTransmission<S>>),
}

/// Spring between force sensor and load, with its damper, the mass before it and the ends of its
/// travel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSpring<S = f64> {
    /// Stiffness of the spring, N/m; of a progressive one at rest.
    pub stiffness: S,
    /// Damping in parallel with the spring, N·s/m; absent if zero.
    pub damping: Option<S>,
    /// Mass between force sensor and spring, kg; absent if zero.
    pub mass: Option<S>,
    /// Travel to either side, m; unlimited if absent.
    pub travel: Option<S>,
    /// Fraction by which the force at the end of the travel exceeds that of a linear spring;
    /// absent if zero.
    pub progression: Option<S>,
    /// Stiffness of the stops at both ends of the travel, N/m; if absent, the ends are only
    /// reported.
    pub stop_stiffness: Option<S>,
    /// Damping of the stops relative to their elastic force, s/m.
    pub stop_damping: S,
    /// Source of the measured force.
    pub force_from: ForceFrom,
    /// Coil of the spring.
    pub coil: Option<SpringCoil<S>>,
    /// Cost and mass of the spring with its housing; the default mass is that of its coils.
    pub cost: PartCost<S>,
}

/// Hydraulic transmission between force sensor and load, filled once and closed.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredTransmission<S = f64> {
    /// Area of either piston, m².
    pub piston_area: S,
    /// Filling pressure at rest and without force, Pa gauge.
    pub filling_pressure: S,
    /// Oil volume at either piston in addition to that of the line, m³.
    pub end_volume: S,
    /// Number of segments of the line.
    pub segments: u32,
    /// Hose or pipe between the pistons.
    pub line: DeclaredLine<S>,
    /// Length of either of its cylinders, m; unknown if absent.
    pub cylinder_length: Option<S>,
    /// Cost and mass of both cylinders together.
    pub cylinders: PartCost<S>,
}

/// Winding of a coil spring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpringCoil<S = f64> {
    /// Mean diameter of the coil over that of the wire.
    pub index: S,
    /// Greatest shear stress in the wire, Pa.
    pub allowed_shear_stress: S,
    /// Shear modulus of the wire, Pa.
    pub shear_modulus: S,
    /// Density of the wire, kg/m³.
    pub density: S,
}

/// Shear modulus in Pa and density in kg/m³ of spring steel (EN 10270-1).
const STEEL_SHEAR_MODULUS: f64 = 81.5e9;
const STEEL_DENSITY: f64 = 7850.0;

/// Default number of segments of a transmission: its first wave, half a wave long, is 3 % slow.
const SEGMENTS: u32 = 4;

impl<S: Default> Default for DeclaredSeries<S> {
    fn default() -> Self {
        DeclaredSeries::Spring(DeclaredSpring::default())
    }
}

impl<S: Default> Default for DeclaredTransmission<S> {
    fn default() -> Self {
        DeclaredTransmission {
            piston_area: S::default(),
            filling_pressure: S::default(),
            end_volume: S::default(),
            segments: SEGMENTS,
            line: DeclaredLine::default(),
            cylinder_length: None,
            cylinders: PartCost::default(),
        }
    }
}

impl DeclaredSeries {
    /// The spring, if it is one.
    pub fn spring(&self) -> Option<&DeclaredSpring> {
        if let DeclaredSeries::Spring(spring) = self { Some(spring) } else { None }
    }

    /// The transmission, if it is one.
    pub fn transmission(&self) -> Option<&DeclaredTransmission> {
        if let DeclaredSeries::Transmission(transmission) = self { Some(transmission) } else { None }
    }
}

impl<S: TableNumber> DeclaredSeries<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.variant(plain("kind", "What lies between force sensor and load."), self, false);
    }
}

impl<S: TableNumber> Variants<S> for DeclaredSeries<S> {
    fn all(&self) -> Vec<DeclaredSeries<S>> {
        vec![DeclaredSeries::default(), DeclaredSeries::Transmission(Box::default())]
    }

    fn word(&self) -> &'static str {
        match self {
            DeclaredSeries::Spring(_) => "spring",
            DeclaredSeries::Transmission(_) => "transmission",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            DeclaredSeries::Spring(spring) => spring.visit(v),
            DeclaredSeries::Transmission(transmission) => transmission.visit(v),
        }
    }
}

impl<S: TableNumber> DeclaredTransmission<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(PISTON_AREA_KEY, &mut self.piston_area);
        let k = key("filling_pressure", &PRESSURE, "Of its oil, at rest and without force.")
            .positive()
            .usual(1e5, 3.5e7, "transmissions");
        v.quantity(k, &mut self.filling_pressure);
        v.quantity(END_VOLUME_KEY, &mut self.end_volume);
        let mut segments = Some(self.segments);
        v.optional_count(SEGMENTS_KEY, &mut segments);
        self.segments = segments.unwrap_or(SEGMENTS);
        v.needed_table(plain("line", "The hose or pipe between its pistons."), &mut self.line, |line, v| {
            line.visit_unconnected(v);
        });
        let k = key("cylinder_length", &LENGTH, "Length of either of its cylinders, when retracted.");
        v.optional(k.positive(), &mut self.cylinder_length);
        v.price(plain("price", "What both cylinders cost."), PricedBy::Piece, &mut self.cylinders.price);
        let k = key("cylinders_mass", &MASS, "Mass of both cylinders as parts.");
        v.optional(k.not_negative(), &mut self.cylinders.mass);
    }
}

impl<S: TableNumber> DeclaredSpring<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(STIFFNESS_KEY, &mut self.stiffness);
        let k = key("damping", &DAMPING, "Damping parallel to the spring.").not_negative();
        v.unless_zero(k.or(0.0), &mut self.damping);
        let k = key("mass", &MASS, "Mass between force sensor and spring.").not_negative();
        v.unless_zero(k.or(0.0), &mut self.mass);
        v.optional(TRAVEL_KEY, &mut self.travel);
        v.unless_zero(PROGRESSION_KEY, &mut self.progression);
        v.optional(STOP_STIFFNESS_KEY, &mut self.stop_stiffness);
        v.quantity(STOP_DAMPING_KEY, &mut self.stop_damping);
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

impl<S: TableNumber> SpringCoil<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("index", &RATIO, "Mean diameter of the coil over the diameter of the wire.");
        v.quantity(k.at_least(3.0).at_most(20.0), &mut self.index);
        let k =
            key("allowed_shear_stress", &PRESSURE, "Greatest shear stress in the wire, by Wahl's factor.")
                .usual(2e8, 1.2e9, "spring steels");
        v.quantity(k.positive(), &mut self.allowed_shear_stress);
        let k = key("shear_modulus", &PRESSURE, "Of the wire.").positive().or(STEEL_SHEAR_MODULUS).usual(
            4e10,
            9e10,
            "spring materials",
        );
        v.quantity(k, &mut self.shear_modulus);
        let k = key("density", &DENSITY, "Of the wire.").positive().or(STEEL_DENSITY).usual(
            4000.0,
            9000.0,
            "spring materials",
        );
        v.quantity(k, &mut self.density);
    }
}
