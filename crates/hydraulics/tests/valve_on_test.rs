//! A valve on a test bench: balance of flows, limits, and a slow spool compared with the equations
//! of a fast one.

use phea_hydraulics::reference_rig::valve;
use phea_hydraulics::servovalve::{
    Edges, LeakageModel, LeakageShape, OpeningShape, PortCircuit, STATIC_COEFFICIENTS, Servovalve, SlowSpool,
    SpoolImperfection, SpoolState, StaticCoefficients, Supply, TestInput, TestedValve, ValveTerms,
    blocked_ports, connected_ports, edge_conductances, edge_flows,
};

const SUPPLY: Supply = Supply { pressure: 70e5, tank_pressure: 2e5 };

/// Openings from far below null to far above, with fine steps over the leakage.
fn openings() -> Vec<f64> {
    let fine = (-100..=100).map(|step| f64::from(step) * 5e-3);
    fine.chain((-20..=20).map(|step| f64::from(step) * 0.5)).collect()
}

const MODELS: [LeakageModel; 2] = [LeakageModel::EachEdge, LeakageModel::OneCurve];

#[test]
fn blocked_ports_pass_on_what_they_take() {
    for (shape, leakage_model) in
        MODELS.into_iter().flat_map(|model| [0.0, 100.0, 4000.0].map(|shape| (shape, model)))
    {
        let valve = Servovalve { leakage_shape: LeakageShape::Common(shape), leakage_model, ..valve() };
        for opening in openings() {
            let found = blocked_ports(&valve, &SUPPLY, opening);
            let conductances = edge_conductances(&valve, opening);
            let edges = edge_flows(&valve, &SUPPLY, &conductances, found.pressure_a, found.pressure_b);
            // for a wide-open edge the drop is below one rounding error of the supply pressure
            let rounding = 1e-9 * 2.0 * 3.85e-7 * opening.abs() / 10.0 / 1e3_f64.sqrt() + 1e-20;
            assert!((edges.supply_to_a - edges.a_to_tank).abs() < rounding, "{opening} {edges:?}");
            assert!((edges.supply_to_b - edges.b_to_tank).abs() < rounding, "{opening} {edges:?}");
            for pressure in [found.pressure_a, found.pressure_b] {
                assert!((SUPPLY.tank_pressure..=SUPPLY.pressure).contains(&pressure));
            }
        }
    }
}

#[test]
fn connected_ports_give_to_each_other() {
    for opening in openings() {
        for (load, leakage_model) in MODELS.into_iter().flat_map(|model| [0.0, 0.9].map(|load| (load, model)))
        {
            let valve = Servovalve { leakage_model, ..valve() };
            let load_pressure = opening.signum() * load * (SUPPLY.pressure - SUPPLY.tank_pressure);
            let found = connected_ports(&valve, &SUPPLY, opening, load_pressure);
            let conductances = edge_conductances(&valve, opening);
            let edges = edge_flows(&valve, &SUPPLY, &conductances, found.pressure_a, found.pressure_b);
            let into_b = edges.supply_to_b - edges.b_to_tank;
            let scale = edges.supply_to_a.abs() + edges.supply_to_b.abs();
            assert!((found.port_flow + into_b).abs() < 1e-9 * scale, "{opening} {load}");
            assert!((found.pressure_a - found.pressure_b - load_pressure).abs() < 1e-6);
            assert!(load > 0.0 || found.port_flow * opening >= 0.0 || opening.abs() < 0.1);
        }
    }
}

/// ORIGIN: analytic, two different edges in series: K_3 K_6/sqrt(K_3^2 + K_6^2)
#[test]
fn the_metered_flow_is_that_of_two_edges_in_series() {
    let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
    let valve =
        Servovalve { transition_pressure: 1e-2, leakage_shape: LeakageShape::Common(1000.0), ..valve() };
    let of = |first: f64, second: f64| first * second / (first * first + second * second).sqrt();
    let flow = &valve.flow_coefficients;
    for opening in [1.0, 5.0] {
        let extending = of(flow.supply_to_a, flow.b_to_tank) * opening / 10.0 * 70e5_f64.sqrt();
        let found: f64 = connected_ports(&valve, &supply, opening, 0.0).port_flow;
        assert!((found / extending - 1.0).abs() < 1e-9);
        let retracting = of(flow.supply_to_b, flow.a_to_tank) * opening / 10.0 * 70e5_f64.sqrt();
        let found: f64 = connected_ports(&valve, &supply, -opening, 0.0).port_flow;
        assert!((found / retracting + 1.0).abs() < 1e-9);
    }
}

/// Memories driven slowly by small steps of the equations of a fast spool, and exactly.
#[test]
fn a_slow_spool_is_the_fast_one_at_rest() {
    let imperfection = SpoolImperfection {
        null_bias: 0.014,
        hysteresis_width: Some(0.128),
        threshold: Some(0.04),
        rate_limit: None,
    };
    let valve = valve();
    let mut memory = SlowSpool::at(0.0);
    let mut state = SpoolState { spool: 0.0, spool_rate: 0.0, spool_friction: 0.0, magnetic_lag: 0.0 };
    let mut command = 0.0;
    for target in [1.0, -0.5, 0.3, 0.31, 0.2] {
        // 0.05 V/s: the spool's own lag is a hundred times less than the tolerance
        let (rate, step) = (0.05_f64.copysign(target - command), 2e-4);
        while (target - command) * rate > 0.0 {
            command += rate * step;
            let rates = imperfection.rates(&valve, &state, command);
            state.spool_rate += step * rates.spool_rate;
            let rates = imperfection.rates(&valve, &state, command);
            state.spool += step * rates.spool;
            state.spool_friction += step * rates.spool_friction;
            state.magnetic_lag += step * rates.magnetic_lag;
        }
        let slow = imperfection.slow_opening(&mut memory, command);
        let fast = imperfection.opening(&state);
        assert!((slow - fast).abs() < 2e-4, "at {command}: {slow} is not {fast}");
    }
}

/// Derivatives compared with differences, for every coefficient and both circuits.
#[test]
fn sensitivities_are_derivatives() {
    for leakage_model in MODELS {
        check_sensitivities(&TestedValve { leakage_model, ..TESTED });
    }
    let terms = ValveTerms { lap: true, saturation: true, leakage_by_edge: true };
    check_sensitivities(&TestedValve { terms, ..TESTED });
}

const TESTED: TestedValve = TestedValve {
    nominal_voltage: 10.0,
    transition_pressure: 1e3,
    tare_reference_drop: 60e5,
    leakage_model: LeakageModel::EachEdge,
    terms: ValveTerms { lap: false, saturation: false, leakage_by_edge: false },
};

fn check_sensitivities(tested: &TestedValve) {
    let coefficients = StaticCoefficients {
        flow_coefficients: valve().flow_coefficients,
        leakage_coefficients: valve().leakage_coefficients,
        leakage_shapes: Edges::from_array([90.0, 70.0, 110.0, 95.0]),
        tare_flow: 7.55e-6,
        null_bias: 0.02,
        hysteresis_width: 0.11,
        opening: OpeningShape { lap_positive: 0.004, lap_negative: -0.003, saturation: 0.3 },
    };
    let commands = [-3.0, -0.2, -0.02, 0.04, 0.1, 2.0, 0.3, 0.05, -0.03, -1.0];
    for circuit in [PortCircuit::Blocked, PortCircuit::Connected] {
        let load = |command: f64| if circuit == PortCircuit::Connected { 1e5 * command } else { 0.0 };
        let inputs = commands.map(|command| TestInput::new(command, SUPPLY, load(command)));
        let found = tested.sensitive_outputs(&coefficients, circuit, &inputs);
        for index in 0..STATIC_COEFFICIENTS {
            let at = |change: f64| {
                let mut numbers = coefficients.to_array();
                numbers[index] *= 1.0 + change;
                tested.outputs(&StaticCoefficients::from_array(numbers), circuit, &inputs)
            };
            let (less, more) = (at(-1e-5), at(1e-5));
            let step = 2e-5 * coefficients.to_array()[index];
            for ((less, more), found) in less.iter().zip(&more).zip(&found) {
                let pairs = [
                    (less.pressure_a, more.pressure_a, found.pressure_a, 70e5),
                    (less.pressure_b, more.pressure_b, found.pressure_b, 70e5),
                    (less.leak_flow, more.leak_flow, found.leak_flow, 1e-5),
                    (less.port_flow, more.port_flow, found.port_flow, 1e-5),
                ];
                for (less, more, found, scale) in pairs {
                    let (difference, derivative) = (more - less, found.gradient()[index] * step);
                    assert!((difference - derivative).abs() < 1e-6 * difference.abs() + 1e-10 * scale);
                }
            }
        }
    }
}

/// Derivatives exist even if an edge is permanently shut.
#[test]
fn a_shut_edge_has_finite_derivatives() {
    let coefficients = StaticCoefficients {
        flow_coefficients: Edges::equal(3e-7),
        leakage_coefficients: Edges::equal(2e-9),
        leakage_shapes: Edges::equal(5000.0),
        tare_flow: 0.0,
        null_bias: 0.0,
        hysteresis_width: 1e-6,
        opening: OpeningShape::default(),
    };
    let inputs = [TestInput::new(10.0, SUPPLY, 0.0)];
    let circuits = [PortCircuit::Blocked, PortCircuit::Connected];
    for (circuit, leakage_model) in
        circuits.into_iter().flat_map(|circuit| MODELS.map(|model| (circuit, model)))
    {
        let tested = TestedValve { leakage_model, ..TESTED };
        for output in tested.sensitive_outputs(&coefficients, circuit, &inputs) {
            for number in [output.pressure_a, output.pressure_b, output.leak_flow, output.port_flow] {
                assert!(number.gradient().iter().all(|slope| slope.is_finite()));
            }
        }
    }
}
