//! Table `[family]`.

use super::Check;
use crate::{Correlation, DeclaredFamily, IdentifiedUse, OperatingRegion, Project, Uncertain};
use phea_dynamics::uncertain_plant::Spacing;

pub(super) fn family(project: &Project, check: &mut Check<'_, '_>) {
    let Some(family) = &project.family else { return };
    if !family.measured.is_empty() {
        return measured(family, check);
    }
    if check.declared("family.measured") {
        return check.error("family.measured", "`measured` is empty: name the files");
    }
    if family.unstable_poles > 0 {
        check.warning("family.unstable_poles", "`unstable_poles` has no effect without `measured`");
    }
    if let Some(region) = &family.operating_region {
        operating_region(project, region, check);
    }
    replaces(project, family, check);
    cases(project, family, check);
    let mut seen = Vec::new();
    for (index, group) in family.correlation.iter().enumerate() {
        let path = format!("family.correlation[{index}]");
        correlation(project, group, &path, check);
        for name in &group.parameters {
            if seen.contains(&name) {
                check.error(&path, format!("`{name}` is correlated twice"));
            }
            seen.push(name);
        }
    }
    let spans =
        family.grid || family.vertices || family.random.is_some() || family.operating_region.is_some();
    if !family.correlation.is_empty() && !family.cases.is_empty() && !spans {
        let message = "`correlation` has no effect: the family is its `cases` alone";
        check.warning("family.correlation", message);
    }
}

fn measured(family: &DeclaredFamily, check: &mut Check<'_, '_>) {
    let others = [
        ("grid", family.grid),
        ("vertices", family.vertices),
        ("random", family.random.is_some()),
        ("cases", !family.cases.is_empty() || check.declared("family.cases")),
        ("correlation", !family.correlation.is_empty()),
        ("operating_region", family.operating_region.is_some()),
        ("replaces", !family.replaces.is_empty()),
    ];
    for (name, present) in others {
        if present {
            let message = format!("`{name}` needs a plant with parameters, but this family is measured");
            check.error(&format!("family.{name}"), message);
        }
    }
    for (index, file) in family.measured.iter().enumerate() {
        if family.measured.iter().take(index).any(|earlier| earlier == file) {
            check.error("family.measured", format!("\"{file}\" is listed twice"));
        }
    }
}

/// Checks that ranges are in order and contain the declared values, and that each number is
/// uncertain in one place.
fn operating_region(project: &Project, region: &OperatingRegion, check: &mut Check<'_, '_>) {
    let path = "family.operating_region";
    let Some(actuator) = &project.actuator else {
        return check.error(path, "`operating_region` needs an actuator, but this project has a [plant]");
    };
    let point = &project.operating_point;
    let ranges = [
        ("position", region.position, point.position),
        ("load_force", region.load_force, point.load_force),
        ("velocity", region.velocity, point.velocity),
    ];
    let written = |name: &str| check.declared(&format!("{path}.{name}"));
    if ranges.iter().all(|(name, range, _)| range.is_none() && !written(name)) {
        return check.error(
            path,
            "`operating_region` is empty: give ranges of `position`, `load_force` or `velocity`",
        );
    }
    for (name, range, declared) in ranges {
        let key = format!("{path}.{name}");
        check.ascending(&key, range);
        let outside = |[low, high]: [f64; 2]| declared.is_some_and(|value| value < low || value > high);
        if range.is_some_and(outside) {
            check.error(&key, format!("`{name}` of [operating_point] lies outside of this range"));
        }
        let both = format!("operating_point.{name}");
        if range.is_some() && project.uncertainty.iter().any(|uncertain| uncertain.name == both) {
            let message = format!("[uncertainty] has a range of `{both}` too");
            check.error_with_help(&key, message, "list one of the two");
        }
    }
    if region.position.is_some_and(|[_, high]| actuator.is_beyond(high)) {
        check.error(&format!("{path}.position"), "`position` goes beyond the stroke");
    }
}

/// Checks parameters of the linear model that follow from uncertain numbers, each with a range.
fn replaces(project: &Project, family: &DeclaredFamily, check: &mut Check<'_, '_>) {
    let identified = project.identify.as_ref().map(|identify| identify.takes);
    let has_directions =
        !project.directions.is_empty() || identified == Some(IdentifiedUse::ValveAndUncertainty);
    if !family.replaces.is_empty() && family.operating_region.is_none() && !has_directions {
        let message = "`replaces` has nothing to compare with: no `operating_region` and no direction";
        check.error("family.replaces", message);
    }
    for one in &family.replaces {
        let path = format!("family.replaces.{}", one.name);
        check.bounds(&path, [one.minimum, one.nominal, one.maximum]);
        if one.spacing == Spacing::Logarithmic && one.minimum <= 0.0 {
            check.error(&format!("{path}.minimum"), "logarithmic spacing needs a `minimum` above zero");
        }
        let compared = ["flow_gain", "flow_pressure_coefficient", "hydraulic_stiffness"];
        if !compared.contains(&one.name.as_str()) {
            let message = format!("`{}` is not among what a region or a direction moves", one.name);
            check.error_with_help(&path, message, format!("there are: {}", compared.join(", ")));
        }
        if project.uncertainty.iter().any(|other| other.name == one.name) {
            check
                .error(&path, format!("[uncertainty] has a range of `{}` too: it is not replaced", one.name));
        }
    }
}

/// Checks that a case gives a value to every parameter of a plant's formulas, within the range of
/// `[uncertainty]`.
fn cases(project: &Project, family: &DeclaredFamily, check: &mut Check<'_, '_>) {
    let formulas = project.plant.as_ref().map(|plant| plant.formulas()).unwrap_or_default();
    let mut used: Vec<&str> = Vec::new();
    for (name, _) in formulas.iter().flat_map(|(_, formula)| formula.parameters()) {
        if !used.contains(&name) {
            used.push(name);
        }
    }
    for (index, case) in family.cases.iter().enumerate() {
        let path = format!("family.cases[{index}]");
        let given = |name: &str| case.parameters.iter().any(|(known, _)| known == name);
        for name in used.iter().filter(|name| !given(name)) {
            check.error(&path, format!("this case gives no value to `{name}`"));
        }
        for (name, value) in &case.parameters {
            let Some(Uncertain { minimum, maximum, .. }) = uncertain(project, name) else { continue };
            if *value < minimum || *value > maximum {
                let message = format!(
                    "`{name}` = {value} lies outside of {minimum} to {maximum}, its range in [uncertainty]"
                );
                check.error(&path, message);
            }
        }
    }
}

fn correlation(project: &Project, group: &Correlation, path: &str, check: &mut Check<'_, '_>) {
    let points: Vec<Option<u32>> =
        group.parameters.iter().map(|name| uncertain(project, name).map(|found| found.points)).collect();
    if points.iter().any(Option::is_none) {
        check.error(path, "only parameters of [uncertainty] can be correlated");
    } else if points.len() < 2 || points.windows(2).any(|pair| pair[0] != pair[1]) {
        check.error(path, "correlated parameters are two or more with the same number of points");
    }
    for name in group.opposed.iter().filter(|name| !group.parameters.contains(name)) {
        check.error(&format!("{path}.opposed"), format!("`{name}` is not among this group's `parameters`"));
    }
}

fn uncertain(project: &Project, name: &str) -> Option<Uncertain> {
    project.uncertain_numbers().into_iter().find(|uncertain| uncertain.name == *name)
}
