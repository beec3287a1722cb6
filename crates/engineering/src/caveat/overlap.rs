//! Caveat for a valve whose edges overlap.

use phea_hydraulics::servovalve::{OpeningLaw, Servovalve, SpoolDirection, Supply, chamber_coefficients};

use super::UncountedEffect;
use crate::setup::Setup;

/// Travel beyond the lap at which an edge is open, in laps.
const BEYOND: f64 = 2.0;

/// Effect of an overlap: within it a valve passes only leakage, and no linear plant has both this
/// and the flow beyond.
pub(super) fn overlap(setup: &Setup<'_>) -> Option<UncountedEffect> {
    let components = setup.rig().ok()?.actuator.components();
    let [from, to, gain_ratio] = dead_band(&components.valve, &components.supply)?;
    Some(UncountedEffect::Overlap { dead_band: [from, to], gain_ratio })
}

/// Spool positions between which no edge is open, and ratio of the magnitude of the flow gain in
/// the middle to that beyond.
pub(crate) fn dead_band(valve: &Servovalve, supply: &Supply) -> Option<[f64; 3]> {
    let OpeningLaw::Shaped(shape) = valve.opening else { return None };
    let [from, to] = [-shape.lap_negative, shape.lap_positive].map(|lap| lap * valve.nominal_voltage);
    if from >= to {
        return None;
    }
    let middle = 0.5 * (supply.pressure + supply.tank_pressure);
    let gain = |spool: f64| {
        let found = chamber_coefficients(valve, supply, spool, middle, middle, SpoolDirection::Mean);
        found.flow_gain_a + found.flow_gain_b
    };
    let width = to - from;
    let beyond = f64::midpoint(gain(to + BEYOND * width), gain(from - BEYOND * width));
    Some([from, to, (gain(f64::midpoint(from, to)) / beyond).abs()])
}
