//! Caveat for a valve whose leakage is least at null.

use phea_hydraulics::servovalve::{Servovalve, Supply, blocked_ports};

use super::UncountedEffect;
use crate::setup::Setup;

/// Number of openings on either side of null at which the leakage is computed, and the greatest
/// opening, in widths of the leakage.
const OPENINGS: usize = 160;
const WIDTHS: f64 = 8.0;
/// Least fraction by which the leakage at null is less than next to it; for the valve of the thesis
/// it is 7.4 %.
const DIP: f64 = 0.08;

/// Effect of edges that open faster than those in series with them shut: the leakage is greatest on
/// either side of null, which no measured valve shows.
pub(super) fn leakage_humps(setup: &Setup<'_>) -> Option<UncountedEffect> {
    let components = setup.rig().ok()?.actuator.components();
    let [command, greatest, least] = humps(&components.valve, &components.supply)?;
    Some(UncountedEffect::LeakageHumps { command, greatest, least })
}

/// Command of the lower of two maxima of a valve's leakage, the leakage there, and the least
/// leakage between both.
fn humps(valve: &Servovalve, supply: &Supply) -> Option<[f64; 3]> {
    let widest = (WIDTHS * valve.nominal_voltage / valve.leakage_shape.widest()).min(valve.nominal_voltage);
    let openings: Vec<f64> =
        (0..=2 * OPENINGS).map(|place| widest * (place as f64 / OPENINGS as f64 - 1.0)).collect();
    let leaks: Vec<f64> =
        openings.iter().map(|opening| blocked_ports(valve, supply, *opening).supply_flow).collect();
    let greatest =
        |from: usize, until: usize| (from..until).max_by(|one, other| leaks[*one].total_cmp(&leaks[*other]));
    let dips = (1..2 * OPENINGS).filter_map(|place| {
        let both = [greatest(0, place)?, greatest(place + 1, leaks.len())?];
        let lower = if leaks[both[0]] < leaks[both[1]] { both[0] } else { both[1] };
        Some([openings[lower], leaks[lower], leaks[place]])
    });
    let deepest = dips.max_by(|one, other| (one[1] - one[2]).total_cmp(&(other[1] - other[2])))?;
    (deepest[2] < (1.0 - DIP) * deepest[1]).then_some(deepest)
}
