//! Both sides of null as a coordinate of the family, if a spool at null opens other edges on each
//! side.
//!
//! ```text
//! K_qU = (1 + n)/2 K_qU(0+) + (1 - n)/2 K_qU(0-),      n from -1 to 1
//! ```
//!
//! n = 1 and n = -1 are the plants of small motions on either side; between them are those of
//! motions across null, n = 0 if they are symmetric.

use phea_dynamics::uncertain_plant::{PlantCoefficients, UncertainParameter};
use phea_qft::family::Extent;

use super::ProjectFamilyError;
use super::hydraulic::Open;
use super::uncertain::{self, cases};
use super::visited::{Visited, within};
use crate::project::Project;
use crate::setup::Setup;

/// Path of the coordinate n.
pub(super) const SIDE: &str = "operating_point.spool_side";
/// Range of n.
const SIDES: [f64; 2] = [-1.0, 1.0];
/// Relative difference of coefficients that counts as rounding.
const EQUAL: f64 = 1e-9;

/// Uncertain parameters of a project, with the side of null if it changes an examined plant; it is
/// nominally the mean. A side that the project states is retained.
pub(super) fn parameters(setup: &Setup<'_>) -> Result<Vec<UncertainParameter>, ProjectFamilyError> {
    let project = setup.project;
    let stated = uncertain::parameters(project)?;
    let is_stated = project.operating_point.spool_side.is_some() || stated.iter().any(|one| one.name == SIDE);
    let Some(declared) = project.actuator.as_ref().filter(|_| project.plant.is_none() && !is_stated) else {
        return Ok(stated);
    };
    let [minimum, maximum] = SIDES;
    let side = UncertainParameter { name: SIDE.to_string(), nominal: 0.0, minimum, maximum };
    let parameters: Vec<UncertainParameter> = stated.iter().cloned().chain([side]).collect();
    let visited = Visited::new(setup, &parameters)?;
    let open = visited.open(project, declared);
    let nominal: Vec<f64> = stated.iter().map(|one| one.nominal).collect();
    let cases = cases(project).iter().map(|case| uncertain::values(case, &stated));
    let mut examined = std::iter::once(nominal).chain(cases).chain(within(&stated));
    let jumps = examined.any(|values| are_different(&visited, &open, &values));
    Ok(if jumps { parameters } else { stated })
}

/// True if the plants of both sides of null differ at these values of the other parameters.
fn are_different(visited: &Visited, open: &Open<'_>, values: &[f64]) -> bool {
    let [below, above] = SIDES.map(|side| {
        let values: Vec<f64> = values.iter().copied().chain([side]).collect();
        flat(&open.plant(&values, visited.moved, visited.equal).1.coefficients())
    });
    below.iter().zip(&above).any(|(one, other)| (one - other).abs() > EQUAL * one.abs().max(other.abs()))
}

fn flat(plant: &PlantCoefficients<f64>) -> Vec<f64> {
    let paths = [Some(&plant.command), plant.disturbance.as_ref()].into_iter().flatten();
    paths.flat_map(|path| path.numerator.iter().chain(&path.denominator)).copied().collect()
}

/// Explicit cases on both sides of null, in addition to the mean.
pub(super) fn on_both_sides(
    project: &Project,
    parameters: &[UncertainParameter],
    members: Vec<Vec<f64>>,
    extent: Extent,
) -> Vec<Vec<f64>> {
    let added = !project.uncertain_numbers().iter().any(|one| one.name == SIDE);
    let place = parameters.iter().position(|one| one.name == SIDE).filter(|_| added);
    let (Some(place), Extent::Members) = (place, extent) else { return members };
    let on = |values: &Vec<f64>, side: f64| {
        let mut other = values.clone();
        other[place] = side;
        other
    };
    members.iter().flat_map(|values| [0.0, SIDES[0], SIDES[1]].map(|side| on(values, side))).collect()
}
