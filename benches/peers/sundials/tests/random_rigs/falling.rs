//! Rigs whose friction falls with the velocity in some range, and whose load moves so slowly that
//! the piston passes through that range.
//!
//! Where dF/dv is negative, friction feeds the ringing of piston and load cell:
//!
//! ```text
//! F(v) = F_c + (F_s - F_c) exp(-|v/v_s|^n) + b v,        dF/dv >= -0.86 (F_s - F_c)/v_s + b       (n = 2)
//! ```

use phea_dynamics::controller::AntiWindup;
use phea_dynamics::simulation::Profile;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::fluid::Fluid;
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::{Friction, LuGre, Stribeck};
use phea_hydraulics::line::{Line, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Machine, MachineOptions, PowerUnit, StartValues};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::servovalve::{
    LeakageModel, LeakageShape, OpeningLaw, Servovalve, SpoolImperfection, Supply,
};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::ActuatorStroke;

use crate::rig::{Chance, Control, Refusal, Rig, smoothed};

const REFERENCE_S: f64 = 0.05;
const MOTION_S: f64 = 0.3;
/// Time from the end of the motion to the end of the run, s.
const REST_S: f64 = 0.2;

/// The rig of this number.
pub(crate) fn rig(number: u64) -> Result<Rig, Refusal> {
    let mut chance = Chance::of(number, 0x9e37_79b9_7f4a_7c15);
    let components = components(&mut chance);
    let control = control(&mut chance, &components);
    let actuator = Actuator::new(components).map_err(Refusal::Actuator)?;
    let machine = Machine::new(&actuator, &MachineOptions::default()).map_err(Refusal::Machine)?;

    let pressure = 0.5 * components.supply.pressure;
    let position = components.cylinder.stroke.middle();
    let start =
        StartValues { position, pressure_a: pressure, pressure_b: pressure, ..StartValues::default() };
    let beginning = machine.start(&start).map_err(Refusal::Machine)?;
    let sign = if chance.happens(0.5) { 1.0 } else { -1.0 };
    let force = sign * components.supply.pressure * components.cylinder.area_b * chance.decades(0.05, 0.6);
    let reference = Profile::steps(0.0, &[(REFERENCE_S, force)]).expect("one step");
    let direction = if chance.happens(0.5) { 1.0 } else { -1.0 };
    let (distance, duration) = (direction * chance.decades(1e-3, 30e-3), chance.decades(0.5, 3.0));
    let motion = Profile::smooth_step(MOTION_S, duration, distance).expect("a positive duration");
    Ok(Rig {
        machine,
        start: beginning.state,
        waves: beginning.waves,
        control,
        reference,
        ground: motion.shifted(beginning.inputs[0]),
        duration_s: MOTION_S + duration + REST_S,
        twin: None,
        features: features(&components, &control),
    })
}

fn features(components: &Components, control: &Control) -> Vec<&'static str> {
    let kind = match components.friction {
        Friction::LuGre(_) => "bristles",
        _ => "smoothed Stribeck",
    };
    let sampled = control.sample_time_s.map(|_| "sampled");
    std::iter::once(kind).chain(sampled).collect()
}

fn components(chance: &mut Chance) -> Components {
    let pressure = chance.decades(50e5, 280e5);
    let area_a = chance.decades(5e-4, 5e-3);
    let area_b = area_a * if chance.happens(0.7) { 1.0 } else { chance.between(0.6, 1.0) };
    let most_force = pressure * area_a;
    let stiffness = most_force / chance.decades(1e-4, 2e-3);
    let moving_mass = stiffness / chance.decades(600.0, 2500.0).powi(2);
    let flow_coefficient = chance.decades(0.05, 0.5) * area_a / (0.5 * pressure).sqrt();
    let leakage = flow_coefficient * chance.decades(2e-3, 2e-2);
    let stroke = chance.between(0.15, 0.6);
    let line = Line::Volume {
        volume: area_a * stroke * chance.decades(2e-2, 0.5),
        effective_bulk_modulus: chance.decades(2e8, 1.4e9),
    };
    Components {
        fluid: Fluid {
            bulk_modulus: 1.4e9,
            density: 870.0,
            kinematic_viscosity: 46e-6,
            entrained_air: None,
            vapour_pressure_absolute: 0.0,
        },
        supply: Supply { pressure, tank_pressure: 0.0 },
        outward: OutwardFlow { external_leakage: None, port_valves: [None; 2] },
        power_unit: PowerUnit::Constant,
        valve: Servovalve {
            flow_coefficients: chance.edges(flow_coefficient),
            opening: OpeningLaw::Proportional,
            leakage_coefficients: chance.edges(leakage),
            leakage_shape: LeakageShape::Common(100.0),
            leakage_model: LeakageModel::EachEdge,
            tare_flow: 0.0,
            tare_reference_drop: pressure,
            nominal_voltage: 10.0,
            natural_frequency: chance.decades(300.0, 2000.0),
            damping_ratio: chance.between(0.6, 1.1),
            transition_pressure: 1e3,
            spool: SpoolImperfection::default(),
        },
        line_a: line,
        line_b: line,
        line_models: [LineModel::Lumped; 2],
        gas: [None; 2],
        cross_port: None,
        series: None,
        linkage: None,
        load: Load::Prescribed,
        velocity_gain: None,
        cylinder: Cylinder {
            area_a,
            area_b,
            stroke: ActuatorStroke::Limited(stroke),
            moving_mass,
            dead_volume_a: area_a * stroke * 0.02,
            dead_volume_b: area_b * stroke * 0.02,
            internal_leakage: None,
            end_stops: None,
        },
        friction: friction(chance, most_force, moving_mass),
        force_sensor: ForceSensor { stiffness },
        stiffness_model: StiffnessModel::ByVolume,
    }
}

/// Friction that is steep enough to feed the ringing, with little viscous friction.
fn friction(chance: &mut Chance, most_force: f64, mass: f64) -> Friction {
    let coulomb = most_force * chance.decades(2e-3, 3e-2);
    let static_friction = coulomb * chance.between(1.2, 2.0);
    let stribeck_velocity = chance.decades(2e-3, 3e-2);
    let steepest = 0.86 * (static_friction - coulomb) / stribeck_velocity;
    let curve = Stribeck {
        coulomb,
        static_friction,
        stribeck_velocity,
        stribeck_exponent: if chance.happens(0.6) { 2.0 } else { chance.between(1.0, 2.0) },
        viscous: steepest * chance.decades(0.02, 0.3),
        retracting: None,
    };
    let friction = if chance.happens(0.6) {
        let bristle_stiffness = coulomb / chance.decades(3e-6, 5e-5);
        let bristle_damping = chance.decades(0.05, 1.0) * (bristle_stiffness * mass).sqrt();
        Friction::LuGre(LuGre { curve, bristle_stiffness, bristle_damping })
    } else {
        Friction::Stribeck { curve, regular_velocity: None }
    };
    smoothed(friction, chance.decades(1e-4, 1e-3))
}

/// Gains for a crossover at which the loop itself does not ring.
fn control(chance: &mut Chance, components: &Components) -> Control {
    let Components { valve, cylinder, supply, force_sensor, line_a, .. } = components;
    let volume = cylinder.area_a * cylinder.stroke.middle() + line_a.volume();
    let hydraulic = 2.0 * cylinder.area_a.powi(2) * 5e8 / volume;
    let stiffness = 1.0 / (1.0 / hydraulic + 1.0 / force_sensor.stiffness);
    let flow_gain =
        valve.flow_coefficients.supply_to_a / valve.nominal_voltage * (0.5 * supply.pressure).sqrt();
    let proportional = chance.decades(2.0, 40.0) * cylinder.area_a / (stiffness * flow_gain);
    let sampled = chance.happens(0.4);
    let sample_time_s = chance.decades(5e-4, 4e-3);
    Control {
        proportional,
        integral: proportional * chance.decades(1.0, 10.0),
        prefilter_frequency: chance.decades(20.0, 60.0),
        prefilter_damping: 1.0,
        limit: valve.nominal_voltage,
        anti_windup: AntiWindup::Clamping,
        sample_time_s: sampled.then_some(sample_time_s),
        delay_s: 0.0,
    }
}
