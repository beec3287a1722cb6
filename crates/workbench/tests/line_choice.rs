//! The model of lines for which the project states none.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{CampaignRequest, CampaignRuns, Request, SimulateRequest};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::shaping::Shaped;
use serde_json::Value;

use super::run_command::{answer, json};

const RIG: &str = include_str!("../../../examples/structural/rig.toml");
const VERIFY: Request = Request::Verify { proof: false, on_machine: false };

/// Two hoses of 3 m without a stated model, without uncertainty.
fn open_rig() -> String {
    let (before, rest) = RIG.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    format!("{before}[[specification]]{after}").replace("model = \"lumped\"\n", "")
}

/// The rig without the law of its controller.
fn rig_to_be_designed() -> String {
    open_rig().replace("elements = [{ kind = \"pi\", proportional_gain = 3e-5, integral_gain = 1e-5 }]\n", "")
}

fn chosen(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &Request::Check)["line_model"].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A quarter of a wave through 3 m of this hose, from the bulk modulus of its oil and its wall: the
/// wave takes L sqrt(rho/K).
#[test]
fn the_boundary_is_a_tenth_of_the_quarter_wave() {
    let rig = rig_to_be_designed();
    let quarter = number(&chosen(&rig, &[])["quarter_wave_rad_per_s"]);
    let bandwidth = |factor: f64| format!("design.highest_bandwidth={}", factor * quarter / 10.0);
    for (factor, model) in [(0.99, "lumped"), (1.01, "transmission_line")] {
        let found = chosen(&rig, &[&bandwidth(factor)]);
        assert_eq!((&found["model"], &found["reached_by"]), (&model.into(), &"highest_bandwidth".into()));
        assert!((number(&found["reached_rad_per_s"]) / (factor * quarter / 10.0) - 1.0).abs() < 1e-12);
    }
    // half the length, twice the frequency
    let found = chosen(&rig, &[&bandwidth(1.01), "line.length=1.5 m"]);
    assert_eq!(found["model"], "lumped");
    assert!((number(&found["quarter_wave_rad_per_s"]) / (2.0 * quarter) - 1.0).abs() < 1e-6);
    // the slower of the two
    let found = chosen(&rig, &[&bandwidth(1.01), "line.a.length=1.5 m"]);
    assert_eq!(found["model"], "transmission_line");
}

/// A requirement in time needs a bandwidth, ln(100/band)/t for settling; limits that require
/// feedback need it up to their design frequencies, and limits at high frequencies do not.
#[test]
fn requirements_reach_frequencies() {
    let rig = rig_to_be_designed();
    let narrow = "design.highest_bandwidth=1 rad/s";
    let found = chosen(&rig, &[narrow]);
    assert_eq!((&found["reached_by"], &found["specification"]), (&"required_time".into(), &2.into()));
    assert!(
        (number(&found["reached_rad_per_s"]) - phea_dynamics::portable::ln(50.0) / 0.25).abs() < 1e-9,
        "{found}"
    );
    assert_eq!(found["model"], "lumped");
    let limit = "\n[[specification]]\nkind = \"sensitivity\"\nlimit = 2\nfrequencies = [1, 60]\n";
    let found = chosen(&format!("{rig}{limit}"), &[narrow]);
    assert_eq!((&found["reached_by"], &found["specification"]), (&"design_frequency".into(), &3.into()));
    assert_eq!((number(&found["reached_rad_per_s"]), &found["model"]), (60.0, &"transmission_line".into()));
}

/// The crossover of a given loop is that which `verify` finds with lumped lines.
#[test]
fn a_given_loop_reaches_its_crossover() {
    let found = chosen(&open_rig(), &["controller.elements.0.proportional_gain=2e-4"]);
    assert_eq!((&found["model"], &found["reached_by"]), (&"transmission_line".into(), &"crossover".into()));
    let settings = ["controller.elements.0.proportional_gain=2e-4", "line.model=lumped"];
    let lumped = json(&open_rig(), &settings, &[], &VERIFY);
    let crossover = number(&lumped["margins"]["nominal"]["at"]["phase_deg"]["frequency_rad_per_s"]);
    assert!((number(&found["reached_rad_per_s"]) / crossover - 1.0).abs() < 1e-6, "{found} {crossover}");
    // the slow loop of the project itself
    let found = chosen(&open_rig(), &[]);
    assert_eq!((&found["model"], &found["reached_by"]), (&"lumped".into(), &"required_time".into()));
}

/// A stated model is never changed, not even that of one side, whatever the frequencies.
#[test]
fn a_stated_model_is_never_changed() {
    let fast = "controller.elements.0.proportional_gain=2e-4";
    for model in ["lumped", "transmission_line", "two_wave"] {
        let model = format!("line.model={model}");
        let object = json(&open_rig(), &[fast, &model], &[], &Request::Check);
        assert!(object.get("line_model").is_none(), "{model}");
    }
    let one_side = answer(&open_rig(), &[fast, "line.a.model=lumped"], &[], &VERIFY);
    let both = ["line.a.model=lumped", "line.b.model=transmission_line"];
    let stated: Value = parsed(&answer(&open_rig(), &[fast, both[0], both[1]], &[], &VERIFY).json);
    let object: Value = parsed(&one_side.json);
    assert_eq!(object["line_model"]["model"], "transmission_line");
    assert_eq!(object["margins"], stated["margins"]);
    // if the project states the model that would be chosen, only the choice differs
    let all = json(&open_rig(), &[fast, "line.model=transmission_line"], &[], &VERIFY);
    let chosen = json(&open_rig(), &[fast], &[], &VERIFY);
    assert_eq!(all["margins"], chosen["margins"]);
}

/// Every command has the model in its first lines and in JSON, and all have one model.
#[test]
fn every_command_names_the_chosen_model() {
    let rig = open_rig() + "\n[campaign.parameters]\n\"supply.pressure\" = { spread = \"5 %\" }\n";
    let settings = ["controller.elements.0.proportional_gain=2e-4", "scenario.0.duration=0.6 s"];
    let of_runs = |runs| Request::Campaign(CampaignRequest { seed: 1, runs, files: false });
    let requests = [
        Request::Check,
        Request::Linearize { sweep: None },
        VERIFY,
        Request::Shape { shaped: Shaped::Controller, changes: vec![] },
        Request::Simulate(SimulateRequest::default()),
        Request::Compare,
        of_runs(CampaignRuns::All(RequestedRuns { runs: 2, effort: Effort::default() })),
        of_runs(CampaignRuns::One(1)),
    ];
    let found: Vec<Value> = requests
        .iter()
        .map(|request| {
            let output = answer(&rig, &settings, &[], request);
            assert!(
                output.text().starts_with("Lines: with waves, since"),
                "{}: {}",
                request.name(),
                output.text()
            );
            let object: Value = parsed(&output.json);
            object["line_model"].clone()
        })
        .collect();
    assert!(found.iter().all(|one| one["model"] == "transmission_line" && *one == found[0]), "{found:?}");
}

/// A designed project states the model that was chosen for the design: from its crossover another
/// model could be chosen, and its margins would be those of other plants. Margins of the nominal
/// loop are reported with waves too, once for the design and once in the audit.
#[test]
fn a_designed_project_states_the_chosen_model() {
    let design = Request::Design { seed: None, stages: false, repair: false };
    for bandwidth in ["design.highest_bandwidth=300", "design.highest_bandwidth=20"] {
        let output = answer(&rig_to_be_designed(), &["design.structure=pi", bandwidth], &[], &design);
        let object: Value = parsed(&output.json);
        let file = output.files.iter().find(|file| file.name == "designed.toml").unwrap();
        let designed = String::from_utf8(file.bytes.clone()).unwrap();
        let model = object["line_model"]["model"].as_str().unwrap();
        assert!(designed.contains(&format!("[line]\nmodel = \"{model}\"\n")), "{designed}");
        let verified = json(&designed, &[bandwidth], &[], &VERIFY);
        assert!(verified["line_model"].is_null());
        for key in ["gain_db", "phase_deg", "modulus", "delay_s"] {
            // the law is read back from its gains, to the last digit but one
            let [read, designed] =
                [&verified, &object["verification"]].map(|one| number(&one["margins"][key]));
            assert!((read / designed - 1.0).abs() < 1e-9, "{key}: {read} {designed}");
        }
        let nominal = &object["verification"]["margins"]["nominal"];
        assert_eq!(object["figures"]["phase_margin_deg"], nominal["phase_deg"]);
        assert_eq!(object["figures"]["gain_margin_db"], nominal["gain_db"]);
        assert!(number(&nominal["phase_deg"]) > 0.0);
    }
}

/// A free mass cannot be computed with waves: its lines remain lumped, with the reason.
#[test]
fn answers_without_waves_use_lumped_lines() {
    let settings = ["load.stiffness=0", "operating_point.load_force=0", "design.highest_bandwidth=300"];
    let found = chosen(&rig_to_be_designed(), &settings);
    assert_eq!(found["model"], "lumped");
    assert_eq!(found["obstacle"], "the load is a mass without stiffness");
}

/// The reason of a design limited by the quarter wave does not compare the quarter wave with
/// itself.
#[test]
fn a_quarter_wave_that_limits_the_bandwidth_is_not_compared_with_itself() {
    let rig = rig_to_be_designed();
    let sentence = |settings: &[&str]| {
        let text_of_check = answer(&rig, settings, &[], &Request::Check).text();
        text_of_check.lines().next().unwrap_or_default().to_string()
    };
    let own = sentence(&[]);
    assert!(own.contains("up to their quarter wave") && !own.contains("within 10 times"), "{own}");
    let stated = sentence(&["design.highest_bandwidth=60"]);
    assert!(stated.contains("within 10 times the 60.0 rad/s"), "{stated}");
}

/// A design without a limit on its bandwidth may use the default bandwidth, although nothing
/// requires it.
#[test]
fn a_design_without_a_bandwidth_limit_has_waves_if_the_rig_permits_the_bandwidth() {
    let rig = rig_to_be_designed();
    let [default, unlimited] = [&[][..], &["design.highest_bandwidth=inf"]].map(|own| chosen(&rig, own));
    assert_eq!(unlimited["reached_rad_per_s"], default["reached_rad_per_s"]);
    let found = (&unlimited["model"], &unlimited["reached_by"]);
    assert_eq!(found, (&"transmission_line".into(), &"unlimited_bandwidth".into()));
}
