//! Box of a project's uncertain numbers, the coordinates that span it, and the plants that are
//! examined.

use std::collections::BTreeSet;

use phea_dynamics::uncertain_plant::{PlantCoefficients, Spacing, UncertainParameter, UncertainPlant};
use phea_qft::family::{self, Coordinate, Extent, UncertainFamily};

use super::ProjectFamilyError;
use super::null_sides::on_both_sides;
use super::region::within_reach;
use crate::project::{Case, Project};

/// Uncertain parameters: those of `[uncertainty]`, then those that only explicit cases set.
///
/// A value of `[linear]` takes precedence over the nominal value of `[uncertainty]`, as everywhere,
/// and this over the first case.
pub(super) fn parameters(project: &Project) -> Result<Vec<UncertainParameter>, ProjectFamilyError> {
    let numbers = within_reach(project)?;
    let declared = numbers.iter().map(|uncertain| UncertainParameter {
        name: uncertain.name.clone(),
        nominal: project.linear.get(&uncertain.name).unwrap_or(uncertain.nominal),
        minimum: uncertain.minimum,
        maximum: uncertain.maximum,
    });
    let mut parameters: Vec<UncertainParameter> = declared.collect();
    for (name, value) in cases(project).iter().flat_map(|case| &case.parameters) {
        let stated = numbers.iter().any(|uncertain| uncertain.name == *name);
        match parameters.iter_mut().find(|parameter| parameter.name == *name) {
            Some(parameter) if !stated => {
                parameter.minimum = parameter.minimum.min(*value);
                parameter.maximum = parameter.maximum.max(*value);
            }
            Some(_) => {}
            None => {
                let nominal = project.linear.get(name).unwrap_or(*value);
                parameters.push(UncertainParameter {
                    name: name.clone(),
                    nominal,
                    minimum: value.min(nominal),
                    maximum: value.max(nominal),
                });
            }
        }
    }
    Ok(parameters)
}

/// The family of a plant: the grid over its box, or what `[family]` chooses instead.
pub(super) fn family(
    project: &Project,
    plant: UncertainPlant,
) -> Result<UncertainFamily, ProjectFamilyError> {
    let coordinates = coordinates(project, &plant);
    let chosen = project.family.clone().unwrap_or_default();
    let mut members: Vec<Vec<f64>> =
        chosen.cases.iter().map(|case| values(case, plant.parameters())).collect();
    let region = chosen.operating_region.is_some();
    let spans = chosen.grid || chosen.vertices || chosen.random.is_some() || region;
    let extent = if spans || members.is_empty() { Extent::Box } else { Extent::Members };
    let alone = !chosen.vertices && chosen.random.is_none();
    if chosen.grid || (extent == Extent::Box && alone) {
        members.extend(family::grid(&plant, &coordinates)?);
    }
    if chosen.vertices {
        members.extend(family::vertices(&plant, &coordinates)?);
    }
    if let Some(random) = &chosen.random {
        members.extend(family::random(&plant, &coordinates, random.count as usize, random.seed.into())?);
    }
    let members = on_both_sides(project, plant.parameters(), members, extent);
    let family = UncertainFamily::new(plant, coordinates, distinct(members), extent)?;
    check_delay(&family)?;
    Ok(family)
}

/// Members without duplicates, each at its first occurrence.
fn distinct(members: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut seen = BTreeSet::new();
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    members.into_iter().filter(|values| seen.insert(bits(values))).collect()
}

/// Checks that no dead time of a member is negative.
fn check_delay(family: &UncertainFamily) -> Result<(), ProjectFamilyError> {
    for values in family.members() {
        let Some(PlantCoefficients { dead_time_s: delay_s, .. }) = family.plant().coefficients(values) else {
            continue;
        };
        if !(delay_s >= 0.0 && delay_s.is_finite()) {
            let names = family.plant().parameters().iter().map(|parameter| &parameter.name);
            let member: Vec<String> =
                names.zip(values).map(|(name, value)| format!("{name} = {value}")).collect();
            return Err(ProjectFamilyError::Delay { delay_s, member: member.join(", ") });
        }
    }
    Ok(())
}

/// The explicit cases of a project.
pub(super) fn cases(project: &Project) -> &[Case] {
    project.family.as_ref().map_or(&[], |family| &family.cases)
}

/// The values of a case; parameters that it does not name are nominal.
pub(super) fn values(case: &Case, parameters: &[UncertainParameter]) -> Vec<f64> {
    let value = |parameter: &UncertainParameter| {
        let found = case.parameters.iter().find(|(name, _)| *name == parameter.name);
        found.map_or(parameter.nominal, |(_, value)| *value)
    };
    parameters.iter().map(value).collect()
}

/// One coordinate for each correlated group, and one for every other parameter that has a range, in
/// the order of the parameters.
fn coordinates(project: &Project, plant: &UncertainPlant) -> Vec<Coordinate> {
    let groups = project.family.as_ref().map_or(&[][..], |family| &family.correlation);
    let group_of =
        |name: &str| groups.iter().position(|group| group.parameters.iter().any(|one| one == name));
    let numbers = project.uncertain_numbers();
    let mut coordinates: Vec<(Option<usize>, Coordinate)> = Vec::new();
    for (index, parameter) in plant.parameters().iter().enumerate() {
        if parameter.minimum >= parameter.maximum {
            continue;
        }
        let uncertain = numbers.iter().find(|uncertain| uncertain.name == parameter.name);
        let spacing = uncertain.map_or(Spacing::Linear, |uncertain| uncertain.spacing);
        let group = group_of(&parameter.name);
        let opposed = group
            .and_then(|group| groups.get(group))
            .and_then(|group| group.opposed.contains(&parameter.name).then_some(index));
        let known = coordinates.iter_mut().find(|(other, _)| other.is_some() && *other == group);
        if let Some((_, coordinate)) = known {
            coordinate.parameters.push(index);
            coordinate.spacing.push(spacing);
            coordinate.opposed.extend(opposed);
        } else {
            let coordinate = Coordinate {
                parameters: vec![index],
                opposed: opposed.into_iter().collect(),
                spacing: vec![spacing],
                points: uncertain.map_or(2, |uncertain| uncertain.points as usize),
            };
            coordinates.push((group, coordinate));
        }
    }
    coordinates.into_iter().map(|(_, coordinate)| coordinate).collect()
}
