//! The neck of an accumulator at a chamber: its limits, its resonance, passivity, and the pressure
//! that shuts its gas off.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use std::f64::consts::FRAC_PI_4;

use num_complex::Complex64;
use phea_dynamics::portable::{exp, pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::{
    Accumulator, Bladder, ChamberGas, GasBranch, GasContent, GasPassage, Neck, NeckImpedance, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::machine::{ENERGY_ACCOUNTS, INDICATORS, Machine, MachineOptions, StartValues};
use phea_hydraulics::plant::{ChamberDynamics, LinearLoad, LinearPlant, PlantInMotion, YieldingSupply};
use phea_hydraulics::reference_rig::{components, nominal_plant, pipe_line};
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::{check_instant, machine_of, random, step};

/// Density, kinematic viscosity and bulk modulus of the oil.
const OIL: [f64; 3] = [870.0, 46e-6, 1.45e9];
/// The first state of the neck at chamber A of a machine with nothing but necks; its gas pressure
/// follows, then chamber B.
const NECK_FLOW: usize = 6;

fn machine(gas: [Option<Accumulator>; 2], necks: [Option<Neck>; 2]) -> Machine {
    let rig = components(pipe_line(), StiffnessModel::ByVolume);
    let gas = [0, 1].map(|side| Some(behind(gas[side]?, necks[side])));
    machine_of(Components { gas, ..rig }, &MachineOptions::default())
}

/// Polytropic gas behind a neck, or at its chamber.
pub(super) fn behind(gas: Accumulator, neck: Option<Neck>) -> ChamberGas {
    let passage = neck.map_or(GasPassage::Open, GasPassage::Neck);
    ChamberGas::Sealed(SealedGas {
        content: GasContent::Polytropic(gas),
        passage,
        maximum_pressure_ratio: None,
    })
}

/// Bladder of gas with a neck.
pub(super) fn bladder(gas: &Accumulator, neck: &Neck) -> Bladder {
    let absolute = gas.precharge_pressure + 101_325.0;
    let softness = neck.compliance * gas.polytropic_exponent * absolute / gas.gas_volume;
    Bladder { precharge_pressure: gas.precharge_pressure, softness }
}

/// Plants with these compliances and this gas with necks: lumped, and without polynomials; with a
/// constant supply and with one that yields.
pub(super) fn responses(
    compliances: [f64; 2],
    gas: [Option<GasBranch>; 2],
    frequency: f64,
) -> Vec<Complex64> {
    let chambers = ChamberDynamics::TwoPressures {
        areas: [1.5e-3, 1.2e-3],
        compliances,
        flow_gains: [5e-5, 4e-5],
        flow_pressures: [2e-12, 3e-12],
    };
    let yielding =
        YieldingSupply { compliance: 2e-12, conductance: 1e-12, edges: [1e-12, 2e-12], flow_gain: 3e-5 };
    let supplies = [None, Some(yielding)].into_iter();
    supplies
        .flat_map(|supply| {
            let plant = LinearPlant::of_load_pressure(&nominal_plant(), 1e-12, LinearLoad::Prescribed);
            let plant = LinearPlant { chambers, gas, supply, ..plant };
            let coefficients = plant.coefficients();
            let polynomials = [Some(coefficients.command), coefficients.disturbance];
            let s = Complex64::new(0.0, frequency);
            let of_polynomials = polynomials.map(|path| path.unwrap().at_frequency(frequency));
            [of_polynomials, PlantInMotion::lumped(&plant).response(s)].concat()
        })
        .collect()
}

/// Largest relative difference between the plant of a chamber A with gas behind a neck of this
/// length, and the plant with these compliances.
fn apart(length: f64, compliances: [f64; 2], frequency: f64) -> f64 {
    let gas = GasBranch::of(3e-12, None, Some(&Neck::round([6e-3, length], OIL, 1.5)));
    let with = responses([8e-13, 9e-13], [Some(gas), None], frequency);
    let gaps = with.iter().zip(responses(compliances, [None; 2], frequency));
    gaps.map(|(with, without)| (with / without - 1.0).norm_sqr().sqrt()).fold(0.0, f64::max)
}

/// Limits of a neck: if its length tends to zero it has no effect; if it tends to infinity the gas
/// is shut off; between them it does neither.
#[test]
fn a_neck_has_two_limits() {
    let (lumped, without_gas) = ([8e-13 + 3e-12, 9e-13], [8e-13, 9e-13]);
    for frequency in [1e-3, 1.0, 50.0, 700.0, 2e3] {
        assert!(apart(1e-12, lumped, frequency) < 1e-9, "{frequency}: {}", apart(1e-12, lumped, frequency));
        assert!(apart(1e12, without_gas, frequency) < 1e-9, "{frequency}");
    }
    assert!(apart(0.04, lumped, 1e-3) < 1e-6);
    assert!(apart(0.04, lumped, 700.0).min(apart(0.04, without_gas, 700.0)) > 0.1);
}

/// A neck without inertance and resistance has no effect, exactly.
#[test]
fn a_neck_without_inertance_and_resistance_has_no_effect() {
    let neck = Some(NeckImpedance { inertance: 0.0, resistance: 0.0 });
    let gas = GasBranch { compliance: 3e-12, relaxation: None, neck, valve: None };
    for frequency in [1e-3, 1.0, 50.0, 700.0, 2e3] {
        let with = responses([8e-13, 9e-13], [Some(gas); 2], frequency);
        for (with, lumped) in with.iter().zip(responses([3.8e-12, 3.9e-12], [None; 2], frequency)) {
            assert!((with / lumped - 1.0).norm_sqr().sqrt() < 1e-12, "{frequency}");
        }
    }
}

/// Gas and neck are a damped oscillator at a chamber of constant pressure.
#[test]
fn it_rings_at_the_helmholtz_resonance() {
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 10e5, polytropic_exponent: 1.4 };
    let neck = Neck::round([6e-3, 0.04], OIL, 0.0);
    let machine = machine([Some(gas), None], [Some(neck), None]);
    let necked = GasBranch::of(gas.compliance(30e5), None, Some(&neck));
    // ORIGIN: analytic, sqrt(A/(rho L C)) with the oil of the neck in addition to the gas
    let area = FRAC_PI_4 * 36e-6;
    let own = gas.compliance(30e5) + area * 0.04 / 1.45e9;
    let frequency = (area / (870.0 * 0.04 * own)).sqrt();
    assert!((necked.resonance().unwrap() / frequency - 1.0).abs() < 1e-12);
    // ORIGIN: analytic, 16 nu/(w d^2) of laminar flow
    let damping = 16.0 * 46e-6 / (frequency * 36e-6);
    assert!((necked.damping_ratio().unwrap() / damping - 1.0).abs() < 1e-12);
    // an offset that changes the compliance of the gas by a millionth
    let offset = 1.0;
    let mut ringing = vec![0.0, 30e5 + offset];
    let mut rates = |_: f64, ringing: &[f64]| {
        let state = [&[0.0, 0.0, 30e5, 30e5, 0.0, 0.0], ringing].concat();
        let mut rates = vec![0.0; machine.states()];
        machine.rates(&state, 0.0, &[0.25, 0.0], &mut rates);
        rates[NECK_FLOW..].to_vec()
    };
    let width = 1e-3 / frequency;
    for index in 0..20_000 {
        step(&mut ringing, 0.0, width, &mut rates);
        let time = f64::from(index + 1) * width;
        let damped = frequency * (1.0 - damping * damping).sqrt();
        let cosine = sin(damped * time + std::f64::consts::FRAC_PI_2);
        let swing = cosine + damping * frequency / damped * sin(damped * time);
        let expected = offset * exp(-damping * frequency * time) * swing;
        assert!((ringing[1] - 30e5 - expected).abs() < 1e-4 * offset, "{time}: {}", ringing[1] - 30e5);
    }
}

/// Gas and neck of either side, with any size and index.
fn drawn(number: u64) -> [(Accumulator, Neck); 2] {
    let mut state = stream(44, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    [0, 1].map(|_| {
        let gas = Accumulator {
            gas_volume: spread(3e-5, 1e-4),
            precharge_pressure: spread(2e5, 8e5),
            polytropic_exponent: spread(1.0, 1.6),
        };
        (gas, Neck::round([spread(3e-3, 1e-2), spread(2e-2, 0.3)], OIL, spread(0.1, 3.0)))
    })
}

/// Motions of the load's ground and of the command, drawn by a number.
struct Shaking([[f64; 3]; 4]);

impl Shaking {
    fn drawn(number: u64) -> Shaking {
        let mut random = stream(45, number);
        let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut random));
        Shaking([0; 4].map(|_| [spread(2e-5, 4e-4), spread(20.0, 900.0), spread(0.1, 0.6)]))
    }

    fn inputs(&self, time: f64) -> [f64; 2] {
        let shift = |[size, frequency, _]: &[f64; 3]| size * pow(sin(frequency * time), 2.0);
        let speed = |[size, frequency, _]: &[f64; 3]| size * frequency * sin(2.0 * frequency * time);
        [0.25 + self.0.iter().map(shift).sum::<f64>(), self.0.iter().map(speed).sum()]
    }

    fn command(&self, time: f64) -> f64 {
        self.0.iter().map(|[_, frequency, size]| size * sin(0.7 * frequency * time)).sum()
    }
}

/// Loss of neck and gas for any drive at the port: energy that has entered, less the increase of
/// their content, has been lost, and this loss only grows while the gas is in use, as it is in
/// these motions.
#[test]
fn it_is_passive_under_random_pressures_of_its_port() {
    let places = ["neck_a", "accumulator_a", "neck_b", "accumulator_b"]
        .map(|name| ENERGY_ACCOUNTS.iter().position(|known| *known == name).unwrap());
    for number in 0..16 {
        let parts = drawn(number);
        let machine = machine(parts.map(|(gas, _)| Some(gas)), parts.map(|(_, neck)| Some(neck)));
        let shaking = Shaking::drawn(number);
        let start =
            StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
        let held = |state: &[f64], time: f64| -> f64 {
            let ledger = machine.ledger(state, &shaking.inputs(time)).unwrap();
            places.iter().map(|place| ledger.energy[*place].stored).sum()
        };
        let count = machine.states();
        let mut state = [&machine.start(&start).unwrap().state[..], &[0.0, 0.0]].concat();
        let at_first = held(&state[..count], 0.0);
        let mut rates = |time: f64, state: &[f64]| {
            let mut rates = vec![0.0; count];
            machine.rates(&state[..count], shaking.command(time), &shaking.inputs(time), &mut rates);
            let power = state[2] * state[NECK_FLOW] + state[3] * state[NECK_FLOW + 2];
            rates.extend([power, power.abs()]);
            rates
        };
        let (mut lost, mut gap) = (0.0_f64, 0.0_f64);
        for index in 0..20_000 {
            let time = f64::from(index) * 1e-5;
            step(&mut state, time, 1e-5, &mut rates);
            let so_far = state[count] - (held(&state[..count], time + 1e-5) - at_first);
            (gap, lost) = (gap.max(lost - so_far), lost.max(so_far));
            for (side, (gas, _)) in parts.iter().enumerate() {
                assert!(state[NECK_FLOW + 2 * side + 1] > gas.least_pressure(), "{number}: shut off");
            }
        }
        let through = state[count + 1];
        assert!(through > 0.1 && lost > 0.0, "{number}: {lost} of {through}");
        assert!(gap <= 1e-6 * through, "{number}: {gap} of {through}");
        assert!(at_first + state[count] >= -1e-6 * through, "{number}: it gave more than it had");
    }
}

/// Accounts at any state, including gas that is shut off, where only the oil of the neck yields.
#[test]
fn accounts_close_where_its_gas_is_shut_off() {
    let mut seed = 46;
    for number in 0..16 {
        let parts = drawn(number);
        let machine = machine(parts.map(|(gas, _)| Some(gas)), parts.map(|(_, neck)| Some(neck)));
        for _ in 0..50 {
            let [gas_a, gas_b] = parts.map(|(gas, neck)| {
                let pressure = gas.precharge_pressure * (1.0 + 0.1 * random(&mut seed));
                bladder(&gas, &neck).within(pressure)
            });
            let mut of = |scale: f64| scale * random(&mut seed);
            let pressures = [35e5 + of(34e5), 35e5 + of(34e5)];
            let state = [of(10.0), of(1e3), pressures[0], pressures[1], of(1e-4), of(0.1)];
            let state = [&state[..], &[of(1e-4), gas_a, of(1e-4), gas_b]].concat();
            check_instant("necks", &machine, &state, of(10.0), [0.25 + of(0.1), of(0.1)]);
        }
    }
}

/// The gas is shut off by its own pressure, not by that of its chamber; oil cavitates in the neck
/// as in the chamber.
#[test]
fn it_is_empty_at_the_pressure_of_its_gas() {
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 20e5, polytropic_exponent: 1.4 };
    let neck = Neck::round([6e-3, 0.04], OIL, 1.5);
    let machine = machine([Some(gas), Some(gas)], [Some(neck), None]);
    let place = |name: &str| INDICATORS.iter().position(|known| *known == name).unwrap();
    for (chamber, gas_pressure) in [(19e5, 21e5), (21e5, 19e5)] {
        let state = [1.0, 0.0, chamber, chamber, 1e-4, 0.05, 1e-5, bladder(&gas, &neck).within(gas_pressure)];
        let mut indicators = vec![0.0; machine.indicators()];
        machine.indicate(&state, &[0.25, 0.0], &mut indicators);
        assert_eq!(indicators[place("accumulator_empty_a")] > 0.0, gas_pressure > 20e5);
        assert_eq!(indicators[place("accumulator_empty_b")] > 0.0, chamber > 20e5);
        assert!(indicators[place("cavitation_a")] > 0.0 && indicators[place("cavitation_b")] > 0.0);
    }
}

/// The pressure in a neck may fall below vapour pressure while the gas is shut off and oil leaves
/// the neck.
#[test]
fn oil_in_a_neck_cavitates() {
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 20e5, polytropic_exponent: 1.4 };
    let neck = Neck::round([6e-3, 0.04], OIL, 1.5);
    let machine = machine([Some(gas); 2], [Some(neck), None]);
    let place = INDICATORS.iter().position(|known| *known == "cavitation_a").unwrap();
    let excess = |chamber: f64, gas_pressure: f64| {
        let state = [1.0, 0.0, chamber, 30e5, 1e-4, 0.05, 1e-5, bladder(&gas, &neck).within(gas_pressure)];
        let mut indicators = vec![0.0; machine.indicators()];
        machine.indicate(&state, &[0.25, 0.0], &mut indicators);
        indicators[place]
    };
    assert!(excess(20e5, 20e5) > 0.0 && excess(20e5, -2e5) < 0.0 && excess(-2e5, 20e5) < 0.0);
    // except for the rounding of the state over the softness of the oil
    assert!((excess(20e5, -2e5) - excess(-2e5, 20e5)).abs() < 1e-3);
}

/// A neck without flow has no effect: the machine rests as with the gas at its chamber.
#[test]
fn a_neck_has_no_effect_at_rest() {
    for number in 0..16 {
        let parts = drawn(number);
        let gas = parts.map(|(gas, _)| Some(gas));
        let (with, without) = (machine(gas, parts.map(|(_, neck)| Some(neck))), machine(gas, [None; 2]));
        let start =
            StartValues { position: 0.25, pressure_a: 41e5, pressure_b: 36e5, ..StartValues::default() };
        let [with, without] = [with, without].map(|machine| machine.start(&start).unwrap());
        assert_eq!(with.state[..NECK_FLOW], without.state[..NECK_FLOW]);
        assert_eq!(with.state[NECK_FLOW..], [0.0, 41e5, 0.0, 36e5]);
    }
}

/// A neck without a length, or with an impossible loss, is rejected by its path.
#[test]
fn impossible_necks_are_refused() {
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 20e5, polytropic_exponent: 1.4 };
    let sound = Neck::round([6e-3, 0.04], OIL, 1.5);
    let cases = [
        (Neck { inertance: 0.0, ..sound }, "neck_inertance"),
        (Neck { resistance: -1.0, ..sound }, "neck_resistance"),
        (Neck { loss: f64::NAN, ..sound }, "neck_loss"),
        (Neck { compliance: -1e-15, ..sound }, "neck_compliance"),
    ];
    for (neck, name) in cases {
        let rig = components(pipe_line(), StiffnessModel::ByVolume);
        let parts = Components { gas: [None, Some(behind(gas, Some(neck)))], ..rig };
        let refused = Actuator::new(parts).unwrap_err().to_string();
        assert!(refused.contains("line.b.accumulator") && refused.contains(name), "{refused}");
    }
}
