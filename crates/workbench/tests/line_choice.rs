//! The model of lines whose project states none.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::campaign::{Effort, RequestedRuns, Shard};
use phea_workbench::command::{CampaignRequest, CampaignRuns, Request, SimulateRequest};
use phea_workbench::shaping::Shaped;
use serde_json::Value;

use super::ask::{answer, json};

const RIG: &str = include_str!("../../../examples/structural/rig.toml");
const VERIFY: Request = Request::Verify { proof: false, on_machine: false };

/// Two hoses of 3 m without a stated model, without uncertainty.
fn open_rig() -> String {
    let (before, rest) = RIG.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    format!("{before}[[specification]]{after}").replace("model = \"lumped\"\n", "")
}

/// The same without the law of its controller.
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
    // the slower of both
    let found = chosen(&rig, &[&bandwidth(1.01), "line.a.length=1.5 m"]);
    assert_eq!(found["model"], "transmission_line");
}

/// What is required within a time needs a bandwidth, ln(100/band)/t for settling; limits that
/// require feedback need it up to their design frequencies, those that protect the top do not.
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

/// The crossover of a given loop: that which `verify` finds with lumped lines.
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

/// A stated model stays, of one side too, whatever is reached.
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
    // stated as the choice would be, all but the choice is the same
    let all = json(&open_rig(), &[fast, "line.model=transmission_line"], &[], &VERIFY);
    let chosen = json(&open_rig(), &[fast], &[], &VERIFY);
    assert_eq!(all["margins"], chosen["margins"]);
}

/// Every command has the model in its first lines and in JSON, and it is one.
#[test]
fn every_command_names_the_chosen_model() {
    let rig = open_rig() + "\n[campaign.parameters]\n\"supply.pressure\" = { spread = \"5 %\" }\n";
    let settings = ["controller.elements.0.proportional_gain=2e-4", "scenario.0.duration=0.6 s"];
    let runs = |asked| Request::Campaign(CampaignRequest { seed: 1, asked, files: false });
    let requests = [
        Request::Check,
        Request::Linearize { sweep: None },
        VERIFY,
        Request::Shape { shaped: Shaped::Controller, changes: vec![] },
        Request::Simulate(SimulateRequest::default()),
        Request::Compare,
        runs(CampaignRuns::All(RequestedRuns {
            runs: 2,
            shard: Shard::default(),
            effort: Effort::default(),
        })),
        runs(CampaignRuns::One(1)),
    ];
    let found: Vec<Value> = requests
        .iter()
        .map(|request| {
            let told = answer(&rig, &settings, &[], request);
            assert!(told.text.starts_with("Lines: with waves, since"), "{}: {}", request.name(), told.text);
            let object: Value = parsed(&told.json);
            object["line_model"].clone()
        })
        .collect();
    assert!(found.iter().all(|one| one["model"] == "transmission_line" && *one == found[0]), "{found:?}");
}

/// A designed project states the model that was chosen for the design: by its crossover alone
/// another might be chosen, and its margins would be those of other plants. Margins of the nominal
/// loop are told with waves too, once as they are of the design and once in the audit.
#[test]
fn a_designed_project_states_the_chosen_model() {
    let design = Request::Design { seed: None, stages: false, repair: false };
    for bandwidth in ["design.highest_bandwidth=300", "design.highest_bandwidth=20"] {
        let told = answer(&rig_to_be_designed(), &["design.structure=pi", bandwidth], &[], &design);
        let object: Value = parsed(&told.json);
        let file = told.files.iter().find(|file| file.name == "designed.toml").unwrap();
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

/// A mass that nothing holds is not computed behind waves: its lines stay lumped, with the reason.
#[test]
fn what_is_not_computed_with_waves_stays_lumped() {
    let settings = ["load.stiffness=0", "operating_point.load_force=0", "design.highest_bandwidth=300"];
    let found = chosen(&rig_to_be_designed(), &settings);
    assert_eq!(found["model"], "lumped");
    assert_eq!(found["hindrance"], "the load is a mass without stiffness");
}

/// Where the quarter wave is what limits a design, the reason is not that it lies near itself.
#[test]
fn a_quarter_wave_that_limits_the_bandwidth_is_not_compared_with_itself() {
    let rig = rig_to_be_designed();
    let sentence = |settings: &[&str]| {
        let said = answer(&rig, settings, &[], &Request::Check).text;
        said.lines().next().unwrap_or_default().to_string()
    };
    let own = sentence(&[]);
    assert!(own.contains("up to their quarter wave") && !own.contains("within 10 times"), "{own}");
    let stated = sentence(&["design.highest_bandwidth=60"]);
    assert!(stated.contains("within 10 times the 60.0 rad/s"), "{stated}");
}

/// A design whose bandwidth nothing limits may go as far as it would by default, though nothing
/// asks for so much.
#[test]
fn a_design_without_a_limit_on_its_bandwidth_has_waves_where_the_rig_leaves_it_as_much() {
    let rig = rig_to_be_designed();
    let [default, unlimited] = [&[][..], &["design.highest_bandwidth=inf"]].map(|own| chosen(&rig, own));
    assert_eq!(unlimited["reached_rad_per_s"], default["reached_rad_per_s"]);
    let found = (&unlimited["model"], &unlimited["reached_by"]);
    assert_eq!(found, (&"transmission_line".into(), &"unlimited_bandwidth".into()));
}
