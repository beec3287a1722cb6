//! Valves with lap, saturation, and a separate leakage shape for each edge: flows in closed form,
//! slopes, operating points and test benches.

use phea_dynamics::portable;
use phea_dynamics::scalar::{Dual, Parameters};
use phea_hydraulics::actuator::Actuator;
use phea_hydraulics::operating_point::{Balance, Condition, Steady, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{USEFUL_AREA, components, hose_line, valve};
use phea_hydraulics::servovalve::{
    Edges, LeakageModel, LeakageShape, OpeningLaw, OpeningShape, Openings, Servovalve, SpoolDirection,
    Supply, blocked_ports, chamber_coefficients, chamber_flows, connected_ports, edge_conductances,
};
use phea_hydraulics::stiffness::StiffnessModel;

const SUPPLY: Supply = Supply { pressure: 70e5, tank_pressure: 2e5 };

const SHAPES: [OpeningShape; 6] = [
    OpeningShape { lap_positive: 0.003, lap_negative: 0.002, saturation: 0.0 },
    OpeningShape { lap_positive: -0.005, lap_negative: -0.004, saturation: 0.0 },
    OpeningShape { lap_positive: 0.0, lap_negative: 0.0, saturation: 0.7 },
    OpeningShape { lap_positive: 0.01, lap_negative: -0.002, saturation: 0.4 },
    OpeningShape { lap_positive: 0.0, lap_negative: 0.003, saturation: 0.0 },
    OpeningShape { lap_positive: 0.0, lap_negative: 0.0, saturation: 0.0 },
];

fn shaped(opening: OpeningShape, leakage_model: LeakageModel) -> Servovalve {
    Servovalve { opening: OpeningLaw::Shaped(opening), leakage_model, ..valve() }
}

fn unlike() -> Servovalve {
    let shapes = Edges::from_array([100.0, 70.0, 140.0, 90.0]);
    Servovalve { leakage_shape: LeakageShape::ByEdge(shapes), ..valve() }
}

/// ORIGIN: analytic. Far from its end an edge has the area a of a sharp one, and passes a over one
/// plus the saturation times a; the error is never more than a thousandth of the lap.
#[test]
fn openings_are_those_of_a_sharp_edge() {
    for shape in SHAPES {
        let valve = shaped(shape, LeakageModel::EachEdge);
        for spool in [-10.0, -3.0, -0.1, -0.02, 0.0, 0.015, 0.05, 0.4, 7.0, 10.0] {
            let sharp = |travel: f64, lap: f64| (travel - lap).max(0.0);
            let passed = |area: f64| area / (1.0 + shape.saturation * area);
            let found = Openings::at(&valve, spool);
            for (found, travel, lap) in [
                (found.forward, spool / 10.0, shape.lap_positive),
                (found.backward, -spool / 10.0, shape.lap_negative),
            ] {
                let wanted = passed(sharp(travel, lap));
                assert!((found - wanted).abs() <= lap.abs() / 1000.0 + 1e-16, "{shape:?} {spool}");
                let beyond = (travel - lap).abs();
                // the rounding of an edge decreases with the distance from its end
                let rounded = (0.002 * lap) * (0.002 * lap) / (4.0 * beyond.max(1e-9));
                assert!((found - wanted).abs() <= 1.01 * rounded + 1e-15, "{shape:?} {spool}");
            }
        }
    }
}

/// Law without lap and saturation is that of edges that open in proportion.
#[test]
fn a_shape_of_zeros_is_the_law_in_proportion() {
    for leakage_model in [LeakageModel::EachEdge, LeakageModel::OneCurve] {
        let zeros = shaped(OpeningShape::default(), leakage_model);
        let proportional = Servovalve { leakage_model, ..valve() };
        for spool in [-10.0, -0.3, -1e-5, 0.0, 1e-12, 0.02, 4.0] {
            assert_eq!(edge_conductances(&zeros, spool), edge_conductances(&proportional, spool));
            for direction in [SpoolDirection::Extending, SpoolDirection::Mean, SpoolDirection::Between(0.3)] {
                let of = |valve| chamber_coefficients(valve, &SUPPLY, spool, 30e5, 25e5, direction);
                let (found, wanted) = (of(&zeros), of(&proportional));
                assert!((found.flow_gain_a - wanted.flow_gain_a).abs() <= 1e-14 * wanted.flow_gain_a.abs());
                assert!((found.flow_gain_b - wanted.flow_gain_b).abs() <= 1e-14 * wanted.flow_gain_b.abs());
            }
        }
    }
    let shapes = LeakageShape::ByEdge(Edges::equal(100.0));
    let by_edge = Servovalve { leakage_shape: shapes, ..valve() };
    assert_eq!(edge_conductances(&by_edge, 0.07), edge_conductances(&valve(), 0.07));
}

/// The coefficients are the derivatives of the flows, found by numbers with derivatives.
#[test]
fn coefficients_are_the_derivatives_of_the_flows() {
    let both = [LeakageModel::EachEdge, LeakageModel::OneCurve];
    let valves = SHAPES.into_iter().flat_map(|shape| both.map(|model| shaped(shape, model)));
    for valve in valves.chain([unlike()]) {
        for spool in [-8.0, -0.2, -0.03, -0.011, 0.004, 0.03, 0.1, 0.7, 9.0] {
            let [pressure_a, pressure_b] = [41e5, 18e5];
            let open = valve.convert(&mut Dual::<3>::from);
            let supply = SUPPLY.convert(&mut Dual::<3>::from);
            let flows = chamber_flows(
                &open,
                &supply,
                Dual::variable(spool, 0),
                Dual::variable(pressure_a, 1),
                Dual::variable(pressure_b, 2),
            );
            let found =
                chamber_coefficients(&valve, &SUPPLY, spool, pressure_a, pressure_b, SpoolDirection::Mean);
            let pairs = [
                (found.flow_gain_a, flows.into_a.gradient()[0]),
                (found.flow_pressure_a, -flows.into_a.gradient()[1]),
                (found.flow_gain_b, -flows.into_b.gradient()[0]),
                (found.flow_pressure_b, -flows.into_b.gradient()[2]),
            ];
            for (closed, derivative) in pairs {
                assert!((closed - derivative).abs() <= 1e-11 * derivative.abs() + 1e-22, "{valve:?} {spool}");
            }
        }
    }
}

/// ORIGIN: analytic. Beyond an overlap two edges in series pass the flow of the remaining travel;
/// within it only the leakage.
#[test]
fn an_overlap_is_a_dead_band_of_the_metered_flow() {
    let shape = OpeningShape { lap_positive: 0.003, lap_negative: 0.003, saturation: 0.0 };
    let lapped = Servovalve { transition_pressure: 1e-3, ..shaped(shape, LeakageModel::EachEdge) };
    let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
    let flow = |spool: f64| connected_ports(&lapped, &supply, spool, 0.0).port_flow;
    let edges = valve().flow_coefficients;
    let series = 1.0 / portable::hypot(1.0 / edges.supply_to_a, 1.0 / edges.b_to_tank);
    for spool in [0.5, 3.0, 9.0] {
        let wanted = series * (spool / 10.0 - 0.003) * 70e5_f64.sqrt();
        assert!((flow(spool) / wanted - 1.0).abs() < 1e-3, "{spool}");
    }
    // the flow within the lap changes by less than a fiftieth of the change without lap
    let without = Servovalve { opening: OpeningLaw::Proportional, ..lapped };
    let open = connected_ports(&without, &supply, 0.02, 0.0).port_flow
        - connected_ports(&without, &supply, 0.0, 0.0).port_flow;
    assert!((flow(0.02) - flow(0.0)).abs() < 0.02 * open);
}

/// An underlap of both pairs doubles the flow gain about null, an overlap nearly removes it.
#[test]
fn lap_changes_the_gain_about_null_by_its_closed_form() {
    let gain = |lap: f64| {
        let shape = OpeningShape { lap_positive: lap, lap_negative: lap, saturation: 0.0 };
        let valve =
            Servovalve { leakage_shape: LeakageShape::Common(0.0), ..shaped(shape, LeakageModel::EachEdge) };
        let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
        let found = chamber_coefficients(&valve, &supply, 0.0, 35e5, 35e5, SpoolDirection::Mean);
        found.flow_gain_a + found.flow_gain_b
    };
    // ORIGIN: analytic, with an underlap all four edges act at null, without lap each on one side
    assert!((gain(-0.005) / gain(0.0) - 2.0).abs() < 2e-3);
    assert!(gain(0.005) > 0.0 && gain(0.005) < 1e-4 * gain(0.0));
}

/// Operating points of lapped and saturating valves balance, at rest and in motion, and are also
/// found from a nearby start.
#[test]
fn operating_points_balance() {
    for shape in SHAPES {
        let balance = Balance {
            valve: shaped(shape, LeakageModel::EachEdge),
            supply: SUPPLY,
            areas: [USEFUL_AREA, 0.7 * USEFUL_AREA],
            across: None,
            outward: None,
        };
        for velocity in [-0.1, -1e-4, 0.0, 2e-3, 0.2] {
            for force in [-2e3, 0.0, 1500.0] {
                let steady = Steady::Moving { velocity, load: SteadyLoad::Force(force) };
                let settled = balance.settle(steady);
                let error = balance.error(steady, &settled);
                assert!(error < 1e-9, "{shape:?} {velocity} {force}: {error} {settled:?}");
            }
        }
    }
}

/// The command that moves a piston is greater by the lap than without it, up to the effect of
/// rounding.
#[test]
fn a_motion_takes_the_lap_more_of_command() {
    let with = |opening| {
        let mut components = components(hose_line(), StiffnessModel::Uniform);
        components.valve.opening = opening;
        let actuator = Actuator::new(components).unwrap();
        let load = SteadyLoad::Force(500.0);
        operating_point(&actuator, 0.25, Condition::Moving(0.05, load)).unwrap().command
    };
    let shape = OpeningShape { lap_positive: 0.004, lap_negative: 0.001, saturation: 0.0 };
    let more = with(OpeningLaw::Shaped(shape)) - with(OpeningLaw::Proportional);
    assert!((more - 0.04).abs() < 1e-4, "{more}");
}

/// ORIGIN: analytic. With shut ports the pressure divides as the squares of the leakage of both
/// edges, each with its own secant.
#[test]
fn leakage_by_edge_divides_the_supply() {
    let valve = Servovalve { transition_pressure: 1e-3, ..unlike() };
    let supply = Supply { pressure: 70e5, tank_pressure: 0.0 };
    let leak = valve.leakage_coefficients;
    for spool in [-0.1, -0.03] {
        let secant = |shape: f64| 1.0 / portable::cosh(shape * spool / 10.0);
        let from_supply = leak.supply_to_a * secant(100.0);
        let to_tank = leak.a_to_tank * secant(70.0) - valve.flow_coefficients.a_to_tank * spool / 10.0;
        let wanted = 70e5 * from_supply * from_supply / (from_supply * from_supply + to_tank * to_tank);
        assert!((blocked_ports(&valve, &supply, spool).pressure_a / wanted - 1.0).abs() < 1e-6);
    }
}

#[test]
fn impossible_shapes_are_reported() {
    let shape = OpeningShape { lap_positive: 1.0, lap_negative: f64::NAN, saturation: -0.1 };
    let valve = shaped(shape, LeakageModel::EachEdge);
    let named: Vec<String> = valve.problems().into_iter().map(|problem| problem.to_string()).collect();
    let all = named.join("\n");
    for name in ["lap.positive", "lap.negative", "saturation"] {
        assert!(all.contains(name), "{all}");
    }
}
