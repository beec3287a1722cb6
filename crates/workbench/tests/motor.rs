//! A motor instead of the cylinder: its verdict is that of a cylinder on a lever, and no output is
//! in newtons or millimetres.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::answer::Answer;
use phea_workbench::command::{
    AlternativesRequest, CampaignRequest, CampaignRuns, CommandError, FrequencyOptions, Request,
    SimulateRequest,
};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::linearize::SweepRequest;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::shaping::Shaped;
use serde_json::Value;

use super::run_command::{load, project_of, try_answer};

const VANE: &str = include_str!("../../../examples/rotary/vane.toml");
const TURNING: &str = include_str!("../../project/tests/valid/motor_turning.toml");

fn returned(project: &str, request: &Request) -> Answer {
    try_answer(project, &[], &[], request).unwrap()
}

/// A rig with a cylinder (arm 1), or with the equivalent motor of a lever with this arm.
fn rig(arm: Option<f64>) -> String {
    let r = arm.unwrap_or(1.0);
    let (square, area) = (r * r, 1.6e-3);
    let friction = format!("model = \"viscous\"\nviscous = {}", 400.0 * square);
    let moving = match arm {
        None => format!(
            "[cylinder]\npiston_area = {area}\nstroke = 0.2\nmoving_mass = 13\ndead_volume = 2e-5\ninternal_leakage = 2e-13\n\
             [cylinder.friction]\n{friction}"
        ),
        Some(_) => format!(
            "[motor]\ndisplacement = {}\nstroke = {}\ninertia = {}\ndead_volume = 2e-5\ninternal_leakage = 2e-13\n\
             [motor.friction]\n{friction}",
            area * r,
            0.2 / r,
            13.0 * square
        ),
    };
    let (sensor, gain, step, turn) = (2e7 * square, 0.0005 / r, 1000.0 * r, 1e-3 / r);
    let (nominal, least, most) = (400.0 * square, 300.0 * square, 2000.0 * square);
    format!(
        r#"schema = 1
title = "arm"
[fluid]
bulk_modulus = "1.45 GPa"
density = 870
[supply]
pressure = "70 bar"
[valve]
model = "moog_760_c263a"
leakage_shape = 100
{moving}
[line]
pipe = {{ bore = "10 mm" }}
length = "1 m"
[force_sensor]
stiffness = {sensor}
[uncertainty]
viscous_friction = {{ nominal = {nominal}, minimum = {least}, maximum = {most} }}
[[specification]]
kind = "robust_stability"
limit = 1.4
frequencies = [1, 10, 100]
band = [0, inf]
[controller]
numerator = "{gain}*(s + 5)"
denominator = "s"
[[scenario]]
name = "step"
duration = "0.5 s"
reference = [{{ at = "0.1 s", force = {step} }}]
load_motion = {{ kind = "smooth_step", start = "0.3 s", duration = "0.1 s", distance = {turn} }}
"#
    )
}

fn campaign(files: bool) -> CampaignRequest {
    let wanted = RequestedRuns { runs: 6, effort: Effort::default() };
    CampaignRequest { seed: 1, runs: CampaignRuns::All(wanted), files }
}

fn close(one: f64, other: f64, what: &str) {
    assert!((one - other).abs() <= 1e-9 * one.abs().max(other.abs()), "{what}: {one} and {other}");
}

/// Verdict, margin and frequency are equal, and so are the numbers of the linear models.
#[test]
fn the_verdict_is_that_of_the_cylinder_on_its_lever() {
    let arm = 0.04;
    let json = |project: &str, request: &Request| -> Value { parsed(&returned(project, request).json) };
    let [linear, rotary] = [rig(None), rig(Some(arm))];
    let [one, other] =
        [&linear, &rotary].map(|project| json(project, &Request::Verify { proof: false, on_machine: false }));
    assert_eq!(one["verdict"], other["verdict"]);
    let of = |audit: &Value, key: &str| audit["specifications"][0][key].as_f64().unwrap();
    assert!((of(&one, "worst_margin_db") - of(&other, "worst_margin_db")).abs() < 1e-7);
    let (one, other) = (
        json(&linear, &Request::Linearize { sweep: None }),
        json(&rotary, &Request::Linearize { sweep: None }),
    );
    let stiffness = |found: &Value, key: &str| found["stiffness"][key].as_f64().unwrap();
    close(
        stiffness(&one, "minimum_n_per_m") * arm * arm,
        stiffness(&other, "minimum_n_m_per_rad"),
        "least stiffness",
    );
    let (one, other) = (
        json(&linear, &Request::Simulate(Default::default())),
        json(&rotary, &Request::Simulate(Default::default())),
    );
    let metric = |run: &Value, event: usize, key: &str| {
        run["scenarios"][0]["events"][event]["metrics"][key].as_f64().unwrap()
    };
    let [peak, turned] = [metric(&one, 1, "disturbance_peak_n"), metric(&other, 1, "disturbance_peak_n_m")];
    assert!((peak * arm / turned - 1.0).abs() < 1e-4, "{peak} {turned}");
    let [rise, turned] = [metric(&one, 0, "rise_time_s"), metric(&other, 0, "rise_time_s")];
    assert!((rise / turned - 1.0).abs() < 1e-4, "{rise} {turned}");
}

/// Leakage to the tank flows through a narrow line, and the valve does not: without motion
///
/// ```text
/// T_e = D (K_qA/(K_cA + G_e (1 + K_cA R)) + K_qB/(K_cB + G_e (1 + K_cB R))) U_C,     R = 128 rho nu L/(pi d^4)
/// ```
#[test]
fn it_leaks_after_its_lines() {
    let tight = rig(Some(0.04)).replace("internal_leakage", "case_leakage").replace("10 mm", "2 mm");
    let leakage = 2e-13;
    let resistance = 128.0 * 870.0 * 46e-6 / (std::f64::consts::PI * 16e-12);
    for model in ["lumped", "segments"] {
        let settings = ["fluid.kinematic_viscosity=46e-6".to_string(), format!("line.model={model}")];
        let project = project_of(&tight, &settings.each_ref().map(String::as_str));
        let setup = Setup::new(&project).unwrap();
        let rig = setup.rig().unwrap();
        let passed = if model == "lumped" { 0.0 } else { resistance };
        let chambers = &rig.two_pressure.chambers;
        let sides = [
            (chambers.flow_gain_a, chambers.flow_pressure_a - leakage),
            (chambers.flow_gain_b, chambers.flow_pressure_b - leakage),
        ];
        let of_side = |(gain, valve): (f64, f64)| gain / (valve + leakage * (1.0 + valve * passed));
        let [displacement, _] = rig.two_pressure.areas;
        let expected = displacement * sides.map(of_side).iter().sum::<f64>();
        let found = rig.response(1e-6).re;
        close(found, expected, model);
        assert!(model == "lumped" || leakage * resistance > 1e-2, "a line that is felt");
    }
}

/// Medians of a campaign and the columns of alternatives are those of the cylinder times the arm.
#[test]
fn campaigns_and_alternatives_are_those_of_the_cylinder_on_its_lever() {
    let arm = 0.04;
    let more = "[campaign.parameters]\n\"supply.pressure\" = { spread = \"5 %\" }\n\
                [[alternative]]\nname = \"hose\"\nset = { \"line.length\" = \"2 m\" }\nrecentre = true\n\
                [design]\nmaximum_order = 2\n";
    let [linear, rotary] = [None, Some(arm)].map(|arm| rig(arm) + more);
    let json = |project: &str, request: &Request| -> Value { parsed(&returned(project, request).json) };
    let drawn = Request::Campaign(campaign(false));
    let (one, other) = (json(&linear, &drawn), json(&rotary, &drawn));
    let median = |found: &Value, event: usize, name: &str| {
        let metrics = found["metrics"][event]["metrics"].as_array().unwrap();
        metrics.iter().find(|metric| metric["name"] == name).unwrap()["quantiles"][2].as_f64().unwrap()
    };
    let [peak, turned] = [median(&one, 1, "disturbance_peak_n"), median(&other, 1, "disturbance_peak_n_m")];
    assert!((peak * arm / turned - 1.0).abs() < 1e-4, "{peak} {turned}");
    let request = Request::Alternatives(AlternativesRequest::default());
    let (one, other) = (json(&linear, &request), json(&rotary, &request));
    let of = |found: &Value, name: &str| found["alternatives"][1]["columns"][name].as_f64().unwrap();
    let pairs = [
        ("stiffness_minimum_n_per_m", "stiffness_minimum_n_m_per_rad", arm * arm),
        ("equivalent_stiffness_n_per_m", "equivalent_stiffness_n_m_per_rad", arm * arm),
        ("moving_mass_kg", "moving_inertia_kg_m2", arm * arm),
        ("oil_mass_kg", "oil_mass_kg", 1.0),
        ("lines_length_m", "lines_length_m", 1.0),
    ];
    for (name, turned, factor) in pairs {
        close(of(&one, name) * factor, of(&other, turned), name);
    }
}

/// Units and words of linear motion, which no sentence, axis or heading of a rotary rig may
/// contain.
fn of_linear_motion(text: &str) -> Vec<String> {
    let units =
        ["kN", "MN", "N", "N/m", "MN/m", "kN/mm", "N/mm", "N.s/m", "N·s/m", "V/N", "N/V", "mm/s", "kg"];
    let words =
        ["force", "forces", "piston", "pistons", "cylinder", "rod", "newton", "newtons", "mass", "cell"];
    let separators = |c: char| c.is_whitespace() || matches!(c, '(' | ')' | ',' | ';' | ':' | '"' | '|');
    let mut found = Vec::new();
    // oil and parts have a mass in every rig
    let of_matter = |line: &&str| line.contains("mass of that oil") || line.contains("mass of its parts");
    let lines = text.lines().filter(|line| !of_matter(line)).collect::<Vec<_>>().join("\n");
    for word in lines.split(separators).map(|word| word.trim_end_matches(['.', '?'])) {
        if units.contains(&word) || words.contains(&word.to_lowercase().trim_end_matches("'s")) {
            found.push(word.to_string());
        }
    }
    found
}

/// Symbols of a cylinder in a text, even where tags separate a letter from its subscript.
fn symbols_of_a_cylinder(text: &str) -> Vec<String> {
    const SYMBOLS: [&str; 9] = ["K_H", "F_e", "F_H", "F_ref", "A_A", "A_B", "A_u", "x_p", "x_L"];
    let mut plain = String::new();
    for (index, part) in text.replace("</i><sub>", "_<").split('<').enumerate() {
        let (tag, shown) = if index == 0 { ("", part) } else { part.split_once('>').unwrap_or(("", part)) };
        // a drawing moves down to a subscript, and up again
        plain.push_str(match tag {
            "" | "/tspan" => "",
            _ if tag.starts_with("tspan") => {
                if tag.contains("dy=\"-") {
                    " "
                } else {
                    "_"
                }
            }
            _ => " ",
        });
        plain.push_str(shown);
    }
    let of_name = |c: char| c.is_alphanumeric() || c == '_';
    plain.split(|c| !of_name(c)).filter(|word| SYMBOLS.contains(word)).map(str::to_string).collect()
}

/// Texts of the user are unchanged, whatever words are in them.
#[test]
fn texts_of_the_user_are_unchanged() {
    let text = rig(Some(0.04)).replace(
        "force = 40 }",
        "force = 40, published = { source = \"force of the piston\", overshoot_percent = 3 } }",
    );
    let direction = "\n[[uncertainty_direction]]\nname = \"wear of the piston\"\nchanges = { \"motor.inertia\" = 1e-3 }\n";
    let of_audit =
        returned(&format!("{text}{direction}"), &Request::Verify { proof: false, on_machine: false });
    assert!(of_audit.text().contains("wear of the piston"), "{}", of_audit.text());
    let of_run = returned(&text, &Request::Report { files: false, alternatives: false });
    let page = String::from_utf8(of_run.files[0].bytes.clone()).unwrap();
    assert!(page.contains("force of the piston"), "{page}");
}

/// Case leakage belongs to the rig and not to the servovalve: the slopes of the valve are listed
/// without it, and the K_c of the rig includes it in both chambers.
#[test]
fn leakage_through_the_case_is_not_the_valves() {
    for case in [1e-13, 1e-12, 1e-11] {
        let text = VANE.replace("case_leakage = \"1e-13 m3/(s.Pa)\"", &format!("case_leakage = {case:e}"));
        let json: Value = parsed(&returned(&text, &Request::Check).json);
        let rows = json["derived"].as_array().unwrap();
        let value = |name: &str| {
            let row = rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("{name}"));
            row["value"].as_f64().unwrap()
        };
        let [own_a, own_b] = ["valve.flow_pressure_a", "valve.flow_pressure_b"].map(value);
        let together = 1.0 / (1.0 / (own_a + case) + 1.0 / (own_b + case));
        let whole = value("linear.flow_pressure_coefficient");
        assert!((whole / together - 1.0).abs() < 1e-12, "{case}: {whole} {together}");
        let in_series = 1.0 / (1.0 / own_a + 1.0 / own_b);
        let gain = value("linear.flow_gain") / in_series;
        assert!((value("valve.pressure_gain") / gain - 1.0).abs() < 1e-12, "{case}");
    }
}

/// The equations of `check` are those of a motor, and so are the symbols everywhere; those of a
/// cylinder are found for a cylinder, so that the test would detect them.
#[test]
fn equations_and_symbols_are_those_of_a_motor() {
    let equation = |name: &str| {
        let json: Value = parsed(&returned(VANE, &Request::Check).json);
        let rows = json["derived"].as_array().unwrap();
        let row = rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("{name}"));
        [&row["symbol"], &row["equation"]].map(|text| text.as_str().unwrap().to_string())
    };
    let is = |name: &str, symbol: &str, text: &str| assert_eq!(equation(name), [symbol, text], "{name}");
    is("stiffness.minimum", "K_θ", "K_θ = min over θ of D^2 (1/C_A + 1/C_B)");
    is("operating_point.hydraulic_torque", "T_H", "T_H = D (p_A - p_B)");
    is("linear.flow_gain", "K_qU", "K_{qU} = D^2 (K_{qA}/C_A + K_{qB}/C_B)/K_θ");
    let leaking = "1/K_c = 1/(K_{cA} + G_e) + 1/(K_{cB} + G_e), with the leakage G_e through the case";
    is("linear.flow_pressure_coefficient", "K_c", leaking);
    is("dynamics.mechanical_frequency", "ω_m", "ω_m = sqrt((K_θ + K_S)/J)");
    for request in [
        Request::Check,
        Request::Linearize { sweep: None },
        Request::Report { files: true, alternatives: false },
    ] {
        let answer = returned(TURNING, &request);
        assert_eq!(symbols_of_a_cylinder(&answer.text()), [""; 0], "{}", request.name());
        for file in
            answer.files.iter().filter(|file| file.name.ends_with("svg") || file.name.ends_with("html"))
        {
            let text = std::str::from_utf8(&file.bytes).unwrap();
            assert_eq!(symbols_of_a_cylinder(text), [""; 0], "{}: {}", request.name(), file.name);
        }
    }
    let linear = returned(&rig(None), &Request::Report { files: true, alternatives: false });
    let found = |name: &str| {
        let file = linear.files.iter().find(|file| file.name == name).unwrap();
        symbols_of_a_cylinder(std::str::from_utf8(&file.bytes).unwrap())
    };
    for symbol in ["K_H", "F_e", "A_A", "x_p"] {
        assert!(found("report.html").iter().any(|one| one == symbol), "{symbol}");
    }
    assert!(found("circuit.svg").iter().any(|one| one == "F_e"));
}

/// A motor has no length from mount to mount, and none is requested.
#[test]
fn a_motor_has_no_retracted_length() {
    let answer = returned(VANE, &Request::Alternatives(AlternativesRequest::default()));
    let json: Value = parsed(&answer.json);
    let reason = &json["alternatives"][0]["columns"]["actuator_length_m_reason"];
    assert_eq!(reason, "a motor has no retracted length");
    assert!(!answer.text().contains("dead_length") && !answer.json.contains("dead_length"));
}

/// The text of a page or drawing, its code and styles left out.
fn text_of(markup: &str) -> String {
    let mut text = String::new();
    let mut rest = markup;
    while let Some(start) = rest.find('<') {
        text.push_str(&rest[..start]);
        text.push(' ');
        let skipped = ["<style", "<code", "<script"].iter().find(|tag| rest[start..].starts_with(**tag));
        let end = match skipped {
            Some(tag) => rest[start..].find(&tag.replace('<', "</")).unwrap_or(1),
            None => 0,
        };
        let after = &rest[start + end..];
        rest = after.find('>').map_or("", |end| &after[end + 1..]);
    }
    text + rest
}

/// Names of lengths and masses that occur for all rigs.
const OF_ALL_RIGS: [&str; 6] =
    ["lines_length_m", "sized_length_m", "actuator_length_m", "oil_mass_kg", "parts_mass_kg", "distance_m"];

/// Keys of JSON that contain a unit of linear motion.
fn keys_of_linear_motion(value: &Value) -> Vec<String> {
    match value {
        Value::Object(members) => members
            .iter()
            .flat_map(|(key, value)| {
                let bare = key.strip_suffix("_reason").unwrap_or(key);
                let is_linear = ["_n", "_n_per_m", "_v_per_n", "_m_per_s", "_m", "_kg"]
                    .iter()
                    .any(|end| bare.ends_with(end))
                    && !bare.ends_with("_n_m")
                    && !OF_ALL_RIGS.contains(&bare);
                is_linear
                    .then(|| key.clone())
                    .into_iter()
                    .chain(keys_of_linear_motion(value))
                    .collect::<Vec<_>>()
            })
            .collect(),
        Value::Array(items) => items.iter().flat_map(keys_of_linear_motion).collect(),
        _ => vec![],
    }
}

fn check(project: &str, request: &Request) {
    let answer = returned(project, request);
    let name = request.name();
    assert_eq!(of_linear_motion(&answer.text()), [""; 0], "{name}: {}", answer.text());
    let json: Value = parsed(&answer.json);
    assert_eq!(json["motion"], "rotary", "{name}");
    assert_eq!(keys_of_linear_motion(&json), [""; 0], "{name}");
    for file in &answer.files {
        let Ok(text) = std::str::from_utf8(&file.bytes) else { continue };
        let found = match file.name.rsplit('.').next() {
            Some("html" | "svg") => of_linear_motion(&text_of(text)),
            Some("csv") => {
                let linear = |name: &&str| {
                    ["_n", "_m", "_m_per_s"].iter().any(|end| name.ends_with(end))
                        && !name.ends_with("_n_m")
                        && !OF_ALL_RIGS.contains(name)
                };
                text.lines().next().unwrap().split(',').filter(linear).map(str::to_string).collect()
            }
            _ => vec![],
        };
        assert_eq!(found, [""; 0], "{name}: {}", file.name);
    }
}

#[test]
fn newtons_and_millimetres_are_absent() {
    let with_figures = SimulateRequest { figures: true, ..SimulateRequest::default() };
    for request in [
        Request::Check,
        Request::Linearize { sweep: None },
        Request::Linearize {
            sweep: Some(SweepRequest { range: "line.length=0.5 m..1 m".to_string(), points: Some(2) }),
        },
        Request::Verify { proof: false, on_machine: true },
        Request::Verify { proof: true, on_machine: false },
        Request::Simulate(with_figures.clone()),
        Request::Simulate(SimulateRequest {
            frequency_response: Some(FrequencyOptions {
                frequencies: Some("10".to_string()),
                ..FrequencyOptions::default()
            }),
            ..SimulateRequest::default()
        }),
        Request::Campaign(campaign(true)),
        Request::Alternatives(AlternativesRequest { files: true, ..AlternativesRequest::default() }),
        Request::Report { files: true, alternatives: false },
    ] {
        check(VANE, &request);
    }
    for request in [
        Request::Check,
        Request::Linearize { sweep: None },
        Request::Simulate(with_figures),
        Request::Report { files: true, alternatives: false },
    ] {
        check(TURNING, &request);
    }
}

#[test]
fn commands_without_support_for_a_motor_refuse_it() {
    let requests = [
        Request::Size { gain: None, length: None },
        Request::Bench,
        Request::Shape { shaped: Shaped::Controller, changes: vec![] },
    ];
    for request in requests {
        let refused = try_answer(VANE, &[], &[], &request);
        assert!(matches!(refused, Err(CommandError::Refused(_))), "{}", request.name());
        assert!(refused.unwrap_err().to_string().contains("cylinder"), "{}", request.name());
    }
    assert!(load(VANE, &[], &[]).project.motion().is_rotary());
}

/// Errors with a place in the file use the words for a motor too.
#[test]
fn a_load_that_cannot_be_held_is_a_torque() {
    let settings = ["operating_point.load_force=\"9 kN.m\""];
    let error = try_answer(VANE, &settings, &[], &Request::Verify { on_machine: false, proof: false });
    let CommandError::Refused(refusal) = error.unwrap_err() else { panic!() };
    let message = &refusal.diagnostics[0].message;
    assert!(message.contains("a load torque of 9000 N.m cannot be held: the valve holds"), "{message}");
    assert!(message.ends_with(" N.m"), "{message}");
}
