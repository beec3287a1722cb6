//! Gas and hoses at the chambers over a run.

use phea_engineering::simulate::{BeyondExpansion, GasRange, ScenarioRun};

use crate::answer::{Answer, Reasoned};

/// Work of the adjustment of accumulators over a run, and the loss in the valves to their gas.
#[derive(Answer)]
pub(super) struct GasAdjustmentAnswer {
    /// Work of the adjustment into the oil: integral of its power while that is positive.
    adjustment_brought_j: Reasoned<f64>,
    /// Work of the adjustment out of the oil, as a magnitude: integral of its power while that is
    /// negative.
    adjustment_taken_j: Reasoned<f64>,
    /// Energy lost in the valves between chambers and gas.
    gas_valve_throttled_j: Reasoned<f64>,
}

/// Gas at a chamber over a run.
#[derive(Answer)]
pub(super) struct ChamberGasAnswer {
    /// Chamber, `a` or `b`.
    chamber: char,
    /// Highest gauge pressure.
    peak_pressure_pa: f64,
    /// Ratio of the lowest absolute temperature to that of the wall.
    temperature_least_ratio: Reasoned<f64>,
    /// Ratio of the highest absolute temperature to that of the wall.
    temperature_peak_ratio: Reasoned<f64>,
}

/// Chamber above the pressure up to which the expansion of its hose is stated.
#[derive(Answer)]
pub(super) struct BeyondExpansionAnswer {
    /// Chamber, `a` or `b`.
    chamber: char,
    /// Highest gauge pressure.
    peak_pressure_pa: f64,
    /// Gauge pressure up to which the expansion is stated.
    stated_pressure_pa: f64,
}

/// Reason why there is no work of an adjustment.
const NOT_ADJUSTED: &str = "no setting of an accumulator moves, and no valve leads to its gas";
const NO_GAS_VALVE: &str = "no valve lies between a chamber and its gas";
/// Reason why there is no temperature.
const NO_HEAT: &str = "a polytropic exponent gives no temperature: state `thermal_time_constant`";

/// The work of the adjustment of accumulators.
pub(super) fn adjustment(run: &ScenarioRun) -> GasAdjustmentAnswer {
    let work = run.adjustment;
    GasAdjustmentAnswer {
        adjustment_brought_j: Reasoned::new(work.map(|of| of.brought_j), NOT_ADJUSTED),
        adjustment_taken_j: Reasoned::new(work.map(|of| of.taken_j), NOT_ADJUSTED),
        gas_valve_throttled_j: Reasoned::new(work.and_then(|of| of.throttled_j), NO_GAS_VALVE),
    }
}

/// The gas at a chamber.
pub(super) fn gas(gas: &GasRange) -> ChamberGasAnswer {
    let ratio = |ratio: fn([f64; 2]) -> f64| Reasoned::new(gas.temperature_ratios.map(ratio), NO_HEAT);
    ChamberGasAnswer {
        chamber: gas.chamber,
        peak_pressure_pa: gas.peak_pa,
        temperature_least_ratio: ratio(|[low, _]| low),
        temperature_peak_ratio: ratio(|[_, high]| high),
    }
}

/// A chamber above the pressure at which the expansion of its hose is stated.
pub(super) fn beyond(beyond: &BeyondExpansion) -> BeyondExpansionAnswer {
    BeyondExpansionAnswer {
        chamber: beyond.chamber,
        peak_pressure_pa: beyond.peak_pa,
        stated_pressure_pa: beyond.stated_pa,
    }
}
