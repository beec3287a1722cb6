//! A rig drawn at random: valve, lines, cylinder, friction, load, controller and inputs, over
//! decades.

use phea_dynamics::controller::AntiWindup;
use phea_dynamics::random;
use phea_dynamics::simulation::Profile;
use phea_hydraulics::actuator::{Actuator, ActuatorError, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::{Friction, LuGre, Stribeck};
use phea_hydraulics::line::{Line, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Machine, MachineError, MachineOptions, PowerUnit, PumpLimited, StartValues};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::servovalve::{
    Edges, LeakageModel, LeakageShape, OpeningLaw, Servovalve, SpoolImperfection, Supply,
};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::ActuatorStroke;

use crate::rich;

/// Duration of every run, s.
const DURATION_S: f64 = 1.0;
/// Output step, fine enough for ringing at 5000 rad/s.
pub(crate) const OUTPUT_STEP_S: f64 = 0.25e-3;
const REFERENCE_S: f64 = 0.1;
const MOTION_S: f64 = 0.5;

/// A proportional-integral controller with a prefilter of second order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Control {
    pub(crate) proportional: f64,
    pub(crate) integral: f64,
    pub(crate) prefilter_frequency: f64,
    pub(crate) prefilter_damping: f64,
    pub(crate) limit: f64,
    pub(crate) anti_windup: AntiWindup,
    pub(crate) sample_time_s: Option<f64>,
    pub(crate) delay_s: f64,
}

/// A machine, its controller, and the inputs of both.
pub(crate) struct Rig {
    pub(crate) machine: Machine,
    pub(crate) start: Vec<f64>,
    /// Waves that arrive from its lines at the start.
    pub(crate) waves: Vec<f64>,
    pub(crate) control: Control,
    pub(crate) reference: Profile,
    pub(crate) ground: Profile,
    /// Duration of its run, s.
    pub(crate) duration_s: f64,
    /// Parameters of `closed_loop.h` that describe an equivalent rig, if it can.
    pub(crate) twin: Option<Vec<String>>,
    /// Features of the rig, in words.
    pub(crate) features: Vec<&'static str>,
}

impl Rig {
    /// Initial state, with this number of values without those of its waves: the states of the
    /// controller are at rest.
    pub(crate) fn beginning(&self, states: usize) -> Vec<f64> {
        let mut start = self.start.clone();
        start.resize(states, 0.0);
        start.extend(&self.waves);
        start
    }
}

/// Reason why there is no such rig.
#[derive(Debug)]
pub(crate) enum Refusal {
    Actuator(ActuatorError),
    Machine(MachineError),
}

/// Source of random numbers.
pub(crate) struct Chance(u64);

impl Chance {
    /// Random numbers for the rig of this number, in the family of this seed.
    pub(crate) fn of(number: u64, seed: u64) -> Chance {
        let mut chance = Chance(number.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ seed);
        random::uniform(&mut chance.0);
        chance
    }

    pub(crate) fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * random::uniform(&mut self.0)
    }

    pub(crate) fn decades(&mut self, least: f64, most: f64) -> f64 {
        self.between(least.ln(), most.ln()).exp()
    }

    pub(crate) fn happens(&mut self, fraction: f64) -> bool {
        random::uniform(&mut self.0) < fraction
    }

    pub(crate) fn edges(&mut self, typical: f64) -> Edges {
        Edges::from_array([0; 4].map(|_| typical * self.between(0.7, 1.3)))
    }
}

/// The rig of this number. Every fourth can be described by `closed_loop.h` too, and every fourth
/// is a richer one, of which one in five has lines with dynamics: CVODE takes long for their many
/// states.
pub(crate) fn rig(number: u64) -> Result<Rig, Refusal> {
    let mut chance = Chance::of(number, 0x1405_7b7e_f767_814f);
    let (like_benchmark, rich) = (number.is_multiple_of(4), number % 4 == 2);
    let mut components = components(&mut chance, like_benchmark);
    if !like_benchmark {
        complete(&mut chance, &mut components);
    }
    if rich {
        if number % 20 == 10 {
            rich::lines(&mut chance, &mut components);
        }
        rich::enrich(&mut chance, &mut components);
    }
    let control = control(&mut chance, &components, like_benchmark);
    let actuator = Actuator::new(components).map_err(Refusal::Actuator)?;
    let machine = Machine::new(&actuator, &MachineOptions::default()).map_err(Refusal::Machine)?;

    let pressure = 0.5 * components.supply.pressure;
    let inside = chance.between(0.2, 0.8);
    let most = components.supply.pressure * components.cylinder.area_b;
    let size = most * chance.decades(0.02, 0.7);
    let pulls = chance.happens(0.5) && !matches!(components.load, Load::Wall { .. });
    let sign = if pulls { -1.0 } else { 1.0 };
    let mut fraction = inside;
    if rich && components.cylinder.end_stops.is_some() && chance.happens(0.5) {
        // Near the end into which it is moved.
        let left = chance.decades(1e-4, 1e-2);
        fraction = if pulls { left } else { 1.0 - left };
    }
    let position = 2.0 * components.cylinder.stroke.middle() * fraction;
    let start =
        StartValues { position, pressure_a: pressure, pressure_b: pressure, ..StartValues::default() };
    let beginning = machine.start(&start).map_err(Refusal::Machine)?;
    let reference = Profile::steps(0.0, &[(REFERENCE_S, sign * size)]).expect("times ascend");
    let distance = sign * 2.0 * components.cylinder.stroke.middle() * chance.decades(1e-4, 0.05);
    let (duration, quintic) = (chance.decades(5e-3, 0.3), chance.happens(0.5));
    let motion = if quintic {
        Profile::smooth_step(MOTION_S, duration, distance)
    } else {
        Profile::first_order(MOTION_S, 0.3 * duration, distance)
    };
    let motion_of_twin = if quintic { [0.0, duration] } else { [0.3 * duration, 1.0] };
    Ok(Rig {
        machine,
        start: beginning.state,
        waves: beginning.waves,
        control,
        reference,
        ground: motion.expect("a positive duration").shifted(beginning.inputs[0]),
        duration_s: DURATION_S,
        twin: like_benchmark
            .then(|| twin(&components, &control, &start, sign * size, distance, motion_of_twin)),
        features: features(&components, &control),
    })
}

fn features(components: &Components, control: &Control) -> Vec<&'static str> {
    let pump = if let PowerUnit::PumpLimited(pump) = components.power_unit { Some(pump) } else { None };
    let has = [
        ("air", components.fluid.entrained_air.is_some()),
        ("unequal areas", components.cylinder.area_a != components.cylinder.area_b),
        ("bristles", matches!(components.friction, Friction::LuGre(_))),
        ("smoothed Stribeck", matches!(components.friction, Friction::Stribeck { .. })),
        ("rate limit", components.valve.spool.rate_limit.is_some()),
        ("hysteresis", components.valve.spool.hysteresis_width.is_some()),
        ("threshold", components.valve.spool.threshold.is_some()),
        ("pump", pump.is_some()),
        ("accumulator", pump.is_some_and(|pump| pump.accumulator.is_some())),
        ("end stops", components.cylinder.end_stops.is_some()),
        ("spring load", matches!(components.load, Load::SpringMassDamper { .. })),
        ("wall", matches!(components.load, Load::Wall { .. })),
        (
            "segments",
            matches!(components.line_models[0], LineModel::Segments { .. } | LineModel::Creeping { .. }),
        ),
        ("one wave", matches!(components.line_models[0], LineModel::TransmissionLine { .. })),
        ("two waves", matches!(components.line_models[0], LineModel::TwoWave { .. })),
        ("sampled", control.sample_time_s.is_some()),
        ("late", control.delay_s > 0.0),
    ];
    has.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
}

fn components(chance: &mut Chance, like_benchmark: bool) -> Components {
    let pressure = chance.decades(10e5, 350e5);
    let area_a = chance.decades(1e-4, 1e-2);
    let area_b = area_a * if chance.happens(0.5) { 1.0 } else { chance.between(0.5, 1.0) };
    let most_force = pressure * area_a;
    let stiffness = most_force / chance.decades(1e-5, 3e-3);
    let moving_mass = stiffness / chance.decades(1e2, 5e3).powi(2);
    let flow_coefficient = chance.decades(0.05, 3.0) * area_a / (0.5 * pressure).sqrt();
    let leakage = flow_coefficient * chance.decades(1e-3, 3e-2);
    let stroke = chance.decades(0.05, 1.0);
    let air = !like_benchmark && chance.happens(0.3);
    let fluid = Fluid {
        bulk_modulus: chance.decades(2e8, 2e9),
        density: 870.0,
        kinematic_viscosity: 46e-6,
        entrained_air: air.then(|| bubbles(chance)),
        vapour_pressure_absolute: 0.0,
    };
    let tank_pressure = chance.between(0.0, 0.05) * pressure;
    Components {
        fluid,
        supply: Supply { pressure, tank_pressure },
        outward: OutwardFlow { external_leakage: None, port_valves: [None; 2] },
        power_unit: PowerUnit::Constant,
        valve: Servovalve {
            flow_coefficients: chance.edges(flow_coefficient),
            opening: OpeningLaw::Proportional,
            leakage_coefficients: chance.edges(leakage),
            leakage_shape: LeakageShape::Common(chance.decades(10.0, 300.0)),
            leakage_model: LeakageModel::EachEdge,
            tare_flow: 0.0,
            tare_reference_drop: pressure - tank_pressure,
            nominal_voltage: 10.0,
            natural_frequency: chance.decades(150.0, 3000.0),
            damping_ratio: chance.between(0.4, 1.3),
            transition_pressure: chance.decades(1e2, 1e5),
            spool: SpoolImperfection::default(),
        },
        line_a: line(chance, area_a * stroke),
        line_b: line(chance, area_a * stroke),
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
            dead_volume_a: area_a * stroke * chance.decades(1e-3, 0.1),
            dead_volume_b: area_b * stroke * chance.decades(1e-3, 0.1),
            internal_leakage: None,
            end_stops: None,
        },
        friction: friction(chance, most_force, moving_mass, like_benchmark),
        force_sensor: ForceSensor { stiffness },
        stiffness_model: if like_benchmark || chance.happens(0.5) {
            StiffnessModel::ByVolume
        } else {
            StiffnessModel::Uniform
        },
    }
}

/// A line with a fraction of the chamber's volume.
fn line(chance: &mut Chance, chamber: f64) -> Line {
    Line::Volume {
        volume: chamber * chance.decades(1e-2, 3.0),
        effective_bulk_modulus: chance.decades(1e8, 1.5e9),
    }
}

fn bubbles(chance: &mut Chance) -> EntrainedAir {
    EntrainedAir { volume_fraction: chance.decades(1e-4, 3e-2), polytropic_exponent: 1.2 }
}

fn friction(chance: &mut Chance, most_force: f64, mass: f64, bristles: bool) -> Friction {
    let viscous = most_force * chance.decades(1e-3, 0.3);
    let coulomb = most_force * chance.decades(1e-3, 0.1);
    let curve = Stribeck {
        coulomb,
        static_friction: coulomb * chance.between(1.0, 1.8),
        stribeck_velocity: chance.decades(1e-3, 5e-2),
        stribeck_exponent: if chance.happens(0.7) { 2.0 } else { chance.between(0.7, 2.0) },
        viscous,
        retracting: None,
    };
    let bristle_stiffness = coulomb / chance.decades(1e-6, 1e-4);
    let bristle_damping = chance.decades(0.05, 1.0) * (bristle_stiffness * mass).sqrt();
    let kind = chance.between(0.0, 3.0);
    if bristles || kind < 1.0 {
        Friction::LuGre(LuGre { curve, bristle_stiffness, bristle_damping })
    } else if kind < 2.0 {
        Friction::Viscous { viscous }
    } else {
        Friction::Stribeck { curve, regular_velocity: None }
    }
}

/// This friction, the jump of a static curve smoothed by a velocity in m/s.
pub(crate) fn smoothed(friction: Friction, velocity: f64) -> Friction {
    match friction {
        Friction::Stribeck { curve, .. } => Friction::Stribeck { curve, regular_velocity: Some(velocity) },
        other => other,
    }
}

/// Adds spool, pump, leakage, end stops and load.
fn complete(chance: &mut Chance, components: &mut Components) {
    let Components { supply, cylinder, force_sensor, .. } = *components;
    let most_force = supply.pressure * cylinder.area_a;
    let flow = components.valve.flow_coefficients.supply_to_a * (0.5 * supply.pressure).sqrt();
    let stiffness = force_sensor.stiffness * chance.decades(1e-2, 1.0);
    let load = Load::SpringMassDamper {
        mass: cylinder.moving_mass * chance.decades(0.1, 10.0),
        stiffness,
        damping: most_force * chance.decades(1e-3, 0.3),
    };
    components.valve.spool = SpoolImperfection {
        null_bias: 10.0 * chance.between(-0.01, 0.01),
        rate_limit: chance.happens(0.3).then(|| chance.decades(300.0, 3e4)),
        ..SpoolImperfection::default()
    };
    let pump = PumpLimited {
        pump_flow: 20.0 * flow * chance.decades(0.02, 1.0),
        relief_override: 0.05 * supply.pressure,
        volume: cylinder.area_a * 2.0 * cylinder.stroke.middle() * chance.decades(0.1, 10.0),
        effective_bulk_modulus: 1e9,
        accumulator: None,
    };
    if chance.happens(0.2) {
        components.power_unit = PowerUnit::PumpLimited(pump);
    }
    components.cylinder.internal_leakage =
        chance.happens(0.5).then(|| flow / supply.pressure * chance.decades(1e-4, 1e-1));
    components.cylinder.end_stops = chance
        .happens(0.3)
        .then(|| Contact { stiffness: most_force / chance.decades(1e-5, 0.3), relative_damping: 1.0 });
    components.friction = smoothed(components.friction, chance.decades(1e-4, 1e-2));
    if chance.happens(0.3) {
        components.load = load;
    }
}

/// Gains for a crossover over decades, for a piston without mass and friction: slow ones, and ones
/// that hunt.
fn control(chance: &mut Chance, components: &Components, like_benchmark: bool) -> Control {
    let Components { valve, cylinder, supply, force_sensor, fluid, .. } = components;
    let volume = cylinder.area_a * cylinder.stroke.middle() + components.line_a.volume();
    let hydraulic = 2.0 * cylinder.area_a.powi(2) * fluid.bulk_modulus.min(1e9) / volume;
    let stiffness = 1.0 / (1.0 / hydraulic + 1.0 / force_sensor.stiffness);
    let flow_gain =
        valve.flow_coefficients.supply_to_a / valve.nominal_voltage * (0.5 * supply.pressure).sqrt();
    let proportional = chance.decades(0.3, 600.0) * cylinder.area_a / (stiffness * flow_gain);
    let sampled = chance.happens(0.3);
    let sample_time_s = chance.decades(2e-4, 2e-2);
    let late = sampled && !like_benchmark && chance.happens(0.5);
    let kind = chance.between(0.0, 3.0);
    Control {
        proportional,
        integral: proportional * chance.decades(0.1, 20.0),
        prefilter_frequency: chance.decades(5.0, 100.0),
        prefilter_damping: chance.between(0.7, 1.5),
        limit: valve.nominal_voltage * chance.decades(0.03, 1.0),
        anti_windup: if like_benchmark || kind < 1.0 {
            AntiWindup::None
        } else if kind < 2.0 {
            AntiWindup::Clamping
        } else {
            AntiWindup::BackCalculation
        },
        sample_time_s: sampled.then_some(sample_time_s),
        delay_s: if late { sample_time_s * chance.between(0.05, 0.95) } else { 0.0 },
    }
}

/// The equivalent rig for `closed_loop.h`; `motion` is its time constant and its duration.
fn twin(
    components: &Components,
    control: &Control,
    start: &StartValues,
    force: f64,
    distance: f64,
    [time_constant, duration]: [f64; 2],
) -> Vec<String> {
    let of_run = [
        ("proportional_gain", control.proportional),
        ("integral_gain", control.integral),
        ("saturation", control.limit),
        ("prefilter_stiffness", control.prefilter_frequency.powi(2)),
        ("prefilter_damping", 2.0 * control.prefilter_damping * control.prefilter_frequency),
        ("start_position", start.position),
        ("start_pressure_a", start.pressure_a),
        ("start_pressure_b", start.pressure_b),
        ("reference_time", REFERENCE_S),
        ("reference_force", force),
        ("motion_start", MOTION_S),
        ("motion_duration", duration),
        ("motion_distance", distance),
        ("motion_time_constant", time_constant),
        ("duration", DURATION_S),
        ("output_step", OUTPUT_STEP_S),
        ("sample_time", control.sample_time_s.unwrap_or(0.0)),
    ];
    let all = of_valve(components).into_iter().chain(of_cylinder(components)).chain(of_run);
    all.map(|(name, value)| format!("{name}={value:e}")).collect()
}

fn of_valve(components: &Components) -> Vec<(&'static str, f64)> {
    let Components { supply, valve, .. } = components;
    let (flow, leak) = (valve.flow_coefficients, valve.leakage_coefficients);
    vec![
        ("supply_pressure", supply.pressure),
        ("tank_pressure", supply.tank_pressure),
        ("transition_pressure", valve.transition_pressure),
        ("valve_frequency", valve.natural_frequency),
        ("valve_damping", valve.damping_ratio),
        ("nominal_voltage", valve.nominal_voltage),
        ("leakage_shape", valve.leakage_shape.widest()),
        ("flow_supply_to_a", flow.supply_to_a),
        ("flow_a_to_tank", flow.a_to_tank),
        ("flow_supply_to_b", flow.supply_to_b),
        ("flow_b_to_tank", flow.b_to_tank),
        ("leakage_supply_to_a", leak.supply_to_a),
        ("leakage_a_to_tank", leak.a_to_tank),
        ("leakage_supply_to_b", leak.supply_to_b),
        ("leakage_b_to_tank", leak.b_to_tank),
    ]
}

fn of_cylinder(components: &Components) -> Vec<(&'static str, f64)> {
    let Components { cylinder, force_sensor, fluid, line_a, line_b, .. } = components;
    let modulus = |line: &Line| match line {
        Line::Volume { effective_bulk_modulus, .. } => *effective_bulk_modulus,
        Line::Hose { .. } | Line::Pipe { .. } => f64::NAN,
    };
    let mut values = vec![
        ("area_a", cylinder.area_a),
        ("area_b", cylinder.area_b),
        ("stroke", 2.0 * cylinder.stroke.middle()),
        ("chamber_modulus", fluid.bulk_modulus),
        ("line_volume_a", line_a.volume()),
        ("line_volume_b", line_b.volume()),
        ("line_modulus_a", modulus(line_a)),
        ("line_modulus_b", modulus(line_b)),
        ("dead_volume_a", cylinder.dead_volume_a),
        ("dead_volume_b", cylinder.dead_volume_b),
        ("moving_mass", cylinder.moving_mass),
        ("sensor_stiffness", force_sensor.stiffness),
    ];
    if let Friction::LuGre(friction) = components.friction {
        values.extend([
            ("coulomb", friction.curve.coulomb),
            ("static_friction", friction.curve.static_friction),
            ("stribeck_velocity", friction.curve.stribeck_velocity),
            ("stribeck_exponent", friction.curve.stribeck_exponent),
            ("bristle_stiffness", friction.bristle_stiffness),
            ("bristle_damping", friction.bristle_damping),
            ("viscous", friction.curve.viscous),
        ]);
    }
    values
}
