//! Each passive part in isolation: for any drive at its port, no more energy leaves than enters.
//!
//! The valve is shut at null, no flow reaches it, friction is zero, and the load or its ground
//! makes random strokes. The power at a port is its effort times its flow, found from pressures,
//! motions and areas, not from the accounts of the machine:
//!
//! ```text
//! lost(t) = integral of effort times flow - (stored(t) - stored(0))
//! it never decreases, and stays zero without losses
//! ```

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::{cos, ln, pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::{
    Accumulator, ChamberGas, GasContent, GasPassage, GasValve, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::Components;
use phea_hydraulics::cross_port::{CrossPort, Restrictor};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::force_sensor::ForceSensor;
use phea_hydraulics::friction::Friction;
use phea_hydraulics::line::Line;
use phea_hydraulics::linkage::{LinkageGeometry, PivotTriangle};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{ENERGY_ACCOUNTS, Machine, MachineOptions, OIL_ACCOUNTS, StartValues};
use phea_hydraulics::outward_flow::OutwardFlow;
use phea_hydraulics::reference_rig::{components, cylinder};
use phea_hydraulics::servovalve::{Edges, Servovalve, Supply};
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::stroke::{ActuatorStroke, PistonStage, Telescope};

use super::linkage::{OFFSET, STROKE, knee, linkages};
use super::machine_conservation::{machine_of, step};

const ATMOSPHERE: f64 = 101_325.0;
const MODULUS: f64 = 1.45e9;
/// Compliance of a line that yields less than the gas, and of one with constant pressure, m3/Pa.
const LINE: f64 = 1e-12;
const SOFT_LINE: f64 = 1e-9;
const MIDDLE: f64 = 0.25;
const REST: f64 = 35e5;

fn line(compliance: f64) -> Line {
    Line::Volume { volume: 2e8 * compliance, effective_bulk_modulus: 2e8 }
}

/// Cylinder of the reference rig with a valve without flow, without friction.
fn closed(compliances: [f64; 2]) -> Components {
    let [line_a, line_b] = compliances.map(line);
    let rig = components(line_a, StiffnessModel::ByVolume);
    let valve = Servovalve { leakage_coefficients: Edges::equal(1e-25), ..rig.valve };
    Components { valve, line_b, friction: Friction::Viscous { viscous: 0.0 }, ..rig }
}

/// Target of the load, one stroke after the other of random length and duration.
struct Strokes {
    times: Vec<f64>,
    positions: Vec<f64>,
}

/// Strokes of a run, and the longest of them in s.
const STROKES: usize = 60;
const LONGEST: f64 = 8e-3;
/// Step of the integration, s; a whole number of times that of a run.
const WIDTH: f64 = 2e-5;

/// Parameters of a random run: its number, the displacement of the ground to either side, and the
/// number of steps into which `WIDTH` is divided.
type History = (u64, f64, u32);

impl Strokes {
    /// Displacement up to `reach` to either side of the start.
    fn drawn(number: u64, start: f64, reach: f64) -> Strokes {
        let mut state = stream(93, number);
        let (mut times, mut positions) = (vec![0.0], vec![start]);
        for index in 0..STROKES {
            // whole steps, so that no step has two strokes
            let steps = (LONGEST / WIDTH * (0.2 + 0.8 * uniform(&mut state))).round();
            times.push(times[index] + steps * WIDTH);
            positions.push(start + reach * (2.0 * uniform(&mut state) - 1.0));
        }
        Strokes { times, positions }
    }

    fn duration(&self) -> f64 {
        self.times[STROKES]
    }

    /// Position and velocity: 3 u^2 - 2 u^3 of a stroke at its time fraction u.
    fn at(&self, time: f64) -> [f64; 2] {
        let next = self.times.partition_point(|of| *of <= time).clamp(1, STROKES);
        let [from, to] = [self.positions[next - 1], self.positions[next]];
        let duration = self.times[next] - self.times[next - 1];
        let fraction = (time - self.times[next - 1]) / duration;
        let way = fraction * fraction * (3.0 - 2.0 * fraction);
        [from + (to - from) * way, (to - from) * 6.0 * fraction * (1.0 - fraction) / duration]
    }
}

/// A machine in motion.
struct Now<'a> {
    machine: &'a Machine,
    state: &'a [f64],
    rates: &'a [f64],
    inputs: [f64; 2],
}

impl Now<'_> {
    /// Flow that leaves chambers A and B other than by the motion of the piston, m3/s: from areas
    /// and compliances of the closed rig.
    fn leaving(&self, lines: [f64; 2]) -> [f64; 2] {
        let Cylinder { area_a, area_b, .. } = cylinder();
        let position = self.inputs[0] + self.state[4];
        let [to_a, to_b] = [area_a * position, area_b * (0.5 - position)];
        let [yields_a, yields_b] = [lines[0] + to_a / MODULUS, lines[1] + to_b / MODULUS];
        let velocity = self.state[5];
        [-area_a * velocity - yields_a * self.rates[2], area_b * velocity - yields_b * self.rates[3]]
    }

    fn stored(&self, account: &str) -> f64 {
        let place = ENERGY_ACCOUNTS.iter().position(|known| *known == account).unwrap();
        self.machine.ledger(self.state, &self.inputs).unwrap().energy[place].stored
    }

    fn oil(&self, account: &str) -> f64 {
        let place = OIL_ACCOUNTS.iter().position(|known| *known == account).unwrap();
        self.machine.ledger(self.state, &self.inputs).unwrap().oil[place].stored
    }
}

/// Result of a run at a port, J.
struct Passed {
    /// Total energy through the port, in both directions.
    through: f64,
    /// Least net energy that had entered at any time.
    least: f64,
    /// Energy lost until the end, its apparent decrease during the run, and its greatest distance
    /// from zero.
    lost: f64,
    fallen: f64,
    farthest: f64,
}

/// Run from rest under these strokes of the ground: the power into a port in W, and the energy
/// stored in the part in J.
fn run(
    machine: &Machine,
    start: &StartValues,
    (number, reach, cut): History,
    power: impl Fn(&Now) -> f64,
    stored: impl Fn(&Now) -> f64,
) -> Passed {
    let beginning = machine.start(start).unwrap();
    let strokes = Strokes::drawn(number, beginning.inputs[0], reach);
    let count = machine.states();
    let now = |time: f64, state: &[f64], read: &dyn Fn(&Now) -> f64| {
        let inputs = strokes.at(time);
        let mut rates = vec![0.0; count];
        machine.rates(&state[..count], 0.0, &inputs, &mut rates);
        let value = read(&Now { machine, state: &state[..count], rates: &rates, inputs });
        (rates, value)
    };
    let mut state = [&beginning.state[..], &[0.0, 0.0]].concat();
    let (_, at_first) = now(0.0, &state, &stored);
    let mut rates = |time: f64, state: &[f64]| {
        let (mut rates, power) = now(time, state, &power);
        rates.extend([power, power.abs()]);
        rates
    };
    let mut passed = Passed { through: 0.0, least: 0.0, lost: 0.0, fallen: 0.0, farthest: 0.0 };
    let mut most = 0.0_f64;
    let width = WIDTH / f64::from(cut);
    let steps = (strokes.duration() / width).round() as u32;
    for index in 0..steps {
        step(&mut state, f64::from(index) * width, width, &mut rates);
        if (index + 1) % cut > 0 {
            continue;
        }
        let (_, stored) = now(f64::from(index + 1) * width, &state, &stored);
        let lost = state[count] - (stored - at_first);
        most = most.max(lost);
        passed = Passed {
            through: state[count + 1],
            least: passed.least.min(state[count]),
            lost,
            fallen: passed.fallen.max(most - lost),
            farthest: passed.farthest.max(lost.abs()),
        };
    }
    passed
}

/// Fraction of the throughput by which the loss may seem to decrease: for a method of fourth order.
const ERROR: f64 = 1e-7;

/// No part supplies more energy than it received, from any instant on and from its rest of least
/// energy.
fn check(what: &str, passed: &Passed, error: f64) {
    let Passed { through, least, fallen, .. } = *passed;
    assert!(through > 1.0 && least >= -error * through, "{what}: {least} of {through}");
    assert!(fallen <= error * through, "{what} gives {fallen} of {through}");
}

/// The part dissipates energy.
fn check_lossy(what: &str, passed: &Passed) {
    check(what, passed, ERROR);
    assert!(passed.lost > 1e-3 * passed.through, "{what}: {} of {}", passed.lost, passed.through);
}

/// The part dissipates no energy.
fn check_lossless(what: &str, passed: &Passed, error: f64) {
    check(what, passed, error);
    assert!(passed.farthest <= error * passed.through, "{what}: {} of {}", passed.farthest, passed.through);
}

/// Numbers that differ from run to run.
fn spreads(number: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut state = stream(94, number);
    move |low, high| low * pow(high / low, uniform(&mut state))
}

fn at_rest(pressure: f64) -> StartValues {
    StartValues { position: MIDDLE, pressure_a: pressure, pressure_b: pressure, ..StartValues::default() }
}

const RUNS: u64 = 8;

/// Flow that enters one port of a valve between the chambers leaves the other.
#[test]
fn valves_between_the_chambers_are_passive() {
    for number in 0..2 * RUNS {
        let mut spread = spreads(number);
        let restrictor = Restrictor::Orifice {
            flow_coefficient: spread(3e-9, 1e-7),
            transition_pressure: spread(1e4, 1e5),
        };
        let capacity = (number % 2 == 1).then(|| spread(2e-13, 2e-12));
        let cross_port = Some(CrossPort { restrictor, capacity });
        let machine = machine_of(Components { cross_port, ..closed([LINE; 2]) }, &MachineOptions::default());
        let power = |now: &Now| {
            let [from_a, from_b] = now.leaving([LINE; 2]);
            assert!((from_a + from_b).abs() < 1e-9 * from_a.abs().max(1e-6), "{from_a} {from_b}");
            now.state[2] * from_a + now.state[3] * from_b
        };
        let of_capacity = |now: &Now| now.stored("cross_port");
        let passed = run(&machine, &at_rest(REST), (number, 1.5e-3, 1), power, of_capacity);
        check_lossy(&format!("valve {number}"), &passed);
    }
}

/// Gas that is compressed from below its precharge, where it contains no oil; small steps while its
/// bladder lifts and its compliance begins.
#[test]
fn polytropic_gas_is_lossless() {
    for number in 0..RUNS / 2 {
        let mut spread = spreads(number);
        let gas = Accumulator {
            gas_volume: spread(1e-5, 4e-5),
            precharge_pressure: spread(15e5, 25e5),
            polytropic_exponent: spread(1.0, 1.6),
        };
        let lines = [5e-12, SOFT_LINE];
        let machine = machine_of(
            Components { gas: [Some(gas.into()), None], ..closed(lines) },
            &MachineOptions::default(),
        );
        let power = |now: &Now| now.state[2] * now.leaving(lines)[0];
        let start = at_rest(0.95 * gas.precharge_pressure);
        let passed = run(&machine, &start, (number, 3e-3, 16), power, |now| now.stored("accumulator_a"));
        check_lossless(&format!("gas {number}"), &passed, 1e-5);
    }
}

/// Gas that exchanges heat with its wall can do work by the heat of the wall: its stored energy is
/// the available work at the temperature of the wall, U - T_w S, with an atmosphere and a chamber
/// of constant pressure.
///
/// ```text
/// U - T_w S = P_0 V_0 ((theta - 1 - ln theta)/(gamma - 1) - ln (V/V_r)),     V = P_0 V_0 theta/P
/// ```
#[test]
fn gas_with_heat_is_passive() {
    for number in 0..RUNS {
        let mut spread = spreads(number);
        let gas = RelaxingGas {
            gas_volume: spread(2e-5, 6e-5),
            precharge_pressure: spread(2e5, 6e5),
            time_constant: spread(3e-3, 0.1),
        };
        let lines = [LINE, SOFT_LINE];
        let sealed = SealedGas {
            content: GasContent::Relaxing(gas),
            passage: GasPassage::Open,
            maximum_pressure_ratio: None,
        };
        let rig = Components { gas: [Some(ChamberGas::Sealed(sealed)), None], ..closed(lines) };
        let machine = machine_of(rig, &MachineOptions::default());
        let amount = (gas.precharge_pressure + ATMOSPHERE) * gas.gas_volume;
        let at_first = amount / (REST + ATMOSPHERE);
        let power = |now: &Now| (now.state[2] - REST) * now.leaving(lines)[0];
        let free = |now: &Now| {
            let (pressure, theta) = (now.state[2], 1.0 + now.state[6]);
            assert!(
                pressure > 1.2 * (gas.precharge_pressure + ATMOSPHERE) * theta - ATMOSPHERE,
                "{pressure}"
            );
            let volume = amount * theta / (pressure + ATMOSPHERE);
            let of_gas = amount * ((theta - 1.0 - ln(theta)) / 0.4 - ln(volume / at_first));
            of_gas + (REST + ATMOSPHERE) * (volume - at_first)
        };
        let passed = run(&machine, &at_rest(REST), (number, 2.5e-3, 1), power, free);
        check_lossy(&format!("gas with heat {number}"), &passed);
    }
}

/// Gas valve at a constant opening, seen from a chamber at rest.
#[test]
fn a_gas_valve_is_passive() {
    for number in 0..RUNS {
        let mut spread = spreads(number);
        let gas = Accumulator {
            gas_volume: spread(1e-5, 4e-5),
            precharge_pressure: spread(5e5, 15e5),
            polytropic_exponent: spread(1.0, 1.6),
        };
        let valve = GasValve {
            flow_coefficient: spread(3e-8, 3e-7),
            transition_pressure: spread(1e4, 1e5),
            compliance: spread(1e-14, 1e-13),
            setting: spread(0.1, 1.0),
            shut: false,
        };
        let lines = [LINE, SOFT_LINE];
        let sealed = SealedGas {
            content: GasContent::Polytropic(gas),
            passage: GasPassage::Valve(valve),
            maximum_pressure_ratio: None,
        };
        let rig = Components { gas: [Some(ChamberGas::Sealed(sealed)), None], ..closed(lines) };
        let machine = machine_of(rig, &MachineOptions::default());
        let power = |now: &Now| (now.state[2] - REST) * now.leaving(lines)[0];
        let stored = |now: &Now| {
            let energy = now.stored("accumulator_a") + now.stored("neck_a");
            energy - REST * (now.oil("accumulator_a") + now.oil("neck_a"))
        };
        let passed = run(&machine, &at_rest(REST), (number, 1.5e-3, 1), power, stored);
        check_lossy(&format!("gas valve {number}"), &passed);
    }
}

fn with_stroke(stroke: ActuatorStroke) -> Components {
    let rig = closed([LINE; 2]);
    Components { cylinder: Cylinder { stroke, ..rig.cylinder }, ..rig }
}

/// Joint of a knee whose angle is prescribed, with its torque by the law of cosines.
#[test]
fn a_linkage_is_lossless_at_its_joint() {
    let PivotTriangle { cylinder_pivot: a, rod_pivot: b, retracted_length } = knee();
    let linkage = LinkageGeometry::Triangle(knee()).reduced(STROKE, OFFSET).unwrap().linkage;
    for number in 0..RUNS {
        let rig = with_stroke(ActuatorStroke::Limited(STROKE));
        let stiffness = rig.force_sensor.stiffness;
        let machine = machine_of(Components { linkage: Some(linkage), ..rig }, &MachineOptions::default());
        let power = |now: &Now| {
            let opening = now.inputs[0] + OFFSET;
            let length = (a * a + b * b - 2.0 * a * b * cos(opening)).sqrt();
            assert!(length > retracted_length);
            -stiffness * now.state[4] * a * b * sin(opening) / length * now.inputs[1]
        };
        let start = StartValues { position: 0.02 + 0.005 * number as f64, ..at_rest(REST) };
        let passed = run(&machine, &start, (number, 0.03, 1), power, |now| now.stored("rig"));
        check_lossless(&format!("knee {number}"), &passed, ERROR);
    }
}

/// Load that oscillates with its weight on a spring, whose ground is moved, with linkages of every
/// kind between it and the oil.
#[test]
fn a_linkage_is_lossless_before_a_load_with_weight() {
    let stiffness = 8e3;
    let load = Load::SpringMassDamper { mass: 0.2, stiffness, damping: 0.0 };
    for (number, linkage) in (0..).zip(linkages()) {
        let rig = Components {
            linkage: Some(linkage.level_at(1.2).with_moment(15.0)),
            load,
            ..with_stroke(ActuatorStroke::Limited(STROKE))
        };
        let machine = machine_of(rig, &MachineOptions::default());
        let start = StartValues { position: 0.04, ..at_rest(REST) };
        let held = machine.start(&start).unwrap().state[6];
        // in addition to the torque that holds the weight at rest
        let power = |now: &Now| -stiffness * (now.state[6] - held) * now.inputs[1];
        let stored = |now: &Now| now.stored("rig") + stiffness * held * now.inputs[0];
        let passed = run(&machine, &start, (number, 0.05, 1), power, stored);
        check_lossless(&format!("linkage {number}"), &passed, ERROR);
    }
}

/// Telescopic piston through both transitions of its areas, seen from the force at its rest.
#[test]
fn a_telescopic_piston_is_lossless() {
    for number in 0..RUNS {
        let mut spread = spreads(number);
        let mut stage = |from: f64| {
            let ratios = [spread(0.5, 1.4), spread(0.5, 1.4)];
            Some(PistonStage { from, ratios })
        };
        let stages = [stage(0.2), stage(0.202), None];
        let rig =
            with_stroke(ActuatorStroke::Telescopic(Telescope { stroke: 0.5, stages, transition: 1.5e-3 }));
        let stiffness = rig.force_sensor.stiffness;
        let machine = machine_of(rig, &MachineOptions::default());
        let position = 0.2 + 3e-4 * number as f64;
        let [area_a, area_b] = rig.cylinder.areas_at(position);
        let force = (area_a - area_b) * REST;
        let power = |now: &Now| -(stiffness * now.state[4] - force) * now.inputs[1];
        let stored = |now: &Now| now.stored("rig") + force * now.inputs[0];
        let start = StartValues { position, force, ..at_rest(REST) };
        let passed = run(&machine, &start, (number, 2e-3, 1), power, stored);
        check_lossless(&format!("telescopic piston {number}"), &passed, ERROR);
    }
}

/// Motor with unlimited rotation, tight, or leaking from chamber to chamber or to the tank, at its
/// shaft: energy of its oil at constant volumes, relative to tank pressure.
#[test]
fn a_motor_is_passive_at_its_shaft() {
    for number in 0..RUNS {
        let mut spread = spreads(number);
        let rig = closed([LINE; 2]);
        let (displacement, inertia) = (spread(1e-5, 6e-5), spread(3e-3, 3e-2));
        let [dead_volume_a, dead_volume_b] = [spread(1e-5, 1e-4), spread(1e-5, 1e-4)];
        let cylinder = Cylinder {
            area_a: displacement,
            area_b: displacement,
            stroke: ActuatorStroke::Unlimited,
            moving_mass: inertia,
            dead_volume_a,
            dead_volume_b,
            // each separately, so that none hides the energy that another supplies
            internal_leakage: (number % 3 == 1).then(|| spread(5e-12, 5e-11)),
            ..rig.cylinder
        };
        let external_leakage = (number % 3 == 2).then(|| spread(5e-12, 5e-11));
        let stiffness = spread(5e3, 5e4);
        let rig = Components {
            cylinder,
            outward: OutwardFlow { external_leakage, ..OutwardFlow::default() },
            supply: Supply { pressure: REST + 1e5, tank_pressure: REST },
            force_sensor: ForceSensor { stiffness },
            ..rig
        };
        let machine = machine_of(rig, &MachineOptions::default());
        let power = |now: &Now| -stiffness * now.state[4] * now.inputs[1];
        let stored = |now: &Now| {
            let square = |value: f64| value * value;
            let of = |pressure: f64, dead: f64| (LINE + dead / MODULUS) * square(pressure - REST);
            let oil = of(now.state[2], dead_volume_a) + of(now.state[3], dead_volume_b);
            0.5 * (oil + inertia * square(now.state[5]) + stiffness * square(now.state[4]))
        };
        let passed = run(&machine, &at_rest(REST), (number, 0.05, 1), power, stored);
        match number % 3 {
            0 => check_lossless(&format!("motor {number}"), &passed, ERROR),
            _ => check_lossy(&format!("leaking motor {number}"), &passed),
        }
    }
}
