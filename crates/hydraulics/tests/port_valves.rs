//! Relief and check valves between the chambers and the tank: closed forms, the equilibrium, the
//! family's balance, and chambers that a load drives.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::expression::Expression;
use phea_dynamics::portable::pow;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::scalar::{Dual, Interval, Parameters};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::machine::{INDICATORS, Machine, MachineOptions, StartValues};
use phea_hydraulics::operating_point::{
    Balance, Condition, OperatingPoint, Steady, SteadyLoad, operating_point,
};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::port_valves::{PortValves, TankValve, ValveOpening, opened, opened_slope};
use phea_hydraulics::reference_rig::{components, hose_line, leaking, pipe_line};
use phea_hydraulics::servovalve::Supply;
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::step;

/// Relief valve at 50 bar and check valve at 0.5 bar, both of 20 L/min at 5 bar.
fn valves() -> PortValves {
    let of = |cracking_pressure| TankValve { cracking_pressure, conductance: 20.0 / 6e4 / 5e5 };
    PortValves { relief: Some(of(50e5)), check: Some(of(0.5e5)), transition_pressure: 1e4 }
}

fn rig(port_valves: [Option<PortValves>; 2]) -> Components {
    let rig = components(hose_line(), StiffnessModel::ByVolume);
    let outward = OutwardFlow { port_valves, ..OutwardFlow::default() };
    let supply = Supply { tank_pressure: 2e5, ..rig.supply };
    Components { outward, supply, line_b: pipe_line(), ..rig }
}

fn machine_of(rig: Components) -> Machine {
    Machine::new(&Actuator::new(rig).unwrap(), &MachineOptions::default()).unwrap()
}

/// The law: zero, a parabola, a line; its slope is the derivative; convex; and the enclosure of a
/// range of pressures contains that of its ends.
#[test]
fn the_law_is_convex_and_smooth() {
    let width = 0.7;
    for step in -400..400 {
        let excess = 0.01 * f64::from(step) + 0.003;
        let expected = match excess {
            shut if shut <= -width => 0.0,
            open if open >= width => open,
            within => (within + width) * (within + width) / (4.0 * width),
        };
        assert!((opened(excess, width) - expected).abs() < 1e-15, "{excess}");
        let dual = opened(Dual::<1>::variable(excess, 0), Dual::constant(width));
        assert!((dual.gradient()[0] - opened_slope(excess, width)).abs() < 1e-14, "{excess}");
        assert!(opened_slope(excess, width) <= opened_slope(excess + 0.01, width));
        let range = Interval::new(excess - 0.4, excess + 0.9);
        let enclosed = opened(range, Interval::from(width));
        let [low, high] = [opened(excess - 0.4, width), opened(excess + 0.9, width)];
        assert!(enclosed.low() <= low && high <= enclosed.high(), "{excess} {enclosed:?}");
    }
}

/// Each rate of a chamber's pressure is less by the flow through its valves over its compliance,
/// and nothing else changes.
#[test]
fn a_chamber_loses_the_flow_of_its_valves() {
    let with = [Some(valves()), Some(PortValves { relief: None, ..valves() })];
    let (relieved, bare) = (machine_of(rig(with)), machine_of(rig([None; 2])));
    let rates = |machine: &Machine, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        machine.rates(state, 0.3, &[0.2, 0.05], &mut rates);
        rates
    };
    for (pressure_a, pressure_b) in [(70e5, 0.5e5), (30e5, 30e5), (52e5, 1.45e5), (1e5, 65e5)] {
        let state = [0.1, 0.0, pressure_a, pressure_b, 1e-4, 0.02];
        let (one, other) = (rates(&relieved, &state), rates(&bare, &state));
        let position = 0.2 + 1e-4;
        let actuator = Actuator::new(rig(with)).unwrap();
        let compliance = actuator.chamber_compliance([pressure_a, pressure_b], StiffeningMember::Nominal);
        let compliance = phea_hydraulics::stiffness::compliance_at(&compliance, position);
        for (side, pressure) in [pressure_a, pressure_b].into_iter().enumerate() {
            let flow = with[side].unwrap().flow(pressure - 2e5);
            let lost = (other[2 + side] - one[2 + side]) * compliance[side];
            assert!((lost - flow).abs() <= 1e-9 * (flow.abs() + 1e-5), "{side} {pressure} {lost} {flow}");
        }
        for index in [0, 1, 4, 5] {
            assert!(one[index].total_cmp(&other[index]).is_eq(), "{index}");
        }
    }
}

/// A rig whose valves are open, within their transition or shut at rest.
fn drawn(number: u64) -> (Components, f64) {
    let mut state = stream(141, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let mut valve = |number: u64| {
        let relief = TankValve { cracking_pressure: spread(3e5, 90e5), conductance: spread(1e-13, 3e-9) };
        let check = TankValve { cracking_pressure: spread(1e3, 1e5), conductance: spread(1e-13, 3e-9) };
        let transition_pressure = spread(1e3, relief.cracking_pressure);
        let (relief, check) =
            ((!number.is_multiple_of(4)).then_some(relief), (number % 4 != 1).then_some(check));
        PortValves { relief, check, transition_pressure }
    };
    let port_valves = [valve(number), valve(number / 4)].map(Some);
    let rig = rig(port_valves);
    let rig = if number.is_multiple_of(3) { leaking(rig, 1e-12) } else { rig };
    (rig, spread(1e-3, 2.0))
}

/// The pressures of the operating point balance all flows, in motion too, those of the family's
/// balance are equal, and the machine rests there.
#[test]
fn operating_points_balance_with_valves_open_and_shut() {
    let mut openings = [0; 3];
    for number in 0..200 {
        let (rig, command) = drawn(number);
        let actuator = Actuator::new(rig).unwrap();
        let side = if number.is_multiple_of(2) { command } else { -command };
        let point = operating_point(&actuator, 0.2, Condition::Command(side)).unwrap();
        let moved = Condition::Moving(0.02, SteadyLoad::Force(point.hydraulic_force));
        let moved = operating_point(&actuator, 0.2, moved).ok();
        let steady = Steady::Moving { velocity: 0.02, load: SteadyLoad::Force(point.hydraulic_force) };
        let points = [Some((point, Steady::Command(side))), moved.map(|moved| (moved, steady))];
        for (point, steady) in points.into_iter().flatten() {
            let OperatingPoint { pressure_a, pressure_b, net_flow_a, net_flow_b, .. } = point;
            assert!(net_flow_a.abs() + net_flow_b.abs() < 2e-12, "{number} {steady:?} {point:?}");
            let balance = Balance::at(actuator.components(), 0.2);
            let settled = balance.settle(steady);
            let [settled_a, settled_b] = settled.pressures;
            let apart = (settled_a - pressure_a).abs() + (settled_b - pressure_b).abs();
            assert!(apart < 1.0, "{number} {steady:?}: {settled:?} {point:?}");
            assert!(balance.error(steady, &settled) < 1e-9, "{number} {steady:?}");
            for (side, pressure) in [pressure_a, pressure_b].into_iter().enumerate() {
                for valve in rig.outward.port_valves[side].unwrap().at_point(pressure, 2e5) {
                    openings[match valve.opening {
                        ValveOpening::Shut => 0,
                        ValveOpening::InTransition => 1,
                        ValveOpening::Open => 2,
                    }] += 1;
                }
            }
        }
        let machine = machine_of(rig);
        let rest = machine.rest(&point).unwrap();
        assert!((rest.state[2] - point.pressure_a).abs() < 1.0, "{number}");
        assert!((rest.state[3] - point.pressure_b).abs() < 1.0, "{number}");
    }
    assert!(openings.iter().all(|count| *count > 40), "{openings:?}");
}

/// Recorded pressures enclose those of every cracking pressure of a range, and equal them at each.
#[test]
fn recorded_pressures_follow_a_cracking_pressure() {
    let found = |cracking_pressure: f64| {
        let relief = Some(TankValve { cracking_pressure, ..valves().relief.unwrap() });
        let valves = PortValves { relief, transition_pressure: 1e5, ..valves() };
        let actuator = Actuator::new(rig([Some(valves); 2])).unwrap();
        operating_point(&actuator, 0.2, Condition::Command(0.5)).unwrap()
    };
    let parts = rig([Some(valves()); 2]);
    let recorded = Expression::record(&["cracking_pressure"], |numbers| {
        let mut balance: Balance<_> = balance_over(&parts);
        for valves in &mut balance.outward.as_mut().unwrap().port_valves {
            let valves = valves.as_mut().unwrap();
            valves.transition_pressure = 1e5.into();
            valves.relief.as_mut().unwrap().cracking_pressure = numbers[0];
        }
        let settled = balance.settle(Steady::Command(0.5.into()));
        settled.pressures.to_vec()
    });
    for step in 0..40 {
        let cracking = 2e6 + 1.25e5 * f64::from(step);
        let [pressure_a, pressure_b] = recorded.evaluate(&[cracking])[..] else { unreachable!() };
        let expected = found(cracking);
        assert!((pressure_a - expected.pressure_a).abs() < 1.0, "{cracking} {pressure_a} {expected:?}");
        assert!((pressure_b - expected.pressure_b).abs() < 1.0, "{cracking} {pressure_b} {expected:?}");
    }
}

fn balance_over<S: phea_dynamics::scalar::Scalar>(parts: &Components) -> Balance<S> {
    let plain = Balance::at(parts, 0.2);
    Balance {
        valve: plain.valve.convert(&mut S::from),
        supply: plain.supply.convert(&mut S::from),
        areas: plain.areas.map(S::from),
        across: None,
        outward: plain.outward.map(|outward| outward.convert(&mut S::from)),
    }
}

/// A load drives the piston of a rig whose spool is shut: one chamber rises to the pressure at
/// which its relief valve passes what the piston displaces, and never beyond; the other falls to
/// that at which its check valve passes it.
#[test]
fn a_driven_piston_meets_the_pressures_of_its_valves() {
    let parts = rig([Some(valves()); 2]);
    let shut = phea_hydraulics::servovalve::Edges::equal(1e-13);
    let valve = phea_hydraulics::servovalve::Servovalve { leakage_coefficients: shut, ..parts.valve };
    let machine = machine_of(Components { valve, ..parts });
    let start = StartValues { position: 0.1, pressure_a: 20e5, pressure_b: 20e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    // the load is driven at 0.1 m/s, which it reaches in 20 ms, and the piston follows on its
    // sensor
    let speed = 0.1;
    let at = |time: f64| {
        let (ramp, ground) = (0.02, beginning.inputs[0]);
        let reached = time.min(ramp);
        let travel = 0.5 * speed * reached * reached / ramp + speed * (time - reached);
        [ground - travel, -speed * reached / ramp]
    };
    let mut rates = |time: f64, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        machine.rates(state, 0.0, &at(time), &mut rates);
        rates
    };
    let (mut state, width, mut peak, mut least) = (beginning.state.clone(), 2e-5, 0.0_f64, f64::INFINITY);
    for index in 0..30_000 {
        step(&mut state, f64::from(index) * width, width, &mut rates);
        peak = peak.max(state[2]);
        least = least.min(state[3]);
    }
    let [area_a, area_b] = parts.cylinder.areas_at(0.1);
    let conductance = valves().relief.unwrap().conductance;
    // ORIGIN: analytic, p_T + p_r + A v/G and p_T - p_c - A v/G
    let (relieved, filled) = (52e5 + area_a * speed / conductance, 1.5e5 - area_b * speed / conductance);
    assert!((state[2] / relieved - 1.0).abs() < 1e-6, "{} {relieved}", state[2]);
    assert!((state[3] - filled).abs() < 1.0, "{} {filled}", state[3]);
    // the oil is stiff next to the mass, whose oscillation adds M w v to the force
    assert!(peak < relieved + 1e5 && least > filled - 1e5, "{peak} {least}");
    let mut indicators = [0.0; INDICATORS.len()];
    machine.indicate(&state, &at(0.6), &mut indicators);
    let open: Vec<&str> =
        (0..INDICATORS.len()).filter(|at| indicators[*at] < 0.0).map(|at| INDICATORS[at]).collect();
    assert_eq!(open, ["relief_valve_a", "check_valve_b"]);
}

/// Impossible parameters are named by their paths.
#[test]
fn impossible_valves_are_rejected() {
    let wrong = PortValves {
        relief: Some(TankValve { cracking_pressure: -1.0, conductance: 0.0 }),
        check: Some(TankValve { cracking_pressure: -1.0, conductance: f64::NAN }),
        transition_pressure: -0.5,
    };
    let error = Actuator::new(rig([None, Some(wrong)])).unwrap_err();
    let names: Vec<&str> = error.problems.iter().map(|problem| problem.quantity.as_str()).collect();
    let expected = [
        "transition_pressure",
        "cracking_pressure",
        "flow",
        "transition_pressure",
        "check_valve_pressure",
        "check_valve_flow",
    ];
    assert_eq!(names, expected.map(|name| format!("port_valves.b.{name}")));
}
