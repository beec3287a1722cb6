//! The linear plant compared with the machine's own derivatives, and with the models that it
//! generalises.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::portable::pow;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::small_signal;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::linear::linear_model_coefficients;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{InitialCondition, Machine, MachineOptions, PowerUnit};
use phea_hydraulics::operating_point::{Balance, Condition, OperatingPoint, Steady, operating_point};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::plant::{LinearLoad, LinearPlant};
use phea_hydraulics::port_valves::{PortValves, TankValve};
use phea_hydraulics::reference_rig::{components, cylinder, hose_line, leaking, nominal_plant, pipe_line};
use phea_hydraulics::servovalve::{LeakageModel, Servovalve, SpoolDirection, Supply};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::{ActuatorStroke, PistonStage, Telescope};
use phea_hydraulics::two_pressure::{
    TwoPressureLinearParameters, TwoPressureModel, two_pressure_coefficients, two_pressure_linear_parameters,
};

use super::commanded::{
    Commanded, chamber_gas, cross_port, power_unit, supply_pressure, without_branches, yielding,
};

/// Rig for every number, with all options that lumped lines allow in the plant.
struct Drawn {
    actuator: Actuator,
    machine: Machine,
    rest: InitialCondition,
    friction: f64,
    load: LinearLoad,
}

/// Some rotate without limit, and some are telescopic, mostly within a transition.
fn turning(cylinder: Cylinder, number: u64) -> Cylinder {
    let stroke = match number % 9 {
        4 => ActuatorStroke::Unlimited,
        2 | 7 => ActuatorStroke::Telescopic(telescope(number)),
        _ => cylinder.stroke,
    };
    Cylinder { stroke, ..cylinder }
}

/// Relief and check valves of both chambers, shut, open or within their transition at rest.
pub(super) fn port_valves(number: u64) -> [Option<PortValves>; 2] {
    let mut state = stream(77, number);
    [0, 1].map(|_| {
        let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
        let relief = TankValve { cracking_pressure: spread(5e5, 80e5), conductance: spread(1e-13, 1e-10) };
        let check = TankValve { cracking_pressure: spread(1e4, 5e5), conductance: spread(1e-13, 1e-10) };
        let transition_pressure = spread(1e4, relief.cracking_pressure);
        match spread(1.0, 16.0) {
            drawn if drawn < 4.0 => None,
            drawn if drawn < 8.0 => {
                Some(PortValves { relief: Some(relief), check: None, transition_pressure })
            }
            _ => Some(PortValves { relief: Some(relief), check: Some(check), transition_pressure }),
        }
    })
}

/// Three stages with long transitions.
pub(super) fn telescope(number: u64) -> Telescope {
    let mut state = stream(13, number);
    let mut ratio = || 0.4 + 0.9 * uniform(&mut state);
    let mut stage = |from: f64| Some(PistonStage { from, ratios: [ratio(), ratio()] });
    Telescope { stroke: 0.5, stages: [stage(0.15), stage(0.35), None], transition: 0.18 }
}

fn drawn(number: u64) -> Drawn {
    let mut state = stream(11, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let friction = spread(50.0, 2e4);
    let air = (number.is_multiple_of(3))
        .then(|| EntrainedAir { volume_fraction: spread(1e-3, 3e-2), polytropic_exponent: spread(1.0, 1.4) });
    let rods = [0.022, spread(0.01, 0.036)];
    let [area_a, area_b] = rods.map(|rod| annulus_area(0.05, rod));
    let line_b = if number.is_multiple_of(2) { hose_line() } else { pipe_line() };
    let model = if number % 5 < 2 { StiffnessModel::Uniform } else { StiffnessModel::ByVolume };
    let reference = components(hose_line(), model);
    let leakage_model = if number % 7 < 4 { LeakageModel::EachEdge } else { LeakageModel::OneCurve };
    let parts = Components {
        fluid: Fluid { entrained_air: air, ..reference.fluid },
        cylinder: Cylinder { area_a, area_b, moving_mass: spread(2.0, 80.0), ..cylinder() },
        line_b,
        valve: Servovalve { leakage_model, ..reference.valve },
        friction: Friction::Viscous { viscous: friction },
        force_sensor: ForceSensor { stiffness: spread(1e6, 1e8) },
        ..reference
    };
    // every fifth leaks to the tank, and some have relief and check valves
    let external_leakage = (number % 5 == 3).then_some(1e-14 * pow(1e3, number as f64 / 300.0));
    let outward = OutwardFlow { external_leakage, port_valves: port_valves(number) };
    let parts = Components { cylinder: turning(parts.cylinder, number), outward, ..parts };
    let (mass, stiffness, damping) = (spread(1.0, 500.0), spread(1e4, 1e8), spread(10.0, 1e4));
    let leakage = if number % 4 == 1 { 0.0 } else { spread(1e-14, 1e-10) };
    let relative_damping = spread(0.01, 1.0);
    let load = match number % 3 {
        0 => Load::Prescribed,
        1 => Load::SpringMassDamper { mass, stiffness, damping },
        _ => Load::Wall { mass: Some(mass), damping, stiffness, gap: 1e-3, relative_damping },
    };
    let parts = if leakage > 0.0 { leaking(parts, leakage) } else { parts };
    let parts = Components {
        gas: chamber_gas(12, number),
        cross_port: cross_port(number),
        power_unit: power_unit(number),
        load,
        ..parts
    };
    let actuator = Actuator::new(parts).unwrap();
    let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
    let (position, command) = (spread(0.05, 0.45), spread(0.01, 2.0));
    // a wall cannot pull: the next command pushes harder
    let rests = (0..20).map(|step| {
        let condition = Condition::Command(command + 0.4 * f64::from(step));
        machine.rest(&operating_point(&actuator, position, condition).unwrap())
    });
    let rest = rests.flatten().next().unwrap();
    // the wall is pressed by K d_0, and its damping grows with this force
    let pressed = rest.state[4] * actuator.components().force_sensor.stiffness / stiffness;
    let load = match load {
        Load::Prescribed => LinearLoad::Prescribed,
        Load::SpringMassDamper { .. } => LinearLoad::Yielding { mass, damping, stiffness },
        Load::Wall { .. } => {
            let damping = damping + stiffness * relative_damping * pressed;
            LinearLoad::Yielding { mass, damping, stiffness }
        }
    };
    Drawn { actuator, machine, rest, friction, load }
}

/// Operating point of a machine that rests in this state, its piston at a position in m.
pub(super) fn point_at(position: f64, state: &[f64]) -> OperatingPoint {
    OperatingPoint {
        position,
        command: state[0],
        pressure_a: state[2],
        pressure_b: state[3],
        velocity: 0.0,
        hydraulic_force: 0.0,
        net_flow_a: 0.0,
        net_flow_b: 0.0,
    }
}

/// Plant of an actuator at the rest of its machine, its piston at a position in m, and the
/// compliances of its chambers with lumped lines; the pressures in Pa at the valve's ports are
/// those of the chambers or slightly different.
pub(super) fn plant_at_rest(
    actuator: &Actuator,
    machine: &Machine,
    (position, ports, state): (f64, [f64; 2], &[f64]),
    load: LinearLoad,
) -> (LinearPlant, [f64; 2]) {
    let components = actuator.components();
    let (pressures, stated) = ([state[2], state[3]], components.supply);
    let supplied = supply_pressure(machine, stated.pressure, state);
    let friction = components.friction.viscous();
    let model = TwoPressureModel {
        supply: Supply { pressure: supplied, ..stated },
        ..TwoPressureModel::new(actuator, pressures, StiffeningMember::Nominal, friction)
    };
    let [pressure_a, pressure_b] = ports;
    let point = OperatingPoint { pressure_a, pressure_b, ..point_at(position, state) };
    let model = TwoPressureModel { outward: None, ..model };
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Extending);
    // at the cylinder, and not at the ports of the valve
    let outward = components.outward.if_present();
    let outward = outward.map(|outward| outward.slopes(pressures, stated.tank_pressure));
    let chambers = parameters.chambers.leaking(outward);
    let parameters = TwoPressureLinearParameters { chambers, ..parameters };
    let supply = yielding(actuator, state[0], ports, supplied);
    let (across, dynamic_feedback) = components.cross_admittance(pressures);
    let gas = components.gas_branches(pressures);
    let compliances = without_branches(components, pressures, parameters.compliances);
    let parameters = TwoPressureLinearParameters { compliances, ..parameters };
    let plant = LinearPlant::of_two_pressures(&parameters, across, load);
    let area_stiffness = components.cylinder.area_stiffness(position, pressures);
    (LinearPlant { supply, dynamic_feedback, gas, area_stiffness, ..plant }, compliances)
}

impl Drawn {
    /// Plant at the rest of the machine.
    fn plant(&self) -> LinearPlant {
        let state = &self.rest.state;
        let moved = if self.load == LinearLoad::Prescribed { 0.0 } else { state[6] };
        let position = self.rest.inputs[0] + moved + state[4];
        let pressures = [state[2], state[3]];
        plant_at_rest(&self.actuator, &self.machine, (position, pressures, state), self.load).0
    }

    /// Paths F_e/U_C and F_e/X_0 from the machine's own derivatives.
    fn small_signal(&self, feed_forward: f64, frequency: f64) -> [Complex64; 2] {
        let inputs = [&[self.rest.command], &self.rest.inputs[..]].concat();
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        let ground = [zero, one, Complex64::new(0.0, frequency)];
        [[one, zero, zero], ground].map(|drive| {
            let system = Commanded(self.machine, feed_forward);
            let amplitudes = small_signal(&system, &self.rest.state, &inputs, &drive, frequency).unwrap();
            amplitudes[4] * self.actuator.components().force_sensor.stiffness
        })
    }
}

/// 300 rigs at 20 frequencies, from a hundredth of a slow pole to ten times the valve's.
#[test]
fn it_is_the_machine_for_small_motions() {
    for number in 0..300 {
        let rig = drawn(number);
        // every other rig feeds the velocity of its load forward, with gains from a thousandth to
        // three times the one that holds the force
        let feed_forward =
            if number.is_multiple_of(2) { 0.03 * pow(3e3, number as f64 / 300.0) } else { 0.0 };
        let fed = (feed_forward > 0.0).then_some(feed_forward);
        let coefficients = LinearPlant { load_velocity_feed_forward: fed, ..rig.plant() }.coefficients();
        let disturbance = coefficients.disturbance.unwrap();
        for step in 0..20 {
            let frequency = 1e-3 * pow(1e7, f64::from(step) / 19.0);
            let [command, ground] = rig.small_signal(feed_forward, frequency);
            for (found_response, own) in [(&coefficients.command, command), (&disturbance, ground)] {
                let error = (found_response.at_frequency(frequency) / own - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-7, "rig {number} at {frequency} rad/s: {error}");
            }
        }
    }
}

/// A limited pump is in equilibrium where the machine rests, if the pump delivers the flow taken
/// there; the pressure of the others has fallen lower.
#[test]
fn a_limited_pump_settles_where_the_machine_rests() {
    let mut counted = [0, 0];
    for number in 0..300 {
        let rig = drawn(number);
        let components = rig.actuator.components();
        let PowerUnit::PumpLimited(unit) = components.power_unit else { continue };
        let idle = components.supply.pressure;
        // at standstill the areas have no effect
        let balance = Balance::at(components, 0.25);
        let found = balance.settled_supply(&unit, Steady::Command(rig.rest.state[0]));
        let rests = supply_pressure(&rig.machine, f64::NAN, &rig.rest.state);
        if found.taken < unit.pump_flow {
            assert!((found.supply.pressure / rests - 1.0).abs() < 1e-9, "rig {number}: {found:?} {rests}");
            for (own, rests) in found.settled.pressures.into_iter().zip(&rig.rest.state[2..4]) {
                assert!((own - rests).abs() < 1e-8 * idle, "rig {number}: {own} {rests}");
            }
        } else {
            assert_eq!(found.supply.pressure, idle - unit.relief_override);
            assert!(rests < found.supply.pressure, "rig {number}: {found:?} {rests}");
        }
        counted[usize::from(found.taken < unit.pump_flow)] += 1;
    }
    assert!(counted.iter().all(|count| *count > 10), "{counted:?}");
}

/// The plant without leakage and with a prescribed load equals the model from which it is built,
/// coefficient by coefficient.
#[test]
fn without_load_and_leakage_it_is_the_known_models() {
    let of_load_pressure = LinearPlant::of_load_pressure(&nominal_plant(), 0.0, LinearLoad::Prescribed);
    let rig = drawn(0);
    let state = &rig.rest.state;
    let model =
        TwoPressureModel::new(&rig.actuator, [state[2], state[3]], StiffeningMember::Nominal, rig.friction);
    let point = operating_point(&rig.actuator, 0.2, Condition::Command(0.3)).unwrap();
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Extending);
    let of_two_pressures = LinearPlant::of_two_pressures(&parameters, 0.0, LinearLoad::Prescribed);
    for (plant, known) in [
        (of_load_pressure.coefficients(), linear_model_coefficients(&nominal_plant())),
        (of_two_pressures.coefficients(), two_pressure_coefficients(&parameters)),
    ] {
        let (load, known_load) = (plant.disturbance.unwrap(), known.disturbance.unwrap());
        for (own, known) in [
            (&plant.command.numerator, &known.command.numerator),
            (&plant.command.denominator, &known.command.denominator),
            (&load.numerator, &known_load.numerator),
            (&load.denominator, &known_load.denominator),
        ] {
            let scale = own[0] / known[0];
            assert_eq!(own.len(), known.len());
            assert!(
                own.iter().zip(known).all(|(own, known)| (own - scale * known).abs() <= 1e-12 * own.abs())
            );
        }
    }
}

/// Equal chambers: one load pressure is sufficient, leakage included.
#[test]
fn equal_chambers_need_one_pressure() {
    let actuator = Actuator::new(Components {
        valve: phea_hydraulics::reference_rig::valve_with_equal_edges(),
        ..components(hose_line(), StiffnessModel::ByVolume)
    })
    .unwrap();
    let point = operating_point(&actuator, 0.25, Condition::Command(0.0)).unwrap();
    let model = TwoPressureModel::new(
        &actuator,
        [point.pressure_a, point.pressure_b],
        StiffeningMember::Nominal,
        100.0,
    );
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
    let load = LinearLoad::Yielding { mass: 100.0, damping: 500.0, stiffness: 2e5 };
    let reduced = phea_hydraulics::two_pressure::reduce(&parameters);
    let one = LinearPlant::of_load_pressure(&reduced, 1e-11, load).coefficients().command;
    let two = LinearPlant::of_two_pressures(&parameters, 1e-11, load).coefficients().command;
    for frequency in [1e-3, 0.1, 5.0, 40.0, 300.0, 1300.0, 2e4] {
        assert!((one.at_frequency(frequency) / two.at_frequency(frequency) - 1.0).norm_sqr() < 1e-24);
    }
}
