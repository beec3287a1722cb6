//! Text and JSON print one answer: every number in a table of the document is a number of the JSON,
//! to the digits that are printed.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{self, CONTRADICTORY, HOSE, PIPE, answer, load};
use crate::{
    alternatives, alternatives_front, friction_identification, line_identification, response_identification,
    valve_identification, valve_in_use,
};
use phea_workbench::answer::{Answer, OutputFile};
use phea_workbench::audit::check_certificate;
use phea_workbench::command::{
    self, CampaignRequest, CampaignRuns, FrequencyOptions, Request, SimulateRequest,
};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::linearize::SweepRequest;
use phea_workbench::engineering::shaping::Shaped;
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const VANE: &str = include_str!("../../../examples/rotary/vane.toml");
const KNEE: &str = include_str!("../../../examples/leg/knee.toml");
const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const SWITCHED: &str = include_str!("../../../examples/ybitu/switched_gas.toml");
const SERIES: &str = include_str!("../../../examples/ybitu/series.toml");
const TELESCOPIC: &str = include_str!("../../../examples/ybitu/telescopic.toml");
const TRANSMISSION: &str = include_str!("../../../examples/ybitu/transmission.toml");
const IMPEDANCE: &str = include_str!("../../../examples/ybitu/variable_impedance.toml");
const SERVO: &str = include_str!("../../../examples/qft/servo.toml");
const BY_HAND: &str = include_str!("../../../examples/qft/by_hand.toml");
const UNSTABLE: &str = include_str!("../../../examples/qft/unstable_plant.toml");
const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");
const REGION: &str = include_str!("../../../examples/structural/rig.toml");

const RIGS: [&str; 10] =
    [HOSE, VANE, KNEE, REGION, GAS, SWITCHED, SERIES, TELESCOPIC, TRANSMISSION, IMPEDANCE];

/// Parts of the places of numbers in documents that the JSON need not have, each with the reason.
const PLACES: [(&str, &str); 0] = [];

/// Texts in cells whose numbers are no values, each with the reason.
const TEXTS: [(&str, &str); 2] =
    [("modulus, least |1 + L|", "a formula"), ("|L| of the nominal loop above 1 again", "a formula")];

/// Beginnings of the names of tables that are not compared, each with the reason.
const FILES: [(&str, &str); 9] = [
    ("leakage", "a recording, in the units of its instruments"),
    ("metering", "a recording"),
    ("pressure_gain", "a recording"),
    ("reversals", "a recording"),
    ("sliding", "a recording"),
    ("breakaway", "a recording"),
    ("shaken", "a recording"),
    ("line_", "a recording"),
    ("frequency_response", "the complex numbers of the JSON in polar form"),
];

/// Columns of tables whose numbers are names, each with the reason.
const COLUMNS: [(&str, &str); 1] = [("equation", "the number of an equation of the thesis")];

/// Lines up to which a table of a file is compared; longer ones are curves and rows of runs.
const LINES: usize = 200;

fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(number) => found.extend(number.as_f64()),
        Value::String(text) if text == "inf" => found.push(f64::INFINITY),
        Value::String(text) if text == "-inf" => found.push(f64::NEG_INFINITY),
        Value::Array(items) => items.iter().for_each(|item| numbers(item, found)),
        Value::Object(members) => members.values().for_each(|member| numbers(member, found)),
        _ => {}
    }
}

/// True if a word of the text is a number.
fn has_number(text: &str) -> bool {
    let is_number = |word: &str| {
        let word = word.trim_matches(|letter: char| !letter.is_alphanumeric());
        word.starts_with(|letter: char| letter.is_ascii_digit()) && word.parse::<f64>().is_ok()
    };
    text.split_whitespace().any(is_number)
}

/// Numbers of the document that the JSON does not have, and numbers without a value.
fn faults(answer: &Answer) -> Vec<String> {
    let mut known = Vec::new();
    numbers(&parsed(&answer.json), &mut known);
    let mut faults = Vec::new();
    for number in answer.document.table_numbers() {
        let near = |known: &&f64| {
            (**known - number.si).abs() <= 0.1 * number.si.abs() + 0.01 || **known == number.si
        };
        let is_known = known.iter().filter(near).any(|known| number.prints(*known));
        if !is_known && !PLACES.iter().any(|(part, _)| number.place.contains(part)) {
            faults.push(format!("{}: {} ({})", number.place, number.text(), number.si));
        }
    }
    for (place, text) in answer.document.table_texts() {
        if has_number(&text) && !TEXTS.iter().any(|(known, _)| text == *known) {
            faults.push(format!("{place}: no value in `{text}`"));
        }
    }
    faults.extend(answer.files.iter().flat_map(|file| faults_of_file(file, &known)));
    faults
}

/// The cells of a line of a table; a comma between quotes separates none.
fn cells(line: &str) -> Vec<&str> {
    let mut is_quoted = false;
    let separates = move |letter: char| {
        is_quoted ^= letter == '"';
        letter == ',' && !is_quoted
    };
    line.split(separates).collect()
}

/// Numbers of a short table that the JSON does not have.
fn faults_of_file(file: &OutputFile, known: &[f64]) -> Vec<String> {
    if !file.name.ends_with(".csv") || FILES.iter().any(|(start, _)| file.name.starts_with(start)) {
        return vec![];
    }
    let text = std::str::from_utf8(&file.bytes).unwrap();
    let mut lines = text.lines();
    let headings = cells(lines.next().unwrap());
    if text.lines().count() > LINES {
        return vec![];
    }
    let mut faults = Vec::new();
    for (heading, cell) in lines.flat_map(|line| headings.iter().copied().zip(cells(line))) {
        let Some(number) = cell.parse::<f64>().ok().filter(|number| !number.is_nan()) else { continue };
        let is_same = |known: &f64| *known == number || (*known - number).abs() <= 1e-12 * number.abs();
        if !known.iter().any(is_same) && !COLUMNS.iter().any(|(name, _)| heading == *name) {
            faults.push(format!("{}, {heading}: {number}", file.name));
        }
    }
    faults
}

#[track_caller]
fn agrees(answer: &Answer) {
    assert_eq!(faults(answer), Vec::<String>::new());
}

#[track_caller]
fn agree(projects: &[&str], settings: &[&str], request: &Request) {
    let of = |project: &&str| faults(&answer(project, settings, &[], request));
    assert_eq!(projects.iter().flat_map(of).collect::<Vec<String>>(), Vec::<String>::new());
}

#[test]
fn check() {
    agree(&[PIPE, SERVO, BENCHMARK], &[], &Request::Check);
    agree(&RIGS, &[], &Request::Check);
}

#[test]
fn size() {
    let request = |gain: Option<&str>, length: Option<&str>| Request::Size {
        gain: gain.map(str::to_string),
        length: length.map(str::to_string),
    };
    agree(&[HOSE], &[], &request(None, None));
    agree(&[HOSE], &[], &request(None, Some("1.5 m")));
}

#[test]
fn linearize() {
    agree(&RIGS, &[], &Request::Linearize { sweep: None });
    let sweep = SweepRequest { range: "line.length=0.5 m..2 m".to_string(), points: Some(4) };
    agree(&[HOSE], &[], &Request::Linearize { sweep: Some(sweep) });
}

#[test]
fn verify() {
    let request = Request::Verify { proof: false, on_machine: false };
    agree(&[HOSE, SERVO, UNSTABLE, VANE], &[], &request);
}

#[test]
fn verify_with_proof() {
    let verified = answer(SERVO, &[], &[], &Request::Verify { proof: true, on_machine: false });
    agrees(&verified);
    let certificate = verified.files.iter().find(|file| file.name.ends_with("certificate.json")).unwrap();
    agrees(&check_certificate(std::str::from_utf8(&certificate.bytes).unwrap()).unwrap());
}

#[test]
fn verify_on_machine() {
    agree(&[HOSE], &[], &Request::Verify { proof: false, on_machine: true });
}

#[test]
fn shape() {
    agree(&[BY_HAND, HOSE], &[], &Request::Shape { shaped: Shaped::Controller, changes: vec![] });
}

#[test]
fn design() {
    agree(&[SERVO, CONTRADICTORY], &[], &Request::Design { seed: None, stages: false, repair: false });
    agrees(run_command::built_hose());
}

#[test]
fn simulate() {
    agree(&[BENCHMARK, VANE, KNEE], &[], &Request::Simulate(SimulateRequest::default()));
    let options =
        FrequencyOptions { frequencies: Some("20, 50 rad/s".to_string()), ..FrequencyOptions::default() };
    let request = SimulateRequest { frequency_response: Some(options), ..SimulateRequest::default() };
    agree(&[BENCHMARK], &[], &Request::Simulate(request));
}

#[test]
fn simulate_with_measurements() {
    let measured = "scenario.0.measured=[{ file = \"bench.csv\", signals = [{ signal = \"force_n\" }] }]";
    let source =
        Memory::default().with("rig.toml", BENCHMARK).with("bench.csv", "time_s,force_n\n0,0\n1,10\n1.5,0\n");
    let loaded = project::read(&source, "rig.toml", &[measured.to_string()], &[]).unwrap();
    agrees(&command::answer(&source, &loaded, &[], &Request::Simulate(SimulateRequest::default())).unwrap());
}

#[test]
fn compare() {
    let projects = [load(BENCHMARK, &[], &[]), load(BENCHMARK, &["line.volume=1.9e-4"], &[])];
    agrees(&command::compare_watched(&Memory::default(), &projects, false, &mut |_| true).unwrap());
}

#[test]
fn campaign() {
    let request = |runs| Request::Campaign(CampaignRequest { seed: 1, runs, files: false });
    let short = [
        "scenario.0.duration=0.4 s",
        "scenario.0.reference.0.at=0.05 s",
        "scenario.0.load_motion.start=0.2 s",
        "scenario.0.load_motion.duration=50 ms",
    ];
    let all = RequestedRuns { runs: 12, effort: Effort { threads: 2, lanes: true } };
    agree(&[CAMPAIGN], &short, &request(CampaignRuns::All(all)));
    agree(&[CAMPAIGN], &short, &request(CampaignRuns::One(1)));
}

#[test]
fn alternatives() {
    agrees(&alternatives::judged().0);
    let request = alternatives_front::front("high_frequency_gain_db,swept:more", "plant.delay=1 ms..20 ms");
    agree(&[alternatives::LOOP], &[], &request);
}

#[test]
fn bench() {
    agree(&[HOSE], &["bench.duration=1 s"], &Request::Bench);
}

#[test]
fn identify() {
    let files = valve_identification::recorded(&[]);
    let request = valve_identification::files_of(&files);
    agrees(&valve_identification::try_request(&files, &request).unwrap());
}

#[test]
fn identified_values_in_use() {
    let source = valve_in_use::source(valve_in_use::IDENTIFIED, valve_in_use::RECORDED.len());
    let answer = command::answer(&source, &valve_in_use::read(&source, &[]), &[], &Request::Check);
    agrees(&answer.unwrap());
}

#[test]
fn identify_friction() {
    agrees(friction_identification::from_all());
}

#[test]
fn identify_line() {
    let files = line_identification::benched(HOSE, &[]);
    agrees(&line_identification::identified(HOSE, &[], &files).unwrap());
}

#[test]
fn identify_response() {
    let rig = response_identification::rig(0.05);
    let table = response_identification::simulated(&rig);
    let found = response_identification::identified(&table, Some(&rig), &response_identification::SETTINGS);
    agrees(&found.unwrap());
}
