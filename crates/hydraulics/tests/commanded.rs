//! Machine with its command as first input, for differentiation with respect to it, and its supply.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::portable::pow;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::scalar::{Dual, Scalar};
use phea_dynamics::simulation::{DIRECTIONS, Plant, System, small_signal};
use phea_hydraulics::accumulator::{
    ChamberGas, GasContent, GasPassage, GasValve, Neck, RelaxingGas, SealedGas,
};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cross_port::{CrossPort, Restrictor};
use phea_hydraulics::machine::{Accumulator, InitialCondition, Machine, PowerUnit, PumpLimited};
use phea_hydraulics::operating_point::{Balance, Settled, SettledSupply};
use phea_hydraulics::plant::YieldingSupply;
use phea_hydraulics::servovalve::{SpoolDirection, Supply};
use phea_hydraulics::signal::Signal;

/// Two out of five numbers have a supply that yields, with an accumulator for every other of these;
/// some pumps deliver less than the leakage.
pub(super) fn power_unit(number: u64) -> PowerUnit {
    if number % 5 < 3 {
        return PowerUnit::Constant;
    }
    let mut state = stream(31, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let gas_volume = spread(1e-4, 1e-2);
    let accumulator = Accumulator { gas_volume, precharge_pressure: 40e5, polytropic_exponent: 1.3 };
    PowerUnit::PumpLimited(PumpLimited {
        pump_flow: spread(6e-6, 3e-4),
        relief_override: spread(1e5, 2e6),
        volume: spread(1e-4, 1e-2),
        effective_bulk_modulus: spread(1e8, 1.4e9),
        accumulator: number.is_multiple_of(2).then_some(accumulator),
    })
}

/// Necks of the accumulators at the chambers, for two out of three numbers.
fn necks(number: u64) -> [Option<Neck>; 2] {
    let mut state = stream(43, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    [0.0, 0.0].map(|_| {
        let neck =
            Neck::round([spread(2e-3, 1e-2), spread(1e-2, 0.3)], [870.0, spread(1e-5, 1e-4), 1.45e9], 1.5);
        (spread(1.0, 8.0) > 2.0).then_some(neck)
    })
}

/// Thermal time constants of the gas at the chambers, for half of the numbers.
fn thermal_time_constants(number: u64) -> [Option<f64>; 2] {
    let mut state = stream(47, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    [0, 1].map(|_| (spread(1.0, 4.0) > 2.0).then_some(spread(1e-3, 1e2)))
}

/// Passages between chambers and gas: a valve for half of the chambers whose gas has no neck.
fn passages(number: u64) -> [GasPassage; 2] {
    let mut state = stream(59, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    necks(number).map(|neck| {
        let valve = GasValve {
            flow_coefficient: spread(1e-9, 1e-7),
            transition_pressure: spread(1e3, 1e5),
            compliance: spread(1e-16, 1e-13),
            setting: spread(1e-2, 1.0),
            shut: false,
        };
        match neck {
            Some(neck) => GasPassage::Neck(neck),
            None if spread(1.0, 4.0) > 2.0 => GasPassage::Valve(valve),
            None => GasPassage::Open,
        }
    })
}

/// Gas at one chamber, both or none, in use at most states of rest, from this source of random
/// numbers.
pub(super) fn chamber_gas(source: u64, number: u64) -> [Option<ChamberGas>; 2] {
    let mut state = stream(source, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let has_gas = [number % 8 < 3, (1..5).contains(&(number % 8))];
    let (heat, passages) = (thermal_time_constants(number), passages(number));
    [0, 1].map(|side| {
        has_gas[side].then(|| {
            let (gas_volume, precharge_pressure) = (spread(1e-6, 1e-4), spread(2e5, 20e5));
            let content = match heat[side] {
                None => {
                    let polytropic_exponent = spread(1.0, 1.6);
                    GasContent::Polytropic(Accumulator {
                        gas_volume,
                        precharge_pressure,
                        polytropic_exponent,
                    })
                }
                Some(time_constant) => {
                    GasContent::Relaxing(RelaxingGas { gas_volume, precharge_pressure, time_constant })
                }
            };
            ChamberGas::Sealed(SealedGas { content, passage: passages[side], maximum_pressure_ratio: None })
        })
    })
}

/// Compliances in m3/Pa less that of gas with necks and with heat exchange.
pub(super) fn without_branches(
    components: &Components,
    pressures: [f64; 2],
    compliances: [f64; 2],
) -> [f64; 2] {
    let gas = components.branch_compliance(pressures);
    [compliances[0] - gas[0], compliances[1] - gas[1]]
}

/// Valve of every kind between the chambers, or none.
pub(super) fn cross_port(number: u64) -> Option<CrossPort> {
    let mut state = stream(41, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let laminar = Restrictor::Laminar { conductance: spread(1e-13, 1e-9) };
    let orifice =
        Restrictor::Orifice { flow_coefficient: spread(1e-10, 1e-7), transition_pressure: spread(1e2, 1e5) };
    let capacity = Some(spread(1e-15, 1e-10));
    match (spread(1.0, 2.0) * 500.0) as u64 % 5 {
        0 => None,
        1 => Some(CrossPort { restrictor: laminar, capacity: None }),
        2 => Some(CrossPort { restrictor: orifice, capacity: None }),
        3 => Some(CrossPort { restrictor: laminar, capacity }),
        _ => Some(CrossPort { restrictor: orifice, capacity }),
    }
}

/// Supply pressure of a machine in this state, or the stated one if it does not yield.
pub(super) fn supply_pressure(machine: &Machine, stated: f64, state: &[f64]) -> f64 {
    let place = machine.state_names().iter().position(|name| name == Signal::SupplyPressure.name());
    place.map_or(stated, |place| state[place])
}

/// Supply at rest, for small motions, with this command in V and these pressures at the valve's
/// ports and of the supply in Pa.
pub(super) fn yielding(
    actuator: &Actuator,
    command: f64,
    ports: [f64; 2],
    pressure: f64,
) -> Option<YieldingSupply> {
    let components = actuator.components();
    let PowerUnit::PumpLimited(unit) = &components.power_unit else { return None };
    let supply = Supply { pressure, ..components.supply };
    let settled = SettledSupply { supply, settled: Settled { command, pressures: ports }, taken: f64::NAN };
    let idle = components.supply.pressure;
    // at standstill the areas have no effect
    let balance = Balance::at(components, 0.25);
    Some(YieldingSupply::new(unit, &balance, idle, &settled, SpoolDirection::Extending))
}

/// Machine, and the gain from the load's velocity to the command, V s/m.
pub(super) struct Commanded(pub(super) Machine, pub(super) f64);

impl System<f64> for Commanded {
    fn states(&self) -> usize {
        self.0.states()
    }
    fn inputs(&self) -> usize {
        1 + self.0.inputs()
    }
    fn scales(&self) -> Vec<f64> {
        self.0.scales()
    }
    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let velocity: T = Plant::<f64>::disturbance(&self.0, state, &inputs[1..]);
        self.0.rates(state, inputs[0] + velocity.times(self.1), &inputs[1..], rates);
    }
    fn delays(&self) -> Vec<f64> {
        self.0.delays()
    }
    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        self.0.outgoing(state, &inputs[1..], waves);
    }
}

/// States on which signals of a machine may depend, without those of its lines, and likewise
/// inputs, without waves.
const STATES: usize = 24;
const INPUTS: usize = 4;

/// Slopes of the signals of a machine at rest over its states and its inputs.
pub(super) fn slopes(
    machine: &Machine,
    rest: &InitialCondition,
    signals: &[Signal],
) -> Vec<[f64; STATES + INPUTS]> {
    let mut slopes = vec![[0.0; STATES + INPUTS]; signals.len()];
    for first in (0..STATES + INPUTS).step_by(DIRECTIONS) {
        let seeded = |values: &[f64], from: usize, to: usize| -> Vec<Dual<DIRECTIONS>> {
            let at = |(index, value): (usize, &f64)| match (from + index).checked_sub(first) {
                Some(direction) if from + index < to => Dual::variable(*value, direction),
                _ => Dual::constant(*value),
            };
            values.iter().enumerate().map(at).collect()
        };
        let states = seeded(&rest.state, 0, STATES);
        let inputs = seeded(&rest.all_inputs(), STATES, STATES + INPUTS);
        let outputs = machine.signals(&states, &inputs);
        for (signal, slopes) in signals.iter().zip(&mut slopes) {
            let found = outputs.get(*signal).unwrap();
            slopes.iter_mut().skip(first).zip(found.gradient()).for_each(|(slope, found)| *slope = *found);
        }
    }
    slopes
}

/// Amplitudes of these states of a machine and then of these inputs, for one unit of its command
/// and of the motion of its ground, which for one unit of the rod's end moves by `turned`; with
/// this gain from the load's velocity to the command.
pub(super) fn amplitudes(
    machine: &Machine,
    rest: &InitialCondition,
    (gain, turned): (f64, f64),
    frequency: f64,
) -> [Vec<Complex64>; 2] {
    let inputs = [vec![rest.command], rest.all_inputs()].concat();
    let (zero, one) = (Complex64::ZERO, Complex64::ONE);
    let moved = [zero, one * turned, Complex64::new(0.0, frequency * turned)];
    [[one, zero, zero], moved].map(|drive| {
        let mut drive = drive.to_vec();
        drive.resize(inputs.len(), zero);
        let system = Commanded(*machine, gain);
        let mut states = small_signal(&system, &rest.state, &inputs, &drive, frequency).unwrap();
        let mut inputs = drive.split_off(1);
        states.resize(STATES, zero);
        inputs.resize(INPUTS, zero);
        [states, inputs].concat()
    })
}

/// Amplitude of a signal with these slopes, for these amplitudes.
pub(super) fn signal_of(amplitudes: &[Complex64], slopes: &[f64]) -> Complex64 {
    amplitudes.iter().zip(slopes).map(|(amplitude, slope)| amplitude * *slope).sum()
}
