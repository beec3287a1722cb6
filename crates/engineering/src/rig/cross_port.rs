//! Flow and loss of a valve between the chambers at the operating point.

use phea_hydraulics::cross_port::CrossPort;

use super::Rig;

/// What a valve between the chambers does at the operating point of a rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossPortAtPoint {
    /// The valve.
    pub valve: CrossPort,
    /// Pressure difference p_A - p_B in Pa.
    pub drop: f64,
    /// What flows through it at rest in m3/s, from A to B.
    pub flow: f64,
    /// Conductance of its restrictor for small motions, in m3/(s Pa).
    pub conductance: f64,
    /// Static gain F_e/U_C of the plant in N/V, with it and without.
    pub static_gains: [f64; 2],
}

impl CrossPortAtPoint {
    /// Power in W that it turns into heat at rest.
    pub fn loss(&self) -> f64 {
        self.flow * self.drop
    }
}

/// What the valve between the chambers of a rig does where it is linearised; `None` where there is
/// none.
pub fn cross_port_at_point(rig: &Rig) -> Option<CrossPortAtPoint> {
    let valve = rig.actuator.components().cross_port?;
    let drop = rig.point.load_pressure();
    let steady = valve.capacity.is_none();
    let conductance = valve.restrictor.conductance(if steady { drop } else { 0.0 });
    let gain = |internal_leakage: f64| {
        let plant = phea_hydraulics::plant::LinearPlant { internal_leakage, ..rig.plant };
        plant.coefficients().command.at_frequency(0.0).re
    };
    let bare = rig.actuator.components().cylinder.internal_leakage.unwrap_or(0.0);
    Some(CrossPortAtPoint {
        valve,
        drop,
        flow: if steady { valve.restrictor.flow(drop) } else { 0.0 },
        conductance,
        static_gains: [gain(rig.internal_leakage), gain(bare)],
    })
}
