//! Accumulators at the chambers: published and recomputed numbers, limits, and the moment at which
//! the gas is shut off.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::simulation::Plant;
use phea_hydraulics::accumulator::{Accumulator, ChamberGas};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::line::{Line, StiffeningMember};
use phea_hydraulics::machine::{INDICATORS, Machine, MachineOptions};
use phea_hydraulics::reference_rig::{components, cylinder, hose_line, pipe_line};
use phea_hydraulics::stiffness::{StiffnessModel, hydraulic_stiffness};

/// Rig of the thesis with lines of negligible volume, and this gas at both chambers.
fn rig(gas: Option<Accumulator>) -> Components {
    let line = Line::Volume { volume: 1e-12, effective_bulk_modulus: 1.45e9 };
    Components { gas: [gas.map(ChamberGas::from); 2], ..components(line, StiffnessModel::ByVolume) }
}

fn stiffness(components: &Components, pressures: [f64; 2]) -> f64 {
    let chambers = components.chamber_compliance(pressures, StiffeningMember::Nominal);
    hydraulic_stiffness(&chambers, cylinder().stroke.middle())
}

/// Gas that softens the actuator as much as metres of hose: at rest, and hardly stiffer at 4 kN.
#[test]
fn ten_millilitres_of_gas_do_the_work_of_the_hose() {
    let gas = |precharge_pressure: f64, gas_volume: f64| Accumulator {
        gas_volume,
        precharge_pressure,
        polytropic_exponent: 1.4,
    };
    // 17.7 mL at 15 bar are 9.9 mL at 35 bar, and stay in use at 4 kN
    let charged = rig(Some(gas(15e5, 1.766_247e-5)));
    let idle = stiffness(&charged, [35e5; 2]);
    // ORIGIN: recomputed by comparisons/recompute_accumulator.py
    assert!((idle - 2.241_87e6).abs() < 5.0, "{idle}");
    let area = cylinder().area_a;
    let loaded = stiffness(&charged, [35e5 + 2e3 / area, 35e5 - 2e3 / area]);
    // ORIGIN: recomputed by comparisons/recompute_accumulator.py
    assert!((loaded / idle - 1.028_21).abs() < 1e-5, "{}", loaded / idle);
}

/// Results of the machine at a state as the gas volume tends to zero: proportionally those of the
/// rig without it.
#[test]
fn an_accumulator_without_gas_leaves_the_rig_unchanged() {
    let rates = |gas_volume: Option<f64>| {
        let gas = gas_volume.map(|gas_volume| Accumulator {
            gas_volume,
            precharge_pressure: 10e5,
            polytropic_exponent: 1.4,
        });
        let rig = Components {
            gas: [gas.map(ChamberGas::from); 2],
            ..components(hose_line(), StiffnessModel::ByVolume)
        };
        let actuator = Actuator::new(rig).unwrap();
        let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
        let mut rates = vec![0.0; machine.states()];
        machine.rates(&[1.0, 20.0, 41e5, 28e5, 1e-4, 0.05], 1.2, &[0.2, 0.01], &mut rates);
        rates
    };
    let bare = rates(None);
    let apart = |gas_volume: f64| {
        let gaps = rates(Some(gas_volume)).into_iter().zip(&bare);
        gaps.map(|(with, bare)| ((with - bare) / bare.abs().max(1.0)).abs()).fold(0.0, f64::max)
    };
    assert!(apart(1e-6) > 1e-2);
    let [little, less] = [1e-11, 1e-13].map(apart);
    assert!((little / less / 100.0 - 1.0).abs() < 1e-3, "{little} {less}");
    assert!(apart(1e-15) < 1e-9);
}

/// Gas below the precharge takes no oil, which the indicator reports; the compliance of the
/// chamber's oil is not that of an empty chamber.
#[test]
fn gas_is_shut_off_below_its_precharge() {
    let gas = Accumulator { gas_volume: 2e-5, precharge_pressure: 20e5, polytropic_exponent: 1.4 };
    let of = |gas| {
        let rig = Components { gas, ..components(pipe_line(), StiffnessModel::ByVolume) };
        Machine::new(&Actuator::new(rig).unwrap(), &MachineOptions::default()).unwrap()
    };
    let (with, without) = (of([Some(gas.into()), None]), of([None; 2]));
    let place = |name: &str| INDICATORS.iter().position(|known| *known == name).unwrap();
    for (pressure, in_use) in [(19.7e5, false), (20.3e5, true)] {
        let state = [1.0, 0.0, pressure, 30e5, 1e-4, 0.05];
        let indicators_of = |machine: &Machine| {
            let mut indicators = vec![0.0; machine.indicators()];
            machine.indicate(&state, &[0.25, 0.0], &mut indicators);
            indicators
        };
        let rate = |machine: &Machine| {
            let mut rates = vec![0.0; machine.states()];
            machine.rates(&state, 1.0, &[0.25, 0.0], &mut rates);
            rates[2]
        };
        let (found, bare) = (indicators_of(&with), indicators_of(&without));
        assert_eq!(found[place("accumulator_empty_a")] > 0.0, in_use);
        assert!(found[place("accumulator_empty_b")] > 0.0 && bare[place("accumulator_empty_a")] > 0.0);
        assert_eq!(found[place("empty_a")], bare[place("empty_a")]);
        assert_eq!(rate(&with) == rate(&without), !in_use);
    }
}

/// Gas without volume, without precharge, or with an impossible index is rejected by its path.
#[test]
fn impossible_gas_is_refused() {
    for (gas_volume, precharge_pressure, polytropic_exponent, quantity) in [
        (0.0, 10e5, 1.4, "gas_volume"),
        (1e-5, -1e5, 1.4, "precharge_pressure"),
        (1e-5, 10e5, 0.9, "polytropic_exponent"),
        (1e-5, 10e5, 1.7, "polytropic_exponent"),
    ] {
        let gas = Accumulator { gas_volume, precharge_pressure, polytropic_exponent };
        let refused = Actuator::new(Components { gas: [None, Some(gas.into())], ..rig(None) }).unwrap_err();
        assert_eq!(refused.problems.len(), 1);
        assert_eq!(refused.problems[0].quantity, format!("line.b.accumulator.{quantity}"));
    }
}
