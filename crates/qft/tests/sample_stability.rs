//! A sample of plants with one controller after another, against the stability of each plant and
//! against closed forms.
#![cfg(test)]

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Discretization, LinearError, Polynomial, TransferFunction};
use phea_dynamics::portable::{exp, ln, magnitude, sin, tan};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::MeasuredPlant;
use phea_qft::loop_shaping::SampleStability;
use phea_qft::stability::{StabilityStatus, member_stability};

const SAMPLE: f64 = 1e-3;

fn around(feedback: TransferFunction, sample_time_s: Option<f64>, delay_s: f64) -> Compensation {
    let timing = Timing { sample_time_s, delay_s, ..Timing::default() };
    let feedback = Compensator::new(vec![Element::General(feedback)]);
    let controller = Controller { feedback, timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn plant(numerator: &[f64], denominator: &[f64], dead_time_s: f64) -> PlantCoefficients<f64> {
    let command = RationalCoefficients { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    PlantCoefficients { command, disturbance: None, dead_time_s, rate: None }
}

/// A gain around one plant, continuous or sampled.
fn gain_around(member: PlantCoefficients<f64>, sample_time_s: Option<f64>) -> impl FnMut(f64) -> (bool, f64) {
    let compensation = around(TransferFunction::gain_only(1.0), sample_time_s, 0.0);
    let mut plants = SampleStability::new(&compensation, vec![compensation.member(member).unwrap()]);
    move |gain| {
        let gain = around(TransferFunction::gain_only(gain), sample_time_s, 0.0).feedback().clone();
        let judgement = plants.judge(&gain).unwrap();
        assert_eq!(plants.is_stable(&gain), Ok(judgement.unstable_plants == 0));
        (judgement.unstable_plants == 0, judgement.largest_real_part)
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, end: usize) -> usize {
        ((self.next() * end as f64) as usize).min(end - 1)
    }

    /// Roots over five decades, some of them lightly damped, some in the right half plane.
    fn roots(&mut self, count: usize, right: f64) -> Vec<Complex64> {
        let mut roots = Vec::new();
        while roots.len() < count {
            let size = 0.01 * exp(11.5 * self.next());
            let damping = if self.next() < 0.2 { 1e-3 } else { self.next() };
            let real = size * damping * if self.next() < right { 1.0 } else { -1.0 };
            if count - roots.len() > 1 && self.next() < 0.5 {
                let imaginary = size * (1.0 - damping * damping).sqrt();
                roots.extend([Complex64::new(real, imaginary), Complex64::new(real, -imaginary)]);
            } else if self.next() < 0.2 {
                roots.push(Complex64::new(0.0, 0.0));
            } else {
                roots.push(Complex64::new(real, 0.0));
            }
        }
        roots
    }

    /// A plant with up to six poles whose gain is one at some frequency.
    fn plant(&mut self, dead_time_s: f64) -> PlantCoefficients<f64> {
        let poles = 1 + self.below(6);
        let zeros = self.below(poles);
        let (poles, zeros) = (self.roots(poles, 0.05), self.roots(zeros, 0.05));
        let shape = TransferFunction::from_factors(1.0, zeros, poles).unwrap();
        let gain = 1.0 / magnitude(shape.at_frequency(0.03 * exp(8.0 * self.next())));
        let (numerator, denominator) = (shape.numerator().scaled(gain), shape.denominator());
        plant(numerator.coefficients(), denominator.coefficients(), dead_time_s)
    }

    /// A controller with up to four poles and a gain between 0.01 and 10.
    fn controller(&mut self) -> TransferFunction {
        let poles = self.below(5);
        let zeros = self.below(poles + 1);
        let (poles, zeros) = (self.roots(poles, 0.0), self.roots(zeros, 0.02));
        let shape = TransferFunction::from_factors(1.0, zeros, poles).unwrap();
        let size = magnitude(shape.at_frequency(exp(5.0 * self.next())));
        let gain = 0.01 * exp(6.9 * self.next()) / if size.is_finite() { size } else { 1.0 };
        shape.series(&TransferFunction::gain_only(gain)).unwrap()
    }
}

/// Results of a comparison over random loops.
#[derive(Debug, Default)]
struct Tally {
    asked: usize,
    stable: usize,
    undecided: usize,
    unresolved: usize,
}

/// A plant in a loop whose controller changes, evaluated by both methods.
fn compare(member: &Member, compensation: &Compensation, tally: &mut Tally) {
    let status = member_stability(member, compensation).status;
    let other =
        around(TransferFunction::gain_only(0.0), compensation.sample_time_s(), compensation.delay_s());
    let mut plants = SampleStability::new(&other, vec![member.clone()]);
    let judgement = plants.judge(compensation.feedback()).unwrap();
    tally.asked += 1;
    tally.undecided += judgement.undecided_tables;
    match status {
        // for example a pole at the origin
        StabilityStatus::NotResolved(_) => {
            assert_eq!(judgement.unstable_plants, 1);
            tally.unresolved += 1;
        }
        status => {
            let stable = status == StabilityStatus::Stable;
            assert_eq!(judgement.unstable_plants == 0, stable, "{member:?}\n{compensation:?}\n{status:?}");
            tally.stable += usize::from(stable);
        }
    }
}

#[test]
fn continuous_loops_are_judged_as_by_their_poles() {
    let (mut random, mut tally) = (Random(1), Tally::default());
    for _ in 0..2000 {
        let compensation = around(random.controller(), None, 0.0);
        let member = compensation.member(random.plant(0.0)).unwrap();
        compare(&member, &compensation, &mut tally);
    }
    assert!(tally.stable > 400 && tally.stable < 1600 && tally.unresolved < 20, "{tally:?}");
    assert_eq!(tally.undecided, 0, "{tally:?}");
}

/// Delays of fractions of a sample, and of whole samples.
#[test]
fn sampled_loops_are_judged_as_by_their_poles() {
    let (mut random, mut tally) = (Random(2), Tally::default());
    for _ in 0..300 {
        let delay_s = if random.next() < 0.3 { 0.0 } else { 3.0 * SAMPLE * random.next() };
        let compensation = around(random.controller(), Some(SAMPLE), delay_s);
        let Ok(member) = compensation.member(random.plant(0.0)) else { continue };
        for _ in 0..4 {
            let compensation = around(random.controller(), Some(SAMPLE), delay_s);
            compare(&member, &compensation, &mut tally);
        }
    }
    assert!(tally.asked > 1000 && tally.stable > 300 && tally.unresolved < 20, "{tally:?}");
    assert_eq!(tally.undecided, 0, "{tally:?}");
}

#[test]
fn delayed_loops_are_judged_as_by_their_turns() {
    let (mut random, mut tally) = (Random(3), Tally::default());
    for _ in 0..300 {
        let delay_s = 0.1 * random.next();
        let compensation = around(random.controller(), None, delay_s);
        let member = compensation.member(random.plant(0.05)).unwrap();
        compare(&member, &compensation, &mut tally);
    }
    assert!(tally.stable > 50 && tally.unresolved < 60, "{tally:?}");
}

/// Loops made to have one pair of poles damped by a millionth, one way or the other, among others
/// over five decades.
#[test]
fn a_millionth_of_damping_is_resolved() {
    let (mut random, mut tally) = (Random(5), Tally::default());
    for sign in [1.0, -1.0].repeat(200) {
        let others = random.below(7);
        let w = 0.01 * exp(11.5 * random.next());
        let mut poles = random.roots(others, 0.0);
        poles.retain(|pole| pole.re < 0.0);
        poles.extend([Complex64::new(-1e-6 * sign * w, w), Complex64::new(-1e-6 * sign * w, -w)]);
        let closed = Polynomial::from_roots(1.0, &poles).unwrap();
        let open: Vec<Complex64> = poles.iter().map(|pole| pole * (1.5 + 0.5 * sign)).collect();
        let denominator = Polynomial::from_roots(1.0, &open).unwrap();
        let numerator = closed.sum(&denominator.scaled(-1.0));
        let compensation = around(TransferFunction::gain_only(1.0), None, 0.0);
        let member = plant(numerator.coefficients(), denominator.coefficients(), 0.0);
        let before = tally.stable;
        compare(&compensation.member(member).unwrap(), &compensation, &mut tally);
        assert_eq!(tally.stable > before, sign > 0.0, "{poles:?}");
    }
    assert_eq!((tally.asked, tally.undecided, tally.unresolved), (400, 0, 0), "{tally:?}");
}

/// Stability limits to the last digits: k = 6 for k/(s (s + 1) (s + 2)), k T = 2 for sampled k/s,
/// k = pi/2 for k e^(-s)/s.
#[test]
fn the_boundary_is_located_exactly() {
    let cubic = plant(&[1.0], &[1.0, 3.0, 2.0, 0.0], 0.0);
    let integrator = plant(&[1.0], &[1.0, 0.0], 0.0);
    let late = plant(&[1.0], &[1.0, 0.0], 1.0);
    for (limit, resolution, member, sample_time_s) in [
        (6.0, 1e-14, cubic, None),
        (2.0 / SAMPLE, 1e-14, integrator, Some(SAMPLE)),
        (PI / 2.0, 1e-12, late, None),
    ] {
        let mut judged = gain_around(member, sample_time_s);
        for fraction in [1e-2, 1e-5, resolution] {
            assert!(judged(limit * (1.0 - fraction)).0, "{limit} less {fraction}");
            assert!(!judged(limit * (1.0 + fraction)).0, "{limit} more {fraction}");
        }
        assert!(!judged(limit).0, "{limit}");
        assert!(judged(1e-9 * limit).0);
        assert!(!judged(-1e-9 * limit).0);
    }
}

/// System x(n + 1) = x(n) - k T x(n - d), stable for 0 < k T < 2 sin(pi/(4 d + 2)) (Levin and May
/// 1976): by the table for a few samples of delay, by turns for many; the real part is that of the
/// roots of z^(d + 1) - z^d + k T.
#[test]
fn samples_of_delay_and_the_real_part() {
    for samples in [0_u32, 1, 3, 20, 40, 300] {
        let delay_s = f64::from(samples) * SAMPLE;
        let mut judged = gain_around(plant(&[1.0], &[1.0, 0.0], delay_s), Some(SAMPLE));
        let limit = 2.0 * sin(PI / f64::from(4 * samples + 2));
        assert!(judged((1.0 - 1e-9) * limit / SAMPLE).0, "{samples}");
        assert!(!judged((1.0 + 1e-9) * limit / SAMPLE).0, "{samples}");
        if samples <= 40 {
            let mut coefficients = vec![1.0, -1.0];
            coefficients.resize(samples as usize + 2, 0.0);
            *coefficients.last_mut().unwrap() += 1.5 * limit;
            let roots = Polynomial::new(coefficients).roots().unwrap();
            let largest = roots.iter().map(|root| magnitude(*root)).fold(0.0, f64::max);
            let (_, real_part) = judged(1.5 * limit / SAMPLE);
            let expected = ln(largest) / SAMPLE;
            assert!((real_part / expected - 1.0).abs() < 0.01, "{samples}: {real_part} is not {expected}");
        }
    }
}

/// Equation s + k e^(-s) = 0, which has the root a + j w with a = -w/tan w and k = w e^a/sin w.
#[test]
fn the_real_part_of_a_delayed_loop() {
    let mut judged = gain_around(plant(&[1.0], &[1.0, 0.0], 1.0), None);
    for w in [1.6, 2.0, 2.9] {
        let expected = -w / tan(w);
        let (stable, real_part) = judged(w * exp(expected) / sin(w));
        assert!(!stable && (real_part / expected - 1.0).abs() < 0.01, "{real_part} is not {expected}");
    }
    // for k s e^(-s)/(s + 1) infinitely many poles near the real part ln k; for k s e^(-s) an
    // unbounded sequence
    let (stable, real_part) = gain_around(plant(&[1.0, 0.0], &[1.0, 1.0], 1.0), None)(1.5);
    assert!(!stable && (real_part / ln(1.5) - 1.0).abs() < 0.01);
    let mut improper = gain_around(plant(&[1.0, 0.0], &[1.0], 1.0), None);
    assert_eq!(improper(1.5), (false, f64::INFINITY));
}

/// Plants around which a gain must lie between two limits: results do not depend on earlier
/// evaluations, and the plant that fails is found at once.
#[test]
fn answers_do_not_depend_on_their_order() {
    let compensation = around(TransferFunction::gain_only(1.0), None, 0.0);
    // stable for k > a with k/(s - a), for k < b (1 + b) with k/(s (s + 1) (s + b))
    let member = |numerator: &[f64], denominator: &[f64]| {
        compensation.member(plant(numerator, denominator, 0.0)).unwrap()
    };
    let members = || {
        let low = (0..10).map(|a| member(&[1.0], &[1.0, -0.1 * f64::from(a)]));
        let high = (1..10).map(|b| member(&[1.0], &[1.0, 1.0 + f64::from(b), f64::from(b), 0.0]));
        low.chain(high).collect::<Vec<_>>()
    };
    let mut asked = SampleStability::new(&compensation, members());
    let mut random = Random(4);
    for _ in 0..200 {
        let gain = TransferFunction::gain_only(5.0 * random.next());
        let fresh = SampleStability::new(&compensation, members()).judge(&gain).unwrap();
        if random.next() < 0.5 {
            assert_eq!(asked.is_stable(&gain), Ok(fresh.unstable_plants == 0));
        } else {
            assert_eq!(asked.judge(&gain), Ok(fresh));
        }
        let below = (0..10).filter(|a| gain.gain() <= 0.1 * f64::from(*a)).count();
        let above = (1..10).filter(|b| gain.gain() >= f64::from(b * (1 + b))).count();
        assert_eq!(fresh.unstable_plants, below + above);
    }
}

/// A lag measured at 500 points: k a/(s + a) with a negative gain is stable down to k = -1.
#[test]
fn measured_plants_are_counted_by_nyquist() {
    let compensation = around(TransferFunction::gain_only(1.0), None, 0.0);
    let frequencies_rad_per_s: Vec<f64> = (0..800).map(|k| 0.01 * exp(f64::from(k) * 0.013)).collect();
    let lag = |frequency: &f64| 3.0 / (Complex64::new(0.0, *frequency) + 3.0);
    let command = frequencies_rad_per_s.iter().map(lag).collect();
    let measured = MeasuredPlant {
        name: "lag".into(),
        frequencies_rad_per_s,
        command,
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    let mut plants = SampleStability::new(&compensation, vec![compensation.measured(&measured)]);
    let mut stable = |gain| plants.is_stable(&TransferFunction::gain_only(gain)).unwrap();
    assert!(stable(20.0) && stable(-0.9) && !stable(-1.1));
    let judgement = plants.judge(&TransferFunction::gain_only(-1.1)).unwrap();
    assert_eq!((judgement.unstable_plants, judgement.largest_real_part), (1, 0.0));
}

/// Modes in all parts of the loop, which are never cancelled, and a controller in another time
/// domain, which is rejected.
#[test]
fn hidden_modes_and_other_times() {
    let compensation = around(TransferFunction::gain_only(1.0), None, 0.0);
    let member = compensation.member(plant(&[1.0], &[1.0, 1.0], 0.0)).unwrap();
    let mut plants = SampleStability::new(&compensation, vec![member]);
    let factor = vec![Complex64::new(1.5, 0.0)];
    let hidden = TransferFunction::from_factors(1.0, factor.clone(), factor).unwrap();
    let judgement = plants.judge(&hidden).unwrap();
    assert!(judgement.unstable_plants == 1 && (judgement.largest_real_part / 1.5 - 1.0).abs() < 0.01);
    let sampled = TransferFunction::from_factors(1.0, vec![], vec![Complex64::new(-1.0, 0.0)]).unwrap();
    let sampled = sampled.discretized(SAMPLE, Discretization::Tustin).unwrap();
    assert_eq!(plants.is_stable(&sampled), Err(LinearError::DomainMismatch));
    assert_eq!(plants.judge(&sampled), Err(LinearError::DomainMismatch));
}
