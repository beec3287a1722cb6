//! Factored transfer functions.
#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_workbench::design::factored;

fn text(gain: f64, zeros: &[[f64; 2]], poles: &[[f64; 2]]) -> String {
    let roots = |pairs: &[[f64; 2]]| pairs.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
    factored(&TransferFunction::from_factors(gain, roots(zeros), roots(poles)).unwrap(), 3)
}

#[test]
fn factors_read_as_they_are_written_by_hand() {
    assert_eq!(text(0.001, &[[-8.0, 0.0]], &[[0.0, 0.0]]), "0.001 (s + 8) / s");
    assert_eq!(
        text(1.0, &[[2.0, 0.0]], &[[0.0, 0.0], [-3.0, 4.0], [-3.0, -4.0]]),
        "(s - 2) / (s (s^2 + 6 s + 25))"
    );
    assert_eq!(text(-2.0, &[], &[]), "-2");
    assert_eq!(text(9.0, &[], &[[0.0, 3.0], [0.0, -3.0]]), "9 / (s^2 + 9)");
    let pole = TransferFunction::from_factors(0.5, vec![], vec![Complex64::new(0.9, 0.0)]).unwrap();
    let sampled = pole.in_domain(TimeDomain::Discrete { sample_time_s: 0.001 }).unwrap();
    assert_eq!(factored(&sampled, 2), "0.5 / (z - 0.9)");
}
