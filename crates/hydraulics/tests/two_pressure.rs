//! The two-pressure model compared with its own dual-number linearisation, and the fifth-order
//! model compared with the two-pressure model.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::expression::Expression;
use phea_dynamics::linear::StateSpace;
use phea_dynamics::scalar::{Dual, Parameters};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::impedance::open_loop_impedance;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::linear::{linear_model, response_difference, transfer_functions};
use phea_hydraulics::operating_point::{Condition, OperatingPoint, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{
    USEFUL_AREA, components, cylinder, hose_line, nominal_plant, pipe_line, valve_with_equal_edges,
};
use phea_hydraulics::servovalve::{Edges, Servovalve, SpoolDirection};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::two_pressure::{
    TwoPressureInput, TwoPressureLinearParameters, TwoPressureModel, TwoPressureState, linearize, rates,
    reduce, reduction, two_pressure_coefficients, two_pressure_linear_parameters,
};

fn model(actuator: &Actuator, point: &OperatingPoint, friction: f64) -> TwoPressureModel {
    TwoPressureModel::new(actuator, [point.pressure_a, point.pressure_b], StiffeningMember::Nominal, friction)
}

/// Matrices of the nonlinear equations at a state, by dual numbers: states first, then command and
/// load velocity.
fn jacobian(
    model: &TwoPressureModel,
    state: &TwoPressureState,
    input: &TwoPressureInput,
) -> ([[f64; 8]; 6], [f64; 6]) {
    let mut index = 0;
    let mut variable = |value: f64| {
        index += 1;
        Dual::<8>::variable(value, index - 1)
    };
    let state = TwoPressureState::from_array(state.to_array().map(&mut variable));
    let input = TwoPressureInput {
        command: variable(input.command),
        load_velocity: variable(input.load_velocity),
        load_position: Dual::constant(input.load_position),
    };
    let rates = rates(&model.convert(&mut Into::into), &state, &input).to_array();
    (rates.map(|rate| *rate.gradient()), rates.map(|rate| rate.value()))
}

/// Every entry agrees to 1e-9 of itself. The chambers' dependence on the deflection is proportional
/// to a net flow that vanishes at an equilibrium: it must be 1e-9 of the effect of the piston's
/// velocity on that pressure.
fn check_against_jacobian(system: &StateSpace, jacobian: &[[f64; 8]; 6]) {
    for (row, duals) in jacobian.iter().enumerate() {
        for (column, &dual) in duals.iter().enumerate() {
            let analytic = if column < 6 { system.a()[(row, column)] } else { system.b()[(row, column - 6)] };
            let vanishing = column == 4 && (row == 2 || row == 3);
            let scale = if vanishing { (duals[5] * 1e-2 / 1e-4).abs() } else { dual.abs() };
            let error = (analytic - dual).abs();
            assert!(error <= 1e-9 * scale, "row {row}, column {column}: {analytic} against {dual}");
        }
    }
}

fn rigs() -> Vec<Components> {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    let unequal = components(hose_line(), StiffnessModel::Uniform);
    let asymmetric = Components {
        cylinder: Cylinder { area_a, area_b, dead_volume_a: 2e-5, ..cylinder() },
        line_b: pipe_line(),
        ..components(hose_line(), StiffnessModel::ByVolume)
    };
    let air = Some(EntrainedAir { volume_fraction: 0.02, polytropic_exponent: 1.4 });
    vec![
        unequal,
        Components { valve: valve_with_equal_edges(), ..unequal },
        asymmetric,
        Components { fluid: Fluid { entrained_air: air, ..asymmetric.fluid }, ..asymmetric },
    ]
}

#[test]
fn linearisation_agrees_with_dual_numbers_everywhere() {
    let conditions = [
        Condition::Command(0.03),
        Condition::Command(-0.4),
        Condition::Load(SteadyLoad::Force(3000.0)),
        Condition::Load(SteadyLoad::Force(-2000.0)),
        Condition::Motion(1.5, SteadyLoad::Force(1000.0)),
        Condition::Motion(-0.7, SteadyLoad::Force(2500.0)),
    ];
    for components in rigs() {
        let actuator = Actuator::new(components).unwrap();
        for position in [0.0, 0.1, 0.25, 0.47] {
            for condition in conditions {
                let point = operating_point(&actuator, position, condition).unwrap();
                let model = model(&actuator, &point, 299.0);
                let (state, input) = model.at(&point);
                let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
                let system = linearize(&parameters).unwrap();
                let (jacobian, rest) = jacobian(&model, &state, &input);
                check_against_jacobian(&system, &jacobian);
                // at rest the remainder is rounding of far larger terms
                let largest = [1e-9, 1e-3, 10.0, 10.0, 1e-12, 1e-6];
                for (rate, bound) in rest.into_iter().zip(largest) {
                    assert!(rate.abs() < bound, "{rest:?}");
                }
            }
        }
    }
}

/// Equations compared directly, far from rest.
#[test]
fn rates_of_the_nonlinear_model() {
    let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume)).unwrap();
    let model = TwoPressureModel::new(&actuator, [0.0; 2], StiffeningMember::Nominal, 100.0);
    let state = TwoPressureState::from_array([-0.37, 12.0, 21e5, 48e5, 1.3e-4, -0.02]);
    let input = TwoPressureInput { command: 0.9, load_velocity: 0.004, load_position: 0.31 };
    // ORIGIN: recomputed by comparisons/recompute_rig.py (eight digits)
    let expected = [12.0, 1510168.9, 15987455.0, -20468628.0, -0.024, -524.66254];
    for (found, expected) in rates(&model, &state, &input).to_array().into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 5e-8, "{found} against {expected}");
    }
}

/// Recorded equations, run with numbers, become data that give identical bits.
#[test]
fn recorded_rates_are_the_rates() {
    let actuator = Actuator::new(rigs()[2]).unwrap();
    let model = TwoPressureModel::new(&actuator, [35e5; 2], StiffeningMember::Nominal, 100.0);
    let names = ["spool", "spool_rate", "pressure_a", "pressure_b", "deflection", "velocity", "command"];
    let recorded = Expression::record(&names, |p| {
        let state = TwoPressureState::from_array([p[0], p[1], p[2], p[3], p[4], p[5]]);
        let input =
            TwoPressureInput { command: p[6], load_velocity: 0.004.into(), load_position: 0.31.into() };
        rates(&model.convert(&mut Into::into), &state, &input).to_array().to_vec()
    });
    for values in [
        [-0.37, 12.0, 21e5, 48e5, 1.3e-4, -0.02, 0.9],
        [0.0, 0.0, 35e5, 35e5, 0.0, 0.0, 0.0],
        [9.0, -300.0, 70.1e5, 10.0, -2e-4, 0.3, -10.0],
    ] {
        let [a, b, c, d, e, f, command] = values;
        let state = TwoPressureState::from_array([a, b, c, d, e, f]);
        let input = TwoPressureInput { command, load_velocity: 0.004, load_position: 0.31 };
        assert_eq!(recorded.evaluate(&values), rates(&model, &state, &input).to_array());
    }
}

/// A passive actuator remains passive for any edges, areas and position: leakage and friction only
/// absorb energy.
#[test]
fn open_loop_impedance_of_the_two_pressure_model_is_passive() {
    for components in rigs() {
        let actuator = Actuator::new(components).unwrap();
        for (position, condition) in
            [(0.0, Condition::Command(0.0)), (0.4, Condition::Motion(2.0, SteadyLoad::Force(2000.0)))]
        {
            let point = operating_point(&actuator, position, condition).unwrap();
            let parameters = two_pressure_linear_parameters(
                &model(&actuator, &point, 100.0),
                &point,
                SpoolDirection::Extending,
            );
            let model = transfer_functions(&two_pressure_coefficients(&parameters)).unwrap();
            let impedance = open_loop_impedance(&model).unwrap();
            assert!(impedance.is_stable());
            for frequency in grid() {
                assert!(impedance.at_frequency(frequency).re >= 0.0, "at {frequency}");
            }
        }
    }
}

#[test]
fn null_valve_takes_the_mean_slope_of_both_directions() {
    let actuator = Actuator::new(rigs()[0]).unwrap();
    let point = operating_point(&actuator, 0.3, Condition::Command(0.0)).unwrap();
    let model = model(&actuator, &point, 100.0);
    let (state, input) = model.at(&point);
    let (duals, _) = jacobian(&model, &state, &input);
    let of = |direction| {
        linearize(&two_pressure_linear_parameters(&model, &point, direction)).unwrap().a().clone()
    };
    check_against_jacobian(
        &linearize(&two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean)).unwrap(),
        &duals,
    );
    let (extending, retracting) = (of(SpoolDirection::Extending), of(SpoolDirection::Retracting));
    assert!((extending[(2, 0)] + retracting[(2, 0)] - 2.0 * duals[2][0]).abs() < 1e-12 * extending[(2, 0)]);
    // ORIGIN: analytic, K_v3 sqrt(p_S - p_A) over K_v4 sqrt(p_A) if leakage balances
    let ratio = (3.2e-7 / 2.5e-7) * (2.2e-9 / 2.35e-9);
    assert!((extending[(2, 0)] / retracting[(2, 0)] / ratio - 1.0).abs() < 1e-6);
}

/// The rational form and the state space represent one system.
#[test]
fn coefficients_and_state_space_respond_alike() {
    for components in rigs() {
        let actuator = Actuator::new(components).unwrap();
        let point = operating_point(&actuator, 0.15, Condition::Load(SteadyLoad::Force(1000.0))).unwrap();
        let model = model(&actuator, &point, 150.0);
        let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
        let system = linearize(&parameters).unwrap();
        let plant = two_pressure_coefficients(&parameters);
        let rational = transfer_functions(&plant).unwrap();
        for frequency in [1e-3, 0.1, 3.0, 40.0, 700.0, 1290.0, 5e3, 1e5] {
            let s = Complex64::new(0.0, frequency);
            let command = system.at_frequency(frequency, 0, 0).unwrap();
            let load = s * system.at_frequency(frequency, 1, 0).unwrap();
            for (a, b) in [
                (command, rational.command.at_frequency(frequency)),
                (load, rational.load_position.at_frequency(frequency)),
            ] {
                assert!((a / b - 1.0).norm_sqr().sqrt() < 1e-9, "{frequency}: {a} against {b}");
            }
        }
    }
}

fn matched(position: f64) -> TwoPressureLinearParameters {
    // the case of comparisons/recompute_rig.py: the hose, K_qU 5.62e-5, K_c 6.42e-13, f_v 100, K_S
    // 2e7
    let valve = Servovalve {
        flow_coefficients: Edges::equal(5.62e-4 / 35e5_f64.sqrt()),
        leakage_coefficients: Edges::equal(6.42e-13 * 140e5_f64.sqrt()),
        ..valve_with_equal_edges()
    };
    let components = Components { valve, ..components(hose_line(), StiffnessModel::Uniform) };
    let actuator = Actuator::new(components).unwrap();
    let point = operating_point(&actuator, position, Condition::Command(0.0)).unwrap();
    two_pressure_linear_parameters(&model(&actuator, &point, 100.0), &point, SpoolDirection::Extending)
}

fn grid() -> Vec<f64> {
    (0..=2000).map(|step| phea_dynamics::portable::pow(10.0, -3.0 + 7.0 * f64::from(step) / 2000.0)).collect()
}

#[test]
fn fifth_order_model_is_exact_at_mid_stroke_with_equal_edges() {
    let parameters = matched(0.25);
    let reduced = reduce(&parameters);
    let plant = nominal_plant();
    // ORIGIN: analytic, the parameters of (6.7) are recovered
    assert!((reduced.flow_gain / 5.62e-5 - 1.0).abs() < 1e-6);
    assert!((reduced.flow_pressure_coefficient / plant.flow_pressure_coefficient - 1.0).abs() < 1e-6);
    assert!((reduced.hydraulic_stiffness / 2.2329616e6 - 1.0).abs() < 1e-7);
    assert!((reduced.useful_area / USEFUL_AREA - 1.0).abs() < 1e-15);
    let difference = reduction(&parameters, &grid()).unwrap();
    for found in [difference.command, difference.load_motion] {
        assert!(found.magnitude_db < 1e-8 && found.phase_deg < 1e-7, "{found:?}");
    }
    assert!((difference.static_gain_ratio - 1.0).abs() < 1e-9);
}

#[test]
fn fifth_order_model_errs_off_mid_stroke() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py
    for (position, magnitude, phase) in [(0.1, 0.70377, 2.32054), (0.0, 2.11579, 6.96108)] {
        let found = reduction(&matched(position), &grid()).unwrap();
        assert!((found.command.magnitude_db - magnitude).abs() < 1e-4, "{found:?}");
        assert!((found.command.phase_deg - phase).abs() < 1e-3, "{found:?}");
        assert!((found.load_motion.magnitude_db - magnitude).abs() < 1e-3);
    }
}

/// Properties of the reduction for any cylinder: the fast and the slow limits are right.
#[test]
fn reduction_of_an_asymmetric_actuator_keeps_both_ends() {
    let actuator = Actuator::new(rigs()[2]).unwrap();
    let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(2000.0))).unwrap();
    let parameters =
        two_pressure_linear_parameters(&model(&actuator, &point, 120.0), &point, SpoolDirection::Extending);
    let full = transfer_functions(&two_pressure_coefficients(&parameters)).unwrap();
    let reduced = linear_model(&reduce(&parameters)).unwrap();
    let difference = |frequencies: &[f64], load: bool| {
        let pick = |model: &phea_hydraulics::linear::LinearModel| match load {
            true => model.load_position.clone(),
            false => model.command.clone(),
        };
        let (full, reduced) = (pick(&full), pick(&reduced));
        response_difference(frequencies, |w| full.at_frequency(w), |w| reduced.at_frequency(w))
    };
    assert!(difference(&[1e5, 1e6], false).magnitude_db < 1e-3);
    assert!(difference(&[1e5, 1e6], true).magnitude_db < 1e-3);
    assert!(difference(&[1e-6, 1e-5], true).magnitude_db < 1e-3);
    let report = reduction(&parameters, &grid()).unwrap();
    assert!(report.command.magnitude_db > 0.1, "an asymmetric actuator is no (6.7): {report:?}");
    let statics = difference(&[1e-6], false).magnitude_db;
    assert!((20.0 * phea_dynamics::portable::log10(report.static_gain_ratio).abs() - statics).abs() < 1e-4);
}
