//! The machine's Jacobian by dual numbers, compared with differences and with the linearised model.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::linear::StateSpace;
use phea_dynamics::scalar::{Dependence, Dual};
use phea_dynamics::simulation::{DIRECTIONS, Plant};
use phea_hydraulics::actuator::{Actuator, Components};
use phea_hydraulics::cylinder::{Cylinder, annulus_area};
use phea_hydraulics::line::StiffeningMember;
use phea_hydraulics::machine::{Machine, MachineOptions};
use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
use phea_hydraulics::reference_rig::{components, cylinder, hose_line, pipe_line};
use phea_hydraulics::servovalve::SpoolDirection;
use phea_hydraulics::stiffness::StiffnessModel;
use phea_hydraulics::two_pressure::{TwoPressureModel, linearize, two_pressure_linear_parameters};

use crate::machine_equations::{Noise, machines, rates_of, some_state};

/// State, command and inputs with the derivatives of the first, of the next and so on by
/// themselves: a few, beginning with this one.
fn seeded(
    (state, command, inputs): (&[f64], f64, &[f64]),
    first: usize,
) -> (Vec<Dual<DIRECTIONS>>, Dual<DIRECTIONS>, Vec<Dual<DIRECTIONS>>) {
    let all = state.iter().chain([&command]).chain(inputs);
    let variable = |(index, &value): (usize, &f64)| match index.checked_sub(first) {
        Some(direction) => Dual::variable(value, direction),
        None => Dual::constant(value),
    };
    let mut states: Vec<_> = all.enumerate().map(variable).collect();
    let mut others = states.split_off(state.len());
    let inputs = others.split_off(1);
    (states, others[0], inputs)
}

/// Derivatives by dual numbers agree with central differences, and differ from zero only within the
/// pattern.
#[test]
fn jacobians_are_slopes_within_their_sparsity_pattern() {
    let mut noise = Noise(7);
    for machine in machines() {
        let count = machine.states();
        let variables: Vec<Dependence> = (0..count).map(Dependence::on).collect();
        let mut pattern = vec![Dependence::from(0.0); count];
        machine.rates(
            &variables,
            Dependence::on(count),
            &vec![Dependence::from(0.0); machine.inputs()],
            &mut pattern,
        );
        for _ in 0..40 {
            let (state, command, inputs) = some_state(&machine, &mut noise);
            let plain = rates_of(&machine, &state, command, &inputs);
            let slopes_from = |first: usize| {
                let (states, command, inputs) = seeded((&state, command, &inputs), first);
                let mut rates = vec![Dual::constant(0.0); count];
                machine.rates(&states, command, &inputs, &mut rates);
                rates
            };
            let by_parts: Vec<Vec<Dual<DIRECTIONS>>> =
                (0..count).step_by(DIRECTIONS).map(slopes_from).collect();
            for (row, rate) in by_parts.iter().flat_map(|rates| rates.iter().enumerate()) {
                assert!((rate.value() - plain[row]).abs() <= 1e-12 * plain[row].abs());
            }
            for column in 0..count {
                let rates = &by_parts[column / DIRECTIONS];
                let step = 1e-6 * machine.scales()[column];
                let moved = |by: f64| {
                    let mut moved = state.clone();
                    moved[column] += by;
                    rates_of(&machine, &moved, command, &inputs)
                };
                let (above, below, near) = (moved(step), moved(-step), moved(0.5 * step));
                for (row, rate) in rates.iter().enumerate() {
                    let slope = rate.gradient()[column % DIRECTIONS];
                    assert!(slope == 0.0 || pattern[row].includes(column), "({row}, {column})");
                    let difference = (above[row] - below[row]) / (2.0 * step);
                    let kink = (near[row] - plain[row]) / (0.5 * step);
                    let rounding = 1e-9 * plain[row].abs().max(machine.scales()[row]) / step;
                    let allowed = 1e-6 * slope.abs() + 2.0 * (kink - difference).abs() + rounding;
                    assert!(
                        (slope - difference).abs() <= allowed,
                        "({row}, {column}): {slope}, {difference}"
                    );
                }
            }
        }
    }
}

/// The viscous rig's Jacobian is the linearised two-pressure model, at rest and in steady motion.
#[test]
fn small_motions_are_those_of_the_two_pressure_model() {
    let [area_a, area_b] = [0.0, 0.022].map(|rod| annulus_area(0.05, rod));
    let hose = components(hose_line(), StiffnessModel::ByVolume);
    let asymmetric =
        Components { cylinder: Cylinder { area_a, area_b, ..cylinder() }, line_b: pipe_line(), ..hose };
    for rig in [hose, asymmetric] {
        let actuator = Actuator::new(rig).unwrap();
        let machine = Machine::new(&actuator, &MachineOptions::default()).unwrap();
        for condition in
            [Condition::Load(SteadyLoad::Force(2000.0)), Condition::Motion(1.5, SteadyLoad::Force(1000.0))]
        {
            let point = operating_point(&actuator, 0.1, condition).unwrap();
            let model = TwoPressureModel::new(&actuator, [0.0; 2], StiffeningMember::Nominal, 100.0);
            let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
            let system = linearize(&parameters).unwrap();
            let beginning = machine.rest(&point).unwrap();
            compare(&machine, &system, &beginning.state, beginning.command, &beginning.inputs);
        }
    }
}

fn compare(machine: &Machine, system: &StateSpace, state: &[f64], command: f64, inputs: &[f64; 2]) {
    let slopes_from = |first: usize| {
        let (states, command, inputs) = seeded((state, command, inputs), first);
        let mut rates = vec![Dual::constant(0.0); 6];
        machine.rates(&states, command, &inputs, &mut rates);
        (rates, machine.measurement(&states, &inputs))
    };
    let ((by_state, sensed), (by_input, _)) = (slopes_from(0), slopes_from(6));
    for row in 0..6 {
        // six states, the command, and the second of the inputs
        let (states, [command, _, velocity, ..]) = (by_state[row].gradient(), *by_input[row].gradient());
        for (column, &found) in states.iter().chain(&[command, velocity]).enumerate() {
            let expected = if column < 6 { system.a()[(row, column)] } else { system.b()[(row, column - 6)] };
            // the effect of the deflection on the compliances vanishes with the net flow
            let scale = if column == 4 && row < 4 { states[5].abs() * 100.0 } else { expected.abs() };
            assert!((found - expected).abs() <= 1e-8 * scale, "({row}, {column}): {found}, {expected}");
        }
    }
    assert_eq!(sensed.gradient()[4], system.c()[(0, 4)]);
}
