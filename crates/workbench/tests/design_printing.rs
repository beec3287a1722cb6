//! Output of a design, however it was found: here, a design made by hand.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element};
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::quantization::{CoefficientFormat, rounded};
use phea_qft::design::{
    ControllerChoice, Design, DesignProblem, DesignRound, DesignStatus, PrefilterChoice, Relaxation,
};
use phea_qft::loop_shaping::{Structure, StructureFactor};
use phea_qft::verification::{AuditProblem, PlantPoint, SpecificationMargin, TrackingJudgement, Verdict};
use phea_workbench::audit::audit_project;
use phea_workbench::command::{Request, answer};
use phea_workbench::design::{
    AuditedController, DESIGNED_PROJECT, DesignPart, LedBy, ProjectDesign, design_options, design_problem,
    files, output, printed, stage_files,
};
use phea_workbench::project::{
    self, DeclaredQuantization, FeedForward, Loaded, Prefilter, RationalFunction, Transfer,
};
use phea_workbench::quantity::MotionKind;
use phea_workbench::robust::DEFAULT_TOLERANCE_DB;
use phea_workbench::robust::robust_problem;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

/// Plant k/(s (s + 10)) with two specifications and a law that is too slow for the second.
pub(super) const PROJECT: &str = "schema = 1\ntitle = \"drive\"\n\n[plant]\nnumerator = \"k\"\ndenominator = \"s*(s + 10)\"\n\n\
    [uncertainty]\nk = { nominal = 10, minimum = 10, maximum = 20, points = 2 }\n\n\
    [[specification]]\nkind = \"robust_stability\"\nlimit = 1.3\nfrequencies = [1, 10]\nband = [0, inf]\n\n\
    [[specification]]\nkind = \"tracking\"\nfrequencies = [0.1, 1]\nupper = 1.2\nlower = \"4/(s + 4)\"\n\n\
    [design]\nstructure = \"free\"\n\n\
    [controller]        # by hand\nnumerator = \"1\"  # slow\ndenominator = \"1\"\nsaturation = \"10 V\"\nTIMING\n\
    [prefilter]\nnumerator = \"1\"\ndenominator = \"1\"\n";

fn text(loaded: &Loaded, view: &ProjectDesign) -> String {
    output(loaded, view).unwrap().text()
}

pub(super) fn object(view: &ProjectDesign) -> serde_json::Value {
    serde_json::from_str(&printed(view, MotionKind::Linear).unwrap()).unwrap()
}

fn loaded(text: &str) -> (Memory, Loaded) {
    let source = Memory::default().with("drive.toml", text);
    let loaded = project::read(&source, "drive.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    (source, loaded)
}

/// The law 5 (s/50 + 1)/(s/500 + 1) and a prefilter of first order, as if a search had found them
/// for coefficients in this format.
fn design(problem: &DesignProblem, coefficients: CoefficientFormat, status: DesignStatus) -> Design {
    let lead = Element::LeadLag { zero_frequency: 50.0, pole_frequency: 500.0 };
    let law = Controller {
        feedback: Compensator::new(vec![Element::Gain(5.0), lead]),
        prefilter: Compensator::new(vec![Element::RealPole { frequency: 6.0 }]),
        timing: problem.timing,
        ..Controller::default()
    };
    let controller = match coefficients {
        CoefficientFormat::Double => law.clone(),
        format => rounded(&law, format).unwrap().controller,
    };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let problem = AuditProblem {
        family: &problem.family,
        compensation: &compensation,
        specifications: &problem.specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: DEFAULT_TOLERANCE_DB,
    };
    let structure = Structure {
        sign: 1.0,
        gain: [0.1, 100.0],
        parts: vec![
            StructureFactor::RealZero { frequency: [1.0, 100.0] },
            StructureFactor::RealPole { frequency: [10.0, 1000.0] },
        ],
    };
    let plant = PlantPoint::Parameters(vec![20.0]);
    Design {
        status,
        law,
        controller,
        name: None,
        prefilter: None,
        free_numbers: vec![],
        structure: structure.clone(),
        starts: None,
        objective_db: 34.0,
        additional_audits: vec![],
        audit: audit(&problem, &mut unwatched).unwrap(),
        binding: vec![margin(1, 1.0, 0.0, plant)],
        rounds: vec![DesignRound {
            structure,
            objective_db: 34.0,
            plants: 4,
            frequencies: 20,
            searched_margin_db: 0.0,
            audited_margin_db: None,
        }],
    }
}

pub(super) fn view(text: &str, status: DesignStatus) -> (Memory, Loaded, ProjectDesign) {
    let (source, loaded) = loaded(text);
    let given = robust_problem(&source, &Setup::new(&loaded.project).unwrap()).unwrap();
    let setup = Setup::new(&loaded.project).unwrap();
    let law = setup.controller.clone().unwrap();
    let audit = audit_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap();
    let published = AuditedController::new(law, given.clone(), audit).unwrap();
    let problem = design_problem(&Setup::new(&loaded.project).unwrap(), &given);
    let options = design_options(&Setup::new(&loaded.project).unwrap(), &given, Some(7)).unwrap();
    assert_eq!(options.controller, ControllerChoice::Grow { maximum_order: 4 });
    assert_eq!(options.prefilter, PrefilterChoice::Grow { maximum_order: 3 });
    let design = design(&problem, options.coefficients, status);
    let view = ProjectDesign::new(&setup, &given, &problem, design, options, &mut |_| true).unwrap();
    (source, loaded, ProjectDesign { published: Some(Box::new(published)), ..view })
}

fn infeasible() -> DesignStatus {
    let plant = PlantPoint::Parameters(vec![10.0]);
    let conflicts = vec![margin(0, 10.0, -1.25, plant)];
    DesignStatus::Infeasible(Relaxation { relaxation_db: 1.25, conflicts })
}

fn margin(
    specification: usize,
    frequency_rad_per_s: f64,
    margin_db: f64,
    plant: PlantPoint,
) -> SpecificationMargin {
    SpecificationMargin { specification, frequency_rad_per_s, margin_db, plant, other: None }
}

#[test]
fn the_text_begins_with_the_status_and_contains_the_law_to_paste() {
    let (_, loaded, view) = view(&PROJECT.replace("TIMING\n", ""), infeasible());
    let text = text(&loaded, &view);
    assert!(
        text.starts_with("Design: infeasible: none of the controllers tried, of order 4 at most, "),
        "{text}"
    );
    for words in [
        "with every limit 1.25 dB wider one does",
        "G(s) = 50 (s + 50) / (s + 500)",
        "F(s) = 6 / (s + 6)",
        "[controller]\ngain = 50\nzeros = [-50]\npoles = [-500]\nsaturation = \"10 V\"\n",
        "[prefilter]\ngain = 6\npoles = [-6]\n",
        "given        designed",
        "started from random points (seed 7); a local optimum: other seeds may need less relaxation",
        "1 robust stability  10     -1.25 dB  10",
        "zero, pole",
    ] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
}

#[test]
fn the_json_keys_are_stable() {
    let (_, loaded, view) = view(&PROJECT.replace("TIMING\n", ""), infeasible());
    let object = object(&view);
    assert_eq!(object["status"], "infeasible");
    assert_eq!(object["relaxation_db"], 1.25);
    assert_eq!(object["conflicts"][0]["plant"]["k"], 10.0);
    assert_eq!(object["binding"][0]["kind"], "tracking");
    assert_eq!(object["controller"]["zeros"], serde_json::json!([[-50.0, 0.0]]));
    assert_eq!(
        (object["controller"]["domain"].as_str(), object["controller"]["gain"].as_f64()),
        (Some("s"), Some(50.0))
    );
    assert_eq!(object["prefilter"]["poles"], serde_json::json!([[-6.0, 0.0]]));
    assert_eq!(object["structure"]["parts"][1]["frequency_rad_per_s"], serde_json::json!([10.0, 1000.0]));
    assert_eq!(object["seed"], 7);
    // the object that `verify` prints, in addition to the common keys
    let designed = String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap();
    let (source, loaded) = self::loaded(&designed);
    let verified =
        answer(&source, &loaded, &[], &Request::Verify { proof: false, on_machine: false }).unwrap().json;
    let verified: serde_json::Value = parsed(&verified);
    for (key, value) in object["verification"].as_object().unwrap() {
        assert_eq!(*value, verified[key], "{key}");
    }
    assert!(object["published"]["verification"]["verdict"].is_string());
}

/// The written project contains the designed controller, and everything else unchanged.
#[test]
fn a_sampled_design_is_written_as_found_and_printed_as_deployed() {
    let timing = "sample_time = \"2 ms\"\ndelay = \"1 ms\"\ndiscretization = \"matched\"\n";
    let (_, loaded, view) = view(&PROJECT.replace("TIMING\n", timing), DesignStatus::Met);
    let object = object(&view);
    assert_eq!(
        (object["controller"]["domain"].as_str(), object["controller"]["sample_time_s"].as_f64()),
        (Some("z"), Some(0.002))
    );
    assert_eq!(object["continuous_law"]["controller"]["poles"], serde_json::json!([[-500.0, 0.0]]));
    let pole = object["controller"]["poles"][0][0].as_f64().unwrap();
    // ORIGIN: analytic, exp(-500 0.002)
    assert!((pole - 0.367_879_441_171_442_3).abs() < 1e-12, "{pole}");
    let text = text(&loaded, &view);
    assert!(
        text.contains("G(s) = ") && text.contains("G(z) = ") && text.contains("sampled every 2.00 ms"),
        "{text}"
    );
    let written = String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap();
    let expected = PROJECT
        .replace(
            "numerator = \"1\"  # slow\ndenominator = \"1\"\nsaturation",
            "gain = 50\nzeros = [-50]\npoles = [-500]\nsaturation",
        )
        .replace(
            "[prefilter]\nnumerator = \"1\"\ndenominator = \"1\"\n",
            "[prefilter]\ngain = 6\npoles = [-6]\n",
        )
        .replace("[controller]        # by hand", "[controller]")
        .replace("TIMING\n", timing);
    assert_eq!(written, expected);
}

/// Keys of the prefilter in addition to its law apply to the designed one too, in the file and in
/// the printed tables.
#[test]
fn a_prefilter_that_acts_between_samples_remains_continuous() {
    let sampled = PROJECT.replace("TIMING\n", "sample_time = \"2 ms\"\n");
    for (beside, is_continuous) in [("continuous = true\n", true), ("", false)] {
        let (_, loaded, view) = view(&format!("{sampled}{beside}"), DesignStatus::Met);
        let law = format!("[prefilter]\ngain = 6\npoles = [-6]\n{beside}");
        let written = String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap();
        assert!(written.ends_with(&law) && text(&loaded, &view).contains(&law), "{written}");
        assert_eq!(self::loaded(&written).1.project.prefilter.unwrap().continuous, is_continuous);
    }
}

#[test]
fn every_stage_is_a_file() {
    let (_, loaded, mut view) = view(&PROJECT.replace("TIMING\n", ""), DesignStatus::Met);
    let names = |files: Vec<phea_workbench::answer::OutputFile>| {
        files.into_iter().map(|file| file.name).collect::<Vec<_>>()
    };
    let files = stage_files(&loaded, &mut view, &mut |_| true).unwrap();
    let content = |name: &str| {
        let file = files.iter().find(|file| file.name == name).unwrap_or_else(|| panic!("no {name}"));
        String::from_utf8(file.bytes.clone()).unwrap()
    };
    for name in
        ["bounds.csv", "templates.csv", "margins.csv", "rounds.csv", "verification.json", DESIGNED_PROJECT]
    {
        assert!(content(name).lines().count() > 1, "{name}");
    }
    // |L| of the nominal plant at 1 rad/s: ORIGIN: analytic, 5 10 |1 + j/50| / (|10 + j| |1 + j/500|)
    let looped = content("loop.csv");
    let row: Vec<&str> = looped.lines().find(|line| line.starts_with("1,")).unwrap().split(',').collect();
    let expected = decibels(50.0 * 1.0004_f64.sqrt() / 101.0_f64.sqrt() / 1.000_004_f64.sqrt());
    assert!((row[1].parse::<f64>().unwrap() - expected).abs() < 1e-9, "{row:?}");
    assert!(["true", "false"].contains(&row[3]), "{row:?}");
    // the distances above and below the band add up to the band less the spread
    for line in content("prefilter_band.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((row[6] + row[7] - ((row[5] - row[2]) - (row[4] - row[3]))).abs() < 1e-9, "{line}");
        assert!((0.1..=1.0).contains(&row[1]));
    }
    assert_eq!(view.designed.view.audit.verdict == Verdict::Met, view.is_met());
    view.leave(DesignPart::Search);
    let left = names(stage_files(&loaded, &mut view, &mut |_| false).unwrap());
    assert!(!left.contains(&"bounds.csv".to_string()) && left.contains(&"loop.csv".to_string()), "{left:?}");
    assert!(text(&loaded, &view).starts_with("Design: stopped: this is the best controller found so far"));
}

/// A published law of elements is the product of those that act, and all of them are replaced by
/// the designed one.
#[test]
fn elements_are_a_published_law() {
    let elements = "elements = [\n  { kind = \"gain\", value = 3 },  # loud\n  { kind = \"pi\", proportional_gain = 2, integral_gain = 4 },\n  \
        { kind = \"pid\", proportional_gain = 1, integral_gain = 2, derivative_gain = 3, filter_time = \"0.1 s\" },\n  \
        { kind = \"lead\", zero_frequency = 1, pole_frequency = 9, enabled = false },\n  { kind = \"lag\", zero_frequency = 9, pole_frequency = 1 },\n  \
        { kind = \"roll_off\", frequency = 40, damping_ratio = 0.5 },\n  { kind = \"general\", numerator = \"s + 5\", denominator = \"s + 7\" },\n]\n";
    let polynomials = "numerator = \"1\"  # slow\ndenominator = \"1\"\nsaturation";
    let text = PROJECT.replace("TIMING\n", "").replace(polynomials, &format!("{elements}saturation"));
    let (_, loaded, view) = view(&text, DesignStatus::Met);
    let law = view.published.as_ref().unwrap().controller.feedback.transfer_function().unwrap();
    let s = Complex64::new(0.0, 6.0);
    let pid = 1.0 + 2.0 / s + 3.0 * s / (0.1 * s + 1.0);
    let lag = (s / 9.0 + 1.0) / (s + 1.0);
    let expected =
        3.0 * (2.0 + 4.0 / s) * pid * lag * 1600.0 / (s * s + 40.0 * s + 1600.0) * (s + 5.0) / (s + 7.0);
    let found = law.at_frequency(6.0);
    assert!((found - expected).norm_sqr() < 1e-20 * expected.norm_sqr(), "{found} {expected}");
    let written = String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap();
    assert_eq!(
        written,
        text.replace("[controller]        # by hand", "[controller]")
            .replace(elements, "gain = 50\nzeros = [-50]\npoles = [-500]\n")
            .replace(
                "[prefilter]\nnumerator = \"1\"\ndenominator = \"1\"\n",
                "[prefilter]\ngain = 6\npoles = [-6]\n",
            )
    );
}

/// Rounded controllers are audited, here and by `verify`.
#[test]
fn rounding_of_the_computer_is_part_of_the_design() {
    let timing = "sample_time = \"2 ms\"\nquantization = { command_bits = 12, command_range = [-10, 10], coefficients = \"f32\" }\n";
    let (_, loaded, view) = view(&PROJECT.replace("TIMING\n", timing), DesignStatus::Met);
    let object = object(&view);
    let pole = object["controller"]["poles"][0][0].as_f64().unwrap();
    assert_eq!(pole, f64::from(pole as f32));
    let effect = &object["rounding"]["effects"][0];
    assert_eq!((effect["of"].as_str(), effect["on"].as_str()), (Some("command"), Some("output")));
    // rounding has at least its effect at rest: half a step of 20 V/4096 through 1/G(z = 1), where
    // the plant integrates ORIGIN: analytic, 20/4096/2/5
    assert!(effect["peak"].as_f64().unwrap() >= 0.999 * 20.0 / 4096.0 / 2.0 / 5.0, "{effect}");
    assert!(effect["peak_plant"]["k"].is_number());
    assert!(text(&loaded, &view).contains("the rounded command moves the output by "));
    let designed = String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap();
    let (source, loaded) = self::loaded(&designed);
    let verified =
        answer(&source, &loaded, &[], &Request::Verify { proof: false, on_machine: false }).unwrap().json;
    let verified: serde_json::Value = parsed(&verified);
    assert_eq!(object["verification"]["specifications"], verified["specifications"]);
}

#[test]
fn a_setting_in_addition_to_the_law_is_written_with_it() {
    let (_, mut loaded, mut view) = view(&PROJECT.replace("TIMING\n", ""), DesignStatus::Met);
    let text = "[controller]\ngain = 1\n[controller.quantization]\ncommand_bits = 8\n[prefilter]\ngain = 1\n";
    let transfer = Transfer {
        ratio: RationalFunction { gain: Some(2.0), ..RationalFunction::default() },
        ..Transfer::default()
    };
    view.declared_controller = project::DeclaredController {
        transfer: transfer.clone(),
        sample_time: Some(1e-3),
        quantization: Some(DeclaredQuantization { command_bits: 12, ..DeclaredQuantization::default() }),
        load_velocity_feed_forward: Some(FeedForward { gain: Some(3.0) }),
        ..project::DeclaredController::default()
    };
    view.declared_prefilter = Some(Prefilter { transfer, continuous: true, ..Prefilter::default() });
    loaded.bytes = text.as_bytes().to_vec();
    let mut written = |settings: &[&str]| {
        loaded.settings = settings.iter().map(|setting| setting.to_string()).collect();
        String::from_utf8(files(&loaded, &view).remove(0).bytes).unwrap()
    };
    // the text without a setting states it already
    assert_eq!(written(&[]), text.replace("gain = 1", "gain = 2"));
    let set = written(&["controller.sample_time=1e-3", "prefilter.continuous=true"]);
    for line in
        ["sample_time = ", "quantization = { command_bits = 12", "load_velocity_feed_forward = { gain = 3 }"]
    {
        assert_eq!(set.matches(line).count(), 1, "{line} in\n{set}");
    }
    assert!(set.ends_with("[prefilter]\ngain = 2\ncontinuous = true\n"), "{set}");
    assert!(!set.contains("command_bits = 8") && !set.contains("[controller.quantization]"), "{set}");
    let pasted = self::text(&loaded, &view);
    assert!(pasted.contains("load_velocity_feed_forward = {"), "{pasted}");
    assert!(pasted.contains("[prefilter]\ngain = 2\ncontinuous = true\n\n"), "{pasted}");
}

/// The law 5 (s/50 + 1)/(s/500 + 1) tends to 50, sampled or not.
// ORIGIN: analytic
#[test]
fn the_high_frequency_gain_of_a_sampled_loop_is_that_of_the_continuous_law() {
    for (timing, words) in
        [("", "33.979 dB"), ("sample_time = \"2 ms\"\n", "33.979 dB, of the continuous law")]
    {
        let (_, loaded, view) = view(&PROJECT.replace("TIMING\n", timing), DesignStatus::Met);
        let object = object(&view);
        let figures = &object["figures"];
        assert!((figures["high_frequency_gain_db"].as_f64().unwrap() - decibels(50.0)).abs() < 1e-9);
        assert_eq!(figures["high_frequency_gain_of"], "continuous_law");
        let text = text(&loaded, &view);
        assert!(
            text.contains(words) && text.contains("of the continuous law") != timing.is_empty(),
            "{text}"
        );
    }
}

/// A loop that touches no limit over frequency had another objective, which is named.
#[test]
fn the_leading_objective_is_named_if_no_limit_is_touched() {
    let (_, loaded, mut view) = view(&PROJECT.replace("TIMING\n", ""), DesignStatus::Met);
    view.design.binding.clear();
    let touches = |led_by: LedBy| text(&loaded, &ProjectDesign { led_by, ..view.clone() });
    assert!(!touches(LedBy::Frequency).contains("touches no limit"));
    for (led_by, words) in
        [(LedBy::LinearSteps, "the linear loop"), (LedBy::NonlinearRuns, "the nonlinear rig")]
    {
        let found = touches(led_by);
        let sentence =
            format!("The loop touches no limit over frequency: the steps of {words} led the search");
        assert!(found.contains(&sentence), "{found}");
    }
    for (led_by, key) in [(LedBy::Frequency, "frequency"), (LedBy::NonlinearRuns, "nonlinear_runs")] {
        let body = printed(&ProjectDesign { led_by, ..view.clone() }, MotionKind::Linear).unwrap();
        assert_eq!(serde_json::from_str::<serde_json::Value>(&body).unwrap()["led_by"], key);
    }
}
