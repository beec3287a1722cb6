//! Ledgers of oil and energy of the machine in motion, by a separate fixed-step method.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::portable::sin;
use phea_dynamics::scalar::Dual;
use phea_dynamics::simulation::{DIRECTIONS, Plant};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::contact::Contact;
use phea_hydraulics::friction::{Friction, LuGre, LuGrePassivity};
use phea_hydraulics::line::{END_SHARE, LineModel};
use phea_hydraulics::load::Load;
use phea_hydraulics::machine::{
    Account, ENERGY_ACCOUNTS, Machine, MachineError, MachineOptions, OIL_ACCOUNTS, StartValues,
};
use phea_hydraulics::reference_rig::{benchmark_components, leaking, stopped};
use phea_hydraulics::servovalve::Servovalve;

use super::rich_machines::{PLAIN, asymmetric, charged_pump, passive_friction, pump, rich_machines};

/// Classical Runge-Kutta step of rates that depend on time.
pub(super) fn step(state: &mut [f64], time: f64, width: f64, rates: &mut dyn FnMut(f64, &[f64]) -> Vec<f64>) {
    let along = |state: &[f64], slope: &[f64], fraction: f64| -> Vec<f64> {
        state.iter().zip(slope).map(|(value, slope)| value + fraction * width * slope).collect()
    };
    let first = rates(time, state);
    let second = rates(time + 0.5 * width, &along(state, &first, 0.5));
    let third = rates(time + 0.5 * width, &along(state, &second, 0.5));
    let fourth = rates(time + width, &along(state, &third, 1.0));
    for (index, value) in state.iter_mut().enumerate() {
        *value += width / 6.0 * (first[index] + 2.0 * (second[index] + third[index]) + fourth[index]);
    }
}

/// Names of the accounts, oil first.
fn names() -> Vec<String> {
    let oil = OIL_ACCOUNTS.iter().map(|name| format!("oil of {name}"));
    oil.chain(ENERGY_ACCOUNTS.iter().map(|name| format!("energy of {name}"))).collect()
}

/// Accounts at an instant, in the order of [`names`].
fn accounts(machine: &Machine, state: &[f64], inputs: &[f64]) -> Vec<Account<f64>> {
    let ledger = machine.ledger(state, inputs).unwrap();
    ledger.oil.into_iter().chain(ledger.energy).collect()
}

/// Motion of a machine: command in V, ground of its load, and, if it has these inputs, external
/// force on the load and setting of its accumulators.
pub(super) struct Motion {
    pub(super) amplitude: f64,
    pub(super) bias: f64,
    pub(super) ground: f64,
    pub(super) ground_amplitude: f64,
}

impl Motion {
    fn command(&self, time: f64) -> f64 {
        self.bias + self.amplitude * (sin(40.0 * time) + 0.5 * sin(113.0 * time))
    }

    fn inputs(&self, time: f64) -> [f64; 5] {
        let (frequency, quarter) = (25.0, std::f64::consts::FRAC_PI_2);
        let cosine = sin(frequency * time + quarter);
        [
            self.ground + self.ground_amplitude * (1.0 - cosine),
            self.ground_amplitude * frequency * sin(frequency * time),
            300.0 * sin(60.0 * time),
            0.3 * sin(70.0 * time),
            21.0 * sin(70.0 * time + quarter),
        ]
    }
}

/// Result of a run: each account's name, its closure error, its throughput, and its loss.
struct Closing {
    name: String,
    gap: f64,
    throughput: f64,
    lost: f64,
    least_loss: f64,
}

/// Inflow and losses are summed by Simpson's rule over the steps.
fn run(machine: &Machine, motion: &Motion, start: &[f64], duration: f64, width: f64) -> Vec<Closing> {
    let at = |index: usize, state: &[f64]| accounts(machine, state, &motion.inputs(index as f64 * width));
    let mut rates = |time: f64, state: &[f64]| {
        let mut rates = vec![0.0; state.len()];
        machine.rates(state, motion.command(time), &motion.inputs(time), &mut rates);
        rates
    };
    let mut state = start.to_vec();
    let mut now = at(0, &state);
    let empty = |(name, account): (String, &Account<f64>)| {
        let (gap, throughput, lost, least_loss) = (account.stored, 0.0, 0.0, account.lost.min(0.0));
        Closing { name, gap, throughput, lost, least_loss }
    };
    let mut closing: Vec<Closing> = names().into_iter().zip(&now).map(empty).collect();
    let steps = (duration / width).round() as usize;
    assert_eq!(steps % 2, 0);
    for index in 0..=steps {
        let of_simpson = if index == 0 || index == steps { 1.0 } else { (2 + index % 2 * 2) as f64 };
        let weight = of_simpson * width / 3.0;
        for (sum, Account { inflow, lost, .. }) in closing.iter_mut().zip(&now) {
            sum.gap += weight * (inflow - lost);
            sum.throughput += weight * (inflow.abs() + lost.abs());
            sum.lost += weight * lost;
            sum.least_loss = sum.least_loss.min(*lost);
        }
        if index < steps {
            step(&mut state, index as f64 * width, width, &mut rates);
            now = at(index + 1, &state);
        }
    }
    assert!(state.iter().all(|value| value.is_finite()));
    for (sum, account) in closing.iter_mut().zip(&now) {
        sum.gap -= account.stored;
    }
    closing
}

pub(super) fn machine_of(components: Components, options: &MachineOptions) -> Machine {
    Machine::new(&Actuator::new(components).unwrap(), options).unwrap()
}

/// Every account closes, and no dissipative part supplies energy.
pub(super) fn check(machine: &Machine, motion: &Motion, start: &StartValues, duration: f64, width: f64) {
    let beginning = machine.start(start).unwrap();
    let motion = Motion { ground: beginning.inputs[0], ..*motion };
    // heat flows in both directions between gas and wall
    let mut heats = false;
    for Closing { name, gap, throughput, lost, least_loss } in
        run(machine, &motion, &beginning.state, duration, width)
    {
        assert!(gap.abs() <= 1e-6 * throughput, "{name}: {gap} of {throughput}");
        heats |= name.contains("gas_heat") && throughput > 0.0;
        if name.starts_with("energy") && !(name.contains("gas_heat") || heats && name.ends_with("rig")) {
            assert!(least_loss >= -1e-9 * lost.max(1e-6), "{name} gives energy: {least_loss}");
        }
    }
}

#[test]
fn ledgers_close_against_a_prescribed_motion() {
    let motion = Motion { amplitude: 1.5, bias: 0.2, ground: 0.0, ground_amplitude: 2e-3 };
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let passive = Components { friction: passive_friction(), ..benchmark_components() };
    check(&machine_of(passive, &MachineOptions::default()), &motion, &start, 0.3, 2e-5);
    let pumped = Components { power_unit: pump(), ..leaking(asymmetric(), 2e-12) };
    check(&machine_of(pumped, &MachineOptions::default()), &motion, &start, 0.3, 2e-5);
}

#[test]
fn ledgers_close_with_loads_of_their_own() {
    let motion = Motion { amplitude: 1.5, bias: 0.4, ground: 0.0, ground_amplitude: 1e-3 };
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let sprung = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let walled =
        Load::Wall { mass: Some(8.0), damping: 50.0, stiffness: 3e7, gap: 4e-4, relative_damping: 0.4 };
    for load in [sprung, walled] {
        let rig = Components { load, ..asymmetric() };
        let pushed = MachineOptions { external_force: true, ..MachineOptions::default() };
        check(&machine_of(rig, &pushed), &motion, &start, 0.3, 1e-5);
        let pumped = Components { power_unit: pump(), ..rig };
        for rig in [pumped, rig] {
            check(&machine_of(rig, &MachineOptions::default()), &motion, &start, 0.3, 1e-5);
        }
    }
}

/// Driven into both of its stops, the piston stays within its stroke, the stops are reported, and
/// the ledgers close.
#[test]
fn ledgers_close_in_the_end_stops() {
    let contact = Contact { stiffness: 1e8, relative_damping: 0.5 };
    let load = Load::SpringMassDamper { mass: 5.0, stiffness: 0.0, damping: 100.0 };
    // an open edge at zero drop and a small chamber are too fast for this method if the root's
    // transition is short
    let rig = asymmetric();
    let valve = Servovalve { transition_pressure: 1e5, ..rig.valve };
    let machine = machine_of(stopped(Components { valve, load, ..rig }, contact), &MachineOptions::default());
    for (position, bias) in [(0.002, -4.0), (0.498, 4.0)] {
        let motion = Motion { amplitude: 2.0, bias, ground: 0.0, ground_amplitude: 0.0 };
        let start = StartValues { position, pressure_a: 20e5, pressure_b: 20e5, ..StartValues::default() };
        check(&machine, &motion, &start, 0.1, 2e-6);
        let beginning = machine.start(&start).unwrap();
        let inputs = beginning.inputs;
        let motion = Motion { ground: inputs[0], ..motion };
        let mut state = beginning.state;
        let mut rates = |time: f64, state: &[f64]| {
            let mut rates = vec![0.0; state.len()];
            machine.rates(state, motion.command(time), &inputs, &mut rates);
            rates
        };
        let mut deepest = f64::INFINITY;
        for index in 0..15_000 {
            step(&mut state, index as f64 * 2e-5, 2e-5, &mut rates);
            let mut indicators = vec![0.0; machine.indicators()];
            machine.indicate(&state, &inputs, &mut indicators);
            deepest = deepest.min(indicators[2].min(indicators[3]));
        }
        // the whole supply presses 70 bar on 1.96e-3 m2: 0.14 mm into 1e8 N/m, and at most twice
        // that when it bounces
        assert!(deepest < -2e-5 && deepest > -2.8e-4, "{deepest}");
    }
}

/// Nothing is lost between components: their total inflow is the flow across the rig's border.
#[test]
fn the_rig_is_the_sum_of_its_components() {
    let load =
        Load::Wall { mass: Some(8.0), damping: 50.0, stiffness: 3e7, gap: 4e-4, relative_damping: 0.4 };
    let plain = leaking(asymmetric(), 2e-12);
    let with_pump = Components { power_unit: pump(), load, ..plain };
    let [with_pump, plain] = [with_pump, plain].map(|rig| machine_of(rig, &MachineOptions::default()));
    for (machine, more) in [(with_pump, vec![2e-6, 0.25, 0.1, 66e5]), (plain, vec![2e-6])] {
        let mut state = vec![0.7, 20.0, 41e5, 22e5, 3e-4, 0.08];
        state.extend(more);
        let ledger = machine.ledger(&state, &[0.2498, 0.05]).unwrap();
        let [components @ .., rig] = ledger.energy;
        let sum: f64 = components.iter().map(|account| account.inflow).sum();
        assert!((sum - rig.inflow).abs() < 1e-9 * rig.inflow.abs().max(1e3), "{sum} {}", rig.inflow);
        let [components @ .., rig] = ledger.oil;
        let sum: f64 = components.iter().map(|account| account.inflow).sum();
        assert!((sum - (rig.inflow - rig.lost)).abs() < 1e-15, "{sum} {}", rig.inflow);
        // an orifice law in volumes loses at most p_S/beta of the flow
        assert!(rig.lost.abs() < 70e5 / 1e9 * 2.0 * 3e-4);
    }
}

#[test]
fn ledgers_close_with_gas_air_and_lines() {
    let motion = Motion { amplitude: 1.5, bias: 0.2, ground: 0.0, ground_amplitude: 2e-3 };
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    for (_, machine) in rich_machines() {
        check(&machine, &motion, &start, 0.1, 1e-5);
    }
}

/// Next state of a generator of numbers from -1 to 1, and the number.
pub(super) fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Error of the accounts at this state: the content must change, along the rates of all states, by
/// inflow and losses; stored or dissipated energy is never below zero.
pub(super) fn check_instant(name: &str, machine: &Machine, state: &[f64], command: f64, inputs: [f64; 2]) {
    // in the first of the directions for which the machine is compiled
    let along = |value: f64, rate: f64| {
        Dual::<DIRECTIONS>::new(
            value,
            std::array::from_fn(|direction| if direction == 0 { rate } else { 0.0 }),
        )
    };
    let mut moved = vec![along(inputs[0], inputs[1]), along(inputs[1], 0.0)];
    moved.extend(machine.has_external_force().then_some(along(150.0, 0.0)));
    // a setting that moves
    moved.extend([along(0.2, 1.5), along(1.5, 0.0)]);
    let inputs: Vec<f64> = moved.iter().map(|input| input.value()).collect();
    let mut rates = vec![0.0; state.len()];
    machine.rates(state, command, &inputs, &mut rates);
    let moving: Vec<_> = state.iter().zip(&rates).map(|(value, rate)| along(*value, *rate)).collect();
    let ledger = machine.ledger(&moving, &moved).unwrap();
    let names = OIL_ACCOUNTS.iter().chain(&ENERGY_ACCOUNTS);
    let accounts = names.zip(ledger.oil.iter().chain(&ledger.energy));
    for (index, (account, Account { stored, inflow, lost })) in accounts.enumerate() {
        let growth = stored.gradient()[0];
        let (inflow, lost) = (inflow.value(), lost.value());
        let gap = growth - (inflow - lost);
        let size = growth.abs().max(inflow.abs()).max(lost.abs());
        assert!(gap.abs() <= 1e-9 * size, "{account} of {name}: {gap} of {size}");
        if index >= OIL_ACCOUNTS.len() {
            // heat flows in both directions between gas and wall
            let only_lost = !(account.starts_with("gas_heat") || name.contains("heat") && *account == "rig");
            assert!(stored.value() >= 0.0, "{account} of {name}: {stored:?}");
            assert!(!only_lost || lost >= -1e-12 * size, "{account} of {name}: {lost}");
        }
    }
}

/// Accounts at any state, including unreachable ones: near the pressures of a run, and about
/// atmospheric pressure, with gas released.
#[test]
fn what_is_stored_changes_by_what_enters_and_is_lost() {
    let mut seed = 7;
    let mut machines = rich_machines();
    let charged = Components { power_unit: charged_pump(75e5, 1.4), ..asymmetric() };
    machines.push(("gas at its precharge", machine_of(charged, &MachineOptions::default())));
    for ((name, machine), (pressure, fraction)) in
        machines.iter().flat_map(|named| [(named, (35e5, 4.0)), (named, (0.0, 0.13))])
    {
        let start = StartValues {
            position: 0.25,
            pressure_a: pressure,
            pressure_b: pressure,
            ..StartValues::default()
        };
        let beginning = machine.start(&start).unwrap();
        for _ in 0..20 {
            let around = beginning.state.iter().zip(machine.scales());
            let state: Vec<f64> =
                around.map(|(value, scale)| value + fraction * scale * random(&mut seed)).collect();
            let inputs = [0.25 + 0.2 * random(&mut seed), 0.1 * random(&mut seed)];
            check_instant(name, machine, &state, random(&mut seed), inputs);
        }
    }
}

/// Waves in transit in a line are not part of states and inputs: there is no ledger, rather than a
/// wrong one.
#[test]
fn waves_have_no_ledger() {
    let rig = asymmetric();
    let waves = LineModel::TransmissionLine { end_share: END_SHARE };
    let rig = Components { line_models: [PLAIN, waves], ..rig };
    let machine = machine_of(rig, &MachineOptions::default());
    let start = StartValues { position: 0.25, pressure_a: 35e5, pressure_b: 30e5, ..StartValues::default() };
    let beginning = machine.start(&start).unwrap();
    assert!(machine.ledger(&beginning.state, &beginning.all_inputs()).is_none());
}

/// Energy that friction takes over one cycle of velocities in m/s held over distances in m, after
/// the bristles settled, J.
fn cycle_energy(lugre: &LuGre, legs: &[(f64, f64)]) -> f64 {
    let mut state = vec![0.0, 0.0];
    let mut taken = 0.0;
    for _ in 0..4 {
        let before = state[1];
        for &(velocity, distance) in legs {
            let width = distance / velocity.abs() / 400.0;
            let mut rates = |_: f64, state: &[f64]| {
                let rate = lugre.bristle_rate(velocity, state[0]);
                vec![rate, lugre.force(velocity, state[0]) * velocity]
            };
            for _ in 0..400 {
                step(&mut state, 0.0, width, &mut rates);
            }
        }
        taken = state[1] - before;
    }
    taken
}

/// LuGre friction absorbs energy over every cycle if sigma_2 >= sigma_1 (F_S - F_C)/F_C. Outside, a
/// slow creep that loads the bristles to F_S and a jerk that unloads them at F_C supply energy,
/// cycle after cycle.
#[test]
fn lugre_takes_energy_under_its_condition_and_may_give_it_outside() {
    let Friction::LuGre(outside) = benchmark_components().friction else { unreachable!() };
    let Friction::LuGre(inside) = passive_friction() else { unreachable!() };
    let jerk = [(1e-4, 3e-5), (3.0, 8e-6), (-1e-4, 3e-5), (-3.0, 8e-6)];
    assert!(matches!(outside.passivity(), LuGrePassivity::NotPassive { .. }));
    assert!(cycle_energy(&outside, &jerk) < -5e-3);
    assert!(cycle_energy(&inside, &jerk) > 1e-3);
    for slow in [1e-4, 1e-3, 1e-2] {
        for fast in [0.1, 0.3, 1.0, 3.0, 10.0] {
            for reach in [1e-6, 1e-5, 1e-4] {
                let legs = [(slow, 3e-5), (fast, reach), (-slow, 3e-5), (-fast, reach)];
                assert!(cycle_energy(&inside, &legs) > 0.0, "{slow} {fast} {reach}");
            }
        }
    }
}

/// Newton's law of the load: an external force changes only its acceleration, by F_x/m, and its
/// power is the power that the load and the rig absorb.
#[test]
fn an_external_force_acts_on_the_load_only() {
    let load = Load::SpringMassDamper { mass: 20.0, stiffness: 3e5, damping: 200.0 };
    let options = MachineOptions { external_force: true, ..MachineOptions::default() };
    let machine = machine_of(Components { load, ..asymmetric() }, &options);
    let start = StartValues {
        position: 0.25,
        pressure_a: 35e5,
        pressure_b: 30e5,
        force: 500.0,
        ..StartValues::default()
    };
    let beginning = machine.start(&start).unwrap();
    assert_eq!((machine.inputs(), beginning.external_force), (3, Some(0.0)));
    let mut state = beginning.state.clone();
    let velocity = state.len() - 1;
    state[velocity] = 0.4;
    let at = |force: f64| {
        let inputs = [beginning.inputs[0], 0.1, force];
        let mut rates = vec![0.0; state.len()];
        machine.rates(&state, 1.0, &inputs, &mut rates);
        (rates, machine.ledger(&state, &inputs).unwrap())
    };
    let ((still, unpushed), (pushed, ledger)) = (at(0.0), at(700.0));
    for (index, (one, other)) in still.iter().zip(&pushed).enumerate() {
        let expected = if index == velocity { 700.0 / 20.0 } else { 0.0 };
        assert!((other - one - expected).abs() < 1e-9 * one.abs().max(1.0), "{index}: {one} {other}");
    }
    for name in ["load", "rig"] {
        let place = ENERGY_ACCOUNTS.iter().position(|known| *known == name).unwrap();
        let gained = ledger.energy[place].inflow - unpushed.energy[place].inflow;
        assert!(
            (gained - 700.0 * 0.4).abs() < 1e-9 * unpushed.energy[place].inflow.abs().max(1e3),
            "{name}: {gained}"
        );
    }
    let refused = MachineOptions { external_force: true, ..MachineOptions::default() };
    let actuator = Actuator::new(asymmetric()).unwrap();
    assert_eq!(Machine::new(&actuator, &refused), Err(MachineError::UnyieldingLoad));
}
