//! Valve between the chambers: a restrictor, with or without a capacity in series (dynamic pressure
//! feedback).
//!
//! ```text
//! laminar      q = G_cp (p_A - p_B)
//! orifice      q = K_cp root(p_A - p_B)                                         orifice.rs
//! feedback     q = restrictor(p_A - p_B - p_cp),   C_cp dp_x/dt = q              a piston on a spring, C_cp = A_cp^2/k_cp
//! ```
//!
//! q is positive from chamber A to chamber B. The capacity is a piston between two springs, or any
//! other part that takes oil on one side and returns an equal volume on the other: at rest its
//! pressure difference p_cp is that of the chambers, and nothing flows. Source: Merritt, Hydraulic
//! Control Systems (1967), which uses it to damp a lightly damped load.

mod checks;
mod component;
mod keys;

pub(crate) use keys::TRANSITION_PRESSURE_KEY;
pub use keys::{
    CrossPortKind, DeclaredCapacity, DeclaredCrossPort, DeclaredOrifice, DeclaredRestrictor, OrificeSize,
};

use phea_dynamics::scalar::Scalar;

use crate::orifice::{flow, regular_root_slope};
use crate::parameter::{ParameterError, Problems};

/// Valve between the chambers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossPort<S = f64> {
    /// Restrictor that the oil passes through.
    pub restrictor: Restrictor<S>,
    /// Capacity C_cp in series with the restrictor, m3/Pa; `None` if the restrictor joins the
    /// chambers directly.
    pub capacity: Option<S>,
}

/// Restriction of the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restrictor<S = f64> {
    /// Laminar: flow proportional to the drop.
    Laminar {
        /// Conductance G_cp, m3/(s Pa).
        conductance: S,
    },
    /// Sharp edge, [`flow`].
    Orifice {
        /// Flow coefficient K_cp, m3/(s Pa^0.5).
        flow_coefficient: S,
        /// Pressure drop below which the square root is regularised, Pa.
        transition_pressure: S,
    },
}

impl CrossPort {
    /// Impossible parameters of this valve; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        match self.restrictor {
            Restrictor::Laminar { conductance } => problems.key(keys::CONDUCTANCE_KEY, conductance),
            Restrictor::Orifice { flow_coefficient, transition_pressure } => {
                problems.positive("flow_coefficient", flow_coefficient);
                problems.key(keys::TRANSITION_PRESSURE_KEY, transition_pressure);
            }
        }
        if let Some(capacity) = self.capacity {
            problems.key(keys::CAPACITY_KEY, capacity);
        }
        problems.into_vec()
    }
}

phea_dynamics::parameters! { CrossPort { restrictor, capacity } }

phea_dynamics::parameters! {
    Restrictor = Restrictor::Laminar { conductance }
        | Restrictor::Orifice { flow_coefficient, transition_pressure }
}

impl<S: Scalar> Restrictor<S> {
    /// Flow for a drop in Pa, m3/s.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::cross_port::Restrictor;
    /// let laminar = Restrictor::Laminar { conductance: 1e-11 };
    /// let orifice = Restrictor::Orifice { flow_coefficient: 1e-8, transition_pressure: 1e3 };
    /// assert!((laminar.flow(2e6) / 2e-5 - 1.0_f64).abs() < 1e-15);
    /// assert!((orifice.flow(-4e6) / -2e-5 - 1.0_f64).abs() < 1e-6);
    /// ```
    #[inline(always)]
    pub fn flow(&self, drop: S) -> S {
        match *self {
            Restrictor::Laminar { conductance } => conductance * drop,
            Restrictor::Orifice { flow_coefficient, transition_pressure } => {
                flow(flow_coefficient, drop, transition_pressure)
            }
        }
    }

    /// Slope of the flow over the drop, m3/(s Pa). At zero drop that of an orifice is
    /// K_cp/sqrt(dp_t): only the transition pressure dp_t bounds it.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::cross_port::Restrictor;
    /// let orifice = Restrictor::Orifice { flow_coefficient: 1e-8, transition_pressure: 1e4 };
    /// assert!((orifice.conductance(0.0) / 1e-10 - 1.0_f64).abs() < 1e-14);
    /// assert!((orifice.conductance(4e6) / (0.5 * 1e-8 / 2e3) - 1.0_f64).abs() < 1e-4);
    /// ```
    pub fn conductance(&self, drop: S) -> S {
        match *self {
            Restrictor::Laminar { conductance } => conductance,
            Restrictor::Orifice { flow_coefficient, transition_pressure } => {
                flow_coefficient * regular_root_slope(drop, transition_pressure)
            }
        }
    }
}

/// Flow from chamber A to chamber B at rest: leakage across the piston, and a valve between the
/// chambers without a capacity in series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossFlow<S = f64> {
    /// Conductance of the leakage and of a laminar valve, m3/(s Pa).
    pub conductance: S,
    /// Valve that is not laminar.
    pub orifice: Option<Restrictor<S>>,
}

impl<S: Scalar> CrossFlow<S> {
    /// Cross flow of this leakage and this valve; `None` without flow at rest.
    ///
    /// # Example
    /// A laminar valve counts as leakage, and one with a capacity does not:
    /// ```
    /// use phea_hydraulics::cross_port::{CrossFlow, CrossPort, Restrictor};
    /// let laminar = CrossPort { restrictor: Restrictor::Laminar { conductance: 3e-12 }, capacity: None };
    /// let both = CrossFlow::of(Some(1e-12), Some(&laminar)).unwrap();
    /// assert_eq!((both.flow(1e6), both.slope(1e6)), (4e-6, 4e-12));
    /// let feedback = CrossPort { capacity: Some(1e-13), ..laminar };
    /// assert_eq!(CrossFlow::of(None, Some(&feedback)), None);
    /// ```
    pub fn of(leakage: Option<S>, cross_port: Option<&CrossPort<S>>) -> Option<CrossFlow<S>> {
        let steady = cross_port.filter(|port| port.capacity.is_none()).map(|port| port.restrictor);
        let none = S::from(0.0);
        match (leakage, steady) {
            (None, None) => None,
            (leakage, Some(Restrictor::Laminar { conductance })) => {
                let conductance = leakage.map_or(conductance, |leakage| leakage + conductance);
                Some(CrossFlow { conductance, orifice: None })
            }
            (leakage, orifice) => Some(CrossFlow { conductance: leakage.unwrap_or(none), orifice }),
        }
    }

    /// Flow at a drop p_A - p_B in Pa, m3/s.
    pub fn flow(&self, drop: S) -> S {
        let laminar = self.conductance * drop;
        self.orifice.map_or(laminar, |orifice| laminar + orifice.flow(drop))
    }

    /// Slope of the flow over the drop, m3/(s Pa).
    pub fn slope(&self, drop: S) -> S {
        self.orifice.map_or(self.conductance, |orifice| self.conductance + orifice.conductance(drop))
    }
}

/// Restrictor in series with a capacity, for small motions: dynamic pressure feedback.
///
/// ```text
/// q = g C_cp s/(C_cp s + g) (p_A - p_B)
/// ```
///
/// Below g/C_cp it is the capacity between the chambers, above it the conductance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicFeedback<S = f64> {
    /// Conductance g of the restrictor at zero drop, m3/(s Pa).
    pub conductance: S,
    /// Capacity C_cp, m3/Pa.
    pub capacity: S,
}

impl<S: Scalar> DynamicFeedback<S> {
    /// Dynamic feedback of a valve between the chambers; `None` without a capacity.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::cross_port::{CrossPort, DynamicFeedback, Restrictor};
    /// let port = CrossPort { restrictor: Restrictor::Laminar { conductance: 1e-10 }, capacity: Some(2e-13) };
    /// assert_eq!(DynamicFeedback::of(&port).map(|one| one.corner()), Some(500.0));
    /// ```
    pub fn of(port: &CrossPort<S>) -> Option<DynamicFeedback<S>> {
        let capacity = port.capacity?;
        Some(DynamicFeedback { conductance: port.restrictor.conductance(S::from(0.0)), capacity })
    }

    /// Corner frequency g/C_cp between the capacity and the conductance, rad/s.
    pub fn corner(&self) -> S {
        self.conductance / self.capacity
    }
}

/// Flow coefficient of a round orifice of a diameter in m, m3/(s Pa^0.5).
///
/// ```text
/// K = C_d (pi d^2/4) sqrt(2/rho)
/// ```
///
/// C_d is the discharge coefficient, near 0.6 for a sharp edge; rho in kg/m3. Source: Merritt,
/// Hydraulic Control Systems (1967), orifice equation.
///
/// # Example
/// 1 mm at 25 bar and 870 kg/m3 gives 2.14 L/min.
/// ```
/// use phea_hydraulics::cross_port::orifice_coefficient;
/// let coefficient: f64 = orifice_coefficient(0.6, 1e-3, 870.0);
/// assert!((coefficient * 25e5_f64.sqrt() * 6e4 - 2.144).abs() < 1e-3);
/// ```
pub fn orifice_coefficient<S: Scalar>(discharge_coefficient: S, diameter: S, density: S) -> S {
    let area = S::from(std::f64::consts::FRAC_PI_4) * diameter.squared();
    discharge_coefficient * area * (S::from(2.0) / density).sqrt()
}
