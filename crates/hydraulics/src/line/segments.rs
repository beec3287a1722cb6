mod content;
mod response;

pub(crate) use content::LineContent;

use phea_dynamics::scalar::Scalar;

use super::laminar_friction::UNSTEADY_FRICTION;
use super::{Conduit, LineError, StandardLinearSolid};

/// Line divided into equal pi segments, each a plug of fluid between two half capacities; without
/// segments, one capacity.
///
/// ```text
/// inside      (C/N) dp_j/dt = q_j - q_j+1 - r_j             valve end  (C/2N) dp_0/dt = q_valve - q_1 - r_0
/// segment     (I/N) dq_j/dt = p_j-1 - p_j - (R_0/N) q_j - (4 nu/R^2)(I/N) sum m_k (q_j - u_jk)
/// friction    du_jk/dt = n_k nu/R^2 (q_j - u_jk)            if friction depends on frequency
/// wall        r_j = C_r (p_j - w_j)/theta, dw_j/dt = (p_j - w_j)/theta        if the wall creeps
/// ```
///
/// p_N is the pressure of the chamber, which takes the last half capacity
/// ([`Segments::chamber_compliance`]). Flows q count from valve to chamber. States, in this order:
/// p_0 to p_N-1, q_1 to q_N, then w_0 to w_N, then u. Every element stores or dissipates, so the
/// line is passive. Source: Merritt (1967) for the elements; Trikha (1975), Journal of Fluids
/// Engineering 97(1), for friction as first-order lags.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segments<S = f64> {
    count: usize,
    compliance: S,
    inertance: S,
    resistance: S,
    viscous_rate: S,
    friction: LaminarFriction,
    creep: Option<Creep<S>>,
}

/// Model of laminar friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaminarFriction {
    /// Friction of steady flow, 8 nu/R^2.
    Steady,
    /// Friction with the boundary layer of unsteady flow: five additional lags for each segment.
    FrequencyDependent,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Creep<S> {
    compliance: S,
    retardation_time: S,
}

impl Segments {
    /// Elastic capacity of this compliance in m3/Pa, all of it at the chamber: the lumped line.
    /// Zero means no line.
    pub fn lumped(compliance: f64) -> Segments {
        Segments {
            count: 0,
            compliance,
            inertance: 0.0,
            resistance: 0.0,
            viscous_rate: 0.0,
            friction: LaminarFriction::Steady,
            creep: None,
        }
    }

    /// Segments of a conduit with an elastic wall; their number is `count`.
    ///
    /// # Errors
    /// Conduit that is impossible or has no length.
    ///
    /// # Example
    /// The chamber takes half a segment:
    /// ```
    /// # use phea_hydraulics::line::{Conduit, LaminarFriction, Segments};
    /// let conduit = Conduit {
    ///     length: 1.5, bore: 12.7e-3, density: 870.0, kinematic_viscosity: 46e-6, effective_bulk_modulus: 2.609e8,
    /// };
    /// let line = Segments::new(&conduit, 4, LaminarFriction::Steady)?;
    /// assert_eq!(line.states(), 8);
    /// assert!((line.chamber_compliance() / conduit.compliance() - 0.125).abs() < 1e-15);
    /// # Ok::<(), phea_hydraulics::line::LineError>(())
    /// ```
    pub fn new(conduit: &Conduit, count: usize, friction: LaminarFriction) -> Result<Segments, LineError> {
        conduit.check()?;
        Ok(Segments {
            count,
            compliance: conduit.compliance(),
            inertance: conduit.inertance(),
            resistance: conduit.steady_resistance(),
            viscous_rate: conduit.viscous_rate(),
            friction,
            creep: None,
        })
    }

    /// Segments with a wall that creeps. The modulus of their conduit must be that of the fluid
    /// with the wall's dynamic modulus: the creep is added.
    ///
    /// # Errors
    /// Impossible wall.
    pub fn with_creep(self, conduit: &Conduit, wall: &StandardLinearSolid) -> Result<Segments, LineError> {
        let problems = wall.problems();
        if !problems.is_empty() {
            return Err(LineError::Impossible { problems });
        }
        let creep = Creep {
            compliance: conduit.area() * conduit.length * wall.retarded_compliance(),
            retardation_time: wall.retardation_time(),
        };
        Ok(Segments { creep: Some(creep), ..self })
    }
}

phea_dynamics::parameters! {
    Segments { count: kept, compliance, inertance, resistance, viscous_rate, friction: kept, creep }
}
phea_dynamics::parameters! { Creep { compliance, retardation_time } }

impl<S: Copy> Segments<S> {
    fn lags(&self) -> usize {
        match self.friction {
            LaminarFriction::Steady => 0,
            LaminarFriction::FrequencyDependent => UNSTEADY_FRICTION.len(),
        }
    }

    fn creeping(&self) -> usize {
        self.creep.map_or(0, |_| self.count + 1)
    }

    /// Number of states.
    pub fn states(&self) -> usize {
        2 * self.count + self.creeping() + self.count * self.lags()
    }

    /// Typical magnitude of each state for a typical pressure in Pa and flow in m3/s.
    pub fn scales(&self, pressure: f64, flow: f64) -> Vec<f64> {
        self.states_of(pressure, flow, |_| pressure)
    }

    /// States in order: pressures, flows, creep pressures, lags.
    fn states_of<T: Copy>(&self, wall: T, flow: T, pressure: impl Fn(usize) -> T) -> Vec<T> {
        let mut state: Vec<T> = (0..self.count).map(pressure).collect();
        state.extend(vec![flow; self.count]);
        state.extend(vec![wall; self.creeping()]);
        state.extend(vec![flow; self.count * self.lags()]);
        state
    }
}

impl<S: Scalar> Segments<S> {
    /// Contribution of the line to the compliance of the chamber, m3/Pa.
    pub fn chamber_compliance(&self) -> S {
        if self.count == 0 { self.compliance } else { self.fraction() / S::from(2.0) }
    }

    fn fraction(&self) -> S {
        self.compliance / S::from(self.count.max(1) as f64)
    }

    /// State of a steady flow in m3/s into a chamber at this pressure in Pa.
    pub fn steady_state(&self, chamber_pressure: S, flow: S) -> Vec<S> {
        let drop = self.resistance * flow / S::from(self.count.max(1) as f64);
        let pressure = |node: usize| chamber_pressure + drop * S::from((self.count - node) as f64);
        let mut state = self.states_of(chamber_pressure, flow, pressure);
        for (node, wall) in state.iter_mut().skip(2 * self.count).take(self.creeping()).enumerate() {
            *wall = pressure(node);
        }
        state
    }

    /// Pressure at the valve port, Pa.
    #[inline]
    pub fn port_pressure<T: Scalar + From<S>>(&self, state: &[T], chamber_pressure: T) -> T {
        if self.count == 0 { chamber_pressure } else { state[0] }
    }

    /// Rates of all states; returns the flow into the chamber in m3/s.
    #[inline]
    pub fn rates<T: Scalar + From<S>>(
        &self,
        flow_from_valve: T,
        chamber_pressure: T,
        state: &[T],
        rates: &mut [T],
    ) -> T {
        let count = self.count;
        let number = |value: usize| <T as From<f64>>::from(value as f64);
        let segments = number(count.max(1));
        let fraction = <T as From<S>>::from(self.compliance) / segments;
        let pressure = |node: usize| if node == count { chamber_pressure } else { state[node] };
        let mut inflow = flow_from_valve;
        for node in 0..=count {
            let taken = self.creep_rate(node, pressure(node), state, rates);
            if node == count {
                return inflow - taken;
            }
            let outflow = state[count + node];
            let capacity = if node == 0 { fraction / number(2) } else { fraction };
            rates[node] = (inflow - outflow - taken) / capacity;
            let drop = self.friction_drop(node, outflow, state, rates);
            let inertance = <T as From<S>>::from(self.inertance) / segments;
            rates[count + node] = (pressure(node) - pressure(node + 1) - drop / segments) / inertance;
            inflow = outflow;
        }
        inflow
    }

    /// Flow into the creeping wall at a node, m3/s.
    fn creep_rate<T: Scalar + From<S>>(&self, node: usize, pressure: T, state: &[T], rates: &mut [T]) -> T {
        let Some(creep) = self.creep else {
            return <T as From<f64>>::from(0.0);
        };
        let index = 2 * self.count + node;
        rates[index] = (pressure - state[index]) / <T as From<S>>::from(creep.retardation_time);
        let ends = if self.count > 0 && (node == 0 || node == self.count) { 2.0 } else { 1.0 };
        let parts = <T as From<f64>>::from(ends * self.count.max(1) as f64);
        <T as From<S>>::from(creep.compliance) / parts * rates[index]
    }

    /// Pressure drop of friction over the whole length at the flow of one segment, Pa.
    fn friction_drop<T: Scalar + From<S>>(&self, segment: usize, flow: T, state: &[T], rates: &mut [T]) -> T {
        let mut drop = <T as From<S>>::from(self.resistance) * flow;
        let first = 2 * self.count + self.creeping() + segment * self.lags();
        let viscous_rate = <T as From<S>>::from(self.viscous_rate);
        let inertance = <T as From<S>>::from(self.inertance);
        for (index, (corner, weight)) in UNSTEADY_FRICTION.into_iter().take(self.lags()).enumerate() {
            let behind = viscous_rate * (flow - state[first + index]);
            rates[first + index] = <T as From<f64>>::from(corner) * behind;
            drop = drop + <T as From<f64>>::from(4.0 * weight) * inertance * behind;
        }
        drop
    }
}
