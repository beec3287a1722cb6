//! Table `[port_valves]`, and its sides `[port_valves.a]` and `[port_valves.b]`.

use phea_quantity::{FLOW, PRESSURE};
use phea_table::{PartCost, TableNumber, Visitor, key, plain};

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

/// Keys that declare a relief valve.
const RELIEF: [&str; 2] = ["cracking_pressure", "override"];

/// Each of these keys declares a valve, or the table of one side that does.
const ONE_EACH: [[&str; 1]; 5] =
    [["check_valve_pressure"], ["check_valve_flow"], ["check_valve_override"], ["a"], ["b"]];

impl<S: TableNumber> DeclaredPortValves<S> {
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let keys = [plain("a", "The valves of chamber A."), plain("b", "The valves of chamber B.")];
        let mut sides = [self.a, self.b];
        v.sides(keys, &[], &mut sides, DeclaredPortValve::visit);
        [self.a, self.b] = sides;
        if sides.iter().all(|side| side.is_absent()) {
            let ways = [&RELIEF[..]].into_iter().chain(ONE_EACH.iter().map(|key| &key[..]));
            v.lacks(&ways.collect::<Vec<_>>(), "`cracking_pressure` or `check_valve_pressure`");
        }
    }
}

impl<S: TableNumber> DeclaredPortValve<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let doc = "Chamber pressure above the tank at which the relief valve opens.";
        v.optional(key("cracking_pressure", &PRESSURE, doc).positive(), &mut self.cracking_pressure);
        let doc = "Pressure above the cracking pressure at which the relief valve passes `flow`.";
        v.optional(key("override", &PRESSURE, doc).positive(), &mut self.pressure_override);
        let doc = "Flow of the relief valve at `override`; absent: that of the open servovalve at 70 bar.";
        v.optional(key("flow", &FLOW, doc).positive(), &mut self.flow);
        let doc = "Chamber pressure below the tank at which the check valve opens; absent: 0 bar.";
        let k = key("check_valve_pressure", &PRESSURE, doc).not_negative();
        v.optional(k, &mut self.check_valve_pressure);
        let doc = "Pressure beyond that at which the check valve passes `check_valve_flow`; absent: 1 bar.";
        v.optional(key("check_valve_override", &PRESSURE, doc).positive(), &mut self.check_valve_override);
        let doc = "Flow of the check valve at `check_valve_override`; absent: as `flow`.";
        v.optional(key("check_valve_flow", &FLOW, doc).positive(), &mut self.check_valve_flow);
        let doc = "Half width of the transition from shut to open; absent: 0.1 bar.";
        v.optional(key("transition_pressure", &PRESSURE, doc).positive(), &mut self.transition_pressure);
        self.cost.visit(v);
        if self.has_relief() && self.relief().is_none() {
            v.lacks(&[&RELIEF], "`cracking_pressure` and `override`, which go together,");
        }
    }
}

impl<S: Copy> DeclaredPortValve<S> {
    /// True if neither valve is declared.
    pub fn is_absent(&self) -> bool {
        !self.has_check() && !self.has_relief()
    }

    fn has_relief(&self) -> bool {
        self.cracking_pressure.is_some() || self.pressure_override.is_some()
    }

    /// True if the check valve is declared.
    pub(super) fn has_check(&self) -> bool {
        let Self { check_valve_pressure, check_valve_flow, check_valve_override, .. } = self;
        [check_valve_pressure, check_valve_flow, check_valve_override].into_iter().any(Option::is_some)
    }

    /// Cracking pressure and override of the relief valve; `None` without one.
    pub(super) fn relief(&self) -> Option<[S; 2]> {
        Some([self.cracking_pressure?, self.pressure_override?])
    }
}
