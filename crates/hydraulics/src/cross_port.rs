//! A valve between the chambers: a restrictor, alone or in series with a capacity (dynamic pressure
//! feedback).
//!
//! ```text
//! laminar      q = G_cp (p_A - p_B)
//! orifice      q = K_cp root(p_A - p_B)                                         orifice.rs
//! feedback     q = restrictor(p_A - p_B - p_cp),   C_cp dp_x/dt = q              a piston on a spring, C_cp = A_cp^2/k_cp
//! ```
//!
//! q is positive from chamber A to chamber B. The capacity is a piston between two springs, or any
//! other part that takes oil on one side and gives as much on the other: at rest its pressure
//! difference p_cp is that of the chambers, and nothing flows. Source: Merritt, Hydraulic Control
//! Systems (1967), which damps a lightly damped load this way.

use phea_dynamics::scalar::Scalar;

use crate::orifice::{flow, regular_root_slope};
use crate::parameter::{ParameterError, Problems};

/// A valve between the chambers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossPort<S = f64> {
    /// What the oil passes through.
    pub restrictor: Restrictor<S>,
    /// Capacity C_cp in series with it, in m3/Pa; `None` where the restrictor joins the chambers by
    /// itself.
    pub capacity: Option<S>,
}

/// A restriction of the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restrictor<S = f64> {
    /// In proportion to the drop.
    Laminar {
        /// Conductance G_cp in m3/(s Pa).
        conductance: S,
    },
    /// A sharp edge, [`flow`].
    Orifice {
        /// Flow coefficient K_cp in m3/(s Pa^0.5).
        flow_coefficient: S,
        /// Drop in Pa below which the square root is made regular.
        transition_pressure: S,
    },
}

impl CrossPort {
    /// Impossible parameters of this valve; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        match self.restrictor {
            Restrictor::Laminar { conductance } => problems.positive("conductance", conductance),
            Restrictor::Orifice { flow_coefficient, transition_pressure } => {
                problems.positive("flow_coefficient", flow_coefficient);
                problems.positive("transition_pressure", transition_pressure);
            }
        }
        if let Some(capacity) = self.capacity {
            problems.positive("capacity", capacity);
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
    /// Flow in m3/s along a drop in Pa.
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

    /// Slope of the flow over the drop, in m3/(s Pa). Without a drop that of an orifice is
    /// K_cp/sqrt(dp_t): the transition pressure dp_t alone bounds it.
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

/// What flows from chamber A to chamber B at rest: leakage across the piston, and a valve between
/// the chambers that no capacity closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossFlow<S = f64> {
    /// Conductance of the leakage and of a laminar valve, in m3/(s Pa).
    pub conductance: S,
    /// A valve that is not laminar.
    pub orifice: Option<Restrictor<S>>,
}

impl<S: Scalar> CrossFlow<S> {
    /// Of this leakage and this valve; `None` where nothing flows at rest.
    ///
    /// # Example
    /// A laminar valve is more leakage, and one with a capacity none.
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

    /// Flow in m3/s at a drop p_A - p_B in Pa.
    pub fn flow(&self, drop: S) -> S {
        let laminar = self.conductance * drop;
        self.orifice.map_or(laminar, |orifice| laminar + orifice.flow(drop))
    }

    /// Its slope over the drop, in m3/(s Pa).
    pub fn slope(&self, drop: S) -> S {
        self.orifice.map_or(self.conductance, |orifice| self.conductance + orifice.conductance(drop))
    }
}

/// A restrictor in series with a capacity, for small motions: dynamic pressure feedback.
///
/// ```text
/// q = g C_cp s/(C_cp s + g) (p_A - p_B)
/// ```
///
/// Slower than g/C_cp it is the capacity between the chambers, faster the conductance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicFeedback<S = f64> {
    /// Conductance g of the restrictor without a drop, in m3/(s Pa).
    pub conductance: S,
    /// Capacity C_cp in m3/Pa.
    pub capacity: S,
}

impl<S: Scalar> DynamicFeedback<S> {
    /// Of a valve between the chambers; `None` where it has no capacity.
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

    /// Where it turns from the capacity into the conductance, g/C_cp, in rad/s.
    pub fn corner(&self) -> S {
        self.conductance / self.capacity
    }
}

/// Flow coefficient in m3/(s Pa^0.5) of a round orifice of a diameter in m.
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
