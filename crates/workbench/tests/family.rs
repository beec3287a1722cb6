//! Families of projects compared with the equations from which they come.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests may fail the test"
)]

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_workbench::family::{ProjectFamilyError, family};
use phea_workbench::project::{self, Project};
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

const SERVO: &str = "schema = 1\n[plant]\nnumerator = \"k*a/2\"\ndenominator = \"(s + a)^2 - a*(s - b)\"\n\
    delay = \"T + 1e-3\"\n[plant.disturbance]\nnumerator = \"-s*b\"\ndenominator = \"s + a\"\n[uncertainty]\n\
    k = { nominal = 2, minimum = 1, maximum = 4, spacing = \"log\" }\n\
    a = { nominal = 3, minimum = 2, maximum = 6 }\n\
    b = { nominal = 5, minimum = 4, maximum = 6 }\n\
    T = { nominal = 0, minimum = 0, maximum = 0.01 }\n";

fn loaded(text: &str) -> Project {
    let source = Memory::default().with("p.toml", text);
    project::read(&source, "p.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}")).project
}

fn found(text: &str) -> Result<Family, ProjectFamilyError> {
    family(&Setup::new(&loaded(text)).unwrap(), &Memory::default())
}

#[track_caller]
fn uncertain(text: &str) -> UncertainFamily {
    match found(text) {
        Ok(Family::Uncertain(family)) => family,
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn close(found: Complex64, expected: Complex64) {
    let error = portable::magnitude(found - expected) / portable::magnitude(expected);
    assert!(error < 1e-13, "{found} is not {expected}: {error:e}");
}

/// Products, powers, sums, dead time and second path as written, at points drawn from the box.
#[test]
fn a_formula_is_the_plant_it_states() {
    let family = uncertain(&format!("{SERVO}[family]\nrandom = {{ count = 200, seed = 3 }}\n"));
    assert_eq!(family.members().len(), 201);
    for values in family.members() {
        let [k, a, b, dead_time] = values[..] else { panic!("four parameters") };
        let member = family.plant().coefficients(values).unwrap();
        for frequency in [0.1, 1.0, 30.0] {
            let s = Complex64::new(0.0, frequency);
            let expected = k * a / 2.0 / ((s + a) * (s + a) - a * (s - b));
            close(member.command.at_frequency(frequency), expected);
            close(member.disturbance.as_ref().unwrap().at_frequency(frequency), -s * b / (s + a));
        }
        assert_eq!(member.dead_time_s, dead_time + 1e-3);
    }
}

#[test]
fn the_family_is_the_grid_by_default() {
    let grid = uncertain(SERVO);
    assert_eq!((grid.members().len(), grid.extent(), grid.coordinates().len()), (81 + 1, Extent::Box, 4));
    assert_eq!(grid.members()[0], [2.0, 3.0, 5.0, 0.0]);
    for (chosen, members) in [
        ("vertices = true", 16 + 1),
        ("grid = true\nvertices = true", 81 + 1), // a grid contains the corners
        ("vertices = true\nrandom = { count = 10, seed = 1 }", 16 + 10 + 1),
        ("cases = [{ k = 2, a = 3, b = 5, T = 0 }]\nvertices = true", 16 + 1), // the case is the nominal plant
    ] {
        let family = uncertain(&format!("{SERVO}[family]\n{chosen}\n"));
        assert_eq!((family.members().len(), family.extent()), (members, Extent::Box), "{chosen}");
    }
}

/// A family of explicit cases has only these; the first is the nominal plant if nothing else states
/// one.
#[test]
fn explicit_cases_without_a_grid_are_the_family() {
    let cases = "[family]\ncases = [{ k = 10, a = 1 }, { k = 1, a = 5 }, { k = 3, a = 2 }]\n";
    let plant = "schema = 1\n[plant]\nnumerator = \"k\"\ndenominator = \"s + a\"\n";
    let family = uncertain(&format!("{plant}{cases}"));
    assert_eq!(family.members(), [[10.0, 1.0], [1.0, 5.0], [3.0, 2.0]]);
    assert_eq!(family.extent(), Extent::Members);
    let ranges = "[uncertainty]\nk = { nominal = 5, minimum = 1, maximum = 10 }\na = { nominal = 5, minimum = 1, maximum = 5 }\n";
    let family = uncertain(&format!("{plant}{ranges}{cases}"));
    assert_eq!(family.members(), [[5.0, 5.0], [10.0, 1.0], [1.0, 5.0], [3.0, 2.0]]);
}

/// A group is one coordinate of the box: its parameters are at equal fractions of their ranges,
/// opposed ones at the complement.
#[test]
fn correlated_parameters_move_together() {
    let text = format!(
        "{SERVO}[family]\ngrid = true\nvertices = true\nrandom = {{ count = 50, seed = 11 }}\n\
         [[family.correlation]]\nparameters = [\"k\", \"b\", \"a\"]\nopposed = [\"b\"]\n"
    );
    let family = uncertain(&text);
    assert_eq!(family.coordinates().len(), 2);
    assert_eq!(family.members().len(), 1 + 9 + 50);
    for values in &family.members()[1..] {
        let fraction = portable::ln(values[0]) / portable::ln(4.0);
        assert!(((values[1] - 2.0) / 4.0 - fraction).abs() < 1e-14, "{values:?}");
        assert!(((6.0 - values[2]) / 2.0 - fraction).abs() < 1e-14, "{values:?}");
        assert!((family.fractions(values)[0] - fraction).abs() < 1e-14);
    }
}

#[test]
fn members_without_a_possible_dead_time_are_refused() {
    let text = SERVO.replace("T + 1e-3", "T - (a - 3)/1e3");
    let error = found(&text).unwrap_err();
    assert!(matches!(error, ProjectFamilyError::Delay { delay_s, .. } if delay_s == -1e-3), "{error}");
    assert_eq!(error.to_string(), "[plant] `delay` is -0.001 s at k = 1, a = 4, b = 4, T = 0");
}

#[test]
fn too_large_a_grid_is_refused_with_its_size() {
    let text = SERVO
        .replace("maximum = 4,", "maximum = 4, points = 1000,")
        .replace("maximum = 6 }", "maximum = 6, points = 1000 }");
    // ORIGIN: analytic, 1000^3 times 3
    assert!(found(&text).unwrap_err().to_string().contains("would have 3000000000 members"));
}

/// [sensor] becomes H of the loop.
#[test]
fn the_sensor_is_carried_into_the_loop() {
    let controller = "[controller]\nnumerator = \"1\"\ndenominator = \"s\"\n";
    let sensor = "[sensor]\nnumerator = \"200\"\ndenominator = \"s + 200\"\ndelay = \"2 ms\"\n";
    let project = loaded(&format!("{SERVO}{sensor}{controller}"));
    let setup = Setup::new(&project).unwrap();
    let around = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
    let family = uncertain(SERVO);
    let member = around.member(family.plant().coefficients(&family.members()[0]).unwrap()).unwrap();
    let s = Complex64::new(0.0, 50.0);
    close(member.response(50.0).unwrap().sensor, 200.0 / (s + 200.0) * portable::exp_complex(-s * 0.002));
    assert_eq!(Setup::new(&loaded(SERVO)).unwrap().controller, None);
    let without = loaded(&format!("{SERVO}{controller}"));
    assert_eq!(Setup::new(&without).unwrap().sensor.at_frequency(50.0), Complex64::new(1.0, 0.0));
}

#[test]
fn a_sensor_with_a_dc_gain_other_than_one_is_reported() {
    let source = Memory::default()
        .with("p.toml", format!("{SERVO}[sensor]\nnumerator = \"9\"\ndenominator = \"s + 10\"\n"));
    let warnings = project::read(&source, "p.toml", &[], &[]).unwrap().warnings;
    assert_eq!(
        warnings[0].message,
        "[sensor] is 0.9 at zero frequency, not 1: the loop follows what it shows"
    );
}
