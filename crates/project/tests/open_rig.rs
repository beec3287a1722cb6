//! Declared rigs over other numbers: nothing of a rig is lost, and open numbers replace theirs.

use phea_project::{OpenRig, Project, source::Memory};

use crate::reading::valid;

/// Project that is expected to be valid.
fn read(text: &str) -> Project {
    phea_project::read(&Memory::default().with("p.toml", text), "p.toml", &[], &[]).unwrap().project
}

#[test]
fn a_rig_without_open_numbers_equals_the_declared_one() {
    let mut rigs = 0;
    for (name, text) in valid() {
        let project = read(&text);
        let Some(actuator) = &project.actuator else { continue };
        let open = OpenRig::new(actuator, &project.operating_point, &[]);
        assert_eq!(&open.actuator::<f64>(&[]), actuator, "{name}");
        assert_eq!(open.operating_point::<f64>(&[]), project.operating_point);
        rigs += 1;
    }
    assert!(rigs > 20, "{rigs} rigs");
}

#[test]
fn a_number_of_one_side_precedes_that_of_both() {
    let project = read(phea_project::STARTER);
    let actuator = project.actuator.as_ref().unwrap();
    let paths = ["line.length", "line.b.length"].map(String::from);
    let open = OpenRig::new(actuator, &project.operating_point, &paths).actuator(&[2.0, 3.0]);
    assert_eq!([&open.line.a, &open.line.b].map(|line| line.length()), [Some(2.0), Some(3.0)]);
}

#[test]
fn a_part_of_size_zero_is_present_while_its_size_is_open() {
    let text = format!("{}\n[series]\nstiffness = \"200 N/mm\"\n", phea_project::STARTER);
    let project = read(&text);
    let actuator = project.actuator.as_ref().unwrap();
    let damping = |paths: &[String], values: &[f64]| {
        let open = OpenRig::new(actuator, &project.operating_point, paths).actuator(values);
        open.series.and_then(|series| series.spring().and_then(|spring| spring.damping))
    };
    assert_eq!(damping(&[], &[]), None);
    assert_eq!(damping(&["series.damping".to_string()], &[0.0]), Some(0.0));
}

#[test]
fn the_position_of_the_operating_point_may_be_open() {
    let text = format!("{}\n[operating_point]\nposition = \"0.1 m\"\n", phea_project::STARTER);
    let project = read(&text);
    let paths = ["operating_point.position".to_string()];
    let open = OpenRig::new(project.actuator.as_ref().unwrap(), &project.operating_point, &paths);
    assert_eq!(open.operating_point(&[0.2]).position, Some(0.2));
}

#[test]
fn an_open_number_is_present_where_the_project_states_none() {
    let project = read(phea_project::STARTER);
    let paths = ["operating_point.spool_side".to_string()];
    let open = OpenRig::new(project.actuator.as_ref().unwrap(), &project.operating_point, &paths);
    assert_eq!(project.operating_point.spool_side, None);
    assert_eq!(open.operating_point(&[-1.0]).spool_side, Some(-1.0));
}
