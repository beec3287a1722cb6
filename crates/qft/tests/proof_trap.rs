//! A controller that appears better on a grid of plants and frequencies than it is.
#![cfg(test)]

use phea_dynamics::controller::Timing;
use phea_dynamics::portable;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::Family;
use phea_qft::proof::{ClaimStatus, check};

use crate::proof::thesis_in;
use crate::verification::plants::{compensation, rational};
use crate::verification::thesis::thesis_family;

const LIMIT: f64 = 1.3;

/// Proportional and integral action with a second-order roll-off, which resonates between the
/// frequencies of the grid.
fn law() -> Compensation {
    let [gain, zero, natural_frequency, damping_ratio]: [f64; 4] = [9.6e-5, 2.0, 56.0, 0.18];
    let square = natural_frequency * natural_frequency;
    let law = rational(
        &[gain * square, gain * zero * square],
        &[1.0, 2.0 * damping_ratio * natural_frequency, square, 0.0],
    );
    compensation(law, rational(&[1.0], &[1.0]), Timing::default())
}

/// Magnitude |L/(1 + L)| of all 3^6 plants of the grid, which stays below 1.3 at a hundred
/// frequencies from 0.01 to 10,000 rad/s, so that the loop seems correct. The proof refutes it with
/// a plant and a frequency where the limit is exceeded by more than 1.5 dB.
#[test]
fn an_optimistic_grid_verdict_is_refuted() {
    let loop_ = law();
    let Family::Uncertain(family) = thesis_family([3; 6]) else { panic!("a box") };
    let mut greatest = 0.0_f64;
    for index in 0..100 {
        let frequency = portable::pow(10.0, -2.0 + 6.0 * f64::from(index) / 99.0);
        let controller = loop_.response(frequency).feedback;
        for values in family.members() {
            let plant = loop_.response_of(family.plant(), values, frequency).unwrap().plant;
            let product = plant * controller;
            greatest = greatest.max(portable::magnitude(product / (1.0 + product)));
        }
    }
    assert!((1.2..LIMIT).contains(&greatest), "{greatest}");
    let proof = thesis_in(&loop_);
    assert_eq!(proof.stability, ClaimStatus::Proven);
    assert_eq!(proof.specifications[0].claim_status, ClaimStatus::Refuted);
    assert!(proof.specifications[0].least_db.unwrap() > 1.5, "{:?}", proof.specifications[0]);
    assert_eq!(check(&proof.certificate.unwrap()), Ok(()));
}
