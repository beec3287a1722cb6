//! Reading, printing and finding one's way in a project.

use phea_workbench::catalogue::{self, Kind};
use phea_workbench::project::{self, Loaded, Origin, Project, Report, STARTER};
use phea_workbench::source::Memory;

fn read(text: &str) -> Result<Loaded, Report> {
    project::read(&Memory::default().with("rig.toml", text), "rig.toml", &[], &[])
}

#[track_caller]
fn accept(text: &str) -> Loaded {
    read(text).unwrap_or_else(|report| panic!("{report}"))
}

/// Printing and reading again gives an equal project; printing that gives the same text.
#[track_caller]
fn round_trip(project: &Project) {
    let text = project::print(project);
    let again = accept(&text).project;
    assert_eq!(&again, project, "{text}");
    assert_eq!(project::print(&again), text);
}

#[test]
fn the_starter_is_spotless() {
    let loaded = accept(STARTER);
    assert_eq!(loaded.warnings, []);
    assert_eq!(loaded.sha256.len(), 64);
    round_trip(&loaded.project);
}

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const PIPE: &str = include_str!("../../../examples/ybitu/pipe.toml");

#[test]
fn the_ybitu_projects_read_and_warn_of_active_friction_only() {
    for text in [HOSE, PIPE] {
        let loaded = accept(text);
        let messages: Vec<&str> = loaded.warnings.iter().map(|warning| warning.message.as_str()).collect();
        assert_eq!(messages.len(), 1, "{messages:?}");
        // ORIGIN: analytic, 2000 (120 - 80)/80
        assert!(messages[0].contains("at least 1000 N.s/m"), "{messages:?}");
        round_trip(&loaded.project);
    }
}
