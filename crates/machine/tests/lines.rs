//! Tests of the machine with dynamic lines: their limits, and comparison with each other, by the
//! production method.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::simulation::{Plant, Profile, SimulationSettings, Status};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::line::{
    Conduit, END_SHARE, LaminarFriction, Line, LineModel, LineWall, StiffeningMember,
};
use phea_hydraulics::machine::{Chambers, Machine, MachineOptions};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{components, hose, hose_line};
use phea_hydraulics::stiffness::StiffnessModel;

use crate::driven::driven;

fn actuator() -> Actuator {
    Actuator::new(components(hose_line(), StiffnessModel::ByVolume)).unwrap()
}

fn machine(model: LineModel) -> Machine {
    let components = Components { line_models: [model; 2], ..*actuator().components() };
    Machine::new(&Actuator::new(components).unwrap(), &MachineOptions::default()).unwrap()
}

fn segments(count: usize) -> LineModel {
    LineModel::Segments { count, friction: LaminarFriction::FrequencyDependent, relaxation_time: None }
}

const WAVES: LineModel = LineModel::TransmissionLine { end_share: END_SHARE };

fn two_waves() -> LineModel {
    LineModel::TwoWave { end_share: END_SHARE, wall: LineWall::default() }
}

/// Force every millisecond, N, while the load moves smoothly by 2 mm, beginning 20 ms after a rest
/// at 2 kN.
fn forces(line: LineModel, motion_s: f64, duration_s: f64) -> Vec<f64> {
    let machine = machine(line);
    let point = operating_point(&actuator(), 0.2, Condition::Load(SteadyLoad::Force(2e3))).unwrap();
    let rest = machine.rest(&point).unwrap();
    let motion = Profile::smooth_step(0.02, motion_s, 2e-3).unwrap();
    let start = [rest.state.clone(), rest.waves.clone()].concat();
    let ground = motion.shifted(rest.inputs[0]);
    let command = Profile::constant(rest.command);
    let settings = SimulationSettings::default();
    let result = driven(machine, start, [duration_s, 1e-3], command, ground, &settings);
    assert_eq!(result.outcome.status, Status::Completed);
    let states = result.states.iter();
    states.map(|state| machine.measurement(state, &rest.all_inputs())).collect()
}

fn largest_difference(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A capacity without segments after the valve equals the lumped line, for any stiffness model of
/// the chamber.
#[test]
fn one_capacity_is_the_lumped_line() {
    let (actuator, member) = (actuator(), StiffeningMember::Nominal);
    let compliance = hose_line().compliance(1.45e9, member);
    let [lumped, capacity] = [
        Chambers::new(&actuator, member),
        Chambers::with_line_compliance(&actuator, member, [compliance; 2]),
    ]
    .map(|chambers| chambers.compliance(0.31, [41e5, 22e5]));
    assert!(lumped.iter().zip(&capacity).all(|(a, b)| (a - b).abs() <= 1e-13 * a), "{lumped:?} {capacity:?}");
}

/// Every line acts as its compliance in slow motion; in fast motion they differ.
#[test]
fn slow_motions_see_the_lumped_line() {
    let compare = |line: LineModel, motion_s: f64| {
        let lumped = forces(LineModel::Lumped, motion_s, motion_s + 0.04);
        let other = forces(line, motion_s, motion_s + 0.04);
        let peak = lumped.iter().map(|force| (force - lumped[0]).abs()).fold(0.0, f64::max);
        assert!(peak > 500.0);
        largest_difference(&lumped, &other) / peak
    };
    for line in [segments(4), WAVES, two_waves()] {
        let (slow, fast) = (compare(line, 0.4), compare(line, 0.02));
        assert!(slow < 0.01 && fast > 3.0 * slow, "{slow} {fast}");
    }
}

/// More segments approach the travelling wave; the error is proportional to the square of their
/// length.
#[test]
fn segments_become_a_transmission_line() {
    let travelling = forces(WAVES, 0.02, 0.05);
    let errors = [2, 4, 8].map(|count| largest_difference(&forces(segments(count), 0.02, 0.05), &travelling));
    assert!(errors[1] < 0.6 * errors[0] && errors[2] < 0.02 * 4e3, "{errors:?}");
}

/// A pulse at the valve has no effect before its wave has arrived.
#[test]
fn the_far_end_is_at_rest_until_the_wave_arrives() {
    let machine = machine(WAVES);
    let point = operating_point(&actuator(), 0.2, Condition::Load(SteadyLoad::Force(0.0))).unwrap();
    let rest = machine.rest(&point).unwrap();
    let ground = Profile::constant(rest.inputs[0]);
    let settings = SimulationSettings { tolerance: 1e-8, ..SimulationSettings::default() };
    let start = [rest.state.clone(), rest.waves.clone()].concat();
    let command = Profile::constant(rest.command + 5.0);
    let result = driven(machine, start, [0.008, 1e-4], command, ground, &settings);
    let delay = machine.delays()[0];
    assert!(delay > 2.6e-3 && delay < 2.80e-3);
    for (time, state) in result.times_s.iter().zip(&result.states) {
        let force = machine.measurement(state, &rest.all_inputs());
        if *time < delay {
            assert!((force - 2e7 * rest.state[4]).abs() < 1e-3, "{force} at {time}");
        }
    }
    let last = result.states.last().unwrap();
    assert!(machine.measurement(last, &rest.all_inputs()) > 10.0);
}

/// Lines of any kind of hose preserve a steady motion, including the pressure drop along them.
#[test]
fn steady_motions_remain_steady() {
    let line = Line::Hose { hose: hose(), length: 3.0 };
    let rig = components(line, StiffnessModel::Uniform);
    let conduit = Conduit::of_line(&line, &rig.fluid, 35e5, StiffeningMember::Nominal).unwrap();
    let segments = LineModel::Segments { count: 3, friction: LaminarFriction::Steady, relaxation_time: None };
    for line_models in [[WAVES, segments], [segments, WAVES]] {
        let actuator = Actuator::new(Components { line_models, ..rig }).unwrap();
        let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
        let point = operating_point(&actuator, 0.2, Condition::Motion(2.0, SteadyLoad::Force(1e3))).unwrap();
        let steady = machine.rest(&point).unwrap();
        let signals = machine.signals(&steady.state, &steady.all_inputs());
        let (chamber, port) = (signals.pressures[0], signals.port_pressures[0]);
        let drop = conduit.steady_resistance() * rig.cylinder.area_a * point.velocity;
        assert!(
            point.velocity > 0.05 && (port - chamber - drop).abs() < 1e-3 * drop,
            "{port} {chamber} {drop}"
        );
    }
}
