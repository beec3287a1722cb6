//! Optima in closed form.

use std::f64::consts::PI;

use phea_dynamics::watch::unwatched;
use phea_qft::loop_shaping::{Aim, DescentOptions, DescentStatus, descend};

use super::formula::{Formula, check_objective, descended};

/// The quadratic nearest to x^4 between -1 and 1 is x^2 - 1/8: Chebyshev's polynomial, whose error
/// 1/8 alternates five times.
#[test]
fn chebyshev_fit_alternates() {
    let margins = |u: &[f64]| {
        let error = |x: f64| x.powi(4) - u[0].exp() * x * x + u[1].exp();
        let points = (0..=40).map(|i| (PI * f64::from(i) / 40.0).cos());
        points.flat_map(|x| [-error(x), error(x)]).collect()
    };
    let mut problem = Formula::new(2, |_| 0.0, margins);
    let descent = descended(&mut problem, &[1.0, 1.0], Aim::WorstMargin);
    assert_eq!(descent.status, DescentStatus::Converged);
    let worst = descent.judgement.unwrap().worst_margin_db;
    assert!((worst + 0.125).abs() < 1e-5, "{worst}");
    assert!(descent.x[0].abs() < 1e-3 && (descent.x[1] - 0.125_f64.ln()).abs() < 1e-2, "{:?}", descent.x);
    let strengths: f64 = descent.binding.iter().map(|binding| binding.multiplier).sum();
    assert!((strengths - 1.0).abs() < 1e-6, "the shares of the common margin: {:?}", descent.binding);
}

/// Rosenbrock's valley, cut by the unit circle: the optimum is on it, found independently by its
/// angle.
#[test]
fn bent_valley_cut_by_a_circle() {
    let valley = |x: &[f64]| 100.0 * (x[1] - x[0] * x[0]).powi(2) + (1.0 - x[0]).powi(2);
    let on_circle = |i: u32| valley(&[(1e-6 * f64::from(i)).cos(), (1e-6 * f64::from(i)).sin()]);
    let expected = (0..1_570_796).map(on_circle).fold(f64::INFINITY, f64::min);
    let problem = Formula::new(2, valley, |x| vec![1.0 - x[0] * x[0] - x[1] * x[1]]);
    let descent = check_objective(problem, &[-0.6, 0.6], expected);
    assert!(descent.work.judgements < 60, "{:?}", descent.work);
}

/// Maratos (1978): every full step towards (1, 0) worsens the margin as much as it improves the
/// objective; without correction, steps shrink to zero.
#[test]
fn full_steps_are_taken_along_a_curved_margin() {
    let objective = |x: &[f64]| 2.0 * (x[0] * x[0] + x[1] * x[1] - 1.0) - x[0];
    let problem = Formula::new(2, objective, |x| vec![x[0] * x[0] + x[1] * x[1] - 1.0]);
    let descent = check_objective(problem, &[0.0, 1.2], -1.0);
    assert!(descent.work.judgements < 30, "{:?}", descent.work);
    let multiplier = descent.binding[0].multiplier;
    assert!((multiplier - 1.5).abs() < 1e-2, "{multiplier}");
}

/// Two margins that exclude each other: the worst margin is greatest half-way, and the deficit is
/// reported.
#[test]
fn contradiction_is_named() {
    let margins = |x: &[f64]| vec![x[0] - 1.0 - x[1] * x[1], -3.0 - x[0]];
    let mut problem = Formula::new(2, |x| x[0], margins);
    let descent = descended(&mut problem, &[4.0, 2.0], Aim::Objective);
    let DescentStatus::Infeasible { worst_margin_db } = descent.status else { panic!("{descent:?}") };
    assert!((worst_margin_db + 2.0).abs() < 1e-4, "{worst_margin_db}");
    let multipliers: Vec<f64> = descent.binding.iter().map(|binding| binding.multiplier).collect();
    assert!(
        multipliers.len() == 2 && multipliers.iter().all(|multiplier| (multiplier - 0.5).abs() < 1e-3),
        "{multipliers:?}"
    );
}

/// A margin that hardly changes has a large multiplier, up to which the penalty must grow; if the
/// tolerance exceeds its change, it has no effect.
#[test]
fn nearly_flat_margin_is_satisfied_or_tolerated() {
    let mut problem = Formula::new(1, |x| (x[0] - 3.0).powi(2), |x| vec![1e-4 * (1.0 - x[0])]);
    let mut descent_of = |reserve_db: f64, tolerance_db: f64| {
        let options = DescentOptions { reserve_db, tolerance_db, ..DescentOptions::new(Aim::Objective) };
        let descent = descend(&mut problem, &[-2.0], options, &mut unwatched).unwrap();
        assert_eq!(descent.status, DescentStatus::Converged);
        descent
    };
    let satisfied = descent_of(0.0, 1e-6);
    assert!((satisfied.x[0] - 1.0).abs() < 0.011, "{:?}", satisfied.x);
    assert!((satisfied.binding[0].multiplier / 4e4 - 1.0).abs() < 0.02, "{:?}", satisfied.binding);
    let tolerated = descent_of(-5e-4, 1e-4);
    assert!((tolerated.x[0] - 3.0).abs() < 0.01, "{:?}", tolerated.x);
}

#[test]
fn hopeless_starts_are_refused() {
    let mut problem = Formula::new(1, |x| x[0], |x| vec![x[0]]);
    let descent_of = |problem: &mut Formula, start: &[f64]| descended(problem, start, Aim::Objective).status;
    assert_eq!(descent_of(&mut problem, &[21.0]), DescentStatus::StartOutside);
    assert_eq!(descent_of(&mut problem, &[1.0, 1.0]), DescentStatus::StartOutside);
    problem.instability = |x| x[0];
    assert_eq!(descent_of(&mut problem, &[1.0]), DescentStatus::StartUnusable);
    let options = DescentOptions { steps_maximum: 2, ..DescentOptions::new(Aim::Objective) };
    let descent = descend(&mut problem, &[-10.0], options, &mut unwatched).unwrap();
    assert_eq!(descent.status, DescentStatus::BudgetSpent { steps: 2 });
}
