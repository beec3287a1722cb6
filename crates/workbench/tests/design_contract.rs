//! Input and answer of `design`: the section of the project, a controller that states only its
//! timing, and the keys that other programs read.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::{CONTRADICTORY, HOSE, answer, json, load, try_answer};
use phea_qft::design::{
    ControllerChoice, DesignOptions, DesignProblem, Objective, PrefilterChoice, diagnose,
};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_workbench::command::{CommandError, Request};
use phea_workbench::design::{Explanation, design_options, design_problem, explanation_sentence};
use phea_workbench::project;
use phea_workbench::robust::robust_problem;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

const TIMED: &str = include_str!("../../project/tests/valid/design.toml");
const DESIGN: Request = Request::Design { seed: None, stages: false, repair: false };

fn begun(project: &str, settings: &[&str], seed: Option<u32>) -> (DesignProblem, DesignOptions) {
    let project = load(project, settings, &[]).project;
    let given = robust_problem(&Memory::default(), &Setup::new(&project).unwrap()).unwrap();
    (
        design_problem(&Setup::new(&project).unwrap(), &given),
        design_options(&Setup::new(&project).unwrap(), &given, seed).unwrap(),
    )
}

#[test]
fn the_design_section_is_the_start_of_a_design() {
    let (problem, options) = begun(TIMED, &[], None);
    assert_eq!((problem.timing.sample_time_s, problem.timing.delay_s), (Some(0.001), 0.0005));
    assert_eq!(problem.minimum_delay_margin_s, 0.002);
    assert_eq!((options.objective, options.seed), (Objective::BestWorstMargin, 7));
    let ControllerChoice::Given(Structure { sign, gain, parts }) = &options.controller else {
        panic!("{options:?}")
    };
    assert_eq!((*sign, *gain, parts.len()), (-1.0, [0.1, 100.0], 6));
    // ORIGIN: analytic, 1 Hz
    let pair = [std::f64::consts::TAU, 100.0];
    assert!(
        matches!(&parts[2], StructureFactor::ZeroPair { natural_frequency, .. } if *natural_frequency == pair)
    );
    assert_eq!(parts[3], StructureFactor::RealPole { frequency: [10.0, 2000.0] });
    // around the design frequencies, 0.1 and 1 rad/s, if the project states nothing
    let StructureFactor::RealZero { frequency: [low, high] } = parts[1] else { panic!("{parts:?}") };
    assert!(low < 0.1 && high > 1.0, "{low} {high}");
    // a prefilter with a controller without a law is retained
    let PrefilterChoice::Given(prefilter) = &options.prefilter else { panic!("{options:?}") };
    assert_eq!((prefilter.gain(), prefilter.poles()[0].re), (0.1, 0.9));
    assert_eq!(begun(TIMED, &[], Some(3)).1.seed, 3);
}

#[test]
fn without_the_section_names_come_first_and_tracking_decides_on_a_prefilter() {
    let options = |settings: &[&str]| begun(HOSE, settings, None).1;
    let plain = options(&[]);
    assert_eq!(plain.objective, Objective::LeastHighFrequencyGain);
    let ControllerChoice::Any { maximum_order: 4, from: None, with_pure_gain: false, earned_per_pole_db } =
        plain.controller
    else {
        panic!("{:?}", plain.controller)
    };
    // ORIGIN: analytic, a factor of two
    assert!((earned_per_pole_db - 6.0206).abs() < 1e-4, "{earned_per_pole_db} dB");
    let free = options(&["design.structure=free"]).controller;
    assert_eq!(free, ControllerChoice::Grow { maximum_order: 4 });
    assert_eq!((plain.prefilter, plain.seed), (PrefilterChoice::Grow { maximum_order: 3 }, 1));
    let (head, tail) = HOSE.split_once("[[specification]]\nkind = \"tracking\"").unwrap();
    let untracked = format!("{head}[controller]{}", tail.split_once("[controller]").unwrap().1);
    // nothing requires the prefilter, and so nothing removes it
    let given = |text: &str| begun(text, &[], None).1.prefilter;
    assert!(matches!(given(&untracked), PrefilterChoice::Given(_)));
    let bare = untracked.split("[controller]").next().unwrap();
    assert_eq!(given(bare), PrefilterChoice::None);
    assert_eq!(
        given(&format!(
            "{}[design]\nprefilter_maximum_order = 0\n",
            HOSE.split("[controller]").next().unwrap()
        )),
        PrefilterChoice::None
    );
}

/// The default gain of a structure is around 1/|P0| at the design frequencies, with the sign
/// opposite to the plant's.
#[test]
fn the_gain_of_a_structure_is_wide_and_of_the_right_sign() {
    let text = |numerator: &str| {
        format!(
            "schema = 1\n[plant]\nnumerator = \"{numerator}\"\ndenominator = \"s + 1\"\n[[specification]]\n\
             kind = \"sensitivity\"\nlimit = 2\nfrequencies = [1]\n[design]\nstructure = [{{ kind = \"pole\" }}]\n"
        )
    };
    for (numerator, expected) in [("4", 1.0), ("-4", -1.0)] {
        let options = begun(&text(numerator), &[], None).1;
        let ControllerChoice::Given(Structure { sign, gain: [low, high], .. }) = options.controller else {
            panic!("{:?}", options.controller)
        };
        assert_eq!(sign, expected);
        // ORIGIN: analytic, |4/(j + 1)|
        let middle = 2.0_f64.sqrt() / 4.0;
        assert!(low < middle / 50.0 && high > middle * 50.0, "{low} {high}");
    }
}

#[test]
fn a_controller_may_state_its_timing_only() {
    let object = json(TIMED, &[], &[], &Request::Check);
    assert_eq!(object["command"], "check");
    let refused =
        try_answer(TIMED, &[], &[], &Request::Verify { proof: false, on_machine: false }).unwrap_err();
    assert!(matches!(refused, CommandError::Refused(_)), "{refused}");
    assert!(refused.to_string().contains("[controller] states only when it acts"), "{refused}");
    assert!(refused.to_string().contains("phea design"), "{refused}");
}

#[test]
fn nothing_is_designed_for_no_specification() {
    let bare = include_str!("../../project/tests/valid/design_growing.toml");
    let refused = try_answer(bare, &[], &[], &DESIGN).unwrap_err();
    assert!(matches!(refused, CommandError::Refused(_)), "{refused}");
    assert!(refused.to_string().contains("states no [[specification]]"), "{refused}");
}

/// An integrator of unknown gain at 100 Hz, with converters.
const CONVERTED: &str = "schema = 1\n[plant]\nnumerator = \"k\"\ndenominator = \"s + 1\"\n\
    [uncertainty]\nk = { nominal = 1, minimum = 1, maximum = 2, points = 3 }\n\
    [[specification]]\nkind = \"robust_stability\"\nlimit = 1.3\nfrequencies = [0.1, 1, 10, 100, 1000]\nband = [0, inf]\n\
    [[specification]]\nkind = \"sensitivity\"\nlimit = \"2*s/(s + 3)\"\nfrequencies = [0.1, 1]\n\
    [controller]\nsample_time = \"10 ms\"\nnumerator = \"12*s + 60\"\ndenominator = \"s\"\n\
    [controller.quantization]\nmeasurement_bits = 9\nmeasurement_range = [-4, 4]\ncommand_bits = 9\ncommand_range = [-4, 4]\n\
    [design]\nobjective = \"best_worst_margin\"\nprefilter_maximum_order = 0\ngain = [1, 300]\n\
    structure = [{ kind = \"integrator\" }, { kind = \"zero\", frequency = [0.1, 100] }]\n";

/// Allowed errors of the converters are two further specifications, for `verify` and for `design`,
/// with their own words. The smaller the allowed errors, the lower the gain of the controller.
#[test]
fn allowed_errors_of_the_converters_are_specifications() {
    let verified = |settings: &[&str]| {
        json(CONVERTED, settings, &[], &Request::Verify { proof: false, on_machine: false })
    };
    assert_eq!(verified(&[])["specifications"].as_array().unwrap().len(), 2);
    let force = "controller.quantization.allowed_force_error=\"1 mN\"";
    let command = "controller.quantization.allowed_command_error=0.25";
    let both = verified(&[force, command]);
    let rows = both["specifications"].as_array().unwrap();
    let summary =
        |row: &serde_json::Value| (row["kind"].clone(), row["name"].clone(), row["verdict"].clone());
    assert!(rows[0]["name"].is_null());
    // |P/(1+L)| of up to 1/14 turns half a step of 1/64 into 0.56 mN at most
    let names = ["force error of the rounded command", "command error of the rounded measurement"];
    assert_eq!(summary(&rows[2]), ("plant_input_disturbance".into(), names[0].into(), "met".into()));
    assert_eq!(summary(&rows[3]), ("control_effort".into(), names[1].into(), "met".into()));
    // ORIGIN: analytic, the limits are the allowed errors divided by half of 8/512; towards
    // infinite frequency, pi/T, |G S| is a little above 12
    assert_eq!(rows[2]["reached"]["limit"], 0.128);
    assert_eq!(rows[3]["reached"]["limit"], 32.0);
    // the frequencies at which bounds are drawn and that are below pi/T
    assert_eq!(rows[2]["at_design_frequencies"].as_array().unwrap().len(), 4);
    let tight = verified(&[force, "controller.quantization.allowed_command_error=0.05"]);
    assert_eq!(tight["specifications"][3]["verdict"], "violated");
    assert_eq!(tight["verdict"], "violated");
    let mut last = f64::INFINITY;
    for allowed in ["0.5", "0.055"] {
        let setting = format!("controller.quantization.allowed_command_error={allowed}");
        let design = json(CONVERTED, &[&setting], &[], &DESIGN);
        assert_eq!(design["status"], "met");
        let gain = design["figures"]["high_frequency_gain_db"].as_f64().unwrap();
        assert!(gain < last - 1.0, "{gain} dB after {last} dB");
        last = gain;
        if allowed == "0.055" {
            let binds =
                |row: &serde_json::Value| row["specification"] == 3 && row["kind"] == "control_effort";
            assert!(design["binding"].as_array().unwrap().iter().any(binds), "{}", design["binding"]);
            assert!(design["rounding"]["effects"][2]["rms"].as_f64().unwrap() < 0.055);
        }
    }
    let text = answer(CONVERTED, &[command], &[], &Request::Verify { proof: false, on_machine: false }).text;
    assert!(text.contains("\n  command error of the rounded measurement is"), "{text}");
}

/// The law in an answer is the one with the coefficients stored in the computer, and its
/// verification is that law's.
#[test]
fn the_answer_is_the_deployed_controller() {
    let single = json(CONVERTED, &["controller.quantization.coefficients=\"f32\""], &[], &DESIGN);
    assert_eq!(single["status"], "met");
    assert_eq!(single["controller"]["domain"], "z");
    assert_eq!(single["continuous_law"]["controller"]["domain"], "s");
    // k (s/z + 1)/s by Tustin's rule: one section, whose first coefficient is the gain
    let gain = single["controller"]["gain"].as_f64().unwrap();
    assert_eq!(gain, f64::from(gain as f32));
    let exact = json(CONVERTED, &[], &[], &DESIGN)["controller"]["gain"].as_f64().unwrap();
    assert_ne!(exact, f64::from(exact as f32));
}

#[test]
fn two_limits_that_no_loop_satisfies_together_are_explained() {
    let source = Memory::default().with("mistake.toml", CONTRADICTORY);
    let project = project::read(&source, "mistake.toml", &[], &[]).unwrap().project;
    let given = robust_problem(&source, &Setup::new(&project).unwrap()).unwrap();
    let findings = diagnose(&design_problem(&Setup::new(&project).unwrap(), &given));
    let found: Vec<Explanation> = findings.iter().map(|one| Explanation::of(one, &given)).collect();
    let impossible = found.iter().find(|one| one.is_impossible && one.specifications == [0, 1]).unwrap();
    // limits |S| <= w/|jw + 30| up to 10 rad/s and |T| <= 5/|jw + 5| from 8 rad/s: only there do
    // both apply
    assert!((8.0..=10.0).contains(&impossible.frequency_rad_per_s.unwrap()), "{impossible:?}");
    assert!(impossible.relaxation_db.unwrap() > 0.0 && explanation_sentence(impossible).contains("rad/s"));
    assert!(!impossible.plants.is_empty());
    assert!(found.is_sorted_by_key(|one| !one.is_impossible));
}
