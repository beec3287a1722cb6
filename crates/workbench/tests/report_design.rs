//! The chapter on the design: its presence, and its values for both controllers, which are those of
//! their audits.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::{HOSE, contradictory_report, load};
use phea_workbench::command::{CommandError, Progress};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::report::{Report, report};
use phea_workbench::source::Memory;

const PROCESS: &str = include_str!("../../../examples/qft/dead_time.toml");
const UNSTABLE: &str = include_str!("../../../examples/qft/unstable_plant.toml");

/// A single plant and tracking between two lags, with a given controller.
const LAG: &str = r#"
schema = 1
title = "Lag"
[plant]
numerator = "k"
denominator = "s + 10"
[uncertainty]
k = { nominal = 10, minimum = 10, maximum = 20, points = 3 }
[[specification]]
kind = "robust_stability"
limit = 1.3
frequencies = [1, 10, 100]
band = [0, inf]
[[specification]]
kind = "tracking"
upper = "20/(s + 20)"
lower = "400/((s + 4)*(s + 100))"
frequencies = [0.1, 1, 4]
band = [0.1, 4]
[controller]
numerator = "s + 10"
denominator = "s"
[prefilter]
numerator = "6"
denominator = "s + 6"
[design]
maximum_order = 1
prefilter_maximum_order = 1
"#;

fn report_of(project: &str, settings: &[&str]) -> Report {
    let loaded = load(project, settings, &[]);
    report(&Memory::default(), &loaded, &Setup::new(&loaded.project).unwrap(), None, &mut |_| true).unwrap()
}

/// The chapter on the page; `None` without one.
fn chapter(report: &Report) -> Option<&str> {
    let (_, rest) = report.html.split_once("<section id=\"design\">")?;
    rest.split("</section>").next()
}

fn fact(report: &Report) -> Option<&str> {
    report.summary.iter().find(|(name, _)| *name == "Designed controller").map(|(_, text)| text.as_str())
}

fn figures(report: &Report) -> Vec<&str> {
    let names = report.figures.iter().map(|figure| figure.name.as_str());
    names.filter(|name| name.starts_with("design_")).collect()
}

/// The cells of the row that begins with these words.
fn row(chapter: &str, name: &str) -> Vec<String> {
    let rows = chapter.split("<tr>").map(|row| {
        let cells = row.split("<td").skip(1).map(|cell| {
            let (_, text) = cell.split_once('>').unwrap();
            let parts = text.split("</td>").next().unwrap().split('<');
            parts.map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect::<String>()
        });
        cells.collect::<Vec<_>>()
    });
    let mut found = rows.filter(|cells| cells.first().is_some_and(|first| first == name));
    found.next().unwrap_or_else(|| panic!("no row {name}"))
}

/// A project that gives a law and requests no design is audited only.
#[test]
fn a_design_is_part_of_the_report_if_requested_or_no_law_is_stated() {
    let (bare, _) = LAG.split_once("[design]").unwrap();
    let given = report_of(bare, &[]);
    assert!(chapter(&given).is_none() && fact(&given).is_none() && figures(&given).is_empty());
    assert!(given.html.contains("id=\"audit\""));
    let (lawless, _) = bare.split_once("[controller]").unwrap();
    let designed = report_of(lawless, &["design.maximum_order=1", "design.prefilter_maximum_order=1"]);
    assert!(chapter(&designed).is_some() && !designed.html.contains("id=\"audit\""));
    assert!(!chapter(&designed).unwrap().contains(">given<"), "there is nothing to compare with");
    assert!(HOSE.contains("[design]"), "the example shows the published controller next to ours");
}

#[test]
fn both_controllers_are_side_by_side_with_their_audits() {
    let report = report_of(LAG, &[]);
    let chapter = chapter(&report).unwrap();
    assert!(chapter.contains(">given<"));
    // L = k/s: T = k/(s + k) is nowhere above 1, and 1.3 leaves 20 log10(1.3) dB. ORIGIN: analytic
    assert_eq!(row(chapter, "margin of 1 robust stability")[1], "+2.28 dB");
    assert_eq!(row(chapter, "crossover of the nominal loop")[1], "10.0 rad/s");
    assert_eq!(row(chapter, "phase margin of the nominal loop")[1], "90.0 deg");
    assert_eq!(row(chapter, "order of controller and prefilter")[1], "1 and 1");
    // the plant of the family with k = 20 tolerates least delay: pi/2 over its crossover of 20
    // rad/s. ORIGIN: analytic
    assert_eq!(row(chapter, "delay margin of the family")[1], "78.5 ms");
    // |1 + k/s| is nowhere below 1 and tends to it
    let distance: f64 = row(chapter, "modulus margin of the family")[1].parse().unwrap();
    assert!((1.0..1.1).contains(&distance), "{distance}");
    assert_eq!(row(chapter, "verdict").len(), 3);
    assert_eq!(row(chapter, "verdict")[2], "met");
    assert_eq!(fact(&report).map(|text| text.starts_with("met: order ")), Some(true));
    assert_eq!(
        figures(&report),
        [
            "design_nichols",
            "design_1_robust_stability",
            "design_2_tracking",
            "design_2_prefilter",
            "design_steps"
        ]
    );
    for figure in &report.figures {
        assert!(report.html.contains(&format!("<b>{}.</b>", figure.title)), "{}", figure.name);
    }
    assert!(report.tables.iter().any(|file| file.name == "designed.toml"));
    // every limit that the loop touches, once, with the plant in words
    let (_, cost) = chapter.split_once("What the specifications cost").unwrap();
    let (cost, _) = cost.split_once("Rounds of search and audit").unwrap();
    let row = |frequency: &str| cost.matches(&format!("<td class=\"number\">{frequency}</td><td")).count();
    assert_eq!(["0.1", "1", "4", "10", "100"].map(row), [1, 1, 1, 0, 0], "{cost}");
    assert_eq!((cost.matches(">k<").count(), cost.matches("<tr>").count()), (1, 4), "{cost}");
}

/// A sampled loop shows its law as it runs, and next to it the design that was made without
/// samples: that of the project when it is continuous.
#[test]
fn a_sampled_loop_is_reported_with_the_effect_of_sampling() {
    let settings = ["controller.sample_time=\"5 ms\"", "controller.delay=\"2 ms\""];
    let report = report_of(LAG, &settings);
    let chapter = chapter(&report).unwrap();
    for words in ["<i>G</i>(<i>s</i>)", "<i>G</i>(<i>z</i>)", "<i>F</i>(<i>z</i>)", "made without samples"] {
        assert!(chapter.contains(words), "{words}");
    }
    assert_eq!(row(chapter, "verdict").len(), 4);
    let continuous = report_of(LAG, &["controller.delay=\"0 s\""]);
    let only_controller = self::chapter(&continuous).unwrap();
    for name in ["high-frequency gain", "order of controller and prefilter"] {
        let without_samples = row(chapter, name)[3].replace(", of the continuous law", "");
        assert_eq!(without_samples, row(only_controller, name)[2], "{name}");
    }
    assert!(chapter.contains("The last column is the design for the continuous loop without delay"));
}

#[test]
fn unreachable_limits_are_reported_with_their_obstacles() {
    let report = contradictory_report();
    let chapter = chapter(report).unwrap();
    assert!(fact(report).unwrap().starts_with("infeasible by "), "{:?}", fact(report));
    let (_, rest) = chapter.split_once("Conflicting specifications").unwrap();
    let (conflicts, _) = rest.split_once("What the specifications cost").unwrap();
    for words in ["1 sensitivity", "2 robust stability", "dB wider"] {
        assert!(conflicts.contains(words), "{words}: {conflicts}");
    }
    assert!(chapter.contains("S + T = 1") && chapter.contains("callout bad-edge"));
}

#[test]
fn a_search_that_ends_with_nothing_leaves_the_report() {
    let report = report_of(UNSTABLE, &["design.maximum_order=0"]);
    assert!(report.html.contains("id=\"audit\"") && chapter(&report).is_some());
    assert!(fact(&report).is_some());
}

/// Dead time: a rational plant has none of the figures of tracking.
#[test]
fn without_tracking_there_is_neither_prefilter_nor_step() {
    let report = report_of(PROCESS, &["design.maximum_order=1"]);
    let names = figures(&report);
    assert_eq!(names.len(), 4, "{names:?}");
    assert!(names.contains(&"design_nichols") && names.contains(&"design_3_plant_input_disturbance"));
}

#[test]
fn the_search_can_be_stopped() {
    let mut searched = false;
    let mut watch = |progress: Progress| {
        searched = searched || progress.stage.starts_with("trying ");
        !searched
    };
    let loaded = load(LAG, &[], &[]);
    let setup = Setup::new(&loaded.project).unwrap();
    let stopped = report(&Memory::default(), &loaded, &setup, None, &mut watch);
    assert!(matches!(stopped, Err(CommandError::Stopped(_))));
    assert!(searched);
}
