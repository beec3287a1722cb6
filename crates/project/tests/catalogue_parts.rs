//! Pipes and cylinders of the catalogue: values of an entry, overriding values of a project, and
//! consistency of their numbers.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use std::f64::consts::PI;

use phea_project::catalogue::{self, CatalogueKind};
use phea_project::source::Memory;
use phea_project::{Component, DeclaredActuator, DeclaredPipe, Loaded, Refusal, Severity};

const PARTS: &str = include_str!("valid/catalogue_parts.toml");

fn read(settings: &[&str]) -> Result<Loaded, Refusal> {
    let source = Memory::default().with("rig.toml", PARTS);
    let settings: Vec<String> = settings.iter().map(|one| one.to_string()).collect();
    phea_project::read(&source, "rig.toml", &settings, &[])
}

fn actuator(settings: &[&str]) -> DeclaredActuator {
    read(settings).unwrap_or_else(|refusal| panic!("{refusal}")).project.actuator.unwrap()
}

fn pipe_a(actuator: &DeclaredActuator) -> &DeclaredPipe {
    match &actuator.line.a.component {
        Component::Pipe { pipe, .. } => pipe,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_entry_supplies_unstated_values() {
    let found = actuator(&[]);
    // ORIGIN: data sheet: Parker, tube fittings catalogue 4300, page R4, 14 x 2
    let pipe = pipe_a(&found);
    assert_eq!((pipe.bore, pipe.outer_diameter), (0.01, Some(0.014)));
    assert_eq!((pipe.working_pressure, pipe.burst_pressure), (Some(343e5), Some(1340e5)));
    assert_eq!(pipe.cost.mass_per_length, Some(0.592));
    assert_eq!(found.cylinder.piston_diameter, Some(0.05));
    assert_eq!(found.cylinder.rod_diameters_m(), [0.0, 0.022]);
    let [a, b] = found.cylinder.effective_areas_m2();
    assert!((a - PI / 4.0 * 0.05 * 0.05).abs() < 1e-15 && (a - b - PI / 4.0 * 0.022 * 0.022).abs() < 1e-15);
}

/// Values of the project override those of the entry, also if it states the rods or the areas in
/// another way.
#[test]
fn a_stated_value_takes_precedence_over_the_catalogue_entry() {
    assert_eq!(pipe_a(&actuator(&["line.pipe.bore=9.8 mm"])).bore, 0.0098);
    assert_eq!(actuator(&["cylinder.rod_diameter=28 mm"]).cylinder.rod_diameters_m(), [0.028; 2]);
    assert_eq!(actuator(&["cylinder.piston_area=12 cm2"]).cylinder.effective_areas_m2(), [12e-4; 2]);
    let warnings = read(&["supply.pressure=350 bar"]).unwrap().warnings;
    let is_warned = |message: &str| warnings.iter().any(|found| found.message == message);
    assert!(is_warned("the pipe's `working_pressure` is below the supply pressure"), "{warnings:?}");
    let misspelt =
        read(&["line.pipe.model=\"parker_eo_14x22\"", "cylinder.model=\"iso_6020_2_50\""]).unwrap_err();
    // values that the entries would have supplied are not requested
    let errors = misspelt.diagnostics.iter().filter(|found| found.severity == Severity::Error);
    assert_eq!(errors.count(), 2, "{misspelt}");
    let error = misspelt.diagnostics.iter().find(|found| found.message.contains("no pipe called")).unwrap();
    assert!(
        error.help.as_ref().is_some_and(|help| help.starts_with("did you mean \"parker_eo_")),
        "{error:?}"
    );
}

/// Bore, outer diameter and wall in the name of a pipe agree, its mass with that of steel of 7.85
/// kg/dm3, and its burst pressure is above its working pressure. The printed mass of two sizes does
/// not agree, as their files state.
#[test]
fn the_numbers_of_pipes_agree() {
    let all = catalogue::load(&Memory::default(), &[]).unwrap();
    let mut apart = Vec::new();
    let names = all.names(CatalogueKind::Pipe);
    for name in &names {
        let pipe = pipe_a(&actuator(&[&format!("line.pipe.model=\"{name}\"")])).clone();
        let (outer, wall) = name.strip_prefix("parker_eo_").unwrap().split_once('x').unwrap();
        let [outer, wall] = [outer, wall].map(|text| text.replace('_', ".").parse::<f64>().unwrap() * 1e-3);
        assert!((pipe.outer_diameter.unwrap() - outer).abs() < 1e-12, "{name}");
        assert!((outer - 2.0 * wall - pipe.bore).abs() < 1e-12, "{name}");
        assert!(
            pipe.burst_pressure.is_none_or(|burst| burst > 2.0 * pipe.working_pressure.unwrap()),
            "{name}"
        );
        let mass = 7850.0 * PI * (pipe.bore + wall) * wall;
        if (pipe.cost.mass_per_length.unwrap() - mass).abs() > 3e-3 {
            apart.push(*name);
        }
    }
    assert_eq!((names.len(), apart.as_slice()), (63, ["parker_eo_4x0_5", "parker_eo_6x0_75"].as_slice()));
}

/// Two rods for each bore, with approximately the areas of ISO 6020/2: the piston has 1.25 to 2
/// times the area of its ring.
#[test]
fn the_numbers_of_cylinders_agree() {
    let all = catalogue::load(&Memory::default(), &[]).unwrap();
    let names = all.names(CatalogueKind::Cylinder);
    assert_eq!(names.len(), 20);
    for name in names {
        let cylinder = actuator(&[&format!("cylinder.model=\"{name}\"")]).cylinder;
        let [a, b] = cylinder.effective_areas_m2();
        assert!((1.2..2.15).contains(&(a / b)), "{name}: {}", a / b);
        let stated = |length: f64| (1e3 * length).round().to_string();
        let [piston, rod] = [cylinder.piston_diameter.unwrap(), cylinder.rod_diameters_m()[1]].map(stated);
        assert_eq!(name, format!("iso_6020_2_{piston}_{rod}"));
    }
}

/// The oil pressure of a transmission at the stall force exceeds the limit of the pipe: a warning
/// at the pipe.
#[test]
fn the_pipe_of_a_transmission_has_its_limit() {
    let text = include_str!("valid/transmission_pipe.toml");
    let source = Memory::default().with("rig.toml", text);
    let is_warned = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|one| one.to_string()).collect();
        let loaded =
            phea_project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|found| panic!("{found}"));
        loaded.warnings.iter().any(|found| found.message.contains("the pipe's `working_pressure` is"))
    };
    assert!(is_warned(&["series.line.pipe.working_pressure=20 bar"]));
    assert!(!is_warned(&["series.line.pipe.working_pressure=900 bar"]) && !is_warned(&[]));
}
