//! What a diagnosis found, as sentences.
#![cfg(test)]

use num_complex::Complex64;
use phea_qft::design::{Constraint, ConstraintPlace, Finding, SharedLimit};
use phea_qft::verification::PlantPoint;
use phea_workbench::design::Explanation;

/// The sentences name frequencies, the specifications, and what it would take.
#[test]
fn findings_read_as_sentences() {
    let plant = PlantPoint::Parameters(vec![]);
    let sum = Finding::SumBelowOne {
        frequency_rad_per_s: 1.0,
        plant: plant.clone(),
        sensitivity: SharedLimit { specification: 0, limit: 0.3 },
        complementary: SharedLimit { specification: 1, limit: 0.5 },
        relaxation_db: 1.9382, // 20 lg 1.25
    };
    let name_of = |index: usize| format!("[[specification]] {}", index + 3);
    let text = Explanation::of(&sum, &name_of).sentence;
    assert!(
        text.contains("[[specification]] 3 and [[specification]] 4") && text.contains("1.938 dB"),
        "{text}"
    );
    let constraint = Constraint {
        place: ConstraintPlace::UnstablePole(Complex64::new(2.0, 0.0)),
        plant,
        dead_time_s: 0.0,
        sensitivity: 0.3,
        complementary: 0.5,
        crossover_rad_per_s: Some(2.236),
        specifications: vec![1],
    };
    let text =
        Explanation::of(&Finding::RightHalfPlane { constraint, relaxation_db: 6.0 }, &name_of).sentence;
    for part in ["unstable pole at 2 rad/s", "|T| = 1", "above 2.236 rad/s", "[[specification]] 4"] {
        assert!(text.contains(part), "{text}");
    }
}
