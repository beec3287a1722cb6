//! Limits of performance for a family as a whole.

use num_complex::Complex64;
use phea_qft::design::{DesignProblem, Finding, FindingSeverity, diagnose};
use phea_qft::family::{Family, MeasuredFamily, MeasuredPlant};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};

use super::problems::{
    boxed, decibels, demand, everywhere, impossibilities, plain, problem, rational, sampled, single,
};

fn gain(least: f64, pole: f64) -> Family {
    boxed(&[("k", 1.0, least, 1.0)], 3, move |p| plain(vec![p[0]], vec![1.0.into(), (-pole).into()], 0.0))
}

/// Plant k/(s - p): s - p + k G must be positive at p for any G, so that k G(p) > 0.
#[test]
fn gains_of_both_signs_need_the_same_controller() {
    for pole in [0.0, 2.0] {
        let found = impossibilities(&problem(gain(-1.0, pole), vec![]));
        let [Finding::GainSign { pole_rad_per_s, plants }] = found.as_slice() else { panic!("{found:?}") };
        assert!((pole_rad_per_s - pole).abs() < 1e-12 && plants[0] != plants[1]);
        assert_eq!(diagnose(&problem(gain(0.5, pole), vec![])), []);
    }
    // a stable plant needs no feedback, unless integral action is required
    let integral = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[2.0, 0.0], &[1.0, 0.01]));
    assert_eq!(diagnose(&problem(gain(-1.0, -3.0), vec![])), []);
    let found = impossibilities(&problem(gain(-1.0, -3.0), vec![demand(integral, &[], [0.0, 1e-3])]));
    assert!(matches!(found[0], Finding::GainSign { pole_rad_per_s: 0.0, .. }), "{found:?}");
}

#[test]
fn a_delay_margin_beyond_two_time_constants() {
    let of = |minimum_delay_margin_s: f64| DesignProblem {
        minimum_delay_margin_s,
        ..problem(single(&[1.0], &[1.0, -4.0], 0.0), vec![])
    };
    assert_eq!(diagnose(&of(0.49)), []);
    let found = impossibilities(&of(0.51));
    assert!(matches!(found[0], Finding::DelayMargin { greatest_s: 0.5, .. }), "{found:?}");
}

/// Plant (s - 1)/((s - 2)(s + 1)): one pole between the zero and infinity; (s - 3)/... has none.
#[test]
fn plants_that_no_stable_controller_stabilises() {
    let of = |zero: f64| {
        let mut findings = diagnose(&problem(single(&[1.0, -zero], &[1.0, -1.0, -2.0], 0.0), vec![]));
        // both raise the peaks: |z + p|/|z - p| is 3 and 5
        let Finding::ForcedPeak { peak_db, .. } = findings.remove(0) else { panic!("{findings:?}") };
        assert!((peak_db - decibels((zero + 2.0) / (zero - 2.0).abs())).abs() < 1e-6);
        findings
    };
    let found = of(1.0);
    let [finding @ Finding::UnstableController { between_zeros_rad_per_s, .. }] = found.as_slice() else {
        panic!("{found:?}")
    };
    assert_eq!(
        (*between_zeros_rad_per_s, finding.severity()),
        ([1.0, f64::INFINITY], FindingSeverity::Warning)
    );
    assert_eq!(of(3.0), []);
}

#[test]
fn frequencies_out_of_reach() {
    let stability = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.5));
    let of = |family: Family| problem(family, vec![demand(stability.clone(), &[1.0, 50.0], [1.0, 50.0])]);
    let found = diagnose(&sampled(of(single(&[1.0], &[1.0, 1.0], 0.0)), 0.1, 0.0));
    assert!(
        matches!(found[0], Finding::OutOfReach { frequency_rad_per_s: 50.0, plant: None, .. }),
        "{found:?}"
    );
    let measured = MeasuredPlant {
        name: "a".into(),
        frequencies_rad_per_s: vec![0.5, 20.0],
        command: vec![Complex64::new(1.0, 0.0); 2],
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    let found = diagnose(&of(Family::Measured(MeasuredFamily::new(vec![measured]).unwrap())));
    assert!(matches!(found[0], Finding::OutOfReach { frequency_rad_per_s: 50.0, plant: Some(_), .. }));
}

#[test]
fn a_static_gain_that_is_not_one() {
    let tracking = Requirement::tracking(Limit::Constant(0.8), Limit::Constant(0.9));
    let found = diagnose(&problem(single(&[1.0], &[1.0, 0.0], 0.0), vec![demand(tracking, &[], [0.0, 1.0])]));
    assert_eq!(found, [Finding::StaticGain { specification: 0, lower: 0.8, upper: 0.9 }]);
    assert_eq!(found[0].severity(), FindingSeverity::Warning);
}

/// Measured plant with only a known response, and the dead time of the loop: the waterbed effect is
/// nevertheless reported.
#[test]
fn measured_plants_have_a_water_bed_too() {
    let frequencies: Vec<f64> = (0..60).map(|index| 10f64.powf(-2.0 + 0.1 * f64::from(index))).collect();
    let plant = MeasuredPlant {
        name: "a".into(),
        command: frequencies.iter().map(|w| 1.0 / Complex64::new(1.0, *w)).collect(),
        frequencies_rad_per_s: frequencies,
        disturbance: None,
        unstable_poles: 0,
        radii: vec![],
        integrators: None,
        is_resolved: false,
    };
    let specifications = vec![
        demand(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.05)), &[], [0.0, 20.0]),
        everywhere(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.5))),
    ];
    let of = |delay_s: f64| {
        let family = Family::Measured(MeasuredFamily::new(vec![plant.clone()]).unwrap());
        let mut problem = problem(family, specifications.clone());
        problem.timing.delay_s = delay_s;
        impossibilities(&problem)
    };
    assert_eq!(of(0.0), []);
    assert!(matches!(of(0.2).as_slice(), [Finding::RightHalfPlane { .. }]));
}
