//! Servovalve from its table.

use phea_dynamics::scalar::Scalar;
use phea_table::once_read;

use super::keys::{NullLeakage, RatedFlow, Valve, ValveCoefficients};
use super::{
    Edges, LeakageShape, OpeningLaw, OpeningShape, Servovalve, SpoolImperfection, Supply,
    flow_coefficient_from_rating, leakage_coefficient_from_rating,
};
use crate::power_unit::DeclaredSupply;

impl<S: Scalar> Supply<S> {
    /// Stated pressures of supply and tank.
    pub fn of(declared: &DeclaredSupply<S>) -> Supply<S> {
        Supply { pressure: declared.pressure, tank_pressure: declared.tank_pressure }
    }
}

impl<S: Scalar> Valve<S> {
    /// Valve with its declared coefficients; without them, with those of the data sheet, equal for
    /// all edges. `supply_drop` is the pressure difference in Pa from supply to tank.
    pub fn component(&self, supply_drop: S) -> Servovalve<S> {
        let opening = self.opening();
        let tare_flow = self.tare_flow;
        let tare_drop = self.tare_pressure.unwrap_or(supply_drop);
        Servovalve {
            flow_coefficients: match self.flow {
                ValveCoefficients::Edges { edges: flow, .. } => flow,
                ValveCoefficients::Rated(RatedFlow { flow, pressure_drop }) => {
                    let rated = flow_coefficient_from_rating(flow, pressure_drop);
                    // the data sheet's flow is that of full travel
                    let [positive, negative] = opening.full().map(|full| rated / full);
                    Edges::from_array([positive, negative, negative, positive])
                }
            },
            opening,
            leakage_coefficients: match self.leakage {
                ValveCoefficients::Edges { edges: leakage, .. } if is_shut(leakage) => Edges::vanishing(),
                ValveCoefficients::Edges { edges: leakage, .. } => leakage,
                ValveCoefficients::Rated(NullLeakage { flow, pressure, .. }) => {
                    Edges::equal(leakage_coefficient_from_rating(flow, tare_flow, tare_drop, pressure))
                }
            },
            leakage_shape: match self.leakage_shapes {
                Some(shapes) => LeakageShape::ByEdge(shapes),
                None => LeakageShape::Common(self.leakage_shape),
            },
            leakage_model: self.leakage_model,
            tare_flow,
            tare_reference_drop: tare_drop,
            nominal_voltage: self.nominal_voltage,
            natural_frequency: self.natural_frequency,
            damping_ratio: self.damping_ratio,
            transition_pressure: self.transition_pressure,
            spool: SpoolImperfection {
                null_bias: self.null_bias,
                hysteresis_width: self.hysteresis,
                threshold: self.threshold,
                rate_limit: self.rate_limit,
            },
        }
    }

    /// Law by which its edges open: proportional if neither lap nor saturation is stated.
    fn opening(&self) -> OpeningLaw<S> {
        let Valve { lap, saturation, .. } = self;
        if lap.is_none() && saturation.is_none() {
            return OpeningLaw::Proportional;
        }
        let lap = lap.unwrap_or_default();
        OpeningLaw::Shaped(OpeningShape {
            lap_positive: lap.positive,
            lap_negative: lap.negative,
            saturation: saturation.unwrap_or(S::from(0.0)),
        })
    }
}

/// True if no edge leaks: an ideal valve.
fn is_shut<S: Scalar>(leakage: Edges<S>) -> bool {
    leakage.to_array().into_iter().all(|edge| once_read(edge).is_none())
}
