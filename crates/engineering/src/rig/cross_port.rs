//! A valve between the chambers, as it is declared, and what it costs at the operating point.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::cross_port::{CrossPort, Restrictor, orifice_coefficient};

use super::Rig;
use crate::project::{
    CrossPortKind, DeclaredCapacity, DeclaredCrossPort, DeclaredOrifice, DeclaredRestrictor, OrificeSize,
};

/// As physics, in a fluid of this density in kg/m3.
pub(super) fn cross_port<S: Scalar>(
    declared: Option<&DeclaredCrossPort<S>>,
    density: S,
) -> Option<CrossPort<S>> {
    let edge = |declared: &DeclaredOrifice<S>| {
        let [flow_coefficient, transition_pressure] = edge(declared, density);
        Restrictor::Orifice { flow_coefficient, transition_pressure }
    };
    Some(match &declared?.kind {
        CrossPortKind::Laminar { conductance } => {
            CrossPort { restrictor: Restrictor::Laminar { conductance: *conductance }, capacity: None }
        }
        CrossPortKind::Orifice(declared) => CrossPort { restrictor: edge(declared), capacity: None },
        CrossPortKind::DynamicPressureFeedback { restrictor, capacity } => CrossPort {
            restrictor: match restrictor {
                DeclaredRestrictor::Laminar { conductance } => {
                    Restrictor::Laminar { conductance: *conductance }
                }
                DeclaredRestrictor::Orifice(declared) => edge(declared),
            },
            capacity: Some(self::capacity(capacity)),
        },
    })
}

/// Flow coefficient in m3/(s Pa^0.5) and transition pressure in Pa of an orifice in a fluid of this
/// density in kg/m3.
pub(super) fn edge<S: Scalar>(declared: &DeclaredOrifice<S>, density: S) -> [S; 2] {
    let flow_coefficient = match declared.size {
        OrificeSize::Diameter { diameter, discharge_coefficient } => {
            orifice_coefficient(discharge_coefficient, diameter, density)
        }
        OrificeSize::Flow { flow, pressure_drop } => flow / pressure_drop.sqrt(),
    };
    [flow_coefficient, declared.transition_pressure]
}

/// C_cp = A_cp^2/k_cp of a piston between springs.
fn capacity<S: Scalar>(declared: &DeclaredCapacity<S>) -> S {
    match *declared {
        DeclaredCapacity::Stated(capacity) => capacity,
        DeclaredCapacity::Piston { diameter, stiffness } => {
            let area = S::from(std::f64::consts::FRAC_PI_4) * diameter.squared();
            area.squared() / stiffness
        }
    }
}

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
