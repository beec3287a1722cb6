//! The four-edge valve: data sheet, coefficients at any operating point, and general properties.

use phea_dynamics::portable;
use phea_dynamics::scalar::{Dual, Parameters};
use phea_dynamics::simulation::DIRECTIONS;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::operating_point::{Condition, operating_point};
use phea_hydraulics::parameter::ParameterRequirement;
use phea_hydraulics::reference_rig::{USEFUL_AREA, components, hose_line, valve, valve_with_equal_edges};
use phea_hydraulics::servovalve::{
    ChamberFlows, Edges, LeakageModel, LeakageShape, Servovalve, SpoolDirection, Supply, blocked_ports,
    chamber_coefficients, chamber_flows, control_coefficients, control_flow, edge_conductances, edge_flows,
    flow_coefficient_from_rating, leakage_coefficient_from_rating, velocity_gain,
};
use phea_hydraulics::stiffness::StiffnessModel;

const SUPPLY: Supply = Supply { pressure: 70e5, tank_pressure: 0.0 };

fn check(what: &str, value: f64, printed: f64, last_digit: f64) {
    assert!((value - printed).abs() <= 0.5 * last_digit, "{what}: {value} is not {printed}");
}

fn rig() -> Components {
    components(hose_line(), StiffnessModel::Uniform)
}

#[test]
fn coefficients_from_a_data_sheet() {
    // ORIGIN: thesis Table 5.1, K_vp from 88 % of the rated flow of Table A.1
    check("K_vp", flow_coefficient_from_rating(0.88 * 6.31e-4, 70e5), 2.97e-7, 1e-9);
    // ORIGIN: analytic, the flow through two such edges in series at the rated drop is the rated
    // flow
    let coefficient: f64 = flow_coefficient_from_rating(6e-4, 70e5);
    let through = |middle: f64| coefficient * (70e5 - middle).sqrt() - coefficient * middle.sqrt();
    assert_eq!(through(35e5), 0.0);
    assert!((coefficient * 35e5_f64.sqrt() / 6e-4 - 1.0).abs() < 1e-15);
    // ORIGIN: analytic, two paths of two edges leak the rated leakage less the tare flow
    let leak: f64 = leakage_coefficient_from_rating(3.0e-5, 1.64e-5, 2.068e7, 2.068e7);
    assert!((2.0 * leak * (2.068e7_f64 / 2.0).sqrt() / (3.0e-5 - 1.64e-5) - 1.0).abs() < 1e-14);
    // ORIGIN: analytic, a tare flow stated at a quarter of the pressure is twice as large
    let quarter: f64 = leakage_coefficient_from_rating(3.0e-5, 0.82e-5, 2.068e7 / 4.0, 2.068e7);
    assert!((quarter / leak - 1.0).abs() < 1e-14);
}

/// ORIGIN: analytic, thesis (4.21) and (4.22) corrected, with plain square roots and the derivative
/// of the leakage.
#[test]
fn control_coefficients_are_the_closed_forms_for_equal_edges() {
    let valve = Servovalve { transition_pressure: 1e-3, ..valve_with_equal_edges() };
    let supply = Supply { pressure: 70e5, tank_pressure: 3e5 };
    let (flow, leak, nominal, shape) = (3.0e-7, 2.40e-9, 10.0, 100.0);
    for spool in [-7.0, -0.2, -0.01, 0.02, 0.3, 10.0_f64] {
        for load_pressure in [-40e5, 0.0, 25e5] {
            let s = spool.signum();
            let drop = supply.pressure - supply.tank_pressure;
            let (near, far) = (drop - s * load_pressure, drop + s * load_pressure);
            let y = shape * spool / nominal;
            let sech = 1.0 / portable::cosh(y);
            let slope = -shape / nominal * sech * portable::sinh(y) / portable::cosh(y);
            let gain = flow / nominal * (near / 2.0).sqrt()
                + s * leak * slope * ((near / 2.0).sqrt() - (far / 2.0).sqrt());
            let pressure = (flow * spool.abs() / nominal + leak * sech) / (8.0 * near).sqrt()
                + leak * sech / (8.0 * far).sqrt();
            let found = control_coefficients(&valve, &supply, spool, load_pressure, SpoolDirection::Mean);
            assert!((found.flow_gain / gain - 1.0).abs() < 1e-12);
            assert!((found.flow_pressure_coefficient / pressure - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn ranges_of_table_6_3() {
    let valve = Servovalve { leakage_shape: LeakageShape::Common(0.0), ..valve_with_equal_edges() };
    let at = |spool, load| control_coefficients(&valve, &SUPPLY, spool, load, SpoolDirection::Extending);
    // ORIGIN: thesis Table 6.3 (one unit of the last digit)
    check("K_qU, no load", at(0.0, 0.0).flow_gain, 5.61e-5, 2.0 * 1e-7);
    // the printed lower end is 5.61e-5/sqrt(3); K_vp = 3.0e-7 itself gives 3.240e-5
    let ratio = at(0.0, 2.0 * 70e5 / 3.0).flow_gain / at(0.0, 0.0).flow_gain;
    assert!((ratio * 3.0_f64.sqrt() - 1.0).abs() < 1e-6);
    check("K_qU, two thirds", 5.61e-5 * ratio, 3.23e-5, 2.0 * 1e-7);
    check("K_c, null", at(0.0, 0.0).flow_pressure_coefficient, 6.42e-13, 2.0 * 1e-15);
    check("K_c, full opening", at(10.0, 2.0 * 70e5 / 3.0).flow_pressure_coefficient, 7e-11, 2.0 * 1e-12);
}

#[test]
fn velocity_gain_carries_the_same_flow_through_both_edges() {
    let gain = |direction| velocity_gain(&valve(), &SUPPLY, [USEFUL_AREA; 2], 0.0, direction).unwrap();
    // ORIGIN: recomputed by comparisons/recompute_rig.py, the edges of Table 5.1 in series at 70
    // bar
    check("extending", USEFUL_AREA * gain(SpoolDirection::Extending), 6.51e-5, 1e-7);
    check("retracting", USEFUL_AREA * gain(SpoolDirection::Retracting), 4.13e-5, 1e-7);
    // ORIGIN: recomputed by comparisons/recompute_rig.py, mean of both chambers at half the supply
    // pressure
    let mean = |direction| control_coefficients(&valve(), &SUPPLY, 0.0, 0.0, direction).flow_gain;
    check("mean of chambers, extending", mean(SpoolDirection::Extending), 6.59467e-5, 1e-10);
    check("mean of chambers, retracting", mean(SpoolDirection::Retracting), 4.20936e-5, 1e-10);
    // ORIGIN: thesis Table 6.3, nominal K_qU 5.4e-5 (one unit of the last digit)
    check("mean of both directions", mean(SpoolDirection::Mean), 5.4e-5, 2.0 * 1e-6);
    assert_eq!(velocity_gain(&valve(), &SUPPLY, [1e-3, 1e-3], 1e5, SpoolDirection::Extending), None);
}

/// Contribution of the leakage to the flow gain, which thesis (4.21) omits.
#[test]
fn leakage_adds_to_the_flow_gain_under_load() {
    let largest = (1..200)
        .map(|step| {
            let spool = 0.005 * f64::from(step);
            let with =
                control_coefficients(&valve_with_equal_edges(), &SUPPLY, spool, 25e5, SpoolDirection::Mean);
            let constant =
                Servovalve { leakage_shape: LeakageShape::Common(0.0), ..valve_with_equal_edges() };
            let without = control_coefficients(&constant, &SUPPLY, spool, 25e5, SpoolDirection::Mean);
            with.flow_gain / without.flow_gain - 1.0
        })
        .fold(0.0, f64::max);
    // ORIGIN: recomputed below from max|sech'| = 1/2 at sinh y = 1
    let (near, far) = (45e5_f64.sqrt(), 95e5_f64.sqrt());
    let expected = 2.40e-9 * 100.0 * 0.5 * (far - near) / (3.0e-7 * near);
    assert!((largest - expected).abs() < 1e-3 * expected, "{largest} against {expected}");
}

/// The total leakage with a leakage curve on each edge is not greatest at null, as thesis (4.14)
/// requires.
#[test]
fn total_leakage_peaks_next_to_null() {
    // ORIGIN: recomputed by comparisons/recompute_rig.py (plain square roots, blocked ports)
    let cases = [
        (valve(), 1.0, 1.0816865, 2.9372e-3),
        (valve(), -1.0, 1.1295702, 3.9964e-3),
        (
            Servovalve {
                flow_coefficients: Edges::equal(2.97e-7),
                leakage_coefficients: Edges::equal(2.48e-9),
                ..valve()
            },
            1.0,
            1.0952882,
            3.3669e-3,
        ),
    ];
    for (valve, side, ratio, command) in cases {
        let actuator = Actuator::new(Components { valve, ..rig() }).unwrap();
        let total = |relative: f64| {
            let spool = 10.0 * side * relative;
            let point = operating_point(&actuator, 0.25, Condition::Command(spool)).unwrap();
            let conductances = edge_conductances(&valve, spool);
            let flows = edge_flows(&valve, &SUPPLY, &conductances, point.pressure_a, point.pressure_b);
            flows.supply_to_a + flows.supply_to_b
        };
        let null = total(0.0);
        check("leakage at its peak", total(command) / null, ratio, 2e-6);
        assert!(total(0.98 * command) < total(command) && total(1.02 * command) < total(command));
        assert!(total(0.05) < 0.1 * null);
    }
}

/// ORIGIN: analytic, thesis (4.14): at any spool position the whole leakage is one secant, and at
/// null that of the other model.
#[test]
fn one_curve_is_the_curve_of_the_whole_valve() {
    let each = Servovalve { transition_pressure: 1e-3, ..valve() };
    let one = Servovalve { leakage_model: LeakageModel::OneCurve, ..each };
    let series = |first: f64, second: f64| first * second / (first * first + second * second).sqrt();
    let null = (series(2.35e-9, 2.2e-9) + series(1.7e-9, 2.35e-9)) * 70e5_f64.sqrt();
    for spool in [-0.5, -0.1, -0.03, 0.0, 0.01, 0.04, 0.2, 0.4] {
        let leak = blocked_ports(&one, &SUPPLY, spool).supply_flow;
        let curve = null / portable::cosh(100.0 * spool / 10.0);
        assert!((leak / curve - 1.0).abs() < 1e-8, "{spool}: {leak} is not {curve}");
    }
    let [of_each, of_one] = [each, one].map(|valve| edge_conductances(&valve, 0.0).to_array());
    for (each, one) in of_each.into_iter().zip(of_one) {
        assert!((each / one - 1.0).abs() < 1e-15);
    }
}

/// ORIGIN: analytic, equal edges: one edge opens as much as the other closes, so that null passes
/// twice the flow gain of one edge.
#[test]
fn one_curve_doubles_the_flow_gain_at_null() {
    let one = Servovalve { leakage_model: LeakageModel::OneCurve, ..valve_with_equal_edges() };
    let gain =
        |valve, spool| control_coefficients(&valve, &SUPPLY, spool, 0.0, SpoolDirection::Extending).flow_gain;
    assert!((gain(one, 0.0) / gain(valve_with_equal_edges(), 0.0) - 2.0).abs() < 1e-12);
    assert!((gain(one, 1.0) / gain(valve_with_equal_edges(), 1.0) - 1.0).abs() < 1e-3);
}

/// Analytic derivatives of both chambers' flows compared with dual numbers, everywhere, including
/// the laminar zone and reversed drops.
#[test]
fn chamber_coefficients_are_the_derivatives_of_the_flows() {
    let one_curve = Servovalve { leakage_model: LeakageModel::OneCurve, ..valve() };
    for valve in [valve(), valve_with_equal_edges(), one_curve] {
        for spool in [-9.0, -0.3, -0.04, -1e-9, 1e-9, 0.02, 0.5, 10.0] {
            for (pressure_a, pressure_b) in [(35e5, 35e5), (69.9995e5, 300.0), (12e5, 71e5), (-0.5e5, 60e5)] {
                let found = chamber_coefficients(
                    &valve,
                    &SUPPLY,
                    spool,
                    pressure_a,
                    pressure_b,
                    SpoolDirection::Mean,
                );
                let [u, a, b] = [(spool, 0), (pressure_a, 1), (pressure_b, 2)]
                    .map(|(value, index)| Dual::<DIRECTIONS>::variable(value, index));
                let flows =
                    chamber_flows(&valve.convert(&mut Into::into), &SUPPLY.convert(&mut Into::into), u, a, b);
                let expected = [
                    (found.flow_gain_a, flows.into_a.gradient()[0]),
                    (found.flow_pressure_a, -flows.into_a.gradient()[1]),
                    (found.flow_gain_b, -flows.into_b.gradient()[0]),
                    (found.flow_pressure_b, -flows.into_b.gradient()[2]),
                ];
                for (analytic, dual) in expected {
                    assert!((analytic - dual).abs() <= 1e-12 * dual.abs(), "{analytic} against {dual}");
                }
                assert_eq!((flows.into_a.gradient()[2], flows.into_b.gradient()[1]), (0.0, 0.0));
            }
        }
    }
}

#[test]
fn direction_decides_at_null_and_the_mean_is_between() {
    for leakage_model in [LeakageModel::EachEdge, LeakageModel::OneCurve] {
        direction_decides(&Servovalve { leakage_model, ..valve() });
    }
}

fn direction_decides(valve: &Servovalve) {
    let at = |direction| chamber_coefficients(valve, &SUPPLY, 0.0, 37e5, 24e5, direction);
    let next_to_null = |spool| chamber_coefficients(valve, &SUPPLY, spool, 37e5, 24e5, SpoolDirection::Mean);
    let (extending, retracting, mean) =
        (at(SpoolDirection::Extending), at(SpoolDirection::Retracting), at(SpoolDirection::Mean));
    for (one_sided, limit) in [(extending, next_to_null(1e-12)), (retracting, next_to_null(-1e-12))] {
        assert!((one_sided.flow_gain_a / limit.flow_gain_a - 1.0).abs() < 1e-9);
        assert!((one_sided.flow_gain_b / limit.flow_gain_b - 1.0).abs() < 1e-9);
    }
    assert!((2.0 * mean.flow_gain_a / (extending.flow_gain_a + retracting.flow_gain_a) - 1.0).abs() < 1e-15);
    let dual = chamber_flows(
        &valve.convert(&mut Into::into),
        &SUPPLY.convert(&mut Into::into),
        Dual::<DIRECTIONS>::variable(0.0, 0),
        Dual::constant(37e5),
        Dual::constant(24e5),
    );
    assert!((dual.into_a.gradient()[0] / mean.flow_gain_a - 1.0).abs() < 1e-15);
}

/// Slopes between both sides are those of chords across null.
#[test]
fn chords_across_null_have_the_slopes_between() {
    let width = 1e-7;
    for leakage_model in [LeakageModel::EachEdge, LeakageModel::OneCurve] {
        let valve = Servovalve { leakage_model, ..valve() };
        for side in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            let flows = |spool| chamber_flows(&valve, &SUPPLY, spool, 37e5, 24e5);
            let (above, below) = (flows(0.5 * width * (1.0 + side)), flows(-0.5 * width * (1.0 - side)));
            let found = chamber_coefficients(&valve, &SUPPLY, 0.0, 37e5, 24e5, SpoolDirection::Between(side));
            let chords = [(above.into_a - below.into_a) / width, -(above.into_b - below.into_b) / width];
            for (chord, slope) in chords.into_iter().zip([found.flow_gain_a, found.flow_gain_b]) {
                assert!((chord / slope - 1.0).abs() < 1e-5, "{side}: {chord} {slope}");
            }
        }
    }
}

/// Exchanging A and B and reversing the command gives the mirrored valve.
#[test]
fn mirrored_valve() {
    let edges = |e: Edges| Edges::from_array([e.supply_to_b, e.b_to_tank, e.supply_to_a, e.a_to_tank]);
    let mirrored = Servovalve {
        flow_coefficients: edges(valve().flow_coefficients),
        leakage_coefficients: edges(valve().leakage_coefficients),
        ..valve()
    };
    for spool in [-3.0, -0.05, 0.0, 0.7] {
        let ChamberFlows { into_a, into_b } = chamber_flows(&valve(), &SUPPLY, spool, 20e5, 55e5);
        let seen = chamber_flows(&mirrored, &SUPPLY, -spool, 55e5, 20e5);
        assert_eq!((into_a, into_b), (seen.into_b, seen.into_a));
    }
}

/// Thesis (4.18) in its printed form for equal edges, and no flow at null without load.
#[test]
fn control_flow_of_equal_edges() {
    let valve = Servovalve { transition_pressure: 1e-3, ..valve_with_equal_edges() };
    assert_eq!(control_flow(&valve, &SUPPLY, 0.0, 0.0), 0.0);
    for (spool, load) in [(2.0, 10e5), (-2.0, 10e5), (0.05, -30e5)] {
        let s: f64 = f64::signum(spool);
        let leak = 2.40e-9 / portable::cosh(100.0 * spool / 10.0);
        let (near, far) = (((70e5 - s * load) / 2.0).sqrt(), ((70e5 + s * load) / 2.0).sqrt());
        let printed = s * (3.0e-7 * spool.abs() / 10.0 + leak) * near - s * leak * far;
        assert!((control_flow(&valve, &SUPPLY, spool, load) / printed - 1.0).abs() < 1e-12);
    }
}

#[test]
fn impossible_valves_are_refused_by_name() {
    let broken = Servovalve { damping_ratio: 0.0, leakage_shape: LeakageShape::Common(f64::NAN), ..valve() };
    let names: Vec<String> = broken.problems().into_iter().map(|problem| problem.quantity).collect();
    assert_eq!(names, ["leakage_shape", "damping_ratio"]);
    let inverted = Supply { pressure: 1e5, tank_pressure: 2e5 };
    assert_eq!(inverted.problems()[0].requirement, ParameterRequirement::AboveTankPressure);
}
