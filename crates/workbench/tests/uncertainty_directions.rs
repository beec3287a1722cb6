//! Numbers that are uncertain together: the family of an identified valve compared with draws from
//! its covariance, and the directions that a project file may state.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use std::sync::OnceLock;

use crate::run_command::HOSE;
use crate::valve_identification::recorded;
use nalgebra::{DMatrix, DVector};
use phea_dynamics::random::{normal, stream};
use phea_hydraulics::servovalve::STATIC_COEFFICIENTS;
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::template::{TemplateOptions, template};
use phea_workbench::family::{family, visited_box};
use phea_workbench::identify::{
    COEFFICIENT_NAMES, Identification, JointRegion, JointRegionError, Known, Search, identify, joint_region,
    recordings, with_valve,
};
use phea_workbench::project::{self, Project};
use phea_workbench::replaced::{replaced_ranges, template_areas};
use phea_workbench::robust::robust_problem;
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

/// Number of coefficients on which the plant depends.
const COUNT: usize = 9;

fn read(text: &str) -> Result<Project, String> {
    let source = Memory::default().with("p.toml", text);
    project::read(&source, "p.toml", &[], &[]).map(|read| read.project).map_err(|report| report.to_string())
}

/// The rig with no uncertainty except its operating point.
fn rig() -> Project {
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let region =
        "[family.operating_region]\nload_force = [\"-4 kN\", \"4 kN\"]\nvelocity = [\"-1 m/s\", \"1 m/s\"]\n";
    read(&format!("{start}{region}\n[[specification]]{end}")).unwrap()
}

/// The valve of Table 5.1, identified from a noisy bench.
fn identification() -> &'static Identification {
    static FOUND: OnceLock<Identification> = OnceLock::new();
    FOUND.get_or_init(|| {
        let files = recorded(&[
            "bench.sample_time=2",
            "bench.pressure_noise=1 bar",
            "bench.leak_meter.noise=0.05 L/min",
            "bench.flow_meter.noise=0.5 L/min",
        ]);
        let source =
            files.iter().fold(Memory::default(), |source, (name, text)| source.with(name, text.as_str()));
        let names: Vec<String> = files.iter().map(|(name, _)| name.clone()).collect();
        let known = Known { supply_pressure: Some(70e5), tare_pressure: Some(70e5), ..Known::default() };
        let files: Vec<_> =
            names.iter().map(|name| phea_workbench::project::RecordedTest::of(name)).collect();
        let search = Search { starts: 1, ..Search::default() };
        identify(recordings(&source, &files, &known).unwrap().recordings, &known, search, &mut |_| true)
            .unwrap()
    })
}

fn with_directions(region: &JointRegion) -> Project {
    let mut project = with_valve(&rig(), identification()).unwrap();
    project.directions.clone_from(&region.directions);
    project
}

fn members(project: &Project) -> UncertainFamily {
    let found = family(&Setup::new(project).unwrap(), &Memory::default());
    match found.unwrap_or_else(|error| panic!("{error}")) {
        Family::Uncertain(family) => family,
        Family::Measured(_) => panic!("nothing was measured"),
    }
}

fn covariance(found: &Identification) -> DMatrix<f64> {
    DMatrix::from_fn(COUNT, COUNT, |i, j| {
        found.deviations[i] * found.deviations[j] * found.correlations[i * COEFFICIENT_NAMES.len() + j]
    })
}

/// The change of each coefficient with each direction.
fn changes(region: &JointRegion) -> DMatrix<f64> {
    DMatrix::from_fn(COUNT, region.directions.len(), |i, j| {
        let path = format!("valve.{}", COEFFICIENT_NAMES[i].0);
        let numbers = &region.directions[j].changes.numbers;
        numbers.iter().find(|(name, _)| *name == path).map_or(0.0, |(_, change)| *change)
    })
}

/// Nine directions, all of them, are the rotated covariance: the product of their changes with its
/// transpose gives it again, and 95 % of draws from it are in the family, whose box is smaller than
/// that of independent intervals.
#[test]
fn the_family_has_ninety_five_of_a_hundred_valves_that_the_recordings_allow() {
    let found = identification();
    let region = joint_region(found, &rig(), 0.0).unwrap();
    assert_eq!((region.directions.len(), region.left_out, region.effect_left_out), (COUNT, 0, 0.0));
    // ORIGIN: analytic, erf(r/sqrt 2) = 0.95^(1/9), by SciPy 2.7662
    assert!((region.deviations - 2.766).abs() < 1e-3, "{}", region.deviations);
    let (covariance, changes) = (covariance(found), changes(&region));
    let again = &changes * changes.transpose();
    for i in 0..COUNT {
        for j in 0..COUNT {
            let scale = found.deviations[i] * found.deviations[j];
            assert!((again[(i, j)] - covariance[(i, j)]).abs() < 1e-9 * scale, "{i} {j}");
        }
    }
    // Hadamard's inequality: the box along the directions is smaller than the one along the
    // coefficients
    let independent: f64 = found.deviations[..COUNT].iter().product();
    let fraction = changes.determinant().abs() / independent;
    assert!(fraction < 0.1, "{fraction}");
    // drawn with the Cholesky factor, which is independent of the directions
    let scaled = DMatrix::from_fn(COUNT, COUNT, |i, j| {
        covariance[(i, j)] / (found.deviations[i] * found.deviations[j])
    });
    let factor = scaled.cholesky().unwrap().l();
    let back = changes.lu();
    let (mut state, draws, mut inside) = (stream(5, 0), 4000, 0);
    for _ in 0..draws {
        let independent = DVector::from_fn(COUNT, |_, _| normal(&mut state));
        let drawn = &factor * independent;
        let change = DVector::from_fn(COUNT, |i, _| drawn[i] * found.deviations[i]);
        let z = back.solve(&change).unwrap();
        inside += usize::from(z.iter().all(|z| z.abs() <= region.deviations));
    }
    // ORIGIN: analytic, 4000 trials at 95 %: 3800 expected, four standard deviations to either side
    assert!((3745..=3855).contains(&inside), "{inside}");
}

/// K_qU and K_c of valves within the region are within the box that the family visits, even if most
/// directions are left out, up to the omitted part.
#[test]
fn neglected_directions_have_little_effect() {
    let found = identification();
    let every = joint_region(found, &rig(), 0.0).unwrap();
    let region = joint_region(found, &rig(), 0.02).unwrap();
    assert!((1..COUNT).contains(&region.directions.len()), "{region:?}");
    assert_eq!(region.directions.len() + region.left_out, COUNT);
    assert!(region.effect_left_out > 0.0 && region.effect_left_out <= 0.02);
    assert!(region.effects.windows(2).all(|pair| pair[0] >= 0.3 * pair[1]), "{:?}", region.effects);
    let ranges = visited_box(&Setup::new(&with_directions(&region)).unwrap()).unwrap().unwrap();
    let all = with_directions(&every);
    let mut state = stream(7, 0);
    for _ in 0..200 {
        let mut drawn = Vec::new();
        for direction in &every.directions {
            let z: f64 = normal(&mut state);
            drawn.push((direction.name.as_str(), z.max(-every.deviations).min(every.deviations)));
        }
        let linear = Setup::rig_of(&all.with_numbers(&drawn).unwrap()).unwrap().linear;
        for (name, value) in
            [("flow_gain", linear.flow_gain), ("flow_pressure_coefficient", linear.flow_pressure_coefficient)]
        {
            let range = ranges.iter().find(|one| one.name == name).unwrap();
            let slack = 1.1 * region.effect_left_out;
            let (least, most) = (range.minimum.value, range.maximum.value);
            assert!(
                value > least * (1.0 - slack) && value < most * (1.0 + slack),
                "{name} {value} {least} {most}"
            );
        }
    }
}

/// A valve that is known exactly is one valve: the family is only that of its operating region.
#[test]
fn exact_parameters_have_no_directions() {
    let mut found = identification().clone();
    found.deviations = [0.0; STATIC_COEFFICIENTS];
    let region = joint_region(&found, &rig(), 0.0).unwrap();
    assert_eq!((region.directions.len(), region.effect_left_out), (0, 0.0));
    let names: Vec<String> =
        members(&with_directions(&region)).plant().parameters().iter().map(|one| one.name.clone()).collect();
    assert_eq!(names, ["operating_point.load_force", "operating_point.velocity"]);
    let mut nominal_only = with_directions(&region);
    nominal_only.family = None;
    nominal_only.operating_point.spool_side = Some(0.0);
    assert_eq!(members(&nominal_only).members().len(), 1);
}

#[test]
fn no_family_is_written_of_undetermined_parameters() {
    let mut found = identification().clone();
    found.estimates[4] = None;
    assert_eq!(
        joint_region(&found, &rig(), 0.0),
        Err(JointRegionError::NotIdentifiable("leakage_coefficients.supply_to_a"))
    );
    let mut found = identification().clone();
    found.deviations[4] = found.coefficients.to_array()[4];
    let below = JointRegionError::BelowZero("valve.leakage_coefficients.supply_to_a".to_string());
    assert_eq!(joint_region(&found, &rig(), 0.0), Err(below));
    let nominal_only = Project { actuator: None, ..rig() };
    assert_eq!(joint_region(identification(), &nominal_only, 0.0), Err(JointRegionError::NoRig));
}

/// Members are the plants of the project with these numbers declared, to rounding.
#[test]
fn a_member_is_the_plant_of_its_coefficients() {
    let project = with_directions(&joint_region(identification(), &rig(), 0.001).unwrap());
    let family = members(&project);
    let names: Vec<&str> = family.plant().parameters().iter().map(|one| one.name.as_str()).collect();
    assert!(names.contains(&"valve_1") && names.contains(&"operating_point.velocity"), "{names:?}");
    for values in family.members().iter().step_by(7) {
        let numbers: Vec<(&str, f64)> = names.iter().copied().zip(values.iter().copied()).collect();
        let declared = project.with_numbers(&numbers).unwrap().without_uncertainty();
        let one = family.plant().coefficients(values).unwrap();
        let other = Setup::rig_of(&declared).unwrap().plant.coefficients();
        for frequency in [0.01, 3.0, 100.0, 2000.0] {
            let [one, other] = [&one, &other].map(|plant| plant.command.at_frequency(frequency));
            assert!((one / other - 1.0).norm_sqr().sqrt() < 1e-9, "{values:?}");
        }
    }
    // and a printed project is read back unchanged
    let printed = project::print(&project);
    assert_eq!(read(&printed).unwrap().directions, project.directions);
}

fn refused(directions: &str) -> String {
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    match read(&format!("{start}{directions}\n[[specification]]{end}")) {
        Err(report) => report,
        Ok(_) => panic!("accepted: {directions}"),
    }
}

#[test]
fn a_direction_moves_numbers_that_exist_and_are_uncertain_nowhere_else() {
    let direction = |name: &str, changes: &str| {
        format!("[[uncertainty_direction]]\nname = \"{name}\"\nchanges = {{ {changes} }}\n")
    };
    let edge = "\"valve.flow_coefficients.supply_to_a\" = 1e-9";
    let cases = [
        (direction("a", "\"valve.flow_coefficients.suply_to_a\" = 1e-9"), "supply_to_a"),
        (direction("a", "\"line.volume\" = 1e-5"), "`line.volume` is not a number of this project"),
        (direction("a", ""), "`changes` is empty"),
        (direction("flow_gain", edge), "a name of its own"),
        (direction("a", edge) + &direction("a", edge), "a second direction called \"a\""),
        (direction("a", "\"valve.flow_coefficients.supply_to_a\" = 2e-7"), "at the ends of its directions"),
        (
            direction("a", edge) + "[uncertainty]\na = { nominal = 0, minimum = -1, maximum = 1 }",
            "is a direction",
        ),
        (
            direction("a", edge)
                + "[uncertainty]\nflow_gain = { nominal = 5e-5, minimum = 4e-5, maximum = 6e-5 }",
            "both cannot be uncertain",
        ),
        (
            direction("a", edge)
                + "[uncertainty]\n\"valve.flow_coefficients.supply_to_a\" = { nominal = 3.2e-7, minimum = 3e-7, maximum = 4e-7 }",
            "has a range of",
        ),
        (
            direction("a", edge)
                + "[campaign.parameters]\n\"valve.flow_coefficients.supply_to_a\" = { spread = \"5 %\" }",
            "draws every direction already",
        ),
        (direction("a", edge) + "[campaign.parameters]\na = { minimum = -1, maximum = 1 }", "by itself"),
    ];
    for (text, expected) in cases {
        let report = refused(&text);
        assert!(report.contains(expected), "{text}\n{report}");
    }
}

/// The part of Table 6.3 that the region of the example reaches: not all of its leakage, and more
/// than its gain. Replaced ranges are used for nothing else.
#[test]
fn ranges_that_are_replaced_are_compared_and_nothing_else() {
    let replaces = "[family.replaces]\nflow_pressure_coefficient = { nominal = 6.42e-13, minimum = 6.42e-13, maximum = 7e-11, spacing = \"log\" }\nflow_gain = { nominal = 5.4e-5, minimum = 3.23e-5, maximum = 5.61e-5 }\n";
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let region =
        "[family.operating_region]\nload_force = [\"-4 kN\", \"4 kN\"]\nvelocity = [\"-1 m/s\", \"1 m/s\"]\n";
    let project = read(&format!("{start}{region}{replaces}[[specification]]{end}")).unwrap();
    assert_eq!(members(&project).members(), members(&rig()).members());
    let setup = Setup::new(&project).unwrap();
    let visited = visited_box(&setup).unwrap().unwrap();
    let ranges = replaced_ranges(&project, &visited);
    let [leakage, gain] = ranges.as_slice() else { panic!("{ranges:?}") };
    // the pump limits the rig to a quarter of the range up to 7e-11; the unequal edges have more
    // gain than Table 6.3
    assert!(leakage.visited[1] < 0.3 * 7e-11 && gain.visited[1] > 1.3 * 5.61e-5, "{ranges:?}");
    let logarithm = |value: f64| value.ln();
    let fraction = logarithm(leakage.visited[1] / 6.42e-13) / logarithm(7e-11 / 6.42e-13);
    assert!((leakage.fraction - fraction).abs() < 1e-12);
    assert_eq!((leakage.beyond(), gain.beyond()), ([true, false], [false, true]));
    let problem = robust_problem(&Memory::default(), &setup).unwrap();
    let own = template(&problem.family, &problem.compensation, 1.0, &TemplateOptions::default()).unwrap();
    let areas = template_areas(&Memory::default(), &project, &problem, &[&own.template]).unwrap();
    assert_eq!(areas.len(), 1);
    assert_eq!(areas[0].visited, own.template.area_deg_db());
    assert!(areas[0].replaced > 0.0 && areas[0].replaced != areas[0].visited, "{areas:?}");
    let nominal_only = format!("{start}{replaces}[[specification]]{end}");
    assert!(read(&nominal_only).unwrap_err().contains("nothing to compare with"));
}
