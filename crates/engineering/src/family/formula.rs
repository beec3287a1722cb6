//! Uncertain plant of a transfer function in s and named parameters.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};

use super::ProjectFamilyError;
use crate::project::{DeclaredPlant, Delay, FormulaError, Rational};

/// Records the coefficients of both paths and the dead time.
pub(super) fn uncertain_plant(
    plant: &DeclaredPlant,
    parameters: Vec<UncertainParameter>,
) -> Result<UncertainPlant, ProjectFamilyError> {
    let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
    // A trial with numbers finds every error of the text before the recording, which cannot fail,
    // begins.
    let nominal: Vec<f64> = parameters.iter().map(|parameter| parameter.nominal).collect();
    coefficients(plant, &names, &nominal).map_err(ProjectFamilyError::Formula)?;
    Ok(UncertainPlant::record(parameters, |values| {
        coefficients(plant, &names, values).unwrap_or_else(|_| PlantCoefficients {
            command: RationalCoefficients { numerator: vec![], denominator: vec![] },
            disturbance: None,
            dead_time_s: 0.0.into(),
            rate: None,
        })
    })?)
}

fn coefficients<S: Scalar>(
    plant: &DeclaredPlant,
    names: &[String],
    values: &[S],
) -> Result<PlantCoefficients<S>, FormulaError> {
    let value = |name: &str| {
        names.iter().position(|known| known == name).and_then(|index| values.get(index)).copied()
    };
    let rational = |text: &Rational| {
        let (upper, lower) = (text.numerator.ratio(&value)?, text.denominator.ratio(&value)?);
        Ok(RationalCoefficients {
            numerator: product(&upper.numerator, &lower.denominator),
            denominator: product(&upper.denominator, &lower.numerator),
        })
    };
    Ok(PlantCoefficients {
        command: rational(&plant.transfer)?,
        disturbance: plant.disturbance.as_ref().map(rational).transpose()?,
        dead_time_s: match &plant.delay {
            Delay::Constant(seconds) => S::from(*seconds),
            Delay::Formula(formula) => {
                formula.ratio(&value)?.numerator.first().copied().unwrap_or(S::from(0.0))
            }
        },
        rate: None,
    })
}

/// Product of two polynomials, highest power first.
fn product<S: Scalar>(one: &[S], other: &[S]) -> Vec<S> {
    let mut sum = vec![S::from(0.0); (one.len() + other.len()).saturating_sub(1)];
    for (index, a) in one.iter().enumerate() {
        for (slot, b) in sum.iter_mut().skip(index).zip(other) {
            *slot = *slot + *a * *b;
        }
    }
    sum
}
