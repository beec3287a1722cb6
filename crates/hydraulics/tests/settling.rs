//! The balance over any scalar compared with bisection, the machine, and closed forms.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::expression::Expression;
use phea_dynamics::random::uniform;
use phea_dynamics::scalar::{Dual, Interval, Parameters};
use phea_dynamics::simulation::DIRECTIONS;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cross_port::CrossFlow;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::machine::{Machine, MachineOptions};
use phea_hydraulics::operating_point::{
    Balance, OperatingPoint, Settled, Steady, SteadyLoad, operating_point,
};
use phea_hydraulics::reference_rig::{components, cylinder, hose_line, leaking, valve};
use phea_hydraulics::servovalve::{Edges, LeakageModel, LeakageShape, OpeningLaw, Servovalve, Supply};
use phea_hydraulics::stiffness::StiffnessModel;

/// The pressures at standstill over a box of supply pressures, loads and commands are enclosed
/// between tank and supply, for any width of the box.
#[test]
fn pressures_at_rest_are_enclosed_between_tank_and_supply() {
    let mut draw = Draw(11);
    for round in 0..12 {
        let rig = draw.rig();
        let Components { valve, supply, cylinder, .. } = *rig.components();
        let force = draw.even(-0.3, 0.3) * cylinder.area_a * supply.pressure;
        let recorded = Expression::record(&["pressure"], |p| {
            let supply = Supply { pressure: p[0], tank_pressure: supply.tank_pressure.into() };
            let valve = valve.convert(&mut Into::into);
            let areas = [cylinder.area_a.into(), cylinder.area_b.into()];
            let balance = Balance { valve, supply, areas, across: None, outward: None };
            let steady = match round % 2 {
                0 => Steady::Command(0.0.into()),
                _ => Steady::Moving { velocity: 0.0.into(), load: SteadyLoad::Force(force.into()) },
            };
            balance.settle(steady).pressures.to_vec()
        });
        let [low, high] = [0.8, 1.2].map(|fraction| fraction * supply.pressure);
        let enclosed = recorded.enclosures(&[Interval::new(low, high)]);
        for step in 0..=20 {
            let pressures = recorded.evaluate(&[low + (high - low) * f64::from(step) / 20.0]);
            for (enclosed, pressure) in enclosed.iter().zip(pressures) {
                assert!(enclosed.low() <= pressure && pressure <= enclosed.high());
            }
        }
        for enclosed in enclosed {
            assert!(enclosed.low() >= supply.tank_pressure && enclosed.high() <= high, "{enclosed:?}");
        }
    }
}

/// Number between two ends, with linear or logarithmic spacing.
struct Draw(u64);

impl Draw {
    fn even(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * uniform(&mut self.0)
    }

    fn factor(&mut self, low: f64, high: f64) -> f64 {
        low * phea_dynamics::portable::pow(high / low, uniform(&mut self.0))
    }

    fn edges(&mut self, low: f64, high: f64) -> Edges {
        Edges::from_array([0; 4].map(|_| self.factor(low, high)))
    }

    fn leakage_model(&mut self) -> LeakageModel {
        if uniform(&mut self.0) < 0.5 { LeakageModel::EachEdge } else { LeakageModel::OneCurve }
    }

    /// Edges that differ threefold, any leakage of them by either model, one rod or two, and a
    /// supply from 30 to 300 bar.
    fn rig(&mut self) -> Actuator {
        let rods = [self.even(0.0, 0.036), self.even(0.0, 0.036)];
        let [area_a, area_b] = rods.map(|rod| annulus_area(0.05, rod));
        let tank_pressure = self.even(0.0, 5e5);
        let supply = Supply { pressure: tank_pressure + self.factor(30e5, 300e5), tank_pressure };
        let valve = Servovalve {
            flow_coefficients: self.edges(1e-7, 3e-7),
            opening: OpeningLaw::Proportional,
            leakage_coefficients: self.edges(1e-9, 3e-9),
            leakage_shape: LeakageShape::Common(self.even(0.0, 200.0)),
            leakage_model: self.leakage_model(),
            transition_pressure: self.factor(1e2, 1e4),
            ..valve()
        };
        let rig = components(hose_line(), StiffnessModel::Uniform);
        let cylinder = Cylinder { area_a, area_b, ..cylinder() };
        Actuator::new(Components { supply, valve, cylinder, ..rig }).unwrap()
    }

    /// Load that the supply can hold, and a velocity that the valve allows.
    fn steady(&mut self, actuator: &Actuator) -> Steady {
        let Components { supply, cylinder, .. } = actuator.components();
        let drop = supply.pressure - supply.tank_pressure;
        let pressure = self.even(-0.8, 0.8) * drop;
        let load = match uniform(&mut self.0) < 0.5 {
            true => SteadyLoad::Pressure(pressure),
            false => SteadyLoad::Force(pressure * cylinder.area_a.min(cylinder.area_b)),
        };
        let reach = 1e-7 * (0.1 * drop).sqrt() / cylinder.area_a.max(cylinder.area_b);
        match uniform(&mut self.0) {
            kind if kind < 0.2 => Steady::Command(self.even(-10.0, 10.0)),
            kind if kind < 0.4 => Steady::Command(self.even(-0.3, 0.3)),
            kind if kind < 0.7 => Steady::Moving { velocity: 0.0, load },
            _ => Steady::Moving { velocity: self.even(-reach, reach), load },
        }
    }
}

fn error(actuator: &Actuator, settled: &Settled, found: &OperatingPoint) -> f64 {
    let Components { supply, valve, .. } = actuator.components();
    let drop = supply.pressure - supply.tank_pressure;
    let [a, b] = settled.pressures;
    ((settled.command - found.command) / valve.nominal_voltage).abs()
        + ((a - found.pressure_a) / drop).abs()
        + ((b - found.pressure_b) / drop).abs()
}

/// Every point without leakage across the piston agrees with bisection, at any position.
#[test]
fn settled_points_are_those_of_bisection() {
    let mut draw = Draw(7);
    let mut found = 0;
    for _ in 0..10_000 {
        let actuator = draw.rig();
        let steady = draw.steady(&actuator);
        let Ok(point) = operating_point(&actuator, 0.25, steady.into()) else { continue };
        let balance = Balance::at(actuator.components(), 0.25);
        let settled = balance.settle(steady);
        assert!(error(&actuator, &settled, &point) < 1e-13, "{steady:?} {actuator:?} {settled:?} {point:?}");
        assert!(balance.error(steady, &settled) < 1e-13, "{steady:?}");
        found += 1;
    }
    assert!(found > 9_500, "{found}");
}

/// True if the force at standstill rises with the command all over its range: with unequal areas
/// and edges this fails for large leakage, and one load has several commands.
fn rises(actuator: &Actuator) -> bool {
    let balance = Balance::at(actuator.components(), 0.25);
    let force = |command: f64| {
        let [a, b] = balance.settle(Steady::Command(command)).pressures;
        balance.areas[0] * a - balance.areas[1] * b
    };
    let commands: Vec<f64> =
        (-60..=60).map(|step| f64::from(step) / 60.0).map(|part| 10.0 * part * part * part).collect();
    commands.windows(2).all(|pair| force(pair[0]) < force(pair[1]))
}

/// Every point with leakage across the piston is the rest of the machine, found by its own
/// equations from the point without leakage.
#[test]
fn leaking_points_are_where_the_machine_rests() {
    let mut draw = Draw(11);
    let mut found = [0; 2];
    for _ in 0..4000 {
        let actuator = draw.rig();
        let steady = draw.steady(&actuator);
        if let Steady::Moving { load: SteadyLoad::Pressure(_), .. } = steady {
            continue; // the machine holds a force
        }
        let leakage = draw.factor(1e-14, 1e-10);
        let leaky = Actuator::new(leaking(*actuator.components(), leakage)).unwrap();
        if !rises(&leaky) {
            continue; // the machine may rest at another balance
        }
        let Ok(tight) = operating_point(&actuator, 0.25, steady.into()) else { continue };
        let machine = Machine::new(&leaky, &MachineOptions::default()).unwrap();
        let (kind, rest) = match steady {
            Steady::Command(_) => (0, machine.rest(&tight)),
            _ => (1, machine.rest_under_load(&tight)),
        };
        let Ok(rest) = rest else { continue };
        let &[command, _, pressure_a, pressure_b] = rest.state.first_chunk().unwrap();
        if pressure_a.min(pressure_b) < -1e5 {
            continue; // a chamber without oil
        }
        let rested = OperatingPoint { command, pressure_a, pressure_b, ..tight };
        let balance = Balance::at(leaky.components(), 0.25);
        let settled = balance.settle(steady);
        assert!(error(&actuator, &settled, &rested) < 1e-9, "{steady:?} {leakage} {settled:?} {rested:?}");
        assert!(balance.error(steady, &settled) < 1e-12, "{steady:?}");
        found[kind] += 1;
        if command.abs() < 10.0 {
            let afresh = operating_point(&leaky, 0.25, steady.into()).unwrap();
            assert!(error(&actuator, &settled, &afresh) < 1e-12, "{steady:?} {afresh:?}");
        }
    }
    assert!(found.iter().all(|count| *count > 500), "{found:?}");
}

/// Equilibrium for edges, pressures, areas, leakage, velocity and force, in this order.
fn settle<S: phea_dynamics::scalar::Scalar>(p: &[S], leakage_model: LeakageModel) -> Vec<S> {
    let balance = Balance {
        valve: Servovalve {
            leakage_model,
            flow_coefficients: Edges::from_array([p[0], p[1], p[2], p[3]]),
            leakage_coefficients: Edges::from_array([p[4], p[5], p[6], p[7]]),
            ..valve().convert(&mut Into::into)
        },
        supply: Supply { pressure: p[8], tank_pressure: p[9] },
        areas: [p[10], p[11]],
        across: Some(CrossFlow { conductance: p[12], orifice: None }),
        outward: None,
    };
    let settled = balance.settle(Steady::Moving { velocity: p[13], load: SteadyLoad::Force(p[14]) });
    vec![settled.command, settled.pressures[0], settled.pressures[1]]
}

const NAMES: [&str; 15] =
    ["K3", "K4", "K5", "K6", "L3", "L4", "L5", "L6", "p_S", "p_T", "A_A", "A_B", "G", "v", "F"];

/// A single recording is valid for every point of a box that brings the spool through null, and
/// differentiating it gives the derivatives of the point itself, by the implicit function theorem.
#[test]
fn a_recorded_point_has_correct_derivatives_everywhere() {
    for leakage_model in [LeakageModel::EachEdge, LeakageModel::OneCurve] {
        check_recorded_point(leakage_model);
    }
}

fn check_recorded_point(leakage_model: LeakageModel) {
    let recorded = Expression::record(&NAMES, |p| settle(p, leakage_model));
    let mut draw = Draw(3);
    let mut sides = [0; 2];
    for _ in 0..300 {
        let mut values: Vec<f64> = draw.edges(1.5e-7, 4e-7).to_array().to_vec();
        values.extend(draw.edges(1e-9, 3e-9).to_array());
        values.extend([draw.even(60e5, 90e5), draw.even(0.0, 5e5)]);
        values.extend([draw.even(1.2e-3, 1.6e-3), draw.even(1.4e-3, 2e-3), draw.factor(1e-14, 1e-11)]);
        values.extend([draw.even(-0.03, 0.03), draw.even(-4000.0, 4000.0)]);
        let point = settle(&values, leakage_model);
        assert_eq!(recorded.evaluate(&values), point);
        sides[usize::from(point[0] > 0.0)] += 1;
        for index in 0..values.len() {
            let duals: Vec<Dual<DIRECTIONS>> = values
                .iter()
                .enumerate()
                .map(
                    |(at, &value)| if at == index { Dual::variable(value, 0) } else { Dual::constant(value) },
                )
                .collect();
            let slopes = recorded.evaluate(&duals);
            let scale = if values[index] == 0.0 { 1.0 } else { values[index].abs() };
            let moved = |step: f64| {
                let mut other = values.clone();
                other[index] += step * scale;
                settle(&other, leakage_model)
            };
            let (before, after) = (moved(-1e-6), moved(1e-6));
            if before[0] * after[0] < 0.0 {
                continue; // the slopes of both sides of null differ
            }
            for (result, whole) in [10.0, 70e5, 70e5].into_iter().enumerate() {
                let difference = (after[result] - before[result]) / 2e-6;
                let slope = slopes[result].gradient()[0] * scale;
                let allowed = 1e-8 * whole + 2e-5 * slope.abs();
                assert!((slope - difference).abs() < allowed, "{index} {result}: {slope} {difference}");
            }
        }
    }
    assert!(sides.iter().all(|count| *count > 50), "{sides:?}");
}

/// Equal pressures cause no leakage, which leaves the operating point unchanged.
#[test]
fn leakage_leaves_equal_pressures_unchanged() {
    let balance = |leakage: f64| Balance {
        valve: phea_hydraulics::reference_rig::valve_with_equal_edges(),
        supply: Supply { pressure: 70e5, tank_pressure: 0.0 },
        areas: [1.58e-3; 2],
        across: Some(CrossFlow { conductance: leakage, orifice: None }),
        outward: None,
    };
    let settled = balance(1e-11).settle(Steady::Command(0.0));
    assert_eq!(settled.pressures, [35e5; 2]);
    let moving = Steady::Moving { velocity: 0.0, load: SteadyLoad::Force(0.0) };
    assert_eq!(balance(1e-11).settle(moving).command, 0.0);
    // ORIGIN: analytic, no load pressure remains with infinite leakage across the piston
    let open = Balance { valve: valve(), ..balance(1e-4) }.settle(Steady::Command(0.0));
    assert!((open.pressures[0] - open.pressures[1]).abs() < 1.0);
}
