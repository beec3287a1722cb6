//! Limits that contradict each other at a frequency.

use phea_qft::design::Finding;
use phea_qft::specification::{ClosedLoop, Limit, Requirement};

use super::problems::{boxed, decibels, demand, impossibilities, plain, problem, rational, single};

/// Constraint |S| + |T| >= 1: a fraction of each is missing, and a common factor brings the sum
/// to 1.
#[test]
fn sensitivity_against_complementary_sensitivity() {
    let of = |limit_of_s: f64| {
        let specifications = vec![
            demand(
                Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(limit_of_s)),
                &[2.0],
                [1.0, 3.0],
            ),
            demand(
                Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(0.5)),
                &[2.0],
                [2.0, 100.0],
            ),
        ];
        problem(single(&[1.0], &[1.0, 1.0], 0.0), specifications)
    };
    assert_eq!(impossibilities(&of(0.51)), []);
    let found = impossibilities(&of(0.3));
    let [
        Finding::SumBelowOne { frequency_rad_per_s, sensitivity, complementary, relaxation_db, .. },
        rest @ ..,
    ] = found.as_slice()
    else {
        panic!("{found:?}")
    };
    assert!((2.0..=3.0).contains(frequency_rad_per_s));
    assert_eq!([sensitivity.specification, complementary.specification], [0, 1]);
    assert!((relaxation_db - decibels(1.0 / 0.8)).abs() < 1e-3);
    // the bounds at the design frequency agree
    let [Finding::Contradiction { frequency_rad_per_s: 2.0, conflicts, relaxation_db, .. }] = rest else {
        panic!("{rest:?}")
    };
    assert!(relaxation_db[0] <= decibels(1.0 / 0.8) && decibels(1.0 / 0.8) <= relaxation_db[1] + 1e-3);
    assert!(relaxation_db[1] - relaxation_db[0] < 0.1);
    assert_eq!(conflicts.iter().map(|margin| margin.specification).collect::<Vec<_>>(), [0, 1]);
}

/// Control effort limits |T| by |G S| |P|, a disturbance at the plant's input |S| by |P S|/|P|.
#[test]
fn effort_against_disturbance() {
    // ORIGIN: analytic, |P(j 2)| = 8/4 for 8/(s^2): |T| <= 0.2 * 2, |S| <= 1/2
    let specifications = vec![
        demand(Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(0.2)), &[], [2.0, 2.0]),
        demand(
            Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(1.0)),
            &[2.0],
            [2.0, 2.0],
        ),
        demand(Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(0.2)), &[2.0], [1.99, 2.01]),
    ];
    let found = impossibilities(&problem(single(&[8.0], &[1.0, 0.0, 0.0], 0.0), specifications));
    let contradiction = found.iter().find_map(|finding| match finding {
        Finding::Contradiction { relaxation_db, .. } => Some(*relaxation_db),
        _ => None,
    });
    let [low, high] = contradiction.unwrap();
    let truth = decibels(1.0 / 0.9);
    assert!(low <= truth && truth <= high + 1e-3 && high - low < 0.1, "{low} {truth} {high}");
}

/// Two plants of opposite phase and |T| <= 1.2: more gain for tracking does not help, which only
/// several plants show.
#[test]
fn spread_against_stability_takes_two_plants() {
    let of = |ratio: f64| {
        let family =
            boxed(&[("k", 1.0, 1.0, 10.0)], 3, |p| plain(vec![p[0]], vec![1.0.into(), 1.0.into()], 0.0));
        let tracking = Requirement::tracking(Limit::Constant(1.0 / ratio), Limit::Constant(ratio));
        let effort = Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(0.5));
        problem(family, vec![demand(tracking, &[1.0], [1.0, 1.0]), demand(effort, &[1.0], [1.0, 1.0])])
    };
    // |G| must be small: the spread stays near 10, for any limit on |T|
    let found = impossibilities(&of(1.2));
    let Some(Finding::Contradiction { conflicts, relaxation_db, frequency_rad_per_s: 1.0, .. }) =
        found.first()
    else {
        panic!("{found:?}")
    };
    assert_eq!(conflicts.iter().map(|margin| margin.specification).collect::<Vec<_>>(), [0, 1]);
    assert!(conflicts[0].other.is_some() && conflicts[0].plant != *conflicts[0].other.as_ref().unwrap());
    assert!(relaxation_db[0] > 1.0);
    assert_eq!(impossibilities(&of(5.0)), []);
}

#[test]
fn crossed_limits_of_tracking() {
    let tracking = Requirement::tracking(rational(&[10.0], &[1.0, 10.0]), rational(&[9.0], &[1.0, 9.0]));
    let found = impossibilities(&problem(
        single(&[1.0], &[1.0, 0.0], 0.0),
        vec![demand(tracking, &[1.0], [0.0, 50.0])],
    ));
    let [Finding::CrossedLimits { frequency_rad_per_s, lower, upper, relaxation_db, .. }] = found.as_slice()
    else {
        panic!("{found:?}")
    };
    assert!(*frequency_rad_per_s == 50.0 && lower > upper);
    assert!((relaxation_db - decibels(lower / upper) / 2.0).abs() < 1e-9);
}

/// Contradictions on the axis: T = 1 at a pole, S = 1 and T = 0 at a zero.
#[test]
fn poles_and_zeros_on_the_axis() {
    let low = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(0.9));
    let found =
        impossibilities(&problem(single(&[1.0], &[1.0, 0.0, 4.0], 0.0), vec![demand(low, &[], [1.0, 3.0])]));
    assert!(matches!(found[0], Finding::PoleOnTheAxis { frequency_rad_per_s: 2.0, .. }), "{found:?}");
    let following = Requirement::tracking(Limit::Constant(0.5), Limit::Constant(1.5));
    let found = impossibilities(&problem(
        single(&[1.0, 0.0], &[1.0, 1.0], 0.0),
        vec![demand(following, &[], [0.0, 1.0])],
    ));
    assert!(matches!(found[0], Finding::ZeroOnTheAxis { frequency_rad_per_s: 0.0, .. }), "{found:?}");
    let quiet = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5));
    let found = impossibilities(&problem(
        single(&[1.0, 0.0, 9.0], &[1.0, 2.0, 1.0], 0.0),
        vec![demand(quiet, &[], [2.9, 3.1])],
    ));
    assert!(matches!(found[0], Finding::ZeroOnTheAxis { frequency_rad_per_s: 3.0, .. }), "{found:?}");
}
