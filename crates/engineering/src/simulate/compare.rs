//! Comparison of the common scenarios of several projects.

use super::{ScenarioRun, SimulateError, simulate_project};
use crate::project::Loaded;
use crate::setup::Setup;
use crate::source::Source;
use phea_dynamics::watch::{Progress, Watch};

/// Projects with the results of their scenarios.
#[derive(Debug)]
pub struct ScenarioComparison<'a> {
    /// Projects in the order in which they were named; a cancelled one is the last.
    pub projects: Vec<(&'a Loaded, Vec<ScenarioRun>)>,
}

impl<'a> ScenarioComparison<'a> {
    /// Names of all scenarios, those of the first project first.
    pub fn scenarios(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for run in self.projects.iter().flat_map(|(_, runs)| runs) {
            if !names.contains(&run.name.as_str()) {
                names.push(&run.name);
            }
        }
        names
    }

    /// Run of that name in each project.
    pub fn runs_of<'s>(&'s self, name: &'s str) -> impl Iterator<Item = Option<&'s ScenarioRun>> {
        self.projects.iter().map(move |(_, runs)| runs.iter().find(|run| run.name == name))
    }

    /// True if every scenario of every project ran to its end and is reliable.
    pub fn is_complete(&self) -> bool {
        let complete = |(loaded, runs): &(&Loaded, Vec<ScenarioRun>)| {
            runs.len() == loaded.project.scenarios.len() && runs.iter().all(ScenarioRun::is_reliable)
        };
        self.projects.iter().all(complete)
    }
}

/// Simulates each project; cancelled if `watch` returns `false`.
///
/// # Errors
/// The error of the first project that cannot be simulated, with its index in the list.
pub fn compare_projects<'a>(
    source: &dyn Source,
    projects: &'a [Loaded],
    watch: Watch<'_>,
) -> Result<ScenarioComparison<'a>, (usize, SimulateError)> {
    let count = projects.len() as f64;
    let mut comparison = ScenarioComparison { projects: Vec::new() };
    for (index, loaded) in projects.iter().enumerate() {
        let mut watched = |progress: Progress| {
            watch(Progress { fraction: (index as f64 + progress.fraction) / count, ..progress })
        };
        let named = |error: SimulateError| (index, error);
        let setup = Setup::new(&loaded.project).map_err(|error| named(error.into()))?;
        let runs = simulate_project(source, &setup, &mut watched).map_err(named)?;
        let stopped = runs.iter().any(ScenarioRun::was_cancelled);
        comparison.projects.push((loaded, runs));
        if stopped {
            break;
        }
    }
    Ok(comparison)
}
