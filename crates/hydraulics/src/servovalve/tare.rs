use phea_dynamics::scalar::Scalar;

use super::{Servovalve, Supply};
use crate::orifice::regular_root;

/// Tare flow at a supply in m3/s, from the data sheet's value at its own pressure drop.
///
/// ```text
/// q(p_S) = q_tare sqrt((p_S - p_T)/p_ref)          with the regular root of the edges: it reverses with the pressures
/// ```
///
/// The first stage is two fixed orifices and two nozzles in turbulent flow (Merritt 1967, chapter
/// 7), so its flow is proportional to the root of the drop. It flows from supply to tank and does
/// not affect the motion, but the pump delivers it.
///
/// # Example
/// ```
/// use phea_hydraulics::reference_rig::valve;
/// use phea_hydraulics::servovalve::{Supply, tare_flow};
/// let at = |pressure| tare_flow(&valve(), &Supply { pressure, tank_pressure: 0.0 });
/// assert_eq!(at(70e5), 7.55e-6);
/// assert!((at(280e5) / at(70e5) - 2.0_f64).abs() < 1e-6);
/// ```
#[inline(always)]
pub fn tare_flow<S: Scalar>(valve: &Servovalve<S>, supply: &Supply<S>) -> S {
    let transition = valve.transition_pressure;
    valve.tare_flow * regular_root(supply.pressure - supply.tank_pressure, transition)
        / regular_root(valve.tare_reference_drop, transition)
}
