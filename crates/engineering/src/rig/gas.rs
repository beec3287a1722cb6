//! Accumulators as they are declared, with what of them is adjusted.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::accumulator::{
    Accumulator, AdjustedGas, ChamberGas, GasContent, GasPassage, GasValve, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, Fluid};

use super::assembly::neck;
use super::cross_port::edge;
use super::numbers::Numbers;
use crate::project::{AdjustmentKind, DeclaredAccumulator, DeclaredGasValve, GasAtOne, GasTemperatures};
use crate::quantity::ZERO_CELSIUS;

/// Within the table of a line.
const TABLE: [&str; 2] = ["accumulator", "adjustment"];

/// An accumulator declared in the table that `numbers` are within, at its working temperature and
/// the setting at rest of its adjustment; with a thermal time constant it is isothermal at rest.
pub(super) fn accumulator<S: Scalar>(
    declared: &DeclaredAccumulator,
    numbers: &Numbers<'_, S>,
) -> Accumulator<S> {
    at_rest(declared, numbers, warm(declared, numbers))
}

/// The gas at a chamber, declared in the line that `numbers` are of; the reader has refused a neck
/// beside a valve, and heat of gas that is added and removed.
pub(super) fn chamber_gas<S: Scalar>(
    declared: &DeclaredAccumulator,
    numbers: &Numbers<'_, S>,
    fluid: &Fluid<S>,
) -> ChamberGas<S> {
    let at_rest = accumulator(declared, numbers);
    let oil = [fluid.density, fluid.kinematic_viscosity, fluid.bulk_modulus];
    let neck = neck(declared, numbers, oil);
    let passage = match declared.adjustment.map(|of| of.kind) {
        Some(AdjustmentKind::Gas(last)) => {
            let [volume_rise, precharge_rise] = rises(declared, &last, numbers, &warm(declared, numbers));
            let setting = setting(declared, numbers);
            let gas = AdjustedGas { at_rest, setting, volume_rise, precharge_rise, neck };
            return ChamberGas::Adjusted(gas);
        }
        Some(AdjustmentKind::Valve(valve)) => GasPassage::Valve(gas_valve(declared, &valve, numbers, fluid)),
        None => neck.map_or(GasPassage::Open, GasPassage::Neck),
    };
    let content = match declared.thermal_time_constant {
        None => GasContent::Polytropic(at_rest),
        Some(time_constant) => GasContent::Relaxing(RelaxingGas {
            gas_volume: at_rest.gas_volume,
            precharge_pressure: at_rest.precharge_pressure,
            time_constant: numbers.at("accumulator.thermal_time_constant", time_constant),
        }),
    };
    ChamberGas::Sealed(SealedGas { content, passage })
}

/// The same at setting 0.
fn warm<S: Scalar>(declared: &DeclaredAccumulator, numbers: &Numbers<'_, S>) -> Accumulator<S> {
    let polytropic = || numbers.at("accumulator.polytropic_exponent", declared.polytropic_exponent);
    let stated = Accumulator {
        gas_volume: numbers.at("accumulator.gas_volume", declared.gas_volume),
        precharge_pressure: numbers.at("accumulator.precharge_pressure", declared.precharge_pressure),
        polytropic_exponent: declared.thermal_time_constant.map_or_else(polytropic, |_| S::from(1.0)),
    };
    let Some(GasTemperatures { precharge, working }) = declared.temperatures else { return stated };
    let absolute = |path: &str, celsius: f64| numbers.at(path, celsius) + S::from(ZERO_CELSIUS);
    let precharge = absolute("accumulator.precharge_temperature", precharge);
    stated.at_temperature([precharge, absolute("accumulator.working_temperature", working)])
}

fn setting<S: Scalar>(declared: &DeclaredAccumulator, numbers: &Numbers<'_, S>) -> S {
    numbers.at("accumulator.adjustment.setting", declared.adjustment.map_or(0.0, |of| of.setting))
}

/// What the setting adds to the gas from 0 to 1, which is `first` at 0: volume in m3, precharge in
/// Pa.
///
/// ```text
/// P_1 = (P_{stated, 1} - P_{stated, 0}) P_0/P_{stated, 0}             absolute: the temperature acts on both alike
/// ```
fn rises<S: Scalar>(
    declared: &DeclaredAccumulator,
    last: &GasAtOne,
    numbers: &Numbers<'_, S>,
    first: &Accumulator<S>,
) -> [S; 2] {
    let zero = S::from(0.0);
    let rise = |key: &'static str, first: S, last: Option<f64>| {
        let [table, inner] = TABLE;
        last.map_or(zero, |last| numbers.within(table).within(inner).at(key, last) - first)
    };
    let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
    let stated = numbers.at("accumulator.precharge_pressure", declared.precharge_pressure);
    let warming = (first.precharge_pressure + atmosphere) / (stated + atmosphere);
    [
        rise("gas_volume", first.gas_volume, last.gas_volume),
        rise("precharge_pressure", stated, last.precharge_pressure) * warming,
    ]
}

/// The gas at its setting of rest, which is `first` at setting 0.
fn at_rest<S: Scalar>(
    declared: &DeclaredAccumulator,
    numbers: &Numbers<'_, S>,
    first: Accumulator<S>,
) -> Accumulator<S> {
    let Some(AdjustmentKind::Gas(last)) = declared.adjustment.map(|of| of.kind) else { return first };
    let [volume, precharge] = rises(declared, &last, numbers, &first);
    let setting = setting(declared, numbers);
    Accumulator {
        gas_volume: first.gas_volume + volume * setting,
        precharge_pressure: first.precharge_pressure + precharge * setting,
        ..first
    }
}

/// A rig with the setting of every adjustment there, for slow motions: an open valve is the gas at
/// its chamber, a shut one no gas.
pub fn components_at_setting(components: &Components, setting: f64) -> Components {
    let gas = components.gas.map(|gas| Some(ChamberGas::Sealed(gas?.at_setting(setting)?)));
    Components { gas, ..*components }
}

fn gas_valve<S: Scalar>(
    declared: &DeclaredAccumulator,
    valve: &DeclaredGasValve,
    numbers: &Numbers<'_, S>,
    fluid: &Fluid<S>,
) -> GasValve<S> {
    let [table, inner] = TABLE;
    let within = numbers.within(table).within(inner);
    let is_shut = declared.adjustment.is_some_and(|of| of.setting == 0.0);
    let [flow_coefficient, transition_pressure] = edge(&valve.orifice, &within, fluid.density);
    GasValve {
        setting: setting(declared, numbers),
        flow_coefficient,
        transition_pressure,
        compliance: within.at("dead_volume", valve.dead_volume(declared.gas_volume)) / fluid.bulk_modulus,
        shut: is_shut && !within.is_open("setting"),
    }
}
