//! Plant with dynamic lines compared with the machine's own derivatives, delays included, and with
//! lumped lines.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::analytic::Disc;
use phea_dynamics::controller::RateFilter;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::portable::{exp_complex, pow};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::small_signal;
use phea_dynamics::uncertain_plant::RationalCoefficients;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{EntrainedAir, Fluid};
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::{
    DynamicLine, END_SHARE, LaminarFriction, Line, LineModel, LineWall, Segments, StiffeningMember,
};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{Chambers, InitialCondition, Machine, MachineOptions};
use phea_hydraulics::operating_point::{Condition, operating_point};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::plant::{ChamberDynamics, LineChambers, LinearLoad, LinearPlant, PlantInMotion};
use phea_hydraulics::reference_rig::{components, cylinder, hose, hose_line, leaking, pipe_line};
use phea_hydraulics::stiffness::StiffnessModel;

use super::commanded::{Commanded, chamber_gas, cross_port, power_unit, without_branches};
use super::plant::{plant_at_rest, port_valves};

pub(super) fn model(number: u64, time: f64) -> LineModel {
    let friction =
        if number.is_multiple_of(2) { LaminarFriction::Steady } else { LaminarFriction::FrequencyDependent };
    match number % 6 {
        0 => LineModel::Lumped,
        1 => LineModel::Creeping { relaxation_time: time },
        2 | 3 => LineModel::Segments { count: 1 + (number % 7) as usize, friction, relaxation_time: None },
        4 => LineModel::TransmissionLine { end_share: END_SHARE },
        _ if number % 12 == 5 => LineModel::TwoWave { end_share: END_SHARE, wall: LineWall::default() },
        _ => LineModel::Segments { count: 3, friction, relaxation_time: Some(time) },
    }
}

/// Linear plant and machine of a rig for every number, with a model for every line.
pub(crate) struct Drawn {
    machine: Machine,
    inputs: Vec<f64>,
    state: Vec<f64>,
    command: f64,
    sensor: f64,
    pub(crate) plant: LinearPlant,
    pub(crate) behind: LineChambers,
}

/// Every third load is prescribed, the others are sprung.
fn loads(number: u64, mass: f64, stiffness: f64, damping: f64) -> (Load, LinearLoad) {
    if number.is_multiple_of(3) {
        return (Load::Prescribed, LinearLoad::Prescribed);
    }
    let sprung = Load::SpringMassDamper { mass, stiffness, damping };
    (sprung, LinearLoad::Yielding { mass, damping, stiffness })
}

/// Plant with these lines when its machine is at rest, with its piston at a position in m: the
/// leakage flows through the lines, so that the pressures at the valve's ports differ slightly from
/// those of the chambers.
pub(super) fn plant_with_lines(
    actuator: &Actuator,
    machine: &Machine,
    lines: [DynamicLine; 2],
    (position, rest): (f64, &InitialCondition),
    load: LinearLoad,
) -> (LinearPlant, LineChambers) {
    let parts = actuator.components();
    let ports = machine.signals(&rest.state, &rest.all_inputs()).port_pressures;
    let (plant, lumped) = plant_at_rest(actuator, machine, (position, ports, &rest.state), load);
    let pressures = [rest.state[2], rest.state[3]];
    let oil = Chambers::with_line_compliance(actuator, StiffeningMember::Nominal, [0.0; 2]);
    let (oil, gas) = (oil.compliance(position, pressures), parts.gas_compliance(pressures));
    let own = without_branches(parts, pressures, [0, 1].map(|side| oil[side] + gas[side].unwrap_or(0.0)));
    let ChamberDynamics::TwoPressures { flow_pressures, .. } = plant.chambers else { unreachable!() };
    let outward = parts.outward.if_present();
    let outward = outward.map_or([0.0; 2], |outward| outward.slopes(pressures, parts.supply.tank_pressure));
    let leaking = [outward[0] / flow_pressures[0], outward[1] / flow_pressures[1]];
    (plant, LineChambers { lines, chambers: own, lumped, leaking })
}

/// Components of a rig for every number and the models of its lines, with numbers drawn by
/// `spread`.
fn parts(number: u64, spread: &mut impl FnMut(f64, f64) -> f64) -> (Components, [LineModel; 2]) {
    let (friction, leakage) = (spread(50.0, 2e4), spread(1e-14, 1e-10));
    let [area_a, area_b] = [0.022, spread(0.01, 0.036)].map(|rod| annulus_area(0.05, rod));
    let stiffness_model = if number % 5 < 2 { StiffnessModel::Uniform } else { StiffnessModel::ByVolume };
    let reference = components(hose_line(), stiffness_model);
    let air = EntrainedAir { volume_fraction: spread(1e-3, 1e-2), polytropic_exponent: 1.3 };
    let of_length = |length| Line::Hose { hose: hose(), length };
    let mut models = [model(number, spread(1e-4, 0.1)), model(number / 6, spread(1e-4, 0.1))];
    if models == [LineModel::Lumped; 2] {
        // two lumped lines are no lines in motion
        models[0] =
            LineModel::Segments { count: 1, friction: LaminarFriction::Steady, relaxation_time: None };
    }
    let line_b = match models[1] {
        LineModel::TransmissionLine { .. } | LineModel::Lumped => pipe_line(),
        _ => of_length(spread(0.3, 3.0)),
    };
    let parts = Components {
        fluid: Fluid { entrained_air: number.is_multiple_of(4).then_some(air), ..reference.fluid },
        cylinder: Cylinder { area_a, area_b, moving_mass: spread(2.0, 80.0), ..cylinder() },
        line_a: of_length(spread(0.3, 3.0)),
        line_b,
        friction: Friction::Viscous { viscous: friction },
        force_sensor: ForceSensor { stiffness: spread(1e6, 1e8) },
        ..reference
    };
    let parts = Components {
        gas: chamber_gas(24, number),
        cross_port: cross_port(number),
        power_unit: power_unit(number),
        ..leaking(parts, leakage)
    };
    // every fifth leaks to the tank as well, from the chamber side of its lines
    let external_leakage = (number % 5 == 3).then_some(1e-14 * pow(1e3, number as f64 / 108.0));
    let parts =
        Components { outward: OutwardFlow { external_leakage, port_valves: port_valves(number) }, ..parts };
    (parts, models)
}

pub(crate) fn drawn(number: u64) -> Drawn {
    let mut state = stream(23, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let (parts, models) = parts(number, &mut spread);
    let actuator = Actuator::new(parts).unwrap();
    let line = |line: &Line, model: &LineModel| {
        DynamicLine::new(line, &parts.fluid, actuator.mean_pressure(), StiffeningMember::Nominal, model)
            .unwrap()
    };
    let lines = [line(&parts.line_a, &models[0]), line(&parts.line_b, &models[1])];
    let (mass, stiffness, damping) = (spread(1.0, 500.0), spread(1e4, 1e8), spread(10.0, 1e4));
    let (load, linear_load) = loads(number, mass, stiffness, damping);
    let actuator = Actuator::new(Components { load, line_models: models, ..parts }).unwrap();
    let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
    let condition = Condition::Command(spread(0.01, 2.0));
    let rest = machine.rest(&operating_point(&actuator, spread(0.05, 0.45), condition).unwrap()).unwrap();
    let moves = linear_load != LinearLoad::Prescribed;
    let position = rest.inputs[0] + if moves { rest.state[6] } else { 0.0 } + rest.state[4];
    let (plant, behind) = plant_with_lines(&actuator, &machine, lines, (position, &rest), linear_load);
    Drawn {
        machine,
        inputs: [&rest.inputs[..], &rest.waves[..]].concat(),
        state: rest.state,
        command: rest.command,
        sensor: parts.force_sensor.stiffness,
        plant,
        behind,
    }
}

impl Drawn {
    /// Paths F_e and the velocity of the load, by the command and by the ground, without
    /// feed-forward.
    pub(crate) fn force_and_velocity(&self, frequency: f64) -> [[Complex64; 2]; 2] {
        let s = Complex64::new(0.0, frequency);
        let inputs = [&[self.command], &self.inputs[..]].concat();
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        [[one, zero, zero], [zero, one, s]].map(|drive| {
            let found =
                small_signal(&Commanded(self.machine, 0.0), &self.state, &inputs, &drive, frequency).unwrap();
            let velocity = |part: fn(&Complex64) -> f64| {
                let inputs: Vec<f64> =
                    drive[1..].iter().map(part).chain(vec![0.0; self.inputs.len() - 2]).collect();
                let state: Vec<f64> = found.iter().map(part).collect();
                phea_dynamics::simulation::Plant::<f64>::disturbance(&self.machine, &state, &inputs)
            };
            [found[4] * self.sensor, Complex64::new(velocity(|value| value.re), velocity(|value| value.im))]
        })
    }

    fn small_signal(&self, feed_forward: f64, frequency: f64) -> [Complex64; 2] {
        let inputs = [&[self.command], &self.inputs[..]].concat();
        let (zero, one) = (Complex64::ZERO, Complex64::ONE);
        let ground = [zero, one, Complex64::new(0.0, frequency)];
        [[one, zero, zero], ground].map(|drive| {
            let system = Commanded(self.machine, feed_forward);
            small_signal(&system, &self.state, &inputs, &drive, frequency).unwrap()[4] * self.sensor
        })
    }
}

/// 108 rigs, including every pair of line models, at 14 frequencies over six decades.
#[test]
fn it_is_the_machine_for_small_motions() {
    for number in 0..108 {
        let rig = drawn(number);
        let feed_forward =
            if number.is_multiple_of(2) { 0.03 * pow(3e3, number as f64 / 108.0) } else { 0.0 };
        let moving = PlantInMotion::new(&rig.plant, &rig.behind).fed_forward(Some(feed_forward));
        assert!(moving.is_passive());
        for step in 0..14 {
            let frequency = 0.01 * pow(1e6, f64::from(step) / 13.0);
            let own = rig.small_signal(feed_forward, frequency);
            let found_response = moving.response(Complex64::new(0.0, frequency));
            for (found_response, own) in found_response.into_iter().zip(own) {
                let error = (found_response / own - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-7, "rig {number} at {frequency} rad/s: {error}");
            }
        }
    }
}

/// The velocity of the load is that of the machine, by the command and by the ground; with lumped
/// lines it is the quotient over the plant's denominator, and fed forward without delay it is fed
/// back too.
#[test]
fn the_velocity_of_the_load_is_that_of_the_machine() {
    let mut yielding = 0;
    for number in 0..108 {
        let rig = drawn(number);
        let moving = PlantInMotion::new(&rig.plant, &rig.behind);
        let gain = 12.0;
        let fed = LinearPlant { load_velocity_feed_forward: Some(gain), ..rig.plant };
        let [own, closed] =
            [rig.plant, fed].map(|plant| (plant.coefficients(), PlantInMotion::lumped(&plant)));
        for step in 0..14 {
            let frequency = 0.01 * pow(1e6, f64::from(step) / 13.0);
            let s = Complex64::new(0.0, frequency);
            let apart = |one: Complex64, other: Complex64| (one / other - 1.0).norm_sqr().sqrt();
            let [[_, command], [_, ground]] = rig.force_and_velocity(frequency);
            let found_response = moving.load_velocity(s);
            if rig.plant.load == LinearLoad::Prescribed {
                assert_eq!((found_response, own.0.rate.clone()), ([Complex64::ZERO, s], None));
                continue;
            }
            yielding += 1;
            for (found_response, own) in found_response.into_iter().zip([command, ground]) {
                assert!(
                    apart(found_response, own) < 1e-7,
                    "rig {number} at {frequency} rad/s: {found_response} {own}"
                );
            }
            let [without_path, back] = [&own, &closed].map(|(coefficients, lumped)| {
                let rate = coefficients.rate.as_ref().unwrap();
                let found = lumped.load_velocity(s);
                for (numerator, found) in [&rate.command, &rate.disturbance].into_iter().zip(found) {
                    let denominator = coefficients.command.denominator.clone();
                    let path = RationalCoefficients { numerator: numerator.clone(), denominator };
                    assert!(apart(path.at_frequency(frequency), found) < 1e-9, "rig {number} at {frequency}");
                }
                found
            });
            for (back, without_path_response) in back.into_iter().zip(without_path) {
                assert!(
                    apart(back, without_path_response / (1.0 - gain * without_path[0])) < 1e-7,
                    "rig {number} at {frequency}"
                );
            }
        }
    }
    assert!(yielding > 500, "{yielding}");
}

/// Response from the machine's own derivatives, with its load's velocity on the command by algebra:
/// K_x e^(-s tau).
#[test]
fn a_late_feed_forward_is_the_machine_with_a_late_command() {
    for number in 0..36 {
        let rig = drawn(number);
        let (gain, delay) = (25.0, 1e-4 * pow(100.0, number as f64 / 35.0));
        let moving = PlantInMotion::new(&rig.plant, &rig.behind).fed_forward(Some(gain));
        let moving = moving.late(delay);
        for step in 0..14 {
            let frequency = 0.01 * pow(1e6, f64::from(step) / 13.0);
            let s = Complex64::new(0.0, frequency);
            let gain = gain * exp_complex(-s * delay);
            let [[force, velocity], [ground_force, ground_velocity]] = rig.force_and_velocity(frequency);
            let back = gain * force / (1.0 - gain * velocity);
            let expected = [back / gain, ground_force + back * ground_velocity];
            let found_response = moving.response(s);
            for (found_response, expected) in found_response.into_iter().zip(expected) {
                let error = (found_response / expected - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-7, "rig {number} at {frequency} rad/s: {error}");
            }
        }
    }
}

/// Discs contain the response of a late plant between two frequencies, and shrink.
#[test]
fn a_late_feed_forward_is_enclosed() {
    for number in [1, 4, 8, 14] {
        let rig = drawn(number);
        let plant = PlantInMotion::lumped(&rig.plant).fed_forward(Some(10.0));
        let filter = RateFilter::SecondOrder { frequency_rad_per_s: 400.0, damping_ratio: 0.5 };
        let late = plant.filtered(filter).late(1e-3);
        for (start, width) in [(3.0, 1e-3), (80.0, 1e-4), (2000.0, 1e-5)] {
            let ends = [start, start * (1.0 + width)];
            let held: Disc = late.enclosure(ends);
            for fraction in [0.0, 0.3, 1.0] {
                let [command, _] = late.response(Complex64::new(0.0, start * (1.0 + fraction * width)));
                assert!(held.contains(command) && held.radius() < 0.2 * command.norm_sqr().sqrt());
            }
        }
    }
}

/// Number of open-loop poles in the right half plane compared with e^(-s tau) as six quotients of
/// second order.
#[test]
fn poles_of_a_late_plant_are_counted() {
    let plant = LinearPlant::of_load_pressure(
        &phea_hydraulics::reference_rig::nominal_plant(),
        0.0,
        LinearLoad::Yielding { mass: 100.0, damping: 500.0, stiffness: 2e5 },
    );
    let without_path = Polynomial::new(plant.coefficients().command.denominator);
    let mut seen = [0; 3];
    for gain in [5.0, 20.0, 29.0, 40.0] {
        let fed = LinearPlant { load_velocity_feed_forward: Some(gain), ..plant }
            .coefficients()
            .command
            .denominator;
        let back = Polynomial::new(fed).sum(&without_path.scaled(-1.0));
        // the count with a filter is that of a longer product of polynomials
        let filter = RateFilter::FirstOrder { frequency_rad_per_s: 30.0 };
        let lag = Polynomial::new(filter.denominator());
        for delay in [0.0, 1e-3, 1e-2, 4e-2] {
            let part = delay / 6.0;
            let quotient = |sign: f64| {
                let one = Polynomial::new(vec![part * part / 12.0, sign * part / 2.0, 1.0]);
                (0..6).fold(Polynomial::new(vec![1.0]), |product, _| product.product(&one))
            };
            let own = without_path.product(&lag).product(&quotient(1.0));
            let characteristic = own.sum(&back.product(&quotient(-1.0)));
            let growing = characteristic.roots().unwrap().iter().filter(|root| root.re > 0.0).count();
            let late = PlantInMotion::lumped(&plant).fed_forward(Some(gain)).filtered(filter).late(delay);
            assert_eq!(late.unstable_poles(), Some(growing), "{gain} V s/m, {delay} s, filtered");
        }
        for delay in [0.0, 1e-3, 3e-3, 1e-2, 2e-2, 3e-2, 4e-2] {
            let part = delay / 6.0;
            let quotient = |sign: f64| {
                let one = Polynomial::new(vec![part * part / 12.0, sign * part / 2.0, 1.0]);
                (0..6).fold(Polynomial::new(vec![1.0]), |product, _| product.product(&one))
            };
            let characteristic = without_path.product(&quotient(1.0)).sum(&back.product(&quotient(-1.0)));
            let growing = characteristic.roots().unwrap().iter().filter(|root| root.re > 0.0).count();
            let late = PlantInMotion::lumped(&plant).fed_forward(Some(gain));
            let late = late.late(delay);
            assert_eq!(late.unstable_poles(), Some(growing), "{gain} V s/m, {delay} s");
            seen[(growing / 2).min(2)] += 1;
        }
    }
    assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
}

/// Lumped lines give the quotient of polynomials, for any stated numbers.
#[test]
fn lumped_lines_make_the_rational_plant() {
    for number in (0..36).step_by(6).map(|first| first * 6) {
        let rig = drawn(number);
        let plants = [
            LinearPlant { load_velocity_feed_forward: Some(20.0), ..rig.plant },
            LinearPlant::of_load_pressure(
                &phea_hydraulics::reference_rig::nominal_plant(),
                1e-12,
                rig.plant.load,
            ),
        ];
        let LineChambers { chambers, lumped, .. } = rig.behind;
        let lines = [0, 1].map(|side| DynamicLine::Segments(Segments::lumped(lumped[side] - chambers[side])));
        for plant in plants {
            let moving = PlantInMotion::new(&plant, &LineChambers { lines, ..rig.behind });
            let rational = plant.coefficients();
            for frequency in [0.01, 1.0, 30.0, 400.0, 2e4] {
                let [command, load] = moving.response(Complex64::new(0.0, frequency));
                let known = rational.command.at_frequency(frequency);
                let known_load = rational.disturbance.as_ref().unwrap().at_frequency(frequency);
                assert!((command / known - 1.0).norm_sqr().sqrt() < 1e-9);
                assert!((load / known_load - 1.0).norm_sqr().sqrt() < 1e-9);
            }
        }
    }
}

/// Immediate compliance of a line equals that of its lumped model, and a stiffer line is one with a
/// stiffer fluid and wall.
#[test]
fn compliance_is_that_of_the_lumped_line() {
    for number in 0..12 {
        let rig = drawn(12 * number + number % 6);
        for line in rig.behind.lines {
            let slow = Complex64::new(0.0, 1e-3);
            let stiff = line.stiffened(4.0);
            assert!((stiff.elastic_compliance() * 4.0 / line.elastic_compliance() - 1.0).abs() < 1e-12);
            let at_port =
                |line: &DynamicLine| line.transfer_matrix(slow).admittance / slow + line.chamber_compliance();
            assert!((at_port(&stiff) * 4.0 / at_port(&line) - 1.0).norm_sqr() < 1e-10);
        }
    }
}

/// Responses between two frequencies are in the disc of both, which shrinks onto the response; and
/// the response stays below its roll-off from its first frequency on.
#[test]
fn enclosures_contain_the_response() {
    let mut state = 8;
    for number in 0..108 {
        let rig = drawn(number);
        let moving = sometimes_fed(PlantInMotion::new(&rig.plant, &rig.behind), number);
        let [from, to] = moving.range_rad_per_s();
        for _ in 0..30 {
            let low = from * pow(to / from, uniform(&mut state));
            let high = low * (1.0 + 0.02 * uniform(&mut state));
            let held = moving.enclosure([low, high]);
            for part in [0.0, 0.2, 0.7, 1.0] {
                let [command, _] = RespondingPlant::response(&moving, low + part * (high - low));
                assert!(held.contains(command), "rig {number}: {low} to {high}");
            }
            let narrow = moving.enclosure([low, low * (1.0 + 1e-7)]);
            assert!(narrow.radius() < 1e-2 * narrow.distance(), "rig {number} at {low}: {narrow:?}");
        }
        let begins = [1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 1e4].map(|factor| 600.0 * factor);
        let begins = begins.into_iter().find(|frequency| moving.roll_off(*frequency).is_some()).unwrap();
        let bound = moving.roll_off(begins).unwrap();
        for step in 0..400 {
            let beyond = begins * pow(1e3, f64::from(step) / 400.0);
            let [command, _] = RespondingPlant::response(&moving, beyond);
            let fallen = bound * pow(begins / beyond, 3.0);
            assert!(command.norm_sqr().sqrt() <= fallen, "rig {number} at {beyond}");
        }
    }
}

/// Every fourth plant with its load's velocity fed forward, delayed and with a resonant filter.
fn sometimes_fed(plant: PlantInMotion, number: u64) -> PlantInMotion {
    let filter = RateFilter::SecondOrder { frequency_rad_per_s: 700.0, damping_ratio: 0.3 };
    match number % 4 {
        1 => plant.fed_forward(Some(8.0)).filtered(filter).late(1e-3),
        _ => plant,
    }
}

/// Towards zero frequency both paths are those of the slow plant: lines are resistances there, and
/// have crept completely.
#[test]
fn slowly_it_is_a_quotient_of_polynomials() {
    for number in 0..108 {
        let rig = drawn(number);
        let moving = sometimes_fed(PlantInMotion::new(&rig.plant, &rig.behind), number);
        let (slow, [from, _]) = (moving.slow(), moving.range_rad_per_s());
        let frequency = 1e-4 * from;
        let [command, load] = RespondingPlant::response(&moving, frequency);
        let known = slow.command.at_frequency(frequency);
        let known_load = slow.disturbance.as_ref().unwrap().at_frequency(frequency);
        for (found_response, known) in [(command, known), (load, known_load)] {
            assert!(
                (found_response / known - 1.0).norm_sqr().sqrt() < 1e-4,
                "rig {number}: {found_response} {known}"
            );
        }
    }
}
