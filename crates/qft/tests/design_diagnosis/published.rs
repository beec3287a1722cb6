//! Published problems that can be met, without false alarms.

use phea_dynamics::expression::Recorded;
use phea_dynamics::uncertain_plant::{PlantCoefficients, UncertainParameter, UncertainPlant};
use phea_qft::design::{FindingSeverity, diagnose};
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};

use super::problems::{EVERYWHERE, boxed, demand, plain, problem, rational, sampled};
use crate::rig::force;

fn stability(limit: f64, frequencies: &[f64]) -> Specification {
    demand(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(limit)), frequencies, EVERYWHERE)
}

fn silent(family: Family, specifications: Vec<Specification>) {
    assert_eq!(diagnose(&problem(family, specifications)), []);
}

/// Plant k/((s + a)(s + b)), the plants of example 1 of Borghesani, Chait and Yaniv (1994).
#[test]
fn forty_edge_plants() {
    let named = |name: &str, nominal, minimum, maximum| UncertainParameter {
        name: name.into(),
        nominal,
        minimum,
        maximum,
    };
    let parameters =
        vec![named("k", 1.0, 1.0, 10.0), named("a", 5.0, 1.0, 5.0), named("b", 30.0, 20.0, 30.0)];
    let plant = UncertainPlant::record(parameters, |p| {
        plain(vec![p[0]], vec![1.0.into(), p[1] + p[2], p[1] * p[2]], 0.0)
    })
    .unwrap();
    let members = (0..10).flat_map(|index| {
        let fraction = f64::from(index) / 9.0;
        let (a, k) = (1.0 + 4.0 * fraction, 1.0 + 9.0 * fraction);
        [vec![10.0, a, 20.0], vec![1.0, a, 30.0], vec![k, 5.0, 30.0], vec![k, 1.0, 20.0]]
    });
    let family = UncertainFamily::new(plant, vec![], members.collect(), Extent::Members).unwrap();
    let limit = rational(&[0.02, 1.28, 14.96, 48.0], &[1.0, 14.4, 169.0]);
    let disturbance = Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(0.01));
    let specifications = vec![
        stability(1.2, &[0.1, 5.0, 10.0, 100.0]),
        demand(Requirement::at_most(ClosedLoop::Sensitivity, limit), &[0.1, 5.0, 10.0], [0.0, 10.0]),
        demand(disturbance, &[0.1, 5.0, 10.0], [0.0, 50.0]),
    ];
    silent(Family::Uncertain(family), specifications);
}

/// Plant k a/(s (s + a)), the servo of Horowitz and Sidi (1972), with tracking up to 10 and up to
/// 15 rad/s.
#[test]
fn servo() {
    for to in [10.0, 15.0] {
        let family = boxed(&[("k", 1.0, 1.0, 10.0), ("a", 1.0, 1.0, 10.0)], 5, |p| {
            plain(vec![p[0] * p[1]], vec![1.0.into(), p[1], 0.0.into()], 0.0)
        });
        let tracking = Requirement::tracking(
            rational(&[120.0], &[1.0, 17.0, 82.0, 120.0]),
            rational(&[0.6584, 19.752], &[1.0, 4.0, 19.752]),
        );
        let frequencies: Vec<f64> = [0.1, 0.5, 1.0, 2.0, 10.0, to].into();
        silent(family, vec![stability(1.2, &[0.1, 1.0, 100.0]), demand(tracking, &frequencies, [0.0, to])]);
    }
}

/// Plant k/(s^2 (s^2 + 2 k)): two masses and a spring.
#[test]
fn undamped() {
    let family = boxed(&[("k", 1.0, 0.5, 2.0)], 5, |p| {
        let none = || Recorded::from(0.0);
        plain(vec![p[0]], vec![1.0.into(), none(), p[0] + p[0], none(), none()], 0.0)
    });
    silent(family, vec![stability(2.25, &[0.01, 0.1, 0.9, 0.99, 1.01, 1.5, 2.01, 20.0])]);
}

/// Plant k (s + a) w^2/(s^2 + 2 z w s + w^2) with |S| below 6 dB.
#[test]
fn resonant() {
    let parameters = [("k", 2.0, 2.0, 5.0), ("a", 1.0, 1.0, 3.0), ("z", 0.3, 0.3, 0.6), ("w", 4.0, 4.0, 8.0)];
    let family = boxed(&parameters, 3, |p| {
        let [k, a, z, w] = [p[0], p[1], p[2], p[3]];
        plain(vec![k * w * w, k * a * w * w], vec![1.0.into(), z * w + z * w, w * w], 0.0)
    });
    let six_db = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(10f64.powf(0.3)));
    silent(family, vec![demand(six_db, &[0.2, 0.5, 1.0, 3.0, 5.0, 7.0, 10.0, 20.0, 50.0], [0.2, 50.0])]);
}

/// Plant k (s + a)/(s^2 - 2.5) with |T| <= 2.1: the published controller fails, but an unstable
/// pole requires only |T| = 1.
#[test]
fn unstable() {
    let of = |dead_time_s: f64| {
        let family = boxed(&[("k", 1.0, 1.0, 10.0), ("a", 0.1, 0.1, 1.0)], 3, |p| {
            plain(vec![p[0], p[0] * p[1]], vec![1.0.into(), 0.0.into(), (-2.5).into()], dead_time_s)
        });
        diagnose(&problem(family, vec![stability(2.1, &[0.1, 1.0, 2.0, 6.0, 50.0])]))
    };
    assert_eq!(of(0.0), []);
    // ORIGIN: analytic, e^(sqrt(2.5) T) = 2.1 at T = 0.4692 s
    assert_eq!(of(0.465), []);
    assert_eq!(of(0.49).first().map(|finding| finding.severity()), Some(FindingSeverity::Impossible));
}

fn rig<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    PlantCoefficients { command: force(p), disturbance: None, dead_time_s: 0.0.into(), rate: None }
}

/// The whole of Table 6.3 with the limits of 6.30 to 6.32, continuous and sampled at 1 kHz with 0.5
/// ms of delay.
#[test]
fn thesis() {
    let parameters = [
        ("viscous_friction", 100.0, 100.0, 3e4),
        ("flow_gain", 5.4e-5, 3.23e-5, 5.61e-5),
        ("flow_pressure_coefficient", 6.42e-13, 6.42e-13, 7e-11),
        ("hydraulic_stiffness", 2.24e6, 2.24e6, 4.11e6),
        ("valve_natural_frequency", 1099.0, 879.0, 1319.0),
        ("valve_damping_ratio", 0.9, 0.72, 1.08),
    ];
    let slow = [0.01, 0.1, 1.0, 5.0, 10.0, 50.0, 100.0, 150.0];
    let sensitivity = Requirement::at_most(ClosedLoop::Sensitivity, rational(&[1.0, 0.0], &[1.0, 15.0]));
    let tracking = Requirement::tracking(
        rational(&[20000.0], &[1.0, 90.0, 2400.0, 20000.0]),
        rational(&[2116.0 / 75.0, 2116.0], &[1.0, 73.6, 2116.0]),
    );
    let specifications = vec![
        stability(1.3, &slow),
        demand(sensitivity, &slow[..5], [0.01, 10.0]),
        demand(tracking, &slow, [0.0, 150.0]),
    ];
    let continuous = problem(boxed(&parameters, 2, rig), specifications);
    assert_eq!(diagnose(&continuous), []);
    let found = diagnose(&sampled(continuous, 1e-3, 0.5e-3));
    assert!(found.iter().all(|finding| finding.severity() == FindingSeverity::Warning), "{found:?}");
}
