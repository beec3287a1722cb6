//! Family of a rig with waves in its lines, or with a delayed feedforward of the load velocity:
//! plants without polynomials over the box of the lumped rig.
//!
//! ```text
//! parameters -> PlantInMotion, at every point of the box -> UncertainPlant -> the examined members
//! ```

use std::sync::Arc;

use phea_dynamics::uncertain_plant::responding::{RespondingPlant, RespondingPlants};
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
use phea_hydraulics::line::LineError;
use phea_hydraulics::plant::PlantInMotion;
use phea_qft::family::{Extent, UncertainFamily, vertices};

use super::ProjectFamilyError;
use super::hydraulic;
use super::visited::Visited;
use crate::project::Project;
use crate::setup::Setup;

/// Largest number of examined members of a box, including its corners; the box between them is
/// searched.
const MEMBERS_MAXIMUM: usize = 200;
/// Largest number of coordinates of a box whose corners are examined; others have too many.
const CORNER_COORDINATES: usize = 6;

/// Family without polynomials; `None` if its plants have polynomials.
pub(super) fn family(
    setup: &Setup<'_>,
    lumped: &UncertainFamily,
) -> Result<Option<UncertainFamily>, ProjectFamilyError> {
    if setup.rig().ok().and_then(|rig| rig.in_loop().in_motion).is_none() {
        return Ok(None);
    }
    let parameters = lumped.plant().parameters().to_vec();
    let moving = Moving { visited: Visited::new(setup, &parameters)?, project: setup.project.clone() };
    let corners = corners(lumped)?;
    let members = members(lumped, &corners);
    for values in corners.iter().chain(&members) {
        let named = || named(&parameters, values);
        let plant =
            moving.plant(values).map_err(|error| ProjectFamilyError::Line { error, member: named() })?;
        if plant.is_none_or(|plant| !plant.is_passive()) {
            return Err(ProjectFamilyError::NotPassive { member: named() });
        }
    }
    let plant = UncertainPlant::responding(parameters, Arc::new(moving))?;
    let coordinates = lumped.coordinates().to_vec();
    Ok(Some(UncertainFamily::new(plant, coordinates, members, lumped.extent())?))
}

/// A rig without polynomials, with its uncertain numbers as parameters.
#[derive(Debug)]
struct Moving {
    project: Project,
    visited: Visited,
}

impl Moving {
    fn plant(&self, values: &[f64]) -> Result<Option<PlantInMotion>, LineError> {
        hydraulic::in_motion(&self.project, &self.visited, values)
    }
}

impl RespondingPlants for Moving {
    /// Plant at these values; `None` if a model cannot describe a line, or if an element would
    /// supply energy, so that the number of unstable poles is not known.
    fn at(&self, values: &[f64]) -> Option<Arc<dyn RespondingPlant>> {
        let plant = self.plant(values).ok()??;
        plant.is_passive().then(|| Arc::new(plant) as Arc<dyn RespondingPlant>)
    }
}

/// Corners of a box if there are few: every audit examines them.
fn corners(lumped: &UncertainFamily) -> Result<Vec<Vec<f64>>, ProjectFamilyError> {
    let few = (1..=CORNER_COORDINATES).contains(&lumped.coordinates().len());
    Ok(match lumped.extent() {
        Extent::Box if few => vertices(lumped.plant(), lumped.coordinates())?,
        Extent::Box | Extent::Members => Vec::new(),
    })
}

/// Nominal plant, and as many of the others as are examined in addition to the corners, spread over
/// all.
fn members(lumped: &UncertainFamily, corners: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let all = lumped.members();
    if lumped.extent() == Extent::Members {
        return all.to_vec();
    }
    let others: Vec<&Vec<f64>> = all.iter().skip(1).filter(|values| !corners.contains(values)).collect();
    let room = MEMBERS_MAXIMUM.saturating_sub(corners.len()).max(1);
    let spread = others.iter().step_by(others.len().div_ceil(room).max(1)).map(|values| (*values).clone());
    all.iter().take(1).cloned().chain(spread).collect()
}

fn named(parameters: &[UncertainParameter], values: &[f64]) -> String {
    let parts: Vec<String> =
        parameters.iter().zip(values).map(|(one, value)| format!("{} = {value}", one.name)).collect();
    if parts.is_empty() { "the nominal plant".to_string() } else { parts.join(", ") }
}
