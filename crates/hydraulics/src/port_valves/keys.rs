//! Table `[port_valves]`, and its sides `[port_valves.a]` and `[port_valves.b]`.

use phea_dynamics::scalar::Scalar;
use phea_quantity::{FLOW, PRESSURE};
use phea_table::{PartCost, TableNumber, Visitor, key, plain};

use super::{PortValves, TankValve};

/// Valves from the chambers to the tank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredPortValves<S = f64> {
    /// Valves of chamber A.
    pub a: DeclaredPortValve<S>,
    /// Valves of chamber B.
    pub b: DeclaredPortValve<S>,
}

/// Relief and check valve of one chamber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredPortValve<S = f64> {
    /// Pressure above the tank at which the relief valve opens, Pa.
    pub cracking_pressure: Option<S>,
    /// Pressure above that at which `flow` passes, Pa.
    pub pressure_override: Option<S>,
    /// Flow of the relief valve at its override, m³/s.
    pub flow: Option<S>,
    /// Pressure below the tank at which the check valve opens, Pa.
    pub check_valve_pressure: Option<S>,
    /// Pressure beyond that at which `check_valve_flow` passes, Pa.
    pub check_valve_override: Option<S>,
    /// Flow of the check valve at its override, m³/s.
    pub check_valve_flow: Option<S>,
    /// Half width of the transition from shut to open, Pa; absent: 0.1 bar.
    pub transition_pressure: Option<S>,
    /// Cost and mass of the valves of this chamber.
    pub cost: PartCost<S>,
}

/// Half width of the transition of a valve that states none, Pa.
const TRANSITION_PRESSURE: f64 = 1e4;

/// Keys that declare the relief valve, and those that declare the check valve.
const RELIEF: [&str; 3] = ["cracking_pressure", "override", "flow"];
const CHECK: [&str; 2] = ["check_valve_flow", "check_valve_override"];

impl<S: TableNumber> DeclaredPortValves<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let keys = [plain("a", "The valves of chamber A."), plain("b", "The valves of chamber B.")];
        let mut sides = [self.a, self.b];
        v.sides(keys, &[], &mut sides, DeclaredPortValve::visit);
        [self.a, self.b] = sides;
        if sides.iter().all(|side| side.is_absent()) {
            v.lacks(&[&RELIEF, &CHECK], "`cracking_pressure` or `check_valve_pressure`");
        }
    }
}

impl<S: TableNumber> DeclaredPortValve<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let doc = "Chamber pressure above the tank at which the relief valve opens.";
        v.optional(key("cracking_pressure", &PRESSURE, doc).positive(), &mut self.cracking_pressure);
        let doc = "Pressure above the cracking pressure at which the relief valve passes `flow`.";
        v.optional(key("override", &PRESSURE, doc).positive(), &mut self.pressure_override);
        let doc = "Flow of the relief valve at `override` above its cracking pressure.";
        v.optional(key("flow", &FLOW, doc).positive(), &mut self.flow);
        let doc = "Chamber pressure below the tank at which the check valve opens; absent: 0 bar.";
        let k = key("check_valve_pressure", &PRESSURE, doc).not_negative();
        v.optional(k, &mut self.check_valve_pressure);
        let doc =
            "Pressure beyond that at which the check valve passes `check_valve_flow`; absent: `override`.";
        v.optional(key("check_valve_override", &PRESSURE, doc).positive(), &mut self.check_valve_override);
        let doc = "Flow of the check valve at `check_valve_override`; absent: `flow`.";
        v.optional(key("check_valve_flow", &FLOW, doc).positive(), &mut self.check_valve_flow);
        let doc = "Half width of the transition from shut to open; absent: 0.1 bar.";
        v.optional(key("transition_pressure", &PRESSURE, doc).positive(), &mut self.transition_pressure);
        self.cost.visit(v);
        self.lacks(v);
    }

    /// Reports the missing keys of a valve that others declare.
    fn lacks<V: Visitor<S>>(&self, v: &mut V) {
        if self.has_relief() && self.relief().is_none() {
            let what = "`cracking_pressure`, `override` and `flow`, which go together,";
            v.lacks(&[&RELIEF], what);
        } else if self.has_check() && self.check().is_none() {
            let what = "`check_valve_flow` and `check_valve_override`, which a check valve without a relief valve needs,";
            v.lacks(&[&CHECK, &RELIEF], what);
        }
    }
}

impl<S: Copy> DeclaredPortValve<S> {
    /// True if neither valve is declared.
    pub fn is_absent(&self) -> bool {
        !self.has_check() && !self.has_relief()
    }

    fn has_relief(&self) -> bool {
        [self.cracking_pressure, self.pressure_override, self.flow].iter().any(Option::is_some)
    }

    fn has_check(&self) -> bool {
        let Self { check_valve_pressure, check_valve_flow, check_valve_override, .. } = self;
        [check_valve_pressure, check_valve_flow, check_valve_override].into_iter().any(Option::is_some)
    }

    /// Cracking pressure, flow and override of the relief valve.
    fn relief(&self) -> Option<[S; 3]> {
        Some([self.cracking_pressure?, self.flow?, self.pressure_override?])
    }

    /// Flow and override of the check valve.
    fn check(&self) -> Option<[S; 2]> {
        let flow = self.check_valve_flow.or(self.flow)?;
        self.has_check().then_some([flow, self.check_valve_override.or(self.pressure_override)?])
    }
}

impl<S: Scalar> DeclaredPortValves<S> {
    /// Valves of both chambers as physics; `None` for a chamber without.
    pub fn components(&self) -> [Option<PortValves<S>>; 2] {
        [&self.a, &self.b].map(DeclaredPortValve::component)
    }
}

impl<S: Scalar> DeclaredPortValve<S> {
    /// These valves as physics; `None` without a valve.
    ///
    /// # Example
    /// The check valve has flow and override of the relief valve unless it states its own:
    /// ```
    /// use phea_hydraulics::port_valves::DeclaredPortValve;
    /// let declared = DeclaredPortValve {
    ///     cracking_pressure: Some(150e5), pressure_override: Some(10e5), flow: Some(1e-3),
    ///     check_valve_pressure: Some(0.3e5), ..DeclaredPortValve::default()
    /// };
    /// let valves = declared.component().unwrap();
    /// assert_eq!(valves.relief.unwrap().conductance, 1e-9);
    /// assert_eq!(valves.check.unwrap().conductance, 1e-9);
    /// assert_eq!(DeclaredPortValve::<f64>::default().component(), None);
    /// ```
    pub fn component(&self) -> Option<PortValves<S>> {
        let valve =
            |cracking_pressure, flow: S, at: S| TankValve { cracking_pressure, conductance: flow / at };
        let closed = self.check_valve_pressure.unwrap_or(S::from(0.0));
        let relief = self.relief().map(|[cracking, flow, at]| valve(cracking, flow, at));
        let check = self.check().map(|[flow, at]| valve(closed, flow, at));
        if relief.is_none() && check.is_none() {
            return None;
        }
        let transition_pressure = self.transition_pressure.unwrap_or(S::from(TRANSITION_PRESSURE));
        Some(PortValves { relief, check, transition_pressure })
    }
}
