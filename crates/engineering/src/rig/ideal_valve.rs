//! The limit of a valve whose edges are shut at null.
//!
//! The machine has a stand-in for it, edges that leak alike and hardly at all
//! ([`Edges::vanishing`]). What follows from a leakage that vanishes, vanishes with it:
//!
//! ```text
//! K_cA, K_cB, K_c  ->  0,      s_1 = -K_c K_eq/A_u^2  ->  0,      K_pU = K_qU/K_c  ->  infinite
//! ```

use phea_hydraulics::actuator::Components;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::operating_point::OperatingPoint;
use phea_hydraulics::plant::YieldingSupply;
use phea_hydraulics::servovalve::{ChamberCoefficients, Edges, Openings, Servovalve, SpoolDirection};
use phea_hydraulics::two_pressure::{
    TwoPressureLinearParameters, TwoPressureModel, reduce, two_pressure_linear_parameters,
};

use super::at_point::RigAtPoint;
use super::parameters::replaced;

/// Opening of a metering edge over the leakage of the stand-in, up to which the edge is shut: under
/// a load the spool is as far from null as the leakage requires.
const SHUT: f64 = 1e3;

/// Whether this valve is the stand-in for an ideal one.
pub fn is_ideal(valve: &Servovalve) -> bool {
    valve.leakage_coefficients == Edges::vanishing()
}

/// Whether the valve is an ideal one that is shut at this point.
pub(crate) fn is_shut_at(valve: &Servovalve, point: &OperatingPoint) -> bool {
    let most = valve.flow_coefficients.to_array().into_iter().fold(0.0, f64::max);
    let openings = Openings::at(valve, point.command);
    let opened = most * openings.forward.max(openings.backward);
    is_ideal(valve) && opened <= SHUT * Edges::<f64>::vanishing().supply_to_a
}

/// The linearised two-pressure model; of an ideal valve that is shut, its limit.
pub fn two_pressures(
    model: &TwoPressureModel,
    point: &OperatingPoint,
    side: SpoolDirection,
) -> TwoPressureLinearParameters {
    in_the_limit(&two_pressure_linear_parameters(model, point, side), model, point)
}

/// These parameters; of an ideal valve that is shut, their limit.
fn in_the_limit(
    found: &TwoPressureLinearParameters,
    model: &TwoPressureModel,
    point: &OperatingPoint,
) -> TwoPressureLinearParameters {
    if !is_shut_at(&model.valve, point) {
        return *found;
    }
    let outward = model.outward_slopes([point.pressure_a, point.pressure_b]);
    let [flow_pressure_a, flow_pressure_b] = outward.unwrap_or([0.0; 2]);
    let chambers = ChamberCoefficients { flow_pressure_a, flow_pressure_b, ..found.chambers };
    TwoPressureLinearParameters { chambers, ..*found }
}

impl RigAtPoint {
    /// The rig with these stated parameters in the limit of an ideal valve that is shut, where the
    /// pressure of a supply that yields moves no flow. Whether it is shut is decided by the spool,
    /// so that the plants of a family, whose spool is not a number, have the stand-in.
    pub(super) fn in_the_limit<'n>(self, stated: impl Iterator<Item = (&'n str, f64)>) -> RigAtPoint {
        let chambers = in_the_limit(&self.chambers, &self.model, &self.point);
        let linear = replaced(&reduced(&chambers), stated);
        let supply = match is_shut_at(&self.model.valve, &self.point) {
            true => self.supply.map(|supply| YieldingSupply { edges: [0.0; 2], ..supply }),
            false => self.supply,
        };
        RigAtPoint { chambers, linear, supply, ..self }
    }
}

/// The greatest K_c in m3/(s Pa) of a valve that is the stand-in for an ideal one and shut; `None`
/// of any other.
///
/// ```text
/// K_c <= G/sqrt(p_S - p_T),      G the leakage with what the spool opens
/// ```
pub(crate) fn stand_in_coefficient(components: &Components) -> Option<f64> {
    let Components { valve, supply, .. } = components;
    let leakage = SHUT * Edges::<f64>::vanishing().supply_to_a;
    is_ideal(valve).then(|| leakage / (supply.pressure - supply.tank_pressure).sqrt())
}

/// The reduction to one load pressure, also of chambers from which nothing leaks.
pub fn reduced(parameters: &TwoPressureLinearParameters) -> LinearParameters {
    let chambers = parameters.chambers;
    if chambers.flow_pressure_a != 0.0 || chambers.flow_pressure_b != 0.0 {
        return reduce(parameters);
    }
    let leaking = ChamberCoefficients { flow_pressure_a: 1.0, flow_pressure_b: 1.0, ..chambers };
    let found = reduce(&TwoPressureLinearParameters { chambers: leaking, ..*parameters });
    LinearParameters { flow_pressure_coefficient: 0.0, ..found }
}
