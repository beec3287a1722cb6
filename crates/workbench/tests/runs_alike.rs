//! Runs of one kind are identical in every command, for every duration and every beginning.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, Request, SimulateRequest};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{Metrics, ScenarioRun, simulate_project};
use phea_workbench::source::Memory;
use serde_json::Value;

use super::run_command::{HOSE, answer, json, load, project_of};

const CONTINUOUS: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const VANE: &str = include_str!("../../../examples/rotary/vane.toml");

fn simulated(text: &str, settings: &[&str]) -> Value {
    json(text, settings, &[], &Request::Simulate(SimulateRequest::default()))["scenarios"][0].clone()
}

fn peak(run: &Value) -> f64 {
    let events = run["events"].as_array().unwrap();
    let of = |event: &Value| event["metrics"]["disturbance_peak_n"].as_f64();
    events.iter().find_map(of).unwrap_or_else(|| panic!("{run}"))
}

/// A slow motion in which friction feeds the ringing of the load cell.
const SLOW: [&str; 3] = [
    "scenario.0.duration=4.5 s",
    "scenario.0.load_motion.duration=1.2",
    "scenario.0.load_motion.distance=0.004",
];

/// A run repeated at smaller tolerances gives the result of a run at the smallest one, and every
/// command reports it.
#[test]
fn a_repeated_run_is_that_of_the_smallest_tolerance_in_every_command() {
    let repeated = simulated(CONTINUOUS, &SLOW);
    assert!(repeated["repetition"].is_object(), "{repeated}");
    let exact = simulated(CONTINUOUS, &[&SLOW[..], &["simulation.tolerance=1e-10"]].concat());
    let spread = repeated["repetition"]["spread"]["part"].as_f64().unwrap();
    assert!((peak(&repeated) / peak(&exact) - 1.0).abs() < spread.max(1e-3), "{repeated}");
    // compared with another project
    let projects = [SLOW[1], "scenario.0.load_motion.duration=0.3"]
        .map(|duration| load(CONTINUOUS, &[SLOW[0], duration, SLOW[2]], &[]));
    let compared = command::compare_watched(&Memory::default(), &projects, false, &mut |_| true).unwrap();
    let compared: Value = parsed(&compared.json);
    let side_by_side = &compared["projects"][0]["scenarios"][0];
    assert_eq!((peak(side_by_side), &side_by_side["repetition"]), (peak(&repeated), &repeated["repetition"]));
    // and as the run of a campaign whose variation is negligible
    let campaign = format!(
        "{CONTINUOUS}\n[campaign.parameters]\n\"supply.tank_pressure\" = {{ minimum = 0, maximum = 1e-3 }}\n"
    );
    let runs = RequestedRuns { runs: 1, effort: Effort::default() };
    let request = CampaignRequest { seed: 1, runs: CampaignRuns::All(runs), files: false };
    let table = json(&campaign, &SLOW, &[], &Request::Campaign(request));
    let occurrences = table["occurrences"].as_array().unwrap();
    let occurs = |kind: &str| occurrences.iter().any(|one| one["kind"] == kind);
    assert!(occurs("repeated") || occurs("errors_amplified"), "{table}");
}

/// Numbers of a window that neither the rows nor the end of the run decide.
fn numbers(metrics: &Metrics) -> [Option<f64>; 4] {
    [metrics.overshoot_percent, metrics.disturbance_peak_n, metrics.control_peak_v, metrics.rise_time_s]
        .map(Result::ok)
}

fn run_of(text: &str, settings: &[&str]) -> ScenarioRun {
    let mut project = project_of(text, settings);
    project.scenarios.truncate(1);
    simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap().remove(0)
}

fn alike(one: &[Option<f64>; 4], other: &[Option<f64>; 4], part: f64) {
    for (one, other) in one.iter().zip(other) {
        match (one, other) {
            (Some(one), Some(other)) => {
                assert!((one - other).abs() <= part * one.abs().max(1.0), "{one} {other}")
            }
            (one, other) => assert_eq!(one, other),
        }
    }
}

/// A sampled loop, an open one, a motor and a line with waves have the peaks of their first seconds
/// for every duration.
#[test]
fn peaks_do_not_depend_on_how_long_a_run_goes_on() {
    let open = "scenario=[{ name = \"open\", duration = 1, start = { position = \"100 mm\" }, command = [{ at = 0.1, voltage = \"50 mV\" }, { at = 0.2, voltage = 0 }] }]";
    let waves = [
        "line.compliance=by_volume",
        "line.model=transmission_line",
        "controller.numerator=0.0005*s + 0.004",
        "scenario=[{ name = \"waves\", duration = 1, reference = [{ at = 0.1, force = 1000 }] }]",
    ];
    let turn = "scenario=[{ name = \"turn\", duration = 1, reference = [{ at = 0.1, force = 100 }] }]";
    let cases: [(&str, &[&str], [&str; 2]); 4] = [
        (CONTINUOUS, &["controller.sample_time=1 ms"], ["5 s", "12 s"]),
        (CONTINUOUS, &[open], ["2 s", "1e4 s"]),
        (VANE, &[turn], ["2 s", "200 s"]),
        (HOSE, &waves, ["1 s", "2.5 s"]),
    ];
    for (text, settings, durations) in cases {
        let [short, long] = durations.map(|duration| {
            let duration = format!("scenario.0.duration={duration}");
            let rows = "scenario.0.output_step=0.1 s";
            run_of(text, &[settings, &[duration.as_str(), rows]].concat()).windows
        });
        assert_eq!(short.len(), long.len(), "{settings:?}");
        for ((_, short), (_, long)) in short.iter().zip(&long) {
            alike(&numbers(short), &numbers(long), 1e-6);
        }
    }
}

/// A step at a sample acts there, whatever the number of the sample: for the reference, and for the
/// motion of the load, with a delay of the controller and without.
#[test]
fn a_run_that_begins_some_samples_later_is_the_same() {
    let of = |sample_tenths: u32, samples: u32, more: &[&str]| {
        let sample_s = f64::from(sample_tenths) / 1e4;
        let at_s = f64::from(sample_tenths * samples) / 1e4;
        let settings = [
            format!("controller.sample_time={sample_s}"),
            format!("scenario.0.reference=[{{ at = {at_s}, force = \"4 kN\" }}]"),
            format!("scenario.0.load_motion.start={}", f64::from(sample_tenths * (samples + 300)) / 1e4),
            "scenario.0.load_motion.duration=20 ms".to_string(),
            "scenario.0.duration=0.6".to_string(),
            "simulation.tolerance=1e-9".to_string(),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).chain(more.iter().copied()).collect();
        // from rest: only the steps move
        run_of(&CONTINUOUS.replace("start = {", "# {"), &settings).windows
    };
    for (sample_tenths, samples, more) in [
        (7, [23, 41], &[][..]),
        (3, [37, 59], &[]),
        (11, [13, 19], &["controller.delay=0.4 ms"]),
        (9, [29, 31], &["controller.delay=2.7 ms"]),
    ] {
        let [one, other] = samples.map(|samples| of(sample_tenths, samples, more));
        // the second window ends with the run
        let [one, other] = [&one[0].1, &other[0].1].map(numbers);
        alike(&one, &other, 1e-6);
    }
}

/// The text of a comparison contains the statement of a single run on its repetition.
#[test]
fn a_comparison_agrees_with_its_runs() {
    let output = answer(CONTINUOUS, &SLOW, &[], &Request::Simulate(SimulateRequest::default())).text();
    let sentence = output.lines().find(|line| line.contains("of the last two passes")).unwrap().trim();
    let projects = [(); 2].map(|()| load(CONTINUOUS, &SLOW, &[]));
    let compared = command::compare_watched(&Memory::default(), &projects, false, &mut |_| true).unwrap();
    assert!(compared.text().contains(sentence), "{sentence}\n{}", compared.text());
}
