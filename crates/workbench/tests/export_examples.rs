//! The controllers of all examples, sampled where they are continuous, as exported files.

use std::fs;
use std::path::Path;

use phea_machine::Deployed;
use phea_workbench::engineering::deployed::{DeployedError, deployed};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project;
use phea_workbench::source::Memory;

use crate::{export_c, export_st};

/// Settings that make a controller run once per sample.
const SAMPLED: [&str; 2] = ["controller.sample_time=1 ms", "prefilter.continuous=false"];

/// Example projects in a folder, with their catalogues and recordings left out.
fn projects(folder: &Path, found: &mut Vec<String>) {
    let mut entries: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            projects(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            found.push(fs::read_to_string(path).unwrap());
        }
    }
}

/// Controller of a project on a computer; `None` for a project that reads other files, or that has
/// no controller.
fn of_project(text: &str) -> Option<Result<Deployed, DeployedError>> {
    let source = Memory::default().with("rig.toml", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).ok()?;
    loaded.project.controller.as_ref().filter(|controller| controller.has_law())?;
    let given = loaded.project.controller.as_ref().and_then(|controller| controller.sample_time);
    let with_prefilter = loaded.project.prefilter.is_some();
    let needed = [given.is_none(), with_prefilter];
    let settings = SAMPLED.iter().zip(needed).filter(|(_, needed)| *needed);
    let settings: Vec<String> = settings.map(|(setting, _)| (*setting).to_string()).collect();
    let loaded = project::read(&source, "rig.toml", &settings, &[]).ok()?;
    Some(deployed(&Setup::new(&loaded.project).ok()?))
}

#[test]
fn the_controllers_of_the_examples_give_the_bits_of_the_simulation() {
    let mut texts = vec![];
    projects(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples"), &mut texts);
    let found: Vec<_> = texts.iter().filter_map(|text| of_project(text)).collect();
    let (controllers, refused): (Vec<_>, Vec<_>) = found.into_iter().partition(Result::is_ok);
    assert!(controllers.len() >= 10, "{} controllers, refused: {refused:?}", controllers.len());
    let excused = |error: &DeployedError| matches!(error, DeployedError::VirtualImpedance);
    assert!(refused.iter().all(|error| excused(error.as_ref().unwrap_err())), "{refused:?}");
    for (index, controller) in controllers.into_iter().flatten().enumerate() {
        export_c::compare_fused(&controller, &format!("example_{index}"));
        export_st::compare(&controller, 500, 1);
    }
}
