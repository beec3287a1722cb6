//! Where the key is that an error names: what is wrong with a valid project is sometimes known only
//! where its rig is computed.

use phea_engineering::alternatives::AlternativesError;
use phea_engineering::bench::BenchError;
use phea_engineering::campaign::CampaignError;
use phea_engineering::design::DesignError;
use phea_engineering::family::ProjectFamilyError;
use phea_engineering::rig::RigError;
use phea_engineering::simulate::SimulateError;
use phea_engineering::sizing::SizingError;

use super::CommandError;
use crate::impossible::late_of_steps;
use crate::project::{LateError, Project};

/// The error at each key or table that it names, in the order of its sentence; empty for an error
/// that is not of the project, or that has places of its own.
pub(super) fn late(error: &CommandError, project: &Project) -> Vec<LateError> {
    if error.refusal().is_some() || error.is_of_files() {
        return vec![];
    }
    match error {
        CommandError::Specification(error) => vec![error.at()],
        CommandError::Design(DesignError::ImpossibleSteps(found)) => late_of_steps(found),
        CommandError::Rig(error)
        | CommandError::Family(ProjectFamilyError::Rig(error))
        | CommandError::Sizing(SizingError::Rig(error))
        | CommandError::Simulate(SimulateError::Rig(error))
        | CommandError::Campaign(CampaignError::Simulate(SimulateError::Rig(error)))
        | CommandError::Bench(BenchError::Rig(error)) => match error {
            RigError::Accumulator(empty) => vec![empty.at()],
            error => named(&error.to_string(), project),
        },
        CommandError::Family(error @ ProjectFamilyError::OperatingPoint { numbers, .. }) => {
            vec![unbalanced(error, numbers, project)]
        }
        CommandError::Control(_)
        | CommandError::Family(_)
        | CommandError::Sizing(_)
        | CommandError::Simulate(_)
        | CommandError::Bench(_)
        | CommandError::Campaign(_)
        | CommandError::Audit(_)
        | CommandError::Design(DesignError::NoSpecification)
        | CommandError::Alternatives(AlternativesError::NoAlternative)
        | CommandError::NothingToReport
        | CommandError::OfCylinders { .. }
        | CommandError::Loop(_) => named(&error.to_string(), project),
        _ => vec![],
    }
}

/// A plant that nothing balances, at the range that first names one of the numbers that determine
/// it: the numbers of the operating point first.
fn unbalanced(error: &ProjectFamilyError, numbers: &[String], project: &Project) -> LateError {
    let ranged = |name: &&String| {
        project.uncertain_numbers().iter().any(|one| one.name == **name && one.minimum < one.maximum)
    };
    let (of_point, others): (Vec<&String>, Vec<&String>) =
        numbers.iter().filter(ranged).partition(|name| name.starts_with(OF_POINT));
    let path = of_point.into_iter().chain(others).next().map(|name| range_of(name, project));
    let help = match &path {
        Some(path) if path.starts_with(REGION) => {
            "narrow the region to the points that the rig can hold, raise `supply.pressure`, or enlarge the areas of the piston"
        }
        Some(_) => {
            "narrow the range to the points that the rig can hold, raise `supply.pressure`, or enlarge the areas of the piston"
        }
        None => {
            "state an operating point that the rig can hold, raise `supply.pressure`, or enlarge the areas of the piston"
        }
    };
    let path = path.unwrap_or_else(|| "operating_point".to_string());
    LateError { path, message: error.to_string(), help: help.to_string() }
}

/// The key at which the range of a number is written.
fn range_of(name: &str, project: &Project) -> String {
    let is_listed = project.uncertainty.iter().any(|declared| declared.name == name);
    let is_direction = project.directions.iter().any(|one| one.name == name);
    match name.strip_prefix(OF_POINT) {
        _ if is_direction => "uncertainty_direction".to_string(),
        Some(own) if !is_listed => format!("{REGION}.{own}"),
        _ => format!("uncertainty.{name}"),
    }
}

/// Names of the numbers of the operating point begin with this; the table of their region.
const OF_POINT: &str = "operating_point.";
const REGION: &str = "family.operating_region";

/// An error at the scenario or the tables that its sentence names.
fn named(message: &str, project: &Project) -> Vec<LateError> {
    let paths = scenario(message, project).map_or_else(|| tables(message), |path| vec![path]);
    let at = |path| LateError { path, message: message.to_string(), help: String::new() };
    paths.into_iter().map(at).collect()
}

fn scenario(message: &str, project: &Project) -> Option<String> {
    let named = |name: &str| message.starts_with(&format!("scenario \"{name}\""));
    let index = project.scenarios.iter().position(|scenario| named(&scenario.name))?;
    Some(format!("scenario[{index}]"))
}

/// The path of each `[table]` and of the key in backticks that may follow it.
fn tables(message: &str) -> Vec<String> {
    let one = |from: &str| {
        let (table, rest) = from.split_once(']')?;
        let key =
            rest.trim_start_matches(']').trim_start().strip_prefix('`').and_then(|rest| rest.split_once('`'));
        let path = key.map_or_else(|| table.to_string(), |(key, _)| format!("{table}.{key}"));
        Some(path).filter(|path| !path.is_empty())
    };
    message.split('[').skip(1).filter_map(one).collect()
}
