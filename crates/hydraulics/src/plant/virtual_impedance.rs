//! Output of the linear plant with a virtual impedance: y = F_e + Z_v X_L.

use phea_dynamics::analytic::Analytic;
use phea_dynamics::controller::VirtualImpedance;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};

use super::{LinearPlant, Paths};
use crate::linear::polynomial::{product, shifted, sum};

/// Numerator and denominator of Z_v.
fn terms<S: Scalar>(impedance: &VirtualImpedance) -> [Vec<S>; 2] {
    [impedance.numerator(), impedance.denominator()]
        .map(|polynomial| polynomial.into_iter().map(S::from).collect())
}

impl<S: Scalar> LinearPlant<S> {
    /// Path y/X_L for a prescribed motion of the load, from F_e/X_L as a quotient.
    pub(super) fn beside_motion(&self, force: Vec<S>, denominator: Vec<S>) -> RationalCoefficients<S> {
        let Some(impedance) = &self.virtual_impedance else {
            return RationalCoefficients { numerator: force, denominator };
        };
        let [over, under] = terms(impedance);
        RationalCoefficients {
            numerator: sum(&product(&force, &under), &product(&denominator, &over)),
            denominator: product(&denominator, &under),
        }
    }

    /// Plant of a load that yields, from the paths of the force and the motion of the load by
    /// command and by ground, all over one denominator.
    pub(super) fn of_yielding_load(
        &self,
        force: [Vec<S>; 2],
        moved: [Vec<S>; 2],
        denominator: Vec<S>,
    ) -> PlantCoefficients<S> {
        let rate = moved.clone().map(|path| self.velocity_sensor.shown(shifted(&path)));
        let (output, rate, denominator) = match &self.virtual_impedance {
            None => (force, rate, denominator),
            Some(impedance) => {
                let [over, under] = terms(impedance);
                let beside =
                    [0, 1].map(|path| sum(&product(&force[path], &under), &product(&moved[path], &over)));
                (beside, rate.map(|path| product(&path, &under)), product(&denominator, &under))
            }
        };
        let [command, ground] = output;
        let [of_command, of_ground] = rate;
        PlantCoefficients {
            command: RationalCoefficients { numerator: command, denominator: denominator.clone() },
            disturbance: Some(RationalCoefficients { numerator: ground, denominator }),
            dead_time_s: S::from(0.0),
            rate: Some(RateNumerators { command: of_command, disturbance: of_ground, inner: None }),
        }
    }
}

impl<A: Analytic> Paths<A> {
    /// Paths with y in place of F_e, at s; `ground_of_load` is R of a load that yields, and `None`
    /// if its motion is prescribed.
    pub(super) fn beside(
        self,
        impedance: Option<&VirtualImpedance>,
        s: A,
        ground_of_load: Option<A>,
    ) -> Paths<A> {
        let Some(impedance) = impedance else { return self };
        let own = impedance.response(s);
        match ground_of_load {
            None => Paths { ground: self.ground + own * self.sensed, ..self },
            Some(tied) => Paths {
                command: self.command + own * self.driven,
                ground: self.ground + own * self.held * tied,
                ..self
            },
        }
    }
}
