//! Contradictions: the smallest relaxation, the conflicting limits, and proof that the relaxed
//! problem is met.

use phea_dynamics::linear::TransferFunction;
use phea_qft::design::{Design, DesignProblem, DesignStatus, Relaxation};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{TrackingJudgement, Verdict};

use super::problems::{audited, demand, designed, example_d, integrator, least_gain, problem, structure};

/// The limit times a factor.
fn times(limit: &Limit, factor: f64) -> Limit {
    match limit {
        Limit::Constant(value) => Limit::Constant(value * factor),
        Limit::Rational(function) => {
            let (zeros, poles) = (function.zeros().to_vec(), function.poles().to_vec());
            Limit::Rational(TransferFunction::from_factors(function.gain() * factor, zeros, poles).unwrap())
        }
        Limit::Table(_) => panic!("{limit:?}"),
    }
}

/// Every upper limit raised and every lower one reduced by this number of dB.
fn relaxed(problem: &DesignProblem, relaxation_db: f64) -> DesignProblem {
    let factor = 10.0_f64.powf(relaxation_db / 20.0);
    let requirement = |one: &Requirement| match one.limits() {
        (Some(lower), upper) => Requirement::tracking(times(lower, 1.0 / factor), times(upper, factor)),
        (None, limit) => Requirement::at_most(one.closed_loop(), times(limit, factor)),
    };
    let specifications = problem
        .specifications
        .iter()
        .map(|one| Specification { requirement: requirement(&one.requirement), ..one.clone() })
        .collect();
    DesignProblem { specifications, ..problem.clone() }
}

fn relaxation(design: &Design) -> &Relaxation {
    let DesignStatus::Infeasible(relaxation) = &design.status else { panic!("{:?}", design.status) };
    relaxation
}

/// Sensitivity up to 1 rad/s against complementary sensitivity from there on.
fn integrator_problem(greatest: f64, [sensitivity, complementary]: [f64; 2]) -> DesignProblem {
    let specifications = vec![
        demand(
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(sensitivity)),
            &[1.0],
            [0.0, 1.0],
        ),
        demand(
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(complementary)),
            &[1.0],
            [1.0, f64::INFINITY],
        ),
    ];
    problem(integrator(greatest), specifications)
}

/// Closed form for a gain g and the plants k/s, k from 1 to c^(1/2):
///
/// ```text
/// |S|^2 = 1/(1 + g^2) <= R a^2        |T|^2 = c g^2/(1 + c g^2) <= R b^2        at 1 rad/s
/// both reached:  (c - 1) a^2 b^2 R^2 - c (a^2 + b^2) R + c = 0
/// ```
#[test]
fn the_relaxation_of_a_pure_gain_has_its_closed_form() {
    for (greatest, [a, b]) in [(1.0, [0.3, 0.6]), (2.0, [0.3, 0.6]), (2.0, [0.7, 0.7])] {
        let problem = integrator_problem(greatest, [a, b]);
        let c = f64::powi(greatest, 2);
        let (square, linear) = ((c - 1.0) * a * a * b * b, c * (a * a + b * b));
        let ratio = 2.0 * c / (linear + (linear * linear - 4.0 * square * c).sqrt());
        let expected_db = 10.0 * ratio.log10();
        for seed in 1..=3 {
            let pure_gain = structure("", [1e-3, 1e3], [1.0, 1.0], [1.0, 1.0]);
            let design = designed(&problem, least_gain(pure_gain, seed));
            let found = relaxation(&design);
            assert!((found.relaxation_db - expected_db).abs() < 1e-3, "{found:?}, not {expected_db} dB");
            let gain = design.controller.feedback.transfer_function().unwrap().gain();
            assert!((gain * gain * ratio * a * a - 1.0 + ratio * a * a).abs() < 2e-3, "{gain}");
            let at: Vec<usize> = found.conflicts.iter().map(|one| one.specification).collect();
            assert!(at.contains(&0) && at.contains(&1), "{found:?}");
            for conflict in &found.conflicts {
                assert!((conflict.margin_db + expected_db).abs() < 1e-2, "{conflict:?}");
                assert!((conflict.frequency_rad_per_s - 1.0).abs() < 1e-2, "{conflict:?}");
            }
            assert_eq!(design.audit.verdict, Verdict::Violated);
            let wider = relaxed(&problem, found.relaxation_db);
            let audit = audited(&wider, &design, TrackingJudgement::Spread);
            assert_eq!(audit.verdict, Verdict::Met, "{:?}", audit.specifications);
        }
    }
}

/// A required delay is included in the relaxation. For a gain g and the plant 1/s:
///
/// ```text
/// |S|^2 = 1/(1 + g^2) <= R a^2  at 1 rad/s          delay = (pi/2)/g >= D/R^(1/2)
/// both reached:  (pi/(2 D))^2 R^2 + R - 1/a^2 = 0
/// ```
#[test]
fn a_required_delay_is_relaxed_with_the_limits() {
    let (a, delay_s) = (0.3, 1.0);
    let sensitivity = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(a));
    let specifications = vec![demand(sensitivity, &[1.0], [0.0, 1.0])];
    let problem =
        DesignProblem { minimum_delay_margin_s: delay_s, ..problem(integrator(1.0), specifications) };
    let square = (std::f64::consts::FRAC_PI_2 / delay_s).powi(2);
    let ratio = ((1.0 + 4.0 * square / (a * a)).sqrt() - 1.0) / (2.0 * square);
    let pure_gain = structure("", [1e-3, 1e3], [1.0, 1.0], [1.0, 1.0]);
    let design = designed(&problem, least_gain(pure_gain, 1));
    let found = relaxation(&design);
    assert!((found.relaxation_db - 10.0 * ratio.log10()).abs() < 1e-3, "{found:?}");
    let reached = design.audit.delay_margin.as_ref().unwrap().delay_s;
    assert!((reached * ratio.sqrt() / delay_s - 1.0).abs() < 1e-3, "{reached}");
    // a delay missed by no more than the relaxation is not new to the search
    assert_eq!(design.rounds.len(), 1);
}

/// Example D with corners no higher than 300 rad/s, where its least gain requires 837 rad/s.
#[test]
fn three_seeds_agree_on_the_relaxation_of_the_servo() {
    let problem = example_d();
    // ORIGIN: recomputed by comparisons/recompute_design.py over the whole box
    let expected_db = 2.7336;
    for seed in 1..=3 {
        let slow = structure("Z PP", [1e-2, 1e4], [0.1, 300.0], [0.1, 5.0]);
        let design = designed(&problem, least_gain(slow, seed));
        let found = relaxation(&design);
        assert!((found.relaxation_db - expected_db).abs() < 0.02, "{seed}: {found:?}");
        let at: Vec<usize> = found.conflicts.iter().map(|one| one.specification).collect();
        assert!(at.contains(&0) && at.contains(&1), "{found:?}");
        let wider = relaxed(&problem, found.relaxation_db);
        let audit = audited(&wider, &design, TrackingJudgement::Spread);
        assert_eq!(audit.verdict, Verdict::Met, "{:?}", audit.specifications);
    }
}
