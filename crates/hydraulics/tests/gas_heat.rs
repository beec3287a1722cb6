//! Gas that exchanges heat with its wall: limits, closed forms, a cycle integrated by SciPy,
//! passivity, and its rejections.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::{exp, pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::{
    Accumulator, ChamberGas, GasBranch, GasContent, GasPassage, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::machine::{INDICATORS, Machine, MachineOptions, StartValues};
use phea_hydraulics::reference_rig::{components, pipe_line};
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::{machine_of, step};
use super::neck::{behind, responses};

const ATMOSPHERE: f64 = 101_325.0;
const GAS: Accumulator = Accumulator { gas_volume: 2e-5, precharge_pressure: 15e5, polytropic_exponent: 1.0 };
const HEATED: RelaxingGas = RelaxingGas { gas_volume: 2e-5, precharge_pressure: 15e5, time_constant: 0.4 };

fn machine(gas: Accumulator, thermal_time_constant: Option<f64>) -> Machine {
    let rig = components(pipe_line(), StiffnessModel::ByVolume);
    let content = match thermal_time_constant {
        None => GasContent::Polytropic(gas),
        Some(time_constant) => GasContent::Relaxing(RelaxingGas { time_constant, ..HEATED }),
    };
    let gas =
        ChamberGas::Sealed(SealedGas { content, passage: GasPassage::Open, maximum_pressure_ratio: None });
    machine_of(Components { gas: [Some(gas); 2], ..rig }, &MachineOptions::default())
}

/// Pressure and theta - 1 of the gas, then the additions of `more`, over a flow into it.
fn driven(
    gas: &RelaxingGas,
    start: [f64; 2],
    flow: impl Fn(f64) -> f64,
    (duration, steps): (f64, u32),
    mut seen: impl FnMut(f64, [f64; 4]),
) -> [f64; 4] {
    let mut state = vec![start[0], start[1], 0.0, 0.0];
    let mut rates = |time: f64, state: &[f64]| {
        let (heated, flow) = (gas.at(state[0], state[1]), flow(time));
        let rate = flow / heated.compliance - heated.cooling;
        vec![rate, heated.warming_rate(flow), (state[0] + ATMOSPHERE) * flow, heated.heat]
    };
    let width = duration / f64::from(steps);
    for index in 0..steps {
        step(&mut state, f64::from(index) * width, width, &mut rates);
        seen(f64::from(index + 1) * width, *state.first_chunk().unwrap());
    }
    *state.first_chunk().unwrap()
}

/// The time constant has two limits in the linear plant: a short one gives isothermal gas, a long
/// one adiabatic gas, and one between them neither.
#[test]
fn the_time_constant_has_two_limits() {
    let isothermal = GAS.compliance(35e5);
    let branch = |time_constant: f64, neck: Option<&Neck>| {
        let later = RelaxingGas { time_constant, ..HEATED }.relaxation(35e5);
        Some(GasBranch::of(isothermal, Some(later), neck))
    };
    let plain = |compliance: f64, neck: &Neck| Some(GasBranch::of(compliance, None, Some(neck)));
    let gap = |one: &[num_complex::Complex64], other: &[num_complex::Complex64]| {
        let gaps = one.iter().zip(other).map(|(one, other)| (one / other - 1.0).norm_sqr().sqrt());
        gaps.fold(0.0, f64::max)
    };
    let neck = Neck::round([6e-3, 0.04], [870.0, 46e-6, 1.45e9], 1.5);
    for frequency in [1e-3, 1.0, 50.0, 700.0, 2e3] {
        for (time_constant, compliance) in [(1e-14, isothermal), (1e14, isothermal / 1.4)] {
            let found = responses([8e-13; 2], [branch(time_constant, None), None], frequency);
            let lumped = responses([8e-13 + compliance, 8e-13], [None; 2], frequency);
            assert!(gap(&found, &lumped) < 1e-9, "{time_constant} s at {frequency} rad/s");
            let with_neck = responses([8e-13; 2], [branch(time_constant, Some(&neck)), None], frequency);
            let without = responses([8e-13; 2], [plain(compliance, &neck), None], frequency);
            assert!(gap(&with_neck, &without) < 1e-9, "{time_constant} s behind a neck at {frequency} rad/s");
        }
    }
    let middle = responses([8e-13; 2], [branch(1.0, None); 2], 1.0);
    for compliance in [isothermal, isothermal / 1.4] {
        assert!(gap(&middle, &responses([8e-13 + compliance; 2], [None; 2], 1.0)) > 1e-2);
    }
}

/// The admittance has the closed form C_T s (1 + tau s)/(1 + gamma tau s).
#[test]
fn small_motions_are_a_lead_of_gamma() {
    let later = RelaxingGas { time_constant: 3.0, ..HEATED }.relaxation(35e5);
    // ORIGIN: analytic, P_0 V_0/P^2 of isothermal gas; its fraction 1 - 1/gamma follows after gamma
    // tau
    let at_rest = (15e5 + ATMOSPHERE) * 2e-5 / ((35e5 + ATMOSPHERE) * (35e5 + ATMOSPHERE));
    assert!((later.compliance / (at_rest * (1.0 - 1.0 / 1.4)) - 1.0).abs() < 1e-12);
    assert!((later.time / (1.4 * 3.0) - 1.0).abs() < 1e-12);
}

/// Gas at constant volume approaches the temperature of its wall exponentially, and its pressure
/// with it.
#[test]
fn held_gas_cools_exponentially() {
    let gas = RelaxingGas { time_constant: 0.7, ..HEATED };
    let (pressure, warming) = (40e5, 0.12);
    driven(
        &gas,
        [pressure, warming],
        |_| 0.0,
        (3.0, 3000),
        |time, [found, left, work, heat]| {
            let expected = warming * exp(-time / 0.7);
            assert!((left - expected).abs() < 1e-12, "{time}");
            let held = (pressure + ATMOSPHERE) * (1.0 + expected) / (1.0 + warming) - ATMOSPHERE;
            assert!((found / held - 1.0).abs() < 1e-11, "{time}");
            let given = (15e5 + ATMOSPHERE) * 2e-5 / 0.4 * (warming - expected);
            assert!(work == 0.0 && (heat - given).abs() < 1e-10, "{time}: {heat} {given}");
        },
    );
}

/// P V^1.4 is constant without time for heat exchange, P V with ample time: for large strokes.
#[test]
fn fast_gas_is_adiabatic_and_slow_gas_isothermal() {
    let absolute = 30e5 + ATMOSPHERE;
    let volume = 2e-5 * (15e5 + ATMOSPHERE) / absolute;
    for (time_constant, index, duration, steps, tolerance) in
        [(1e14, 1.4, 1.0, 20_000, 1e-9), (1e-6, 1.0, 0.1, 100_000, 1e-6)]
    {
        let gas = RelaxingGas { time_constant, ..HEATED };
        let flow = |time: f64| 0.2 * volume * 10.0 * sin(20.0 * time);
        driven(&gas, [30e5, 0.0], flow, (duration, steps), |time, [found, ..]| {
            let left = volume * (1.0 - 0.2 * pow(sin(10.0 * time), 2.0));
            let expected = absolute * pow(volume / left, index);
            assert!(((found + ATMOSPHERE) / expected - 1.0).abs() < tolerance, "{index} at {time}");
        });
    }
}

/// A cycle between both limits, and ten such cycles.
#[test]
fn a_cycle_is_that_of_scipy() {
    let gas = HEATED;
    let volume = 2e-5 * (15e5 + ATMOSPHERE) / (35e5 + ATMOSPHERE);
    let flow = |time: f64| 0.3 * volume * 3.0 * sin(3.0 * time + std::f64::consts::FRAC_PI_2);
    let found = driven(&gas, [35e5, 0.0], flow, (20.0, 40_000), |_, _| ());
    // ORIGIN: recomputed by comparisons/recompute_gas_heat.py
    let expected = [2_940_280.942_6, -0.078_189_254_9, 15.204_442_640, 21.464_763_071];
    let sizes = [35e5, 0.1, 10.0, 10.0];
    for ((found, expected), size) in found.into_iter().zip(expected).zip(sizes) {
        assert!((found - expected).abs() < 1e-7 * size, "{found} {expected}");
    }
}

/// A machine whose gas has no time for heat exchange equals one with polytropic gas of index 1.4
/// from its present state.
#[test]
fn a_machine_with_fast_gas_is_the_polytropic_one() {
    // the polytrope through the gas at 35 bar, from the same precharge
    let absolute = 35e5 + ATMOSPHERE;
    let precharge = 15e5 + ATMOSPHERE;
    let held = 2e-5 * precharge / absolute;
    let gas_volume = held * pow(absolute / precharge, 1.0 / 1.4);
    let polytropic = Accumulator { gas_volume, polytropic_exponent: 1.4, ..GAS };
    let runs = [(polytropic, None), (GAS, Some(1e12))].map(|(gas, heat)| {
        let machine = machine(gas, heat);
        let start =
            StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
        let mut state = machine.start(&start).unwrap().state;
        let mut rates = |time: f64, state: &[f64]| {
            let mut rates = vec![0.0; state.len()];
            machine.rates(state, 2.0 * sin(60.0 * time), &[0.25, 0.0], &mut rates);
            rates
        };
        (0..20_000).for_each(|index| step(&mut state, f64::from(index) * 1e-5, 1e-5, &mut rates));
        assert!((state[3] - 35e5).abs() > 1e5, "{state:?}");
        state
    });
    let [polytropic, heated] = runs;
    for (place, (one, other)) in polytropic.iter().zip(&heated).enumerate() {
        assert!((one - other).abs() <= 1e-9 * one.abs().max(1e-3), "{place}: {one} {other}");
    }
    assert!(heated[6].abs() > 1e-3);
}

/// Gas under any flow: no more energy leaves than enters, with the pressure counted from its rest.
#[test]
fn it_is_passive_under_random_flows() {
    for number in 0..64 {
        let mut random = stream(48, number);
        let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut random));
        let gas = RelaxingGas {
            gas_volume: spread(1e-6, 1e-3),
            precharge_pressure: spread(2e5, 20e5),
            time_constant: spread(0.02, 20.0),
        };
        let rest = gas.precharge_pressure * spread(1.2, 4.0);
        let volume = gas.gas_volume - gas.at(rest, 0.0).oil;
        let waves = [0; 4].map(|_| [spread(0.005, 0.05), spread(0.3, 60.0), spread(0.1, 6.0)]);
        let flow = |time: f64| -> f64 {
            waves.iter().map(|[size, rate, phase]| volume * size * rate * sin(rate * time + phase)).sum()
        };
        let from_rest = rest + ATMOSPHERE;
        let (mut entered, mut least) = (0.0, f64::INFINITY);
        let mut before = 0.0;
        driven(&gas, [rest, 0.0], flow, (4.0, 40_000), |_, [pressure, warming, work, heat]| {
            let heated = gas.at(pressure, warming);
            // work at the pressure from rest: the full work less P_rest times the oil that has
            // entered
            entered = work - from_rest * (heated.oil - gas.at(rest, 0.0).oil);
            // and the heat agrees with the first law
            let held = heated.energy + ATMOSPHERE * heated.oil;
            let gap = held - (gas.at(rest, 0.0).energy + ATMOSPHERE * gas.at(rest, 0.0).oil) - (work - heat);
            assert!(gap.abs() < 1e-9 * held, "{number}: {gap}");
            least = f64::min(least, entered);
            before = f64::max(before, entered);
        });
        assert!(least >= -1e-9 * before && before > 0.0, "{number}: {least} of {before}");
    }
}

/// Warm gas lifts its bladder at a higher pressure, and cold gas is shut off at a lower one.
#[test]
fn it_is_shut_off_by_the_pressure_of_its_own_temperature() {
    let machine = machine(GAS, Some(1.0));
    let place = INDICATORS.iter().position(|known| *known == "accumulator_empty_a").unwrap();
    let excess = |pressure: f64, warming: f64| {
        let state = [0.0, 0.0, pressure, 30e5, 0.0, 0.0, warming, 0.0];
        let mut indicators = vec![0.0; machine.indicators()];
        machine.indicate(&state, &[0.25, 0.0], &mut indicators);
        let mut rates = vec![0.0; machine.states()];
        machine.rates(&state, 0.0, &[0.25, 0.0], &mut rates);
        assert!(rates.iter().all(|rate| rate.is_finite()));
        indicators[place]
    };
    let edge = |warming: f64| (15e5 + ATMOSPHERE) * (1.0 + warming) - ATMOSPHERE;
    for warming in [-0.1, 0.0, 0.1] {
        assert!(excess(edge(warming) + 1.0, warming) > 0.0 && excess(edge(warming) - 1.0, warming) < 0.0);
    }
}

/// A pressure limit of the maker is reported when the pressure of the gas exceeds it.
#[test]
fn excess_pressure_is_reported() {
    let rig = components(pipe_line(), StiffnessModel::ByVolume);
    let limited = |gas: ChamberGas, ratio| {
        Some(ChamberGas::Sealed(SealedGas { maximum_pressure_ratio: Some(ratio), ..gas.sealed() }))
    };
    // of 60 bar
    let ratio = (60e5 + ATMOSPHERE) / (15e5 + ATMOSPHERE);
    let neck = Neck::round([6e-3, 0.04], [870.0, 46e-6, 1.45e9], 1.5);
    let neck = Components { gas: [limited(behind(GAS, Some(neck)), ratio), None], ..rig };
    let impossible = Components { gas: [None, limited(GAS.into(), -1.0)], ..rig };
    let rig = Components { gas: [limited(GAS.into(), ratio), None], ..rig };
    let place = |name: &str| INDICATORS.iter().position(|known| *known == name).unwrap();
    for (parts, gas_pressure) in [(rig, None), (neck, Some(61e5))] {
        let machine = machine_of(parts, &MachineOptions::default());
        for (pressure, over) in [(59e5, gas_pressure.is_some()), (61e5, true)] {
            let mut state = vec![0.0, 0.0, pressure, 65e5, 0.0, 0.0];
            state.extend(gas_pressure.into_iter().flat_map(|gas_pressure| [0.0, gas_pressure]));
            let mut indicators = vec![0.0; machine.indicators()];
            machine.indicate(&state, &[0.25, 0.0], &mut indicators);
            assert_eq!(indicators[place("accumulator_overpressure_a")] < 0.0, over);
            assert!(indicators[place("accumulator_overpressure_b")] > 0.0);
        }
    }
    let refused = Actuator::new(impossible).unwrap_err().to_string();
    assert!(refused.contains("line.b.accumulator.maximum_pressure_ratio"), "{refused}");
}

/// A time constant that is not positive is rejected by its path.
#[test]
fn impossible_heat_is_refused() {
    for time_constant in [0.0, f64::NAN] {
        let rig = components(pipe_line(), StiffnessModel::ByVolume);
        let content = GasContent::Relaxing(RelaxingGas { time_constant, ..HEATED });
        let gas = ChamberGas::Sealed(SealedGas {
            content,
            passage: GasPassage::Open,
            maximum_pressure_ratio: None,
        });
        let parts = Components { gas: [None, Some(gas)], ..rig };
        let refused = Actuator::new(parts).unwrap_err();
        assert_eq!(refused.problems.len(), 1);
        assert_eq!(refused.problems[0].quantity, "line.b.accumulator.thermal_time_constant");
    }
}
