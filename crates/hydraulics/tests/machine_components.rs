//! Contribution of each component to the machine: closed forms, limits, and a published kind of
//! reference run.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::{exp, sin};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid};
use phea_hydraulics::friction::{Friction, MovingFriction};
use phea_hydraulics::line::{Line, StiffeningMember};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{
    Accumulator, Chambers, INDICATORS, Machine, MachineOptions, PowerUnit, PumpLimited, StartValues,
};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{
    benchmark_components, components, cylinder, hose_line, measured_spool, pipe_line, stopped, valve,
};
use phea_hydraulics::servovalve::{SlowSpool, SpoolImperfection, SpoolState, ramp_delay};
use phea_hydraulics::stiffness::{StiffnessModel, compliance_at};

/// Classical Runge-Kutta step of rates that depend on time.
fn step(state: &mut [f64], time: f64, width: f64, rates: &mut impl FnMut(f64, &[f64], &mut [f64])) {
    let count = state.len();
    let mut slopes = [[0.0; 12]; 4];
    let mut trial = [0.0; 12];
    for (stage, fraction) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
        for index in 0..count {
            let slope = if stage == 0 { 0.0 } else { slopes[stage - 1][index] };
            trial[index] = state[index] + fraction * width * slope;
        }
        rates(time + fraction * width, &trial[..count], &mut slopes[stage][..count]);
    }
    for (index, value) in state.iter_mut().enumerate() {
        let [first, second, third, fourth] = slopes.map(|slope| slope[index]);
        *value += width / 6.0 * (first + 2.0 * (second + third) + fourth);
    }
}

fn machine_of(components: Components, options: &MachineOptions) -> Machine {
    Machine::new(&Actuator::new(components).unwrap(), options).unwrap()
}

fn indicator(name: &str) -> usize {
    INDICATORS.iter().position(|&indicator| indicator == name).unwrap()
}

/// Smooth step of the load by 5 mm from 3.0 to 3.1 s: position and velocity.
fn load_step(time: f64) -> [f64; 2] {
    let fraction = ((time - 3.0) / 0.1).clamp(0.0, 1.0);
    let position = fraction * fraction * fraction * (10.0 - 15.0 * fraction + 6.0 * fraction * fraction);
    let slope = 30.0 * fraction * fraction * (1.0 - fraction) * (1.0 - fraction);
    [0.25 + 5e-3 * position, 5e-3 * slope / 0.1]
}

/// Closed loop of 5 s for the comparison of solvers: PI controller and prefilter, 4 kN at 2 s, 5 mm
/// of load at 3 s.
///
/// ORIGIN: other tool, CVODE at a tolerance of 1e-12 on equal equations written in C
#[test]
fn the_benchmark_agrees_with_the_reference() {
    let machine = machine_of(benchmark_components(), &MachineOptions::default());
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    let mut state = machine.start(&start).unwrap().state;
    state.extend([0.0; 3]);
    let reference = |time: f64| if time < 2.0 { 0.0 } else { 4000.0 };
    let expected = [
        (0.05, 13.3791493708),
        (2.0, 0.0194834536545),
        (2.05, 1097.42257169),
        (3.0, 4000.15959349),
        (3.05, 2054.72492047),
        (5.0, 4000.0002761),
    ];
    let width: f64 = 1e-4;
    let mut done = 0;
    for (time, force) in expected {
        let last = (time / width).round() as usize;
        for index in done..last {
            // held over the step, so that the jump of the reference is at the border of two steps
            let wanted = reference((index as f64 + 0.5) * width);
            let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
                let (plant, loop_states) = state.split_at(7);
                let &[integral, filtered, filtered_rate] = loop_states else { unreachable!() };
                let inputs = load_step(time);
                let error = filtered - machine.measurement(plant, &inputs);
                let command = (0.001 * error + integral).clamp(-10.0, 10.0);
                machine.rates(plant, command, &inputs, &mut rates[..7]);
                rates[7] = 0.008 * error;
                rates[8] = filtered_rate;
                rates[9] = 910.0 * (wanted - filtered) - 83.0 * filtered_rate;
            };
            step(&mut state, index as f64 * width, width, &mut rates);
        }
        done = last;
        let found = machine.signals(&state[..7], &load_step(time)).force;
        assert!((found - force).abs() < 5e-3, "{time} s: {found} against {force}");
    }
}

/// Spool without a machine: opening over a command, sampled every step.
fn spool_run(imperfection: &SpoolImperfection, duration: f64, command: impl Fn(f64) -> f64) -> Vec<[f64; 3]> {
    let valve = valve();
    let mut state = [0.0; 4];
    let named = |state: &[f64]| SpoolState {
        spool: state[0],
        spool_rate: state[1],
        spool_friction: state[2],
        magnetic_lag: state[3],
    };
    let width = 1e-4;
    let mut track = Vec::new();
    for index in 0..(duration / width).round() as usize {
        let time = index as f64 * width;
        let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
            let SpoolState { spool, spool_rate, spool_friction, magnetic_lag } =
                imperfection.rates(&valve, &named(state), command(time));
            rates.copy_from_slice(&[spool, spool_rate, spool_friction, magnetic_lag]);
        };
        step(&mut state, time, width, &mut rates);
        let time = time + width;
        track.push([time, command(time), imperfection.opening(&named(&state))]);
    }
    track
}

/// Triangle from 0 up to 1, down to -1 and up again, four times a period.
fn triangle(phase: f64) -> f64 {
    let phase = (phase + 0.25).rem_euclid(1.0);
    1.0 - 4.0 * (phase - 0.5).abs()
}

/// A slow cycle reproduces the measured null: rising at 0.078 V, falling at -0.05 V (section 5.2.1
/// of the thesis).
#[test]
fn a_slow_cycle_finds_null_at_bias_and_half_width() {
    for threshold in [None, Some(0.05)] {
        let spool = SpoolImperfection { threshold, ..measured_spool() };
        let track = spool_run(&spool, 16.0, |time| 0.6 * triangle(time / 8.0));
        let crossings: Vec<f64> = track[70_000..]
            .windows(2)
            .filter(|pair| pair[0][2] * pair[1][2] <= 0.0)
            .map(|pair| pair[1][1])
            .collect();
        let [rising, falling] = crossings[..] else { panic!("{crossings:?}") };
        assert!((falling + 0.05).abs() < 2e-3 && (rising - 0.078).abs() < 2e-3, "{crossings:?}");
    }
}

/// A slow test and the machine have equal openings: that of the memories less the lag of the spool
/// relative to a steadily moving command. The memories of the machine follow the lagging spool:
/// next to a reversal that changes the opening by up to twice the lag.
#[test]
fn the_machine_has_the_hysteresis_of_a_slow_test() {
    let spool = measured_spool();
    let track = spool_run(&spool, 12.0, |time| 0.6 * triangle(time / 8.0));
    let mut memory = SlowSpool::at(0.0);
    let rate = 4.0 * 0.6 / 8.0;
    let valve = valve();
    let lag = rate * ramp_delay(valve.natural_frequency, valve.damping_ratio);
    for pair in track.windows(2) {
        let ([_, before, _], [time, command, opening]) = (pair[0], pair[1]);
        let late = spool.slow_opening(&mut memory, command) - (command - before).signum() * lag;
        let begun = if time < 2.0 { time } else { (time - 2.0).rem_euclid(4.0) };
        let left = 2.0 * exp(-rate * begun / 0.128) + 1e-3;
        // ten time constants of the spool
        if begun > 0.02 {
            assert!((opening - late).abs() < left * lag, "{time}: {opening} for {late}, lag {lag}");
        }
    }
}

/// Within the threshold, a reversal moves the opening by 7 % of the command (x = 2 exp(-20 x), half
/// of x); twice as much moves it by nearly all of the excess.
#[test]
fn a_reversal_takes_the_threshold() {
    let spool = SpoolImperfection { threshold: Some(0.05), ..SpoolImperfection::default() };
    let there = |time: f64| if time < 4.0 { 0.25 * time } else { 1.0 - 0.05 * (time - 4.0) };
    let track = spool_run(&spool, 6.0, there);
    let opening = |time: f64| track[(time * 1e4).round() as usize - 1][2];
    let moved = |by: f64| opening(4.0) - opening(4.0 + by / 0.05);
    assert!(moved(0.05) > 0.0 && moved(0.05) < 0.08 * 0.05, "{}", moved(0.05));
    assert!((moved(0.1) - 0.05).abs() < 1e-3, "{}", moved(0.1));
}

/// A large step moves at the rate limit, a small one is unaffected by it.
#[test]
fn the_rate_is_limited() {
    let free = SpoolImperfection::default();
    let limited = SpoolImperfection { rate_limit: Some(500.0), ..free };
    let great = spool_run(&limited, 0.012, |_| 8.0);
    for pair in great[10..100].windows(2) {
        assert!((pair[1][2] - pair[0][2] - 500.0 * 1e-4).abs() < 1e-9);
    }
    let small = |spool: &SpoolImperfection| spool_run(spool, 0.012, |_| 0.5);
    for (one, other) in
        small(&free).iter().zip(small(&SpoolImperfection { rate_limit: Some(5000.0), ..free }))
    {
        assert_eq!(one[2], other[2]);
    }
    assert!(small(&limited)[20][2] <= small(&free)[20][2]);
}

fn foamy() -> Components {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    let air = Some(EntrainedAir { volume_fraction: 0.02, polytropic_exponent: 1.4 });
    let hose = components(hose_line(), StiffnessModel::ByVolume);
    Components {
        fluid: Fluid { entrained_air: air, ..hose.fluid },
        cylinder: Cylinder { area_a, area_b, dead_volume_a: 2e-5, dead_volume_b: 1e-5, ..cylinder() },
        line_b: pipe_line(),
        ..hose
    }
}

/// Compliances with air equal those of the actuator at equal pressures, for every kind of line and
/// both models.
#[test]
fn air_softens_each_chamber_by_its_own_pressure() {
    let volume = Line::Volume { volume: 1.9e-4, effective_bulk_modulus: 2.6e8 };
    for stiffness_model in [StiffnessModel::Uniform, StiffnessModel::ByVolume] {
        for line_a in [hose_line(), pipe_line(), volume] {
            let actuator = Actuator::new(Components { line_a, stiffness_model, ..foamy() }).unwrap();
            for member in [StiffeningMember::Minimum, StiffeningMember::Maximum] {
                let chambers = Chambers::new(&actuator, member);
                for pressures in [[1e5, 60e5], [35e5, 3e5]] {
                    for x in [0.0, 0.13, 0.5] {
                        let found = chambers.compliance(x, pressures);
                        let of = actuator.chamber_compliance(pressures, member);
                        for (found, expected) in found.iter().zip(compliance_at(&of, x)) {
                            assert!((found / expected - 1.0).abs() < 1e-13);
                        }
                    }
                }
            }
        }
    }
    // below vacuum there is no such oil, but the result is still a number
    let machine = machine_of(foamy(), &MachineOptions::default());
    let mut rates = [f64::NAN; 6];
    machine.rates(&[0.0, 0.0, -3e5, 35e5, 0.0, 0.0], 0.0, &[0.25, 0.0], &mut rates);
    assert!(rates.iter().all(|rate| rate.is_finite()));
}

/// Slowly moving bristles give the static curve, and so does the smoothed curve except near
/// standstill.
#[test]
fn slow_bristles_are_the_static_curve() {
    let Friction::LuGre(lugre) = benchmark_components().friction else { unreachable!() };
    let curve = lugre.curve;
    let bristles = MovingFriction::new(&Friction::LuGre(lugre)).unwrap();
    let smoothed = |regular_velocity| MovingFriction::new(&Friction::Stribeck { curve, regular_velocity });
    let smooth = smoothed(Some(1e-6)).unwrap();
    assert_eq!(smoothed(None), None);
    let velocity = |time: f64| 0.02 * sin(0.05 * time);
    let mut state = [0.0];
    for index in 0..240_000 {
        let time = index as f64 * 5e-4;
        let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
            rates[0] = bristles.at(velocity(time), state[0]).bristle_rate;
        };
        step(&mut state, time, 5e-4, &mut rates);
        let now = velocity(time + 5e-4);
        if now.abs() > 1e-3 {
            let steady = curve.steady_force(now);
            assert!((bristles.at(now, state[0]).force - steady).abs() < 5e-3 * steady.abs(), "{now}");
            assert!((smooth.at(now, 0.0).force - steady).abs() < 1e-6 * steady.abs());
        }
    }
}

/// A mass thrown at a contact comes back with 1 - 2 c v/3 of its speed: Hunt and Crossley's result
/// for slow impacts.
#[test]
fn contacts_restitute_after_hunt_and_crossley() {
    for relative_damping in [0.0, 0.05, 0.2] {
        let contact = Contact { stiffness: 1e6, relative_damping };
        let (mass, speed) = (4.0, 0.1);
        let mut state = [0.0, speed];
        let mut time = 0.0;
        while state[0] >= 0.0 {
            let mut rates = |_: f64, state: &[f64], rates: &mut [f64]| {
                rates[0] = state[1];
                rates[1] = -contact.force(state[0], state[1]) / mass;
            };
            step(&mut state, time, 1e-6, &mut rates);
            time += 1e-6;
        }
        let restitution = -state[1] / speed;
        let slow = 1.0 - 2.0 / 3.0 * relative_damping * speed;
        let next_order = (relative_damping * speed) * (relative_damping * speed);
        assert!((restitution - slow).abs() < next_order + 1e-8, "{restitution} against {slow}");
    }
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

/// A pump holds nearly the stated pressure while it has flow to spare; if more is required, it
/// limits the velocity and the pressure falls.
#[test]
fn a_pump_delivers_its_available_flow() {
    let unit = PumpLimited { accumulator: None, ..pump() };
    let rig = components(hose_line(), StiffnessModel::ByVolume);
    let rig = Components { power_unit: PowerUnit::PumpLimited(unit), ..rig };
    let (actuator, machine) = (Actuator::new(rig).unwrap(), machine_of(rig, &MachineOptions::default()));
    let idle = operating_point(&actuator, 0.25, Condition::Load(SteadyLoad::Force(0.0))).unwrap();
    let rest = machine.rest(&idle).unwrap();
    let outputs = machine.signals(&rest.state, &rest.inputs);
    let [supply, taken] = [outputs.supply_pressure, outputs.supply_flow];
    // leakage and tare flow of the valve do not pass the relief valve
    assert!((supply - (70e5 - 5e5 * taken / unit.pump_flow)).abs() < 1.0);
    assert!(taken > 7e-6 && taken < 4e-5);
    let load = Load::SpringMassDamper { mass: 5.0, stiffness: 0.0, damping: 5e3 };
    let machine = machine_of(Components { load, ..rig }, &MachineOptions::default());
    let start = StartValues { position: 0.1, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    let mut state = beginning.state;
    for index in 0..40_000 {
        let mut rates =
            |_: f64, state: &[f64], rates: &mut [f64]| machine.rates(state, 10.0, &beginning.inputs, rates);
        step(&mut state, index as f64 * 2e-5, 2e-5, &mut rates);
    }
    let outputs = machine.signals(&state, &beginning.inputs);
    let velocity = outputs.piston.velocity;
    let given = unit.pump_flow - (outputs.supply_flow - rig.cylinder.area_a * velocity);
    assert!((rig.cylinder.area_a * velocity / given - 1.0).abs() < 1e-6);
    assert!(outputs.supply_pressure < 40e5 && velocity > 0.09);
}

/// Oil volume in an accumulator agrees with the polytropic compression of its gas.
#[test]
fn accumulators_hold_a_polytropic_gas() {
    let unit = pump();
    let bare = PumpLimited { accumulator: None, ..unit };
    let atmosphere = ATMOSPHERIC_PRESSURE_ABSOLUTE;
    let gas = |pressure: f64| {
        let ratio = (40e5 + atmosphere) / (pressure + atmosphere);
        1e-3 * phea_dynamics::portable::pow(ratio, 1.0 / 1.3)
    };
    for pressure in [41e5, 55e5, 70e5] {
        let slope = (gas(pressure - 10.0) - gas(pressure + 10.0)) / 20.0;
        let found = unit.compliance(pressure) - bare.compliance(pressure);
        assert!((found / slope - 1.0).abs() < 1e-8);
    }
    assert_eq!(unit.compliance(39e5), bare.compliance(39e5));
}

/// The supply delivers the flow of the edges and the tare flow, which is proportional to the root
/// of the pressure.
#[test]
fn tare_flow_is_the_supplys() {
    let with = |pressure: f64, tare_flow: f64| {
        let rig = components(hose_line(), StiffnessModel::ByVolume);
        let supply = phea_hydraulics::servovalve::Supply { pressure, tank_pressure: 0.0 };
        let valve = phea_hydraulics::servovalve::Servovalve { tare_flow, ..rig.valve };
        let machine = machine_of(Components { supply, valve, ..rig }, &MachineOptions::default());
        machine.signals(&[0.3, 0.0, 20e5, 15e5, 0.0, 0.0], &[0.2, 0.0]).supply_flow
    };
    for (pressure, fraction) in [(70e5, 1.0), (17.5e5, 0.5)] {
        let tare = with(pressure, 7.55e-6) - with(pressure, 0.0);
        assert!((tare / (fraction * 7.55e-6) - 1.0).abs() < 1e-6);
    }
}

/// Signs of events agree with their direction.
#[test]
fn indicators_turn_negative_with_their_events() {
    let contact = Contact { stiffness: 1e8, relative_damping: 0.0 };
    let Contact { stiffness, relative_damping } = contact;
    let load = Load::Wall { mass: Some(8.0), damping: 50.0, stiffness, gap: 1e-3, relative_damping };
    let rig = stopped(components(hose_line(), StiffnessModel::ByVolume), contact);
    let machine = machine_of(Components { load, ..rig }, &MachineOptions::default());
    let negative = |pressure_a: f64, position: f64, ground: f64| {
        let state = [0.0, 0.0, pressure_a, 30e5, 0.0, 0.0, position - ground, 0.0];
        let mut indicators = [0.0; INDICATORS.len()];
        machine.indicate(&state, &[ground, 0.0], &mut indicators);
        (0..INDICATORS.len()).filter(|&index| indicators[index] < 0.0).collect::<Vec<_>>()
    };
    assert_eq!(negative(30e5, 0.25, 0.25), []);
    assert_eq!(negative(-1.02e5, 0.25, 0.25), [indicator("cavitation_a")]);
    assert_eq!(negative(30e5, -1e-5, 0.0), [indicator("end_stop_a")]);
    assert_eq!(negative(30e5, 0.51, 0.51), [indicator("end_stop_b")]);
    assert_eq!(negative(30e5, 0.252, 0.25), [indicator("load_contact")]);
    assert_eq!(negative(30e5, -0.8, -0.8), [indicator("end_stop_a"), indicator("empty_a")]);
}
