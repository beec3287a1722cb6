//! Regions that no step may enter.

use phea_qft::loop_shaping::{Aim, DescentStatus};

use super::formula::{Formula, check_objective, descended};

fn squared_radius(x: &[f64]) -> f64 {
    x[0] * x[0] + x[1] * x[1]
}

/// Unstable unit disc across the straight path; the margin falls towards it, as that of a loop
/// does.
#[test]
fn descent_goes_around_an_unstable_region() {
    let objective = |x: &[f64]| (x[0] - 2.0).powi(2) + x[1] * x[1];
    let mut problem = Formula::new(2, objective, |x| vec![10.0 * squared_radius(x).log10()]);
    problem.instability = |x| 1.0 - squared_radius(x);
    let descent = check_objective(problem, &[-2.0, 1.0], 0.0);
    assert!(descent.judgement.unwrap().stable);
}

/// Region without a margin that falls towards it: the descent stops at its edge, outside, and
/// reports this.
#[test]
fn descent_stops_at_an_edge_without_warning() {
    let mut problem = Formula::new(1, |x| x[0], |_| vec![1.0]);
    problem.instability = |x| 1.0 - x[0];
    let descent = descended(&mut problem, &[2.0], Aim::Objective);
    let judgement = descent.judgement.unwrap();
    assert!(matches!(descent.status, DescentStatus::TrustRegionTooSmall { .. }), "{:?}", descent.status);
    assert!(judgement.stable && (descent.x[0] - 1.0).abs() < 1e-4, "{:?}", descent.x);
}
