//! Valve between the chambers from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{CrossPortKind, DeclaredCapacity, DeclaredCrossPort, DeclaredOrifice, DeclaredRestrictor};
use super::{CrossPort, OrificeSize, Restrictor, orifice_coefficient};

impl<S: Scalar> DeclaredCrossPort<S> {
    /// Valve in a fluid of this density in kg/m3.
    pub fn component(&self, density: S) -> CrossPort<S> {
        match &self.kind {
            CrossPortKind::Laminar { conductance } => {
                CrossPort { restrictor: Restrictor::Laminar { conductance: *conductance }, capacity: None }
            }
            CrossPortKind::Orifice(orifice) => {
                CrossPort { restrictor: orifice.restrictor(density), capacity: None }
            }
            CrossPortKind::DynamicPressureFeedback { restrictor, capacity } => {
                CrossPort { restrictor: restrictor.component(density), capacity: Some(capacity.component()) }
            }
        }
    }
}

impl<S: Scalar> DeclaredRestrictor<S> {
    fn component(&self, density: S) -> Restrictor<S> {
        match self {
            DeclaredRestrictor::Laminar { conductance } => Restrictor::Laminar { conductance: *conductance },
            DeclaredRestrictor::Orifice(orifice) => orifice.restrictor(density),
        }
    }
}

impl<S: Scalar> DeclaredOrifice<S> {
    /// Flow coefficient in m3/(s Pa^0.5) and transition pressure in Pa in a fluid of this density
    /// in kg/m3.
    pub(crate) fn edge(&self, density: S) -> [S; 2] {
        let flow_coefficient = match self.size {
            OrificeSize::Diameter { diameter, discharge_coefficient } => {
                orifice_coefficient(discharge_coefficient, diameter, density)
            }
            OrificeSize::Flow { flow, pressure_drop } => flow / pressure_drop.sqrt(),
        };
        [flow_coefficient, self.transition_pressure]
    }

    fn restrictor(&self, density: S) -> Restrictor<S> {
        let [flow_coefficient, transition_pressure] = self.edge(density);
        Restrictor::Orifice { flow_coefficient, transition_pressure }
    }
}

impl<S: Scalar> DeclaredCapacity<S> {
    /// C_cp = A_cp^2/k_cp of a piston between springs.
    fn component(&self) -> S {
        match *self {
            DeclaredCapacity::Stated(capacity) => capacity,
            DeclaredCapacity::Piston { diameter, stiffness } => {
                let area = S::from(std::f64::consts::FRAC_PI_4) * diameter.squared();
                area.squared() / stiffness
            }
        }
    }
}
