//! The settled state of the supply of a rig, over any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::operating_point::{Balance, SettledSupply, Steady};
use phea_hydraulics::plant::YieldingSupply;
use phea_hydraulics::power_unit::PowerUnit;
use phea_hydraulics::servovalve::{SpoolDirection, edge_conductances, edge_flows, tare_flow};

use super::Rig;

/// The settled state of a limited pump with valve and chambers, given the balance at the stated
/// supply; `None` for a constant pressure.
pub fn settled_supply<S: Scalar>(
    power_unit: &PowerUnit<S>,
    balance: &Balance<S>,
    steady: Steady<S>,
) -> Option<SettledSupply<S>> {
    match power_unit {
        PowerUnit::Constant => None,
        PowerUnit::PumpLimited(unit) => Some(balance.settled_supply(unit, steady)),
    }
}

/// That supply for small motions.
pub(crate) fn yielding_supply<S: Scalar>(
    power_unit: &PowerUnit<S>,
    balance: &Balance<S>,
    settled: &SettledSupply<S>,
    side: SpoolDirection<S>,
) -> Option<YieldingSupply<S>> {
    let PowerUnit::PumpLimited(unit) = power_unit else { return None };
    Some(YieldingSupply::new(unit, balance, balance.supply.pressure, settled, side))
}

/// Power in W that the valve takes from the supply at the operating point: leakage and tare flow
/// where the actuator rests.
///
/// ```text
/// P = p_S (q_v3 + q_v5 + q_tare)
/// ```
///
/// What a pump delivers beyond that, through its relief valve, is not in it.
pub(crate) fn power_at_rest(rig: &Rig) -> f64 {
    if let Some(found) = rig.supply {
        return found.taken * found.supply.pressure;
    }
    let components = rig.actuator.components();
    let (valve, supply, point) = (&components.valve, &components.supply, &rig.point);
    let edges = edge_flows(
        valve,
        supply,
        &edge_conductances(valve, point.command),
        point.pressure_a,
        point.pressure_b,
    );
    supply.pressure * (edges.supply_to_a + edges.supply_to_b + tare_flow(valve, supply))
}
