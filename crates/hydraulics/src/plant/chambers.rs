//! Pressures of both chambers by Cramer's rule, and the force and a pressure signal computed from
//! them.

use phea_dynamics::scalar::Scalar;

use super::supply::{Coupled, YieldingSupply};
use crate::accumulator::GasBranch;
use crate::linear::LinearParameters;
use crate::linear::polynomial::{product, scaled, sum};
use crate::two_pressure::TwoPressureLinearParameters;

/// Dynamics of the pressures. Units: m2, m3/(s V), m3/(s Pa), N/m, m3/Pa.
///
/// ```text
/// load pressure    D = A^2 s + (K_c + G) K_H,   N_u = A K_H K_qU,   N_v = A^2 K_H             thesis (6.5) with (4.20)
/// two pressures    Y_A = C_A s + K_cA,   Y_B = C_B s + K_cB,   D = Y_A Y_B + G (Y_A + Y_B)
///                  N_u = A_A K_qA Y_B + A_B K_qB Y_A + G (A_A - A_B) (K_qA - K_qB)
///                  N_v = A_A^2 Y_B + A_B^2 Y_A + G (A_A - A_B)^2
/// ```
///
/// Both forms are equal for equal chambers: equal areas, compliances and flow-pressure
/// coefficients. Dynamic pressure feedback adds g C_cp s/(C_cp s + g) to G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChamberDynamics<S = f64> {
    /// Single load pressure, for a cylinder with equal chambers.
    LoadPressure {
        /// Useful area A.
        useful_area: S,
        /// Flow gain K_qU.
        flow_gain: S,
        /// Flow-pressure coefficient K_c of the valve.
        flow_pressure_coefficient: S,
        /// Hydraulic stiffness K_H.
        hydraulic_stiffness: S,
    },
    /// Separate pressures of the chambers.
    TwoPressures {
        /// Areas A_A and A_B.
        areas: [S; 2],
        /// Compliances C_A and C_B.
        compliances: [S; 2],
        /// Flow gains K_qA and K_qB.
        flow_gains: [S; 2],
        /// Flow-pressure coefficients K_cA and K_cB.
        flow_pressures: [S; 2],
    },
}

impl<S: Scalar> From<&LinearParameters<S>> for ChamberDynamics<S> {
    fn from(parameters: &LinearParameters<S>) -> ChamberDynamics<S> {
        ChamberDynamics::LoadPressure {
            useful_area: parameters.useful_area,
            flow_gain: parameters.flow_gain,
            flow_pressure_coefficient: parameters.flow_pressure_coefficient,
            hydraulic_stiffness: parameters.hydraulic_stiffness,
        }
    }
}

impl<S: Scalar> From<&TwoPressureLinearParameters<S>> for ChamberDynamics<S> {
    fn from(parameters: &TwoPressureLinearParameters<S>) -> ChamberDynamics<S> {
        let chambers = &parameters.chambers;
        ChamberDynamics::TwoPressures {
            areas: parameters.areas,
            compliances: parameters.compliances,
            flow_gains: [chambers.flow_gain_a, chambers.flow_gain_b],
            flow_pressures: [chambers.flow_pressure_a, chambers.flow_pressure_b],
        }
    }
}

/// Polynomials D, N_u and N_v, highest power first, or their values.
pub(super) struct ChamberPolynomials<T> {
    pub(super) own: T,
    pub(super) driven: T,
    pub(super) displaced: T,
}

/// Chambers without flow between them (separate), and joined to one pressure: with an admittance Y
/// between them, in which the determinant of their equations is linear,
///
/// ```text
/// D = D_apart + Y D_joined,   N_u and N_v likewise
/// ```
pub(super) struct ChamberPair<T> {
    pub(super) apart: ChamberPolynomials<T>,
    pub(super) joined: ChamberPolynomials<T>,
}

impl<T> ChamberPair<T> {
    /// Combination of D, N_u and N_v, separate and joined.
    pub(super) fn combined(&self, with: impl Fn(&T, &T) -> T) -> ChamberPolynomials<T> {
        let ChamberPair { apart, joined } = self;
        ChamberPolynomials {
            own: with(&apart.own, &joined.own),
            driven: with(&apart.driven, &joined.driven),
            displaced: with(&apart.displaced, &joined.displaced),
        }
    }
}

/// Linear combination of both pressures, w_A p_A - w_B p_B: the force, or the signal of a pressure
/// feedback.
#[derive(Clone, Copy)]
pub(super) struct Reading<S> {
    /// Weights w_A and w_B.
    pub(super) weights: [S; 2],
    /// Products w_A A_A and w_B A_B.
    pub(super) displaced: [S; 2],
    /// Difference w_A - w_B.
    pub(super) difference: S,
    /// Product (w_A - w_B) (A_A - A_B).
    pub(super) displaced_difference: S,
    /// Mean weight (w_A + w_B)/2 and its product with A, for chambers of equal areas: p_A = -p_B =
    /// p_L/2.
    pub(super) of_equal: [S; 2],
}

impl<S: Scalar> Reading<S> {
    /// Force F_h = A_A p_A - A_B p_B.
    pub(super) fn of_force(areas: [S; 2]) -> Reading<S> {
        let difference = areas[0] - areas[1];
        Reading {
            weights: areas,
            displaced: areas.map(Scalar::squared),
            difference,
            displaced_difference: difference.squared(),
            of_equal: [areas[0], areas[0].squared()],
        }
    }

    /// Pressure signal p_A - phi p_B.
    pub(super) fn of_signal(ratio: f64, areas: [S; 2]) -> Reading<S> {
        let (mean, difference) = (S::from(0.5 * (1.0 + ratio)), S::from(1.0 - ratio));
        let ratio = S::from(ratio);
        Reading {
            weights: [S::from(1.0), ratio],
            displaced: [areas[0], ratio * areas[1]],
            difference,
            displaced_difference: difference * (areas[0] - areas[1]),
            of_equal: [mean, mean * areas[0]],
        }
    }
}

impl<S: Scalar> ChamberDynamics<S> {
    /// Areas of both chambers.
    pub fn areas(&self) -> [S; 2] {
        [self.side(0).area, self.side(1).area]
    }

    pub(super) fn chambers(&self, reading: &Reading<S>) -> ChamberPair<Vec<S>> {
        match *self {
            ChamberDynamics::LoadPressure {
                useful_area: area,
                flow_gain,
                flow_pressure_coefficient,
                hydraulic_stiffness: stiffness,
            } => {
                let [read, displaced] = reading.of_equal;
                ChamberPair {
                    apart: ChamberPolynomials {
                        own: vec![area.squared(), flow_pressure_coefficient * stiffness],
                        driven: vec![read * stiffness * flow_gain],
                        displaced: vec![displaced * stiffness],
                    },
                    joined: ChamberPolynomials { own: vec![stiffness], driven: vec![], displaced: vec![] },
                }
            }
            ChamberDynamics::TwoPressures { compliances, flow_gains, flow_pressures, .. } => {
                let [gain_a, gain_b] = flow_gains;
                let [a, b] = [0, 1].map(|side| [compliances[side], flow_pressures[side]]);
                let Reading { weights: [read_a, read_b], displaced: [displaced_a, displaced_b], .. } =
                    *reading;
                ChamberPair {
                    apart: ChamberPolynomials {
                        own: product(&a, &b),
                        driven: sum(&scaled(read_a * gain_a, &b), &scaled(read_b * gain_b, &a)),
                        displaced: sum(&scaled(displaced_a, &b), &scaled(displaced_b, &a)),
                    },
                    joined: ChamberPolynomials {
                        own: sum(&a, &b),
                        driven: vec![reading.difference * (gain_a - gain_b)],
                        displaced: vec![reading.displaced_difference],
                    },
                }
            }
        }
    }

    /// Chambers with gas that has its own dynamics, of either form, each chamber multiplied by the
    /// denominator of its gas.
    pub(super) fn beside(&self, gas: [Option<GasBranch<S>>; 2], reading: &Reading<S>) -> ChamberPair<Vec<S>> {
        let [one, other] = [self.side(0), self.side(1)];
        let [(a, passed_a), (b, passed_b)] = [one.beside(gas[0]), other.beside(gas[1])];
        let Reading { weights: [read_a, read_b], displaced: [displaced_a, displaced_b], .. } = *reading;
        let [driven_a, driven_b] = [read_a * one.flow_gain, read_b * other.flow_gain];
        let (by_a, by_b) = (product(&a, &passed_b), product(&b, &passed_a));
        let both = product(&passed_a, &passed_b);
        ChamberPair {
            apart: ChamberPolynomials {
                own: product(&a, &b),
                driven: sum(&scaled(driven_a, &by_b), &scaled(driven_b, &by_a)),
                displaced: sum(&scaled(displaced_a, &by_b), &scaled(displaced_b, &by_a)),
            },
            joined: ChamberPolynomials {
                own: sum(&by_a, &by_b),
                driven: scaled(reading.difference * (one.flow_gain - other.flow_gain), &both),
                displaced: scaled(reading.displaced_difference, &both),
            },
        }
    }

    /// Chambers with a supply that yields, of either form.
    pub(super) fn behind(
        &self,
        supply: &YieldingSupply<S>,
        gas: [Option<GasBranch<S>>; 2],
    ) -> Coupled<Vec<S>> {
        let [one, other] = [self.side(0), self.side(1)];
        let [(a, passed_a), (b, passed_b)] = [one.beside(gas[0]), other.beside(gas[1])];
        let [of_a, of_b] = supply.edges;
        Coupled {
            own: [a, b, vec![supply.compliance, supply.conductance + of_a + of_b]],
            passed: gas.iter().any(Option::is_some).then_some([passed_a, passed_b]),
            edges: [vec![of_a], vec![of_b]],
            gains: [vec![one.flow_gain], vec![other.flow_gain], vec![supply.flow_gain]],
        }
    }

    /// Parameters of one chamber, 0 or 1. One load pressure represents two equal chambers:
    ///
    /// ```text
    /// C = 2 A^2/K_H,   K_q = K_qU,   2 K_c
    /// ```
    pub(super) fn side(&self, side: usize) -> Chamber<S> {
        match *self {
            ChamberDynamics::LoadPressure {
                useful_area: area,
                flow_gain,
                flow_pressure_coefficient,
                hydraulic_stiffness,
            } => Chamber {
                area,
                compliance: S::from(2.0) * area * area / hydraulic_stiffness,
                flow_gain,
                flow_pressure: S::from(2.0) * flow_pressure_coefficient,
            },
            ChamberDynamics::TwoPressures { areas, compliances, flow_gains, flow_pressures } => Chamber {
                area: areas[side],
                compliance: compliances[side],
                flow_gain: flow_gains[side],
                flow_pressure: flow_pressures[side],
            },
        }
    }
}

/// Area, compliance, flow gain and flow-pressure coefficient of a chamber.
pub(super) struct Chamber<S> {
    pub(super) area: S,
    pub(super) compliance: S,
    pub(super) flow_gain: S,
    pub(super) flow_pressure: S,
}

impl<S: Scalar> Chamber<S> {
    /// Admittance C s + K_c plus that of the gas, times the denominator of the latter, and this
    /// denominator.
    pub(super) fn beside(&self, gas: Option<GasBranch<S>>) -> (Vec<S>, Vec<S>) {
        let own = vec![self.compliance, self.flow_pressure];
        let Some(gas) = gas else { return (own, vec![S::from(1.0)]) };
        let [numerator, denominator] = gas.admittance();
        (sum(&product(&own, &denominator), &numerator), denominator)
    }
}
