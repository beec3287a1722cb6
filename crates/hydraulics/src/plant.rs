//! Linear plant of the controller at an operating point, with lumped lines and with its load.
//!
//! ```text
//! U_sp = w^2/(s^2 + 2 xi w s + w^2) U_C                                  spool, thesis (4.1)
//! D F_h = N_u U_sp - N_v s X                                             chambers: ChamberDynamics
//! (M s^2 + f_v s + k_A) X = F_h - F_e, F_e = K_S (X - X_L)               piston and force sensor, thesis (6.6)
//! X_L = X_0,   or   (m s^2 + c s + k) X_L = F_e + (c s + k) X_0          load: LinearLoad
//! U_C -> U_C + K_x (1 + e) H_v s X_L - H (p_A - phi p_B)                 feed-forward of the load's velocity, feedback of
//!                                                                        the pressures: PressureFeedback
//! F_e -> F_e + Z_v X_L                                                   contribution of a virtual impedance to the output
//! ```
//!
//! These are the equations of [`crate::machine`] differentiated, with friction as one slope f_v.
//! The supply pressure is constant, or a state: [`YieldingSupply`].

mod chambers;
mod in_motion;
mod load;
mod pressure_feedback;
mod series;
mod supply;
mod virtual_impedance;
pub use chambers::ChamberDynamics;
pub use in_motion::{LineChambers, PlantInMotion};
pub use load::LinearLoad;
pub use pressure_feedback::PressureFeedback;
pub use series::{LinearElement, LinearSeries, LinearSpring, SeriesOutput};
pub use supply::YieldingSupply;

use phea_dynamics::controller::{RateFilter, VirtualImpedance};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};

use chambers::{ChamberPolynomials, Reading};
use pressure_feedback::ValveAndChambers;

use crate::accumulator::GasBranch;
use crate::cross_port::DynamicFeedback;
use crate::linear::LinearParameters;
use crate::linear::polynomial::{product, scaled, shifted, sum};
use crate::two_pressure::TwoPressureLinearParameters;

/// Parameters of the linear plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearPlant<S = f64> {
    /// Natural frequency w of the spool, rad/s.
    pub valve_natural_frequency: S,
    /// Damping ratio xi of the spool.
    pub valve_damping_ratio: S,
    /// Dynamics from spool position and piston velocity to the force of the pressures.
    pub chambers: ChamberDynamics<S>,
    /// Conductance G from chamber to chamber, m3/(s Pa): leakage across the piston, and a valve
    /// between the chambers.
    pub internal_leakage: S,
    /// Dynamic pressure feedback between the chambers; `None` without it.
    pub dynamic_feedback: Option<DynamicFeedback<S>>,
    /// Gas behind a neck, or with heat, at either chamber: not included in the chambers'
    /// compliances.
    pub gas: [Option<GasBranch<S>>; 2],
    /// Moving mass M, kg.
    pub moving_mass: S,
    /// Slope f_v of the friction, N s/m.
    pub viscous_friction: S,
    /// Stiffness k_A from the slope of the areas of a telescopic piston, N/m; `None` for constant
    /// areas.
    pub area_stiffness: Option<S>,
    /// Stiffness K_S of the force sensor, N/m; with a prescribed load, of sensor and environment.
    pub sensor_stiffness: S,
    /// Element between force sensor and load; `None` if the sensor acts directly on the load.
    pub series: Option<LinearSeries<S>>,
    /// Load on the force sensor.
    pub load: LinearLoad<S>,
    /// Supply that yields; `None` if its pressure is constant.
    pub supply: Option<YieldingSupply<S>>,
    /// Gain K_x from the velocity of the load to the command, without delay, V s/m; `None` without
    /// feed-forward.
    pub load_velocity_feed_forward: Option<S>,
    /// Sensor of this velocity.
    pub velocity_sensor: VelocitySensor<S>,
    /// Virtual impedance Z_v of an outer loop, with which the output is y = F_e + Z_v X_L; `None`
    /// for the force.
    pub virtual_impedance: Option<VirtualImpedance>,
    /// Feedback of the chambers' pressures to the command, without delay; `None` without one.
    pub pressure_feedback: Option<PressureFeedback>,
    /// Factor phi of a pressure signal p_A - phi p_B that a loop around the plant samples: its
    /// paths are then among the coefficients. `None` without such a loop.
    pub pressure_signal: Option<f64>,
}

/// Sensor of the load's velocity, without its dead time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocitySensor<S = f64> {
    /// Ratio 1 + e of measured to true velocity; `None` if e is zero.
    pub gain: Option<S>,
    /// Filter H_v of the velocity that is fed forward within the plant.
    pub filter: RateFilter,
}

impl<S> Default for VelocitySensor<S> {
    fn default() -> VelocitySensor<S> {
        VelocitySensor { gain: None, filter: RateFilter::None }
    }
}

impl<S> VelocitySensor<S> {
    /// Sensor with this gain, and no filter within the plant.
    pub fn with_gain(gain: Option<S>) -> VelocitySensor<S> {
        VelocitySensor { gain, filter: RateFilter::None }
    }
}

impl<S: Scalar> VelocitySensor<S> {
    /// Polynomial of the measured velocity, before its filter, from that of the true velocity.
    fn shown(&self, velocity: Vec<S>) -> Vec<S> {
        self.gain.map_or(velocity.clone(), |gain| scaled(gain, &velocity))
    }

    /// Polynomial times the denominator of the filter.
    fn filtered(&self, polynomial: Vec<S>) -> Vec<S> {
        match self.filter {
            RateFilter::None => polynomial,
            filter => {
                let denominator: Vec<S> = filter.denominator().into_iter().map(S::from).collect();
                product(&polynomial, &denominator)
            }
        }
    }
}

/// Paths over their divisors: F_e (sensed - fed) = command U_C + ground X_0 and v_L (sensed - fed)
/// = s (driven U_C + held R X_0), `fed` being the feedback through the velocity of a load that can
/// move and R the connection of this load to its ground.
struct Paths<T> {
    command: T,
    ground: T,
    sensed: T,
    fed: Option<T>,
    driven: T,
    held: T,
}

impl<S: Scalar> LinearPlant<S> {
    /// Plant with these parameters of the fifth-order model, and with the effects that this model
    /// omits.
    pub fn of_load_pressure(
        parameters: &LinearParameters<S>,
        leakage: S,
        load: LinearLoad<S>,
    ) -> LinearPlant<S> {
        LinearPlant {
            valve_natural_frequency: parameters.valve_natural_frequency,
            valve_damping_ratio: parameters.valve_damping_ratio,
            chambers: ChamberDynamics::from(parameters),
            internal_leakage: leakage,
            dynamic_feedback: None,
            gas: [None; 2],
            moving_mass: parameters.moving_mass,
            viscous_friction: parameters.viscous_friction,
            area_stiffness: None,
            sensor_stiffness: parameters.sensor_stiffness,
            series: None,
            load,
            supply: None,
            load_velocity_feed_forward: None,
            velocity_sensor: VelocitySensor::default(),
            virtual_impedance: None,
            pressure_feedback: None,
            pressure_signal: None,
        }
    }

    /// Plant with these parameters of the two-pressure model, and with the effects that this model
    /// omits.
    pub fn of_two_pressures(
        parameters: &TwoPressureLinearParameters<S>,
        leakage: S,
        load: LinearLoad<S>,
    ) -> LinearPlant<S> {
        LinearPlant {
            valve_natural_frequency: parameters.valve_natural_frequency,
            valve_damping_ratio: parameters.valve_damping_ratio,
            chambers: ChamberDynamics::from(parameters),
            internal_leakage: leakage,
            dynamic_feedback: None,
            gas: [None; 2],
            moving_mass: parameters.moving_mass,
            viscous_friction: parameters.viscous_friction,
            area_stiffness: None,
            sensor_stiffness: parameters.sensor_stiffness,
            series: None,
            load,
            supply: None,
            load_velocity_feed_forward: None,
            velocity_sensor: VelocitySensor::default(),
            virtual_impedance: None,
            pressure_feedback: None,
            pressure_signal: None,
        }
    }

    /// Polynomials D, N_u and N_v of a reading with the flow from chamber to chamber; dynamic
    /// pressure feedback multiplies all three by C_cp s + g, the denominator of its admittance, and
    /// gas multiplies them by that of its own admittance.
    fn chamber_polynomials(&self, reading: &Reading<S>) -> ChamberPolynomials<Vec<S>> {
        let chambers = match (&self.supply, self.gas) {
            (None, [None, None]) => self.chambers.chambers(reading),
            (None, gas) => self.chambers.beside(gas, reading),
            (Some(supply), gas) => self.chambers.behind(supply, gas).chambers(self.chambers.areas(), reading),
        };
        let leakage = self.internal_leakage;
        match self.dynamic_feedback {
            None => chambers.combined(|apart, joined| sum(apart, &scaled(leakage, joined))),
            Some(DynamicFeedback { conductance, capacity }) => {
                let denominator = [capacity, conductance];
                let numerator = [(leakage + conductance) * capacity, leakage * conductance];
                chambers.combined(|apart, joined| {
                    sum(&product(&denominator, apart), &product(&numerator, joined))
                })
            }
        }
    }

    /// Paths F_e/U_C in N/V and F_e/X_0 in N/m, X_0 being the motion of the load or of its ground.
    ///
    /// ```text
    /// Q = (M s^2 + f_v s + k_A) D + N_v s,     Z = m s^2 + c s + k,     V = s^2 + 2 xi w s + w^2
    /// prescribed    F_e = K_S (w^2 N_u U_C - V Q X_0)/(V (Q + K_S D))
    /// yielding      F_e = K_S (Z w^2 N_u U_C - (c s + k) V Q X_0)/(V (Q (Z + K_S) + K_S Z D))
    ///               v_L = s (K_S w^2 N_u U_C + (c s + k) V (Q + K_S D) X_0)/(V (Q (Z + K_S) + K_S Z D))
    /// ```
    ///
    /// Behind a linkage Z has k_g in addition to k, and r^2 K_S w^2 N_u and r^2 K_S represent the
    /// effect of the force on the load: [`LinearLoad::Linked`]. The velocity of the load that is
    /// fed forward is a second path of a prescribed motion, and a second loop of a load that
    /// yields. With the sensor's gain 1 + e and its filter H_v = 1/d_v,
    ///
    /// ```text
    /// prescribed    F_e = (N U_C - (d_v B - (1 + e) K_x s N) X_0/d_v)/D                    N, B, D of the equations above
    /// yielding      F_e = (d_v N U_C - (c s + k) (d_v B - (1 + e) K_x s K_S w^2 N_u) X_0)/(d_v D - (1 + e) K_x s K_S w^2 N_u)
    /// ```
    ///
    /// Output `rate` is (1 + e) v_L, before its filter. With a series element between sensor and
    /// load see [`LinearSeries`]. With a virtual impedance the output is y:
    ///
    /// ```text
    /// y/U_C = F_e/U_C + Z_v X_L/U_C,     y/X_0 = F_e/X_0 + Z_v X_L/X_0         X_L = X_0 if its motion is prescribed
    /// ```
    ///
    /// # Example
    /// The load has an effect: with a mass as heavy as the earth it does not move:
    /// ```
    /// # use phea_hydraulics::linear::{LinearParameters, linear_model_coefficients};
    /// use phea_hydraulics::plant::{LinearLoad, LinearPlant};
    /// # let parameters = LinearParameters {
    /// #     useful_area: 1.58e-3, moving_mass: 13.1, viscous_friction: 100.0, flow_gain: 5.4e-5,
    /// #     flow_pressure_coefficient: 6.4e-13, hydraulic_stiffness: 2.24e6, sensor_stiffness: 2e7,
    /// #     valve_natural_frequency: 1099.0, valve_damping_ratio: 0.9,
    /// # };
    /// let plant = |load| LinearPlant::of_load_pressure(&parameters, 0.0, load).coefficients().command.at_frequency(500.0);
    /// let heavy = LinearLoad::Yielding { mass: 6e24, damping: 500.0, stiffness: 2e5 };
    /// let light = LinearLoad::Yielding { mass: 100.0, damping: 500.0, stiffness: 2e5 };
    /// let prescribed = plant(LinearLoad::Prescribed);
    /// assert!((plant(heavy) / prescribed - 1.0).norm_sqr() < 1e-24);
    /// assert!((plant(light) / prescribed - 1.0).norm_sqr() > 1e-3);
    /// ```
    pub fn coefficients(&self) -> PlantCoefficients<S> {
        self.of_free_load(self.with_position())
    }

    fn with_position(&self) -> PlantCoefficients<S> {
        let valve = self.valve_and_chambers();
        let moved = self.resisted(&valve.chambers);
        let plant = self.against_load(valve, moved);
        match self.pressure_signal {
            Some(ratio) => self.with_signal(plant, ratio),
            None => plant,
        }
    }

    /// Denominator Q for these chambers.
    fn resisted(&self, ChamberPolynomials { own, displaced, .. }: &ChamberPolynomials<Vec<S>>) -> Vec<S> {
        let moved = shifted(&sum(&product(&[self.moving_mass, self.viscous_friction], own), displaced));
        match self.area_stiffness {
            Some(stiffness) => sum(&moved, &scaled(stiffness, own)),
            None => moved,
        }
    }

    /// Valve and chambers with this Q, connected to the load.
    fn against_load(&self, valve: ValveAndChambers<S>, moved: Vec<S>) -> PlantCoefficients<S> {
        let ValveAndChambers { chambers, spool, square } = valve;
        let ChamberPolynomials { driven, .. } = &chambers;
        let sensor = self.sensor_stiffness;
        if let Some(series) = &self.series {
            let driven = scaled(sensor * square, driven);
            return self.coefficients_through(series, &chambers, [moved, driven, spool]);
        }
        let ChamberPolynomials { own, driven, .. } = chambers;
        let shows = &self.velocity_sensor;
        let fed = self
            .load_velocity_feed_forward
            .map(|gain| shows.shown(shifted(&scaled(gain * sensor * square, &driven))));
        // without a feed-forward there is no filter within the plant
        let filtered = |path: Vec<S>| if fed.is_some() { shows.filtered(path) } else { path };
        let by_load = filtered(scaled(-sensor, &product(&spool, &moved)));
        let by_load = fed.as_ref().map_or(by_load.clone(), |fed| sum(&by_load, fed));
        let held = product(&spool, &sum(&moved, &scaled(sensor, &own)));
        let command = scaled(sensor * square, &driven);
        match self.load.terms() {
            None => PlantCoefficients {
                command: RationalCoefficients { numerator: command, denominator: held.clone() },
                disturbance: Some(self.beside_motion(by_load, filtered(held.clone()))),
                dead_time_s: S::from(0.0),
                // measured rate of X_0 itself
                rate: shows.gain.map(|gain| RateNumerators {
                    command: vec![S::from(0.0)],
                    disturbance: shifted(&scaled(gain, &held)),
                    inner: None,
                }),
            },
            Some(terms) => {
                let (load, tied) = (terms.own(), terms.ground);
                let [inertia, damping, stiffness] = load;
                let before_sensor = product(&moved, &[inertia, damping, stiffness + terms.moved_by(sensor)]);
                let sensed = sum(&before_sensor, &scaled(sensor, &product(&load, &own)));
                let alone = filtered(product(&spool, &sensed));
                let back = fed.as_ref().map(|fed| terms.moved(scaled(S::from(-1.0), fed)));
                let denominator = back.map_or(alone.clone(), |back| sum(&alone, &back));
                let moved = [terms.moved(command), product(&held, &tied)].map(filtered);
                let command = filtered(scaled(sensor * square, &product(&load, &driven)));
                let disturbance = product(&by_load, &tied);
                self.of_yielding_load([command, disturbance], moved, denominator)
            }
        }
    }
}
