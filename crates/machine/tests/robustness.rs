//! Machines under extreme inputs, by the production method: they reach their expected end, or
//! report the reason.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::simulation::{Profile, SimulationSettings, Status};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::friction::Friction;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{
    INDICATORS, Machine, MachineOptions, MachineSignals, PowerUnit, PumpLimited, StartValues,
};
use phea_hydraulics::reference_rig::{benchmark_components, components, hose_line, stopped};
use phea_hydraulics::servovalve::{Servovalve, SpoolImperfection, Supply};
use phea_hydraulics::signal::Signal;
use phea_hydraulics::stiffness::StiffnessModel;

use crate::driven::{Driven, driven};

/// Simulates the machine under an input schedule; its ground begins at the position in the start.
fn drive(
    machine: Machine,
    start: &StartValues,
    duration_s: f64,
    command: &[(f64, f64)],
    ground: Profile,
) -> (Driven, Vec<MachineSignals>) {
    let beginning = machine.start(start).unwrap().state;
    let command = Profile::steps(0.0, command).unwrap();
    let settings = SimulationSettings { maximum_steps: 200_000, ..SimulationSettings::default() };
    let result = driven(machine, beginning, [duration_s, duration_s / 1000.0], command, ground, &settings);
    let rows = result.states.iter().zip(&result.inputs);
    let outputs: Vec<_> = rows.map(|(state, inputs)| machine.signals(state, inputs)).collect();
    let values =
        |row: &MachineSignals| Signal::ALL.iter().filter_map(|signal| row.get(*signal)).collect::<Vec<f64>>();
    assert!(outputs.iter().flat_map(values).all(f64::is_finite));
    (result, outputs)
}

fn machine_of(components: Components, options: &MachineOptions) -> Machine {
    Machine::new(&Actuator::new(components).unwrap(), options).unwrap()
}

fn column(outputs: &[MachineSignals], signal: Signal) -> Vec<f64> {
    outputs.iter().filter_map(|row| row.get(signal)).collect()
}

fn happened(result: &Driven, name: &str) -> bool {
    result.outcome.events.iter().any(|event| INDICATORS[event.indicator] == name && !event.rising)
}

/// Ground at which the load of a prescribed motion starts at the piston position.
fn at(position: f64) -> StartValues {
    StartValues { position, pressure_a: 30e5, pressure_b: 30e5, ..StartValues::default() }
}

/// Hose rig with end stops.
fn hose_rig() -> Components {
    let contact = Contact { stiffness: 1e8, relative_damping: 0.5 };
    stopped(components(hose_line(), StiffnessModel::ByVolume), contact)
}

fn free_load() -> Load {
    Load::SpringMassDamper { mass: 5.0, stiffness: 0.0, damping: 300.0 }
}

/// A valve that is shut for half a minute: the pressures settle at the balance of leakage, without
/// any other motion.
#[test]
fn a_shut_valve_settles() {
    let machine = machine_of(benchmark_components(), &MachineOptions::default());
    let (result, outputs) = drive(machine, &at(0.25), 30.0, &[], Profile::constant(0.25));
    assert_eq!(result.outcome.status, Status::Completed);
    assert!(result.outcome.events.is_empty());
    let pressure = column(&outputs, Signal::PressureA);
    let [before, last] = [pressure[pressure.len() - 10], pressure[pressure.len() - 1]];
    // ORIGIN: analytic, thesis Table 5.1: p_A = p_S/(1 + (K_vin4/K_vin3)^2) where leakage in equals
    // leakage out
    assert!((last / (70e5 / (1.0 + (2.2_f64 / 2.35) * (2.2 / 2.35))) - 1.0).abs() < 1e-3);
    assert!((before - last).abs() < 1e-4 * last && result.outcome.work.steps < 2000);
}

/// Motion into the end stop at full command: the full supply pressure holds the piston there, which
/// is reported, and it returns.
#[test]
fn a_piston_meets_its_end_stops() {
    let rig = Components { load: free_load(), ..hose_rig() };
    let schedule = [(0.0, 10.0), (1.0, -10.0), (3.5, 0.0)];
    let machine = machine_of(rig, &MachineOptions::default());
    let (result, outputs) = drive(machine, &at(0.4), 4.0, &schedule, Profile::constant(0.4));
    assert_eq!(result.outcome.status, Status::Completed);
    assert!(happened(&result, "end_stop_b") && happened(&result, "end_stop_a"));
    let position = column(&outputs, Signal::Position);
    let [largest, least] =
        [position.iter().copied().fold(0.0, f64::max), position.iter().copied().fold(1.0, f64::min)];
    assert!(largest > 0.5 && largest < 0.501 && least < 0.0 && least > -0.001);
}

/// A load motion of 20 mm in 10 ms: chambers cavitate and are reported, not clamped, and the run
/// ends in time.
#[test]
fn violent_loads_are_survived() {
    let air = Some(EntrainedAir { volume_fraction: 0.01, polytropic_exponent: 1.4 });
    let rig = benchmark_components();
    let foamy = Components { fluid: Fluid { entrained_air: air, ..rig.fluid }, ..rig };
    let hose = components(hose_line(), StiffnessModel::ByVolume);
    let aerated =
        Components { fluid: Fluid { entrained_air: air, ..hose.fluid }, friction: rig.friction, ..hose };
    let ground = Profile::table(
        &[0.0, 0.1, 0.105, 0.11, 0.3, 0.305, 0.31, 0.5],
        &[0.25, 0.25, 0.26, 0.27, 0.27, 0.26, 0.25, 0.25],
    );
    let ground = ground.unwrap();
    for rig in [rig, foamy, hose, aerated] {
        let machine = machine_of(rig, &MachineOptions::default());
        let (result, outputs) = drive(machine, &at(0.25), 0.5, &[(0.0, 0.5)], ground.clone());
        assert_eq!(result.outcome.status, Status::Completed);
        assert!(column(&outputs, Signal::Force).iter().any(|force| force.abs() > 5e3));
        assert!(result.outcome.work.steps < 20_000, "{:?}", result.outcome.work);
    }
    let machine = machine_of(benchmark_components(), &MachineOptions::default());
    let start = StartValues { pressure_a: 2e5, pressure_b: 2e5, ..at(0.25) };
    let (result, _) = drive(machine, &start, 0.5, &[], ground);
    assert!(happened(&result, "cavitation_a") && happened(&result, "cavitation_b"));
}

/// A pump without flow, and a tank above the chambers: oil flows back, the loss is reported.
#[test]
fn lost_supplies_and_reversed_pressures_are_no_error() {
    let unit = PumpLimited {
        pump_flow: 0.0,
        relief_override: 5e5,
        volume: 5e-4,
        effective_bulk_modulus: 1e9,
        accumulator: None,
    };
    let power_unit = PowerUnit::PumpLimited(unit);
    let rig = Components { power_unit, load: free_load(), ..hose_rig() };
    let machine = machine_of(rig, &MachineOptions::default());
    let schedule = [(0.5, 5.0), (1.0, -5.0), (1.5, 0.0)];
    let (result, outputs) = drive(machine, &at(0.25), 3.0, &schedule, Profile::constant(0.25));
    assert_eq!(result.outcome.status, Status::Completed);
    let supply = column(&outputs, Signal::SupplyPressure);
    assert!(supply[0] > 60e5 && supply[supply.len() - 1] < 5e5);
    let reversed =
        Components { supply: Supply { pressure: 20e5, tank_pressure: 1e5 }, ..benchmark_components() };
    let start = StartValues { pressure_a: 60e5, pressure_b: 55e5, ..at(0.25) };
    let machine = machine_of(reversed, &MachineOptions::default());
    let (result, outputs) = drive(machine, &start, 1.0, &[(0.0, 0.05)], Profile::constant(0.25));
    assert_eq!(result.outcome.status, Status::Completed);
    let taken = column(&outputs, Signal::SupplyFlow);
    assert!(taken[0] < 0.0 && taken[taken.len() - 1] > 0.0);
}

/// A wall hit at speed pushes and never pulls, with every kind of friction and every imperfection
/// of the spool.
#[test]
fn walls_are_met_with_every_friction() {
    let Friction::LuGre(lugre) = benchmark_components().friction else { unreachable!() };
    let smoothed = Friction::Stribeck { curve: lugre.curve, regular_velocity: Some(1e-4) };
    let frictions = [Friction::Viscous { viscous: 100.0 }, smoothed, Friction::LuGre(lugre)];
    let load =
        Load::Wall { mass: Some(8.0), damping: 50.0, stiffness: 5e7, gap: 5e-3, relative_damping: 0.5 };
    let spool = SpoolImperfection {
        null_bias: 0.014,
        hysteresis_width: Some(0.128),
        threshold: Some(0.03),
        rate_limit: Some(3000.0),
    };
    for friction in frictions {
        let rig = components(hose_line(), StiffnessModel::ByVolume);
        let rig = Components { friction, valve: Servovalve { spool, ..rig.valve }, load, ..rig };
        let machine = machine_of(rig, &MachineOptions::default());
        let schedule = [(0.1, 2.0), (0.8, -2.0)];
        let (result, outputs) = drive(machine, &at(0.25), 1.5, &schedule, Profile::constant(0.25));
        assert_eq!(result.outcome.status, Status::Completed);
        assert!(happened(&result, "load_contact") && result.outcome.work.steps < 20_000);
        let force = column(&outputs, Signal::Force);
        assert!(force[500] > 5e3 && force[1000].abs() < 300.0, "{} {}", force[500], force[1000]);
    }
}
