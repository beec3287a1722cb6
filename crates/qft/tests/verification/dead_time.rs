//! Loops with dead time, continuous and sampled, with a sensor and correlated parameters, compared
//! with an independent search.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Family, Spacing};
use phea_qft::specification::{ClosedLoop, Limit, LimitTable, Requirement, Specification};
use phea_qft::verification::{SpecificationFinding, TrackingJudgement};

use super::plants::{along, audited, on_grid, parameter, rational, specification};

/// Worst margin, its frequency, and the margins at the design frequencies.
struct Truth {
    worst: (f64, f64),
    design: &'static [f64],
}

fn check(findings: &[SpecificationFinding], truths: &[Truth]) {
    for (finding, truth) in findings.iter().zip(truths) {
        let worst = finding.worst.as_ref().unwrap();
        assert!((worst.margin_db - truth.worst.0).abs() < 2e-5, "{worst:?} {:?}", truth.worst);
        let ratio = worst.frequency_rad_per_s / truth.worst.1;
        assert!(truth.worst.1 == 0.0 || (ratio - 1.0).abs() < 1e-4, "{worst:?} {:?}", truth.worst);
        assert!(truth.design.is_empty() || finding.at_design_frequencies.len() == truth.design.len());
        for (case, margin) in finding.at_design_frequencies.iter().zip(truth.design) {
            assert!((case.margin_db - margin).abs() < 2e-5, "{case:?} {margin}");
        }
    }
}

fn judged(
    family: &Family,
    controller: Controller,
    specifications: &[Specification],
) -> Vec<SpecificationFinding> {
    let one = rational(&[1.0], &[1.0]);
    let around = Compensation::new(&controller, one).unwrap();
    audited(family, &around, specifications, TrackingJudgement::Magnitude).0
}

/// Plant k e^(-0.2 s)/(tau s + 1).
fn process() -> Family {
    let parameters = vec![parameter("k", 1.0, 0.8, 1.25), parameter("tau", 1.0, 0.8, 1.5)];
    let plant = UncertainPlant::record(parameters, |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![p[1], 1.0.into()] },
        disturbance: None,
        dead_time_s: 0.2.into(),
        rate: None,
    });
    on_grid(plant.unwrap(), vec![along(0, Spacing::Logarithmic, 5), along(1, Spacing::Logarithmic, 5)])
}

// ORIGIN: recomputed by comparisons/compare_verify.py
#[test]
fn a_process_with_dead_time() {
    let everywhere = [0.0, f64::INFINITY];
    let design = [0.1, 0.5, 1.0, 2.0, 5.0, 10.0];
    let six_db = 10f64.powf(0.3);
    let specifications = [
        specification(
            Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.3)),
            &design,
            everywhere,
        ),
        specification(
            Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(six_db)),
            &design,
            everywhere,
        ),
        specification(
            Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(0.6)),
            &design,
            everywhere,
        ),
    ];
    let integral = Element::General(rational(&[1.8, 1.8], &[1.0, 0.0]));
    let controller = Controller { feedback: Compensator::new(vec![integral]), ..Controller::default() };
    let truths = [
        Truth { worst: (1.71646, 0.893436), design: &[2.25804, 1.9342, 1.73577, 2.67939, 3.42018, 10.82619] },
        Truth {
            worst: (1.597778, 6.156412),
            design: &[29.09301, 13.93266, 7.46651, 4.6569, 2.05081, 3.50505],
        },
        Truth {
            worst: (1.445417, 3.613015),
            design: &[20.69086, 7.31351, 3.13568, 2.0381, 1.98013, 9.25901],
        },
    ];
    check(&judged(&process(), controller.clone(), &specifications), &truths);
    let timing = Timing { sample_time_s: Some(0.2), delay_s: 0.2, ..Timing::default() };
    let truths = [Truth {
        worst: (-14.302966, 3.129149),
        design: &[2.23964, 1.45177, -0.03472, -3.6913, 4.83761, 14.28336],
    }];
    check(&judged(&process(), Controller { timing, ..controller }, &specifications[..1]), &truths);
}

/// Plant k w^2 e^(-s T)/(s (s^2 + 2 d w s + w^2)), with damping that decreases with stiffness, and
/// a force cell 1/(s/800 + 1) with 0.5 ms of dead time.
// ORIGIN: recomputed by comparisons/compare_verify.py
#[test]
fn a_load_frame_with_everything_at_once() {
    let parameters = vec![
        parameter("k", 4.0, 3.0, 6.0),
        parameter("w", 90.0, 70.0, 120.0),
        parameter("d", 0.25, 0.2, 0.35),
        parameter("T", 0.002, 0.001, 0.004),
    ];
    let plant = UncertainPlant::record(parameters, |p| {
        let [k, w, d, dead_time_s] = [p[0], p[1], p[2], p[3]];
        let damping = d * w + d * w;
        PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![k * w * w],
                denominator: vec![1.0.into(), damping, w * w, 0.0.into()],
            },
            disturbance: Some(RationalCoefficients {
                numerator: vec![(-2.0).into(), damping * (-2.0).into(), 0.0.into()],
                denominator: vec![1.0.into(), damping, w * w],
            }),
            dead_time_s,
            rate: None,
        }
    });
    let stiffness = Coordinate {
        parameters: vec![1, 2],
        opposed: vec![2],
        spacing: vec![Spacing::Logarithmic, Spacing::Logarithmic],
        points: 5,
    };
    let coordinates = vec![along(0, Spacing::Logarithmic, 5), stiffness, along(3, Spacing::Linear, 3)];
    let family = on_grid(plant.unwrap(), coordinates);
    let everywhere = [0.0, f64::INFINITY];
    let table = LimitTable::new(vec![(1.0, 0.01), (30.0, 1.2), (100.0, 10.0), (200.0, 10.0)]).unwrap();
    let stable = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.3));
    let specifications = [
        specification(stable, &[], everywhere),
        specification(
            Requirement::at_most(ClosedLoop::LoadMotion, Limit::Table(table)),
            &[1.0, 3.0, 10.0, 30.0, 100.0],
            [1.0, 200.0],
        ),
        specification(
            Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(10f64.powf(0.6))),
            &[1.0, 10.0, 100.0],
            everywhere,
        ),
    ];
    let lead = Element::General(rational(&[1.5 / 60.0, 1.5], &[1.0 / 150.0, 1.0]));
    let controller = Controller { feedback: Compensator::new(vec![lead]), ..Controller::default() };
    let sensor = rational(&[1.0], &[1.0 / 800.0, 1.0]).with_dead_time(5e-4).unwrap();
    let around = Compensation::new(&controller, sensor).unwrap();
    let (findings, _) = audited(&family, &around, &specifications, TrackingJudgement::Magnitude);
    // |T| = 1 at rest, the limit above it by 20 log10 1.3
    let truths = [
        Truth { worst: (20.0 * 1.3f64.log10(), 0.0), design: &[] },
        Truth { worst: (0.360868, 62.34138), design: &[7.24148, 2.90396, 2.45562, 3.13223, 3.5254] },
        Truth { worst: (0.18706, 116.1751), design: &[21.74239, 9.01415, 0.91977] },
    ];
    check(&findings, &truths);
}
