//! The largest flow of the lines.

use phea_hydraulics::actuator::Components;
use phea_hydraulics::servovalve::{SpoolDirection, velocity_gain};

use crate::project::{DeclaredSupply, Pump, SupplyModel};

/// The largest flows of a rig in m3/s: with the valve fully open and the piston unloaded, as far as
/// the supply gives them.
///
/// ```text
/// extending:   q_S = min(A_A v, q_pump),   q_A = q_S,            q_B = q_S A_B/A_A
/// retracting:  q_S = min(A_B v, q_pump),   q_A = q_S A_A/A_B,    q_B = q_S
/// v = U_Cn times the velocity gain and the relative opening at full travel;  equal areas: A v = q_vn sqrt((p_S - p_T)/dp_tn)
/// ```
///
/// The rating dp_tn is the drop over both edges, each of which has half of it. An accumulator on
/// the supply line delivers more than the pump for a time: with one q_pump limits nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct LargestFlow {
    /// Of line A and of line B.
    pub lines: [f64; 2],
    /// Into the valve from the supply.
    pub taken: f64,
    /// The largest of a line that the valve passes, whatever the supply gives.
    pub valve: f64,
    /// The part of the rig that limits the largest of a line.
    pub limit: FlowLimit,
    /// What the pump gives, and whether an accumulator adds to it; `None` where it is not stated.
    pub pump: Option<(f64, bool)>,
}

/// The part of a rig that limits its largest flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlowLimit {
    /// The valve fully open.
    Valve,
    /// The pump.
    Pump,
}

/// Those of one direction of motion: into the valve from the supply, and of both lines.
struct DirectionFlows {
    taken: f64,
    lines: [f64; 2],
}

/// The largest flows over both directions and all stages of the piston.
pub fn largest_flow(components: &Components, supply: &DeclaredSupply) -> LargestFlow {
    let pump = supply.flow().map(|flow| {
        let stored = matches!(&supply.model, SupplyModel::PumpLimited(Pump { accumulator: Some(_), .. }));
        (flow, stored)
    });
    let bound = pump.filter(|(_, stored)| !stored).map_or(f64::INFINITY, |(flow, _)| flow);
    let mut largest = LargestFlow { lines: [0.0; 2], taken: 0.0, valve: 0.0, limit: FlowLimit::Valve, pump };
    for areas in components.cylinder.areas_of_stages() {
        for direction in [SpoolDirection::Extending, SpoolDirection::Retracting] {
            let valve = flows(components, areas, direction, f64::INFINITY);
            let given = flows(components, areas, direction, bound);
            if given.line() > largest.line() {
                largest.limit = if given.taken < valve.taken { FlowLimit::Pump } else { FlowLimit::Valve };
            }
            largest.valve = largest.valve.max(valve.line());
            largest.taken = largest.taken.max(given.taken);
            largest.lines = [0, 1].map(|side| largest.lines[side].max(given.lines[side]));
        }
    }
    largest
}

/// Those of one direction, of which the supply gives so much at most; none where the supply cannot
/// move the unloaded piston this way.
fn flows(components: &Components, areas: [f64; 2], direction: SpoolDirection, bound: f64) -> DirectionFlows {
    let (valve, supply) = (&components.valve, &components.supply);
    let driven = usize::from(direction == SpoolDirection::Retracting);
    let full = valve.opening.full()[driven] * valve.nominal_voltage;
    let speed = velocity_gain(valve, supply, areas, 0.0, direction).unwrap_or(0.0) * full;
    let taken = (areas[driven] * speed).min(bound);
    DirectionFlows { taken, lines: areas.map(|area| taken * area / areas[driven]) }
}

impl DirectionFlows {
    fn line(&self) -> f64 {
        self.lines[0].max(self.lines[1])
    }
}

impl LargestFlow {
    /// The largest of a line, m3/s.
    pub fn line(&self) -> f64 {
        self.lines[0].max(self.lines[1])
    }
}
