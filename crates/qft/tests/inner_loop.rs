//! Inner feedback designed before the loop around it: against closed forms, a grid of gains and
//! corners, and the order of the plants.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use std::f64::consts::FRAC_PI_2;

use num_complex::Complex64;
use phea_dynamics::controller::{InnerFeedback, Timing};
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable::{cos, magnitude, sin};
use phea_qft::inner_loop::{InnerLoopLimits, InnerLoopProblem, InnerPlant, InnerPoint};

const FREE: InnerLoopLimits = InnerLoopLimits {
    modulus_margin: 0.5,
    delay_margin_s: 0.0,
    highest_bandwidth_rad_per_s: f64::INFINITY,
    noise: None,
};

/// A mass of one on the springs K_S of the load and K_H of the oil, filled by the command with area
/// and flow gain of one: force of the load and of the oil.
///
/// ```text
/// p (s + K_H K_c) = K_H (u - s x),   (s^2 + f s + K_S) x = p,   y = K_S x
/// ```
#[derive(Clone, Copy)]
struct Rig {
    load: f64,
    oil: f64,
    friction: f64,
    leakage: f64,
    delay: f64,
}

impl Rig {
    fn at(&self, frequency: f64) -> InnerPoint {
        let s = Complex64::new(0.0, frequency);
        let mass = s * s + self.friction * s + self.load;
        let divisor = (s + self.oil * self.leakage) * mass + self.oil * s;
        let late = Complex64::new(cos(frequency * self.delay), -sin(frequency * self.delay));
        InnerPoint {
            frequency_rad_per_s: frequency,
            plant: late * self.oil * self.load / divisor,
            signal: late * self.oil * mass / divisor,
        }
    }

    fn resonance(&self) -> f64 {
        (self.load + self.oil).sqrt()
    }

    fn plant(&self) -> InnerPlant {
        let mut frequencies = logarithmic_grid(0.1, 300.0, 150).unwrap();
        let near = (-300..=300).map(|step| self.resonance() * (1.0 + 1e-3 * f64::from(step)));
        frequencies.extend(near);
        frequencies.sort_by(f64::total_cmp);
        InnerPlant {
            points: frequencies.into_iter().map(|frequency| self.at(frequency)).collect(),
            reference: self.at(1.0),
        }
    }
}

const RIG: Rig = Rig { load: 64.0, oil: 36.0, friction: 0.2, leakage: 0.0, delay: 0.0 };

fn problem(rigs: &[Rig], limits: InnerLoopLimits) -> InnerLoopProblem {
    InnerLoopProblem {
        plants: rigs.iter().map(Rig::plant).collect(),
        timing: Timing::default(),
        low_pass_rad_per_s: None,
        high_pass_rad_per_s: [0.3, 30.0],
        limits,
    }
}

/// Damping 2 xi w = f/M + k K_H^2/(K_S + K_H) without leakage; a resonance in series with an
/// integrator tolerates a loop gain of 2 xi w (1 - m): the criterion equals the added damping.
#[test]
fn the_loop_gain_is_the_damping_that_is_added() {
    for gain in [0.0, 1e-3, 4e-3] {
        let feedback = InnerFeedback { gain, high_pass_rad_per_s: Some(0.01), low_pass_rad_per_s: None };
        let reach = problem(&[RIG], FREE).reach(&feedback).unwrap().unwrap();
        let damping = RIG.friction + gain * RIG.oil * RIG.oil / (RIG.load + RIG.oil);
        let expected = 0.5 * damping;
        let error = reach.loop_gain / expected - 1.0;
        assert!(error.abs() < 0.02, "{gain}: {} is not {expected}", reach.loop_gain);
        assert!((reach.frequency_rad_per_s / RIG.resonance() - 1.0).abs() < 0.01);
    }
}

/// An integrator with a gain K tolerates a delay of pi/(2 K), one with a delay d tolerates d less.
#[test]
fn a_delay_limits_the_gain_of_an_integrator() {
    for delay in [0.0, 0.03] {
        let at = |frequency: f64| InnerPoint {
            frequency_rad_per_s: frequency,
            plant: Complex64::new(-sin(frequency * delay), -cos(frequency * delay)) / frequency,
            signal: Complex64::ZERO,
        };
        let points = (1..=20_000).map(|step| at(1e-2 * f64::from(step))).collect();
        let limits = InnerLoopLimits { modulus_margin: 1e-6, delay_margin_s: 0.05, ..FREE };
        let plants = vec![InnerPlant { points, reference: at(1.0) }];
        let problem = InnerLoopProblem { plants, ..problem(&[], limits) };
        let reach = problem.reach(&InnerFeedback::default()).unwrap().unwrap();
        let expected = FRAC_PI_2 / (0.05 + delay);
        assert!((reach.outer_gain / expected - 1.0).abs() < 1e-3, "{}", reach.outer_gain);
    }
}

/// An integrator with a gain K falls to -3 dB of 1/(1 + s/K) at K.
#[test]
fn a_bandwidth_limits_the_gain_of_an_integrator() {
    let at = |frequency: f64| InnerPoint {
        frequency_rad_per_s: frequency,
        plant: Complex64::new(0.0, -1.0 / frequency),
        signal: Complex64::ZERO,
    };
    let points = (1..=1000).map(|step| at(f64::from(step))).collect();
    let limits = InnerLoopLimits { highest_bandwidth_rad_per_s: 20.0, ..FREE };
    let plants = vec![InnerPlant { points, reference: at(1.0) }];
    let reach = InnerLoopProblem { plants, ..problem(&[], limits) }.reach(&InnerFeedback::default());
    let reach = reach.unwrap().unwrap();
    assert!((reach.outer_gain / 20.0 - 1.0).abs() < 1e-12 && reach.frequency_rad_per_s == 20.0);
}

fn family() -> Vec<Rig> {
    let late = Rig { delay: 0.05, leakage: 1e-3, ..RIG };
    [30.0, 64.0, 150.0]
        .into_iter()
        .flat_map(|load| [20.0, 36.0].map(|oil| Rig { load, oil, ..late }))
        .chain([Rig { friction: 1.0, ..late }])
        .collect()
}

/// The result is within one hundredth of the best gain and corner of a fine grid, and better than
/// no feedback.
#[test]
fn the_gain_is_at_least_as_good_as_the_best_of_a_grid() {
    let limits = InnerLoopLimits { delay_margin_s: 0.02, ..FREE };
    let problem = problem(&family(), limits);
    let found = problem.best().unwrap().unwrap();
    let mut best = 0.0_f64;
    for corner in logarithmic_grid(0.3, 30.0, 41).unwrap() {
        for gain in logarithmic_grid(1e-3, 10.0, 161).unwrap() {
            let feedback =
                InnerFeedback { gain, high_pass_rad_per_s: Some(corner), low_pass_rad_per_s: None };
            let reach = problem.reach(&feedback).unwrap();
            best = best.max(reach.map_or(0.0, |reach| reach.loop_gain));
        }
    }
    assert!(found.reach.loop_gain > 0.99 * best, "{found:?} {best}");
    assert!(found.reach.loop_gain > 1.5 * found.without.loop_gain, "{found:?}");
    assert!(magnitude(Complex64::new(found.reach.loop_gain / best - 1.0, 0.0)) < 0.05, "{found:?} {best}");
}

#[test]
fn the_order_of_the_plants_does_not_matter() {
    let limits = InnerLoopLimits { delay_margin_s: 0.02, ..FREE };
    let mut rigs = family();
    let first = problem(&rigs, limits).best().unwrap().unwrap();
    for _ in 1..rigs.len() {
        rigs.rotate_left(1);
        let found = problem(&rigs, limits).best().unwrap().unwrap();
        let apart = found.reach.loop_gain / first.reach.loop_gain - 1.0;
        assert!(apart.abs() < 5e-3, "{found:?} {first:?}");
    }
}

/// A plant whose signal does not respond to the command passes the noise unchanged: k = u/n.
#[test]
fn noise_limits_the_gain() {
    let deaf = |rig: &Rig| {
        let mut plant = rig.plant();
        plant.points.retain(|point| point.frequency_rad_per_s < 40.0);
        plant
    };
    let timing = Timing { sample_time_s: Some(std::f64::consts::PI / 40.0), ..Timing::default() };
    let quiet = InnerLoopProblem { plants: vec![deaf(&RIG)], timing, ..problem(&[], FREE) };
    let free = quiet.best().unwrap().unwrap();
    let limits = InnerLoopLimits { noise: Some([2.0, 1e-3]), ..FREE };
    let noisy = InnerLoopProblem { limits, ..quiet }.best().unwrap().unwrap();
    assert!(noisy.feedback.gain < 1e-2 * free.feedback.gain, "{noisy:?} {free:?}");
    // so small a gain does not change the noise, and |H| of a high pass is at most one
    let least = 0.5e-3;
    assert!(noisy.feedback.gain >= least * 0.95, "{noisy:?}");
    assert!(noisy.reach.loop_gain < free.reach.loop_gain);
}
