//! The page that decides: what it says is what the commands say, of both controllers, and what to
//! do next follows from it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use phea_qft::verification::Verdict;
use std::fmt::Write as _;

use crate::run_command::{built_hose, contradictory_report};
use phea_workbench::command::{self, Request};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, simulate_project};
use phea_workbench::engineering::trial::Agreement;
use phea_workbench::project::{self, Loaded};
use phea_workbench::report::{DecidedAnswer, Report, report};
use phea_workbench::source::Memory;
use serde_json::Value;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

fn load(source: &Memory, settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn report_of(text: &str, settings: &[&str]) -> Report {
    let source = Memory::default().with("rig.toml", text);
    let loaded = load(&source, settings);
    report(&source, &loaded, &Setup::new(&loaded.project).unwrap(), None, &mut |_| true).unwrap()
}

fn json(source: &Memory, loaded: &Loaded, request: &Request) -> Value {
    parsed(&command::answer(source, loaded, &[], request).unwrap().json)
}

/// The first page without its pictures.
fn opening(report: &Report) -> String {
    let (_, rest) = report.html.split_once("id=\"decision\">").unwrap();
    rest.split("</section>").next().unwrap().to_string()
}

/// The texts of the cells in the rows below a text that begin with this one.
fn rows(page: &str, first: &str) -> Vec<Vec<String>> {
    let cells = |row: &str| -> Vec<String> {
        let row = row.split("</tr>").next().unwrap();
        row.split("<td").skip(1).map(|cell| plain(cell.split_once('>').unwrap().1)).collect()
    };
    let rows = page.split("<tr>").map(cells);
    rows.filter(|cells| cells.first().is_some_and(|cell| cell.starts_with(first))).collect()
}

fn plain(markup: &str) -> String {
    let texts = markup.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text));
    texts.collect::<String>().replace('\u{a0}', " ")
}

fn without(text: &str, first: &str, until: &str) -> String {
    let (before, rest) = text.split_once(first).unwrap();
    format!("{before}{until}{}", rest.split_once(until).unwrap().1)
}

/// The hose with what was measured of its first scenario: what the machine does under the given
/// controller, 30 N too large.
fn measured_hose() -> (Memory, f64) {
    let plain = Memory::default().with("rig.toml", HOSE);
    let run = runs(&plain, &load(&plain, &[])).remove(0);
    let force = run.record.signal(Signal::Force);
    let mut csv = "time_s,force_n\n".to_string();
    let rows = run.record.times_s.iter().zip(&force).step_by(16);
    let (mut least, mut most) = (f64::MAX, f64::MIN);
    for (time_s, force) in rows {
        writeln!(csv, "{time_s:e},{:e}", force + 30.0).unwrap();
        (least, most) = (least.min(*force), most.max(*force));
    }
    let declared = "[[scenario.measured]]\nfile = \"bench.csv\"\nsignals = [{ signal = \"force_n\" }]\n\n";
    let second = "[[scenario]]                             # Figure 6.16";
    let text = HOSE.replacen(second, &format!("{declared}{second}"), 1);
    assert_ne!(text, HOSE);
    (Memory::default().with("rig.toml", text.as_str()).with("bench.csv", csv.as_str()), 30.0 / (most - least))
}

fn runs(source: &Memory, loaded: &Loaded) -> Vec<ScenarioRun> {
    simulate_project(source, &Setup::new(&loaded.project).unwrap(), &mut |_| true)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Proof of an audit in JSON: true if it holds in every part.
fn is_all_proven(answer: &Value) -> bool {
    let each = answer["specifications"].as_array().unwrap().iter().map(|own| &own["proven"]);
    std::iter::once(&answer["proof"]["stable"]["proven"]).chain(each).all(|proven| proven == true)
}

/// The verdict of the nonlinear simulation as the page has it.
fn agreement_words(answer: &Value) -> &str {
    match answer["machine"]["verdict"].as_str().unwrap() {
        "agrees_but_for_settling" => "agrees but for the settling",
        verdict => verdict,
    }
}

/// Compares the words of a controller with those of its audit and of its trial on the machine.
#[track_caller]
fn assert_decided(decided: &DecidedAnswer, audit: &Value, machine: &Value) {
    let verdict = match decided.verdict.unwrap() {
        Verdict::Met => "met",
        Verdict::Violated => "violated",
        Verdict::NotProven => "not_proven",
    };
    let agreement = match decided.machine.unwrap() {
        Agreement::Agrees => "agrees",
        Agreement::AgreesButForSettling => "agrees_but_for_settling",
        Agreement::Differs => "differs",
        Agreement::Contradicts => "contradicts",
    };
    assert_eq!((Some(verdict), Some(agreement)), (audit["verdict"].as_str(), machine["verdict"].as_str()));
}

/// One report of the hose against the commands that it repeats: verdicts of `verify` and `design`,
/// numbers of `simulate`.
#[test]
fn both_controllers_stand_there_as_the_commands_tell_them() {
    let (source, nrmse) = measured_hose();
    let loaded = load(&source, &[]);
    let told = report(&source, &loaded, &Setup::new(&loaded.project).unwrap(), None, &mut |_| true).unwrap();
    let page = opening(&told);

    let verified = json(&source, &loaded, &Request::Verify { proof: false, on_machine: true });
    // what was measured does not take part in a design
    let designed: Value = parsed(&built_hose().json);
    let both = [&verified, &designed["verification"]];
    let verdict = designed["verification"]["verdict"].as_str().unwrap();
    let proven = if is_all_proven(&designed["verification"]) { ", proven" } else { "" };
    let cells = [verified["verdict"].as_str().unwrap().to_string(), format!("{verdict}{proven}")];
    assert_eq!(rows(&page, "every specification")[0][1..], cells);
    let decided = [&told.decision.given, &told.decision.designed];
    let decided_proven = decided.map(|one| one.as_ref().and_then(|one| one.proven));
    assert_eq!(decided_proven, [Some(false), Some(!proven.is_empty())]);
    let machines = [&verified, &designed].map(agreement_words);
    let tried = &rows(&page, "tried on the rig")[0];
    assert!(tried[1].starts_with(machines[0]) && tried[2].starts_with(machines[1]), "{tried:?}");
    for (index, name) in ["1 robust stability", "2 sensitivity", "3 tracking"].iter().enumerate() {
        let row = &rows(&page, name)[0];
        for (cell, answer) in row[1..].iter().zip(both) {
            let verdict = answer["specifications"][index]["verdict"].as_str().unwrap();
            assert!(cell.starts_with(verdict), "{row:?}");
        }
    }
    let decided = told.decision.given.as_ref().unwrap();
    assert_decided(decided, &verified, &verified["machine"]);
    let decided = told.decision.designed.as_ref().unwrap();
    assert_decided(decided, &designed["verification"], &designed["machine"]);

    // the designed project, driven by itself, does what the report says of the designed controller
    let file = told.tables.iter().find(|file| file.name == "designed.toml").unwrap();
    let of_design = source.clone().with("rig.toml", std::str::from_utf8(&file.bytes).unwrap());
    let driven = [runs(&source, &loaded), runs(&of_design, &load(&of_design, &[]))];
    for (runs, name) in driven.iter().zip(["given", "designed"]) {
        let settling_s = runs[0].windows[0].1.settling_time_s.unwrap();
        let (_, card) = page.split_once(&format!("Simulated, {name} controller")).unwrap();
        let card = plain(card.split("</dd>").next().unwrap());
        assert!(
            card.contains(&format!("settling {settling_s:.3} s (1 %); load motion at 3 s")),
            "{card} {settling_s}"
        );
    }
    // measured curve and NRMSE
    let measured: Vec<f64> = driven.iter().map(|runs| runs[0].measured[0].nrmse.unwrap()).collect();
    assert!((measured[0] / nrmse - 1.0).abs() < 1e-2, "{measured:?} {nrmse}");
    let (_, simulation) = told.html.split_once("<section id=\"simulation\">").unwrap();
    let overlays = rows(simulation, "force_n");
    assert_eq!(overlays.len(), 2, "{overlays:?}");
    for ((row, nrmse), name) in overlays.iter().zip(&measured).zip(["given", "designed"]) {
        let shown: f64 = row[3].trim_end_matches(" %").parse().unwrap();
        assert!(row[2] == name && (shown / (100.0 * nrmse) - 1.0).abs() < 5e-3, "{row:?} {nrmse}");
    }
    curves(&told);
}

/// Both controllers and what was measured are in the figures that compare, each controller in those
/// of the inside.
fn curves(report: &Report) {
    let drawing = |name: &str| {
        let found = report.figures.iter().find(|figure| figure.name == name);
        found.unwrap_or_else(|| panic!("no {name}")).to_svg_standalone()
    };
    for name in ["opening_force", "simulation-1", "simulation-1-event-1", "simulation-1-measured"] {
        let drawn = drawing(name);
        for words in [">designed<", ">given<", ">measured<"] {
            assert!(drawn.contains(words), "{name}: {words}");
        }
    }
    assert!(drawing("opening_force").contains("required in time"));
    assert!(drawing("simulation-2").contains(">designed<"));
    for name in ["simulation-1-given-event-1", "simulation-1-designed-event-2", "simulation-2-given-event-7"]
    {
        assert!(drawing(name).contains("hydraulic force"), "{name}");
    }
    let order = [
        "id=\"decision\"",
        "id=\"rig\"",
        "id=\"simulation\"",
        "id=\"design\"",
        "id=\"derived\"",
        "id=\"inside\"",
        "id=\"bounds\"",
    ];
    let places: Vec<usize> = order.iter().map(|anchor| report.html.find(anchor).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
}

#[test]
fn what_to_do_next_follows_from_the_results() {
    let next = |text: &str, settings: &[&str]| report_of(text, settings).decision.next;
    let undesigned = without(HOSE, "[design] ", "[[scenario]]");
    let given = next(&undesigned, &[]);
    assert!(
        given[0].starts_with("The given controller violates 1 robust stability by 19.2 dB at 1304 rad/s"),
        "{given:?}"
    );
    assert!(given[0].contains("and 2 more") && given[0].contains("add `[design]`"), "{given:?}");
    assert!(given.iter().any(|step| step.contains("`[[scenario.measured]]`")), "{given:?}");
    // the family does not hold the rig as it is derived
    assert!(given.iter().any(|step| step.contains("flow_pressure_coefficient is 5.929e-13")), "{given:?}");

    let (still, _) = undesigned.split_once("[[scenario]]").unwrap();
    let undriven = next(still, &[]);
    assert!(undriven.iter().any(|step| step.starts_with("Add a `[[scenario]]`")), "{undriven:?}");

    let unasked = without(still, "[[specification]]", "[controller]");
    assert!(next(&unasked, &[])[0].contains("`[[specification]]`"));

    let contradictory = &contradictory_report().decision.next;
    assert!(contradictory[0].starts_with("Ease ") && contradictory[0].contains(" dB"), "{contradictory:?}");

    let wall = next(still, &["load.model=wall", "load.stiffness=1e6"]);
    assert!(
        wall.iter().any(|step| step.contains("no verdict on the linear loop includes it: load.model")),
        "{wall:?}"
    );
}

/// A page of a rig without a controller has no columns and says so.
#[test]
fn cards_tell_load_lines_and_hose() {
    let (rig, _) = HOSE.split_once("[uncertainty]").unwrap();
    let page = plain(&opening(&report_of(rig, &[])));
    for words in [
        "Load",
        "moves as prescribed, behind 20 kN/mm",
        "Lines",
        "eaton_synflex_3130_08, hose 12.7 mm, 1.5 m each",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let load = [
        "load.model=spring_mass_damper",
        "load.mass=20 kg",
        "load.stiffness=1 MN/m",
        "load.damping=100 N.s/m",
    ];
    let page = plain(&opening(&report_of(rig, &load)));
    assert!(
        page.contains("spring, mass and damper: 20 kg, 1 kN/mm") || page.contains("20 kg, 1 MN/m"),
        "{page}"
    );
}
