//! Inner feedback in a sampled loop: the plant seen by the loop, against a closed form, against the
//! loop in state space, and against the plant with its polynomials hidden.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::analytic::{Analytic, Disc, Jet};
use phea_dynamics::controller::{Compensator, Controller, Element, InnerFeedback, Timing};
use phea_dynamics::linear::{LinearError, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{exp, exp_complex, ln, magnitude};
use phea_dynamics::random::uniform;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RateNumerators, RationalCoefficients};
use phea_qft::closed_loop::Compensation;
use phea_qft::stability::{StabilityStatus, member_stability};

const SAMPLE_TIME: f64 = 0.01;
const FREQUENCIES: [f64; 5] = [0.02, 1.0, 17.0, 99.0, 300.0];

fn timing(inner_feedback: InnerFeedback, delay_s: f64) -> Timing {
    Timing { sample_time_s: Some(SAMPLE_TIME), delay_s, inner_feedback, ..Timing::default() }
}

fn around(timing: Timing, feedback: Vec<Element>) -> Compensation {
    let controller = Controller { feedback: Compensator::new(feedback), timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

/// Inner feedback H by Tustin's rule, s = 2/T (z - 1)/(z + 1).
fn by_tustin(feedback: &InnerFeedback, z: Complex64) -> Complex64 {
    feedback.response(2.0 / SAMPLE_TIME * (z - 1.0) / (z + 1.0))
}

/// The sum of r/(s + p) over these (r, p), held and sampled with a delay.
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

/// Plants P = 1/((s + a)(s + b)), P_p = (c s + d) P and I_d = (s + 2) P by partial fractions: P' =
/// P/(1 + H P_p), Pd' = Pd - H I_d P'.
#[test]
fn it_is_the_closed_form_of_two_lags() {
    let (a, b, c, d) = (4.0, 30.0, 3.0, 20.0);
    let force = [(1.0 / (b - a), a), (-1.0 / (b - a), b)];
    let inner = [((d - c * a) / (b - a), a), (-(d - c * b) / (b - a), b)];
    let plant = PlantCoefficients {
        command: RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, a + b, a * b] },
        disturbance: Some(RationalCoefficients { numerator: vec![-3.0, 0.0], denominator: vec![1.0, 5.0] }),
        dead_time_s: 0.0,
        rate: Some(RateNumerators {
            command: vec![0.0],
            disturbance: vec![1.0, a + b, a * b, 0.0],
            inner: Some([vec![c, d], vec![1.0, 2.0]]),
        }),
    };
    let filters = [(None, None), (Some(2.0), None), (Some(2.0), Some(60.0)), (None, Some(200.0))];
    for (high_pass_rad_per_s, low_pass_rad_per_s) in filters {
        for (gain, delay) in [(5.0, 0.0), (5.0, 0.0237), (-2.0, 0.0037), (5.0, 0.01)] {
            let feedback = InnerFeedback { gain, high_pass_rad_per_s, low_pass_rad_per_s };
            let loops = around(timing(feedback, delay), vec![]);
            let member = loops.member(plant.clone()).unwrap();
            for frequency in FREQUENCIES {
                let s = Complex64::new(0.0, frequency);
                let own = by_tustin(&feedback, exp_complex(s * SAMPLE_TIME));
                let z = exp_complex(s * SAMPLE_TIME);
                let expected = held(&force, delay, z) / (1.0 + own * held(&inner, delay, z));
                let pressed = (s + 2.0) / ((s + a) * (s + b));
                for found in [
                    member.response(frequency).unwrap(),
                    loops.plant_response(plant.clone(), frequency).unwrap(),
                ] {
                    close(found.plant, expected, 1e-10);
                    close(found.load_motion, -3.0 * s / (s + 5.0) - own * pressed * expected, 1e-10);
                }
            }
        }
    }
    // the rate that the command also moves gives two paths, which it does not close
    let rate = plant.rate.clone().map(|rate| RateNumerators { command: vec![1.0, 0.0], ..rate });
    let feedback = InnerFeedback { gain: 1.0, ..InnerFeedback::default() };
    let both = Timing { rate_feed_forward: 2.0, ..timing(feedback, 0.0) };
    let refused = around(both, vec![]).member(PlantCoefficients { rate, ..plant });
    assert!(matches!(refused, Err(LinearError::NotRational { .. })));
}

/// Two oscillators in series, with the output and the inner signal taken from their states.
#[derive(Clone, Debug)]
struct Drawn {
    numerators: [[f64; 4]; 2],
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
        let inner = [0.0, 0.0, spread(0.02, 1.0) * size / q.max(t).sqrt(), spread(0.1, 2.0) * size];
        Drawn {
            numerators: [[0.0, 0.0, spread(0.01, 0.1) * size / q.sqrt(), size], inner],
            denominator: [p + r, q + t + p * r, p * t + r * q, q * t],
        }
    }

    fn shown(&self) -> PlantCoefficients<f64> {
        let denominator = [&[1.0], &self.denominator[..]].concat();
        let [numerator, inner] = self.numerators.map(|numerator| numerator.to_vec());
        PlantCoefficients {
            command: RationalCoefficients { numerator, denominator: denominator.clone() },
            disturbance: Some(RationalCoefficients {
                numerator: vec![-1.0, 0.0],
                denominator: denominator.clone(),
            }),
            dead_time_s: 0.0,
            rate: Some(RateNumerators {
                command: vec![0.0],
                disturbance: [&denominator[..], &[0.0]].concat(),
                inner: Some([inner, vec![0.3, 2.0, 5.0]]),
            }),
        }
    }

    /// State space of both outputs from one input.
    fn states(&self) -> StateSpace {
        let mut a = DMatrix::zeros(4, 4);
        for index in 0..4 {
            a[(0, index)] = -self.denominator[index];
            if index > 0 {
                a[(index, index - 1)] = 1.0;
            }
        }
        let mut b = DMatrix::zeros(4, 1);
        b[(0, 0)] = 1.0;
        let c = DMatrix::from_fn(2, 4, |row, column| self.numerators[row][column]);
        StateSpace::new(a, b, c, DMatrix::zeros(2, 1), TimeDomain::Continuous).unwrap()
    }

    fn at<A: Analytic>(&self, s: A) -> [A; 4] {
        let of = |coefficients: &[f64]| {
            coefficients.iter().fold(A::from(0.0), |sum, coefficient| sum * s + A::from(*coefficient))
        };
        let below = of(&[&[1.0], &self.denominator[..]].concat());
        let [force, inner] = self.numerators;
        [of(&force), of(&[-1.0, 0.0]), of(&inner), of(&[0.3, 2.0, 5.0])].map(|above| above / below)
    }
}

impl RespondingPlant for Drawn {
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        let [command, disturbance, ..] = self.at(Complex64::new(0.0, frequency_rad_per_s));
        [command, disturbance]
    }

    fn inner(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
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

/// The largest ln|z|/T of the loop in state space: u = -G y - H p.
fn in_states(plant: &Drawn, delay_s: f64, parts: [&TransferFunction; 2]) -> f64 {
    let held = plant.states().held_with_dead_time(SAMPLE_TIME, delay_s).unwrap();
    let parts = parts.map(|part| StateSpace::from_transfer_function(part).unwrap());
    let [own, inner] = parts.each_ref().map(StateSpace::order);
    let mut a = DMatrix::zeros(own + inner, own + inner);
    let (mut b, mut c) = (DMatrix::zeros(own + inner, 2), DMatrix::zeros(1, own + inner));
    let mut d = DMatrix::zeros(1, 2);
    for (column, (part, from)) in parts.iter().zip([0, own]).enumerate() {
        a.view_mut((from, from), (part.order(), part.order())).copy_from(part.a());
        b.view_mut((from, column), (part.order(), 1)).copy_from(part.b());
        c.view_mut((0, from), (1, part.order())).copy_from(part.c());
        d[(0, column)] = part.d()[(0, 0)];
    }
    let back = StateSpace::new(a, b, c, d, held.domain()).unwrap();
    let poles = held.feedback(&back).unwrap().poles().unwrap();
    poles.iter().map(|pole| ln(magnitude(*pole)) / SAMPLE_TIME).fold(f64::NEG_INFINITY, f64::max)
}

/// Two hundred random loops with delays of fractions of a sample and of whole samples: stable if
/// the loop in state space is, and with hidden polynomials the count of unstable poles and the
/// response agree.
#[test]
fn its_stability_is_that_of_the_loop_in_states() {
    let mut state = 7;
    let mut seen = [0; 2];
    for number in 0..200 {
        let plant = Drawn::new(&mut state);
        let mut spread = |low: f64, high: f64| exp(ln(low) + uniform(&mut state) * ln(high / low));
        let feedback = InnerFeedback {
            gain: spread(0.05, 3.0) * if number % 5 == 4 { -0.3 } else { 1.0 },
            high_pass_rad_per_s: (number % 2 == 0).then_some(spread(0.2, 20.0)),
            low_pass_rad_per_s: (number % 3 == 0).then_some(spread(20.0, 250.0)),
        };
        let delay = [0.0, 0.0037, 0.01, 0.0237][number % 4];
        let (proportional_gain, integral_gain) = (spread(0.01, 1.0), spread(0.01, 3.0));
        let law = Element::ProportionalIntegral { proportional_gain, integral_gain };
        let loops = around(timing(feedback, delay), vec![law]);
        let growth = in_states(&plant, delay, [loops.feedback(), loops.inner_feedback().unwrap()]);
        if growth.abs() < 1e-3 {
            continue;
        }
        let shown = loops.member(plant.shown()).unwrap();
        let hidden = loops.responding(Arc::new(plant));
        for member in [&shown, &hidden] {
            let found = member_stability(member, &loops).status;
            assert_eq!(found == StabilityStatus::Stable, growth < 0.0, "{number}: {found:?} {growth}");
            assert!(growth < 0.0 || matches!(found, StabilityStatus::Unstable(_)), "{number}: {found:?}");
        }
        for frequency in FREQUENCIES {
            let [one, other] = [&shown, &hidden].map(|member| member.response(frequency).unwrap());
            close(other.plant, one.plant, 3e-4);
            close(other.load_motion, one.load_motion, 3e-4);
        }
        seen[usize::from(growth > 0.0)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}
