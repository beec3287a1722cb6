//! Requirements in time in the output of a design.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_qft::design::{DesignStatus, NamedStructure, StructureEnding};
use phea_workbench::design::{ProjectDesign, ReachedStructure};
use phea_workbench::simulate::{ReachedStep, RunStatus};
use phea_workbench::trial::{self, Agreement, HeldRequirement, Leg, StepSize, Trial, TrialFinding, TrialRun};

use super::design_printing::{PROJECT, object, view};

/// The drive with a required step, designed without changes.
fn with_step(timing: &str) -> ProjectDesign {
    let step = "[[specification]]\nkind = \"step\"\novershoot_percent = 5\nsettling_time = \"1.5 s\"\n";
    view(&format!("{}\n{step}", PROJECT.replace("TIMING\n", timing)), DesignStatus::Met).2
}

/// A structure that satisfies its limits is met if its steps are within the requirement, and one
/// that does not is missed, whatever its steps.
// ORIGIN: written by hand, within and beyond 5 % and 1.5 s
#[test]
fn a_structure_that_fails_by_its_steps_only_fails_in_time() {
    let mut view = with_step("");
    let structure =
        |ending: StructureEnding, [overshoot_percent, settling_time_s]: [f64; 2]| ReachedStructure {
            name: Some(NamedStructure::ProportionalIntegral),
            no_pid: None,
            structure: view.design.structure.clone(),
            order: 1,
            ending,
            is_chosen: false,
            least: None,
            binding: None,
            slowest_zero_rad_per_s: None,
            nominal: None,
            high_frequency_gain_db: None,
            relative_degree: 0,
            compared_db: None,
            steps: Some(ReachedStep { overshoot_percent, settling_time_s, rise_time_s: 9.0 }),
            misses_on_rig: false,
        };
    let met = StructureEnding::Met;
    view.structures = vec![
        structure(met, [4.9, 1.4]),
        structure(met, [5.1, 1.4]),
        structure(met, [4.9, 1.6]),
        structure(met, [4.9, f64::INFINITY]),
        structure(StructureEnding::Missed, [5.1, 1.6]),
        ReachedStructure { misses_on_rig: true, ..structure(met, [4.9, 1.4]) },
    ];
    let object = object(&view);
    let found: Vec<&str> =
        object["structures"].as_array().unwrap().iter().map(|one| one["status"].as_str().unwrap()).collect();
    let missed = "missed_in_time";
    assert_eq!(found, ["met", missed, missed, missed, "missed", missed]);
    assert_eq!(object["structures"][1]["worst_overshoot_percent"], 5.1);
}

/// A run of the nonlinear rig with one requirement for each of these verdicts.
fn run(view: &ProjectDesign, satisfied: &[bool]) -> TrialRun {
    let required = view.designed.view.in_time[0].requirement.step_limits;
    let reached = ReachedStep { overshoot_percent: 1.0, settling_time_s: 1.0, rise_time_s: 1.0 };
    let held = |is_satisfied: &bool| HeldRequirement {
        number: 3,
        step_limits: required,
        reached,
        reached_with_room: reached,
        is_satisfied: *is_satisfied,
    };
    TrialRun {
        machine_driven: trial::TrialMachine::Declared,
        size: StepSize::Required,
        plant: None,
        status: RunStatus::Completed,
        reference_n: [0.0, 1.0],
        linear: None,
        machine: None,
        legs: vec![],
        worst: Leg::There,
        remaining_amplitude_n: None,
        requirements: satisfied.iter().map(held).collect(),
        units: Default::default(),
        linear_response: Default::default(),
        machine_response: Default::default(),
        agreement: Agreement::Agrees,
        reason: TrialFinding::NeitherSettles { overshoots: None }.into(),
        quarter_wave_rad_per_s: None,
        met: vec![],
    }
}

/// A requirement that one run misses is missed by the design; a run without a requirement misses
/// nothing.
#[test]
fn a_design_misses_on_the_rig_where_a_run_does() {
    let view = with_step("");
    let is_missed = |runs: &[&[bool]]| {
        let runs = runs.iter().map(|satisfied| run(&view, satisfied)).collect();
        let trial = Trial { runs, corners: vec![], not_driven: vec![] };
        ProjectDesign { trial: Some(trial), ..view.clone() }.misses_on_rig()
    };
    assert!(!view.misses_on_rig());
    assert!(!is_missed(&[&[], &[]]));
    assert!(!is_missed(&[&[true], &[true, true], &[]]));
    assert!(is_missed(&[&[true], &[true, false], &[]]));
}
