//! Feedback of the chambers' pressures to the command: active damping.

use phea_dynamics::controller::InnerFeedback;
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators};

use super::chambers::{ChamberPolynomials, Reading};
use super::{LinearPlant, LinearSeries, SeriesOutput, product, scaled, shifted, sum};
use crate::cross_port::DynamicFeedback;

/// Pressure signal that is fed back to the command.
///
/// ```text
/// u = u_C - H p,     p = p_A - phi p_B,     D p = N_p U_sp - N_x s X      chambers, as D F_h = N_u U_sp - N_v s X
/// (D + S H N_p) F_h = S N_u u_C - (N_v + S H m) s X                       with the spool S = w^2/V
/// m = (N_v N_p - N_x N_u)/D = (A_B - phi A_A) (A_B K_qA - A_A K_qB)       no supply that yields
/// ```
///
/// The term m is the remaining determinant of two pressures: a number, and zero for equal chambers
/// and for phi = A_B/A_A, where the signal is the load pressure F_h/A_A. So with equal chambers and
/// a fast spool, H is an admittance K_qU H in addition to the flow-pressure coefficient K_c: it
/// damps like leakage across the piston, and with a high pass it preserves the stiffness at rest.
///
/// # Example
/// With a fast spool and a gain k, the plant has an additional leakage k K_qU across the piston:
/// ```
/// # use phea_hydraulics::linear::LinearParameters;
/// use phea_dynamics::controller::InnerFeedback;
/// use phea_hydraulics::plant::{LinearLoad, LinearPlant, PressureFeedback};
/// # let parameters = LinearParameters {
/// #     useful_area: 1.58e-3, moving_mass: 13.1, viscous_friction: 100.0, flow_gain: 5.4e-5,
/// #     flow_pressure_coefficient: 6.4e-13, hydraulic_stiffness: 2.24e6, sensor_stiffness: 2e7,
/// #     valve_natural_frequency: 1e9, valve_damping_ratio: 0.9,
/// # };
/// let plant = |leakage| LinearPlant::of_load_pressure(&parameters, leakage, LinearLoad::Prescribed);
/// let filter = InnerFeedback { gain: 2e-7, ..InnerFeedback::default() };
/// let pressure_feedback = Some(PressureFeedback { filter, ratio: 1.0 });
/// let fed_back = LinearPlant { pressure_feedback, ..plant(0.0) }.coefficients().command;
/// let leaking = plant(2e-7 * 5.4e-5).coefficients().command;
/// let ratio = fed_back.at_frequency(1300.0) / leaking.at_frequency(1300.0);
/// assert!((ratio - 1.0).norm_sqr() < 1e-10);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureFeedback {
    /// Filter H, V/Pa.
    pub filter: InnerFeedback,
    /// Ratio phi: weight of a pascal in chamber B relative to one in chamber A.
    pub ratio: f64,
}

/// Polynomials of the valve with its chambers, highest power first.
pub(super) struct ValveAndChambers<S> {
    /// Polynomials D, N_u and N_v, or their replacements.
    pub(super) chambers: ChamberPolynomials<Vec<S>>,
    /// Polynomial V, or one if the chambers include it.
    pub(super) spool: Vec<S>,
    /// Factor w^2, or one.
    pub(super) square: S,
}

impl PressureFeedback {
    /// Numerator and denominator of H.
    fn polynomials<S: Scalar>(&self) -> [Vec<S>; 2] {
        [self.filter.numerator(), self.filter.denominator()]
            .map(|polynomial| polynomial.into_iter().map(S::from).collect())
    }
}

impl<S: Scalar> LinearPlant<S> {
    /// Polynomial V, w^2 and the chambers; with pressure feedback H = n/d one and one, and
    ///
    /// ```text
    /// D -> V D d + w^2 n N_p,     N_u -> w^2 d N_u,     N_v -> V d N_v + w^2 n m
    /// ```
    pub(super) fn valve_and_chambers(&self) -> ValveAndChambers<S> {
        let (one, square) = (S::from(1.0), self.valve_natural_frequency.squared());
        let damping = S::from(2.0) * self.valve_damping_ratio * self.valve_natural_frequency;
        let spool = vec![one, damping, square];
        let chambers = self.chamber_polynomials(&Reading::of_force(self.chambers.areas()));
        let Some(feedback) = self.pressure_feedback else {
            return ValveAndChambers { chambers, spool, square };
        };
        let [over, under] = feedback.polynomials();
        let over = scaled(square, &over);
        let [signal, turned] = self.signal(feedback.ratio);
        let ChamberPolynomials { own, driven, displaced } = chambers;
        let behind = product(&spool, &under);
        let chambers = ChamberPolynomials {
            own: sum(&product(&behind, &own), &product(&over, &signal)),
            driven: product(&scaled(square, &under), &driven),
            displaced: sum(&product(&behind, &displaced), &product(&over, &turned)),
        };
        ValveAndChambers { chambers, spool: vec![one], square: one }
    }

    /// Polynomials N_p and m of the signal p_A - phi p_B, over the D of the force.
    fn signal(&self, ratio: f64) -> [Vec<S>; 2] {
        let areas = self.chambers.areas();
        let signal = self.chamber_polynomials(&Reading::of_signal(ratio, areas)).driven;
        let turned = scaled(areas[1] - S::from(ratio) * areas[0], &self.turned());
        let turned = match self.dynamic_feedback {
            None => turned,
            Some(DynamicFeedback { conductance, capacity }) => product(&[capacity, conductance], &turned),
        };
        [signal, turned]
    }

    /// Plant with the paths to the signal p_A - phi p_B, for a loop that samples it: the paths of
    /// the force without a virtual impedance, with N_p and m for D and N_v in the denominator, and
    /// N_x s for Q in the numerator of the motion.
    ///
    /// ```text
    /// p/U_C = w^2 Delta(N_p, m)/(V Delta(D, N_v)),     F_s = K_S (... - V Q X_0)/(V Delta),     p/X_0 = F_s/X_0 with N_x s for Q
    /// ```
    pub(super) fn with_signal(&self, mut plant: PlantCoefficients<S>, ratio: f64) -> PlantCoefficients<S> {
        let areas = self.chambers.areas();
        let square = self.valve_natural_frequency.squared();
        let [signal, turned] = self.signal(ratio);
        let chambers = ChamberPolynomials { own: signal, driven: vec![], displaced: turned };
        let moved = self.resisted(&chambers);
        let within = ValveAndChambers { chambers, spool: vec![S::from(1.0)], square: S::from(1.0) };
        let command = scaled(square, &self.against_load(within, moved).command.denominator);
        let series = self.series.map(|series| LinearSeries { output: SeriesOutput::Sensor, ..series });
        let through_sensor = LinearPlant {
            series,
            virtual_impedance: None,
            load_velocity_feed_forward: None,
            pressure_feedback: None,
            ..*self
        };
        let moved = shifted(&self.chamber_polynomials(&Reading::of_signal(ratio, areas)).displaced);
        let pushed = through_sensor.against_load(through_sensor.valve_and_chambers(), moved);
        let ground = pushed.disturbance.map_or(vec![], |path| path.numerator);
        let ground = match (&self.virtual_impedance, self.load.terms()) {
            (Some(impedance), Some(_)) => {
                let under: Vec<S> = impedance.denominator().into_iter().map(S::from).collect();
                product(&ground, &under)
            }
            _ => ground,
        };
        let of_ground = || RateNumerators {
            command: vec![S::from(0.0)],
            disturbance: shifted(&plant.command.denominator),
            inner: None,
        };
        let rate = plant.rate.take().unwrap_or_else(of_ground);
        plant.rate = Some(RateNumerators { inner: Some([command, ground]), ..rate });
        plant
    }

    /// Determinant m over A_B - phi A_A.
    fn turned(&self) -> Vec<S> {
        if let Some(supply) = &self.supply {
            return self.chambers.behind(supply, self.gas).turned(self.chambers.areas());
        }
        let [one, other] = [self.chambers.side(0), self.chambers.side(1)];
        let [(_, passed_a), (_, passed_b)] = [one.beside(self.gas[0]), other.beside(self.gas[1])];
        let turned = other.area * one.flow_gain - one.area * other.flow_gain;
        scaled(turned, &product(&passed_a, &passed_b))
    }
}
