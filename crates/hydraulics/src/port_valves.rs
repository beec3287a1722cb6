//! Port relief and anti-cavitation valves: from each chamber to the tank, at the cylinder.
//!
//! ```text
//! relief       q_r =  G_r s(p - p_T - p_r)            opens above the cracking pressure p_r
//! check        q_c = -G_c s(p_T - p - p_c)            opens below p_T - p_c and lets oil in from the tank
//!
//! s(x) = 0                     x <= -w
//! s(x) = (x + w)^2/(4 w)       |x| < w                 transition of half width w
//! s(x) = x                     x >= w
//! ```
//!
//! Flow is positive out of the chamber. s is convex, value and slope are continuous, and a closed
//! valve passes nothing. G is the flow over the override, the pressure above the cracking pressure
//! at which that flow passes. Without inertia: a valve opens at once.

mod checks;
mod component;
mod keys;

pub use keys::{DeclaredPortValve, DeclaredPortValves};

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Valve between a chamber and the tank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TankValve<S = f64> {
    /// Pressure difference p_r or p_c at which it opens, Pa.
    pub cracking_pressure: S,
    /// Conductance G_r or G_c of the open valve, m3/(s Pa).
    pub conductance: S,
}

phea_dynamics::parameters! { TankValve { cracking_pressure, conductance } }

/// Valves of one chamber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortValves<S = f64> {
    /// Relief valve to the tank.
    pub relief: Option<TankValve<S>>,
    /// Check valve from the tank, against cavitation.
    pub check: Option<TankValve<S>>,
    /// Half width w of the transition from shut to open, Pa.
    pub transition_pressure: S,
}

phea_dynamics::parameters! { PortValves { relief, check, transition_pressure } }

/// Kinds of a valve between a chamber and the tank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortValveKind {
    /// Relief valve.
    Relief,
    /// Check valve, against cavitation.
    Check,
}

/// A valve at a pressure of its chamber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValveAtPoint {
    /// Kind of the valve.
    pub kind: PortValveKind,
    /// Opening.
    pub opening: ValveOpening,
    /// Chamber pressure, Pa.
    pub pressure: f64,
    /// Chamber pressure at which the valve opens, Pa.
    pub opens_at: f64,
    /// Conductance for small motions, m3/(s Pa).
    pub conductance: f64,
    /// Conductance of the open valve, m3/(s Pa).
    pub open_conductance: f64,
}

/// Opening of a valve at an operating point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValveOpening {
    /// Shut: nothing flows.
    Shut,
    /// Within its transition.
    InTransition,
    /// Open: its flow is proportional to the pressure.
    Open,
}

impl PortValves {
    /// Impossible parameters of these valves; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("transition_pressure", self.transition_pressure);
        if let Some(relief) = self.relief {
            problems.positive("cracking_pressure", relief.cracking_pressure);
            problems.positive("flow", relief.conductance);
            let (width, shut) = (self.transition_pressure, ParameterRequirement::AtMostCrackingPressure);
            problems.require("transition_pressure", width, width <= relief.cracking_pressure, shut);
        }
        if let Some(check) = self.check {
            problems.not_negative("check_valve_pressure", check.cracking_pressure);
            problems.positive("check_valve_flow", check.conductance);
        }
        problems.into_vec()
    }

    /// The relief and the check valve, if present, at a pressure of the chamber and of the tank in
    /// Pa.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::port_valves::{PortValves, TankValve, ValveOpening};
    /// let relief = Some(TankValve { cracking_pressure: 100e5, conductance: 1e-10 });
    /// let valves = PortValves { relief, check: None, transition_pressure: 1e4 };
    /// let opening = |pressure| valves.at_point(pressure, 2e5)[0].opening;
    /// assert_eq!([101.8e5, 102e5, 103e5].map(opening), [ValveOpening::Shut, ValveOpening::InTransition, ValveOpening::Open]);
    /// assert_eq!((valves.at_point(102e5, 2e5)[0].opens_at, valves.at_point(102e5, 2e5)[0].conductance), (102e5, 0.5e-10));
    /// ```
    pub fn at_point(&self, pressure: f64, tank_pressure: f64) -> Vec<ValveAtPoint> {
        let width = self.transition_pressure;
        let excesses = self.excesses(pressure - tank_pressure);
        let kinds = [(PortValveKind::Relief, self.relief, 1.0), (PortValveKind::Check, self.check, -1.0)];
        let of = |((kind, valve, sign), excess): ((PortValveKind, Option<TankValve>, f64), Option<f64>)| {
            let (valve, excess) = valve.zip(excess)?;
            Some(ValveAtPoint {
                kind,
                opening: match excess {
                    excess if excess <= -width => ValveOpening::Shut,
                    excess if excess < width => ValveOpening::InTransition,
                    _ => ValveOpening::Open,
                },
                pressure,
                opens_at: tank_pressure + sign * valve.cracking_pressure,
                conductance: valve.conductance * opened_slope(excess, width),
                open_conductance: valve.conductance,
            })
        };
        kinds.into_iter().zip(excesses).filter_map(of).collect()
    }
}

impl<S: Scalar> PortValves<S> {
    /// Flow out of the chamber at a pressure above that of the tank in Pa, m3/s.
    ///
    /// # Example
    /// Nothing while both are shut, the whole flow at the override, and oil from the tank:
    /// ```
    /// use phea_hydraulics::port_valves::{PortValves, TankValve};
    /// let relief = Some(TankValve { cracking_pressure: 100e5, conductance: 5e-4 / 10e5 });
    /// let check = Some(TankValve { cracking_pressure: 0.5e5, conductance: 1e-9 });
    /// let valves = PortValves { relief, check, transition_pressure: 1e4 };
    /// assert_eq!([valves.flow(50e5), valves.flow(0.0)], [0.0, 0.0]);
    /// assert!((valves.flow(110e5) / 5e-4 - 1.0_f64).abs() < 1e-12);
    /// assert!((valves.flow(-1.5e5) / -1e-4 - 1.0_f64).abs() < 1e-12);
    /// ```
    #[inline(always)]
    pub fn flow(&self, above_tank: S) -> S {
        let passed = |valve: Option<TankValve<S>>, excess: Option<S>| {
            let (valve, excess) = valve.zip(excess)?;
            Some(valve.conductance * opened(excess, self.transition_pressure))
        };
        let [relief, check] = self.excesses(above_tank);
        match (passed(self.relief, relief), passed(self.check, check)) {
            (Some(out), Some(entering)) => out - entering,
            (Some(out), None) => out,
            (None, Some(entering)) => -entering,
            (None, None) => S::from(0.0),
        }
    }

    /// Slope of this flow over the pressure, m3/(s Pa); never negative.
    pub fn slope(&self, above_tank: S) -> S {
        let slope = |valve: Option<TankValve<S>>, excess: Option<S>| {
            let (valve, excess) = valve.zip(excess)?;
            Some(valve.conductance * opened_slope(excess, self.transition_pressure))
        };
        let [relief, check] = self.excesses(above_tank);
        let slopes = [slope(self.relief, relief), slope(self.check, check)];
        slopes.into_iter().flatten().fold(S::from(0.0), |sum, one| sum + one)
    }

    /// Pressures beyond the cracking pressures of the relief and the check valve, Pa; negative
    /// while a valve is shut, `None` for a valve that is absent.
    #[inline(always)]
    pub fn excesses(&self, above_tank: S) -> [Option<S>; 2] {
        [
            self.relief.map(|relief| above_tank - relief.cracking_pressure),
            self.check.map(|check| -above_tank - check.cracking_pressure),
        ]
    }

    /// Writes the functions that change their sign at both ends of each transition.
    pub(crate) fn write_kinks(&self, above_tank: S, write: &mut dyn FnMut(S)) {
        for excess in self.excesses(above_tank).into_iter().flatten() {
            write(excess + self.transition_pressure);
            write(excess - self.transition_pressure);
        }
    }

    /// Range of the pressure above that of the tank in Pa, if without these valves it is `free`,
    /// the supply is `drop` above the tank, and the piston and the other chamber take `taken` in
    /// m3/s.
    pub(crate) fn range(&self, free: S, drop: S, taken: S) -> [S; 2] {
        let (zero, width) = (S::from(0.0), self.transition_pressure);
        let bound = |valve: TankValve<S>, flow: S| {
            valve.cracking_pressure + width + flow.maximum(zero) / valve.conductance
        };
        let low = free.minimum(zero);
        let high = self.relief.map_or(free, |relief| free.minimum(bound(relief, -taken)));
        [self.check.map_or(low, |check| low.maximum(-bound(check, taken))), high.maximum(drop)]
    }
}

/// Pressure s(x) that drives the flow of a valve with an excess x over its cracking pressure and a
/// transition of half width w, all in Pa.
///
/// ```text
/// s = y^2/(4 w) + max(x - w, 0),      y = min(max(x + w, 0), 2 w)
/// ```
///
/// # Example
/// ```
/// use phea_hydraulics::port_valves::opened;
/// assert_eq!([-3.0, -1.0, 0.0, 1.0, 4.0].map(|excess| opened(excess, 1.0)), [0.0, 0.0, 0.25, 1.0, 4.0]);
/// ```
#[inline(always)]
pub fn opened<S: Scalar>(excess: S, width: S) -> S {
    let two = S::from(2.0);
    let within = (excess + width).maximum(S::from(0.0)).minimum(two * width);
    within.squared() / (two * two * width) + (excess - width).maximum(S::from(0.0))
}

/// Slope of [`opened`] over the excess: 0 while shut, 1 while open.
///
/// # Example
/// ```
/// use phea_hydraulics::port_valves::opened_slope;
/// assert_eq!([-3.0, -1.0, 0.0, 1.0, 4.0].map(|excess| opened_slope(excess, 1.0)), [0.0, 0.0, 0.5, 1.0, 1.0]);
/// ```
pub fn opened_slope<S: Scalar>(excess: S, width: S) -> S {
    let two = S::from(2.0);
    (excess + width).maximum(S::from(0.0)).minimum(two * width) / (two * width)
}
