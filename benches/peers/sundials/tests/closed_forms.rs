//! Tests of the safe interface to CVODE on problems with a known solution.

use sundials::{CvodeError, Method, integrate};

const METHODS: [Method; 3] = [Method::BackwardDifferentiation, Method::StabilityLimit, Method::Adams];

#[test]
fn a_stiff_linear_system_follows_its_eigenvectors() {
    // y = V exp(Λ t) V⁻¹ y₀ with eigenvalues -1 and -1e6 along (1, 1) and (1, -1).
    let (slow, fast) = (-1.0, -1e6);
    let mut rates = |_: f64, y: &[f64], dy: &mut [f64]| {
        let (sum, difference) = (slow * (y[0] + y[1]), fast * (y[0] - y[1]));
        dy.copy_from_slice(&[(sum + difference) / 2.0, (sum - difference) / 2.0]);
    };
    let times: Vec<f64> = (0..=20).map(|i| f64::from(i) * 0.1).collect();
    for method in [Method::BackwardDifferentiation, Method::StabilityLimit] {
        let states = integrate(&mut rates, &[2.0, 0.0], &times, 1e-9, &[1e-11; 2], method, &[]).unwrap();
        for (time, state) in times.iter().zip(&states).skip(1) {
            for value in state {
                assert!((value - (-time).exp()).abs() < 1e-7, "{method:?} {time} {value}");
            }
        }
    }
}

#[test]
fn a_rotation_preserves_its_radius() {
    let mut rates = |_: f64, y: &[f64], dy: &mut [f64]| dy.copy_from_slice(&[y[1], -y[0]]);
    for method in METHODS {
        let states =
            integrate(&mut rates, &[0.0, 1.0], &[0.0, 1.0, 10.0], 1e-10, &[1e-12; 2], method, &[]).unwrap();
        assert!((states[2][0] - 10.0f64.sin()).abs() < 1e-6, "{method:?}");
        assert!((states[2][0].hypot(states[2][1]) - 1.0).abs() < 1e-6, "{method:?}");
    }
}

#[test]
fn the_reaction_of_robertson_ends_where_it_is_known_to() {
    // ORIGIN: paper, Mazzia and Magherini (2008), test set for initial value problems, t = 1e11
    let expected = [0.2083340149701255e-7, 0.8333360770334713e-13, 0.999999979166505];
    let mut rates = |_: f64, y: &[f64], dy: &mut [f64]| {
        let (slow, back, quick) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        dy.copy_from_slice(&[back - slow, slow - back - quick, quick]);
    };
    let absolute = [1e-14, 1e-19, 1e-12];
    let start = [1.0, 0.0, 0.0];
    let method = Method::BackwardDifferentiation;
    let states = integrate(&mut rates, &start, &[0.0, 1e11], 1e-10, &absolute, method, &[]).unwrap();
    for (value, expected) in states[1].iter().zip(expected) {
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
    }
}

#[test]
fn rates_that_jump_at_a_stop_are_right_on_both_sides() {
    let mut earliest_after = f64::INFINITY;
    let mut rates = |time: f64, _: &[f64], dy: &mut [f64]| {
        if time >= 1.0 {
            earliest_after = earliest_after.min(time);
        }
        dy[0] = if time >= 1.0 { 1e3 } else { 0.0 };
    };
    for method in METHODS {
        let states = integrate(&mut rates, &[0.0], &[0.0, 1.0, 1.5], 1e-6, &[1e-6], method, &[1.0]).unwrap();
        assert_eq!(states[1][0], 0.0);
        assert!((states[2][0] - 500.0).abs() < 1e-9, "{method:?} {}", states[2][0]);
    }
    assert_eq!(earliest_after, 1.0);
}

#[test]
fn times_that_differ_by_a_rounding_are_one_time() {
    let mut rates = |_: f64, y: &[f64], dy: &mut [f64]| dy[0] = -y[0];
    let stop = 1.0f64.next_up();
    for times in [[0.0, 1.0, stop, 2.0], [0.0, 1.0, stop.next_up(), 2.0]] {
        let states =
            integrate(&mut rates, &[1.0], &times, 1e-9, &[1e-9], Method::Adams, &[1.0, stop]).unwrap();
        assert!((states[2][0] - states[1][0]).abs() < 1e-12 && (states[3][0] - (-2.0f64).exp()).abs() < 1e-7);
    }
}

#[test]
fn a_solution_that_ends_is_an_error_with_its_time() {
    // y' = y², y = 1/(1 - t).
    let mut rates = |_: f64, y: &[f64], dy: &mut [f64]| dy[0] = y[0] * y[0];
    for method in METHODS {
        match integrate(&mut rates, &[1.0], &[0.0, 2.0], 1e-8, &[1e-8], method, &[]) {
            Err(CvodeError::Failed { status, time }) => {
                assert!(status < 0 && (time - 1.0).abs() < 1e-3, "{time}")
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let mut rates = |_: f64, _: &[f64], dy: &mut [f64]| dy.fill(0.0);
    let mut refused = |start: &[f64], times: &[f64], relative: f64, absolute: &[f64]| {
        let answer = integrate(&mut rates, start, times, relative, absolute, Method::Adams, &[]);
        matches!(answer, Err(CvodeError::Argument(_)))
    };
    assert!(!refused(&[0.0], &[0.0, 1.0], 1e-6, &[1e-6]));
    assert!(refused(&[], &[0.0, 1.0], 1e-6, &[]));
    assert!(refused(&[0.0], &[], 1e-6, &[1e-6]));
    assert!(refused(&[0.0], &[0.0, 0.0], 1e-6, &[1e-6]));
    assert!(refused(&[0.0], &[0.0, f64::NAN], 1e-6, &[1e-6]));
    assert!(refused(&[0.0], &[0.0, 1.0], 0.0, &[1e-6]));
    assert!(refused(&[0.0], &[0.0, 1.0], 1e-6, &[1e-6, 1e-6]));
    assert!(refused(&[f64::INFINITY], &[0.0, 1.0], 1e-6, &[1e-6]));
}

#[test]
#[should_panic(expected = "of the caller")]
fn a_panic_passes_through() {
    let mut rates = |time: f64, _: &[f64], dy: &mut [f64]| {
        assert!(time < 0.5, "of the caller");
        dy[0] = 1.0;
    };
    let _ = integrate(&mut rates, &[0.0], &[0.0, 1.0], 1e-6, &[1e-6], Method::Adams, &[]);
}
