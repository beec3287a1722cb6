//! Right-half-plane poles and zeros and dead time, against closed forms (Skogestad and
//! Postlethwaite 2005, chapter 5).

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_qft::design::{ConstraintPlace, DesignProblem};
use phea_qft::family::Family;
use phea_qft::specification::{ClosedLoop, Limit, Requirement};

use super::problems::{
    boxed, constraints, decibels, demand, everywhere, forced_peak_db, impossibilities, plain, problem,
    rational, sampled, single,
};

fn limit_of_t(limit: f64) -> Requirement {
    Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit))
}

fn limit_of_s(limit: f64) -> Requirement {
    Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(limit))
}

/// A limit that is 1 dB too strict is found, with that 1 dB; one with 0.05 dB to spare is not.
fn check(family: &Family, requirement: impl Fn(f64) -> Requirement, least: f64, place: ConstraintPlace) {
    let of = |limit: f64| problem(family.clone(), vec![everywhere(requirement(limit))]);
    let short = constraints(&of(least / 10f64.powf(1.0 / 20.0)));
    let (constraint, relaxation) = short.first().unwrap();
    assert!((relaxation - 1.0).abs() < 0.01, "{relaxation}");
    assert_eq!(constraint.place, place);
    assert_eq!(constraint.specifications, [0]);
    let enough = of(least * 10f64.powf(0.05 / 20.0));
    assert_eq!(impossibilities(&enough), []);
}

fn pole(p: f64) -> ConstraintPlace {
    ConstraintPlace::UnstablePole(Complex64::new(p, 0.0))
}

fn zero(z: f64) -> ConstraintPlace {
    ConstraintPlace::RightHalfPlaneZero(Complex64::new(z, 0.0))
}

/// Least peak |T| >= e^(p T_d) |z + p|/|z - p|, and likewise without dead time for S.
#[test]
fn pole_zero_and_dead_time_raise_the_least_peak() {
    check(&single(&[1.0], &[1.0, -2.0], 0.3), limit_of_t, (0.6_f64).exp(), pole(2.0));
    let both = single(&[1.0, -6.0], &[1.0, -1.0, -2.0], 0.0); // (s - 6)/((s - 2)(s + 1))
    check(&both, limit_of_t, 2.0, pole(2.0));
    check(&both, limit_of_s, 2.0, zero(6.0));
    let delayed = single(&[1.0, -6.0], &[1.0, -1.0, -2.0], 0.1);
    check(&delayed, limit_of_t, 2.0 * (0.2_f64).exp(), pole(2.0));
}

/// A complex pair of poles: |T| >= the product over both of |z + p|/|z - p| at the zero of S.
#[test]
fn a_complex_pair_counts_twice() {
    // ORIGIN: analytic, p = 1 +- 2i, z = 3: |z + p|^2/|z - p|^2 = (16 + 4)/(4 + 4) = 2.5
    check(&single(&[1.0, -3.0], &[1.0, -2.0, 5.0], 0.0), limit_of_s, 2.5, zero(3.0));
}

/// Least control effort |G S| >= 1/|P_s(p)| with P_s = k/(s + p): 2 p/k for k/(s - p), which
/// proportional control reaches.
#[test]
fn an_unstable_plant_costs_control_effort() {
    let effort = |limit: f64| Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(limit));
    check(&single(&[5.0], &[1.0, -3.0], 0.0), effort, 6.0 / 5.0, pole(3.0));
}

/// Least disturbance response |P S| >= |P_m(z)| with P_m the plant without its zero: 4/(z + 1) (2
/// z) for 4 (z - s)/(s + 1)^2 with the zero reflected.
#[test]
fn a_zero_costs_disturbance_rejection() {
    // ORIGIN: analytic, P = 4 (2 - s)/(s + 1)^2: |P_m(2)| = 4 (2 + 2)/9
    let disturbance =
        |limit: f64| Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(limit));
    check(&single(&[-4.0, 8.0], &[1.0, 2.0, 1.0], 0.0), disturbance, 16.0 / 9.0, zero(2.0));
}

/// A rational limit without roots in the right half plane acts by its value at the pole: M w_b/(s +
/// w_b) allows poles up to (M - 1) w_b.
#[test]
fn a_pole_above_the_permitted_bandwidth_is_reported() {
    let of = |p: f64| {
        let limit = Requirement::at_most(ClosedLoop::RobustStability, rational(&[4.0], &[1.0, 2.0])); // 2 * 2/(s + 2)
        problem(single(&[1.0], &[1.0, -p], 0.0), vec![everywhere(limit)])
    };
    let found = constraints(&of(5.0));
    assert_eq!(found.len(), 1);
    assert!((found[0].0.complementary - 4.0 / 7.0).abs() < 1e-3);
    assert!((found[0].1 - decibels(7.0 / 4.0)).abs() < 0.01);
    // |4/(j w + 2)| falls below 1 at sqrt(12)
    assert!((found[0].0.crossover_rad_per_s.unwrap() / 12f64.sqrt() - 1.0).abs() < 0.06);
    assert_eq!(impossibilities(&of(1.95)), []);
}

/// Required bandwidth w_b < z (1 - 1/M) for |S| <= M s/(s + M w_b).
#[test]
fn a_zero_below_the_required_bandwidth_is_reported() {
    let of = |bandwidth: f64| {
        let limit =
            Requirement::at_most(ClosedLoop::Sensitivity, rational(&[2.0, 0.0], &[1.0, 2.0 * bandwidth]));
        problem(single(&[1.0, -10.0], &[1.0, 2.0, 1.0], 0.0), vec![everywhere(limit)])
    };
    assert_eq!(impossibilities(&of(4.9)), []);
    let found = constraints(&of(8.0));
    assert_eq!(found[0].0.place, zero(10.0));
    assert!((found[0].0.sensitivity - 20.0 / 26.0).abs() < 1e-3);
}

/// Forced peak beyond the end of a limit: at least (1/limit) to the power of the ratio of harmonic
/// measures of both parts at the pole.
#[test]
fn sensitivity_rises_outside_the_limited_band() {
    let limited = demand(limit_of_t(0.01), &[], [6.0, f64::INFINITY]);
    let found = forced_peak_db(&problem(single(&[1.0], &[1.0, -2.0], 0.0), vec![limited])).unwrap();
    let free = 2.0 / PI * (6.0_f64 / 2.0).atan();
    assert!((found - 40.0 * (1.0 - free) / free).abs() < 0.05, "{found}");
    // the sensitivity near a zero likewise
    let limited = demand(limit_of_s(0.01), &[], [0.0, 3.0]);
    let found = forced_peak_db(&problem(single(&[1.0, -4.0], &[1.0, 2.0, 1.0], 0.0), vec![limited])).unwrap();
    let below = 2.0 / PI * (3.0_f64 / 4.0).atan();
    assert!((found - 40.0 * below / (1.0 - below)).abs() < 0.1, "{found}");
}

/// Bode's integral: with |S| <= e below b and |T| <= (a/w)^2 beyond a, |S| must rise between them.
/// The areas of ln|S| are b ln(1/e) below 1 and at most (a - b) ln(peak) + a (pi/2 - ln 2) above.
/// Dead time reduces the area further.
#[test]
fn a_stable_plant_has_a_water_bed() {
    let of = |peak: f64, dead_time_s: f64| {
        let roll_off =
            Requirement::at_most(ClosedLoop::RobustStability, rational(&[100.0], &[1.0, 0.0, 0.0]));
        let specifications = vec![
            demand(limit_of_s(0.01), &[], [0.0, 3.0]),
            demand(limit_of_s(peak), &[], [3.0, 10.0]),
            demand(roll_off, &[], [10.0, f64::INFINITY]),
        ];
        problem(single(&[1.0], &[1.0, 1.0, 0.0], dead_time_s), specifications)
    };
    let least = ((3.0 * 100f64.ln() - 10.0 * (PI / 2.0 - 2f64.ln())) / 7.0).exp();
    let found = constraints(&of(0.93 * least, 0.0));
    assert!(matches!(found[0].0.place, ConstraintPlace::Point(_)), "{found:?}");
    assert_eq!(found[0].0.specifications, [0, 1, 2]);
    assert_eq!(impossibilities(&of(1.07 * least, 0.0)), []);
    let late = constraints(&of(1.07 * least, 0.1));
    assert!(late[0].0.dead_time_s == 0.1 && late[0].1 > 1.0, "{late:?}");
}

/// Sampled loop: T = 1 at z = e^(pT), and each sample of delay costs e^(pT): that of the hold, and
/// those of the loop.
#[test]
fn a_sampled_loop_is_judged_in_z() {
    let of = |limit: f64, delay_s: f64| -> DesignProblem {
        let continuous = problem(single(&[1.0], &[1.0, -2.0], 0.0), vec![everywhere(limit_of_t(limit))]);
        sampled(continuous, 0.1, delay_s)
    };
    for (delay_s, samples) in [(0.0, 1.0), (0.1, 2.0), (0.3, 4.0)] {
        let least = (0.2_f64 * samples).exp();
        assert_eq!(impossibilities(&of(least * 1.01, delay_s)), []);
        let found = constraints(&of(least / 1.2, delay_s));
        assert_eq!(found[0].0.place, pole(2.0));
        assert!((found[0].1 - decibels(1.2)).abs() < 0.01, "{found:?}");
        assert!((found[0].0.dead_time_s - 0.1 * samples).abs() < 1e-12);
    }
}

/// The zeros caused by sampling also count: for 1/s^3 one is at z = -3.73 (Astrom, Hagander and
/// Sternby 1984).
#[test]
fn zeros_of_sampling_cost_sensitivity() {
    // ORIGIN: paper, Astrom, Hagander and Sternby (1984): z^2 + 4 z + 1
    let sampling_zero = -2.0 - 3f64.sqrt();
    let pole = (0.2_f64).exp();
    let at = |z: f64| (z - 1.0) / (z + 1.0);
    let family = single(&[1.0], &[1.0, -2.0, 0.0, 0.0], 0.0); // 1/(s^2 (s - 2)), zeros near those of 1/s^3
    let least = ((at(sampling_zero) + at(pole)) / (at(sampling_zero) - at(pole))).abs();
    let of = |limit: f64| {
        let continuous = problem(family.clone(), vec![everywhere(limit_of_s(limit))]);
        sampled(continuous, 0.001, 0.0)
    };
    // the pole is e^0.002 for T = 0.001 and has almost no effect: the constraint at the zero is S
    // >= 1
    assert!(least > 1.0);
    assert_eq!(impossibilities(&of(1.02)), []);
    let found = constraints(&of(0.9));
    assert!(found.iter().any(|(constraint, _)| match constraint.place {
        ConstraintPlace::RightHalfPlaneZero(zero) => (zero.im - PI / 0.001).abs() < 1e-6,
        _ => false,
    }));
}

/// The sensor's dead time and zeros are included in L and count like those of the plant.
#[test]
fn the_sensor_is_part_of_the_loop() {
    let slow = TransferFunction::gain_only(1.0).with_dead_time(0.3).unwrap();
    let plain = problem(single(&[1.0], &[1.0, -2.0], 0.0), vec![everywhere(limit_of_t(1.5))]);
    assert_eq!(impossibilities(&plain), []);
    let found = constraints(&DesignProblem { sensor: slow, ..plain });
    assert!((found[0].1 - decibels((0.6_f64).exp() / 1.5)).abs() < 0.01);
}

/// Tracking wider than possible: plants with gains of 1 to 10 and dead time cannot respond alike
/// far beyond 1/T_d.
#[test]
fn tracking_beyond_the_limit_of_dead_time_is_reported() {
    let of = |to: f64| {
        let family =
            boxed(&[("k", 1.0, 1.0, 10.0)], 3, |p| plain(vec![p[0]], vec![1.0.into(), 0.0.into()], 0.1));
        let tracking = Requirement::tracking(Limit::Constant(0.9), Limit::Constant(1.1));
        problem(family, vec![everywhere(limit_of_t(1.5)), demand(tracking, &[], [0.0, to])])
    };
    assert_eq!(impossibilities(&of(0.3)), []);
    let found = constraints(&of(40.0));
    assert_eq!(found[0].0.specifications, [0, 1]);
    assert_eq!(found[0].0.dead_time_s, 0.1);
}
