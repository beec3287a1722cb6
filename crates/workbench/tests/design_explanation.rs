//! Sentences on the findings of a diagnosis.
#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::run_command::answer;
use num_complex::Complex64;
use phea_qft::design::{Constraint, ConstraintPlace, Finding, SharedLimit};
use phea_qft::specification::ClosedLoop;
use phea_qft::verification::PlantPoint;
use phea_workbench::command::Request;
use phea_workbench::design::explanation_sentence;
use phea_workbench::engineering::design::{ExplainedFact, ExplainedLimit, Explanation};
use phea_workbench::engineering::specification::{NamedSpecification, SpecificationName};

/// The sentence of a finding on limits of the sensitivity, numbered from 3.
fn sentence(finding: Finding) -> String {
    let name = |index: &usize| {
        let name = SpecificationName::ClosedLoop(ClosedLoop::Sensitivity);
        ExplainedLimit::Specification(NamedSpecification { number: Some(index + 3), name })
    };
    let specifications = finding.specifications();
    explanation_sentence(&Explanation {
        limits: specifications.iter().map(|index| (*index, name(index))).collect(),
        fact: ExplainedFact::Finding(finding),
        is_impossible: true,
        frequency_rad_per_s: None,
        plants: vec![],
        specifications,
        relaxation_db: None,
    })
}

/// The sentences name frequencies, the specifications, and the change that would be necessary.
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
    let text = sentence(sum);
    assert!(
        text.contains("[[specification]] 3 (sensitivity) and [[specification]] 4 (sensitivity)")
            && text.contains("1.938 dB"),
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
    let text = sentence(Finding::RightHalfPlane { constraint, relaxation_db: 6.0 });
    for part in ["unstable pole at 2 rad/s", "|T| = 1", "above 2.236 rad/s", "[[specification]] 4"] {
        assert!(text.contains(part), "{text}");
    }
}

/// A double pole at 1 rad/s, which under a pure integrator is not stable at any gain.
const UNSTABLE: &str = r#"schema = 1
title = "unstable"
[plant]
numerator = "k"
denominator = "s^2 - 2*s + 1"
[uncertainty]
k = { nominal = 2, minimum = 1, maximum = 4, points = 3 }
[design]
structure = [{ kind = "integrator" }]
[[specification]]
kind = "robust_stability"
limit = 1.3
frequencies = [0.1, 1, 10]
"#;

/// A controller that leaves a plant unstable is not printed for use, and its file begins with the
/// reason; a later design of that project removes the words.
#[test]
fn a_controller_that_is_not_stable_is_not_to_be_used() {
    let design = Request::Design { seed: None, stages: false, repair: false };
    let of = |text: &str| {
        let output = answer(text, &[], &[], &design);
        let file = output.files.iter().find(|file| file.name == "designed.toml").unwrap();
        (output.text().clone(), String::from_utf8(file.bytes.clone()).unwrap())
    };
    let (words, file) = of(UNSTABLE);
    let why = "it does not make every plant of the family stable";
    assert!(words.contains(&format!("Do not use this controller: {why}")), "{words}");
    assert!(!words.contains("In the project, in place of"), "{words}");
    let first = format!("# DO NOT USE THIS CONTROLLER: {why}.\nschema = 1\n");
    assert!(file.starts_with(&first), "{file}");
    let (_, again) = of(&file);
    assert_eq!(again.matches("DO NOT USE").count(), 1, "{again}");
    let stable = file.replace("s^2 - 2*s + 1", "s + 1").replace("limit = 1.3", "limit = 2");
    let (words, file) = of(&stable);
    assert!(words.contains("In the project, in place of [controller]"), "{words}");
    assert!(file.starts_with("schema = 1\n"), "{file}");
}
