//! The simulated machine compared with models with which it must agree: its linearisation, the
//! static friction curve, and independent computations for hose and pipe.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use phea_hydraulics::signal::Signal;
use std::f64::consts::TAU;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::simulation::{
    CommandedPlant, Input, InputSchedule, Observer, Profile, Sensed, SimulationSettings, Status, Task,
};
use phea_hydraulics::machine::{Machine, MachineOptions};
use phea_machine::{Control, Watcher};
use phea_workbench::linearize::linearize;
use phea_workbench::project::{self, Project};
use phea_workbench::rig::Rig;
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{Cause, Metrics, ScenarioRun, simulate_project};
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");

fn load(settings: &[&str]) -> Project {
    let source = Memory::default().with("rig.toml", BENCHMARK);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    loaded.project
}

fn run(settings: &[&str]) -> ScenarioRun {
    let run = simulate_project(&Memory::default(), &Setup::new(&load(settings)).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert_eq!(run.status, Status::Completed);
    run
}

/// Time in s and state of the force, the stretch of the sensor, at every row.
#[derive(Default)]
struct Forces(Vec<(f64, f64)>);

impl Observer for Forces {
    fn wanted(&self) -> &[usize] {
        &[4]
    }

    fn observe(&mut self, time_s: f64, states: &[f64], _: &[f64]) {
        self.0.push((time_s, states[0]));
    }
}

/// Input that excites the machine about its rest.
enum Shaken {
    /// Command, V.
    Command,
    /// Load position, m.
    Load,
}

/// Force per command in N/V, or per load position in N/m, of the machine itself: a small sine until
/// all transients have decayed, then the fundamental of the force over whole periods.
fn small_signal(rig: &Rig, shaken: &Shaken, amplitude: f64, frequency: f64) -> Complex64 {
    const ROWS_PER_PERIOD: f64 = 32.0;
    let machine = Machine::new(&rig.actuator, &MachineOptions::default()).unwrap();
    let rest = machine.rest(&rig.point).unwrap();
    let through = TransferFunction::gain_only(1.0);
    let held = CommandedPlant::on_hold(Sensed::new(machine, &through).unwrap(), &through).unwrap();
    let sine = Profile::sine(0.0, amplitude, frequency).unwrap();
    let still = [Profile::constant(rest.command), Profile::constant(rest.inputs[0])];
    let [command, ground] = match shaken {
        Shaken::Command => [sine.shifted(rest.command), still[1].clone()],
        Shaken::Load => [still[0].clone(), sine.shifted(rest.inputs[0])],
    };
    let none = Input::Value(Profile::constant(0.0));
    let inputs = vec![Input::Value(command), none, Input::Value(ground.clone()), Input::Rate(ground)];
    let period = TAU / frequency;
    // the slowest pole is near 0.5 rad/s
    let settled = (25.0 / period).ceil();
    let schedule = InputSchedule {
        duration_s: (settled + 2.5) * period,
        output_step_s: period / ROWS_PER_PERIOD,
        inputs,
    };
    let settings = SimulationSettings { tolerance: 1e-9, ..SimulationSettings::default() };
    let mut forces = Forces::default();
    let task = Task {
        start: rest.state,
        schedule: &schedule,
        sampler: None,
        observer: Box::new(&mut forces) as Watcher,
    };
    let outcome = Control::Open(Box::new(held)).drive(task, &settings, &mut |_| true).unwrap();
    assert_eq!(outcome.status, Status::Completed);
    let stiffness = rig.actuator.components().force_sensor.stiffness;
    let from = (settled * ROWS_PER_PERIOD) as usize;
    let rows = from..from + 2 * ROWS_PER_PERIOD as usize;
    let sum: Complex64 = rows
        .clone()
        .map(|row| {
            let (time_s, extension) = forces.0[row];
            let phase = frequency * time_s;
            // sin is the imaginary part: F e^{-j w t} averages to A/(2 j)
            Complex64::new(phase.cos(), -phase.sin()) * stiffness * extension
        })
        .sum();
    sum / rows.len() as f64 * Complex64::new(0.0, 2.0) / amplitude
}

#[test]
fn small_motions_are_those_of_the_linearised_rig() {
    // Equal edges, or the flow gain at null would differ by direction; away from the middle two
    // pressures are needed.
    let project = load(&[
        "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
        "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
        "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
        "operating_point.position=\"0.1 m\"",
    ]);
    let rig = Setup::rig_of(&project).unwrap();
    let linear = linearize(&rig, None, &TransferFunction::gain_only(1.0)).unwrap().two_pressure;
    // 1 mV or 1 um; the piston on its sensor resonates near 1300 rad/s
    for frequency in [10.0, 30.0, 100.0, 300.0, 1000.0, 1300.0] {
        for (shaken, amplitude, model) in
            [(Shaken::Command, 1e-3, &linear.command), (Shaken::Load, 1e-6, &linear.load_position)]
        {
            let expected = model.at_frequency(frequency);
            let found = small_signal(&rig, &shaken, amplitude, frequency);
            let error = (found / expected - 1.0).norm_sqr().sqrt();
            assert!(error < 0.01, "{frequency} rad/s: {found}, not {expected}");
        }
    }
}

/// A load that moves to and fro at 5 mm/s at most: bristles and the smoothed curve both give the
/// static friction. The viscous friction is so large that the curve never falls; otherwise the
/// piston would vibrate on its sensor, and nothing would be slow.
#[test]
fn at_low_velocity_bristles_have_the_static_curve() {
    let slow = [
        "scenario.0.load_motion={ kind = \"sine\", amplitude = \"5 mm\", frequency = \"1 rad/s\" }",
        "scenario.0.reference=[]",
        "scenario.0.duration=\"7 s\"",
        "cylinder.friction.viscous=\"4000 N.s/m\"",
    ];
    let smoothed = "cylinder.friction={ model = \"stribeck\", coulomb = \"80 N\", static = \"120 N\", \
                    stribeck_velocity = \"0.01 m/s\", viscous = \"4000 N.s/m\", regular_velocity = \"1e-5 m/s\" }";
    let of_static = [&slow[..], &[smoothed]].concat();
    for settings in [&slow[..], &of_static] {
        let run = run(settings);
        let (friction, velocity) = (run.record.signal(Signal::Friction), run.record.signal(Signal::Velocity));
        let mut compared = 0;
        for (friction, v) in friction.iter().zip(&velocity).skip(100).filter(|(_, v)| v.abs() > 1e-3) {
            let curve = v.signum() * (80.0 + 40.0 * (-(v / 0.01).powi(2)).exp()) + 4e3 * v;
            assert!((friction - curve).abs() < 0.01 * curve.abs(), "{v} m/s: {friction} N, not {curve}");
            compared += 1;
        }
        assert!(compared > 4_000, "{compared}");
    }
}

/// The difference between hydraulic and measured force is friction and acceleration: over the
/// motion of the load their impulse is the change of the piston's momentum, and at rest only the
/// friction remains, which the bristles still hold.
#[test]
fn friction_is_the_difference_of_hydraulic_and_measured_force() {
    const MOVING_MASS_KG: f64 = 13.1;
    let run = run(&["simulation.tolerance=1e-8"]);
    let [hydraulic, friction, force, velocity] =
        [Signal::HydraulicForce, Signal::Friction, Signal::Force, Signal::Velocity]
            .map(|signal| run.record.signal(signal));
    let left: Vec<f64> = hydraulic
        .iter()
        .zip(&friction)
        .zip(&force)
        .map(|((all, friction), force)| all - friction - force)
        .collect();
    let [from, until] = [3.0, 3.5].map(|time: f64| (time / run.sample_interval_s).round() as usize);
    let (mut impulse, mut of_friction, mut fastest) = (0.0, 0.0, 0.0_f64);
    for sample in from..until {
        let over = |values: &[f64]| 0.5 * (values[sample] + values[sample + 1]) * run.sample_interval_s;
        impulse += over(&left);
        of_friction += over(&friction).abs();
        let momentum = MOVING_MASS_KG * (velocity[sample + 1] - velocity[from]);
        fastest = fastest.max(momentum.abs());
        assert!((impulse - momentum).abs() < 1e-3, "{sample}: {impulse} N s, not {momentum} N s");
    }
    assert!(of_friction > 5.0 && fastest > 1.0, "{of_friction} N s, {fastest} N s");
    let last = left.len() - 1;
    assert!(velocity[last].abs() < 1e-6 && friction[last].abs() > 1.0, "{} N", friction[last]);
    assert!(left[last].abs() < 1e-2, "{} N beside {} N of friction", left[last], friction[last]);
}

const HOSE: [&str; 0] = [];
/// 0.35 m of 10.5 mm bore, with its controller of the thesis.
const PIPE: [&str; 5] = [
    "line.volume=\"3.03e-5 m3\"",
    "line.effective_bulk_modulus=\"1.45 GPa\"",
    "controller.numerator=\"0.0005*s + 0.002\"",
    "prefilter.numerator=\"484\"",
    "prefilter.denominator=\"s^2 + 44*s + 484\"",
];

/// Effect of a load step of 5 mm with this time constant on a force of 4 kN.
fn disturbed(line: &[&str], time_constant_s: f64) -> (ScenarioRun, Metrics) {
    let motion = format!(
        "scenario.0.load_motion={{ kind = \"first_order\", start = \"3 s\", time_constant = \"{time_constant_s} s\", \
         distance = \"5 mm\" }}"
    );
    let settings = [line, &[motion.as_str(), "simulation.tolerance=1e-8"]].concat();
    let run = run(&settings);
    let (window, metrics) = run.windows[1];
    assert_eq!(window.cause, Cause::LoadMotion);
    (run, metrics)
}

/// Number of crossings of 4 kN with a deviation of more than one percent between them.
fn swings(run: &ScenarioRun) -> usize {
    let force = run.record.signal(Signal::Force);
    let after = run.record.times_s.iter().zip(&force).filter(|(time, _)| **time >= 3.0);
    let sides: Vec<bool> =
        after.map(|(_, force)| force - 4e3).filter(|off| off.abs() > 40.0).map(|off| off > 0.0).collect();
    sides.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[test]
fn a_hose_responds_less_to_load_steps_than_a_pipe() {
    // ORIGIN: other tool, Runge-Kutta in fixed steps on equal equations, written independently:
    // peaks in N
    let expected = [(0.02, 5813.0, 8901.0), (0.05, 2803.0, 4527.0), (0.1, 1604.0, 2546.0)];
    for (time_constant_s, of_hose, of_pipe) in expected {
        let (hose_run, hose) = disturbed(&HOSE, time_constant_s);
        let (pipe_run, pipe) = disturbed(&PIPE, time_constant_s);
        for (found, expected) in [(&hose, of_hose), (&pipe, of_pipe)] {
            let peak: f64 = found.disturbance_peak_n.unwrap();
            assert!((peak / expected - 1.0).abs() < 0.05, "{time_constant_s} s: {peak} N, not {expected}");
        }
        let softening = pipe.disturbance_peak_n.unwrap() / hose.disturbance_peak_n.unwrap();
        assert!((1.5..=1.9).contains(&softening), "{softening}");
        // Contrary to expectation, the hose's command is larger, and its force swings longer. Its
        // gain is twice the pipe's.
        assert!(hose.control_rms_v.unwrap() > 1.1 * pipe.control_rms_v.unwrap());
        assert!(swings(&hose_run) > swings(&pipe_run));
    }
}
