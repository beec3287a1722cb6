//! Coordinates of the box: one uncertain parameter each, or several that move together.

use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};

use super::{FamilyError, Spacing};

/// One direction of the box, traversed by a fraction from 0 to 1. Several parameters in it are
/// fully correlated.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Indices of the parameters that it moves, in the order of the plant.
    pub parameters: Vec<usize>,
    /// Indices of the parameters among these that run from maximum to minimum.
    pub opposed: Vec<usize>,
    /// Spacing of each parameter, in the order of `parameters`.
    pub spacing: Vec<Spacing>,
    /// Number of grid points.
    pub points: usize,
}

impl Coordinate {
    /// The fraction at which the first parameter that moves has its value.
    pub(super) fn fraction(&self, plant: &UncertainPlant, values: &[f64]) -> f64 {
        let found = self.parameters.iter().zip(&self.spacing).find_map(|(&index, &spacing)| {
            let parameter = plant.parameters().get(index)?;
            let value = *values.get(index)?;
            let fraction = fraction_of(parameter, spacing, value)?;
            Some(if self.opposed.contains(&index) { 1.0 - fraction } else { fraction })
        });
        found.unwrap_or(0.0)
    }
}

pub(super) fn check(plant: &UncertainPlant, coordinates: &[Coordinate]) -> Result<(), FamilyError> {
    let mut moved = vec![false; plant.parameters().len()];
    for coordinate in coordinates {
        for (position, &index) in coordinate.parameters.iter().enumerate() {
            match moved.get_mut(index) {
                Some(taken) if !*taken => *taken = true,
                _ => return Err(FamilyError::Coordinate(index)),
            }
            let logarithmic = coordinate.spacing.get(position) == Some(&Spacing::Logarithmic);
            let parameter = &plant.parameters()[index];
            if logarithmic && parameter.minimum <= 0.0 {
                return Err(FamilyError::Logarithmic(parameter.name.clone()));
            }
        }
    }
    Ok(())
}

pub(super) fn values(plant: &UncertainPlant, coordinates: &[Coordinate], fractions: &[f64]) -> Vec<f64> {
    let mut values = plant.nominal();
    for (number, coordinate) in coordinates.iter().enumerate() {
        let fraction = fractions.get(number).copied().unwrap_or(0.0).clamp(0.0, 1.0);
        for (position, &index) in coordinate.parameters.iter().enumerate() {
            let fraction = if coordinate.opposed.contains(&index) { 1.0 - fraction } else { fraction };
            let spacing = coordinate.spacing.get(position).copied().unwrap_or_default();
            if let (Some(slot), Some(parameter)) = (values.get_mut(index), plant.parameters().get(index)) {
                *slot = value_at(parameter, spacing, fraction);
            }
        }
    }
    values
}

/// Value of a parameter at a fraction of its range; exact to the bit at both ends.
fn value_at(parameter: &UncertainParameter, spacing: Spacing, fraction: f64) -> f64 {
    let UncertainParameter { minimum, maximum, .. } = *parameter;
    match (fraction, spacing) {
        (0.0, _) => minimum,
        (1.0, _) => maximum,
        (_, Spacing::Linear) => minimum + fraction * (maximum - minimum),
        (_, Spacing::Logarithmic) => {
            (minimum * portable::exp(fraction * portable::ln(maximum / minimum))).clamp(minimum, maximum)
        }
    }
}

fn fraction_of(parameter: &UncertainParameter, spacing: Spacing, value: f64) -> Option<f64> {
    let UncertainParameter { minimum, maximum, .. } = *parameter;
    if maximum <= minimum {
        return None;
    }
    let fraction = match spacing {
        Spacing::Linear => (value - minimum) / (maximum - minimum),
        Spacing::Logarithmic => portable::ln(value / minimum) / portable::ln(maximum / minimum),
    };
    Some(fraction.clamp(0.0, 1.0))
}
