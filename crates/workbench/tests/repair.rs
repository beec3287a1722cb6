//! Repair of a design that the machine contradicts.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, CommandError, Progress, Request};
use phea_workbench::design::{DESIGNED_PROJECT, NEAREST_PROJECT};
use serde_json::Value;

use super::run_command::{HOSE, UNLIMITED, answer, designed_hose, json, load, number, source};

const REPAIRED: Request = Request::Design { seed: None, stages: false, repair: true };
const LEFT: Request = Request::Design { seed: None, stages: false, repair: false };

/// The hose without its family: one rig, whose chambers and hoses have their own compliance.
fn one_rig() -> String {
    let (before, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    format!("{before}[[specification]]{after}")
}

fn object(output: &Answer) -> Value {
    parsed(&output.json)
}

fn file<'a>(output: &'a Answer, name: &str) -> Option<&'a str> {
    let found = output.files.iter().find(|file| file.name == name)?;
    Some(std::str::from_utf8(&found.bytes).unwrap())
}

fn worst_margin(audit: &Value) -> f64 {
    let findings = audit["specifications"].as_array().unwrap();
    findings.iter().map(|finding| number(finding, "worst_margin_db")).fold(f64::INFINITY, f64::min)
}

/// Order 4 is not sufficient over the box of Table 6.3 and with waves in the rig itself: the limits
/// must be relaxed, and with the controller for wider limits the machine with waves comes to rest.
#[test]
fn infeasibility_with_waves_is_reported() {
    let output = designed_hose();
    let object = object(output);
    let repair = &object["repair"];
    // the design is the original one, for the declared family
    assert!(!output.affirmative);
    assert_eq!((&object["status"], &object["machine"]["verdict"]), (&"met".into(), &"contradicts".into()));
    assert_eq!((&repair["status"], &repair["plant_before"]["stable"]), (&"infeasible".into(), &false.into()));
    assert_eq!(repair["added_plant"], "the rig with waves in its lines");
    // the printed controller satisfies the limits to the printed relaxation, for the family and for
    // the plant with waves
    let relaxation = number(repair, "relaxation_db");
    assert!(relaxation > 0.01, "{relaxation} dB");
    let both = [&repair["nearest"]["verification"], &repair["plant_after"]];
    let worst = both.map(worst_margin).into_iter().fold(f64::INFINITY, f64::min);
    assert!((worst + relaxation).abs() < 0.01, "{worst} {relaxation}");
    let runs = repair["nearest_machine"]["runs"].as_array().unwrap();
    let waves = runs.iter().find(|run| run["what"] == repair["added_plant"]).unwrap();
    assert_eq!(waves["agreement"], "agrees");
    // the project written with it gives equal results
    let written = json(
        file(output, NEAREST_PROJECT).unwrap(),
        &[],
        &[],
        &Request::Verify { proof: false, on_machine: false },
    );
    assert_eq!(written["stable"], true);
    assert!((worst_margin(&written) - worst_margin(&repair["nearest"]["verification"])).abs() < 1e-3);
    // ORIGIN: analytic, pi c/(2 L) with the wave's speed in the hose at 35 bar
    assert!((number(repair, "quarter_wave_rad_per_s") - 560.0).abs() < 1.0);
    for words in
        ["Repair: infeasible", "beyond the quarter wave", "what would help: a line shorter than 0.63 m"]
    {
        assert!(output.text.contains(words), "{words}: {}", output.text);
    }
}

/// The hose with limits so much wider that a controller of order 4 is suitable for waves too; at
/// the corners of its box and in between.
fn wider() -> String {
    let changes = [
        ("\nlimit = 1.3\n", "\nlimit = 1.36\n"),
        ("2116*(s + 75)/75", "2116*1.05*(s + 75)/75"),
        ("\"400*50\"", "\"400*50*0.95\""),
        ("points = 3", "points = 2"),
        ("points = 5", "points = 2"),
    ];
    changes.into_iter().fold(HOSE.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// Settings that leave only the specifications, which must be met to a thousandth of a decibel.
const EXACT: [&str; 3] = [UNLIMITED[0], UNLIMITED[1], "verification.tolerance=0.001 dB"];

/// A controller that the machine with waves contradicts is replaced by one suitable for both.
#[test]
fn a_design_is_repaired_if_possible() {
    let first = object(&answer(&wider(), &EXACT, &[], &LEFT));
    assert_eq!((&first["status"], &first["machine"]["verdict"]), (&"met".into(), &"contradicts".into()));
    assert_eq!((&first["repair"], &first["repair_reason"]), (&Value::Null, &"it was not requested".into()));

    let output = answer(&wider(), &EXACT, &[], &REPAIRED);
    let object = object(&output);
    let repair = &object["repair"];
    assert_eq!((&object["status"], &repair["status"]), (&"met".into(), &"met".into()), "{repair}");
    // steps of a tenth end outside the band for longer than a run, and overshoot by more than the
    // linear ones
    assert_ne!(object["machine"]["verdict"], "contradicts", "{:#}", object["machine"]);
    assert!(output.affirmative);
    assert_eq!(repair["plant_after"]["verdict"], "met");
    // the first design is printed in addition
    assert_eq!(repair["before"]["controller"], first["controller"]);
    assert!(output.text.contains("before the repair"), "{}", output.text);
    // the verdicts with waves in every plant are those of the audit of the project that declares
    // them
    let written = file(&output, DESIGNED_PROJECT).unwrap();
    let declared = json(
        written,
        &["line.model=transmission_line"],
        &[],
        &Request::Verify { proof: false, on_machine: false },
    );
    let whole = &repair["family_with_waves"];
    assert_eq!((&declared["verdict"], &declared["stable"]), (&whole["verdict"], &whole["stable"]));
    assert!((worst_margin(&declared) - worst_margin(whole)).abs() < 1e-6);
    assert_eq!(file(&output, NEAREST_PROJECT), None);
}

/// A command that reaches its limit at once is in no linear plant: no plant is added, and the
/// answer states the change to make.
#[test]
fn an_unexplained_contradiction_is_reported() {
    let settings = [
        "line.model=segments",
        "line.segments=4",
        "line.relaxation_time=0.3 ms",
        "controller.saturation=0.02 V",
    ];
    let output = answer(&one_rig(), &settings, &[], &REPAIRED);
    let object = object(&output);
    assert_eq!((&object["status"], &object["machine"]["verdict"]), (&"met".into(), &"contradicts".into()));
    let repair = &object["repair"];
    assert_eq!((&repair["status"], &repair["added_plant"]), (&"nothing_to_add".into(), &Value::Null));
    let sentences = repair["sentences"].as_array().unwrap();
    assert!(
        sentences.iter().any(|one| one.as_str().unwrap().contains("command was at its limit")),
        "{repair}"
    );
}

/// A repair that is stopped leaves the design unchanged.
#[test]
fn a_repair_may_be_stopped() {
    let loaded = load(&wider(), &EXACT, &[]);
    let mut stages = Vec::new();
    let mut watch = |progress: Progress| {
        stages.push(progress.stage);
        !progress.stage.starts_with("designing again")
    };
    let output: Result<Answer, CommandError> =
        command::answer_into(&source(&wider()), &loaded, &[], &REPAIRED, None, &mut watch);
    let output = output.unwrap();
    let object = object(&output);
    assert_eq!((&object["status"], &object["repair"]["status"]), (&"met".into(), &"stopped".into()));
    assert!(!output.affirmative && stages.iter().any(|stage| stage.starts_with("designing again")));
}
