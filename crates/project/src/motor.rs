//! Table `[motor]`, in place of `[cylinder]`: a rotary actuator.

use phea_quantity::{ANGLE, DISPLACEMENT, FLOW_PRESSURE_COEFFICIENT, INERTIA, MotionKind, VOLUME};

use phea_hydraulics::contact::Contact;

use super::{DeclaredActuator, DeclaredFriction};
use phea_table::{Motions, key, plain};
use phea_table::{TableNumber, Visitor};

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
    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.moves(Some(MotionKind::Rotary));
        let k = key("displacement", &DISPLACEMENT, "What a chamber takes for an angle; torque per pressure.");
        v.quantity(k.positive(), &mut self.displacement);
        let k = key(
            "stroke",
            &ANGLE,
            "From end to end, 0 at the end of chamber A; absent: it rotates without limit.",
        );
        v.optional(k.positive(), &mut self.stroke);
        let k = key("inertia", &INERTIA, "Inertia of shaft, rotor and what turns with them.").positive();
        v.quantity(k, &mut self.inertia);
        let k = key("dead_volume", &VOLUME, "Volume of each chamber besides the swept volume and the line.");
        v.optional(k.not_negative(), &mut self.dead_volume);
        let k = key("dead_volumes", &VOLUME, "Dead volumes of chamber A and of chamber B.").not_negative();
        v.pair(k, &mut self.dead_volumes);
        v.one_of(&["dead_volume", "dead_volumes"], false);
        let k =
            key("internal_leakage", &FLOW_PRESSURE_COEFFICIENT, "Laminar leakage from chamber to chamber.");
        v.optional(k.positive(), &mut self.internal_leakage);
        let k = key(
            "case_leakage",
            &FLOW_PRESSURE_COEFFICIENT,
            "Laminar leakage of each chamber through the case to the tank.",
        );
        v.optional(k.positive(), &mut self.case_leakage);
        let k = plain("end_stops", "End stops at both ends of the stroke; absent: none.");
        v.table(k, &mut self.end_stops, Contact::visit);
        let k = plain("friction", "Friction of seals and bearings; absent: none.");
        v.table(k, &mut self.friction, DeclaredFriction::visit);
    }
}

impl<S> DeclaredActuator<S> {
    /// Motion of the actuator.
    ///
    /// # Example
    /// ```
    /// use phea_project::{DeclaredActuator, DeclaredMotor};
    /// use phea_quantity::MotionKind;
    /// let cylinder = DeclaredActuator::default();
    /// assert_eq!(cylinder.motion(), MotionKind::Linear);
    /// let motor = DeclaredActuator { motor: Some(DeclaredMotor::default()), ..cylinder };
    /// assert_eq!((motor.motion(), motor.stroke()), (MotionKind::Rotary, None));
    /// ```
    pub fn motion(&self) -> MotionKind {
        if self.motor.is_some() { MotionKind::Rotary } else { MotionKind::Linear }
    }

    /// Motion of the load, which also turns behind a linkage.
    pub fn load_motion(&self) -> MotionKind {
        if self.linkage.is_some() { MotionKind::Rotary } else { self.motion() }
    }

    /// Motions of actuator and load.
    pub fn motions(&self) -> Motions {
        Motions { rig: self.motion(), load: self.load_motion() }
    }

    /// Table that describes the moving part.
    pub fn moving_part(&self) -> &'static str {
        if self.motor.is_some() { "motor" } else { "cylinder" }
    }

    /// Friction of seals and bearings.
    pub fn friction(&self) -> Option<&DeclaredFriction<S>> {
        self.motor.as_ref().map_or(self.cylinder.friction.as_ref(), |motor| motor.friction.as_ref())
    }
}

impl DeclaredActuator {
    /// Stroke in m or rad; `None` for a motor that rotates without limit.
    pub fn stroke(&self) -> Option<f64> {
        self.motor.as_ref().map_or(Some(self.cylinder.stroke), |motor| motor.stroke)
    }

    /// True if a position in m or rad is beyond the end of the stroke.
    pub(crate) fn is_beyond(&self, position: f64) -> bool {
        self.stroke().is_some_and(|stroke| stroke > 0.0 && position > stroke)
    }

    /// Friction of seals and bearings, mutable.
    pub fn friction_mut(&mut self) -> Option<&mut DeclaredFriction> {
        match &mut self.motor {
            Some(motor) => motor.friction.as_mut(),
            None => self.cylinder.friction.as_mut(),
        }
    }

    /// Moving mass in kg or inertia in kg·m², mutable.
    pub fn moving_mass_mut(&mut self) -> &mut f64 {
        match &mut self.motor {
            Some(motor) => &mut motor.inertia,
            None => &mut self.cylinder.moving_mass,
        }
    }
}
