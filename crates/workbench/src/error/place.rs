//! Place of the key that an error names: some errors of a valid project are found only when its rig
//! is computed.

use phea_engineering::bench::BenchError;
use phea_engineering::campaign::CampaignError;
use phea_engineering::design::DesignError;
use phea_engineering::family::ProjectFamilyError;
use phea_engineering::rig::RigError;
use phea_engineering::simulate::SimulateError;
use phea_engineering::sizing::SizingError;

use super::CommandError;
use super::tables::tables;
use crate::impossible_steps::late_of_steps;
use crate::project::{LateError, Project};
use crate::specification;

/// The error at each key or table that it names, in the order of its message; empty for an error
/// that is not of the project, or that has its own places.
pub(super) fn late(error: &CommandError, project: &Project) -> Vec<LateError> {
    if error.refusal().is_some() || error.is_of_files() {
        return vec![];
    }
    match error {
        CommandError::Specification(error) => vec![specification::late(error)],
        CommandError::Design(DesignError::ImpossibleSteps(found)) => late_of_steps(found),
        CommandError::Rig(RigError::Accumulator(empty))
        | CommandError::Family(ProjectFamilyError::Rig(RigError::Accumulator(empty)))
        | CommandError::Sizing(SizingError::Rig(RigError::Accumulator(empty)))
        | CommandError::Simulate(SimulateError::Rig(RigError::Accumulator(empty)))
        | CommandError::Campaign(CampaignError::Simulate(SimulateError::Rig(RigError::Accumulator(empty))))
        | CommandError::Bench(BenchError::Rig(RigError::Accumulator(empty))) => vec![empty.at()],
        CommandError::Family(error @ ProjectFamilyError::OperatingPoint { numbers, .. }) => {
            vec![unbalanced(error, numbers, project)]
        }
        error => named(error, project),
    }
}

/// An operating point without equilibrium, at the range that first names one of the numbers that
/// determine it; the numbers of the operating point come first.
fn unbalanced(error: &ProjectFamilyError, numbers: &[String], project: &Project) -> LateError {
    let ranged = |name: &&String| {
        project.uncertain_numbers().iter().any(|one| one.name == **name && one.minimum < one.maximum)
    };
    let (of_point, others): (Vec<&String>, Vec<&String>) =
        numbers.iter().filter(ranged).partition(|name| name.starts_with(OF_POINT));
    let path = of_point.into_iter().chain(others).next().map(|name| range_of(name, project));
    let start = match &path {
        Some(path) if path.starts_with(REGION) => "narrow the region to the points",
        Some(_) => "narrow the range to the points",
        None => "state an operating point",
    };
    let piston = project.motion().words().piston;
    let help = format!(
        "{start} that the rig can hold, raise `supply.pressure`, or enlarge the areas of the {piston}"
    );
    let path = path.unwrap_or_else(|| "operating_point".to_string());
    LateError { path, message: error.to_string(), help }
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

/// Prefix of the names of the numbers of the operating point; the table of their region.
const OF_POINT: &str = "operating_point.";
const REGION: &str = "family.operating_region";

/// An error at the scenario or the tables that it names.
fn named(error: &CommandError, project: &Project) -> Vec<LateError> {
    let scenario = scenario_of(error).and_then(|name| {
        let index = project.scenarios.iter().position(|scenario| scenario.name == name)?;
        Some(format!("scenario[{index}]"))
    });
    let paths = scenario.map_or_else(|| tables(error), |path| vec![path]);
    let at = |path| LateError { path, message: error.to_string(), help: String::new() };
    paths.into_iter().map(at).collect()
}

/// The scenario that cannot be simulated.
fn scenario_of(error: &CommandError) -> Option<&str> {
    let (CommandError::Simulate(error) | CommandError::Campaign(CampaignError::Simulate(error))) = error
    else {
        return None;
    };
    match error {
        SimulateError::Start { name, .. }
        | SimulateError::Equilibrium { name, .. }
        | SimulateError::NoRest { name, .. }
        | SimulateError::NoRestThere { name, .. }
        | SimulateError::RestBeyondLimit { name, .. }
        | SimulateError::Rest { name, .. }
        | SimulateError::Profile { name, .. }
        | SimulateError::Setting { name, .. }
        | SimulateError::Simulation { name, .. } => Some(name),
        _ => None,
    }
}
