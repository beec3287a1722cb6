//! Equations of the machine compared with separate formulations, its Jacobian with differences, and
//! its states of rest.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::{cosh, expm1, pow};
use phea_dynamics::scalar::{LANES, Lanes, Parameters};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::friction::{Friction, FrictionLevels, Stribeck};
use phea_hydraulics::line::{END_SHARE, LaminarFriction, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{
    Accumulator, INDICATORS, Machine, MachineError, MachineOptions, MachineSignals, PowerUnit, PumpLimited,
};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{
    benchmark_components, components, cylinder, hose_line, leaking, measured_spool, pipe_line, stopped,
};
use phea_hydraulics::servovalve::{Servovalve, SpoolImperfection};
use phea_hydraulics::stiffness::StiffnessModel;

/// Uniform numbers from -1 to 1, identical on every machine.
pub(super) struct Noise(pub(super) u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn machine_of(components: Components, options: &MachineOptions) -> Machine {
    Machine::new(&Actuator::new(components).unwrap(), options).unwrap()
}

pub(super) fn rates_of(machine: &Machine, state: &[f64], command: f64, inputs: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; state.len()];
    machine.rates(state, command, inputs, &mut rates);
    rates
}

fn pump() -> PumpLimited {
    let accumulator = Accumulator { gas_volume: 1e-3, precharge_pressure: 40e5, polytropic_exponent: 1.3 };
    PumpLimited {
        pump_flow: 1.633e-4,
        relief_override: 5e5,
        volume: 5e-4,
        effective_bulk_modulus: 1e9,
        accumulator: Some(accumulator),
    }
}

/// Components with all imperfections of the spool, a pump, leakage, end stops and a wall.
fn full(components: Components) -> Components {
    let spool = SpoolImperfection { threshold: Some(0.04), rate_limit: Some(4000.0), ..measured_spool() };
    let valve = Servovalve { spool, ..components.valve };
    let contact = Contact { stiffness: 1e8, relative_damping: 0.3 };
    let power_unit = PowerUnit::PumpLimited(pump());
    let Contact { stiffness, relative_damping } = contact;
    let load = Load::Wall { mass: Some(8.0), damping: 50.0, stiffness, gap: 2e-3, relative_damping };
    stopped(leaking(Components { valve, power_unit, load, ..components }, 3e-13), contact)
}

fn hose() -> Components {
    components(hose_line(), StiffnessModel::ByVolume)
}

/// Unequal areas and lines, air, and a static friction curve that differs by direction, smoothed by
/// this velocity in m/s.
fn asymmetric(regular_velocity: f64) -> Components {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    let air = Some(EntrainedAir { volume_fraction: 0.02, polytropic_exponent: 1.4 });
    let curve = Stribeck {
        coulomb: 80.0,
        static_friction: 120.0,
        stribeck_velocity: 0.01,
        stribeck_exponent: 1.4,
        viscous: 100.0,
        retracting: Some(FrictionLevels { coulomb: 95.0, static_friction: 160.0, viscous: 140.0 }),
    };
    Components {
        fluid: Fluid { entrained_air: air, ..hose().fluid },
        cylinder: Cylinder { area_a, area_b, dead_volume_a: 2e-5, dead_volume_b: 1e-5, ..cylinder() },
        line_b: pipe_line(),
        friction: Friction::Stribeck { curve, regular_velocity: Some(regular_velocity) },
        ..hose()
    }
}

/// Rigs with all possible options, on very different actuators.
pub(super) fn machines() -> Vec<Machine> {
    let plain = MachineOptions::default();
    let without_gas = PumpLimited { accumulator: None, ..pump() };
    let sprung = Components {
        power_unit: PowerUnit::PumpLimited(without_gas),
        load: Load::SpringMassDamper { mass: 20.0, stiffness: 3e6, damping: 200.0 },
        ..asymmetric(1e-4)
    };
    let rough = Components { friction: benchmark_components().friction, ..hose() };
    let uniform = Components { stiffness_model: StiffnessModel::Uniform, ..asymmetric(1e-3) };
    let waves = LineModel::TransmissionLine { end_share: END_SHARE };
    let friction = LaminarFriction::Steady;
    let segments = LineModel::Segments { count: 2, friction, relaxation_time: None };
    vec![
        machine_of(benchmark_components(), &plain),
        machine_of(hose(), &plain),
        machine_of(full(rough), &plain),
        machine_of(sprung, &plain),
        machine_of(full(uniform), &plain),
        machine_of(Components { line_models: [waves, segments], ..hose() }, &plain),
        machine_of(Components { line_models: [segments, waves], ..full(rough) }, &plain),
    ]
}

/// State, command and inputs.
type Instant = (Vec<f64>, f64, Vec<f64>);

/// State within some hundred scales of a working point, with command and inputs to match.
pub(super) fn some_state(machine: &Machine, noise: &mut Noise) -> Instant {
    let mut state: Vec<f64> = machine.scales().iter().map(|scale| scale * 2.0 * noise.next()).collect();
    state[2] = 35e5 + 25e5 * noise.next();
    state[3] = 35e5 + 25e5 * noise.next();
    for (value, scale) in state.iter_mut().zip(machine.scales()).skip(6) {
        if scale == machine.scales()[2] {
            *value = 60e5 + 15e5 * noise.next();
        }
    }
    let mut inputs = vec![0.25 + 0.2 * noise.next(), 0.05 * noise.next()];
    inputs.extend((2..machine.inputs()).map(|_| 35e5 + 25e5 * noise.next()));
    (state, 8.0 * noise.next(), inputs)
}

/// The benchmark's equations in another form: pressures by moduli and volumes, flows by signed
/// roots, hyperbolic cosine.
fn benchmark_rates(state: &[f64], command: f64, inputs: &[f64]) -> [f64; 7] {
    let &[voltage, rate, p_a, p_b, deflection, v, z] = state else { unreachable!() };
    let root = |drop: f64| drop.signum() * (drop * drop / (drop * drop + 1e6).sqrt()).sqrt();
    let leak = 1.0 / cosh(10.0 * voltage);
    let [open, close] = [voltage.max(0.0) / 10.0, (-voltage).max(0.0) / 10.0];
    let q_a =
        (3.2e-7 * open + 2.35e-9 * leak) * root(7e6 - p_a) - (2.5e-7 * close + 2.2e-9 * leak) * root(p_a);
    let q_b =
        (2.0e-7 * close + 1.7e-9 * leak) * root(7e6 - p_b) - (3.85e-7 * open + 2.35e-9 * leak) * root(p_b);
    let x = inputs[0] + deflection;
    let area = 1.583e-3;
    let slide = 120.0 + 40.0 * expm1(-v * v / 1e-4);
    let z_rate = v * (1.0 - 1e7 * z * v.signum() / slide);
    let friction = 1e7 * z + 2e3 * z_rate + 100.0 * v;
    [
        rate,
        1099.0 * (1099.0 * (command - voltage) - 1.8 * rate),
        2.6e8 * (q_a - area * v) / (1.9e-4 + area * x),
        2.6e8 * (q_b + area * v) / (1.9e-4 + area * (0.5 - x)),
        v - inputs[1],
        (area * p_a - area * p_b - friction - 2e7 * deflection) / 13.1,
        z_rate,
    ]
}

#[test]
fn the_benchmark_is_the_text_of_its_equations() {
    let machine = machine_of(benchmark_components(), &MachineOptions::default());
    let mut noise = Noise(1);
    for _ in 0..300 {
        let (state, command, inputs) = some_state(&machine, &mut noise);
        let rates = rates_of(&machine, &state, command, &inputs);
        for (index, (found, expected)) in
            rates.iter().zip(benchmark_rates(&state, command, &inputs)).enumerate()
        {
            let scale = expected.abs().max(machine.scales()[index]);
            assert!((found - expected).abs() < 1e-11 * scale, "{index}: {found} against {expected}");
        }
    }
}

/// A machine with all options, in another form: one side at a time, forces and flows case by case.
fn full_rates(state: &[f64], command: f64, inputs: &[f64]) -> [f64; 12] {
    let &[u, r, p_a, p_b, d, v, z, way, v_l, p_s, f, lag] = state else { unreachable!() };
    let spool_rate = r.clamp(-4000.0, 4000.0);
    let opening = u - 0.014 - lag;
    let root = |drop: f64| drop.signum() * (drop * drop / (drop * drop + 1e6).sqrt()).sqrt();
    let leak = 1.0 / cosh(10.0 * opening);
    let edge = |flow: f64, open: f64, leakage: f64| flow * open.max(0.0) / 10.0 + leakage * leak;
    let from_s =
        [edge(3.2e-7, opening, 2.35e-9) * root(p_s - p_a), edge(2.0e-7, -opening, 1.7e-9) * root(p_s - p_b)];
    let to_t = [edge(2.5e-7, -opening, 2.2e-9) * root(p_a), edge(3.85e-7, opening, 2.35e-9) * root(p_b)];
    let across = 3e-13 * (p_a - p_b);
    let x = inputs[0] + way + d;
    let oil = std::f64::consts::FRAC_PI_4 * 12.7e-3 * 12.7e-3 + 1.56e-5 - 2.236e-12 * 35e5;
    let hose = 1.5 * (2.236e-12 / 5.0 + oil / 1.45e9);
    let area = std::f64::consts::PI / 4.0 * (0.05 * 0.05 - 0.022 * 0.022);
    let compliance = |length: f64| hose + area * length / 1.45e9;
    let slide = 120.0 + 40.0 * expm1(-v * v / 1e-4);
    let z_rate = v * (1.0 - 1e7 * z * v.signum() / slide);
    let contact = |depth: f64, rate: f64| {
        if depth > 0.0 && 1.0 + 0.3 * rate > 0.0 { 1e8 * depth * (1.0 + 0.3 * rate) } else { 0.0 }
    };
    let friction = 1e7 * z + 2e3 * z_rate + 100.0 * v;
    let pushing = area * p_a - area * p_b - friction - 2e7 * d + contact(-x, -v) - contact(x - 0.5, v);
    let closing = v_l - inputs[1];
    let tare = 7.55e-6 * root(p_s) / root(70e5);
    let relief = if p_s > 65e5 { 1.633e-4 * (p_s - 65e5) / 5e5 } else { 0.0 };
    let (empty, lift) = (40e5 + 101325.0, 0.01 * (40e5 + 101325.0));
    let lifted = ((p_s - 40e5 + lift) / (2.0 * lift)).clamp(0.0, 1.0);
    let full = empty + if p_s > 40e5 + lift { p_s - 40e5 } else { lift * lifted * lifted };
    let stored = 5e-4 / 1e9 + lifted * 1e-3 * pow(empty / full, 1.0 / 1.3) / (1.3 * full);
    [
        spool_rate,
        1099.0 * (1099.0 * (command.clamp(-10.0, 10.0) - u - f) - 1.8 * r),
        (from_s[0] - to_t[0] - across - area * v) / compliance(x),
        (from_s[1] - to_t[1] + across + area * v) / compliance(0.5 - x),
        v - v_l,
        pushing / 13.1,
        z_rate,
        closing,
        (2e7 * d - contact(way - 2e-3, closing) - 50.0 * closing) / 8.0,
        (1.633e-4 - relief - from_s[0] - from_s[1] - tare) / stored,
        20.0 * (spool_rate - spool_rate.abs() * f / 0.02),
        0.5 * (spool_rate - spool_rate.abs() * lag / 0.044),
    ]
}

#[test]
fn a_machine_with_everything_is_the_text_of_its_equations() {
    let machine = machines()[2];
    let mut noise = Noise(11);
    let mut contacts = 0;
    for index in 0..600 {
        let (mut state, command, mut inputs) = some_state(&machine, &mut noise);
        // everywhere, in the stops, and at the wall
        let position = [0.25 + 0.2 * noise.next(), 1e-4 * noise.next(), 0.5 + 1e-4 * noise.next()][index % 3];
        state[7] = 2e-3 + 1e-4 * noise.next();
        state[9] = 55e5 + 20e5 * noise.next();
        inputs[0] = position - state[7];
        let rates = rates_of(&machine, &state, 1.5 * command, &inputs);
        let mut indicators = [0.0; INDICATORS.len()];
        machine.indicate(&state, &inputs, &mut indicators);
        contacts += usize::from(indicators[2].min(indicators[3]) < 0.0 && indicators[6] < 0.0);
        for (index, (found, expected)) in
            rates.iter().zip(full_rates(&state, 1.5 * command, &inputs)).enumerate()
        {
            let scale = expected.abs().max(machine.scales()[index]);
            assert!((found - expected).abs() < 1e-10 * scale, "{index}: {found} against {expected}");
        }
    }
    assert!(contacts > 50);
}

/// Forces that a machine reports accelerate its piston: M dv/dt = F_H + F_stops - F_fr - F_e.
#[test]
fn recorded_forces_accelerate_the_piston() {
    let mut stopped = 0;
    for machine in machines() {
        let mut noise = Noise(23);
        for index in 0..150 {
            let (state, command, mut inputs) = some_state(&machine, &mut noise);
            inputs[0] = [inputs[0], 0.0, 0.5][index % 3];
            let accelerating = cylinder().moving_mass * rates_of(&machine, &state, command, &inputs)[5];
            let MachineSignals { hydraulic_force, end_stops, friction, force, .. } =
                machine.signals(&state, &inputs);
            let found = hydraulic_force + end_stops - friction - force;
            let scale = [hydraulic_force, end_stops, friction, force].map(f64::abs).iter().sum::<f64>();
            assert!((found - accelerating).abs() < 1e-12 * scale, "{found} N against {accelerating} N");
            stopped += usize::from(end_stops != 0.0);
        }
    }
    assert!(stopped > 20, "{stopped}");
}

/// Machines at an operating point do not move, for any of their options.
#[test]
fn rests_do_not_move() {
    for machine in machines() {
        let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume)).unwrap();
        for (position, command) in [(0.1, 0.02), (0.25, 0.05), (0.4, 0.4)] {
            let point = operating_point(&actuator, position, Condition::Command(command)).unwrap();
            let rest = machine.rest(&point).unwrap();
            let inputs = rest.all_inputs();
            let rates = rates_of(&machine, &rest.state, rest.command, &inputs);
            for (rate, scale) in rates.iter().zip(machine.scales()) {
                assert!((rate / scale).abs() < 1e-5, "{rates:?}");
            }
            let mut sent = vec![f64::NAN; rest.waves.len()];
            machine.outgoing(&rest.state, &inputs, &mut sent);
            assert!(sent.iter().zip(&rest.waves).all(|(sent, wave)| (sent / wave - 1.0).abs() < 1e-9));
            let outputs = machine.signals(&rest.state, &inputs);
            let (at, opening) = (outputs.piston.position, outputs.opening);
            assert!((at - position).abs() < 1e-15 && (opening - command).abs() < 1e-15);
        }
    }
    for machine in machines() {
        let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume)).unwrap();
        let point = operating_point(&actuator, 0.25, Condition::Load(SteadyLoad::Force(0.0))).unwrap();
        let idle = machine.rest_under_load(&point).unwrap();
        let force = machine.measurement(&idle.state, &idle.all_inputs());
        assert!(force.abs() < 1e-6 && idle.command.abs() < 0.5, "{force} {}", idle.command);
    }
    let sliding = machine_of(benchmark_components(), &MachineOptions::default());
    let actuator = Actuator::new(benchmark_components()).unwrap();
    let point = operating_point(&actuator, 0.2, Condition::Motion(1.0, SteadyLoad::Force(500.0))).unwrap();
    let steady = sliding.rest(&point).unwrap();
    let rates = rates_of(&sliding, &steady.state, steady.command, &steady.inputs);
    assert!(point.velocity > 0.01 && rates.iter().zip(sliding.scales()).all(|(r, s)| (r / s).abs() < 1e-5));
}

#[test]
fn starts_that_cannot_be_are_refused() {
    let actuator = Actuator::new(benchmark_components()).unwrap();
    let machine = machine_of(benchmark_components(), &MachineOptions::default());
    let matched = operating_point(&actuator, 0.2, Condition::Matched(1.0, 10e5)).unwrap();
    // the balance found for this command is steady, although the point was not
    let rest = machine.rest(&matched).unwrap();
    assert!(rest.state[2] != matched.pressure_a);
    let outside = phea_hydraulics::machine::StartValues { position: 0.6, ..Default::default() };
    assert!(matches!(machine.start(&outside), Err(MachineError::StartOutsideStroke { .. })));
    let vacuum = phea_hydraulics::machine::StartValues { pressure_a: -2e5, ..Default::default() };
    assert!(matches!(
        machine.start(&vacuum),
        Err(MachineError::ImpossibleStart { quantity: "pressure_a", .. })
    ));
    let rough = Components { friction: static_friction(None), ..benchmark_components() };
    let refused = Machine::new(&Actuator::new(rough).unwrap(), &MachineOptions::default());
    assert_eq!(refused, Err(MachineError::StaticFriction));
    let soft = Contact { stiffness: 1e4, relative_damping: 0.0 };
    let soft = Actuator::new(stopped(hose(), soft)).unwrap();
    assert!(matches!(
        Machine::new(&soft, &MachineOptions::default()),
        Err(MachineError::ChamberVanishes { .. })
    ));
    let spool = SpoolImperfection { threshold: Some(0.2), hysteresis_width: Some(0.1), ..Default::default() };
    let (valve, friction) = (Servovalve { spool, ..hose().valve }, static_friction(Some(-1.0)));
    let narrow = Components { valve, friction, ..hose() };
    assert_eq!(Actuator::new(narrow).unwrap_err().problems.len(), 2);
    assert!(Actuator::new(leaking(hose(), -1.0)).is_err());
}

fn static_friction(regular_velocity: Option<f64>) -> Friction {
    let Friction::LuGre(lugre) = benchmark_components().friction else { unreachable!() };
    Friction::Stribeck { curve: lugre.curve, regular_velocity }
}

/// Lanes compute the result of each separate machine, bit for bit.
#[test]
fn lanes_are_machines_side_by_side() {
    for machine in machines() {
        let machines = [1.0, 1.01, 0.99, 1.02].map(|factor| machine.convert(&mut |value| factor * value));
        let mut all = machine.convert(&mut |value: f64| Lanes::from(value));
        for (lane, one) in machines.iter().enumerate() {
            all.put(lane, one).unwrap();
        }
        let mut noise = Noise(3);
        let starts = [(); LANES].map(|()| some_state(&machine, &mut noise));
        let side_by_side = |of: &dyn Fn(&Instant) -> f64| Lanes(starts.each_ref().map(of));
        let count = machine.states();
        let state: Vec<Lanes> = (0..count).map(|index| side_by_side(&|start| start.0[index])).collect();
        let inputs: Vec<Lanes> =
            (0..machine.inputs()).map(|index| side_by_side(&|start| start.2[index])).collect();
        let mut rates = vec![Lanes::from(f64::NAN); count];
        all.rates(&state, side_by_side(&|start| start.1), &inputs, &mut rates);
        for (lane, single) in machines.iter().enumerate() {
            let (state, command, inputs) = &starts[lane];
            for (found, expected) in rates.iter().zip(rates_of(single, state, *command, inputs)) {
                assert_eq!(found.0[lane].to_bits(), expected.to_bits());
            }
        }
    }
}

/// Parameters of the valve enter the equations.
#[test]
fn saturation_is_that_of_the_valve() {
    let valve = Servovalve { nominal_voltage: 5.0, ..benchmark_components().valve };
    let machine = machine_of(Components { valve, ..benchmark_components() }, &MachineOptions::default());
    let state = [0.0, 0.0, 35e5, 35e5, 0.0, 0.0, 0.0];
    let at = |command| rates_of(&machine, &state, command, &[0.25, 0.0])[1];
    assert!(at(7.0) == at(5.0) && at(-9.0) == at(-5.0) && at(4.0) < at(5.0));
}
