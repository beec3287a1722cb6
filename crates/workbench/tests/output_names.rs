//! The names that a command may write are known before it runs, for every file that it writes.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use phea_workbench::answer::TableFormat;
use phea_workbench::command::{
    self, AlternativesRequest, CampaignRequest, CampaignRuns, FrequencyOptions, OutputNames, Request,
    SimulateRequest,
};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use phea_workbench::engineering::linearize::SweepRequest;
use phea_workbench::engineering::shaping::Shaped;

use super::run_command::{HOSE, load, source};

const LOOP: &str = "schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n[controller]\nnumerator = \"1\"\n\
     denominator = \"s\"\n[[specification]]\nkind = \"robust_stability\"\nlimit = 1.2\nfrequencies = [1]\n\
     band = [0, inf]\n[[alternative]]\nname = \"b/c\"\nset = { \"plant.denominator\" = \"s + 2\" }\n\
     [[alternative]]\nname = \"B_C\"\nset = { \"plant.denominator\" = \"s + 3\" }\n";
const CAMPAIGN: &str = include_str!("../../../examples/benchmark/campaign.toml");
const SHORT: [&str; 2] = ["scenario.0.duration=0.1 s", "scenario.0.reference=[]"];

#[track_caller]
fn all_are_known(project: &str, settings: &[&str], request: &Request) {
    let loaded = load(project, settings, &[]);
    let names = OutputNames::of(&loaded, request);
    let answer = command::answer(&source(project), &loaded, &[], request).unwrap();
    assert!(!answer.files.is_empty(), "{request:?} writes nothing");
    for file in &answer.files {
        assert!(names.contains(&file.name), "{request:?} writes {}", file.name);
        assert!(names.contains(&file.name.to_uppercase()), "{request:?} writes {}", file.name);
    }
    for other in ["rig.toml", "motion.csv", "notes.txt"] {
        assert!(!names.contains(other), "{request:?} writes no {other}");
    }
}

#[test]
fn files_of_the_linear_commands_have_known_names() {
    let sweep = SweepRequest { range: "line.length=1 m..2 m".to_string(), points: Some(2) };
    let requests = [
        Request::Check,
        Request::Size { gain: None, length: None },
        Request::Linearize { sweep: None },
        Request::Linearize { sweep: Some(sweep) },
        Request::Bench,
    ];
    requests.iter().for_each(|request| all_are_known(HOSE, &[], request));
    let requests = [
        Request::Verify { proof: true, on_machine: false },
        Request::Shape { shaped: Shaped::Controller, changes: vec![] },
        Request::Design { seed: None, stages: true, repair: true },
        Request::Report { files: true, alternatives: false },
        Request::Alternatives(AlternativesRequest { files: true, ..AlternativesRequest::default() }),
    ];
    requests.iter().for_each(|request| all_are_known(LOOP, &[], request));
}

#[test]
fn files_of_runs_have_known_names() {
    for table in [TableFormat::Csv, TableFormat::Parquet] {
        let requested = SimulateRequest { table, figures: true, ..SimulateRequest::default() };
        all_are_known(CAMPAIGN, &SHORT, &Request::Simulate(requested.clone()));
        let options = FrequencyOptions { frequencies: Some("10 rad/s".to_string()), ..Default::default() };
        let requested = SimulateRequest { frequency_response: Some(options), ..requested };
        all_are_known(CAMPAIGN, &SHORT, &Request::Simulate(requested));
    }
    let runs = CampaignRuns::All(RequestedRuns { runs: 4, effort: Effort::default() });
    let request = CampaignRequest { seed: 1, runs, files: true };
    all_are_known(CAMPAIGN, &SHORT, &Request::Campaign(request));
    let request = CampaignRequest { seed: 1, runs: CampaignRuns::One(0), files: true };
    all_are_known(CAMPAIGN, &SHORT, &Request::Campaign(request));
}
