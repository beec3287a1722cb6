//! A rate that is fed forward and that the command also moves: the plant seen by a sampled loop,
//! against closed forms, against the loop in state space, and against the plant with its
//! polynomials hidden.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::analytic::{Analytic, Disc, Jet};
use phea_dynamics::controller::{Compensator, Controller, Element, RateFilter, RateSensor, Timing};
use phea_dynamics::linear::{LinearError, Polynomial, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{exp, exp_complex, ln, magnitude};
use phea_dynamics::random::uniform;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RateNumerators, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::loop_shaping::SampleStability;
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, audit_specifications};

const SAMPLE_TIME: f64 = 0.01;
const FREQUENCIES: [f64; 5] = [0.02, 1.0, 17.0, 99.0, 300.0];

fn compensation(timing: Timing, feedback: Vec<Element>, sensor: TransferFunction) -> Compensation {
    let controller = Controller { feedback: Compensator::new(feedback), timing, ..Controller::default() };
    Compensation::new(&controller, sensor).unwrap()
}

fn fed(rate_feed_forward: f64, delay_s: f64) -> Timing {
    Timing { sample_time_s: Some(SAMPLE_TIME), delay_s, rate_feed_forward, ..Timing::default() }
}

/// Lag w/(s + w) with this dead time.
fn lagging(w: f64, dead_time_s: f64) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    let lag = TransferFunction::from_polynomials(&polynomial(&[w]), &polynomial(&[1.0, w])).unwrap();
    lag.with_dead_time(dead_time_s).unwrap()
}

/// The sum of r/(s + p) over these (r, p), held and sampled with a delay: r/p (1 - q + (q -
/// e)/z)/((z - e) z^k), e = exp(-p T), q = exp(-p (T - d)) with the remainder d of a sample.
fn held(parts: &[(f64, f64)], delay_s: f64, z: Complex64) -> Complex64 {
    let whole = (delay_s / SAMPLE_TIME + 1e-9).floor();
    let rest = (delay_s - whole * SAMPLE_TIME).max(0.0);
    let late = (0..whole as usize).fold(Complex64::ONE, |late, _| late / z);
    let lag = |&(residue, pole): &(f64, f64)| {
        let (e, q) = (exp(-pole * SAMPLE_TIME), exp(-pole * (SAMPLE_TIME - rest)));
        residue / pole * (1.0 - q + (q - e) / z) / (z - e)
    };
    late * parts.iter().map(lag).sum::<Complex64>()
}

#[track_caller]
fn close(found: Complex64, expected: Complex64, tolerance: f64) {
    let error = magnitude(found - expected) / magnitude(expected);
    assert!(error < tolerance, "{found} is not {expected}: {error:e}");
}

/// Plants P = 1/((s + a)(s + b)), P_v = c s P and V_d = s (s + 1) P by partial fractions, with P' =
/// P/(1 - K P_v) and Pd' = Pd + K V_d P': with delays of fractions of a sample, of whole samples,
/// and with a sensor whose delay completes a sample.
#[test]
fn it_is_the_closed_form_of_two_lags() {
    let (a, b, c, w) = (4.0, 30.0, 3.0, 90.0);
    let of = |one: f64, other: f64, third: f64| w / ((other - one) * (third - one));
    let force = [(1.0 / (b - a), a), (-1.0 / (b - a), b)];
    let rate = [(-c * a / (b - a), a), (c * b / (b - a), b)];
    let sensed = [(of(a, b, w), a), (of(b, a, w), b), (of(w, a, b), w)];
    let denominator = vec![1.0, a + b, a * b];
    let plant = PlantCoefficients {
        command: RationalCoefficients { numerator: vec![1.0], denominator: denominator.clone() },
        disturbance: Some(RationalCoefficients { numerator: vec![-3.0, 0.0], denominator: vec![1.0, 5.0] }),
        dead_time_s: 0.0,
        rate: Some(RateNumerators { command: vec![c, 0.0], disturbance: vec![1.0, 1.0, 0.0], inner: None }),
    };
    for (gain, delay, further) in
        [(5.0, 0.0, 0.0), (5.0, 0.0237, 0.0), (-8.0, 0.0037, 0.0063), (5.0, 0.01, 0.0137), (12.0, 0.03, 0.0)]
    {
        let around = compensation(fed(gain, delay), vec![], lagging(w, further));
        let member = around.member(plant.clone()).unwrap();
        for frequency in FREQUENCIES {
            let (s, z) =
                (Complex64::new(0.0, frequency), exp_complex(Complex64::new(0.0, frequency * SAMPLE_TIME)));
            let back = 1.0 - gain * held(&rate, delay, z);
            let expected = held(&force, delay, z) / back;
            let from_disturbance = s * (s + 1.0) / ((s + a) * (s + b));
            for found in [
                member.response(frequency).unwrap(),
                around.plant_response(plant.clone(), frequency).unwrap(),
            ] {
                close(found.plant, expected, 1e-11);
                close(found.plant * found.sensor, held(&sensed, delay + further, z) / back, 1e-11);
                close(found.load_motion, -3.0 * s / (s + 5.0) + gain * from_disturbance * expected, 1e-11);
            }
        }
    }
    let late = Timing { rate_feed_forward: 1.0, delay_s: 0.1, ..Timing::default() };
    let refused = compensation(late, vec![], TransferFunction::gain_only(1.0)).member(plant.clone());
    assert!(matches!(refused, Err(LinearError::NotRational { .. })));
    // the path is a quotient in continuous time if there is no delay
    let at_once = Timing { rate_feed_forward: 2.0, ..Timing::default() };
    let around = compensation(at_once, vec![], TransferFunction::gain_only(1.0));
    let s = Complex64::new(0.0, 7.0);
    let expected = 1.0 / ((s + a) * (s + b) - 2.0 * c * s);
    close(around.member(plant).unwrap().response(7.0).unwrap().plant, expected, 1e-13);
}

/// Plant with a sensor of the rate: c s w/((s + a)(s + b)(s + w)) by partial fractions, with a
/// separate delay. The zeros that P' has there, at z = exp(-w T) and for each sample of that delay,
/// are those of the closed form.
#[test]
fn a_sensor_of_the_rate_is_a_path_of_its_own() {
    let (a, b, c, w) = (4.0, 30.0, 3.0, 55.0);
    let force = [(1.0 / (b - a), a), (-1.0 / (b - a), b)];
    let shown = |p: f64, q: f64, r: f64| (-c * w * p / ((q - p) * (r - p)), p);
    let rate = [shown(a, b, w), shown(b, a, w), shown(w, a, b)];
    let denominator = vec![1.0, a + b, a * b];
    let plant = PlantCoefficients {
        command: RationalCoefficients { numerator: vec![1.0], denominator },
        disturbance: Some(RationalCoefficients { numerator: vec![-3.0, 0.0], denominator: vec![1.0, 5.0] }),
        dead_time_s: 0.0,
        rate: Some(RateNumerators { command: vec![c, 0.0], disturbance: vec![1.0, 1.0, 0.0], inner: None }),
    };
    let filter = RateFilter::FirstOrder { frequency_rad_per_s: w };
    for (gain, delay, later) in [
        (5.0, 0.0, 0.0),
        (5.0, 0.0237, 0.0),
        (-8.0, 0.0037, 0.02),
        (12.0, 0.01, 0.0037),
        (5.0, 0.0037, 0.0063),
    ] {
        let rate_sensor = RateSensor { filter, delay_s: later };
        let around = compensation(Timing { rate_sensor, ..fed(gain, delay) }, vec![], lagging(90.0, 0.0037));
        let member = around.member(plant.clone()).unwrap();
        let without = around.without_inner_paths().member(plant.clone()).unwrap();
        for frequency in FREQUENCIES {
            let (s, z) =
                (Complex64::new(0.0, frequency), exp_complex(Complex64::new(0.0, frequency * SAMPLE_TIME)));
            let back = 1.0 - gain * held(&rate, delay + later, z);
            let expected = held(&force, delay, z) / back;
            let from_disturbance =
                s * (s + 1.0) / ((s + a) * (s + b)) * w / (s + w) * exp_complex(-s * later);
            let own = without.response(frequency).unwrap();
            for found in [
                member.response(frequency).unwrap(),
                around.plant_response(plant.clone(), frequency).unwrap(),
            ] {
                close(found.plant, expected, 1e-11);
                close(found.sensor, own.sensor, 1e-11);
                close(found.load_motion, -3.0 * s / (s + 5.0) + gain * from_disturbance * expected, 1e-11);
            }
        }
    }
    // the path is a quotient in continuous time if there is no delay
    let rate_sensor = RateSensor { filter, delay_s: 0.0 };
    let at_once = |rate_sensor| Timing { rate_feed_forward: 2.0, rate_sensor, ..Timing::default() };
    let around = |timing| compensation(timing, vec![], TransferFunction::gain_only(1.0));
    let s = Complex64::new(0.0, 7.0);
    let expected = 1.0 / ((s + a) * (s + b) - 2.0 * c * s * w / (s + w));
    close(
        around(at_once(rate_sensor)).member(plant.clone()).unwrap().response(7.0).unwrap().plant,
        expected,
        1e-13,
    );
    let late = around(at_once(RateSensor { delay_s: 1e-3, ..rate_sensor })).member(plant);
    assert!(matches!(late, Err(LinearError::NotRational { .. })));
}

/// Polynomials of N/D, N_v/D and V_d with two modes; P and P_v have the states of one companion
/// form.
#[derive(Clone, Debug)]
struct Drawn {
    numerator: [f64; 3],
    rate: [f64; 3],
    /// Coefficients below s^4.
    denominator: [f64; 4],
}

impl Drawn {
    fn new(state: &mut u64) -> Drawn {
        let mut spread = |low: f64, high: f64| exp(ln(low) + uniform(state) * ln(high / low));
        let mut pair = || {
            let (w, d) = (spread(2.0, 80.0), spread(0.02, 1.0));
            [2.0 * d * w, w * w]
        };
        let ([p, q], [r, t]) = (pair(), pair());
        let size = q * t;
        let numerator = [0.0, spread(0.01, 0.1) * size / (q * t).sqrt().sqrt(), size];
        let rate = [0.0, spread(0.02, 1.0) * size / q.max(t).sqrt(), 0.0];
        Drawn { numerator, rate, denominator: [p + r, q + t + p * r, p * t + r * q, q * t] }
    }

    fn shown(&self) -> PlantCoefficients<f64> {
        let denominator = [&[1.0], &self.denominator[..]].concat();
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: self.numerator.to_vec(),
                denominator: denominator.clone(),
            },
            disturbance: Some(RationalCoefficients { numerator: vec![-1.0, 0.0], denominator }),
            dead_time_s: 0.0,
            rate: Some(RateNumerators {
                command: self.rate.to_vec(),
                disturbance: vec![0.3, 2.0, 5.0, 0.0],
                inner: None,
            }),
        }
    }

    /// State space of both outputs from one input, with the rate after a lag w/(s + w) if there is
    /// one.
    fn states(&self, lag: Option<f64>) -> StateSpace {
        let count = if lag.is_some() { 5 } else { 4 };
        let mut a = DMatrix::zeros(count, count);
        for index in 0..4 {
            a[(0, index)] = -self.denominator[index];
            if index > 0 {
                a[(index, index - 1)] = 1.0;
            }
        }
        let mut b = DMatrix::zeros(count, 1);
        b[(0, 0)] = 1.0;
        let mut c = DMatrix::zeros(2, count);
        for (index, (force, rate)) in self.numerator.iter().zip(&self.rate).enumerate() {
            c[(0, index + 1)] = *force;
            match lag {
                None => c[(1, index + 1)] = *rate,
                Some(w) => a[(4, index + 1)] = w * rate,
            }
        }
        if let Some(w) = lag {
            a[(4, 4)] = -w;
            c[(1, 4)] = 1.0;
        }
        StateSpace::new(a, b, c, DMatrix::zeros(2, 1), TimeDomain::Continuous).unwrap()
    }

    fn at<A: Analytic>(&self, s: A) -> [A; 4] {
        let of = |coefficients: &[f64]| {
            coefficients.iter().fold(A::from(0.0), |sum, coefficient| sum * s + A::from(*coefficient))
        };
        let below = of(&[&[1.0], &self.denominator[..]].concat());
        [of(&self.numerator), of(&[-1.0, 0.0]), of(&self.rate), of(&[0.3, 2.0, 5.0, 0.0])]
            .map(|above| above / below)
    }
}

impl RespondingPlant for Drawn {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        let [command, disturbance, ..] = self.at(Complex64::new(0.0, frequency_rad_per_s));
        [command, disturbance]
    }

    fn rate(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        let [.., command, disturbance] = self.at(Complex64::new(0.0, frequency_rad_per_s));
        [command, disturbance]
    }

    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc {
        Jet::enclosed(Disc::of_frequencies(frequencies_rad_per_s), |s| self.at(s)[0])
    }

    fn slow(&self) -> PlantCoefficients<f64> {
        self.shown()
    }

    fn roll_off(&self, _: f64) -> Option<f64> {
        None
    }

    fn unstable_poles(&self) -> Option<usize> {
        Some(0)
    }

    fn range_rad_per_s(&self) -> [f64; 2] {
        [0.005, 2000.0]
    }

    fn echo_s(&self) -> f64 {
        0.0
    }
}

/// The largest ln|z|/T of the loop in state space: u = -G y + K v, with v after a lag and whole
/// samples.
fn in_states(
    plant: &Drawn,
    gain: f64,
    delay_s: f64,
    feedback: &TransferFunction,
    (lag, samples): (Option<f64>, usize),
) -> f64 {
    let held = plant.states(lag).held_with_dead_time(SAMPLE_TIME, delay_s).unwrap();
    let controller = StateSpace::from_transfer_function(feedback).unwrap();
    let own = controller.order();
    let mut a = DMatrix::zeros(own + samples, own + samples);
    let (mut b, mut c) = (DMatrix::zeros(own + samples, 2), DMatrix::zeros(1, own + samples));
    a.view_mut((0, 0), (own, own)).copy_from(controller.a());
    b.view_mut((0, 0), (own, 1)).copy_from(controller.b());
    c.view_mut((0, 0), (1, own)).copy_from(controller.c());
    for sample in 0..samples {
        match sample {
            0 => b[(own, 1)] = 1.0,
            _ => a[(own + sample, own + sample - 1)] = 1.0,
        }
    }
    let mut at_once = 0.0;
    match samples {
        0 => at_once = -gain,
        _ => c[(0, own + samples - 1)] = -gain,
    }
    let d = DMatrix::from_row_slice(1, 2, &[controller.d()[(0, 0)], at_once]);
    let back = StateSpace::new(a, b, c, d, held.domain()).unwrap();
    let poles = held.feedback(&back).unwrap().poles().unwrap();
    poles.iter().map(|pole| ln(magnitude(*pole)) / SAMPLE_TIME).fold(f64::NEG_INFINITY, f64::max)
}

/// Three hundred random loops with delays of fractions of a sample and of whole samples: the
/// slowest pole is that of the loop in state space, and with hidden polynomials the count of
/// unstable poles agrees.
#[test]
fn its_poles_are_those_of_the_loop_in_states() {
    let mut state = 5;
    let mut seen = [0; 2];
    let mut hidden_seen = [0; 2];
    for number in 0..300 {
        let plant = Drawn::new(&mut state);
        let gain = 3.0 * uniform(&mut state) - 1.0;
        let delay_s = [0.0, 0.0037, 0.02, 0.0237][number % 4];
        let integral = Element::ProportionalIntegral {
            proportional_gain: 0.02 + 0.6 * uniform(&mut state),
            integral_gain: 1.0 + 5.0 * uniform(&mut state),
        };
        // every second loop with a sensor of its rate
        let sensed = (number % 2 == 1).then(|| (exp(2.0 + 4.0 * uniform(&mut state)), (number / 2) % 4));
        let (lag, samples) = (sensed.map(|(w, _)| w), sensed.map_or(0, |(_, samples)| samples));
        let rate_sensor = RateSensor {
            filter: lag.map_or(RateFilter::None, |frequency_rad_per_s| RateFilter::FirstOrder {
                frequency_rad_per_s,
            }),
            delay_s: samples as f64 * SAMPLE_TIME,
        };
        let timing = Timing { rate_sensor, ..fed(gain, delay_s) };
        let around = compensation(timing, vec![integral], TransferFunction::gain_only(1.0));
        let expected = in_states(&plant, gain, delay_s, around.feedback(), (lag, samples));
        let member = around.member(plant.shown()).unwrap();
        let found = member_stability(&member, &around);
        let slowest = found.largest_real_part.unwrap();
        assert!(
            (slowest - expected).abs() < 1e-6 * expected.abs().max(1.0),
            "{number}: {slowest} {expected}"
        );
        let stable = expected < 0.0;
        if expected.abs() < 1e-3 {
            continue;
        }
        assert_eq!(found.status == StabilityStatus::Stable, stable, "{number}: {found:?} {expected}");
        seen[usize::from(stable)] += 1;
        let mut stability = SampleStability::new(&around, vec![member]);
        assert_eq!(stability.is_stable(around.feedback()).unwrap(), stable, "{number}");
        if number % 5 != 0 {
            continue;
        }
        let hidden = around.responding(Arc::new(plant.clone()));
        let mut stability = SampleStability::new(&around, vec![hidden.clone()]);
        match member_stability(&hidden, &around).status {
            StabilityStatus::NotResolved(_) => {}
            status => {
                assert_eq!(status == StabilityStatus::Stable, stable, "{number}: {status:?} {expected}");
                assert_eq!(stability.is_stable(around.feedback()).unwrap(), stable, "{number}");
                hidden_seen[usize::from(stable)] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 40), "{seen:?}");
    assert!(hidden_seen.iter().all(|count| *count > 5), "{hidden_seen:?}");
}

/// Folded from their responses, P', H and Pd' equal those of the polynomials.
#[test]
fn hidden_polynomials_fold_onto_equal_frequencies() {
    let mut state = 9;
    for number in 0..20 {
        let plant = Drawn::new(&mut state);
        let gain = 2.0 * uniform(&mut state) - 1.0;
        let filter = RateFilter::SecondOrder { frequency_rad_per_s: 70.0, damping_ratio: 0.4 };
        let rate_sensor = match number % 2 {
            0 => RateSensor::default(),
            _ => RateSensor { filter, delay_s: 0.0043 },
        };
        let timing = Timing { rate_sensor, ..fed(gain, 0.0137) };
        let around = compensation(timing, vec![], lagging(60.0, 0.002));
        let [shown, hidden]: [Member; 2] =
            [around.member(plant.shown()).unwrap(), around.responding(Arc::new(plant.clone()))];
        for frequency in FREQUENCIES {
            let [one, other] = [&shown, &hidden].map(|member| member.response(frequency).unwrap());
            for (found, expected) in
                [(other.plant, one.plant), (other.sensor, one.sensor), (other.load_motion, one.load_motion)]
            {
                let error = magnitude(found / expected - 1.0);
                assert!(error < 2e-3, "{number} at {frequency}: {error:e}");
            }
        }
    }
}

/// The audit of a family finds the worst case of a dense grid of responses.
#[test]
fn an_audit_includes_the_inner_feedback() {
    let gains = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 2.0 };
    let plant = UncertainPlant::record(vec![gains], |p| {
        let denominator = vec![1.0.into(), 12.0.into(), 90.0.into()];
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![p[0] * 40.0.into()],
                denominator: denominator.clone(),
            },
            disturbance: Some(RationalCoefficients {
                numerator: vec![(-3.0).into(), 0.0.into()],
                denominator,
            }),
            dead_time_s: 0.0.into(),
            rate: Some(RateNumerators {
                command: vec![p[0] * 2.0.into(), 0.0.into()],
                disturbance: vec![1.0.into(), p[0], 0.0.into()],
                inner: None,
            }),
        }
    })
    .unwrap();
    let members = vec![vec![1.0], vec![1.5], vec![2.0]];
    let around = compensation(fed(2.5, 0.013), vec![Element::Gain(0.5)], TransferFunction::gain_only(1.0));
    let family = UncertainFamily::new(plant.clone(), vec![], members.clone(), Extent::Members).unwrap();
    for (closed_loop, limit) in [(ClosedLoop::LoadMotion, 0.1), (ClosedLoop::RobustStability, 1.2)] {
        let nyquist = std::f64::consts::PI / SAMPLE_TIME;
        let demanded = Specification {
            requirement: Requirement::at_most(closed_loop, Limit::Constant(limit)),
            frequencies_rad_per_s: vec![1.0],
            band_rad_per_s: [0.0, f64::INFINITY],
        };
        let mut truth = f64::INFINITY;
        for values in &members {
            for point in 1..=4000 {
                let w = nyquist * exp(ln(1e-4) * (1.0 - f64::from(point) / 4000.0));
                let found = around.response_of(&plant, values, w.min(nyquist)).unwrap();
                let compensator = around.response(w.min(nyquist));
                let response = LoopResponse {
                    plant: found.plant,
                    load_motion: found.load_motion,
                    controller: compensator.feedback,
                    prefilter: compensator.prefilter,
                    sensor: found.sensor,
                };
                truth = truth.min(demanded.margin_db(&response, w).unwrap());
            }
        }
        let whole = Family::Uncertain(family.clone());
        let demands = std::slice::from_ref(&demanded);
        let problem = AuditProblem {
            family: &whole,
            compensation: &around,
            specifications: demands,
            tracking: TrackingJudgement::Magnitude,
            tolerance_db: TOLERANCE_DB,
        };
        let worst = audit_specifications(&problem, &mut unwatched).unwrap().0[0].worst.clone().unwrap();
        assert!((worst.margin_db - truth).abs() < 2e-3, "{truth} {worst:?}");
    }
}
