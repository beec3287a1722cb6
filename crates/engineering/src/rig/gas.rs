//! Declared accumulators as the gas of `phea_hydraulics`.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::accumulator::{
    Accumulator, AdjustedGas, ChamberGas, GasContent, GasPassage, GasValve, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, Fluid};

use super::cross_port::edge;
use crate::project::{
    AdjustmentKind, DeclaredAccumulator, DeclaredAdjustment, DeclaredGasValve, DeclaredNeck, GasAtOne,
    GasTemperatures,
};
use crate::quantity::ZERO_CELSIUS;

/// Polytropic gas of an accumulator declared in the table that `numbers` are within, at its working
/// temperature and setting 0.
pub(super) fn accumulator<S: Scalar>(declared: &DeclaredAccumulator<S>) -> Accumulator<S> {
    let stated = Accumulator {
        gas_volume: declared.gas_volume,
        precharge_pressure: declared.precharge_pressure,
        polytropic_exponent: declared.polytropic_exponent,
    };
    let Some(GasTemperatures { precharge, working }) = declared.temperatures else { return stated };
    stated.at_temperature([precharge, working].map(|celsius| celsius + S::from(ZERO_CELSIUS)))
}

/// Gas at a chamber. The reader rejects a neck next to
/// a valve, and heat of gas that is added and removed.
pub(super) fn chamber_gas<S: Scalar>(declared: &DeclaredAccumulator<S>, fluid: &Fluid<S>) -> ChamberGas<S> {
    let gas = accumulator(declared);
    let neck = declared.neck.map(|declared| neck(&declared, fluid));
    let maximum_pressure_ratio = declared.maximum_pressure_ratio;
    let passage = match declared.adjustment {
        None => neck.map_or(GasPassage::Open, GasPassage::Neck),
        Some(DeclaredAdjustment { kind: AdjustmentKind::Valve(valve), setting }) => {
            GasPassage::Valve(gas_valve((&valve, setting, declared.gas_volume), fluid))
        }
        Some(DeclaredAdjustment { kind: AdjustmentKind::Gas(last), setting }) => {
            let stated = declared.precharge_pressure;
            let adjusted = adjusted((gas, stated), (&last, setting), neck);
            return ChamberGas::Adjusted(AdjustedGas { maximum_pressure_ratio, ..adjusted });
        }
    };
    let Accumulator { gas_volume, precharge_pressure, .. } = gas;
    let content = match declared.thermal_time_constant {
        None => GasContent::Polytropic(gas),
        Some(time_constant) => {
            GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
        }
    };
    ChamberGas::Sealed(SealedGas { content, passage, maximum_pressure_ratio })
}

/// Gas that is added and removed: from `first`, whose precharge in Pa is `stated` for another
/// temperature, at setting 0, to `last` at setting 1.
///
/// ```text
/// P_1 = (P_{stated, 1} - P_{stated, 0}) P_0/P_{stated, 0}             absolute: the temperature acts on both alike
/// ```
fn adjusted<S: Scalar>(
    (first, stated): (Accumulator<S>, S),
    (last, setting): (&GasAtOne<S>, Option<S>),
    neck: Option<Neck<S>>,
) -> AdjustedGas<S> {
    let rise = |first: S, last: Option<S>| last.map_or(S::from(0.0), |last| last - first);
    let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
    let warming = (first.precharge_pressure + atmosphere) / (stated + atmosphere);
    let volume_rise = rise(first.gas_volume, last.gas_volume);
    let precharge_rise = rise(stated, last.precharge_pressure) * warming;
    let setting = setting.unwrap_or_default();
    let at_rest = Accumulator {
        gas_volume: first.gas_volume + volume_rise * setting,
        precharge_pressure: first.precharge_pressure + precharge_rise * setting,
        ..first
    };
    AdjustedGas { at_rest, setting, volume_rise, precharge_rise, neck, maximum_pressure_ratio: None }
}

/// Valve with this setting at rest before gas of this volume in m3.
fn gas_valve<S: Scalar>(
    (valve, setting, gas_volume): (&DeclaredGasValve<S>, Option<S>, S),
    fluid: &Fluid<S>,
) -> GasValve<S> {
    let [flow_coefficient, transition_pressure] = edge(&valve.orifice, fluid.density);
    GasValve {
        setting: setting.unwrap_or_default(),
        flow_coefficient,
        transition_pressure,
        compliance: valve.dead_volume(gas_volume) / fluid.bulk_modulus,
        shut: setting.is_none(),
    }
}

/// Neck filled with this fluid.
fn neck<S: Scalar>(declared: &DeclaredNeck<S>, fluid: &Fluid<S>) -> Neck<S> {
    let size = [declared.diameter, declared.length];
    let oil = [fluid.density, fluid.kinematic_viscosity, fluid.bulk_modulus];
    Neck::round(size, oil, declared.loss_coefficient)
}

/// A rig with the setting of every adjustment there, for slow motions: an open valve is the gas at
/// its chamber, a shut one no gas.
pub fn components_at_setting(components: &Components, setting: f64) -> Components {
    let gas = components.gas.map(|gas| Some(ChamberGas::Sealed(gas?.at_setting(setting)?)));
    Components { gas, ..*components }
}
