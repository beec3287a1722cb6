//! Interface of a plant without polynomials for robust design.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::analytic::{Disc, Jet};
use phea_dynamics::portable::argument;
use phea_dynamics::uncertain_plant::PlantCoefficients;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;

use super::super::series::BeyondSensor;
use super::super::{ChamberDynamics, LinearLoad, LinearPlant, LinearSeries, Paths, YieldingSupply};
use super::{ChamberSide, PlantInMotion};

/// Factors from the slowest and the fastest characteristic frequencies of a plant to the ends of
/// its frequency range.
const BELOW: f64 = 0.01;
const ABOVE_SPOOL: f64 = 20.0;
const ABOVE_QUARTER_WAVE: f64 = 40.0;
const ABOVE_SERIES_MASS: f64 = 5.0;
/// Factor beyond this range to which a count of its open-loop poles extends, and the steps of the
/// count.
const FAR: f64 = 100.0;
const STEPS_MAXIMUM: usize = 100_000;
const SMALL_TURN: f64 = 0.5;
const LARGE_STEP: f64 = 1.05;
/// Magnitude of a feedback below which it cannot reach one within a step.
const SMALL_FED: f64 = 0.25;
/// Relative difference from the load pressure below which a pressure signal counts as the load
/// pressure.
const SAME_READING: f64 = 1e-9;

impl RespondingPlant for PlantInMotion {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        self.response(Complex64::new(0.0, frequency_rad_per_s))
    }

    fn rate(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        self.load_velocity(Complex64::new(0.0, frequency_rad_per_s)).map(|path| path * self.velocity_gain())
    }

    fn inner(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        let signal = |ratio| self.signal(Complex64::new(0.0, frequency_rad_per_s), ratio);
        self.plant.pressure_signal.map_or([Complex64::ZERO; 2], signal)
    }

    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc {
        Jet::enclosed(Disc::of_frequencies(frequencies_rad_per_s), |s| {
            let [command, _] = self.response(s);
            command
        })
    }

    /// Rig at rest: lines pass flow through their steady resistance R, and have yielded completely.
    ///
    /// ```text
    /// p_port = p + R q,   q = K_q U - K_c p_port      so that q = K_q/(1 + K_c R) U - K_c/(1 + K_c R) p
    /// ```
    ///
    /// in addition to the chamber's leakage; the edges of a supply that yields are treated
    /// likewise.
    fn slow(&self) -> PlantCoefficients<f64> {
        let of = |value: fn(&ChamberSide) -> f64| [value(&self.sides[0]), value(&self.sides[1])];
        let passing = |side: &ChamberSide| 1.0 + side.flow_pressure * side.line.resistance();
        let slow = [passing(&self.sides[0]), passing(&self.sides[1])];
        let over = |values: [f64; 2]| [values[0] / slow[0], values[1] / slow[1]];
        let ([valve_a, valve_b], [leaking_a, leaking_b]) =
            (over(of(|side| side.flow_pressure)), of(|side| side.leakage));
        let chambers = ChamberDynamics::TwoPressures {
            areas: of(|side| side.area),
            compliances: of(|side| {
                side.compliance - side.line.chamber_compliance() + side.line.static_compliance()
            }),
            flow_gains: over(of(|side| side.flow_gain)),
            flow_pressures: [valve_a + leaking_a, valve_b + leaking_b],
        };
        let supply = self.plant.supply.map(|supply| {
            let [resistance_a, resistance_b] = over(of(|side| side.line.resistance()));
            let ([of_a, of_b], edges) = (supply.edges, over(supply.edges));
            let [gain_a, gain_b] = of(|side| side.flow_gain);
            let returned = of_a * of_a * resistance_a + of_b * of_b * resistance_b;
            YieldingSupply {
                conductance: supply.conductance + of_a + of_b - edges[0] - edges[1] - returned,
                flow_gain: supply.flow_gain - of_a * resistance_a * gain_a + of_b * resistance_b * gain_b,
                edges,
                ..supply
            }
        });
        LinearPlant { chambers, supply, ..self.plant }.coefficients()
    }

    /// All parts after the valve are passive, so that the piston receives at most the power that a
    /// source with the conductance K_c can deliver, and it moves no faster than its friction
    /// dissipates that power:
    ///
    /// ```text
    /// f_v |v|^2 <= (K_qA^2/K_cA + K_qB^2/K_cB)/4 |U_sp|^2
    /// F_e = K_e (x_C - x_L) = v/(s/K_e + Y_L)                     Y_L: velocity of the load over its force
    /// |P(jw)| <= |v/U_sp| w_n^2/(w^2 - w_n^2) / (w/K_e - w/(M_L w^2 - K_L))       each factor falls from the frequency on at which it is positive
    /// ```
    ///
    /// A limited supply is a third port, `power_per_volt`. The feed-forward of a load that can move
    /// multiplies this by at most 1/(1 - (1 + e) K_x |H_v| |P Y_L|), and feedback of the load
    /// pressure F_h/A_A, for which only this bound is known,
    ///
    /// ```text
    /// F_h = (M s + f_v + k_A/s) v + F_e
    /// ```
    ///
    /// by at most 1/(1 - |H| |F_h/U_C|/A_A); with another reading of the pressures there is no
    /// bound. A series element is between K_e and Y_L: `LinearSeries::beyond_sensor`.
    fn roll_off(&self, frequency_rad_per_s: f64) -> Option<f64> {
        let friction = self.plant.viscous_friction;
        let w = frequency_rad_per_s;
        let natural = self.plant.valve_natural_frequency;
        let spool = natural * natural / (w * w - natural * natural);
        // displacement and velocity of the load per newton at this frequency
        let (yielding, speed) = match self.plant.load.terms().map(|load| load.reflected()) {
            Some([mass, _, stiffness]) if mass > 0.0 => {
                let yielding = w / (mass * w * w - stiffness);
                (yielding, yielding)
            }
            Some([_, damping, _]) if damping > 0.0 => (0.0, 1.0 / damping),
            Some([_, _, stiffness]) => (0.0, w / stiffness),
            None => (0.0, 0.0),
        };
        let beyond = match &self.plant.series {
            None => Some(BeyondSensor { yielding, passed: 1.0, output: 1.0 }),
            Some(series) => series.beyond_sensor(w, [yielding, speed]),
        };
        let BeyondSensor { yielding, passed, output } = beyond?;
        let held = w / self.plant.sensor_stiffness - yielding;
        let moving = (self.power_per_volt() / friction).sqrt() * spool;
        let resisted =
            w * self.plant.moving_mass + friction + self.plant.area_stiffness.unwrap_or(0.0) / w + 1.0 / held;
        let back = self.plant.pressure_feedback.map_or(Some(0.0), |feedback| {
            let [area_a, area_b] = self.sides.map(|side| side.area);
            let of_load = (area_b - feedback.ratio * area_a).abs() < SAME_READING * area_b;
            of_load.then_some(feedback.filter.bound(w) * moving * resisted / area_a)
        })?;
        let bound = moving / held / (1.0 - back);
        let peak = self.plant.velocity_sensor.filter.peak();
        let fed = self.fed_gain().map_or(0.0, |gain| gain.abs() * peak * bound * passed * speed);
        let falls = spool > 0.0 && held > 0.0 && yielding >= 0.0 && fed < 0.5 && back < 0.5;
        // y = F_e + Z_v X_L, and a bound of |X_L| from the force that reaches the load
        let beside = self.plant.virtual_impedance.map_or(0.0, |impedance| {
            let yields = self.plant.load != LinearLoad::Prescribed;
            if yields { impedance.bound() * passed * speed / w } else { 0.0 }
        });
        let bound = (output + beside) * bound / (1.0 - fed);
        (self.is_passive() && falls && bound.is_finite()).then_some(bound)
    }

    fn unstable_poles(&self) -> Option<usize> {
        if !self.is_passive() {
            return None;
        }
        let moves = self.plant.load != LinearLoad::Prescribed;
        if self.plant.pressure_feedback.is_none()
            && !(moves && self.plant.load_velocity_feed_forward.is_some())
        {
            return Some(0);
        }
        // 1 less the feed-forward and feedback, for a plant that is stable without them: Nyquist
        let alone = self.fed_forward(None).fed_back(None, 0.0);
        let difference = |frequency: f64| {
            let [own, alone] = [self, &alone].map(|plant| {
                let Paths { sensed, fed, .. } = plant.paths(Complex64::new(0.0, frequency));
                fed.map_or(sensed, |fed| sensed - fed)
            });
            (frequency, own / alone)
        };
        let [from, to] = self.range_rad_per_s();
        let mut ahead: Vec<(f64, Complex64)> =
            [to * FAR, (from * to).sqrt(), from / FAR].map(difference).to_vec();
        let mut here = ahead.pop()?;
        let start = argument(here.1);
        let mut turn = start - (start / PI).round() * PI;
        for _ in 0..STEPS_MAXIMUM {
            let Some(&next) = ahead.last() else {
                return Some(((argument(here.1) - turn) / PI).round().max(0.0) as usize);
            };
            let step = argument(next.1 / here.1);
            if step.abs() < SMALL_TURN && self.is_near([here, next]) {
                turn += step;
                here = next;
                ahead.pop();
            } else {
                ahead.push(difference((here.0 * next.0).sqrt()));
            }
        }
        None
    }

    fn range_rad_per_s(&self) -> [f64; 2] {
        let slowest = self.sides.iter().map(|side| {
            let line = side.line.static_compliance() - side.line.chamber_compliance();
            let gas = side.gas.map_or(0.0, |gas| gas.at_rest());
            let leaking = side.flow_pressure + side.leakage + self.plant.internal_leakage;
            leaking / (side.compliance + line + gas)
        });
        let [filled, passed] = self.feedback_rad_per_s();
        let slowest = slowest.fold(filled, f64::min).min(self.plant.valve_natural_frequency);
        let quarter_wave = self.quarter_wave_rad_per_s().unwrap_or(0.0);
        let modes = self.sides.iter().map(|side| side.line.fastest_rad_per_s());
        let necks = self.sides.iter().filter_map(|side| {
            let gas = side.gas?;
            Some(((1.0 / gas.compliance + 1.0 / side.compliance) / gas.neck?.inertance).sqrt())
        });
        let fastest = modes.chain(necks).fold(ABOVE_QUARTER_WAVE * quarter_wave, f64::max).max(passed);
        let fastest = fastest.max(ABOVE_SPOOL * self.plant.valve_natural_frequency);
        let series = self.plant.series.as_ref();
        let shaken = series.and_then(|series| series.fastest_rad_per_s(self.plant.sensor_stiffness));
        let resisted = series.and_then(LinearSeries::slowest_rad_per_s);
        let fastest = fastest.max(ABOVE_SERIES_MASS * shaken.unwrap_or(0.0));
        let slowest = if slowest > 0.0 { slowest } else { self.plant.valve_natural_frequency };
        let filter = self.plant.velocity_sensor.filter.frequency_rad_per_s();
        let filter = filter.filter(|_| self.plant.load_velocity_feed_forward.is_some());
        let lag = self.plant.virtual_impedance.and_then(|impedance| impedance.corner_rad_per_s());
        let heat = self.sides.iter().filter_map(|side| Some(1.0 / side.gas?.relaxation?.time));
        let valves = self.sides.iter().filter_map(|side| {
            let (gas, own) = (side.gas?, 1.0 / side.compliance);
            Some([1.0 / gas.compliance, own + 1.0 / gas.compliance].map(|per| per * gas.valve.unwrap_or(0.0)))
        });
        let valves = valves.flatten().filter(|corner| *corner > 0.0);
        let fed_back = self.plant.pressure_feedback;
        let fed_back = fed_back.iter().flat_map(|feedback| feedback.filter.corners_rad_per_s());
        let lags = || {
            fed_back
                .clone()
                .chain(filter)
                .chain(lag)
                .chain(heat.clone())
                .chain(valves.clone())
                .chain(resisted)
        };
        let slowest = lags().fold(slowest, f64::min);
        let fastest = lags().fold(fastest, |fastest, lag| fastest.max(ABOVE_SPOOL * lag));
        [BELOW * slowest, fastest]
    }

    fn echo_s(&self) -> f64 {
        let delays = self.sides.iter().flat_map(|side| side.line.delays());
        let waves = 2.0 * delays.fold(0.0, f64::max);
        let fed = self.plant.load_velocity_feed_forward.map_or(0.0, |_| self.lateness);
        let back = self.plant.pressure_feedback.map_or(0.0, |_| self.feedback_delay_s);
        waves + fed.max(back)
    }
}

impl PlantInMotion {
    /// True if 1 less the feedback cannot have encircled zero between these two points: a delay
    /// turns it in proportion to the frequency, which matters if the feedback is large.
    fn is_near(&self, [here, next]: [(f64, Complex64); 2]) -> bool {
        let turned = (next.0 - here.0) * self.lateness.max(self.feedback_delay_s);
        let fed = [here, next].map(|(_, difference)| (difference - 1.0).norm_sqr());
        let is_small = fed.iter().all(|fed| *fed < SMALL_FED * SMALL_FED);
        next.0 < LARGE_STEP * here.0 && (turned < SMALL_TURN || is_small)
    }

    /// Corner frequencies of dynamic pressure feedback: from its capacity together with those of
    /// the adjacent chambers to its restrictor between the chambers, rad/s.
    fn feedback_rad_per_s(&self) -> [f64; 2] {
        let Some(feedback) = &self.plant.dynamic_feedback else { return [f64::INFINITY, 0.0] };
        let chambers: f64 = self.sides.iter().map(|side| 1.0 / side.compliance).sum();
        [feedback.corner(), feedback.corner() + feedback.conductance * chambers]
    }

    /// Largest power that can leave valve and supply per square of a volt, W: their sources k less
    /// their conductances G,
    ///
    /// ```text
    /// max over p of k.p - p.G p = k.G^-1 k/4,      p = (p_A, p_B, p_S),   k = (K_qA, -K_qB, -K_qS)
    /// ```
    fn power_per_volt(&self) -> f64 {
        let driven = self.sides.iter().filter(|side| side.flow_gain != 0.0);
        let ports: f64 = driven.map(|side| side.flow_gain * side.flow_gain / side.flow_pressure).sum();
        let Some(supply) = &self.plant.supply else { return ports / 4.0 };
        let passed = [0, 1].map(|side| supply.edges[side] / self.sides[side].flow_pressure);
        let [of_a, of_b] = [0, 1].map(|side| passed[side] * self.sides[side].flow_gain);
        let source = of_a - of_b - supply.flow_gain;
        let own =
            supply.conductance + supply.edges[0] * (1.0 - passed[0]) + supply.edges[1] * (1.0 - passed[1]);
        (ports + source * source / own) / 4.0
    }
}
