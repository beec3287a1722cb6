//! Verdicts tried on the machine.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{CommandError, Request};
use serde_json::Value;

use super::ask::{answer, try_answer};

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const PLANT: &str = include_str!("../../../examples/qft/servo.toml");
/// What `design` finds for the hose, and calls met over its family.
const DESIGNED: [&str; 4] = [
    "controller.numerator=0.7217*(s + 23.992)*(s + 2148.5)",
    "controller.denominator=s*(s^2 + 624.8*s + 1077500)",
    "prefilter.numerator=479.07",
    "prefilter.denominator=s^2 + 35.964*s + 479.07",
];

fn on_machine(settings: &[&str]) -> (bool, Value, String) {
    let said = answer(HOSE, settings, &[], &Request::Verify { proof: false, on_machine: true });
    (said.affirmative, serde_json::from_str(&said.json).unwrap(), said.text)
}

/// The run that this machine made.
fn run<'a>(object: &'a Value, what: &str) -> &'a Value {
    let runs = object["machine"]["runs"].as_array().unwrap();
    runs.iter()
        .find(|run| run["what"].as_str().unwrap().starts_with(what))
        .unwrap_or_else(|| panic!("{runs:?}"))
}

fn overshoot(run: &Value, of: &str) -> f64 {
    run[of]["overshoot_percent"].as_f64().unwrap()
}

/// Small steps of the published loop: the nominal machine does what the linear loop does, friction,
/// leakage and all.
#[test]
fn the_nominal_machine_is_the_linear_loop() {
    let (_, object, _) = on_machine(&[]);
    let nominal = run(&object, "the rig as declared");
    assert_eq!((&nominal["agrees"], &nominal["status"]), (&Value::from(true), &Value::from("completed")));
    assert!((overshoot(nominal, "machine") - overshoot(nominal, "linear")).abs() < 0.05, "{nominal}");
    let times = ["machine", "linear"].map(|of| nominal[of]["settling_time_s"].as_f64().unwrap());
    assert!((times[0] / times[1] - 1.0).abs() < 0.02, "{times:?}");
    // each worst plant was made into a rig, which it names
    for (index, kind) in ["1 robust stability", "2 sensitivity", "3 tracking"].into_iter().enumerate() {
        let worst = run(&object, &format!("the worst plant of {kind}"));
        assert_eq!(worst["plant"], object["specifications"][index]["plant"]);
    }
    assert_eq!(object["machine"]["not_driven"], Value::from(Vec::<Value>::new()));
}

/// With 1.5 m of hose a wave takes 2.8 ms: the loop has gain beyond the quarter wave, and what is
/// met with lumped lines swings with waves.
#[test]
fn a_met_verdict_that_waves_contradict_is_no() {
    let by_volume = ["line.compliance=by_volume"];
    let settings: Vec<&str> = DESIGNED.into_iter().chain(by_volume).collect();
    let (yes, object, text) = on_machine(&settings);
    assert_eq!(
        (object["verdict"].as_str(), object["machine"]["verdict"].as_str()),
        (Some("met"), Some("contradicts"))
    );
    assert!(!yes && text.contains("On the machine: contradicts"));
    let waves = run(&object, "the rig with waves in its lines");
    assert_eq!(waves["machine"]["settling_time_s"], Value::Null);
    assert!(overshoot(waves, "machine") > 100.0, "{waves}");
    // ORIGIN: analytic, pi c/(2 L) with the wave's speed in the hose at 35 bar
    assert!(waves["reason"].as_str().unwrap().contains("a quarter wave long at 560 rad/s"), "{waves}");
    // what a transmission line does not take is not recommended for it
    assert!(
        waves["reason"].as_str().unwrap().contains("(line.model = \"segments\" with line.relaxation_time)")
    );
    // the rig with lumped lines, which is what was promised
    assert_eq!(run(&object, "the rig as declared")["agrees"], Value::from(true));
}

/// Waves that are declared are in the verdict and in the machine, which swings as the verdict says.
#[test]
fn declared_waves_are_the_rig() {
    let waves = ["line.compliance=by_volume", "line.model=transmission_line"];
    let settings: Vec<&str> = DESIGNED.into_iter().chain(waves).collect();
    let (yes, object, _) = on_machine(&settings);
    assert!(!yes && object["verdict"] == "violated");
    assert!(object["stability"]["reason"].as_str().unwrap().contains("unstable closed-loop poles"));
    let first = &object["machine"]["runs"][0];
    assert_eq!((&first["agrees"], &first["linear"]), (&Value::from(true), &Value::Null));
    assert_eq!(first["reason"], "neither the linear loop nor the machine settles");
}

/// A load that yields is in both; the leakage as well.
#[test]
fn load_and_leakage_are_in_both() {
    let load = ["load.model=spring_mass_damper", "load.mass=100", "load.stiffness=2e5", "load.damping=500"];
    let settings: Vec<&str> = load.into_iter().chain(["cylinder.internal_leakage=1e-12"]).collect();
    let (_, object, _) = on_machine(&settings);
    let nominal = run(&object, "the rig as declared");
    let [machine, linear] = ["machine", "linear"].map(|of| overshoot(nominal, of));
    assert!(linear > 20.0 && (machine - linear).abs() < 3.0, "{machine} {linear}");
}

#[test]
fn a_plant_without_a_machine_is_refused() {
    let refused = try_answer(PLANT, &[], &[], &Request::Verify { proof: false, on_machine: true });
    assert!(matches!(refused, Err(CommandError::Rig(_))), "{refused:?}");
}
