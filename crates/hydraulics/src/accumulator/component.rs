//! Accumulators from their tables.

use phea_dynamics::scalar::Scalar;
use phea_quantity::ZERO_CELSIUS;

use super::adjustment_keys::{AdjustmentKind, DeclaredAdjustment, DeclaredGasValve, GasAtOne};
use super::keys::{DeclaredAccumulator, DeclaredNeck, GasTemperatures};
use super::{
    Accumulator, AdjustedGas, ChamberGas, GasContent, GasPassage, GasValve, Neck, RelaxingGas, SealedGas,
};
use crate::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, Fluid};

impl<S: Scalar> DeclaredAccumulator<S> {
    /// Polytropic gas at its working temperature and setting 0.
    pub fn component(&self) -> Accumulator<S> {
        let stated = Accumulator {
            gas_volume: self.gas_volume,
            precharge_pressure: self.precharge_pressure,
            polytropic_exponent: self.polytropic_exponent,
        };
        let Some(GasTemperatures { precharge, working }) = self.temperatures else { return stated };
        stated.at_temperature([precharge, working].map(|celsius| celsius + S::from(ZERO_CELSIUS)))
    }

    /// Gas at a chamber. The reader rejects a neck next to a valve, and heat of gas that is added
    /// and removed.
    pub fn chamber_gas(&self, fluid: &Fluid<S>) -> ChamberGas<S> {
        let gas = self.component();
        let neck = self.neck.map(|declared| declared.component(fluid));
        let maximum_pressure_ratio = self.maximum_pressure_ratio;
        let passage = match self.adjustment {
            None => neck.map_or(GasPassage::Open, GasPassage::Neck),
            Some(DeclaredAdjustment { kind: AdjustmentKind::Valve(valve), setting }) => {
                GasPassage::Valve(valve.component((setting, self.gas_volume), fluid))
            }
            Some(DeclaredAdjustment { kind: AdjustmentKind::Gas(last), setting }) => {
                let stated = self.precharge_pressure;
                let adjusted = adjusted((gas, stated), (&last, setting), neck);
                return ChamberGas::Adjusted(AdjustedGas { maximum_pressure_ratio, ..adjusted });
            }
        };
        let Accumulator { gas_volume, precharge_pressure, .. } = gas;
        let content = match self.thermal_time_constant {
            None => GasContent::Polytropic(gas),
            Some(time_constant) => {
                GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
            }
        };
        ChamberGas::Sealed(SealedGas { content, passage, maximum_pressure_ratio })
    }
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

impl<S: Scalar> DeclaredGasValve<S> {
    /// Valve with this setting at rest before gas of this volume in m3.
    fn component(&self, (setting, gas_volume): (Option<S>, S), fluid: &Fluid<S>) -> GasValve<S> {
        let [flow_coefficient, transition_pressure] = self.orifice.edge(fluid.density);
        GasValve {
            setting: setting.unwrap_or_default(),
            flow_coefficient,
            transition_pressure,
            compliance: self.dead_volume(gas_volume) / fluid.bulk_modulus,
            shut: setting.is_none(),
        }
    }
}

impl<S: Scalar> DeclaredNeck<S> {
    /// Neck filled with this fluid.
    fn component(&self, fluid: &Fluid<S>) -> Neck<S> {
        let size = [self.diameter, self.length];
        let oil = [fluid.density, fluid.kinematic_viscosity, fluid.bulk_modulus];
        Neck::round(size, oil, self.loss_coefficient)
    }
}
