//! Campaigns: rows that do not depend on the way in which they are computed or on interruptions,
//! and runs as `simulate` has them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

mod stored;

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use std::fs;
use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use phea_workbench::command::{self, CampaignRequest, CampaignRuns, CommandError, Request};
use phea_workbench::engineering::campaign::{
    CampaignError, Effort, FamilyBox, Plan, RequestedRuns, Row, RowOutcome, RowStore, Summary,
};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{Metric, RunStatus, simulate_project};
use phea_workbench::project::{self, Loaded};
use phea_workbench::source::Memory;
use serde_json::Value;

const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");

/// Settings that make a run short: one step of the force, and a load that moves.
const SHORT: [&str; 4] = [
    "scenario.0.duration=0.4 s",
    "scenario.0.reference.0.at=0.05 s",
    "scenario.0.load_motion.start=0.2 s",
    "scenario.0.load_motion.duration=50 ms",
];

fn source() -> Memory {
    Memory::default().with("campaign.toml", CAMPAIGN)
}

fn load(settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source(), "campaign.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn plan(more: &[&str]) -> Plan {
    let settings = [&SHORT, more].concat();
    Plan::new(&source(), &load(&settings), 1).unwrap()
}

const SCALAR: Effort = Effort { threads: 1, lanes: false };

fn lanes(threads: usize) -> Effort {
    Effort { threads, lanes: true }
}

/// Every machine has identical bits in a single run, in lanes, and on any number of threads; so do
/// those that stop early.
#[test]
fn rows_are_the_same_in_lanes_one_by_one_and_on_any_number_of_threads() {
    let sampled = ["controller.sample_time=1 ms", "force_sensor.noise=2 N"];
    let impedance =
        ["controller.impedance={ stiffness = 1e5, damping = 2e3, mass = 10, filter_time = 2e-3 }"];
    for more in [&[] as &[&str], &sampled, &["simulation.maximum_steps=120"], &impedance] {
        let plan = plan(more);
        let expected = plan.rows(0..45, SCALAR).unwrap();
        assert_eq!(expected.len(), 45);
        let text = plan.table(&expected);
        for threads in [1, 2, 3] {
            assert_eq!(plan.table(&plan.rows(0..45, lanes(threads)).unwrap()), text, "{threads} threads");
        }
        // other neighbours in other lanes
        assert_eq!(plan.rows(7..30, lanes(1)).unwrap(), expected[7..30]);
        let one_by_one = plan.forces(0..45, SCALAR).unwrap();
        let side_by_side = plan.forces(0..45, lanes(1)).unwrap();
        for (one, other) in one_by_one.iter().zip(&side_by_side) {
            assert!(one.len() == other.len() && !one.is_empty());
            assert!(one.iter().zip(other).all(|(one, other)| one.to_bits() == other.to_bits()));
        }
    }
}

/// The campaign without a controller: a command steps to 0.5 V, and the load moves.
fn open_loop() -> (Memory, Loaded) {
    let without = |text: &str, table: &str| {
        let (before, after) = text.split_once(table).unwrap();
        let (_, after) = after.split_once("\n\n").unwrap();
        [before, after].concat()
    };
    let closed = without(&without(CAMPAIGN, "[controller]\n"), "[prefilter]\n");
    let reference = "reference = [{ at = \"2 s\", force = \"4 kN\" }]";
    let command = "command = { at = \"0.05 s\", voltage = \"0.5 V\" }";
    let text = closed.replace(reference, command).replace("\"1 ms\"", "\"0.25 ms\"");
    let source = Memory::default().with("open.toml", text);
    let settings: Vec<String> =
        SHORT.iter().filter(|text| !text.contains("reference")).map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "open.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    (source, loaded)
}

/// Machines driven by a stated command: identical rows in lanes and in single runs, and each as
/// `simulate` has it.
#[test]
fn an_open_loop_is_drawn_as_a_closed_one_is() {
    let (source, loaded) = open_loop();
    let plan = Plan::new(&source, &loaded, 1).unwrap();
    let expected = plan.rows(0..45, SCALAR).unwrap();
    assert!(expected.iter().all(|row| row.status() == RunStatus::Completed));
    for threads in [1, 2] {
        let rows = plan.rows(0..45, lanes(threads)).unwrap();
        assert_eq!(plan.table(&rows), plan.table(&expected), "{threads} threads");
    }
    // no event requests a force
    let header = plan.table(&[]);
    for (event, metric) in [(1, "force_peak_n"), (2, "force_peak_n"), (2, "control_rms_v")] {
        assert!(header.contains(&format!(",event{event}_{metric}")), "{header}");
    }
    assert!(!header.contains("disturbance") && !header.contains("settling") && !header.contains("error"));
    let summary = Summary::of(&plan, &expected);
    let spreads: Vec<usize> = summary
        .metrics
        .iter()
        .map(|of| Metric::ALL.iter().filter(|metric| of[**metric].is_some()).count())
        .collect();
    assert_eq!(spreads, [3, 3]);
    for run in 0..2 {
        let request = CampaignRequest { seed: 1, runs: CampaignRuns::One(run), files: false };
        let answer = command::answer(&source, &loaded, &[], &Request::Campaign(request)).unwrap();
        assert!(answer.text().contains("open loop"), "{}", answer.text());
        let project = plan.settings(&plan.draw(run));
        let settings: Vec<String> = SHORT
            .iter()
            .filter(|text| !text.contains("reference"))
            .map(|text| (*text).to_string())
            .chain(project)
            .collect();
        let drawn = project::read(&source, "open.toml", &settings, &[]).unwrap();
        let simulated =
            simulate_project(&source, &Setup::new(&drawn.project).unwrap(), &mut |_| true).unwrap().remove(0);
        let force_n = plan.forces(run..run + 1, lanes(1)).unwrap().remove(0);
        let seen = simulated.record.signal(Signal::Force);
        assert_eq!((simulated.samples_per_row, seen.len()), (1, force_n.len()));
        assert!(seen.iter().zip(&force_n).all(|(one, other)| one.to_bits() == other.to_bits()), "run {run}");
        let row = &expected[run as usize];
        for ((_, metrics), numbers) in simulated.windows.iter().zip(&row.ran().unwrap().metrics) {
            let of = |metric: Metric| numbers[metric];
            assert_eq!(metrics.force_peak_n.ok(), of(Metric::ForcePeak));
            assert!(metrics.force_peak_n.is_ok() && of(Metric::ControlPeak) == Some(0.5));
        }
    }
}

/// More runs than a thread takes at once: the rows of several batches come in their order.
#[test]
fn batches_come_in_their_order_on_any_number_of_threads() {
    let plan = plan(&["scenario.0.duration=0.1 s"]);
    let expected = plan.table(&plan.rows(0..1200, lanes(1)).unwrap());
    for threads in [2, 5] {
        assert!(plan.table(&plan.rows(0..1200, lanes(threads)).unwrap()) == expected, "{threads} threads");
    }
}

/// A run, written as settings, is an identical machine for `simulate`: if both have equal output
/// steps, the bits of the force are identical.
#[test]
fn a_run_equals_simulate_with_its_settings() {
    let often = "scenario.0.output_step=0.25 ms";
    for more in [&[often] as &[&str], &[often, "controller.sample_time=1 ms", "force_sensor.noise=2 N"]] {
        let settings = [&SHORT, more].concat();
        let plan = plan(more);
        let forces = plan.forces(0..3, lanes(1)).unwrap();
        for (run, force_n) in forces.iter().enumerate() {
            let drawn = plan.settings(&plan.draw(run as u64));
            let all: Vec<&str> = settings.iter().copied().chain(drawn.iter().map(String::as_str)).collect();
            let simulated =
                simulate_project(&source(), &Setup::new(&load(&all).project).unwrap(), &mut |_| true)
                    .unwrap()
                    .remove(0);
            let seen = simulated.record.signal(Signal::Force);
            assert_eq!((simulated.samples_per_row, seen.len()), (1, force_n.len()));
            assert!(
                seen.iter().zip(force_n).all(|(one, other)| one.to_bits() == other.to_bits()),
                "run {run}"
            );
            let row = plan.rows(run as u64..run as u64 + 1, lanes(1)).unwrap().remove(0);
            for ((_, metrics), numbers) in simulated.windows.iter().zip(&row.ran().unwrap().metrics) {
                let of = |metric: Metric| numbers[metric];
                assert_eq!(metrics.disturbance_peak_n.ok(), of(Metric::DisturbancePeak));
                assert_eq!(metrics.rise_time_s.ok(), of(Metric::RiseTime));
                // the command is an equal sum in another order
                let peaks = metrics.control_peak_v.ok().zip(of(Metric::ControlPeak));
                assert!(peaks.is_some_and(|(one, other)| (one - other).abs() < 1e-9 * one), "{peaks:?}");
            }
        }
    }
}

/// A table in memory.
#[derive(Default)]
struct Page {
    text: String,
}

impl RowStore for Page {
    fn stored(&mut self) -> Result<String, String> {
        Ok(self.text.clone())
    }

    fn cut(&mut self, bytes: usize) -> Result<(), String> {
        self.text.truncate(bytes);
        Ok(())
    }

    fn append(&mut self, text: &str) -> Result<(), String> {
        self.text.push_str(text);
        Ok(())
    }
}

fn request(runs: u64) -> CampaignRequest {
    let wanted = RequestedRuns { runs, effort: lanes(2) };
    CampaignRequest { seed: 1, runs: CampaignRuns::All(wanted), files: false }
}

fn resumed(loaded: &Loaded, request: &CampaignRequest, page: &mut Page) -> Result<String, CommandError> {
    command::campaign_watched(&source(), loaded, &[], request, (Some(page), None), &mut |_| true)
        .map(|answer| answer.json)
}
/// Errors of 200 runs: half of all stay within 0.02 N of the runs at a tolerance of 1e-10, and all
/// but two within 0.2 N.
#[test]
fn the_error_of_the_force_is_within_the_stated_one() {
    let of = |settings: &[&str]| {
        let plan = Plan::new(&source(), &load(settings), 1).unwrap();
        plan.forces(0..200, lanes(2)).unwrap()
    };
    let (found, exact) = (of(&[]), of(&["simulation.tolerance=1e-10"]));
    let mut errors: Vec<f64> = found
        .iter()
        .zip(&exact)
        .map(|(one, other)| {
            assert!(one.len() == 5001 && other.len() == 5001);
            one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    assert!(0.5 * (errors[99] + errors[100]) <= 0.02 && errors[197] <= 0.2, "{errors:?}");
}

/// A mass drawn below zero, and static friction drawn below Coulomb's, give rows with the reason.
#[test]
fn impossible_draws_are_reported_with_their_index() {
    let mass = "campaign.parameters.\"cylinder.moving_mass\"={ minimum = 1, maximum = 9, distribution = \"normal\" }";
    let static_friction = "campaign.parameters.\"cylinder.friction.static\"={ minimum = 70, maximum = 150 }";
    let plan = plan(&[mass, static_friction]);
    let rows = plan.rows(0..200, lanes(1)).unwrap();
    let place = |path: &str| plan.ranges().iter().position(|range| range.path == path).unwrap();
    let [mass, static_friction, coulomb] =
        ["cylinder.moving_mass", "cylinder.friction.static", "cylinder.friction.coulomb"].map(place);
    let impossible = |row: &Row| row.values[mass] <= 0.0 || row.values[static_friction] < row.values[coulomb];
    let mut refused = 0;
    for (index, row) in rows.iter().enumerate() {
        assert_eq!((row.run, &row.values), (index as u64, &plan.draw(index as u64).values));
        match &row.outcome {
            RowOutcome::Refused(reason) => {
                refused += 1;
                assert!(
                    impossible(row) && (reason.contains("moving_mass") || reason.contains("friction")),
                    "{reason}"
                );
            }
            RowOutcome::Driven(_) => assert!(!impossible(row)),
        }
    }
    let summary = Summary::of(&plan, &rows);
    assert!(refused > 3 && summary.refused.len() == refused);
    assert_eq!(summary.statuses.iter().sum::<usize>(), 200);
    assert_eq!(
        summary.statuses[RunStatus::OF_ROWS.iter().position(|one| *one == RunStatus::Refused).unwrap()],
        refused
    );
}

/// The lumped parameters of a draw are those that `linearize` finds with its settings.
#[test]
fn lumps_are_those_of_the_drawn_linear_model() {
    let plan = plan(&[]);
    for row in plan.rows(0..3, lanes(1)).unwrap() {
        let drawn = plan.settings(&plan.draw(row.run));
        let all: Vec<&str> = SHORT.iter().copied().chain(drawn.iter().map(String::as_str)).collect();
        let linear = phea_workbench::engineering::setup::Setup::rig_of(&load(&all).project).unwrap().derived;
        let expected = [linear.hydraulic_stiffness, linear.flow_gain, linear.flow_pressure_coefficient];
        assert_eq!(row.lumps, Some(expected));
    }
}

#[test]
fn the_start_can_vary_and_fixed_keys_are_refused() {
    let plan = plan(&["campaign.parameters.\"start.position\"={ spread = \"50 %\" }"]);
    let place = plan.ranges().iter().position(|range| range.path == "start.position").unwrap();
    assert_eq!((plan.ranges()[place].minimum, plan.ranges()[place].maximum), (0.125, 0.375));
    let rows = plan.rows(0..20, lanes(1)).unwrap();
    assert!(rows.iter().all(|row| row.status() == RunStatus::Completed));
    let refused = |settings: &[&str]| {
        let loaded = load(&[&SHORT, settings].concat());
        Plan::new(&source(), &loaded, 1).map(|_| ()).unwrap_err()
    };
    let velocity = "start.velocity".to_string();
    assert_eq!(
        refused(&["campaign.parameters.\"start.velocity\"={ spread = \"50 %\" }"]),
        CampaignError::NotStated { path: velocity }
    );
    let bare = CAMPAIGN.split("[campaign]").next().unwrap();
    let source = Memory::default().with("bare.toml", bare);
    let loaded = project::read(&source, "bare.toml", &[], &[]).unwrap();
    assert_eq!(Plan::new(&source, &loaded, 1).map(|_| ()).unwrap_err(), CampaignError::Absent);
    let request = Request::Campaign(request(3));
    let error = command::answer(&source, &loaded, &[], &request).unwrap_err();
    assert!(command::error_json(&loaded, &request, &error).contains("the project has no [campaign]"));
}

#[test]
fn the_keys_of_the_answer_are_stable() {
    let loaded = load(&SHORT);
    let request = Request::Campaign(CampaignRequest { files: true, ..request(12) });
    let answer = command::answer(&source(), &loaded, &[], &request).unwrap();
    let json: Value = parsed(&answer.json);
    assert_eq!((&json["command"], &json["seed"]), (&Value::from("campaign"), &Value::from(1)));
    assert_eq!(json["statuses"]["completed"], 12);
    let metrics = json["metrics"].as_array().unwrap();
    assert_eq!(metrics.len(), 2);
    for metric in metrics.iter().flat_map(|event| event["metrics"].as_array().unwrap()) {
        let numbers: Vec<f64> = metric["quantiles"]
            .as_array()
            .into_iter()
            .flatten()
            .map(|value| value.as_f64().unwrap())
            .collect();
        assert!(numbers.windows(2).all(|pair| pair[0] <= pair[1]), "{metric}");
        assert_eq!(metric["count"].as_u64().unwrap() + metric["missing"].as_u64().unwrap(), 12);
    }
    let times = json["bands"]["time_s"].as_array().unwrap().len();
    let bands = json["bands"]["force_n"].as_array().unwrap();
    assert!(bands.len() == 5 && bands.iter().all(|band| band.as_array().unwrap().len() == times));
    assert!(json["worst_runs"][0]["settings"][0].as_str().unwrap().starts_with("supply.pressure="));
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    assert!(names.contains(&"runs.parquet") && names.contains(&"campaign-bands.svg"), "{names:?}");
}

/// The tables agree cell by cell, rejected draws included.
#[test]
fn the_parquet_table_agrees_with_the_text() {
    let mass = "campaign.parameters.\"cylinder.moving_mass\"={ minimum = 0.001, maximum = 3, distribution = \"normal\" }";
    let loaded = load(&[&SHORT as &[&str], &[mass]].concat());
    let requested = CampaignRequest { files: true, ..request(300) };
    let mut page = Page::default();
    let mut go_on = |_| true;
    let answer =
        command::campaign_watched(&source(), &loaded, &[], &requested, (Some(&mut page), None), &mut go_on)
            .unwrap();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("campaign.parquet");
    fs::write(&path, &answer.files.iter().find(|file| file.name == "runs.parquet").unwrap().bytes).unwrap();
    let reader = SerializedFileReader::new(fs::File::open(&path).unwrap()).unwrap();
    let mut lines = page.text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut rows = 0;
    for (line, row) in lines.zip(reader.get_row_iter(None).unwrap()) {
        let row = row.unwrap();
        let fields: Vec<(&String, &Field)> = row.get_column_iter().collect();
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!((fields.len(), cells.len()), (names.len(), names.len()));
        for ((name, cell), (field_name, field)) in names.iter().zip(cells).zip(fields) {
            assert_eq!(name, field_name);
            let same = match field {
                Field::Null => cell.is_empty(),
                Field::Long(value) => cell.parse() == Ok(*value),
                Field::Double(value) => cell.parse() == Ok(*value),
                Field::Float(value) => cell.parse() == Ok(*value),
                Field::Str(text) => cell.trim_matches('"') == text,
                _ => false,
            };
            assert!(same, "{name}: {cell} {field}");
        }
        rows += 1;
    }
    assert_eq!(rows, 300);
    assert!(page.text.contains(",refused,"));
}

/// Quantiles are of the runs that have a number; those that do not settle within their window are
/// counted next to the quantiles.
#[test]
fn runs_that_do_not_settle_are_counted_next_to_the_quantiles() {
    let loaded = load(&SHORT);
    let requested = Request::Campaign(request(20));
    let answer = command::answer(&source(), &loaded, &[], &requested).unwrap();
    let json: Value = parsed(&answer.json);
    let events = json["metrics"].as_array().unwrap();
    let settling = |event: &Value| {
        let metrics = event["metrics"].as_array().unwrap();
        let found = metrics.iter().find(|metric| metric["name"] == "settling_time_s").unwrap();
        found["missing"].as_u64().unwrap()
    };
    let missing: Vec<u64> = events.iter().map(settling).collect();
    assert!(missing.iter().any(|missing| *missing > 1), "{missing:?}");
    for missing in missing.iter().filter(|missing| **missing > 1) {
        let words = format!("settling to 1 % (s); {missing} of 20 do not settle within their window");
        assert!(answer.text().contains(&words), "{}", answer.text());
    }
}

/// A loop that overshoots, and a band within which no step ends.
const OVERSHOOTING: [&str; 4] = [
    "controller.numerator=0.001*s + 0.05",
    "prefilter.numerator=1",
    "prefilter.denominator=1",
    "scenario.0.settling_band_percent=1e-6",
];

/// Runs none of which settles are equal in settling time: the worst of them is the one with the
/// largest overshoot.
#[test]
fn the_worst_of_runs_that_do_not_settle_overshoots_most() {
    let band = "settling_band_percent = 1e-6";
    let required = format!(
        "[[specification]]\nkind = \"step\"\novershoot_percent = 1\nsettling_time = \"10 ms\"\n{band}\n"
    );
    let source = source().with("required.toml", format!("{CAMPAIGN}\n{required}").as_str());
    let settings = [&SHORT[..], &OVERSHOOTING].concat();
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "required.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&source, &loaded, 1).unwrap();
    let requested = RequestedRuns { runs: 20, effort: lanes(1) };
    let rows =
        phea_workbench::engineering::campaign::campaign(&plan, requested, None, &mut |_| true).unwrap();
    let summary = Summary::of(&plan, &rows);
    let (run, reached) = summary.requirements[0].judged.unwrap().worst.unwrap();
    assert_eq!(reached.settling_time_s, f64::INFINITY);
    let overshoots: Vec<f64> =
        rows.iter().map(|row| row.ran().unwrap().metrics[0][Metric::Overshoot].unwrap()).collect();
    let most = overshoots.iter().copied().fold(0.0, f64::max);
    assert!(overshoots[0] < most, "the first run is not the worst: {overshoots:?}");
    assert_eq!((reached.overshoot_percent, overshoots[run as usize]), (most, most));
}

/// Errors in `[campaign]` are reported once, at their place in the text.
#[test]
fn refusals_of_a_campaign_have_their_place_and_a_hint() {
    let refused = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
        let report = project::read(&source(), "campaign.toml", &settings, &[]).map(|_| ()).unwrap_err();
        report.to_string()
    };
    let pressure = |table: &str| format!("campaign.parameters.\"supply.pressure\"={table}");
    for (table, words) in [
        ("{ spread = \"-20 %\" }", "`spread` must be above 0"),
        ("{ spread = \"20 bar\" }", "bar"),
        ("{ minimum = \"90 bar\", maximum = \"60 bar\" }", "`minimum`, 90 bar, is above `maximum`, 60 bar"),
        ("{ minimum = \"-5 bar\", maximum = \"60 bar\" }", "`minimum` must be"),
    ] {
        let text = refused(&[&pressure(table)]);
        assert!(text.contains(words) && text.matches("error").count() == 1, "{text}");
        assert!(text.contains("--> --set campaign.parameters"), "{text}");
    }
    let text = refused(&["campaign.distribution=gaussian"]);
    assert!(text.contains("did you mean \"normal\"?"), "{text}");
    let text = refused(&["campaign.scenario=step and laod motion"]);
    assert!(text.contains("did you mean \"step and load motion\"?"), "{text}");
    let loaded = load(&[&pressure("{ spread = 20 }")]);
    assert!(loaded.warnings.iter().any(|warning| warning.message.contains("`spread` is 2000 %")));
    let loaded = load(&[&pressure("{ spread = 1 }")]);
    assert!(!loaded.warnings.iter().any(|warning| warning.message.contains("`spread`")));
}

/// Drawn numbers are compared with the box one by one: a range within it is not mentioned, a wider
/// one with both ranges, and a number that is not in it is reported as such.
#[test]
fn numbers_that_are_drawn_beyond_the_box_are_named() {
    const RIG: &str = include_str!("../../../examples/structural/rig.toml");
    let text = format!(
        "{RIG}\n[campaign]\n[campaign.parameters]\n\"supply.pressure\" = {{ minimum = \"180 bar\", maximum = \"231 bar\" }}\n\
         \"load.stiffness\" = {{ minimum = \"5 kN/mm\", maximum = \"30 kN/mm\" }}\n\
         \"valve.natural_frequency\" = {{ spread = \"20 %\" }}\n"
    );
    let source = Memory::default().with("rig.toml", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&source, &loaded, 1).unwrap();
    assert_eq!(plan.box_of_family(), FamilyBox::Numbers);
    let beyond = plan.beyond_box();
    let paths: Vec<&str> = beyond.iter().map(|one| one.range.path.as_str()).collect();
    assert_eq!(paths, ["supply.pressure", "valve.natural_frequency"]);
    let [low, high] = beyond[0].designed_for.unwrap();
    assert!((low - 189e5).abs() < 1.0 && (high - 231e5).abs() < 1.0);
    assert_eq!(beyond[1].designed_for, None);
}
