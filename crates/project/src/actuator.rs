//! Hydraulic actuator with its load: one table for each part.

use super::{
    DeclaredAdjustment, DeclaredCrossPort, DeclaredCylinder, DeclaredFluid, DeclaredForceSensor,
    DeclaredFriction, DeclaredLines, DeclaredLinkage, DeclaredMotor, DeclaredSeries, DeclaredSupply,
    DeclaredVelocitySensor, Key, Load, Motions, TableNumber, Valve, Visitor, plain,
};
use phea_hydraulics::port_valves::DeclaredPortValves;
use phea_quantity::MotionKind;
use phea_table::PartCost;

/// Hydraulic actuator and its load.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredActuator<S = f64> {
    /// Oil.
    pub fluid: DeclaredFluid<S>,
    /// Pressure supply.
    pub supply: DeclaredSupply<S>,
    /// Servovalve.
    pub valve: Valve<S>,
    /// Cylinder; the default value if the rig has a motor.
    pub cylinder: DeclaredCylinder<S>,
    /// Motor in place of the cylinder.
    pub motor: Option<DeclaredMotor<S>>,
    /// Lines between valve and cylinder.
    pub line: DeclaredLines<S>,
    /// Valve between the chambers, if there is one.
    pub cross_port: Option<DeclaredCrossPort<S>>,
    /// Relief and check valves between the chambers and the tank, if there are any.
    pub port_valves: Option<DeclaredPortValves<S>>,
    /// Load cell.
    pub force_sensor: DeclaredForceSensor<S>,
    /// Sensor of the load velocity; if absent, the true velocity is known immediately.
    pub velocity_sensor: Option<DeclaredVelocitySensor<S>>,
    /// Element between load cell and load; if absent, the cell acts directly on the load.
    pub series: Option<DeclaredSeries<S>>,
    /// Linkage between rod and load; if absent, the load moves with the rod.
    pub linkage: Option<DeclaredLinkage<S>>,
    /// Load on which the force acts.
    pub load: Load<S>,
}

/// Valve at the chambers with its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberValve {
    /// Table that declares it.
    pub table: &'static str,
    /// Names of one such valve and of several.
    pub names: [&'static str; 2],
    /// Chamber of the valve, `A` or `B`; `None` for a valve of both.
    pub side: Option<&'static str>,
    /// Cost and mass.
    pub cost: PartCost,
}

impl DeclaredActuator {
    /// Required tables of an actuator, in addition to one of [`DeclaredActuator::MOVING`].
    pub(crate) const REQUIRED: [&'static str; 5] = ["fluid", "supply", "valve", "line", "force_sensor"];
    /// Tables of which exactly one describes the moving part.
    pub(crate) const MOVING: [&'static str; 2] = ["cylinder", "motor"];
    /// Optional tables.
    const OPTIONAL: [&'static str; 6] =
        ["cross_port", "port_valves", "velocity_sensor", "series", "linkage", "load"];

    /// All tables with their names.
    pub(crate) fn tables() -> impl Iterator<Item = &'static str> + Clone {
        Self::REQUIRED.into_iter().chain(Self::MOVING).chain(Self::OPTIONAL)
    }
}

impl<S: TableNumber> DeclaredActuator<S> {
    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        required(plain("fluid", "The oil."), &mut self.fluid, DeclaredFluid::visit, v);
        required(plain("supply", "The pressure supply."), &mut self.supply, DeclaredSupply::visit, v);
        required(plain("valve", "The servovalve."), &mut self.valve, Valve::visit, v);
        self.visit_moving(v);
        required(plain("line", "From the valve to each chamber."), &mut self.line, DeclaredLines::visit, v);
        let k = plain("cross_port", "A valve between the chambers.");
        v.table(k, &mut self.cross_port, DeclaredCrossPort::visit);
        let k = plain("port_valves", "Relief and check valves between each chamber and the tank.");
        v.table(k, &mut self.port_valves, DeclaredPortValves::visit);
        required(
            plain("force_sensor", "The load cell."),
            &mut self.force_sensor,
            DeclaredForceSensor::visit,
            v,
        );
        v.table(
            plain("velocity_sensor", "What the velocity of the load is measured with."),
            &mut self.velocity_sensor,
            DeclaredVelocitySensor::visit,
        );
        let k = plain("series", "A spring or transmission between force sensor and load; absent: none.");
        v.table(k, &mut self.series, DeclaredSeries::visit);
        let k = plain("linkage", "What lies between the rod and a load that turns; absent: nothing.");
        v.table(k, &mut self.linkage, DeclaredLinkage::visit);
        v.load_moves((!v.names_everything()).then(|| self.load_motion()));
        v.table_or_default(plain("load", "What the force acts on."), &mut self.load, Load::visit);
    }

    /// Visits the moving part: a motor, or otherwise a cylinder. The keys of all other tables
    /// measure its motion.
    fn visit_moving<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("motor", "A rotary actuator in place of the cylinder.");
        v.table(k, &mut self.motor, DeclaredMotor::visit);
        v.moves(Some(MotionKind::Linear));
        if self.motor.is_none() || v.names_everything() {
            required(plain("cylinder", "The cylinder."), &mut self.cylinder, DeclaredCylinder::visit, v);
        }
        v.moves((!v.names_everything()).then(|| self.motion()));
    }
}

/// Table that a schema marks as required in addition to that of the plant.
fn required<S: TableNumber, T: Default, V: Visitor<S>>(
    key: Key,
    field: &mut T,
    visit: impl Fn(&mut T, &mut V),
    v: &mut V,
) {
    let mut table = Some(std::mem::take(field));
    v.table(key, &mut table, visit);
    *field = table.unwrap_or_default();
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

impl DeclaredActuator {
    /// Valves at the chambers, in the order of their tables.
    pub fn chamber_valves(&self) -> Vec<ChamberValve> {
        let cross_port = self.cross_port.iter().map(|port| ChamberValve {
            table: "cross_port",
            names: ["cross-port valve", "cross-port valves"],
            side: None,
            cost: port.cost,
        });
        let sides = self.port_valves.iter().flat_map(|valves| [("A", valves.a), ("B", valves.b)]);
        let port_valves = sides.filter(|(_, valves)| !valves.is_absent());
        let port_valves = port_valves.map(|(side, valves)| ChamberValve {
            table: "port_valves",
            names: ["port valve", "port valves"],
            side: Some(side),
            cost: valves.cost,
        });
        cross_port.chain(port_valves).collect()
    }

    /// Adjustments of the accumulators at chambers A and B.
    pub fn adjustments(&self) -> [Option<DeclaredAdjustment>; 2] {
        [&self.line.a, &self.line.b].map(|line| line.accumulator.as_ref()?.adjustment)
    }
}
