//! Published optima.

use phea_qft::loop_shaping::{Aim, DescentStatus};

use super::formula::{Formula, check_objective, descended};

/// Rosen and Suzuki; problem 43 of Hock and Schittkowski (1981).
#[test]
fn rosen_suzuki() {
    let objective = |x: &[f64]| {
        x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2] + x[3] * x[3] - 5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2]
            + 7.0 * x[3]
    };
    let margins = |x: &[f64]| {
        let squares = x.iter().map(|x| x * x).sum::<f64>();
        vec![
            8.0 - squares - x[0] + x[1] - x[2] + x[3],
            10.0 - squares - x[1] * x[1] - x[3] * x[3] + x[0] + x[3],
            5.0 - squares - x[0] * x[0] + x[3] * x[3] - 2.0 * x[0] + x[1] + x[3],
        ]
    };
    // ORIGIN: Hock and Schittkowski (1981), problem 43: x = (0, 1, 2, -1), f = -44, multipliers 1,
    // 0, 2
    let descent = check_objective(Formula::new(4, objective, margins), &[0.0; 4], -44.0);
    assert!(descent.x.iter().zip([0.0, 1.0, 2.0, -1.0]).all(|(x, expected)| (x - expected).abs() < 0.01));
    let strongest = [descent.binding[0], descent.binding[1]];
    assert_eq!(strongest.map(|binding| binding.sample), [2, 0]);
    assert!(
        strongest.iter().zip([2.0, 1.0]).all(|(found, expected)| (found.multiplier - expected).abs() < 0.01)
    );
}

#[test]
fn hock_schittkowski_71() {
    let objective = |x: &[f64]| x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
    let margins =
        |x: &[f64]| vec![x.iter().product::<f64>() - 25.0, 40.0 - x.iter().map(|x| x * x).sum::<f64>()];
    let mut problem = Formula::new(4, objective, margins);
    problem.bounds = vec![[1.0, 5.0]; 4];
    // ORIGIN: Hock and Schittkowski (1981), problem 71: f = 17.0140173
    check_objective(problem, &[1.0, 5.0, 5.0, 1.0], 17.0140173);
}

#[test]
fn hock_schittkowski_100() {
    let objective = |x: &[f64]| {
        (x[0] - 10.0).powi(2)
            + 5.0 * (x[1] - 12.0).powi(2)
            + x[2].powi(4)
            + 3.0 * (x[3] - 11.0).powi(2)
            + 10.0 * x[4].powi(6)
            + 7.0 * x[5] * x[5]
            + x[6].powi(4)
            - 4.0 * x[5] * x[6]
            - 10.0 * x[5]
            - 8.0 * x[6]
    };
    let margins = |x: &[f64]| {
        vec![
            127.0 - 2.0 * x[0] * x[0] - 3.0 * x[1].powi(4) - x[2] - 4.0 * x[3] * x[3] - 5.0 * x[4],
            282.0 - 7.0 * x[0] - 3.0 * x[1] - 10.0 * x[2] * x[2] - x[3] + x[4],
            196.0 - 23.0 * x[0] - x[1] * x[1] - 6.0 * x[5] * x[5] + 8.0 * x[6],
            -4.0 * x[0] * x[0] - x[1] * x[1] + 3.0 * x[0] * x[1] - 2.0 * x[2] * x[2] - 5.0 * x[5]
                + 11.0 * x[6],
        ]
    };
    // ORIGIN: Hock and Schittkowski (1981), problem 100: f = 680.6300573
    check_objective(Formula::new(7, objective, margins), &[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0], 680.6300573);
}

#[test]
fn hock_schittkowski_113() {
    let objective = |x: &[f64]| {
        x[0] * x[0] + x[1] * x[1] + x[0] * x[1] - 14.0 * x[0] - 16.0 * x[1]
            + (x[2] - 10.0).powi(2)
            + 4.0 * (x[3] - 5.0).powi(2)
            + (x[4] - 3.0).powi(2)
            + 2.0 * (x[5] - 1.0).powi(2)
            + 5.0 * x[6] * x[6]
            + 7.0 * (x[7] - 11.0).powi(2)
            + 2.0 * (x[8] - 10.0).powi(2)
            + (x[9] - 7.0).powi(2)
            + 45.0
    };
    let margins = |x: &[f64]| {
        vec![
            105.0 - 4.0 * x[0] - 5.0 * x[1] + 3.0 * x[6] - 9.0 * x[7],
            -10.0 * x[0] + 8.0 * x[1] + 17.0 * x[6] - 2.0 * x[7],
            8.0 * x[0] - 2.0 * x[1] - 5.0 * x[8] + 2.0 * x[9] + 12.0,
            120.0 - 3.0 * (x[0] - 2.0).powi(2) - 4.0 * (x[1] - 3.0).powi(2) - 2.0 * x[2] * x[2] + 7.0 * x[3],
            40.0 - 5.0 * x[0] * x[0] - 8.0 * x[1] - (x[2] - 6.0).powi(2) + 2.0 * x[3],
            30.0 - 0.5 * (x[0] - 8.0).powi(2) - 2.0 * (x[1] - 4.0).powi(2) - 3.0 * x[4] * x[4] + x[5],
            -x[0] * x[0] - 2.0 * (x[1] - 2.0).powi(2) + 2.0 * x[0] * x[1] - 14.0 * x[4] + 6.0 * x[5],
            3.0 * x[0] - 6.0 * x[1] - 12.0 * (x[8] - 8.0).powi(2) + 7.0 * x[9],
        ]
    };
    let start = [2.0, 3.0, 5.0, 5.0, 1.0, 2.0, 7.0, 3.0, 6.0, 10.0];
    // ORIGIN: Hock and Schittkowski (1981), problem 113: f = 24.3062091
    check_objective(Formula::new(10, objective, margins), &start, 24.3062091);
}

/// Charalambous and Bandler: the least of the greatest of three functions, at a kink between two
/// (the first) or three of them (the second).
#[test]
fn charalambous_bandler() {
    fn check(margins: fn(&[f64]) -> Vec<f64>, expected: f64) {
        let descent = descended(&mut Formula::new(2, |_| 0.0, margins), &[2.0, 2.0], Aim::WorstMargin);
        assert_eq!(descent.status, DescentStatus::Converged);
        let greatest = -descent.judgement.unwrap().worst_margin_db;
        assert!((greatest - expected).abs() < 1e-4, "{greatest} {expected}");
        assert!(descent.work.judgements < 30, "{:?}", descent.work);
    }
    // ORIGIN: paper, Charalambous and Bandler (1976): 1.9522245 and 2
    check(|x| three(x[0].powi(2) + x[1].powi(4), x), 1.9522245);
    check(|x| three(x[0].powi(4) + x[1].powi(2), x), 2.0);
}

fn three(first: f64, x: &[f64]) -> Vec<f64> {
    vec![-first, -(2.0 - x[0]).powi(2) - (2.0 - x[1]).powi(2), -2.0 * (x[1] - x[0]).exp()]
}
