//! The mistakes of `examples/qft/mistakes`: each is found, with its numbers.

use phea_qft::design::{ConstraintPlace, Finding, diagnose};
use phea_qft::specification::{ClosedLoop, Limit, Requirement};

use super::problems::{EVERYWHERE, boxed, decibels, demand, plain, problem, rational};

fn numbers<'t, const N: usize>(values: [f64; N]) -> Vec<phea_dynamics::expression::Recorded<'t>> {
    values.into_iter().map(Into::into).collect()
}

/// Plant k/(s (s + 5)) with |S| <= |s/(s + 30)| and |T| <= |5/(s + 5)| both between 8 and 10 rad/s.
#[test]
fn contradictory_bounds() {
    let family = boxed(&[("k", 10.0, 10.0, 20.0)], 3, |p| plain(vec![p[0]], numbers([1.0, 5.0, 0.0]), 0.0));
    let sensitivity = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[1.0, 0.0], &[1.0, 30.0]));
    let stability = Requirement::at_most(ClosedLoop::RobustStability, rational(&[5.0], &[1.0, 5.0]));
    let specifications = vec![
        demand(sensitivity, &[0.1, 1.0, 10.0], [0.0, 10.0]),
        demand(stability, &[8.0, 10.0, 100.0], [8.0, f64::INFINITY]),
    ];
    let found = diagnose(&problem(family, specifications));
    let Finding::SumBelowOne { relaxation_db, sensitivity, complementary, .. } = &found[0] else {
        panic!("{found:?}")
    };
    assert!((relaxation_db - decibels(1.0 / (sensitivity.limit + complementary.limit))).abs() < 1e-3);
    let contradiction = found.iter().find_map(|finding| match finding {
        Finding::Contradiction { frequency_rad_per_s, relaxation_db, .. } => {
            Some((*frequency_rad_per_s, *relaxation_db))
        }
        _ => None,
    });
    let (frequency, [low, high]) = contradiction.unwrap();
    // for the gains 10 and 20, the smallest loop must satisfy S and the greatest T: at phase 0,
    // with 1/(1 + g) = s r and 2 g/(1 + 2 g) = t r
    let (s, t) = (10.0 / 1000f64.sqrt(), 5.0 / 125f64.sqrt());
    let truth = decibels((s + t - (s * s + t * t).sqrt()) / (s * t));
    assert!(frequency == 10.0 && low <= truth && truth <= high + 1e-3, "{low} {truth} {high}");
}

/// Plants with gains of 1 to 10 and 0.1 s of dead time that are to respond alike up to 60 rad/s.
#[test]
fn wide_tracking() {
    let family = boxed(&[("k", 1.0, 1.0, 10.0)], 5, |p| plain(vec![p[0]], numbers([1.0, 0.0]), 0.1));
    let tracking = Requirement::tracking(Limit::Constant(0.9), Limit::Constant(1.1));
    let frequencies = [0.1, 1.0, 10.0, 60.0];
    let stability = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.4));
    let specifications =
        vec![demand(stability, &frequencies, EVERYWHERE), demand(tracking, &frequencies, [0.0, 60.0])];
    let found = diagnose(&problem(family, specifications));
    let explained = found.iter().find(|finding| {
        matches!(finding, Finding::RightHalfPlane { constraint, .. } if constraint.dead_time_s == 0.1)
    });
    assert_eq!(explained.unwrap().specifications(), [0, 1]);
}

/// The pole at 4 rad/s, 4.2 at worst, with |T| <= |3/(s + 2)|: 3/6.2 remains where 1 is needed.
#[test]
fn fast_unstable_pole() {
    let family = boxed(&[("k", 10.0, 8.0, 12.0), ("w", 4.0, 3.8, 4.2)], 3, |p| {
        plain(vec![p[0]], vec![1.0.into(), 0.0.into(), -(p[1] * p[1])], 0.0)
    });
    let roll_off = Requirement::at_most(ClosedLoop::RobustStability, rational(&[3.0], &[1.0, 2.0]));
    let specification = demand(roll_off, &[0.1, 1.0, 2.0, 5.0, 10.0, 50.0], EVERYWHERE);
    let found = diagnose(&problem(family, vec![specification]));
    let Finding::RightHalfPlane { constraint, relaxation_db } = &found[0] else { panic!("{found:?}") };
    assert_eq!(found[0].relaxation_db(), Some(*relaxation_db));
    let ConstraintPlace::UnstablePole(pole) = constraint.place else { panic!("{found:?}") };
    assert!((pole.re - 4.2).abs() < 1e-9);
    assert!((relaxation_db - decibels(6.2 / 3.0)).abs() < 0.01);
    assert!((constraint.crossover_rad_per_s.unwrap() - 5_f64.sqrt()).abs() < 0.05, "{constraint:?}");
}
