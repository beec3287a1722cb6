//! Uncertain precharges of accumulators: the supply must reach each of them.

use super::Check;
use crate::{DeclaredAccumulator, DeclaredActuator, Project, Pump, SupplyModel};
use phea_hydraulics::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE as ATMOSPHERE;
use phea_quantity::{self as quantity, PRESSURE};

/// Checks the ends of the ranges of a precharge: the supply must reach the highest, and must not
/// compress the lowest beyond the maker's limit.
pub(super) fn ranges(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let range_of = |name: &str| project.uncertainty.iter().find(|one| one.name == name);
    let supply = range_of("supply.pressure").map_or(actuator.supply.pressure, |range| range.maximum);
    supply_falls_short(project, actuator, check);
    let sides = [("line.a", &actuator.line.a), ("line.b", &actuator.line.b)];
    let mut seen = vec![];
    for (side, line) in sides {
        let Some(gas) = &line.accumulator else { continue };
        let names = [side, "line"].map(|table| format!("{table}.accumulator.precharge_pressure"));
        let Some(range) =
            names.iter().find_map(|name| range_of(name)).filter(|range| !seen.contains(&&range.name))
        else {
            continue;
        };
        seen.push(&range.name);
        let at = |precharge_pressure: f64| DeclaredAccumulator { precharge_pressure, ..*gas };
        let place = format!("uncertainty.{}", range.name);
        at(range.minimum).check_pressure_ratio(supply, &format!("{place}.minimum"), check);
        let working = at(range.maximum).working_precharge(ATMOSPHERE);
        if supply > 0.0 && working >= supply {
            let [precharge, pressure] =
                [working, supply].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
            let message = format!(
                "the precharge goes up to {precharge} and the supply has {pressure}: no chamber ever lets oil into this accumulator there"
            );
            let help = "let the range end below the lowest pressure at which the gas is to work";
            check.error_with_help(&format!("{place}.maximum"), message, help);
        }
    }
}

/// Rejects a range of the supply pressure that extends below the precharge of the supply's own
/// accumulator.
fn supply_falls_short(project: &Project, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let range = project.uncertainty.iter().find(|one| one.name == "supply.pressure");
    let SupplyModel::PumpLimited(Pump { accumulator: Some(gas), .. }) = &actuator.supply.model else {
        return;
    };
    let working = gas.working_precharge(ATMOSPHERE);
    let stated = actuator.supply.pressure;
    // without a stated pressure above the precharge the pressure itself is rejected
    let Some(range) = range.filter(|range| range.minimum <= working && working < stated) else { return };
    let [pressure, precharge] =
        [range.minimum, working].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
    let message = format!(
        "the supply goes down to {pressure} and its accumulator has a precharge of {precharge}: the pump never lets oil into it there"
    );
    let help = "let the range end above the precharge, or state a lower `precharge_pressure`";
    check.error_with_help("uncertainty.supply.pressure.minimum", message, help);
}
