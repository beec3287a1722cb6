//! Gas of an accumulator for small motions, if it is more than a compliance of its chamber.

use phea_dynamics::analytic::Analytic;
use phea_dynamics::scalar::Scalar;

use super::{GasRelaxation, Neck};
use crate::linear::polynomial::{product, scaled, shifted, sum};

/// Gas behind a neck or a valve, gas that exchanges heat, or both, without a flow at rest.
///
/// ```text
/// Y = C(s) s/(I C(s) s^2 + R C(s) s + 1),     C(s) = C + C_r/(1 + T s)
/// Y = g C(s) s/(C(s) s + g)                   behind a valve of conductance g
/// ```
///
/// Below its resonance 1/sqrt(I C) the branch is the gas, above it an inertance, which shuts the
/// gas off. Below 1/T the gas is isothermal, above it adiabatic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasBranch<S = f64> {
    /// Immediate compliance C, m3/Pa.
    pub compliance: S,
    /// Delayed compliance; `None` if the gas exchanges no heat, or exactly enough to remain
    /// polytropic.
    pub relaxation: Option<GasRelaxation<S>>,
    /// Neck before the gas; `None` without one.
    pub neck: Option<NeckImpedance<S>>,
    /// Conductance g of a valve before the gas, which then has no neck, m3/(s Pa); `None` without
    /// one.
    pub valve: Option<S>,
}

/// Pressure drop over the flow through a neck, I s + R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeckImpedance<S = f64> {
    /// Inertance I, kg/m4.
    pub inertance: S,
    /// Resistance R, Pa s/m3.
    pub resistance: S,
}

impl<S: Scalar> GasBranch<S> {
    /// Branch of gas with this compliance at rest in m3/Pa; the compliance of the oil in its neck
    /// is added.
    pub fn of(at_rest: S, relaxation: Option<GasRelaxation<S>>, neck: Option<&Neck<S>>) -> GasBranch<S> {
        let at_once = relaxation.map_or(at_rest, |later| at_rest - later.compliance);
        GasBranch {
            compliance: neck.map_or(at_once, |neck| at_once + neck.compliance),
            relaxation,
            neck: neck.map(|neck| NeckImpedance { inertance: neck.inertance, resistance: neck.resistance }),
            valve: None,
        }
    }

    /// Branch without a neck, behind a valve of a conductance in m3/(s Pa) with oil of a compliance
    /// in m3/Pa behind the valve.
    #[must_use]
    pub fn through_valve(&self, conductance: S, of_oil: S) -> GasBranch<S> {
        GasBranch { compliance: self.compliance + of_oil, valve: Some(conductance), ..*self }
    }

    /// Branch with this fraction of all compliances.
    #[must_use]
    pub fn softened(&self, fraction: S) -> GasBranch<S> {
        GasBranch {
            compliance: self.compliance * fraction,
            relaxation: self.relaxation.map(|GasRelaxation { compliance, time }| GasRelaxation {
                compliance: compliance * fraction,
                time,
            }),
            ..*self
        }
    }

    /// Compliance at rest including the oil of a neck, m3/Pa.
    pub fn at_rest(&self) -> S {
        self.relaxation.map_or(self.compliance, |later| self.compliance + later.compliance)
    }

    /// Helmholtz resonance 1/sqrt(I C), rad/s; `None` without a neck.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::accumulator::{GasBranch, NeckImpedance};
    /// let neck = Some(NeckImpedance { inertance: 1e6, resistance: 1e8 });
    /// let gas = GasBranch { compliance: 1e-12, relaxation: None, neck, valve: None };
    /// assert!((gas.resonance().unwrap() - 1e3_f64).abs() < 1e-9);
    /// assert!((gas.damping_ratio().unwrap() - 0.05_f64).abs() < 1e-12);
    /// ```
    pub fn resonance(&self) -> Option<S> {
        self.neck.map(|neck| S::from(1.0) / (neck.inertance * self.compliance).sqrt())
    }

    /// Damping ratio of the resonance from the neck, R/2 sqrt(C/I).
    pub fn damping_ratio(&self) -> Option<S> {
        self.neck.map(|neck| S::from(0.5) * neck.resistance * (self.compliance / neck.inertance).sqrt())
    }

    /// Numerator and denominator of Y, highest power of s first.
    pub(crate) fn admittance(&self) -> [Vec<S>; 2] {
        let one = S::from(1.0);
        let [yields, lag] = match self.relaxation {
            None => [vec![self.compliance], vec![one]],
            Some(GasRelaxation { compliance, time }) => {
                [vec![self.compliance * time, self.compliance + compliance], vec![time, one]]
            }
        };
        let taken = shifted(&yields);
        match (self.neck, self.valve) {
            (None, None) => [taken, lag],
            (None, Some(conductance)) => {
                [scaled(conductance, &taken), sum(&taken, &scaled(conductance, &lag))]
            }
            (Some(NeckImpedance { inertance, resistance }), _) => {
                let drop = product(&taken, &[inertance, resistance]);
                [taken, sum(&drop, &lag)]
            }
        }
    }
}

impl GasBranch {
    /// Admittance Y at s, or over a set of values of s.
    pub(crate) fn admittance_at<A: Analytic>(&self, s: A) -> A {
        let at_once = s.scaled(self.compliance);
        let taken = match self.relaxation {
            None => at_once,
            Some(GasRelaxation { compliance, time }) => {
                at_once + s.scaled(compliance) / (s.scaled(time) + A::from(1.0))
            }
        };
        match (self.neck, self.valve) {
            (None, None) => taken,
            (None, Some(conductance)) => {
                taken.scaled(conductance) / (taken + A::from(1.0).scaled(conductance))
            }
            (Some(NeckImpedance { inertance, resistance }), _) => {
                taken / (taken * (s.scaled(inertance) + A::from(resistance)) + A::from(1.0))
            }
        }
    }

    /// Numbers of the branch, none of which is negative if it is passive.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let later = self.relaxation.into_iter().flat_map(|later| [later.compliance, later.time]);
        let neck = self.neck.into_iter().flat_map(|neck| [neck.inertance, neck.resistance]);
        later.chain(neck).chain(self.valve).chain([self.compliance]).collect()
    }
}
