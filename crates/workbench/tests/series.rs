//! A spring between force sensor and load, from the project's keys to verdict, machine, impedance
//! and sizing.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use num_complex::Complex64;
use phea_hydraulics::signal::Signal;
use phea_qft::family::Family;
use phea_workbench::catalogue;
use phea_workbench::command::Request;
use phea_workbench::derived::derive;
use phea_workbench::engineering::family::family;
use phea_workbench::engineering::linearize::{Linearization, linearize};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::simulate_project;
use phea_workbench::engineering::sizing::sizing_problem;
use phea_workbench::project::Project;
use phea_workbench::source::Memory;
use serde_json::Value;

use super::run_command::{answer, project_of};

const SERIES: &str = include_str!("../../../examples/ybitu/series.toml");
const STIFFENING: &str = include_str!("../../project/tests/valid/series.toml");
const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const SPRUNG: [&str; 4] =
    ["load.model=spring_mass_damper", "load.mass=100", "load.stiffness=2e5", "load.damping=500"];

fn linearized(project: &Project) -> Linearization {
    let setup = Setup::new(project).unwrap();
    linearize(setup.rig().unwrap(), setup.controller.as_ref(), &setup.sensor).unwrap()
}

/// The nominal member of the recorded family is the rig, polynomial by polynomial, for every kind
/// of element and load.
#[test]
fn the_family_is_the_rig_at_its_nominal() {
    let travel =
        "series={ stiffness = \"2.24 MN/m\", mass = 1, damping = 500, travel = \"5 mm\", progression = 0.3 }";
    let deflection = "series.force_from=deflection";
    let force = "operating_point.load_force=2 kN";
    for settings in [&[][..], &[travel, force], &[deflection], &["supply.model=pump_limited"]] {
        for load in [&[][..], &SPRUNG] {
            let project = project_of(SERIES, &[settings, load].concat());
            let setup = Setup::new(&project).unwrap();
            let rig = setup.rig().unwrap();
            let Family::Uncertain(family) = family(&setup, &Memory::default()).unwrap() else {
                panic!("a box")
            };
            let nominal: Vec<f64> = family.plant().parameters().iter().map(|one| one.nominal).collect();
            let names: Vec<&str> = family.plant().parameters().iter().map(|one| one.name.as_str()).collect();
            assert!(names.contains(&"series.stiffness"), "{names:?}");
            let [own, of_family] = [rig.plant.coefficients(), family.plant().coefficients(&nominal).unwrap()];
            for frequency in [0.1, 10.0, 400.0, 1300.0, 6000.0] {
                let paths = [&own, &of_family].map(|paths| {
                    let ground = paths.disturbance.as_ref().unwrap().at_frequency(frequency);
                    [paths.command.at_frequency(frequency), ground]
                });
                for (own, of_family) in paths[0].into_iter().zip(paths[1]) {
                    assert!(
                        (own / of_family - 1.0).norm_sqr() < 1e-20,
                        "{settings:?} {load:?}: {own} {of_family}"
                    );
                }
            }
        }
    }
}

/// Every number of the element may be uncertain and moves the family; a number that did not would
/// be rejected.
#[test]
fn its_numbers_may_be_uncertain() {
    let more = "\"series.mass\" = { nominal = \"2 kg\", minimum = \"1 kg\", maximum = \"3 kg\", points = 2 }\n\
                \"series.progression\" = { nominal = 0.2, minimum = 0, maximum = 0.4, points = 2 }\n\
                \"series.travel\" = { nominal = \"5 mm\", minimum = \"4.8 mm\", maximum = \"5.2 mm\", points = 2 }\n\n[[specification]]";
    let text = SERIES.replacen("[[specification]]", more, 1);
    let spring =
        "series={ stiffness = \"2.24 MN/m\", mass = 2, damping = 500, travel = \"5 mm\", progression = 0.2 }";
    let project = project_of(&text, &[spring, "operating_point.load_force=3 kN"]);
    let Family::Uncertain(family) = family(&Setup::new(&project).unwrap(), &Memory::default()).unwrap()
    else {
        panic!("a box")
    };
    let of_series = family.plant().parameters().iter().filter(|one| one.name.starts_with("series."));
    assert_eq!(of_series.count(), 5);
}

/// Infinite stiffness: verdict's plant, impedance and the reduced models are those of the rig
/// without a spring.
#[test]
fn a_rigid_spring_has_no_effect() {
    let text = without_series();
    let plain = linearized(&project_of(&text, &[]));
    let rigid = linearized(&project_of(&text, &["series={ stiffness = 1e22 }"]));
    for frequency in [0.01, 3.0, 200.0, 1300.0, 9000.0] {
        let of = |models: &Linearization| {
            let closed = models.closed_loop.as_ref().unwrap().impedance.at_frequency(frequency);
            let open = models.open_loop.impedance.at_frequency(frequency);
            let plants = [&models.plant, &models.two_pressure, &models.full]
                .map(|model| model.command.at_frequency(frequency));
            [&plants[..], &[open, closed]].concat()
        };
        for (one, other) in of(&plain).into_iter().zip(of(&rigid)) {
            assert!((one / other - 1.0).norm_sqr() < 1e-18, "{frequency}: {one} {other}");
        }
    }
}

/// The example without its spring.
fn without_series() -> String {
    let (before, rest) = SERIES.split_once("[series]").unwrap();
    let (_, after) = rest.split_once("[uncertainty]").unwrap();
    let others: Vec<&str> = after.lines().filter(|line| !line.starts_with("\"series.")).collect();
    format!("{before}[uncertainty]{}", others.join("\n"))
}

/// K_eq of oil, sensor and spring in series, where it is printed and where it is used.
#[test]
fn the_spring_is_in_the_equivalent_stiffness_and_in_the_sizing() {
    let project = project_of(SERIES, &[]);
    let setup = Setup::new(&project).unwrap();
    let rig = setup.rig().unwrap();
    let list = derive(&setup).unwrap();
    let value = |name: &str| list.iter().find(|one| one.name == name).unwrap().value.unwrap();
    let stiffness = rig.linear.hydraulic_stiffness;
    let expected = 1.0 / (1.0 / stiffness + 1.0 / 20e6 + 1.0 / 2.24e6);
    assert!((value("dynamics.equivalent_stiffness") / expected - 1.0).abs() < 1e-12);
    assert!((value("series.deflection_at_stall") - value("cylinder.stall_force") / 2.24e6).abs() < 1e-12);
    // the formula for the wire by hand: C = 4, K_w = 15/12 + 0.615/4
    let wahl = 1.25 + 0.153_75;
    let wire = (8.0 * wahl * value("cylinder.stall_force") * 4.0 / (std::f64::consts::PI * 6e8)).sqrt();
    assert!((value("series.coil.wire_diameter") / wire - 1.0).abs() < 1e-12);
    assert!(value("series.coil.active_coils") > 2.0 && value("series.coil.mass") > 0.1);
    let hose = project_of(HOSE, &["series={ stiffness = \"2.24 MN/m\" }"]);
    let built_in = catalogue::load(&Memory::default(), &[]).unwrap();
    let problem = sizing_problem(&Setup::new(&hose).unwrap(), &built_in).unwrap();
    let in_series = 1.0 / (1.0 / 20e6 + 1.0 / 2.24e6);
    assert!((problem.linear.sensor_stiffness / in_series - 1.0).abs() < 1e-12);
}

/// The impedance at the load at high frequencies is that of the spring and its damper, in open and
/// closed loop; the loop is closed over the measured force, which is verified at single frequencies
/// from the paths themselves.
#[test]
fn the_impedance_is_that_at_the_load() {
    use phea_hydraulics::plant::{LinearPlant, LinearSeries, SeriesOutput};
    for measured in ["sensor", "deflection"] {
        let project = project_of(SERIES, &[&format!("series.force_from={measured}")]);
        let setup = Setup::new(&project).unwrap();
        let rig = setup.rig().unwrap();
        let models = linearized(&project);
        let given = setup.controller.as_ref().unwrap().feedback.transfer_function().unwrap();
        let closed = &models.closed_loop.as_ref().unwrap().impedance;
        let series = rig.plant.series.unwrap();
        let on_load = LinearSeries { output: SeriesOutput::OnLoad, ..series };
        let felt = LinearPlant { series: Some(on_load), ..rig.plant }.coefficients();
        let seen = rig.plant.coefficients();
        for frequency in [0.05, 2.0, 60.0, 800.0, 5000.0] {
            let at = |paths: &phea_dynamics::uncertain_plant::PlantCoefficients<f64>| {
                let moved = paths.disturbance.as_ref().unwrap().at_frequency(frequency);
                (paths.command.at_frequency(frequency), moved)
            };
            let ((felt_command, felt_motion), (seen_command, seen_motion)) = (at(&felt), at(&seen));
            let controller = given.at_frequency(frequency);
            // U = -G (measured), measured = seen_command U + seen_motion X
            let command = -controller * seen_motion / (1.0 + controller * seen_command);
            let expected = -(felt_motion + felt_command * command) / Complex64::new(0.0, frequency);
            let found = closed.at_frequency(frequency);
            assert!(
                (found / expected - 1.0).norm_sqr() < 1e-14,
                "{measured} {frequency}: {found} {expected}"
            );
        }
        let high = models.open_loop.impedance.at_frequency(1e6);
        assert!((high.re / 500.0 - 1.0).abs() < 1e-2, "{high}");
    }
}

/// Audit of the linear loop and simulation of the machine under one controller: both stable, with
/// equal overshoot of a small step.
#[test]
fn the_machine_follows_its_linear_loop() {
    let viscous = "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }";
    let small = "scenario=[{ name = \"small\", duration = \"1.5 s\", reference = [{ at = \"0.2 s\", force = \"50 N\" }] }]";
    for settings in [&[][..], &["series.force_from=deflection"]] {
        let settings = [settings, &[viscous, small]].concat();
        let output = answer(SERIES, &settings, &[], &Request::Verify { proof: false, on_machine: true });
        let object: Value = parsed(&output.json);
        assert_eq!(object["stable"], Value::from(true), "{}", output.text());
        let run = &object["machine"]["runs"][0];
        assert_eq!(run["agrees"], Value::from(true), "{run}");
    }
}

/// Lines in motion and the spring in one plant, and a family of them.
#[test]
fn lines_in_motion_and_the_spring_go_together() {
    let moving = ["line.model=transmission_line"];
    let project = project_of(SERIES, &moving);
    let setup = Setup::new(&project).unwrap();
    let rig = setup.rig().unwrap();
    let [own, lumped] = [rig.response(2.0), rig.plant.coefficients().command.at_frequency(2.0)];
    assert!((own / lumped - 1.0).norm_sqr() < 1e-5, "{own} {lumped}");
    let Family::Uncertain(family) = family(&setup, &Memory::default()).unwrap() else { panic!("a box") };
    let of_family = family.plant().response(&family.plant().nominal(), 800.0).unwrap();
    let own = rig.response(800.0);
    assert!((of_family / own - 1.0).norm_sqr() < 1e-18, "{of_family} {own}");
}

/// A progressive spring is reported before the verdict; effects that the reduced models leave out
/// are reported with them.
#[test]
fn uncounted_effects_are_reported() {
    let spring =
        "series={ stiffness = \"2.24 MN/m\", damping = 500, travel = \"5.5 mm\", progression = 0.2 }";
    let output = answer(SERIES, &[spring], &[], &Request::Verify { proof: false, on_machine: false });
    assert!(output.text().contains("series.progression is counted for small motions"), "{}", output.text());
    let output = answer(SERIES, &[], &[], &Request::Linearize { sweep: None });
    assert!(
        output.text().contains("series.damping and series.mass are counted in the plant"),
        "{}",
        output.text()
    );
}

/// The force of a spring that stiffens, or that reaches its end, is not a multiple of a state: the
/// metrics of a run are those of its rows nevertheless.
#[test]
fn metrics_are_those_of_the_rows() {
    let without_spring = |text: &str| {
        text.replace("damping = \"300 N.s/m\"\nmass = \"1.5 kg\"\n", "").replace("stop_damping = 0.3\n", "")
    };
    let sensed = |text: &str| text.replace("force_from = \"deflection\"\n", "");
    // the project without everything else that a family needs
    let plain = STIFFENING.split_once("[uncertainty]").unwrap();
    let plain = format!("{}[controller]{}", plain.0, plain.1.split_once("[controller]").unwrap().1);
    let even = |text: &str| text.replace("progression = 0.2\n", "");
    for (text, settings) in [
        (plain.clone(), vec![]),
        (even(&plain), vec!["series.travel=5.6 mm"]),
        (without_spring(&plain), vec!["series.progression=1"]),
        (even(&sensed(&without_spring(&plain))), vec!["series.travel=5.6 mm"]),
        (sensed(&without_spring(&plain)), vec!["series.progression=1"]),
        (sensed(&plain), vec!["series.progression=1"]),
    ] {
        let project = project_of(&text, &settings);
        let runs =
            simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap();
        let [(_, metrics)] = runs[0].windows[..] else { panic!("{settings:?}") };
        let record = &runs[0].record;
        let largest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let force = record.signal(Signal::Force);
        let near = |found: f64, rows: f64, slack: f64| {
            assert!((found - rows).abs() < slack, "{settings:?}: {found} and {rows} of the rows\n{text}");
        };
        near(metrics.overshoot_percent.unwrap(), (largest(&force) / 10.0 - 100.0).max(0.0), 0.05);
        near(metrics.control_peak_v.unwrap(), largest(&record.signal(Signal::Control)), 0.005);
        let last = force.len() - force.len() / 11..;
        let mean = force[last.clone()].iter().sum::<f64>() / force[last].len() as f64;
        near(metrics.steady_state_error_n.unwrap(), 1000.0 - mean, 0.1);
    }
}
