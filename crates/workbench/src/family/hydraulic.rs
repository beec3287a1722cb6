//! The uncertain plant of an actuator: the linear plant of its rig over parameters of the linear model and over physical numbers that
//! reach it by a formula.

use super::FamilyError;
use super::machine::Machine;
use crate::project::{LINEAR_PARAMETERS, Project};
use crate::rig::{Rig, has_one_pressure, plant, stated};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
use phea_hydraulics::line::LineError;
use phea_hydraulics::plant::{Plant, PlantInMotion};

/// Records the model with the uncertain numbers open and all others at the values that hold.
pub(super) fn uncertain_plant(
    project: &Project,
    rig: &Rig,
    parameters: Vec<UncertainParameter>,
) -> Result<UncertainPlant, FamilyError> {
    let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
    // A trial with numbers finds every path without a formula before the recording, which cannot fail, begins.
    let mut trial = Machine::new(project, rig);
    for name in names.iter().filter(|name| !is_linear(name)) {
        if !trial.set(name, 1.0) {
            return Err(FamilyError::Path { path: name.clone(), reason: reason(name) });
        }
    }
    Ok(UncertainPlant::record(parameters, |values| member(project, rig, &names, values).1.coefficients())?)
}

/// The plant of one member behind lines in motion; `None` where both lines are lumped.
///
/// # Errors
/// A line that its model does not fit.
pub(super) fn in_motion(
    project: &Project,
    rig: &Rig,
    names: &[String],
    values: &[f64],
) -> Result<Option<PlantInMotion>, LineError> {
    let Some(declared) = &project.actuator else { return Ok(None) };
    let (machine, plant) = member(project, rig, names, values);
    let behind = machine.behind_lines(&declared.line, rig)?;
    Ok(behind.map(|behind| PlantInMotion::new(&plant, &behind)))
}

/// Physical numbers first; what `[linear]` and `[uncertainty]` state of the linear model goes before what follows from them.
fn member<S: Scalar>(project: &Project, rig: &Rig, names: &[String], values: &[S]) -> (Machine<S>, Plant<S>) {
    let mut machine = Machine::new(project, rig).map();
    for (name, value) in names.iter().zip(values).filter(|(name, _)| !is_linear(name)) {
        machine.set(name, *value);
    }
    let known = stated(&rig.parameters).map(|(name, value)| (name, S::from(value)));
    let open = names.iter().map(String::as_str).zip(values.iter().copied());
    let stated = known.chain(open.filter(|(name, _)| is_linear(name)));
    let one_pressure = has_one_pressure(&rig.parameters, &rig.two_pressure, names);
    let chambers = machine.linear_parameters(rig);
    let plant = plant(&chambers, stated, one_pressure, machine.internal_leakage(), machine.load());
    (machine, plant)
}

fn is_linear(name: &str) -> bool {
    LINEAR_PARAMETERS.iter().any(|parameter| parameter.key.name == name)
}

/// Why no formula carries a path into the linear model, and what to use instead.
fn reason(path: &str) -> String {
    let reached = LINEAR_PARAMETERS.iter().filter(|parameter| parameter.follows_from(path));
    let names: Vec<String> = reached.map(|parameter| format!("`{}`", parameter.key.name)).collect();
    let instead = format!("give a range to {} instead", names.join(", "));
    match names.is_empty() {
        true => "it does not enter the linear model".to_string(),
        false if path.starts_with("supply.") || path.starts_with("valve.") => {
            format!("it moves the operating point, whose pressures follow from no formula: {instead}")
        }
        false => format!("no formula carries it into the linear model: {instead}"),
    }
}
