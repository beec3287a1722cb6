//! A motor: equivalence to a cylinder on a lever, its stiffness, its leakage, and unlimited
//! rotation.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::ChamberGas;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::{Cylinder, chamber_volumes};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::{Friction, LuGre, Stribeck};
use phea_hydraulics::line::{Line, StiffeningMember};
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Accumulator, Machine, MachineOptions, PowerUnit, StartValues};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::plant::{LinearLoad, LinearPlant};
use phea_hydraulics::reference_rig::{benchmark_components, components, hose_line, leaking};
use phea_hydraulics::servovalve::SpoolDirection;
use phea_hydraulics::stiffness::{StiffnessModel, chamber_compliance, hydraulic_stiffness};
use phea_hydraulics::stroke::ActuatorStroke;
use phea_hydraulics::two_pressure::{TwoPressureModel, reduce, two_pressure_linear_parameters};

use super::machine_conservation::{Motion, check, check_instant, machine_of, random, step};
use super::rich_machines::{asymmetric, pump};

/// Lever arm in m.
const ARM: f64 = 0.04;

/// Double-rod cylinder with all options of a motor.
fn cylinder_rig() -> Components {
    let rig = benchmark_components();
    let contact = Contact { stiffness: 2e8, relative_damping: 0.2 };
    let cylinder = Cylinder {
        internal_leakage: Some(2e-13),
        dead_volume_a: 2e-5,
        dead_volume_b: 3e-5,
        end_stops: Some(contact),
        ..rig.cylinder
    };
    let outward = OutwardFlow { external_leakage: Some(1e-13), ..OutwardFlow::default() };
    Components { cylinder, outward, line_a: hose_line(), line_b: hose_line(), ..rig }
}

/// Motor equivalent to the cylinder with its rod on a lever: effects of load and friction at the
/// lever's end, seen at the shaft.
///
/// ```text
/// D = A r,   J = M r^2,   theta = x/r,   T = F r,   K_theta = K r^2,   f_theta = f r^2
/// ```
fn on_lever(rig: Components) -> Components {
    let Friction::LuGre(lugre) = rig.friction else { unreachable!() };
    let curve = Stribeck {
        coulomb: lugre.curve.coulomb * ARM,
        static_friction: lugre.curve.static_friction * ARM,
        stribeck_velocity: lugre.curve.stribeck_velocity / ARM,
        viscous: lugre.curve.viscous * ARM * ARM,
        ..lugre.curve
    };
    let cylinder = rig.cylinder;
    Components {
        cylinder: Cylinder {
            area_a: cylinder.area_a * ARM,
            area_b: cylinder.area_b * ARM,
            stroke: ActuatorStroke::Limited(cylinder.stroke.length().unwrap() / ARM),
            moving_mass: cylinder.moving_mass * ARM * ARM,
            end_stops: cylinder.end_stops.map(|stops| Contact {
                stiffness: stops.stiffness * ARM * ARM,
                relative_damping: stops.relative_damping * ARM,
            }),
            ..cylinder
        },
        friction: Friction::LuGre(LuGre {
            curve,
            bristle_stiffness: lugre.bristle_stiffness * ARM * ARM,
            bristle_damping: lugre.bristle_damping * ARM * ARM,
        }),
        force_sensor: ForceSensor { stiffness: rig.force_sensor.stiffness * ARM * ARM },
        ..rig
    }
}

fn close(one: f64, other: f64, what: &str) {
    assert!((one - other).abs() <= 1e-9 * one.abs().max(other.abs()), "{what}: {one} and {other}");
}

/// State of a machine after 0.2 s under a command and a sprung load: position, force, pressures.
fn driven(rig: Components, arm: f64) -> [f64; 4] {
    let load = Load::SpringMassDamper {
        mass: 20.0 * arm * arm,
        stiffness: 3e5 * arm * arm,
        damping: 200.0 * arm * arm,
    };
    let machine = machine_of(Components { load, ..rig }, &MachineOptions::default());
    let start =
        StartValues { position: 0.25 / arm, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    let mut state = beginning.state;
    let mut rates = |time: f64, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        let command = 1.5 * phea_dynamics::portable::sin(40.0 * time) + 0.5;
        machine.rates(state, command, &beginning.inputs, &mut rates);
        rates
    };
    for index in 0..10_000 {
        step(&mut state, f64::from(index) * 2e-5, 2e-5, &mut rates);
    }
    let signals = machine.signals(&state, &beginning.inputs);
    let [pressure_a, pressure_b] = signals.pressures;
    [signals.piston.position * arm, signals.force / arm, pressure_a, pressure_b]
}

#[test]
fn a_motor_moves_as_the_cylinder_on_its_lever() {
    let rig = cylinder_rig();
    let (linear, rotary) = (driven(rig, 1.0), driven(on_lever(rig), ARM));
    for (what, (one, other)) in ["x", "F", "p_A", "p_B"].iter().zip(linear.into_iter().zip(rotary)) {
        close(one, other, what);
    }
}

/// Parameters of the linear plant, and F_e/U_C over frequency.
fn plant(rig: Components, arm: f64) -> (LinearParameters, LinearPlant) {
    let actuator = Actuator::new(rig).unwrap();
    let load = SteadyLoad::Force(2e3 * arm);
    let point = operating_point(&actuator, 0.2 / arm, Condition::Load(load)).unwrap();
    let friction = 400.0 * arm * arm;
    let pressures = [point.pressure_a, point.pressure_b];
    let model = TwoPressureModel::new(&actuator, pressures, StiffeningMember::Nominal, friction);
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
    let (across, _) = actuator.components().cross_admittance(pressures);
    (reduce(&parameters), LinearPlant::of_two_pressures(&parameters, across, LinearLoad::Prescribed))
}

#[test]
fn its_linear_plant_is_that_of_the_cylinder_on_its_lever() {
    let rig = cylinder_rig();
    let ((linear, plant_linear), (rotary, plant_rotary)) = (plant(rig, 1.0), plant(on_lever(rig), ARM));
    close(linear.hydraulic_stiffness * ARM * ARM, rotary.hydraulic_stiffness, "K_H");
    close(linear.flow_pressure_coefficient, rotary.flow_pressure_coefficient, "K_c");
    close(linear.flow_gain, rotary.flow_gain, "K_qU");
    close(linear.useful_area * ARM, rotary.useful_area, "D");
    let of = |plant: &LinearPlant, frequency: f64| plant.coefficients().command.at_frequency(frequency);
    for frequency in [0.01, 1.0, 30.0, 300.0, 1300.0, 1e4] {
        let ratio = of(&plant_rotary, frequency) / of(&plant_linear, frequency) / ARM;
        assert!((ratio - 1.0).norm_sqr() < 1e-18, "{frequency}: {ratio}");
    }
}

/// K_theta = D^2 (1/C_A + 1/C_B), and C = V/beta of a chamber of steel.
#[test]
fn its_stiffness_is_that_of_its_oil() {
    let line = Line::Volume { volume: 1e-4, effective_bulk_modulus: 1e9 };
    let rig = components(line, StiffnessModel::ByVolume);
    let cylinder = Cylinder {
        stroke: ActuatorStroke::Unlimited,
        dead_volume_a: 5e-5,
        dead_volume_b: 8e-5,
        ..rig.cylinder
    };
    let lines = [&rig.line_a, &rig.line_b];
    let member = StiffeningMember::Nominal;
    let found = chamber_compliance(StiffnessModel::ByVolume, [1.45e9; 2], &cylinder, lines, member);
    let compliance = |dead: f64| dead / 1.45e9 + 1e-4 / 1e9;
    let displacement = cylinder.area_a;
    let expected = displacement * displacement * (1.0 / compliance(5e-5) + 1.0 / compliance(8e-5));
    for angle in [0.0, 3.0, -1e4] {
        close(hydraulic_stiffness(&found, angle), expected, "K_theta");
    }
    let over = found.over_stroke();
    close(over.minimum, over.maximum, "over every angle");
}

/// Oil through a motor with unlimited rotation leaves its chamber volumes unchanged, and its torque
/// turns it through hundreds of revolutions.
#[test]
fn turning_on_changes_no_volume() {
    let rig = on_lever(cylinder_rig());
    let turning = Cylinder { stroke: ActuatorStroke::Unlimited, end_stops: None, ..rig.cylinder };
    assert_eq!(chamber_volumes(&turning, 0.0), chamber_volumes(&turning, 1e5));
    let load = Load::SpringMassDamper { mass: 0.05, stiffness: 0.0, damping: 0.5 };
    let actuator = Actuator::new(Components { cylinder: turning, load, ..rig }).unwrap();
    let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
    let start = StartValues { pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    let mut state = beginning.state;
    let mut rates = |_: f64, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        machine.rates(state, 8.0, &beginning.inputs, &mut rates);
        rates
    };
    for index in 0..50_000 {
        step(&mut state, f64::from(index) * 5e-5, 5e-5, &mut rates);
    }
    let mut indicators = vec![0.0; machine.indicators()];
    machine.indicate(&state, &beginning.inputs, &mut indicators);
    let angle = machine.signals(&state, &beginning.inputs).piston.position;
    // no end is reached, and the compliance at this angle equals that at the start
    assert!(angle > 2.0 && indicators[2] > 0.0 && indicators[3] > 0.0, "{angle} {indicators:?}");
    let compliance = actuator.chamber_compliance([35e5, 30e5], StiffeningMember::Nominal);
    close(hydraulic_stiffness(&compliance, angle), hydraulic_stiffness(&compliance, 0.0), "K_theta");
    // linearisation and start are possible at every angle
    assert!(operating_point(&actuator, 1e4, Condition::Command(0.0)).is_ok());
}

/// Leakage to the tank stays in balance: the machine rests at the operating point.
#[test]
fn a_leaking_motor_rests_at_its_operating_point() {
    for external_leakage in [1e-14, 1e-12, 2e-11] {
        for internal_leakage in [None, Some(3e-13)] {
            let rig = on_lever(cylinder_rig());
            let cylinder = Cylinder { internal_leakage, ..rig.cylinder };
            let outward = OutwardFlow { external_leakage: Some(external_leakage), ..OutwardFlow::default() };
            let actuator = Actuator::new(Components { cylinder, outward, ..rig }).unwrap();
            let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
            for condition in [Condition::Command(0.2), Condition::Load(SteadyLoad::Force(50.0))] {
                let point = operating_point(&actuator, 3.0, condition).unwrap();
                let rest = machine.rest(&point).unwrap();
                close(rest.state[2], point.pressure_a, "p_A");
                close(rest.state[3], point.pressure_b, "p_B");
                assert!(point.net_flow_a.abs() < 1e-14 && point.net_flow_b.abs() < 1e-14, "{point:?}");
            }
        }
    }
}

/// Rigs that leak to the tank, and motors with unlimited rotation.
fn turning_machines() -> Vec<(&'static str, Machine)> {
    let rig = asymmetric();
    let of = |rig, power_unit| {
        machine_of(Components { power_unit, ..leaking(rig, 2e-12) }, &MachineOptions::default())
    };
    let gas = |gas_volume, precharge_pressure, polytropic_exponent| {
        Some(ChamberGas::from(Accumulator { gas_volume, precharge_pressure, polytropic_exponent }))
    };
    let at_chambers = |rig| Components { gas: [gas(2e-5, 8e5, 1.4), gas(5e-6, 3e5, 1.0)], ..rig };
    let vane = Components {
        outward: OutwardFlow { external_leakage: Some(2e-12), ..OutwardFlow::default() },
        ..rig
    };
    // a motor of this kind discharges on one side the flow that it takes in on the other
    let turning = Cylinder { area_b: rig.cylinder.area_a, stroke: ActuatorStroke::Unlimited, ..rig.cylinder };
    let motor = Components { cylinder: turning, ..vane };
    let air = Some(EntrainedAir { volume_fraction: 0.02, polytropic_exponent: 1.4 });
    let aerated = Components { fluid: Fluid { entrained_air: air, ..motor.fluid }, ..motor };
    vec![
        ("leakage to the tank", of(vane, pump())),
        ("a motor that turns on", of(motor, pump())),
        ("the same at a constant supply", of(motor, PowerUnit::Constant)),
        ("the same with air and gas", of(at_chambers(aerated), pump())),
    ]
}

/// Oil and energy accounts close to 1e-6 of their throughput, over a run; and at any state the
/// content changes by inflow and losses.
#[test]
fn its_ledgers_close() {
    let motion = Motion { amplitude: 1.5, bias: 0.2, ground: 0.0, ground_amplitude: 2e-3 };
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let mut seed = 7;
    for (name, machine) in turning_machines() {
        check(&machine, &motion, &start, 0.1, 1e-5);
        let beginning = machine.start(&start).unwrap();
        for _ in 0..20 {
            let around = beginning.state.iter().zip(machine.scales());
            let state: Vec<f64> = around.map(|(value, scale)| value + scale * random(&mut seed)).collect();
            let inputs = [0.25 + 0.2 * random(&mut seed), 0.1 * random(&mut seed)];
            check_instant(name, &machine, &state, random(&mut seed), inputs);
        }
    }
}
