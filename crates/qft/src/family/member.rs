//! Members of a family over a box.

use phea_dynamics::uncertain_plant::UncertainPlant;

use super::{Coordinate, FamilyError, MEMBERS_MAXIMUM, coordinate};

/// All combinations of the coordinates' points, the last coordinate running fastest.
///
/// # Errors
/// [`FamilyError::TooManyMembers`], and those of coordinates that do not fit the plant.
pub fn grid(plant: &UncertainPlant, coordinates: &[Coordinate]) -> Result<Vec<Vec<f64>>, FamilyError> {
    let points: Vec<usize> = coordinates.iter().map(|coordinate| coordinate.points.max(1)).collect();
    combinations(plant, coordinates, &points)
}

/// All corners of the box.
///
/// # Errors
/// Those of [`grid`].
pub fn vertices(plant: &UncertainPlant, coordinates: &[Coordinate]) -> Result<Vec<Vec<f64>>, FamilyError> {
    combinations(plant, coordinates, &vec![2; coordinates.len()])
}

fn combinations(
    plant: &UncertainPlant,
    coordinates: &[Coordinate],
    points: &[usize],
) -> Result<Vec<Vec<f64>>, FamilyError> {
    coordinate::check(plant, coordinates)?;
    let count: f64 = points.iter().map(|&points| points as f64).product();
    if count > MEMBERS_MAXIMUM as f64 {
        return Err(FamilyError::TooManyMembers(count, MEMBERS_MAXIMUM));
    }
    let mut shares: Vec<Vec<f64>> = vec![vec![]];
    for &points in points {
        let last = points.saturating_sub(1).max(1) as f64;
        let extend = |start: Vec<f64>| {
            (0..points).map(move |point| {
                let mut shares = start.clone();
                shares.push(point as f64 / last);
                shares
            })
        };
        shares = shares.into_iter().flat_map(extend).collect();
    }
    Ok(shares.iter().map(|shares| coordinate::values(plant, coordinates, shares)).collect())
}

pub(super) fn check(plant: &UncertainPlant, members: &[Vec<f64>]) -> Result<(), FamilyError> {
    if members.len() > MEMBERS_MAXIMUM {
        return Err(FamilyError::TooManyMembers(members.len() as f64, MEMBERS_MAXIMUM));
    }
    let expected = plant.parameters().len();
    for (member, values) in members.iter().enumerate() {
        if values.len() != expected {
            return Err(FamilyError::Values { member, found: values.len(), expected });
        }
        for (parameter, &value) in plant.parameters().iter().zip(values) {
            let inside = parameter.minimum <= value && value <= parameter.maximum;
            if !inside {
                return Err(FamilyError::Outside {
                    member,
                    parameter: parameter.name.clone(),
                    value,
                    minimum: parameter.minimum,
                    maximum: parameter.maximum,
                });
            }
        }
    }
    Ok(())
}
