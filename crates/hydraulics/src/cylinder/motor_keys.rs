//! Table `[motor]`, in place of `[cylinder]`: a rotary actuator.

use phea_quantity::{ANGLE, DISPLACEMENT, FLOW_PRESSURE_COEFFICIENT, INERTIA, MotionKind, VOLUME};
use phea_table::{Key, TableNumber, Visitor, key, plain};

use crate::contact::Contact;

use crate::friction::DeclaredFriction;

pub(crate) const CASE_LEAKAGE_KEY: Key = key(
    "case_leakage",
    &FLOW_PRESSURE_COEFFICIENT,
    "Laminar leakage of each chamber through the case to the tank.",
)
.positive();

/// Hydraulic motor or vane actuator; its angle grows while oil enters chamber A.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredMotor<S = f64> {
    /// Displacement of a chamber per angle, m³/rad.
    pub displacement: S,
    /// Stroke from end to end, rad; if absent, it rotates without limit, and its chamber volumes
    /// are constant.
    pub stroke: Option<S>,
    /// Inertia of shaft, rotor and the parts that turn with them, kg·m².
    pub inertia: S,
    /// Volume in each chamber in addition to the swept volume and the line, m³; this or
    /// `dead_volumes`.
    pub dead_volume: Option<S>,
    /// Volumes in chamber A and in chamber B, m³.
    pub dead_volumes: Option<[S; 2]>,
    /// Laminar leakage from chamber to chamber, m³/(s·Pa).
    pub internal_leakage: Option<S>,
    /// Laminar leakage of each chamber through the case to the tank, m³/(s·Pa).
    pub case_leakage: Option<S>,
    /// End stops; if absent, the ends are only reported.
    pub end_stops: Option<Contact<S>>,
    /// Friction of seals and bearings.
    pub friction: Option<DeclaredFriction<S>>,
}

impl<S: TableNumber> DeclaredMotor<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.moves(Some(MotionKind::Rotary));
        let k = key("displacement", &DISPLACEMENT, "What a chamber takes for an angle; torque per pressure.")
            .usual(1e-7, 1e-3, "motors");
        v.quantity(k.positive(), &mut self.displacement);
        let k = key(
            "stroke",
            &ANGLE,
            "From end to end, 0 at the end of chamber A; absent: it rotates without limit.",
        )
        .usual(0.5, 6.3, "vane actuators");
        v.optional(k.positive(), &mut self.stroke);
        let k = key("inertia", &INERTIA, "Inertia of shaft, rotor and what turns with them.")
            .positive()
            .usual(1e-4, 10.0, "shafts with what is fixed to them");
        v.quantity(k, &mut self.inertia);
        let k = key("dead_volume", &VOLUME, "Volume of each chamber besides the swept volume and the line.");
        v.optional(k.not_negative(), &mut self.dead_volume);
        let k = key("dead_volumes", &VOLUME, "Dead volumes of chamber A and of chamber B.").not_negative();
        v.pair(k, &mut self.dead_volumes);
        v.one_of(&["dead_volume", "dead_volumes"], false);
        let k =
            key("internal_leakage", &FLOW_PRESSURE_COEFFICIENT, "Laminar leakage from chamber to chamber.");
        v.optional(k.positive(), &mut self.internal_leakage);
        v.optional(CASE_LEAKAGE_KEY, &mut self.case_leakage);
        let k = plain("end_stops", "End stops at both ends of the stroke; absent: none.");
        v.table(k, &mut self.end_stops, Contact::visit);
        let k = plain("friction", "Friction of seals and bearings; absent: none.");
        v.table(k, &mut self.friction, DeclaredFriction::visit);
    }
}
