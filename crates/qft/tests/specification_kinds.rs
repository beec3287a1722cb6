//! Closed loop limited by each kind of specification.

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};

fn margin(requirement: Requirement) -> f64 {
    let real = |value: f64| Complex64::new(value, 0.0);
    let response = LoopResponse {
        plant: real(3.0),
        load_motion: real(8.0),
        controller: real(1.0),
        prefilter: real(2.0),
        sensor: real(1.0),
    };
    let specification =
        Specification { requirement, frequencies_rad_per_s: vec![], band_rad_per_s: [0.0, 1.0] };
    specification.margin_db(&response, 1.0).unwrap()
}

/// Closed loops for L = 3, all simple fractions: T = 3/4, S = 1/4, P S = 3/4, G S = 1/4, Pd S = 2,
/// F T = 3/2.
#[test]
fn each_kind_limits_its_own_closed_loop() {
    let limit = Limit::Constant;
    for (requirement, ratio) in [
        (Requirement::at_most(ClosedLoop::RobustStability, limit(1.5)), 2.0),
        (Requirement::at_most(ClosedLoop::Sensitivity, limit(0.5)), 2.0),
        (Requirement::at_most(ClosedLoop::PlantInputDisturbance, limit(0.375)), 0.5),
        (Requirement::at_most(ClosedLoop::ControlEffort, limit(0.25)), 1.0),
        (Requirement::at_most(ClosedLoop::LoadMotion, limit(20.0)), 10.0),
        (Requirement::tracking(limit(1.0), limit(15.0)), 1.5),
        (Requirement::tracking(limit(3.0), limit(15.0)), 0.5),
        (Requirement::tracking(limit(0.1), limit(1.5)), 1.0),
    ] {
        assert!(
            (margin(requirement.clone()) - 20.0 * portable::log10(ratio)).abs() < 1e-12,
            "{requirement:?}"
        );
    }
}
