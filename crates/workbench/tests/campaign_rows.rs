//! A repeated run of a campaign has the values of its row, to the last bit, for every rig.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, Request};
use phea_workbench::engineering::campaign::{Effort, Plan};
use phea_workbench::engineering::simulate::Metric;
use phea_workbench::project;
use phea_workbench::quantity::MotionKind;
use phea_workbench::source::Memory;
use serde_json::Value;

const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");

const KNEE: &str = include_str!("../../../examples/leg/knee.toml");

/// Settings for one step of the force, and a load that moves.
const SHORT: [&str; 4] = [
    "scenario.0.duration=0.4 s",
    "scenario.0.reference.0.at=0.05 s",
    "scenario.0.load_motion.start=0.2 s",
    "scenario.0.load_motion.duration=50 ms",
];

/// Checks the row of a run in a campaign of a few against the repeated run.
fn agree(more: &[&str]) {
    agree_of(CAMPAIGN, &[&SHORT[..], more].concat());
}

fn agree_of(text: &str, more: &[&str]) {
    let source = Memory::default().with("campaign.toml", text);
    let settings: Vec<String> = more.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "campaign.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&source, &loaded, 5).unwrap();
    let rows = plan.rows(0..4, Effort { threads: 1, lanes: true }).unwrap();
    for row in &rows[..3] {
        let ran = row.ran().unwrap_or_else(|| panic!("{row:?}"));
        let request = CampaignRequest { seed: 5, runs: CampaignRuns::One(row.run), files: false };
        let answer = command::answer(&source, &loaded, &[], &Request::Campaign(request)).unwrap();
        let json: Value = parsed(&answer.json);
        let run = &json["scenarios"][0];
        assert_eq!(
            (&run["status"], &run["work"]["steps"]),
            (&ran.status.key().into(), &ran.steps.into()),
            "{more:?}"
        );
        let events = run["events"].as_array().unwrap();
        assert_eq!(events.len(), ran.metrics.len());
        for (event, numbers) in events.iter().zip(&ran.metrics) {
            for metric in Metric::ALL {
                let (own, number) = (
                    event["metrics"][&*metric.quantity().text(MotionKind::Linear)].as_f64(),
                    numbers[metric],
                );
                let bits = |value: Option<f64>| value.map(f64::to_bits);
                assert_eq!(
                    bits(own),
                    bits(number),
                    "{more:?}, run {}: {metric:?} {own:?} {number:?}",
                    row.run
                );
            }
        }
    }
}

#[test]
fn a_continuous_loop_is_repeated_to_the_bit() {
    agree(&[]);
    agree(&["controller.delay=1 ms"]);
}

#[test]
fn a_sampled_loop_is_repeated_to_the_bit() {
    agree(&["controller.sample_time=1 ms"]);
    // rows between the samples, and a command that takes effect between them
    agree(&["controller.sample_time=0.7 ms", "controller.delay=0.4 ms", "scenario.0.output_step=0.3 ms"]);
    agree(&["controller.sample_time=2 ms", "force_sensor.noise=2 N"]);
}

#[test]
fn waves_and_gas_are_repeated_to_the_bit() {
    let waves =
        "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
    let gas = "line.accumulator={ gas_volume = \"50 mL\", precharge_pressure = \"20 bar\", polytropic_exponent = 1.4 }";
    let without = "campaign.parameters={ \"supply.pressure\" = { spread = \"20 %\" } }";
    for more in [&[waves][..], &[waves, "controller.sample_time=1 ms"], &[gas, "controller.sample_time=1 ms"]]
    {
        agree(&[&[without], more].concat());
    }
}

#[test]
fn a_load_that_yields_is_repeated_to_the_bit() {
    let sprung = "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"2 MN/m\", damping = \"500 N.s/m\" }";
    let fed = "controller.load_velocity_feed_forward.gain=5";
    agree(&[sprung, fed]);
    agree(&[sprung, fed, "controller.sample_time=1 ms"]);
}

/// A joint turned by the cylinder: its load is stated about the joint, its rows are moments.
#[test]
fn a_joint_is_repeated_to_the_bit() {
    let campaign = "[campaign]\nparameters = { \"supply.pressure\" = { spread = \"10 %\" } }\n";
    let text = format!("{KNEE}\n{campaign}");
    agree_of(&text, &["scenario.0.load_motion.start=0.4 s", "scenario.0.duration=0.8 s"]);
    agree_of(&text, &["controller.sample_time=1 ms"]);
}
