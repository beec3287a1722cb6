//! The answers of `simulate` and `compare`.

mod event;
mod gas;
mod growth;
mod ledger;
mod limits;
mod repetition;
mod scenario;
mod step_counts;

use phea_engineering::simulate::{
    MachineResponses, ScenarioComparison, ScenarioRun, required_of_run, state_names,
};

use super::frequency::{self, MachineResponsesAnswer};
use crate::answer::{Answer, RecordedAnswer, body_in_use};
use crate::project::Loaded;
pub(crate) use event::{SteppedAnswer, stepped};
use scenario::{ScenarioAnswer, scenario};

/// Answer of `simulate`.
#[derive(Answer)]
pub(crate) struct SimulateAnswer {
    /// Frequency response of the machine, only if it was requested: then no scenario is run.
    #[answer(optional)]
    frequency_response: Option<MachineResponsesAnswer>,
    #[answer(flatten)]
    scenarios: ScenariosAnswer,
    /// Misfits of identified parts, which the runs do not contain, if any.
    #[answer(optional)]
    warnings: Option<Vec<String>>,
}

/// Runs of the scenarios of a project.
#[derive(Answer)]
pub(crate) struct ScenariosAnswer {
    /// Runs in the order of the scenarios in the file.
    scenarios: Vec<ScenarioAnswer>,
    /// Names of the scenarios that were not started.
    not_run: Vec<String>,
}

/// Answer of `compare`.
#[derive(Answer)]
pub(crate) struct CompareAnswer {
    /// Projects in the order of the command; one at which it was stopped is the last.
    projects: Vec<ComparedProjectAnswer>,
}

/// Runs of one of several projects.
#[derive(Answer)]
struct ComparedProjectAnswer {
    /// Path of the project file.
    path: String,
    /// Title of the project.
    title: String,
    /// SHA-256 of the bytes of the project file, before settings.
    project_sha256: String,
    /// Settings that replaced values of the file, each `path=value`.
    settings: Vec<String>,
    /// Catalogue files in addition to the built-in catalogue.
    catalogue_files: Vec<String>,
    /// Values identified from recordings, which replace those of the file.
    #[answer(optional)]
    identified: Option<RecordedAnswer>,
    #[answer(flatten)]
    scenarios: ScenariosAnswer,
}

/// The runs of `simulate`, with these warnings.
pub(crate) fn body(loaded: &Loaded, runs: &[ScenarioRun], warnings: Vec<String>) -> SimulateAnswer {
    SimulateAnswer {
        frequency_response: None,
        scenarios: scenarios(loaded, runs),
        warnings: Some(warnings).filter(|all| !all.is_empty()),
    }
}

/// A frequency response in place of the scenarios.
pub(crate) fn frequency_body(loaded: &Loaded, found: &MachineResponses) -> SimulateAnswer {
    SimulateAnswer {
        frequency_response: Some(frequency::body(found)),
        scenarios: scenarios(loaded, &[]),
        warnings: None,
    }
}

/// The runs of several projects.
pub(crate) fn comparison_body(comparison: &ScenarioComparison<'_>) -> CompareAnswer {
    let project = |(loaded, runs): &(&Loaded, Vec<ScenarioRun>)| ComparedProjectAnswer {
        path: loaded.path.clone(),
        title: loaded.project.title.clone(),
        project_sha256: loaded.sha256.clone(),
        settings: loaded.settings.clone(),
        catalogue_files: loaded.catalogue_files.clone(),
        identified: loaded.recorded.as_ref().map(body_in_use),
        scenarios: scenarios(loaded, runs),
    };
    CompareAnswer { projects: comparison.projects.iter().map(project).collect() }
}

/// The scenarios of a project; the last ones are not run if the command was stopped before.
pub(crate) fn scenarios(loaded: &Loaded, runs: &[ScenarioRun]) -> ScenariosAnswer {
    let names = state_names(runs.iter().map(|run| run.name.as_str()));
    let not_run = loaded.project.scenarios.iter().skip(runs.len());
    let each = runs.iter().zip(names);
    ScenariosAnswer {
        scenarios: each
            .map(|(run, state_file)| scenario(run, state_file, &required_of_run(&loaded.project, run)))
            .collect(),
        not_run: not_run.map(|scenario| scenario.name.clone()).collect(),
    }
}
