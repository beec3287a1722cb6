//! The spring between force sensor and load: the linear plant compared with the machine, the rigid
//! limit, ledgers and passivity.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::controller::RateFilter;
use phea_dynamics::portable::{pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::force_sensor::{ForceSensor, in_series};
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::{DynamicLine, END_SHARE, LineModel, StiffeningMember};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{ENERGY_ACCOUNTS, InitialCondition, Machine, MachineOptions, StartValues};
use phea_hydraulics::operating_point::{Condition, OperatingPoint, operating_point};
use phea_hydraulics::plant::{
    LineChambers, LinearLoad, LinearPlant, LinearSeries, PlantInMotion, SeriesOutput, VelocitySensor,
};
use phea_hydraulics::reference_rig::{components, hose_line, nominal_plant};
use phea_hydraulics::series::{ForceFrom, SeriesElement, SeriesSpring, SeriesTravel};
use phea_hydraulics::servovalve::{Servovalve, SpoolDirection};
use phea_hydraulics::signal::Signal;
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::two_pressure::{TwoPressureModel, two_pressure_linear_parameters};

use super::commanded::{amplitudes, signal_of, slopes};
use super::machine_conservation::{Motion, check, check_instant, machine_of, random, step};

fn rig(spring: SeriesSpring) -> Components {
    Components {
        series: Some(SeriesElement::Spring(spring)),
        ..components(hose_line(), StiffnessModel::ByVolume)
    }
}

/// Spring with nothing, with a damper, with a mass, with both; every other one progressive with
/// ends.
pub(super) fn element(number: u64) -> SeriesSpring {
    let mut state = stream(41, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let free = number.is_multiple_of(4);
    let ends =
        Contact { stiffness: spread(1e7, 1e9), relative_damping: if free { 0.0 } else { spread(0.05, 1.0) } };
    let stiffness = spread(2e5, 2e7);
    // the travel holds the stall force
    let travel = SeriesTravel {
        travel: spread(1.1e4, 5e4) / stiffness,
        progression: Some(spread(0.1, 3.0)),
        ends: Some(ends),
    };
    SeriesSpring {
        stiffness,
        damping: (number % 4 == 1 || number % 4 == 3).then(|| spread(20.0, 2e4)),
        mass: (number % 4 > 1).then(|| spread(0.2, 30.0)),
        travel: (number % 8 > 3).then_some(travel),
        force_from: if number.is_multiple_of(3) { ForceFrom::Deflection } else { ForceFrom::Sensor },
    }
}

pub(super) struct Drawn {
    machine: Machine,
    rest: InitialCondition,
    pub(super) plant: LinearPlant,
}

fn drawn(number: u64) -> Drawn {
    drawn_with(SeriesElement::Spring(element(number)), number)
}

pub(super) fn drawn_with(series: SeriesElement, number: u64) -> Drawn {
    let mut state = stream(42, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let friction = spread(50.0, 2e4);
    let parts = Components {
        friction: Friction::Viscous { viscous: friction },
        force_sensor: ForceSensor { stiffness: spread(1e6, 1e8) },
        series: Some(series),
        ..components(hose_line(), StiffnessModel::ByVolume)
    };
    let (mass, stiffness, damping) = (spread(1.0, 500.0), spread(1e4, 1e8), spread(10.0, 1e4));
    let (load, linear) = match number % 5 {
        0 | 1 => (Load::Prescribed, LinearLoad::Prescribed),
        _ => (
            Load::SpringMassDamper { mass, stiffness, damping },
            LinearLoad::Yielding { mass, damping, stiffness },
        ),
    };
    let actuator = Actuator::new(Components { load, ..parts }).unwrap();
    let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
    let condition = Condition::Command(spread(0.01, 2.0));
    let point = operating_point(&actuator, spread(0.1, 0.4), condition).unwrap();
    let rest = machine.rest(&point).unwrap();
    let pressures = [rest.state[2], rest.state[3]];
    let model = TwoPressureModel::new(&actuator, pressures, StiffeningMember::Nominal, friction);
    let point = OperatingPoint { pressure_a: pressures[0], pressure_b: pressures[1], ..point };
    let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Extending);
    let force = at_rest(&machine, &rest, Signal::LoadForce);
    let series = LinearSeries::of_components(&parts, force);
    let plant = LinearPlant { series, ..LinearPlant::of_two_pressures(&parameters, 0.0, linear) };
    Drawn { machine, rest, plant }
}

fn at_rest(machine: &Machine, rest: &InitialCondition, signal: Signal) -> f64 {
    machine.signals(&rest.state, &rest.inputs).get(signal).unwrap()
}

impl Drawn {
    /// Signal of the machine, for one unit of the command and of the motion of the ground.
    pub(super) fn small_signal(&self, signal: Signal, feed_forward: f64, frequency: f64) -> [Complex64; 2] {
        let slopes = slopes(&self.machine, &self.rest, &[signal]);
        amplitudes(&self.machine, &self.rest, (feed_forward, 1.0), frequency)
            .map(|amplitudes| signal_of(&amplitudes, &slopes[0]))
    }
}

/// 200 rigs at 20 frequencies; every other one feeds the velocity of its load forward.
#[test]
fn it_is_the_machine_for_small_motions() {
    for number in 0..200 {
        is_the_machine(&drawn(number), number);
    }
}

/// Force through the sensor and force on the load, with a velocity that is fed forward in every
/// other rig.
pub(super) fn is_the_machine(rig: &Drawn, number: u64) {
    let gain = if number.is_multiple_of(2) { 0.03 * pow(3e3, number as f64 / 200.0) } else { 0.0 };
    let fed = (gain > 0.0).then_some(gain);
    let plant = LinearPlant { load_velocity_feed_forward: fed, ..rig.plant };
    let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..plant.series.unwrap() };
    let port = LinearPlant { series: Some(on_load), ..plant };
    for (plant, signal) in [(plant, Signal::Force), (port, Signal::LoadForce)] {
        let coefficients = plant.coefficients();
        let disturbance = coefficients.disturbance.unwrap();
        for step in 0..20 {
            let frequency = 1e-2 * pow(1e6, f64::from(step) / 19.0);
            let [command, ground] = rig.small_signal(signal, gain, frequency);
            for (found_response, own) in [(&coefficients.command, command), (&disturbance, ground)] {
                let error = (found_response.at_frequency(frequency) / own - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-6, "rig {number}, {signal:?} at {frequency} rad/s: {error}");
            }
        }
    }
}

/// Path of a load that yields: its velocity per volt.
#[test]
fn the_velocity_of_the_load_is_that_of_the_machine() {
    for number in (2..80).filter(|number| number % 5 > 1) {
        velocity_is_that_of_the_machine(&drawn(number), number);
    }
}

pub(super) fn velocity_is_that_of_the_machine(rig: &Drawn, number: u64) {
    let coefficients = rig.plant.coefficients();
    let rate = coefficients.rate.unwrap();
    let [lumped] = [PlantInMotion::lumped(&rig.plant)];
    for frequency in [0.3, 7.0, 90.0, 1100.0] {
        let at = |polynomial: &[f64]| {
            let s = Complex64::new(0.0, frequency);
            polynomial.iter().fold(Complex64::ZERO, |sum, one| sum * s + *one)
        };
        let own = rig.small_signal(Signal::LoadVelocity, 0.0, frequency);
        let found_response =
            [&rate.command, &rate.disturbance].map(|path| at(path) / at(&coefficients.command.denominator));
        let moving = lumped.load_velocity(Complex64::new(0.0, frequency));
        for ((own, found_response), moving) in own.into_iter().zip(found_response).zip(moving) {
            assert!(
                (found_response / own - 1.0).norm_sqr() < 1e-14,
                "rig {number} at {frequency}: {found_response} {own}"
            );
            assert!((moving / own - 1.0).norm_sqr() < 1e-14, "rig {number} at {frequency}: {moving} {own}");
        }
    }
}

/// The response with lumped lines is that of the polynomials, and its roll-off bounds it, also if
/// the velocity of the load is fed forward from a sensor with an error and a filter.
#[test]
fn the_response_is_that_of_the_polynomials() {
    let bounded: usize = (0..80).map(|number| responds_as_its_polynomials(&drawn(number), number)).sum();
    assert!(bounded > 1000, "{bounded}");
}

/// Number of roll-off bounds that were compared.
pub(super) fn responds_as_its_polynomials(rig: &Drawn, number: u64) -> usize {
    let mut bounded = 0;
    let gain = if number.is_multiple_of(2) { Some(0.1) } else { None };
    let filter = RateFilter::SecondOrder { frequency_rad_per_s: 900.0, damping_ratio: 0.7 };
    let velocity_sensor = match number % 3 {
        0 => VelocitySensor { gain: Some(1.05), filter },
        _ => VelocitySensor::default(),
    };
    let plant = LinearPlant { load_velocity_feed_forward: gain, velocity_sensor, ..rig.plant };
    let coefficients = plant.coefficients();
    let moving = PlantInMotion::lumped(&plant);
    let disturbance = coefficients.disturbance.unwrap();
    for step in 0..20 {
        let frequency = 1e-2 * pow(1e7, f64::from(step) / 19.0);
        let [command, ground] = moving.response(Complex64::new(0.0, frequency));
        for (own, found_response) in [(command, &coefficients.command), (ground, &disturbance)] {
            assert!((own / found_response.at_frequency(frequency) - 1.0).norm_sqr() < 1e-18, "rig {number}");
        }
        use phea_dynamics::uncertain_plant::responding::RespondingPlant;
        let Some(bound) = moving.roll_off(frequency) else { continue };
        for beyond in [1.0, 1.7, 6.0, 50.0] {
            let here = beyond * frequency;
            let found = coefficients.command.at_frequency(here).norm_sqr().sqrt();
            assert!(
                found <= (1.0 + 1e-7) * bound / pow(beyond, 3.0),
                "rig {number} at {here}: {found} {bound}"
            );
            bounded += 1;
        }
    }
    bounded
}

/// A rigid spring has no effect: in the linear plant, with lines in motion and in the machine at
/// rest and in small motions.
#[test]
fn a_rigid_spring_has_no_effect() {
    let rigid = |damping| SeriesSpring {
        stiffness: 1e25,
        damping,
        mass: None,
        travel: None,
        force_from: ForceFrom::Sensor,
    };
    let line = |fluid| {
        let model = LineModel::TransmissionLine { end_share: END_SHARE };
        DynamicLine::new(&hose_line(), &fluid, 35e5, StiffeningMember::Nominal, &model).unwrap()
    };
    for damping in [None, Some(500.0)] {
        for load in
            [LinearLoad::Prescribed, LinearLoad::Yielding { mass: 100.0, damping: 500.0, stiffness: 2e5 }]
        {
            let plain = LinearPlant {
                load_velocity_feed_forward: Some(3.0),
                ..LinearPlant::of_load_pressure(&nominal_plant(), 1e-13, load)
            };
            let series = Some(LinearSeries::of_spring(&rigid(damping), 1e3));
            let sprung = LinearPlant { series, ..plain };
            let behind = LineChambers {
                lines: [line(components(hose_line(), StiffnessModel::ByVolume).fluid); 2],
                chambers: [2.7e-13; 2],
                lumped: [2.7e-13 + 4e-12; 2],
                leaking: [0.0; 2],
            };
            for frequency in [1e-3, 0.5, 20.0, 700.0, 1.3e3, 9e3] {
                let s = Complex64::new(0.0, frequency);
                let of = |plant: &LinearPlant| {
                    let own = plant.coefficients();
                    let ground = own.disturbance.unwrap().at_frequency(frequency);
                    let [moving, _] = PlantInMotion::new(plant, &behind).response(s);
                    [own.command.at_frequency(frequency), ground, moving]
                };
                for (one, other) in of(&plain).into_iter().zip(of(&sprung)) {
                    assert!((one / other - 1.0).norm_sqr() < 1e-18, "{frequency}: {one} {other}");
                }
            }
        }
        let plain = components(hose_line(), StiffnessModel::ByVolume);
        let rests = [plain, rig(rigid(damping))].map(|parts| {
            let actuator = Actuator::new(parts).unwrap();
            let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
            let point = operating_point(&actuator, 0.2, Condition::Command(0.4)).unwrap();
            let rest = machine.rest(&point).unwrap();
            machine.signals(&rest.state, &rest.inputs)
        });
        for signal in Signal::ALL {
            let Some((one, other)) = rests[0].get(*signal).zip(rests[1].get(*signal)) else { continue };
            let absent = [Signal::SeriesDeflection, Signal::Velocity, Signal::LoadVelocity].contains(signal);
            let size = if absent { 1.0 } else { one.abs() };
            assert!((one - other).abs() <= 1e-9 * size, "{signal:?}: {one} {other}");
        }
    }
}

/// A spring without damper and mass is equivalent to a softer force sensor, in the machine too.
#[test]
fn a_spring_without_mass_is_a_softer_sensor() {
    let spring = SeriesSpring {
        stiffness: 2.24e6,
        damping: None,
        mass: None,
        travel: None,
        force_from: ForceFrom::Sensor,
    };
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let plain = components(hose_line(), StiffnessModel::ByVolume);
    let softer = ForceSensor { stiffness: in_series(plain.force_sensor.stiffness, 2.24e6) };
    let machines = [Components { force_sensor: softer, ..plain }, rig(spring)]
        .map(|parts| machine_of(Components { load, ..parts }, &MachineOptions::default()));
    let fraction = softer.stiffness / 2.24e6;
    let motion = Motion { amplitude: 1.5, bias: 0.4, ground: 0.0, ground_amplitude: 1e-3 };
    let start = StartValues {
        position: 0.25,
        pressure_a: 35e5,
        pressure_b: 33e5,
        force: 300.0,
        ..StartValues::default()
    };
    let runs = machines.map(|machine| {
        let beginning = machine.start(&start).unwrap();
        let mut state = beginning.state;
        let mut rates = |time: f64, state: &[f64]| {
            let mut rates = vec![0.0; state.len()];
            machine.rates(state, motion.bias + sin(40.0 * time), &beginning.inputs, &mut rates);
            rates
        };
        for index in 0..2_000 {
            step(&mut state, f64::from(index) * 5e-5, 5e-5, &mut rates);
        }
        (machine.measurement(&state, &beginning.inputs), state)
    });
    let [(force, one), (other_force, other)] = runs;
    assert!((force / other_force - 1.0_f64).abs() < 1e-9, "{force} {other_force}");
    for (index, (one, other)) in one.iter().zip(&other).enumerate() {
        let one = if index == 4 { one * fraction } else { *one };
        assert!((one - other).abs() <= 1e-8 * one.abs().max(1e-6), "{index}: {one} {other}");
    }
}

/// Every kind of element in motion, pressed into its ends and within them.
#[test]
fn ledgers_close() {
    let motion = Motion { amplitude: 1.5, bias: 0.4, ground: 0.0, ground_amplitude: 1e-3 };
    let start = StartValues {
        position: 0.25,
        pressure_a: 35e5,
        pressure_b: 30e5,
        force: 500.0,
        ..StartValues::default()
    };
    let sprung = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    for number in 0..8 {
        for load in [Load::Prescribed, sprung] {
            let own = element(number);
            // a few newtons reach the ends of a short travel
            let travel = own.travel.map(|travel| SeriesTravel { travel: 2e-4, ..travel });
            let own = SeriesSpring { travel, stiffness: 2e6, damping: own.damping.map(|_| 800.0), ..own };
            let own = SeriesSpring { mass: own.mass.map(|_| 3.0), ..own };
            let ends = own.travel.map(|travel| SeriesTravel {
                ends: travel.ends.map(|ends| Contact { stiffness: 2e7, ..ends }),
                ..travel
            });
            // an edge that opens at zero drop is too fast for this method if the root's transition
            // is short
            let parts = rig(SeriesSpring { travel: ends, ..own });
            let valve = Servovalve { transition_pressure: 1e5, ..parts.valve };
            let machine = machine_of(Components { valve, load, ..parts }, &MachineOptions::default());
            check(&machine, &motion, &start, 0.1, 5e-6);
        }
    }
}

/// Accounts at any state, including unreachable ones.
#[test]
fn what_is_stored_changes_by_what_enters_and_is_lost() {
    let mut seed = 5;
    for number in 0..40 {
        let own = element(number);
        let travel = own.travel.map(|travel| SeriesTravel { travel: 1e-3, ..travel });
        let own = SeriesSpring { travel, stiffness: 2e6, ..own };
        let machine = machine_of(rig(own), &MachineOptions::default());
        closes_at_any_state("a series element", &machine, &mut seed);
    }
}

/// Accounts at ten random states around that at rest.
pub(super) fn closes_at_any_state(name: &str, machine: &Machine, seed: &mut u64) {
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    for _ in 0..10 {
        let around = beginning.state.iter().zip(machine.scales());
        let state: Vec<f64> = around.map(|(value, scale)| value + 4.0 * scale * random(seed)).collect();
        let inputs = [0.25 + 0.1 * random(seed), 0.1 * random(seed)];
        check_instant(name, machine, &state, random(seed), inputs);
    }
}

/// Element under any motion of its two ends: from rest, the energy that has entered is never less
/// than the energy returned.
#[test]
fn it_is_passive_under_random_motions_of_its_ports() {
    for number in 0..16 {
        let own = element(number);
        let travel = own.travel.map(|travel| SeriesTravel {
            travel: 3e-4,
            ends: travel.ends.map(|ends| Contact { stiffness: 3e7, ..ends }),
            ..travel
        });
        let own = SeriesSpring {
            travel,
            stiffness: 2e6,
            damping: own.damping.map(|_| 600.0),
            mass: own.mass.map(|_| 2.0),
            ..own
        };
        let machine = machine_of(rig(own), &MachineOptions::default());
        stays_passive(&machine, 43, number);
    }
}

/// Checks passivity from rest, with random motions of both ports of the series element, drawn by
/// this seed.
pub(super) fn stays_passive(machine: &Machine, seed: u64, number: u64) {
    let series = ENERGY_ACCOUNTS.iter().position(|name| *name == "series").unwrap();
    let mut state = stream(seed, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let waves: Vec<[f64; 3]> =
        (0..4).map(|_| [spread(2e-5, 4e-4), spread(20.0, 900.0), spread(0.05, 0.5)]).collect();
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    let ground = |time: f64| {
        let shift = |[size, frequency, _]: &[f64; 3]| size * pow(sin(frequency * time), 2.0);
        let speed = |[size, frequency, _]: &[f64; 3]| size * frequency * sin(2.0 * frequency * time);
        [beginning.inputs[0] + waves.iter().map(shift).sum::<f64>(), waves.iter().map(speed).sum()]
    };
    let count = machine.states();
    let mut state = [&beginning.state[..], &[0.0, 0.0]].concat();
    let mut rates = |time: f64, state: &[f64]| {
        let inputs = ground(time);
        let command: f64 =
            waves.iter().map(|[_, frequency, size]| 4.0 * size * sin(0.7 * frequency * time)).sum();
        let mut rates = vec![0.0; count];
        machine.rates(&state[..count], command, &inputs, &mut rates);
        let inflow = machine.ledger(&state[..count], &inputs).unwrap().energy[series].inflow;
        rates.extend([inflow, inflow.abs()]);
        rates
    };
    let (mut least, mut through) = (0.0_f64, 0.0);
    for index in 0..20_000 {
        step(&mut state, f64::from(index) * 1e-5, 1e-5, &mut rates);
        least = least.min(state[count]);
        through = state[count + 1];
    }
    assert!(through > 0.1 && least >= -1e-6 * through, "{number}: {least} of {through}");
}

/// Impossible elements are rejected with their path.
#[test]
fn impossible_elements_are_refused() {
    let ends = Some(Contact { stiffness: 1e8, relative_damping: 0.5 });
    let travel = Some(SeriesTravel { travel: 5e-3, progression: None, ends });
    let own =
        SeriesSpring { stiffness: 0.0, damping: None, mass: None, travel, force_from: ForceFrom::Sensor };
    let refused = Actuator::new(rig(own)).unwrap_err().to_string();
    assert!(refused.contains("series.stiffness is 0, but must be positive"), "{refused}");
    assert!(refused.contains("series.stop_damping is 0.5, but must be zero where"), "{refused}");
    let fit = SeriesSpring { stiffness: 2e6, damping: Some(100.0), ..own };
    assert!(Actuator::new(rig(fit)).is_ok());
}
