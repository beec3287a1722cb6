//! Members of a family over a box.

use phea_dynamics::random::uniform;
use phea_dynamics::uncertain_plant::UncertainPlant;

use super::{Coordinate, FamilyError, MEMBERS_MAXIMUM, coordinate};

/// All combinations of the coordinates' points, the last coordinate varying fastest.
///
/// # Errors
/// [`FamilyError::TooManyMembers`], and errors of coordinates that do not fit the plant.
pub fn grid(plant: &UncertainPlant, coordinates: &[Coordinate]) -> Result<Vec<Vec<f64>>, FamilyError> {
    let points: Vec<usize> = coordinates.iter().map(|coordinate| coordinate.points.max(1)).collect();
    combinations(plant, coordinates, &points)
}

/// All corners of the box.
///
/// # Errors
/// Errors of [`grid`].
pub fn vertices(plant: &UncertainPlant, coordinates: &[Coordinate]) -> Result<Vec<Vec<f64>>, FamilyError> {
    combinations(plant, coordinates, &vec![2; coordinates.len()])
}

/// Points of the box drawn at random: the fraction of every coordinate is uniform over [0, 1], so
/// that a logarithmic one is uniform in its logarithm. Equal seeds give equal points on every
/// machine, and a longer draw begins with the shorter one.
///
/// Source: the generator is SplitMix64, Steele, Lea and Flood (2014).
///
/// # Errors
/// Errors of [`grid`].
///
/// # Example
/// ```
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_qft::family::{Coordinate, Spacing, random};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 100.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// let gain = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Logarithmic], points: 3 };
/// let drawn = random(&plant, std::slice::from_ref(&gain), 1000, 7)?; // between 1 and 100
/// let below = drawn.iter().filter(|values| values[0] < 10.0).count();
/// assert!(drawn.len() == 1000 && (440..560).contains(&below)); // half of them in either decade
/// assert_eq!(random(&plant, &[gain], 10, 7)?, drawn[..10]);
/// # Ok(())
/// # }
/// ```
pub fn random(
    plant: &UncertainPlant,
    coordinates: &[Coordinate],
    count: usize,
    seed: u64,
) -> Result<Vec<Vec<f64>>, FamilyError> {
    coordinate::check(plant, coordinates)?;
    if count > MEMBERS_MAXIMUM {
        return Err(FamilyError::TooManyMembers(count as f64, MEMBERS_MAXIMUM));
    }
    let mut state = seed;
    let mut member = || {
        let fractions: Vec<f64> = coordinates.iter().map(|_| uniform(&mut state)).collect();
        coordinate::values(plant, coordinates, &fractions)
    };
    Ok((0..count).map(|_| member()).collect())
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
    let mut fractions: Vec<Vec<f64>> = vec![vec![]];
    for &points in points {
        let last = points.saturating_sub(1).max(1) as f64;
        let extend = |start: Vec<f64>| {
            (0..points).map(move |point| {
                let mut fractions = start.clone();
                fractions.push(point as f64 / last);
                fractions
            })
        };
        fractions = fractions.into_iter().flat_map(extend).collect();
    }
    Ok(fractions.iter().map(|fractions| coordinate::values(plant, coordinates, fractions)).collect())
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
