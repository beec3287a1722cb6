//! The impedance at the load: asymptotes, the published controller's lack of passivity, and the
//! step without a final force.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::frequency::passivity;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable;
use phea_hydraulics::impedance::{
    Asymptote, AsymptoteKind, closed_loop_impedance, compliance_hidden_above, final_force_after_load_step,
    impedance_asymptotes, load_motion_of, open_loop_impedance,
};
use phea_hydraulics::linear::{LinearModel, LinearParameters, linear_model};
use phea_hydraulics::reference_rig::nominal_plant;

fn integrator(proportional: f64, integral: f64) -> TransferFunction {
    let zero = Complex64::new(-integral / proportional, 0.0);
    TransferFunction::from_factors(proportional, vec![zero], vec![Complex64::new(0.0, 0.0)]).unwrap()
}

/// G_1 = (0.001 s + 0.008)/s
fn published_controller() -> TransferFunction {
    integrator(0.001, 0.008)
}

fn model() -> LinearModel {
    linear_model(&nominal_plant()).unwrap()
}

fn logarithmic(from: f64, to: f64, points: u32) -> Vec<f64> {
    let decades = portable::log10(to / from);
    (0..=points).map(|i| from * portable::pow(10.0, decades * f64::from(i) / f64::from(points))).collect()
}

#[test]
fn open_loop_is_passive_on_the_axis() {
    for viscous_friction in [0.0, 100.0, 3e4] {
        for flow_pressure_coefficient in [6.42e-13, 7e-11] {
            let parameters =
                LinearParameters { viscous_friction, flow_pressure_coefficient, ..nominal_plant() };
            let impedance = open_loop_impedance(&linear_model(&parameters).unwrap()).unwrap();
            assert!(impedance.is_stable());
            for frequency in logarithmic(1e-3, 1e5, 4000) {
                assert!(impedance.at_frequency(frequency).re >= 0.0, "at {frequency}");
            }
        }
    }
}

#[test]
fn published_closed_loop_fails_between_447_and_921_rad_per_s() {
    let impedance = closed_loop_impedance(&model(), &published_controller()).unwrap();
    assert!(impedance.is_stable());
    let real = |frequency: f64| impedance.at_frequency(frequency).re;
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    let (from, to) = (446.62935, 921.59055);
    for (edge, inside, outside) in [(from, 1e-6, -1e-6), (to, -1e-6, 1e-6)] {
        assert!(real(edge * (1.0 + inside)) < 0.0 && real(edge * (1.0 + outside)) > 0.0);
    }
    for frequency in logarithmic(1e-3, 1e5, 4000) {
        assert_eq!(real(frequency) < 0.0, (from..to).contains(&frequency), "at {frequency}");
    }
}

/// Passivity conditions, all three, and the band found by the passivity test.
#[test]
fn passivity_of_open_and_published_closed_loop() {
    let open = passivity(&open_loop_impedance(&model()).unwrap()).unwrap();
    assert!(open.passive && open.bands.is_empty() && open.right_half_plane_poles.is_empty());
    let closed = passivity(&closed_loop_impedance(&model(), &published_controller()).unwrap()).unwrap();
    assert!(!closed.passive && closed.right_half_plane_poles.is_empty() && closed.bands.len() == 1);
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    assert!((closed.bands[0].from_rad_per_s / 446.62935 - 1.0).abs() < 2e-8);
    assert!((closed.bands[0].to_rad_per_s / 921.59055 - 1.0).abs() < 2e-8);
}

/// Z from factors compared with Z_open/(1 + G P), at every frequency.
#[test]
fn closed_loop_impedance_is_the_open_one_divided() {
    let controller = published_controller();
    let rational = closed_loop_impedance(&model(), &controller).unwrap();
    let motion = load_motion_of(&rational).unwrap();
    assert_eq!(rational.poles().len(), 6);
    for frequency in logarithmic(1e-4, 1e6, 100) {
        let loop_gain = controller.at_frequency(frequency) * model().command.at_frequency(frequency);
        let divided = open_loop_impedance(&model()).unwrap().at_frequency(frequency) / (1.0 + loop_gain);
        let found = rational.at_frequency(frequency);
        assert!((found / divided - 1.0).norm_sqr().sqrt() < 1e-9, "{frequency}: {found} against {divided}");
        let ratio = motion.at_frequency(frequency) / (-found * Complex64::new(0.0, frequency));
        assert!((ratio - 1.0).norm_sqr().sqrt() < 1e-12);
    }
}

fn asymptote(kind: AsymptoteKind, controller: Option<&TransferFunction>) -> Asymptote {
    let all = impedance_asymptotes(&nominal_plant(), controller);
    *all.iter().find(|asymptote| asymptote.kind == kind).unwrap()
}

/// Asymptotes compared with the model, each far into its range.
#[test]
fn model_follows_its_asymptotes() {
    let proportional = TransferFunction::gain_only(2.73e-4);
    let published = published_controller();
    let double = integrator(0.001, 0.008).series(&integrator(1.0, 0.5)).unwrap();
    for controller in [None, Some(&proportional), Some(&published), Some(&double)] {
        let impedance = match controller {
            None => open_loop_impedance(&model()).unwrap(),
            Some(controller) => closed_loop_impedance(&model(), controller).unwrap(),
        };
        let ratio = |kind, frequency: f64| {
            let line = asymptote(kind, controller);
            impedance.at_frequency(frequency) / line.at_frequency(frequency)
        };
        let near = |ratio: Complex64, tolerance: f64| (ratio - 1.0).norm_sqr().sqrt() < tolerance;
        assert!(near(ratio(AsymptoteKind::LowFrequency, 1e-5), 1e-3), "{controller:?}");
        assert!(near(ratio(AsymptoteKind::SensorLimit, 1e6), 1e-4), "{controller:?}");
    }
    // the plateau is between the loop's bandwidth and the frequency above which the mass dominates.
    let open = open_loop_impedance(&model()).unwrap();
    let plateau = asymptote(AsymptoteKind::CompliancePlateau, None);
    assert_eq!((plateau.power, plateau.to), (-1, compliance_hidden_above(2.24e6, 13.1)));
    let ratio = open.at_frequency(20.0) / plateau.at_frequency(20.0);
    assert!((ratio - 1.0).norm_sqr().sqrt() < 0.03, "{ratio}");
}

#[test]
fn coefficients_of_the_asymptotes() {
    let p = nominal_plant();
    let (a, kc) = (p.useful_area, p.flow_pressure_coefficient);
    let near = |found: f64, expected: f64, tolerance: f64| {
        assert!((found / expected - 1.0).abs() < tolerance, "{found} against {expected}");
    };
    // ORIGIN: analytic, limits of (6.7) and (6.8)
    let open = asymptote(AsymptoteKind::LowFrequency, None);
    near(open.coefficient, (a * a + p.viscous_friction * kc) / kc, 1e-15);
    assert_eq!(open.power, 0);
    let proportional = asymptote(AsymptoteKind::LowFrequency, Some(&TransferFunction::gain_only(0.01)));
    near(proportional.coefficient, a / (p.flow_gain * 0.01), 1e-3);
    assert_eq!(proportional.power, 0);
    let integral = asymptote(AsymptoteKind::LowFrequency, Some(&published_controller()));
    near(integral.coefficient, a / (p.flow_gain * 0.008), 1e-4);
    assert_eq!(integral.power, 1);
    let plateau = asymptote(AsymptoteKind::CompliancePlateau, None);
    near(plateau.coefficient, 2.24e6 * 2e7 / 2.224e7, 1e-12);
    assert_eq!(asymptote(AsymptoteKind::SensorLimit, None).coefficient, 2e7);
    // ORIGIN: analytic, sqrt(2.233e6/13.1)
    assert!((compliance_hidden_above(2.233e6, 13.1) - 412.9).abs() < 0.05);
}

/// Asymptotes have positive ranges: one that is nowhere the nearest is omitted.
#[test]
fn asymptotes_that_are_nearest_nowhere_are_left_out() {
    let kinds = |parameters: &LinearParameters, controller: Option<&TransferFunction>| {
        let asymptotes = impedance_asymptotes(parameters, controller);
        assert!(asymptotes.iter().all(|line| line.from < line.to && line.coefficient.is_finite()));
        asymptotes.iter().map(|line| line.kind).collect::<Vec<_>>()
    };
    let all = [AsymptoteKind::LowFrequency, AsymptoteKind::CompliancePlateau, AsymptoteKind::SensorLimit];
    let nominal = nominal_plant();
    assert_eq!(kinds(&nominal, None), all);
    // the spring applies from the lowest frequency if there is no leakage
    let tight = LinearParameters { flow_pressure_coefficient: 0.0, ..nominal };
    assert_eq!(kinds(&tight, None), all[1..]);
    // a loop faster than sqrt(K_H/M) leaves no plateau: its damper A/(K_qU K_p) crosses the spring
    // above 413 rad/s
    let fast = TransferFunction::gain_only(0.1);
    assert_eq!(kinds(&nominal, Some(&fast)), [all[0], all[2]]);
}

/// A softer fluid no longer softens the contact above sqrt(K_H/M).
#[test]
fn mass_hides_the_compliance() {
    let at = |hydraulic_stiffness, frequency| {
        let parameters = LinearParameters { hydraulic_stiffness, ..nominal_plant() };
        let impedance = open_loop_impedance(&linear_model(&parameters).unwrap()).unwrap();
        portable::magnitude(impedance.at_frequency(frequency))
    };
    let hidden = compliance_hidden_above(2.24e6, 13.1);
    assert!(at(1.12e6, hidden / 10.0) < 0.6 * at(2.24e6, hidden / 10.0));
    assert!((at(1.12e6, hidden * 10.0) / at(2.24e6, hidden * 10.0) - 1.0).abs() < 0.02);
}

/// Proposition 6.2, and its limits.
#[test]
fn load_step_leaves_no_force() {
    let open = model().load_position;
    assert_eq!(final_force_after_load_step(&open, 5e-3), Some(0.0));
    let closed = |controller: &TransferFunction| {
        load_motion_of(&closed_loop_impedance(&model(), controller).unwrap()).unwrap()
    };
    for controller in [TransferFunction::gain_only(1e-3), published_controller()] {
        assert_eq!(final_force_after_load_step(&closed(&controller), 5e-3), Some(0.0));
    }
    // a gain of one, as in the proof, is unstable for this plant: there is no final value
    let unstable = closed(&TransferFunction::gain_only(1.0));
    assert_eq!(final_force_after_load_step(&unstable, 5e-3), None);
    // ORIGIN: analytic, without leakage and feedback the springs hold K_eq x
    let tight = LinearParameters { flow_pressure_coefficient: 0.0, ..nominal_plant() };
    let force = final_force_after_load_step(&linear_model(&tight).unwrap().load_position, 5e-3).unwrap();
    assert!((force / (-2.24e6 * 2e7 / 2.224e7 * 5e-3) - 1.0).abs() < 1e-9);
}
