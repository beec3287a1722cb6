//! Friction on test compared with the LuGre equations, integrated by another method.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use phea_hydraulics::friction::{KnottedForce, LuGre, MultisineForce, PressedMass, SlidBlock};

/// Friction with levels of the other direction.
const NUMBERS: [f64; 10] = [80.0, 120.0, 0.01, 2.0, 100.0, 1e7, 2e3, 95.0, 150.0, 100.0];
const MASS: f64 = 13.1;

/// Displacement of a mass on bristles from this initial velocity and deflection, by the Runge-Kutta
/// method with this number of steps between rows.
fn runge_kutta(
    lugre: &LuGre,
    [velocity, deflection]: [f64; 2],
    force: &[f64],
    time_step: f64,
    steps: usize,
) -> Vec<f64> {
    let rates = |[_, velocity, deflection]: [f64; 3], force: f64| {
        let bristle = lugre.bristle_rate(velocity, deflection);
        [velocity, (force - lugre.force(velocity, deflection)) / MASS, bristle]
    };
    let mut state = [0.0, velocity, deflection];
    let mut moved = vec![0.0];
    let h = time_step / steps as f64;
    for ends in force.windows(2) {
        for step in 0..steps {
            let at = |fraction: f64| ends[0] + (ends[1] - ends[0]) * (step as f64 + fraction) / steps as f64;
            let add = |rate: [f64; 3], by: f64| std::array::from_fn(|i| state[i] + by * rate[i]);
            let first = rates(state, at(0.0));
            let second = rates(add(first, h / 2.0), at(0.5));
            let third = rates(add(second, h / 2.0), at(0.5));
            let fourth = rates(add(third, h), at(1.0));
            state = std::array::from_fn(|i| {
                state[i] + h / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i])
            });
        }
        moved.push(state[0]);
    }
    moved
}

/// A force of 96 N applied slowly and released within 3 ms: the mass rings on its bristles, and
/// retains a part of the displacement.
fn released() -> KnottedForce {
    KnottedForce { knots: vec![0, 60, 63, 120], forces: vec![0.0, 96.0, 0.0, 0.0] }
}

fn rows(force: &KnottedForce) -> Vec<f64> {
    force
        .fractions()
        .into_iter()
        .map(|(knot, fraction)| force.forces[knot] * (1.0 - fraction) + force.forces[knot + 1] * fraction)
        .collect()
}

#[test]
fn a_pressed_mass_satisfies_the_equations() {
    let lugre = LuGre::from_array(NUMBERS);
    let force = rows(&released());
    let exact = runge_kutta(&lugre, [0.0; 2], &force, 1e-3, 200);
    let at = |substeps| {
        let pressed = PressedMass { mass: MASS, time_step: 1e-3, substeps };
        let moved = pressed.displacements(&lugre, &force);
        moved.iter().zip(&exact).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    };
    // 20 um of displacement; the error falls with the square of the step
    assert!(exact.iter().copied().fold(0.0, f64::max) > 15e-6);
    let [coarse, fine] = [4, 16].map(at);
    assert!(coarse < 0.1e-6, "{coarse}");
    assert!(fine < coarse / 8.0, "{coarse} {fine}");
}

#[test]
fn a_mass_that_creeps_on_soft_bristles_satisfies_the_equations() {
    let soft = LuGre::same_both_ways([80.0, 120.0, 0.01, 1.5, 100.0, 2e4, 6e3]);
    let force = rows(&released());
    let exact = runge_kutta(&soft, [0.0; 2], &force, 1e-3, 200);
    let pressed = PressedMass { mass: MASS, time_step: 1e-3, substeps: 2 };
    let moved = pressed.displacements(&soft, &force);
    let largest = exact.iter().copied().fold(0.0, f64::max);
    for (one, other) in moved.iter().zip(&exact) {
        assert!((one - other).abs() < 1e-4 * largest, "{one} {other}");
    }
}

#[test]
fn the_derivatives_are_those_of_the_displacement() {
    let lugre = LuGre::from_array(NUMBERS);
    let force = released();
    let pressed = PressedMass { mass: MASS, time_step: 1e-3, substeps: 4 };
    let found = pressed.sensitive_displacements(&lugre, &force);
    let plain = pressed.displacements(&lugre, &rows(&force));
    assert_eq!(found.displacements.len(), plain.len());
    let count = NUMBERS.len() + force.forces.len();
    for (one, other) in found.displacements.iter().zip(&plain) {
        assert!((one - other).abs() < 1e-15);
    }
    let largest = 20e-6;
    for index in 0..count {
        let moved = |sign: f64| {
            let (mut numbers, mut force) = (NUMBERS, force.clone());
            let by = 1e-5 * sign;
            match index.checked_sub(NUMBERS.len()) {
                None => numbers[index] *= 1.0 + by,
                Some(knot) => force.forces[knot] += 100.0 * by,
            }
            pressed.displacements(&LuGre::from_array(numbers), &rows(&force))
        };
        let unit = NUMBERS.get(index).copied().unwrap_or(100.0);
        for (row, (more, less)) in moved(1.0).iter().zip(moved(-1.0)).enumerate() {
            let slope = found.gradients[row * count + index] * unit;
            let difference = (more - less) / 2e-5;
            // the bristles' slip has a kink where the mass reverses
            assert!((slope - difference).abs() < 3e-3 * largest, "{index} {row}: {slope} {difference}");
        }
    }
}

/// Three sines that make the bristles slip, and a mean that drifts.
fn shaking() -> MultisineForce {
    MultisineForce {
        rows: 600,
        frequencies: vec![500.0, 830.0, 1210.0],
        duration: 599.0 * 2e-4,
        sizes: vec![3.0, -1.0, 0.5, 10.0, -5.0, 8.0, 2.0, -6.0, 9.0],
    }
}

/// Velocity and deflection at the first row.
const BEGINNING: [f64; 2] = [-1e-3, 2e-6];

#[test]
fn a_shaken_mass_satisfies_the_equations() {
    let lugre = LuGre::from_array(NUMBERS);
    let force = shaking();
    let fine = force.along(599 * 20 + 1, 1e-5);
    let exact = runge_kutta(&lugre, BEGINNING, &fine, 1e-5, 4);
    let at = |substeps| {
        let pressed = PressedMass { mass: MASS, time_step: 2e-4, substeps };
        let moved = pressed.shaken(&lugre, BEGINNING, (&force.sizes, &pressed.shapes(&force))).displacements;
        assert_eq!(moved.len(), 600);
        moved.iter().zip(exact.iter().step_by(20)).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    };
    assert!(exact.iter().copied().fold(0.0, f64::max) > 5e-6);
    let [coarse, fine] = [3, 12].map(at);
    assert!(coarse < 0.02e-6, "{coarse}");
    assert!(fine < coarse / 8.0, "{coarse} {fine}");
}

#[test]
fn the_derivatives_of_a_shaken_mass_are_those_of_the_displacement() {
    let lugre = LuGre::from_array(NUMBERS);
    let force = shaking();
    let pressed = PressedMass { mass: MASS, time_step: 2e-4, substeps: 8 };
    let shapes = pressed.shapes(&force);
    let found = pressed.shaken(&lugre, BEGINNING, (&force.sizes, &shapes));
    let units: Vec<f64> =
        NUMBERS.iter().chain(&[1e-3, 1e-6]).copied().chain(force.sizes.iter().map(|_| 10.0)).collect();
    let count = units.len();
    assert_eq!(found.gradients.len(), 600 * count);
    for (index, unit) in units.iter().enumerate() {
        let moved = |sign: f64| {
            let mut all: Vec<f64> = NUMBERS.iter().chain(&BEGINNING).chain(&force.sizes).copied().collect();
            all[index] += 1e-4 * sign * unit;
            let numbers = std::array::from_fn(|place| all[place]);
            pressed
                .shaken(&LuGre::from_array(numbers), [all[10], all[11]], (&all[12..], &shapes))
                .displacements
        };
        let both: Vec<(f64, f64)> = moved(1.0).into_iter().zip(moved(-1.0)).collect();
        let differences: Vec<f64> = both.iter().map(|(more, less)| (more - less) / 2e-4).collect();
        let largest = differences.iter().fold(0.0_f64, |most, at| most.max(at.abs()));
        for (row, difference) in differences.iter().enumerate() {
            let slope = found.gradients[row * count + index] * unit;
            assert!((slope - difference).abs() <= 1e-2 * largest, "{index} {row}: {slope} {difference}");
        }
    }
}

/// Mean over each block compared with the equation of the bristles, solved in short steps.
#[test]
fn the_force_after_a_reversal_is_that_of_the_bristles() {
    let lugre = LuGre::from_array(NUMBERS);
    let velocity = -0.002;
    let (steps, h) = (4000, 5e-6);
    let mut deflection = 9e-6;
    let settled = -lugre.curve.sliding_force(velocity) / lugre.bristle_stiffness;
    let mut forces = Vec::with_capacity(steps);
    for _ in 0..steps {
        // middle of each step, by the rate there
        let rate = lugre.bristle_rate(velocity, deflection);
        let middle = deflection + h / 2.0 * lugre.bristle_rate(velocity, deflection + h / 2.0 * rate);
        forces.push(lugre.force(velocity, middle));
        deflection += h * lugre.bristle_rate(velocity, middle);
    }
    // remainder of the initial force: of the spring and of the damper of the bristles
    let fraction = 1.0 - lugre.bristle_damping * velocity.abs() / lugre.curve.sliding_force(velocity);
    let left = lugre.bristle_stiffness * (9e-6 - settled) * fraction;
    let length = velocity.abs() * h;
    for block in 0..4 {
        let (from, to) = (block * 1000, (block + 1) * 1000);
        let mean = forces[from..to].iter().sum::<f64>() / 1000.0;
        let slid =
            SlidBlock { velocity, distance: (from + to) as f64 / 2.0 * length, half_length: 500.0 * length };
        let (force, gradient) = slid.sensitive_force(&lugre, left);
        assert!((force - mean).abs() < 1e-3, "{block}: {force} {mean}");
        for (index, number) in NUMBERS.iter().enumerate() {
            let changed = |by: f64| {
                let mut numbers = NUMBERS;
                numbers[index] = number * (1.0 + by);
                slid.force(&LuGre::from_array(numbers), left)
            };
            let difference = (changed(1e-6) - changed(-1e-6)) / (2e-6 * number);
            assert!((gradient[index] - difference).abs() <= 1e-6 * (difference.abs() + 1.0 / number));
        }
    }
}
