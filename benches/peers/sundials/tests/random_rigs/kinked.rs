//! Rigs whose rates have kinks: end stops, walls with a gap, stages of a telescopic piston,
//! friction that sticks and reverses.

use phea_dynamics::simulation::Profile;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Machine, MachineOptions, StartValues};
use phea_hydraulics::stroke::{ActuatorStroke, PistonStage, Telescope};

use crate::necks;
use crate::rig::{Chance, Refusal, Rig};

const DURATION_S: f64 = 0.5;

/// The parts of the rig with this number.
const KINDS: [&str; 4] = ["end stops", "wall", "stages", "stick-slip"];

/// The rig of this number; every fourth is of each kind.
pub(crate) fn rig(number: u64) -> Result<Rig, Refusal> {
    let mut chance = Chance::of(number, 0x6a09_e667_f3bc_c909);
    let kind = KINDS[(number % 4) as usize];
    let mut components = Components { gas: [None; 2], ..necks::components(&mut chance) };
    let length = 2.0 * components.cylinder.stroke.middle();
    let most = components.supply.pressure * components.cylinder.area_b;
    let sign = if chance.happens(0.5) { 1.0 } else { -1.0 };
    let mut position = 0.5 * length;
    let mut way = sign * length * chance.decades(1e-3, 2e-2);
    match kind {
        "end stops" => {
            let stiffness = most / chance.decades(1e-5, 1e-3);
            let relative_damping = chance.decades(0.1, 3.0);
            components.cylinder.end_stops = Some(Contact { stiffness, relative_damping });
            // the load moves into the stop and out of it
            let left = way.abs() * chance.between(0.3, 0.95);
            position = if sign > 0.0 { length - left } else { left };
        }
        "wall" => components.load = wall(&mut chance, &components, way.abs()),
        "stages" => {
            let transition = length * chance.decades(3e-4, 2e-2);
            way = sign * transition * chance.decades(0.5, 20.0);
            components.cylinder.stroke = ActuatorStroke::Telescopic(stages(&mut chance, length, transition));
            position = 0.5 * length - way * chance.between(0.1, 0.9);
        }
        _ => sticky(&mut chance, &mut components, most),
    }
    let control = necks::control(&mut chance, &components);
    let actuator = Actuator::new(components).map_err(Refusal::Actuator)?;
    let machine = Machine::new(&actuator, &MachineOptions::default()).map_err(Refusal::Machine)?;
    let pressure = 0.5 * components.supply.pressure;
    let start =
        StartValues { position, pressure_a: pressure, pressure_b: pressure, ..StartValues::default() };
    let beginning = machine.start(&start).map_err(Refusal::Machine)?;
    Ok(Rig {
        machine,
        start: beginning.state,
        waves: beginning.waves,
        control,
        reference: reference(&mut chance, kind, sign * most)?,
        ground: ground(&mut chance, way).shifted(beginning.inputs[0]),
        duration_s: DURATION_S,
        twin: None,
        features: vec![kind],
    })
}

/// A push and a smaller one, and at last one that releases; no pull against a wall.
fn reference(chance: &mut Chance, kind: &str, most: f64) -> Result<Profile, Refusal> {
    let most = if kind == "wall" { most.abs() } else { most };
    let size = most * chance.decades(0.02, 0.5);
    let back = if kind == "wall" { chance.between(0.05, 0.3) } else { chance.between(-0.8, 0.5) };
    let last = size * chance.between(0.1, 0.9);
    let steps = [(0.03, size), (0.17, back * size), (0.36, last)];
    Ok(Profile::steps(0.0, &steps).expect("times ascend"))
}

/// Motion to a position, or to and fro.
fn ground(chance: &mut Chance, way: f64) -> Profile {
    let motion = if chance.happens(0.5) {
        Profile::smooth_step(0.08, chance.decades(2e-2, 0.3), way)
    } else {
        Profile::sine(0.08, way, chance.decades(8.0, 60.0))
    };
    motion.expect("a positive duration")
}

fn wall(chance: &mut Chance, components: &Components, gap: f64) -> Load {
    let most_force = components.supply.pressure * components.cylinder.area_a;
    Load::Wall {
        mass: Some(components.cylinder.moving_mass * chance.decades(0.1, 3.0)),
        damping: most_force * chance.decades(1e-2, 0.3),
        gap: gap * chance.decades(0.05, 1.0),
        stiffness: components.force_sensor.stiffness * chance.decades(0.1, 10.0),
        relative_damping: chance.decades(0.1, 10.0),
    }
}

/// Two stages; the second begins in the middle.
fn stages(chance: &mut Chance, stroke: f64, transition: f64) -> Telescope {
    let ratios = [chance.between(0.4, 0.9), chance.between(0.5, 1.1)];
    let second = PistonStage { from: 0.5 * stroke, ratios };
    Telescope { stroke, stages: [Some(second), None, None], transition }
}

/// Friction of a few percent of the largest force, steep, with little viscous friction.
fn sticky(chance: &mut Chance, components: &mut Components, most: f64) {
    let Friction::LuGre(mut lugre) = components.friction else { return };
    lugre.curve.coulomb = most * chance.decades(1e-2, 8e-2);
    lugre.curve.static_friction = lugre.curve.coulomb * chance.between(1.0, 1.3);
    lugre.curve.stribeck_velocity = chance.decades(1e-2, 5e-2);
    lugre.bristle_stiffness = lugre.curve.coulomb / chance.decades(3e-6, 5e-5);
    lugre.bristle_damping =
        chance.decades(0.3, 1.5) * (lugre.bristle_stiffness * components.cylinder.moving_mass).sqrt();
    components.friction = Friction::LuGre(lugre);
}
