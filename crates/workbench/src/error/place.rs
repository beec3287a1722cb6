//! Where the key is that an error names: what is wrong with a valid project is sometimes known only
//! where its rig is computed.

use phea_engineering::bench::BenchError;
use phea_engineering::campaign::CampaignError;
use phea_engineering::family::ProjectFamilyError;
use phea_engineering::rig::RigError;
use phea_engineering::simulate::SimulateError;
use phea_engineering::sizing::SizingError;

use super::CommandError;
use crate::project::{LateError, Project};

/// The error at the place of a key; `None` for one that is not of the project, or that has places
/// of its own.
pub(super) fn late(error: &CommandError, project: &Project) -> Option<LateError> {
    if error.refusal().is_some() || error.is_of_files() {
        return None;
    }
    match error {
        CommandError::Specification(error) => Some(error.at()),
        CommandError::Rig(error)
        | CommandError::Family(ProjectFamilyError::Rig(error))
        | CommandError::Sizing(SizingError::Rig(error))
        | CommandError::Simulate(SimulateError::Rig(error))
        | CommandError::Campaign(CampaignError::Simulate(SimulateError::Rig(error)))
        | CommandError::Bench(BenchError::Rig(error)) => Some(match error {
            RigError::Accumulator(empty) => empty.at(),
            error => return named(error.to_string(), project),
        }),
        CommandError::Control(_)
        | CommandError::Family(_)
        | CommandError::Sizing(_)
        | CommandError::Simulate(_)
        | CommandError::Bench(_)
        | CommandError::Campaign(_)
        | CommandError::Loop(_) => named(error.to_string(), project),
        _ => None,
    }
}

/// An error at the scenario or the table that its sentence names.
fn named(message: String, project: &Project) -> Option<LateError> {
    let path = scenario(&message, project).or_else(|| table(&message))?;
    Some(LateError { path, message, help: String::new() })
}

fn scenario(message: &str, project: &Project) -> Option<String> {
    let named = |name: &str| message.starts_with(&format!("scenario \"{name}\""));
    let index = project.scenarios.iter().position(|scenario| named(&scenario.name))?;
    Some(format!("scenario[{index}]"))
}

/// The path of `[table]` and of the key in backticks that may follow it.
fn table(message: &str) -> Option<String> {
    let (_, from) = message.split_once('[')?;
    let (table, rest) = from.trim_start_matches('[').split_once(']')?;
    let key =
        rest.trim_start_matches(']').trim_start().strip_prefix('`').and_then(|rest| rest.split_once('`'));
    Some(key.map_or_else(|| table.to_string(), |(key, _)| format!("{table}.{key}")))
}
