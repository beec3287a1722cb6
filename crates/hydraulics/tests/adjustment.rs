//! Accumulators that are adjusted in operation: frozen settings, closed forms of their work and of
//! switching, limits, passivity, and their rejections.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::{exp, pow, sin};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::{
    Accumulator, AdjustedGas, Bladder, ChamberGas, GasBranch, GasContent, GasPassage, GasValve, MovedGas,
    Neck, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::machine::{ENERGY_ACCOUNTS, INDICATORS, Machine, MachineOptions, StartValues};
use phea_hydraulics::reference_rig::{components, pipe_line};
use phea_hydraulics::signal::Signal;
use phea_hydraulics::stiffness::StiffnessModel;

use super::machine_conservation::{machine_of, random, step};
use super::neck::{behind as necked, bladder, responses};

const ATMOSPHERE: f64 = 101_325.0;
const GAS: Accumulator = Accumulator { gas_volume: 2e-5, precharge_pressure: 15e5, polytropic_exponent: 1.3 };
const VALVE: GasValve = GasValve {
    setting: 0.5,
    flow_coefficient: 3e-8,
    transition_pressure: 1e4,
    compliance: 1e-15,
    shut: false,
};

/// A quarter turn before the sine.
fn cos(angle: f64) -> f64 {
    sin(angle + std::f64::consts::FRAC_PI_2)
}

fn moving() -> MachineOptions {
    MachineOptions { moving_setting: true, ..MachineOptions::default() }
}

fn with_gas(gas: ChamberGas) -> Components {
    Components { gas: [Some(gas), None], ..components(pipe_line(), StiffnessModel::ByVolume) }
}

fn behind(valve: GasValve) -> Components {
    let (content, passage) = (GasContent::Polytropic(GAS), GasPassage::Valve(valve));
    with_gas(ChamberGas::Sealed(SealedGas { content, passage, maximum_pressure_ratio: None }))
}

/// Gas that is adjusted by a volume in m3 and a precharge in Pa.
fn adjusted([volume_rise, precharge_rise]: [f64; 2], setting: f64) -> AdjustedGas {
    AdjustedGas {
        at_rest: GAS,
        setting,
        volume_rise,
        precharge_rise,
        neck: None,
        maximum_pressure_ratio: None,
    }
}

/// A fixed setting equals the accumulator declared with the values of that setting, in every rate.
#[test]
fn a_frozen_setting_is_the_declared_accumulator() {
    let neck = Neck::round([6e-3, 0.04], [870.0, 46e-6, 1.45e9], 1.5);
    let mut seed = 52;
    for neck in [None, Some(neck)] {
        let adjusting = AdjustedGas { neck, ..adjusted([3e-5, -4e5], 0.25) };
        for change in [-0.25, 0.0, 0.3, 0.75] {
            let machine = machine_of(with_gas(ChamberGas::Adjusted(adjusting)), &moving());
            let gas = Accumulator {
                gas_volume: GAS.gas_volume + 3e-5 * change,
                precharge_pressure: GAS.precharge_pressure - 4e5 * change,
                ..GAS
            };
            let declared = machine_of(with_gas(necked(gas, neck)), &MachineOptions::default());
            for _ in 0..50 {
                let mut of = |middle: f64, scale: f64| middle + scale * random(&mut seed);
                let state = [
                    of(0.0, 5.0),
                    of(0.0, 10.0),
                    of(20e5, 15e5),
                    of(30e5, 20e5),
                    of(0.0, 1e-4),
                    of(0.0, 0.1),
                ];
                // each machine has its own state of the gas at a pressure of the oil
                let (flow, pressure) = (of(0.0, 1e-4), of(20e5, 15e5));
                let bladders = neck.map(|neck| {
                    let softness = bladder(&GAS, &neck).softness;
                    [Bladder { softness, ..bladder(&gas, &neck) }, bladder(&gas, &neck)]
                });
                let states = [0, 1].map(|machine| {
                    let own = bladders.map(|of| [flow, of[machine].within(pressure)]);
                    [&state[..], own.as_ref().map_or(&[], |own| &own[..])].concat()
                });
                let state = &states[0];
                let mut rates = [vec![0.0; state.len()], vec![0.0; state.len()]];
                machine.rates(&states[0], 1.0, &[0.25, 0.05, change, 0.0], &mut rates[0]);
                declared.rates(&states[1], 1.0, &[0.25, 0.05], &mut rates[1]);
                for (rates, of) in rates.iter_mut().zip(bladders.into_iter().flatten()) {
                    // oil pressure
                    rates[7] /= of.rate(pressure, [1.0, 0.0]);
                }
                for (one, other) in rates[0].iter().zip(&rates[1]) {
                    assert!((one - other).abs() <= 1e-9 * other.abs().max(1e-9), "{change}: {one} {other}");
                }
            }
        }
    }
}

/// Oil at constant volume while gas is added and compressed: the work is that of the polytrope.
#[test]
fn its_work_is_that_of_the_polytrope() {
    for exponent in [1.0, 1.4] {
        let gas = Accumulator { polytropic_exponent: exponent, ..GAS };
        for rises in [[2e-5, 0.0], [-8e-6, 0.0], [0.0, 10e5], [1e-5, -5e5]] {
            let adjusted = AdjustedGas { at_rest: gas, ..adjusted(rises, 0.0) };
            let held = gas.oil(35e5);
            // pressure and work, over the setting at constant rate
            let mut state = vec![35e5, 0.0];
            let mut rates = |change: f64, state: &[f64]| {
                let moved = adjusted.moved(change, 1.0);
                vec![-moved.oil_rate(state[0]) / moved.gas.compliance(state[0]), moved.power(state[0])]
            };
            (0..4000).for_each(|index| step(&mut state, f64::from(index) / 4000.0, 1.0 / 4000.0, &mut rates));
            let last = adjusted.moved(1.0, 0.0).gas;
            // ORIGIN: analytic, P = P_0 (V_0/(V_0 - V_oil))^n and the integral of p dV_oil from the
            // precharge on
            let ideal = |gas: &Accumulator| {
                let (precharge, ratio) =
                    (gas.precharge_pressure + ATMOSPHERE, gas.gas_volume / (gas.gas_volume - held));
                let pressed = match exponent {
                    1.0 => phea_dynamics::portable::ln(ratio),
                    n => (pow(ratio, n - 1.0) - 1.0) / (n - 1.0),
                };
                let pressure = precharge * pow(ratio, exponent) - ATMOSPHERE;
                (pressure, precharge * gas.gas_volume * pressed - ATMOSPHERE * held)
            };
            let ((_, before), (pressure, after)) = (ideal(&gas), ideal(&last));
            assert!((state[0] / pressure - 1.0).abs() < 1e-10, "{state:?} {pressure}");
            // the work of lifting the bladder, below 2e-5 P_0 V_0, is not in the closed form
            let lifting = 2e-5 * (GAS.precharge_pressure + ATMOSPHERE) * GAS.gas_volume;
            assert!((state[1] - (after - before)).abs() < lifting, "{state:?} {}", after - before);
            let own = held_energy(&last, state[0]) - held_energy(&gas, 35e5);
            assert!((state[1] - own).abs() < 1e-8 * held_energy(&gas, 35e5), "{state:?} {own}");
        }
    }
}

/// Energy that the oil can recover from the gas at a pressure, W: the integral of p C dp by
/// Simpson's rule.
fn held_energy(gas: &Accumulator, pressure: f64) -> f64 {
    let steps = 100_000;
    let from = 0.98 * (gas.precharge_pressure + ATMOSPHERE) - ATMOSPHERE;
    let width = (pressure - from) / f64::from(steps);
    let of = |at: f64| at * gas.compliance(at);
    let strip = |index: i32| {
        let left = from + f64::from(index) * width;
        (of(left) + 4.0 * of(left + 0.5 * width) + of(left + width)) / 6.0
    };
    (0..steps).map(strip).sum::<f64>() * width
}

/// A stiffness that oscillates at twice the frequency of the oil pumps energy into it: 1/2 dK/dt
/// x^2 over a cycle, in each phase.
#[test]
fn a_swinging_stiffness_pumps_half_its_rate_times_the_square() {
    let middle = GAS.oil(35e5);
    let adjusted = adjusted([8e-6, -3e5], 0.5);
    // ORIGIN: analytic, the pressure of gas that holds this oil, and its stiffness dp/dV_oil = n
    // P/V
    let pressure = |gas: &Accumulator, oil: f64| {
        let ratio = gas.gas_volume / (gas.gas_volume - oil);
        (gas.precharge_pressure + ATMOSPHERE) * pow(ratio, gas.polytropic_exponent) - ATMOSPHERE
    };
    let stiffness = |change: f64| {
        let gas = adjusted.moved(change, 0.0).gas;
        gas.polytropic_exponent * (pressure(&gas, middle) + ATMOSPHERE) / (gas.gas_volume - middle)
    };
    for phase in [0.0, 0.9, 2.0, 4.0] {
        let setting = |time: f64| (0.3 * sin(2.0 * time + phase), 0.6 * cos(2.0 * time + phase));
        let gap = |size: f64| {
            let steps = 4000;
            let (mut pumped, mut reported) = (0.0, 0.0);
            for index in 0..steps {
                let time = std::f64::consts::TAU * f64::from(index) / f64::from(steps);
                let ((change, rate), moved_by) = (setting(time), size * sin(time));
                let moved: MovedGas = adjusted.moved(change, rate);
                pumped += moved.power(pressure(&moved.gas, middle + moved_by));
                let slope = (stiffness(change + 1e-5) - stiffness(change - 1e-5)) / 2e-5 * rate;
                reported += 0.5 * slope * moved_by * moved_by;
            }
            (pumped / reported - 1.0, reported)
        };
        let ((wide, reported), (narrow, _)) = (gap(0.02 * GAS.gas_volume), gap(0.01 * GAS.gas_volume));
        // the remainder falls with the square of the amplitude
        assert!(reported.abs() > 0.0 && narrow.abs() < 1e-2, "{phase}: {narrow} {wide}");
        assert!((wide / narrow - 4.0).abs() < 0.2, "{phase}: {wide} {narrow}");
    }
}

/// Oil and gas separated by a valve, with a flow into the oil: both pressures, and the work of flow
/// and valve.
fn switched(
    start: [f64; 2],
    compliance: f64,
    opening: impl Fn(f64) -> f64,
    flow: impl Fn(f64) -> f64,
    (duration, steps): (f64, u32),
    mut seen: impl FnMut([f64; 4]),
) -> [f64; 4] {
    let mut state = vec![start[0], start[1], 0.0, 0.0];
    let mut rates = |time: f64, state: &[f64]| {
        let (drop, entering) = (state[0] - state[1], flow(time));
        let through = GasValve { setting: opening(time), ..VALVE }.flow(0.0, drop);
        let behind = GAS.compliance(state[1]) + VALVE.compliance;
        vec![(entering - through) / compliance, through / behind, state[0] * entering, drop * through]
    };
    let width = duration / f64::from(steps);
    for index in 0..steps {
        step(&mut state, f64::from(index) * width, width, &mut rates);
        seen(*state.first_chunk().unwrap());
    }
    *state.first_chunk().unwrap()
}

/// Switching on at equal pressures loses no energy; at unequal ones it loses 1/2 C_1 C_2/(C_1 +
/// C_2) dp^2, the more exactly the smaller dp.
#[test]
fn switching_loses_what_two_compliances_lose() {
    let compliance = 2e-12;
    let gas = GAS.compliance(35e5) + VALVE.compliance;
    let opened = |time: f64| f64::min(time / 1e-3, 1.0);
    let [_, _, _, nothing] = switched([35e5; 2], compliance, opened, |_| 0.0, (0.05, 5000), |_| ());
    assert_eq!(nothing, 0.0);
    let gap = |drop: f64| {
        let start = [35e5 + drop, 35e5];
        let [chamber, gas_side, _, lost] =
            switched(start, compliance, opened, |_| 0.0, (0.4, 200_000), |_| ());
        assert!((chamber - gas_side).abs() < 1e-3 * drop.abs(), "{chamber} {gas_side}");
        // ORIGIN: analytic, the energy of two springs that are joined
        lost / (0.5 * compliance * gas / (compliance + gas) * drop * drop) - 1.0
    };
    for sign in [1.0, -1.0] {
        let (wide, narrow) = (gap(4e5 * sign), gap(2e5 * sign));
        assert!(narrow.abs() < 0.03, "{narrow}");
        assert!((wide / narrow - 2.0).abs() < 0.3, "{wide} {narrow}");
    }
    // shut, it separates both
    let held = switched([50e5, 20e5], compliance, |_| 0.0, |_| 0.0, (0.1, 1000), |_| ());
    assert_eq!(held, [50e5, 20e5, 0.0, 0.0]);
}

/// Output energy never exceeds the input for any flow at a constant opening.
#[test]
fn a_frozen_opening_is_passive() {
    for number in 0..24 {
        let mut random = stream(60, number);
        let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut random));
        let (opening, compliance) = (spread(0.02, 1.0), spread(5e-13, 5e-12));
        let waves = [0; 4].map(|_| [spread(2e5, 3e6), spread(3.0, 600.0), spread(0.1, 6.0)]);
        let flow = |time: f64| -> f64 {
            let wave = |[size, rate, phase]: &[f64; 3]| compliance * size * rate * sin(rate * time + phase);
            waves.iter().map(wave).sum()
        };
        let rest = 35e5;
        let whole = |[chamber, gas_side, ..]: [f64; 4]| {
            let of_gas = |pressure: f64| held_energy(&GAS, pressure) - rest * GAS.oil(pressure);
            let oil = 0.5 * compliance * (chamber - rest) * (chamber - rest);
            let between = 0.5 * VALVE.compliance * (gas_side - rest) * (gas_side - rest);
            oil + between + of_gas(gas_side) - of_gas(rest)
        };
        let (mut entered, mut last) = (0.0, [0.0; 4]);
        let mut oil = 0.0;
        let steps = 100_000;
        let found = switched(
            [rest; 2],
            compliance,
            |_| opening,
            flow,
            (1.0, steps),
            |state| {
                assert!(state[3] >= 0.0);
                last = state;
            },
        );
        for index in 0..steps {
            oil += flow((f64::from(index) + 0.5) / f64::from(steps)) / f64::from(steps);
        }
        entered += found[2] - rest * oil;
        let stored = whole(last);
        // the energy that entered is stored and throttled
        assert!(stored >= 0.0 && found[3] > 0.0);
        assert!(
            (entered - stored - found[3]).abs() < 1e-5 * (stored + found[3]),
            "{number}: {entered} {stored} {found:?}"
        );
    }
}

/// The linear plant has two limits: a valve without resistance has no effect, and one that passes
/// no flow removes the accumulator.
#[test]
fn its_conductance_has_two_limits() {
    let gas = GAS.compliance(35e5);
    let gas_side =
        |conductance: f64| Some(GasBranch::of(gas, None, None).through_valve(conductance, VALVE.compliance));
    let gap = |one: &[num_complex::Complex64], other: &[num_complex::Complex64]| {
        let gaps = one.iter().zip(other).map(|(one, other)| (one / other - 1.0).norm_sqr().sqrt());
        gaps.fold(0.0, f64::max)
    };
    for frequency in [1e-3, 1.0, 50.0, 700.0, 2e3] {
        let open = responses([8e-13; 2], [gas_side(1e3), None], frequency);
        let at_chamber = responses([8e-13 + gas + VALVE.compliance, 8e-13], [None; 2], frequency);
        assert!(gap(&open, &at_chamber) < 1e-9, "{frequency} rad/s");
        let shut = responses([8e-13; 2], [gas_side(1e-26), None], frequency);
        let without = responses([8e-13; 2], [None; 2], frequency);
        assert!(gap(&shut, &without) < 1e-9, "{frequency} rad/s");
        let between = responses([8e-13; 2], [gas_side(1e-11), None], frequency);
        assert!(!(0.5..=100.0).contains(&frequency) || gap(&between, &at_chamber) > 1e-3);
    }
}

/// A valve that is shut at rest removes both the gas and its oil from the plant; the machine
/// preserves the pressure of its gas.
#[test]
fn a_shut_valve_holds_its_gas() {
    let parts = behind(GasValve { setting: 0.0, shut: true, ..VALVE });
    assert_eq!((parts.gas_branches([35e5; 2]), parts.gas_compliance([35e5; 2])), ([None; 2], [None; 2]));
    let machine = machine_of(parts, &moving());
    assert_eq!((machine.shut_gas(0.0), machine.shut_gas(0.1)), (vec![6], vec![]));
    let state = [0.0, 0.0, 40e5, 30e5, 0.0, 0.0, 20e5];
    let mut rates = vec![0.0; state.len()];
    for (change, flows) in [(0.0, false), (0.5, true)] {
        machine.rates(&state, 1.0, &[0.25, 0.0, change, 0.0], &mut rates);
        assert_eq!(rates[6] > 0.0, flows);
        let outputs = machine.signals(&state, &[0.25, 0.0, change, 0.0]);
        let of = |signal: Signal| outputs.get(signal).unwrap();
        assert_eq!((of(Signal::SettingA), of(Signal::GasPressureA)), (change, 20e5));
        assert_eq!((of(Signal::SettingB), of(Signal::AdjustmentPower)), (0.0, 0.0));
    }
}

/// The precharge at which the gas is shut off moves with the setting.
#[test]
fn it_is_empty_at_the_precharge_of_its_setting() {
    let machine = machine_of(with_gas(ChamberGas::Adjusted(adjusted([0.0, 10e5], 0.0))), &moving());
    let place = INDICATORS.iter().position(|known| *known == "accumulator_empty_a").unwrap();
    for change in [0.0, 0.4, 1.0] {
        for (above, shut) in [(1.0, false), (-1.0, true)] {
            let state = [0.0, 0.0, 15e5 + 10e5 * change + above, 30e5, 0.0, 0.0];
            let mut indicators = vec![0.0; machine.indicators()];
            machine.indicate(&state, &[0.25, 0.0, change, 0.0], &mut indicators);
            assert_eq!(indicators[place] < 0.0, shut, "{change}");
        }
    }
}

/// A machine at rest with a setting that can move stays at rest.
#[test]
fn it_rests_like_the_declared_one() {
    for rig in [behind(VALVE), with_gas(ChamberGas::Adjusted(adjusted([1e-5, 0.0], 0.5)))] {
        let machine: Machine = machine_of(rig, &moving());
        let start =
            StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 35e5, ..StartValues::default() };
        let beginning = machine.start(&start).unwrap();
        assert_eq!(beginning.all_inputs(), [0.25, 0.0, 0.0, 0.0]);
        let expected: &[f64] = if machine.states() == 7 { &[35e5] } else { &[] };
        assert_eq!(beginning.state[6..], *expected);
    }
}

/// Settings outside 0 to 1, gas that vanishes within the range, and a valve of zero size are
/// rejected by path.
#[test]
fn impossible_adjustments_are_refused() {
    let gas = |rises, setting| with_gas(ChamberGas::Adjusted(adjusted(rises, setting)));
    let cases = [
        (gas([1e-5, 0.0], 1.5), "setting"),
        (gas([1e-5, 0.0], f64::NAN), "setting"),
        (behind(GasValve { setting: -0.1, ..VALVE }), "setting"),
        (gas([-3e-5, 0.0], 0.0), "gas_volume"),
        (behind(GasValve { flow_coefficient: 0.0, ..VALVE }), "flow_coefficient"),
    ];
    for (parts, name) in cases {
        let refused = Actuator::new(parts).unwrap_err().to_string();
        assert!(refused.contains(&format!("line.a.accumulator.adjustment.{name}")), "{refused}");
    }
}

/// Pressures of gas and oil equalise as through a conductance if the drop is small.
#[test]
fn a_small_drop_decays_exponentially() {
    let (compliance, opening) = (2e-12, 0.4);
    let gas = GAS.compliance(35e5) + VALVE.compliance;
    let conductance = GasValve { setting: opening, ..VALVE }.conductance();
    let time = 0.5 * compliance / conductance;
    let [chamber, gas_side, ..] =
        switched([35e5 + 10.0, 35e5], compliance, |_| opening, |_| 0.0, (time, 2000), |_| ());
    let expected = 10.0 * exp(-time * conductance * (1.0 / compliance + 1.0 / gas));
    assert!(((chamber - gas_side) / expected - 1.0).abs() < 1e-5, "{} {expected}", chamber - gas_side);
}

/// A limit is a multiple of the precharge: the setting moves both in proportion.
#[test]
fn a_limit_follows_the_precharge() {
    let limited = AdjustedGas { maximum_pressure_ratio: Some(4.0), ..adjusted([1e-5, -6e5], 0.25) };
    let machine = machine_of(with_gas(ChamberGas::Adjusted(limited)), &moving());
    let place = INDICATORS.iter().position(|known| *known == "accumulator_overpressure_a").unwrap();
    for change in [-0.25, 0.0, 0.3, 0.75] {
        // ORIGIN: analytic, P_2 = 4 P_0(u), absolute
        let passed = 4.0 * (GAS.precharge_pressure - 6e5 * change + ATMOSPHERE) - ATMOSPHERE;
        for (pressure, within) in [(passed - 10.0, true), (passed + 10.0, false)] {
            let mut indicators = vec![0.0; machine.indicators()];
            let state = [0.0, 0.0, pressure, 30e5, 0.0, 0.0];
            machine.indicate(&state, &[0.25, 0.0, change, 0.1], &mut indicators);
            assert_eq!(indicators[place] > 0.0, within, "{change}");
        }
    }
}

/// The throttling loss of a valve equals the loss in the account of the neck in its place.
#[test]
fn a_valve_dissipates_its_throttled_power() {
    let machine = machine_of(behind(VALVE), &moving());
    let mut seed = 7;
    for change in [-0.5, -0.2, 0.0, 0.5] {
        for _ in 0..20 {
            let mut of = |middle: f64, scale: f64| middle + scale * random(&mut seed);
            let state = [
                of(0.0, 5.0),
                of(0.0, 10.0),
                of(35e5, 15e5),
                of(30e5, 20e5),
                of(0.0, 1e-4),
                of(0.0, 0.1),
                of(35e5, 15e5),
            ];
            let inputs = [0.25, 0.0, change, 0.0];
            let energy = machine.ledger(&state, &inputs).unwrap().energy;
            let lost: f64 = ENERGY_ACCOUNTS
                .iter()
                .zip(&energy)
                .filter(|(name, _)| name.starts_with("neck_"))
                .map(|(_, account)| account.lost)
                .sum();
            let reported = machine.throttled_at_gas(&state, &inputs);
            assert!(reported >= 0.0 && (reported - lost).abs() <= 1e-12 * lost, "{reported} {lost}");
            assert_eq!(reported == 0.0, change == -0.5);
        }
    }
}
