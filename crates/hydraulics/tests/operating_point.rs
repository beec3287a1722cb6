//! Equilibria: closed forms, required balances, and errors with their numbers.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::operating_point::{Condition, OperatingPointError, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{USEFUL_AREA, components, cylinder, hose_line, valve_with_equal_edges};
use phea_hydraulics::servovalve::{Servovalve, SpoolDirection, chamber_flows, velocity_gain};
use phea_hydraulics::stiffness::StiffnessModel;

fn rig() -> Components {
    components(hose_line(), StiffnessModel::Uniform)
}

fn asymmetric() -> Actuator {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    Actuator::new(Components { cylinder: Cylinder { area_a, area_b, ..cylinder() }, ..rig() }).unwrap()
}

#[test]
fn null_valve_with_unequal_edges() {
    let actuator = Actuator::new(rig()).unwrap();
    let null = operating_point(&actuator, 0.25, Condition::Command(0.0)).unwrap();
    // ORIGIN: recomputed by comparisons/recompute_rig.py, with plain square roots
    assert!((null.pressure_a - 3_730_518.7).abs() < 0.2 && (null.pressure_b - 2_404_754.8).abs() < 0.2);
    assert!((null.hydraulic_force - 2099.165).abs() < 1e-3);
    // ORIGIN: analytic, p = p_S K_in^2/(K_in^2 + K_out^2) without the transition
    let ratio = 2.35e-9 * 2.35e-9 / (2.35e-9 * 2.35e-9 + 2.2e-9 * 2.2e-9);
    assert!((null.pressure_a / 70e5 - ratio).abs() < 1e-7);
}

#[test]
fn equal_edges_settle_at_half_the_supply() {
    let actuator = Actuator::new(Components { valve: valve_with_equal_edges(), ..rig() }).unwrap();
    for condition in
        [Condition::Command(0.0), Condition::Load(SteadyLoad::Force(0.0)), Condition::Matched(0.0, 0.0)]
    {
        let point = operating_point(&actuator, 0.1, condition).unwrap();
        assert_eq!((point.pressure_a, point.pressure_b, point.command), (35e5, 35e5, 0.0));
    }
}

/// Every requested condition holds, and no flow exceeds the motion of the piston.
#[test]
fn every_equilibrium_balances() {
    for actuator in [Actuator::new(rig()).unwrap(), asymmetric()] {
        let Components { valve, supply, cylinder, .. } = *actuator.components();
        let conditions = [
            Condition::Command(0.02),
            Condition::Command(-3.0),
            Condition::Load(SteadyLoad::Force(4000.0)),
            Condition::Load(SteadyLoad::Force(-6500.0)),
            Condition::Load(SteadyLoad::Pressure(20e5)),
            Condition::Motion(1.0, SteadyLoad::Force(2000.0)),
            Condition::Motion(-4.0, SteadyLoad::Force(2000.0)),
            Condition::Motion(2.0, SteadyLoad::Pressure(-15e5)),
            Condition::Moving(0.05, SteadyLoad::Force(3000.0)),
            Condition::Moving(-0.02, SteadyLoad::Pressure(15e5)),
        ];
        for condition in conditions {
            let point = operating_point(&actuator, 0.2, condition).unwrap();
            let flows = chamber_flows(&valve, &supply, point.command, point.pressure_a, point.pressure_b);
            // the last bit of a pressure near the supply's is worth K/sqrt(dp_t) times 1e-9 Pa
            let scale = 2e-17 + 1e-9 * flows.into_a.abs();
            assert!((flows.into_a - cylinder.area_a * point.velocity).abs() < scale, "{condition:?}");
            assert!((flows.into_b + cylinder.area_b * point.velocity).abs() < scale, "{condition:?}");
            match condition {
                Condition::Load(SteadyLoad::Force(force))
                | Condition::Motion(_, SteadyLoad::Force(force))
                | Condition::Moving(_, SteadyLoad::Force(force)) => {
                    assert!((point.hydraulic_force - force).abs() < 1e-5)
                }
                Condition::Load(SteadyLoad::Pressure(pressure))
                | Condition::Motion(_, SteadyLoad::Pressure(pressure))
                | Condition::Moving(_, SteadyLoad::Pressure(pressure)) => {
                    assert!((point.load_pressure() - pressure).abs() < 1e-2)
                }
                Condition::Command(_) | Condition::Matched(..) => assert_eq!(point.velocity, 0.0),
            }
        }
    }
}

/// Leakage hardly matters at full opening, and the speed is that of two edges in series.
#[test]
fn speed_at_full_opening_is_the_velocity_gain() {
    for actuator in [Actuator::new(rig()).unwrap(), asymmetric()] {
        let Components { valve, supply, cylinder, .. } = *actuator.components();
        let areas = [cylinder.area_a, cylinder.area_b];
        for (command, direction) in [(10.0, SpoolDirection::Extending), (-10.0, SpoolDirection::Retracting)] {
            let point =
                operating_point(&actuator, 0.25, Condition::Motion(command, SteadyLoad::Force(1500.0)))
                    .unwrap();
            let speed = command * velocity_gain(&valve, &supply, areas, 1500.0, direction).unwrap();
            assert!((point.velocity / speed - 1.0).abs() < 1e-6, "{} against {speed}", point.velocity);
        }
    }
}

#[test]
fn load_rises_with_the_command_that_holds_it() {
    let actuator = asymmetric();
    let mut last = f64::NEG_INFINITY;
    for step in -6..=12 {
        let force = 1000.0 * f64::from(step);
        let command =
            operating_point(&actuator, 0.25, Condition::Load(SteadyLoad::Force(force))).unwrap().command;
        assert!(command > last);
        last = command;
    }
}

#[test]
fn impossible_operating_points_are_refused_with_numbers() {
    let actuator = Actuator::new(rig()).unwrap();
    let refused = |position, condition| operating_point(&actuator, position, condition).unwrap_err();
    assert_eq!(
        refused(0.6, Condition::Command(0.0)),
        OperatingPointError::PositionOutsideStroke { position: 0.6, stroke: 0.5 }
    );
    assert_eq!(
        refused(0.1, Condition::Motion(-11.0, SteadyLoad::Force(0.0))),
        OperatingPointError::CommandBeyondNominal { command: -11.0, nominal: 10.0 }
    );
    let OperatingPointError::LoadOutOfReach { load, minimum, maximum, .. } =
        refused(0.1, Condition::Load(SteadyLoad::Force(12e3)))
    else {
        panic!()
    };
    // ORIGIN: analytic, at full opening the supply pressure on one side only
    assert!(load == 12e3 && (maximum / (USEFUL_AREA * 70e5) - 1.0).abs() < 1e-3 && minimum < -0.99 * maximum);
    // an overrunning load draws chamber A empty
    let overrun = refused(0.1, Condition::Motion(1.0, SteadyLoad::Force(-30e3)));
    assert!(matches!(overrun, OperatingPointError::BelowVacuum { pressure } if pressure < -101_325.0));
    for condition in
        [Condition::Load(SteadyLoad::Force(f64::NAN)), Condition::Motion(1.0, SteadyLoad::Force(f64::NAN))]
    {
        assert!(operating_point(&actuator, 0.1, condition).is_err());
    }
}

#[test]
fn an_actuator_reports_all_impossible_parameters_at_once() {
    let broken = Components {
        cylinder: Cylinder {
            stroke: phea_hydraulics::stroke::ActuatorStroke::Limited(-0.5),
            moving_mass: 0.0,
            ..cylinder()
        },
        valve: Servovalve { natural_frequency: f64::INFINITY, ..rig().valve },
        ..rig()
    };
    let error = Actuator::new(broken).unwrap_err();
    let names: Vec<&str> = error.problems.iter().map(|problem| problem.quantity.as_str()).collect();
    assert_eq!(names, ["valve.natural_frequency", "cylinder.stroke", "cylinder.moving_mass"]);
    assert!(error.to_string().contains("cylinder.stroke is -0.5, but must be positive"));
    let line = phea_hydraulics::line::Line::Volume { volume: 0.0, effective_bulk_modulus: 1e9 };
    let empty = Actuator::new(Components { line_a: line, ..rig() }).unwrap_err();
    assert_eq!(empty.problems[0].quantity, "cylinder.dead_volume_a");
}
