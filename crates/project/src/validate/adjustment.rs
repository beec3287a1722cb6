//! Accumulators that are adjusted, and what moves their setting.

use super::Check;
use crate::{
    AdjustmentKind, DeclaredAccumulator, DeclaredActuator, DeclaredAdjustment, DeclaredSupply, GasAtOne,
    Scenario, Signal, SignalUnit, Uncertain,
};
use phea_quantity::{self as quantity, PRESSURE};

/// Pa, between absolute and gauge pressures.
const ATMOSPHERE: f64 = 101_325.0;

/// The adjustment of the gas at a chamber.
pub(super) fn adjustment(
    gas: &DeclaredAccumulator,
    supply: &DeclaredSupply,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let Some(declared) = &gas.adjustment else { return };
    let path = &format!("{path}.adjustment");
    match &declared.kind {
        AdjustmentKind::Valve(_) => {
            if gas.neck.is_some() {
                let message = "a `valve` lies between chamber and gas, and the accumulator states a neck: one of them leads to the gas";
                let help = "leave out `neck_diameter` and `neck_length`, or adjust the `gas`";
                check.error_with_help(&format!("{path}.kind"), message, help);
            }
        }
        AdjustmentKind::Gas(last) => {
            if gas.thermal_time_constant.is_some() {
                let message = "which temperature gas has that is added is not modelled: `kind` \"gas\" goes with a `polytropic_exponent`";
                let help = "leave out `thermal_time_constant`, or adjust by a `valve`";
                check.error_with_help(&format!("{path}.kind"), message, help);
            }
            moved(gas, last, supply, path, check);
        }
    }
}

fn moved(
    gas: &DeclaredAccumulator,
    last: &GasAtOne,
    supply: &DeclaredSupply,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let stands = |name: &str| {
        let message = format!("`{name}` at setting 1 is that of the accumulator: the setting moves nothing");
        let help = format!("state another `{name}`, or leave out the adjustment");
        (format!("{path}.{name}"), message, help)
    };
    let same = [
        ("gas_volume", last.gas_volume, gas.gas_volume),
        ("precharge_pressure", last.precharge_pressure, gas.precharge_pressure),
    ];
    for (name, _, _) in same.into_iter().filter(|(_, last, first)| *last == Some(*first)) {
        let (path, message, help) = stands(name);
        check.error_with_help(&path, message, help);
    }
    let [_, at_one] = gas.ends();
    let working = at_one.working_precharge(ATMOSPHERE);
    if last.precharge_pressure.is_some() && supply.pressure > 0.0 && working >= supply.pressure {
        let [precharge, pressure] =
            [working, supply.pressure].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
        let message = format!(
            "`precharge_pressure` is {precharge} at setting 1 and the supply has {pressure}: no chamber ever lets oil into this accumulator there"
        );
        let help = "the gas is in use only above its precharge: state one below the lowest pressure at which it is to work";
        check.error_with_help(&format!("{path}.precharge_pressure"), message, help);
    }
}

/// The course of the setting in a scenario.
pub(super) fn course(
    scenario: &Scenario,
    actuator: &DeclaredActuator,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let (signals, unit) = (&scenario.setting_change, SignalUnit::SETTING_CHANGE);
    super::signal::signals(signals, unit, [path, "setting_change"], scenario.duration, check);
    if signals.is_empty() {
        return;
    }
    let place = format!("{path}.setting_change");
    let adjusted: Vec<DeclaredAdjustment> = actuator.adjustments().into_iter().flatten().collect();
    if adjusted.is_empty() {
        let message = "no accumulator at a chamber is adjusted: there is no setting to change";
        let help = "state [line.accumulator.adjustment], or leave out `setting_change`";
        return check.error_with_help(&place, message, help);
    }
    let moves_gas = adjusted.iter().any(|one| one.valve().is_none());
    let jumps = |signal: &Signal| match signal {
        Signal::Step { at, .. } => *at > 0.0,
        Signal::Steps { times, .. } => times.iter().any(|time| *time > 0.0),
        _ => false,
    };
    for (index, _) in signals.iter().enumerate().filter(|(_, signal)| moves_gas && jumps(signal)) {
        let message = "a step would add or take gas in no time";
        let help = "let the setting move in a time: `kind = \"ramp\"` with a `duration`";
        check.error_with_help(&format!("{place}[{index}]"), message, help);
    }
}

/// The end of the path of a setting.
const SETTING: &str = "accumulator.adjustment.setting";

/// The setting of a valve opens in every plant of a family.
pub(super) fn uncertain(
    uncertain: &Uncertain,
    actuator: Option<&DeclaredActuator>,
    check: &mut Check<'_, '_>,
) {
    if !uncertain.name.ends_with(SETTING) {
        return;
    }
    let path = format!("uncertainty.{}", uncertain.name);
    let sides = actuator.map_or([None; 2], DeclaredActuator::adjustments);
    if uncertain.minimum == 0.0 && sides.into_iter().flatten().any(|one| one.valve().is_some()) {
        let message = "a `valve` that is shut takes its gas out of the plant: it is no limit of plants with the gas in them";
        let help = "let the range begin above 0, and judge the shut valve as an alternative of its own with `setting = 0`";
        check.error_with_help(&format!("{path}.minimum"), message, help);
    }
}
