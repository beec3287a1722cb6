//! A rig that rests at null between unequal edges has the plants of both sides in its family.

#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::HOSE;
use phea_dynamics::uncertain_plant::{PlantMember, UncertainPlant};
use phea_dynamics::watch::unwatched;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::verification::{PlantPoint, Verdict};
use phea_workbench::engineering::audit::{ProjectAudit, audit_project};
use phea_workbench::engineering::family::{family, visited_box};
use phea_workbench::engineering::plant_names::PlantNames;
use phea_workbench::engineering::rig::Rig;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::plant_names::plant_text;
use phea_workbench::project::{self, Project};
use phea_workbench::quantity::{VELOCITY, parse};
use phea_workbench::source::Memory;

const SIDE: &str = "operating_point.spool_side";
/// Frequencies from below the hydraulic pole to above the piston on its load cell, rad/s.
const FREQUENCIES: [f64; 5] = [0.01, 3.0, 80.0, 1300.0, 6000.0];

/// The hose with these tables instead of `[sizing]` and `[uncertainty]`.
fn loaded(tables: &str, settings: &[&str]) -> Project {
    changed(HOSE, tables, settings)
}

fn changed(hose: &str, tables: &str, settings: &[&str]) -> Project {
    let (start, rest) = hose.split_once("[sizing]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let text = format!("{start}{tables}\n[[specification]]{end}");
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    let source = Memory::default().with("p.toml", text.as_str());
    project::read(&source, "p.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

fn family_of(project: &Project) -> UncertainFamily {
    match family(&Setup::new(project).unwrap(), &Memory::default()).unwrap_or_else(|error| panic!("{error}"))
    {
        Family::Uncertain(family) => family,
        Family::Measured(_) => panic!("nothing was measured"),
    }
}

fn rig(project: &Project, numbers: &[(&str, f64)]) -> Rig {
    let plain = Project { uncertainty: vec![], family: None, ..project.clone() };
    Setup::rig_of(&plain.with_numbers(numbers).unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

/// The response of a plant of the family at these values.
fn response(plant: &UncertainPlant, values: &[f64], frequency: f64) -> [f64; 2] {
    let response = match plant.member(values).unwrap() {
        PlantMember::Responding(plant) => plant.response(frequency)[0],
        PlantMember::Rational(plant) => plant.command.at_frequency(frequency),
    };
    [response.re, response.im]
}

/// The ends of the side are the plants of rigs whose spool is a little above and a little below
/// null, where there is no side to choose: their load differs a little from the one at null.
#[track_caller]
fn ends_are_both_limits(project: &Project) {
    let family = family_of(project);
    let names: Vec<&str> = family.plant().parameters().iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, [SIDE]);
    assert_eq!(family.plant().nominal(), [0.0]);
    let null = rig(project, &[]).point;
    assert_eq!(null.command, 0.0);
    for side in [-1.0, 1.0] {
        let next_to_null = rig(project, &[("operating_point.load_pressure", null.load_pressure() + side)]);
        assert!(
            next_to_null.point.command * side > 0.0 && next_to_null.point.command.abs() < 1e-6,
            "{:?}",
            next_to_null.point
        );
        for frequency in FREQUENCIES {
            let [re, im] = response(family.plant(), &[side], frequency);
            let limit = next_to_null.response(frequency);
            let apart = ((re - limit.re).powi(2) + (im - limit.im).powi(2)).sqrt() / limit.norm_sqr().sqrt();
            assert!(apart < 1e-4, "{side} {frequency}: {apart}");
        }
        // no other plant of the family is a mean that is not the mean of both
        let [mean, own, other] = [0.0, side, -side].map(|side| response(family.plant(), &[side], 3.0));
        assert!((mean[1] - 0.5 * (own[1] + other[1])).abs() < 1e-9 * mean[1].abs());
        assert!((own[1] / other[1] - 1.0).abs() > 0.1, "{own:?} {other:?}");
    }
}

#[test]
fn lumped_chambers_have_both_sides() {
    ends_are_both_limits(&loaded("", &[]));
    ends_are_both_limits(&loaded(
        "",
        &["valve.leakage_model=\"one_curve\"", "supply.tank_pressure=\"3 bar\""],
    ));
}

#[test]
fn unequal_areas_and_leakage_have_both_sides() {
    let (start, rest) = HOSE.split_once("rod_diameter = \"22 mm\"\n").unwrap();
    let text = format!("{start}rod_diameters = [\"0 mm\", \"22 mm\"]\ninternal_leakage = 1e-12\n{rest}");
    ends_are_both_limits(&changed(&text, "", &[]));
}

#[test]
fn lines_in_motion_have_both_sides() {
    ends_are_both_limits(&loaded("", &["line.model=\"transmission_line\""]));
}

/// A side is added if it changes a plant and is not stated.
#[test]
fn nothing_is_added_where_nothing_jumps() {
    let names = |project: &Project| -> Vec<String> {
        family_of(project).plant().parameters().iter().map(|one| one.name.clone()).collect()
    };
    let edges = |kind: &str, value: f64| {
        format!(
            "valve.{kind}={{ supply_to_a = {value}, a_to_tank = {value}, supply_to_b = {value}, b_to_tank = {value} }}"
        )
    };
    let [flow, leak] = [edges("flow_coefficients", 3e-7), edges("leakage_coefficients", 2.4e-9)];
    assert!(names(&loaded("", &[&flow, &leak])).is_empty());
    assert!(names(&loaded("", &["operating_point.spool_side=-1"])).is_empty());
    assert!(names(&loaded("", &["operating_point.command=0.003"])).is_empty());
    assert!(names(&loaded("[linear]\nflow_gain = 5e-5\n", &[])).is_empty());
    let supply = "[uncertainty]\n\"supply.pressure\" = { nominal = 70e5, minimum = 60e5, maximum = 80e5, points = 2 }\n";
    assert_eq!(names(&loaded(supply, &[])), ["supply.pressure", SIDE]);
    // equal edges that are uncertain are unequal in the box
    let edge = "[uncertainty]\n\"valve.flow_coefficients.supply_to_a\" = { nominal = 3e-7, minimum = 2.5e-7, maximum = 3.5e-7, points = 2 }\n";
    assert_eq!(names(&loaded(edge, &[&flow, &leak])), ["valve.flow_coefficients.supply_to_a", SIDE]);
}

/// Explicit cases are plants on both sides, and nothing else.
#[test]
fn explicit_cases_are_on_both_sides() {
    let cases =
        "[family]\ncases = [{ \"supply.pressure\" = \"60 bar\" }, { \"supply.pressure\" = \"70 bar\" }]\n";
    let family = family_of(&loaded(cases, &[]));
    assert_eq!(family.extent(), Extent::Members);
    for pressure in [60e5, 70e5] {
        for side in [-1.0, 0.0, 1.0] {
            assert!(family.members().contains(&vec![pressure, side]), "{pressure} {side}");
        }
    }
    assert_eq!(family.members().len(), 6);
}

fn audited(project: &Project) -> ProjectAudit {
    audit_project(&Memory::default(), &Setup::new(project).unwrap(), &mut unwatched)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A loop that the mean satisfies and one side does not is violated, at that side; the worst margin
/// of the family is that of its worse side.
#[test]
fn the_verdict_is_that_of_the_worse_side() {
    let worst_of = |hose: &str, settings: &[&str]| {
        let found = audited(&changed(hose, "", settings)).audit;
        let worst = found.specifications[0].worst.clone().unwrap();
        (worst.margin_db, worst.plant, found.specifications[0].verdict)
    };
    let worst = |settings: &[&str]| worst_of(HOSE, settings);
    let (mean, ..) = worst(&["operating_point.spool_side=0"]);
    let (below, ..) = worst(&["operating_point.spool_side=-1"]);
    let (above, ..) = worst(&["operating_point.spool_side=1"]);
    let (both, plant, _) = worst(&[]);
    assert!(both < mean && (both - below.min(above)).abs() < 1e-3, "{both} {mean} {below} {above}");
    let side = if below < above { -1.0 } else { 1.0 };
    assert_eq!(plant, PlantPoint::Parameters(vec![side]));
    // a limit between the margins of the mean and of the worse side
    let limit = 1.3 * 10_f64.powf(-0.025 * (mean + both));
    let between = HOSE.replace("limit = 1.3\n", &format!("limit = {limit}\n"));
    assert_eq!(worst_of(&between, &["operating_point.spool_side=0"]).2, Verdict::Met);
    assert_eq!(worst_of(&between, &[]).2, Verdict::Violated);
}

/// The box printed by `check` has both sides as its ends.
#[test]
fn the_box_that_is_printed_has_both_sides() {
    let project = loaded("", &[]);
    let ranges = visited_box(&Setup::new(&project).unwrap()).unwrap().unwrap();
    let gain = ranges.iter().find(|one| one.name == "flow_gain").unwrap();
    let [below, above] = rig(&project, &[]).null_flow_gains().unwrap();
    assert!((gain.minimum.value / below.min(above) - 1.0).abs() < 1e-12);
    assert!((gain.maximum.value / below.max(above) - 1.0).abs() < 1e-12);
    assert!(gain.minimum.at.iter().any(|(name, _)| name == SIDE));
}

/// The members of a family next to null read back from the printed values as identical plants: with
/// four digits half of them would be on the other side, where K_qU differs by a quarter.
#[test]
fn a_place_next_to_null_reads_back_on_its_own_side() {
    let region = "[family.operating_region]\nvelocity = [\"-1.1 mm/s\", \"0.7 mm/s\"]\n";
    let project = loaded(region, &["operating_point.load_force=2.3456 kN"]);
    let family = family_of(&project);
    let names: Vec<&str> = family.plant().parameters().iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["operating_point.velocity"]);
    let printed = PlantNames::of_parameters(&project, names.into_iter());
    assert!(family.members().len() > 1, "{:?}", family.members());
    for values in family.members() {
        let text = plant_text(&printed, &PlantPoint::Parameters(values.clone()));
        let read = parse(text.strip_prefix("operating_point.velocity ").unwrap(), &VELOCITY).unwrap();
        let [own, again] = [values[0], read].map(|value| response(family.plant(), &[value], 3.0));
        let apart = (own[0] - again[0]).hypot(own[1] - again[1]) / own[0].hypot(own[1]);
        assert!(apart < 1e-3, "{text} for {values:?}: {apart}");
    }
    let corner = plant_text(&printed, &PlantPoint::Parameters(vec![-1.1e-3]));
    assert_eq!(corner, "operating_point.velocity -1.1 mm/s");
}
