//! Table `[[uncertainty_direction]]`.

use std::collections::BTreeMap;

use super::requirements::of_one_sensor;
use super::{Check, linear_parameter};
use crate::{LINEAR_PARAMETERS, Project, UncertaintyDirection};
use phea_quantity::display;

pub(super) fn directions(project: &Project, check: &mut Check<'_, '_>) {
    if !project.directions.is_empty() && project.actuator.is_none() {
        let message =
            "[[uncertainty_direction]] moves numbers of an actuator, which this project does not have";
        return check.error("uncertainty_direction", message);
    }
    let stated = project.system_numbers();
    for (index, direction) in project.directions.iter().enumerate() {
        let path = format!("uncertainty_direction[{index}]");
        name(project, index, &path, check);
        moved(project, direction, &stated, &path, check);
    }
    ends(project, &stated, check);
}

/// Rejects a direction name that is already in use.
fn name(project: &Project, index: usize, path: &str, check: &mut Check<'_, '_>) {
    let Some(UncertaintyDirection { name, .. }) = project.directions.get(index) else { return };
    let path = format!("{path}.name");
    let twice = project.directions.iter().take(index).any(|earlier| earlier.name == *name);
    let taken = linear_parameter(name).is_some() || name.contains('.') || project.number(name).is_some();
    if twice {
        check.error(&path, format!("a second direction called \"{name}\""));
    } else if name.is_empty() || taken {
        check.error(&path, format!("a direction needs a name of its own without dots, and not \"{name}\""));
    }
}

/// Checks that every number is stated by the project, and uncertain in one place.
fn moved(
    project: &Project,
    direction: &UncertaintyDirection,
    stated: &BTreeMap<String, f64>,
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let path = format!("{path}.changes");
    if direction.changes.numbers.is_empty() && !check.refused(&path) {
        check.error(&path, "`changes` is empty: name the numbers that this direction moves");
    }
    for (number, _) in &direction.changes.numbers {
        if !stated.contains_key(number) {
            let message = format!("the project states no `{number}`, from which a direction could move it");
            check.error(&path, message);
        }
        of_one_sensor(number, &path, check);
        if project.uncertainty.iter().any(|uncertain| uncertain.name == *number) {
            let message = format!("[uncertainty] has a range of `{number}` too");
            check.error_with_help(&path, message, "list it in one of the two");
        }
        let varied = project.campaign.iter().flat_map(|campaign| &campaign.parameters);
        if varied.into_iter().any(|varied| varied.path == *number) {
            let message = format!("[campaign] varies `{number}` too, and draws every direction already");
            check.error_with_help(&path, message, "take it out of `campaign.parameters`");
        }
        let from_it = |name: &str| linear_parameter(name).is_some_and(|one| one.follows_from(number));
        if let Some(uncertain) = project.uncertainty.iter().find(|uncertain| from_it(&uncertain.name)) {
            let message = format!("`{}` depends on `{number}`: both cannot be uncertain", uncertain.name);
            check.error_with_help(&path, message, "list one of the two");
        }
    }
    let reached: Vec<&str> = LINEAR_PARAMETERS
        .iter()
        .filter(|one| direction.changes.numbers.iter().any(|(number, _)| one.follows_from(number)))
        .map(|one| one.key.name)
        .collect();
    if !reached.is_empty() && reached.iter().all(|name| project.linear.get(name).is_some()) {
        let message =
            format!("`{}` does not reach the linear model: [linear] sets what it changes", direction.name);
        check.warning(&path, message);
    }
}

/// Checks that each number is acceptable with all directions at their ends.
fn ends(project: &Project, stated: &BTreeMap<String, f64>, check: &mut Check<'_, '_>) {
    let mut reach: BTreeMap<&str, (f64, usize)> = BTreeMap::new();
    for (index, direction) in project.directions.iter().enumerate() {
        for (number, change) in &direction.changes.numbers {
            let (sum, _) = reach.get(number.as_str()).copied().unwrap_or((0.0, index));
            reach.insert(number, (sum + direction.deviations * change.abs(), index));
        }
    }
    for (number, (reach, index)) in reach {
        let (Some(value), Some(key)) = (stated.get(number), check.reader.named.get(number).copied()) else {
            continue;
        };
        let beyond =
            [value - reach, value + reach].into_iter().find(|end| !end.is_nan() && !key.range.contains(*end));
        if let Some(end) = beyond {
            let message =
                format!("at the ends of its directions `{number}` is {}", display(end, key.dimension, 4));
            let path = format!("uncertainty_direction[{index}].changes");
            check.error_with_help(&path, message, "lower `deviations`, or measure more precisely");
        }
    }
}
