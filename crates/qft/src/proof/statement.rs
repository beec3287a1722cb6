//! The loop of an audit as a certificate states it, and which plants stand at which variables.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::scalar::Interval;
use phea_dynamics::uncertain_plant::UncertainParameter;

use super::NotProven;
use super::certificate::{Certificate, CertifiedParameter, CertifiedPlant, Quotient};
use super::claimed::lengths;
use crate::closed_loop::Compensation;
use crate::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
use crate::specification::Limit;

/// Variables at most: a box has two to this power corners.
const VARIABLES_MAXIMUM: usize = 12;

/// The loop, and whether its box is that of the family or a larger one.
pub(super) struct Stated {
    /// Without a claim.
    pub(super) certificate: Certificate,
    /// Parameters that move together by equal factors are let move each by itself: what is wrong there may be right in the family.
    pub(super) larger: bool,
}

/// The certificate of a loop, without a claim.
pub(super) fn stated(family: &Family, compensation: &Compensation) -> Result<Stated, NotProven> {
    let Family::Uncertain(family) = family else { return Err(NotProven::Measured) };
    if compensation.sample_time_s().is_some() {
        return Err(NotProven::Sampled);
    }
    if compensation.rate_feed_forward() != 0.0 {
        return Err(NotProven::RateFedForward);
    }
    let (parameters, variables, larger) = parameters(family)?;
    let plant = family.plant();
    let expression = plant.expression().ok_or(NotProven::Waves)?;
    let of_box: Vec<Interval> = parameters.iter().map(|one| Interval::new(one.low, one.high)).collect();
    let enclosed = plant.enclosures(&of_box).ok_or(NotProven::Waves)?;
    let dead_time = enclosed.dead_time_s + Interval::from(compensation.delay_s());
    if dead_time != Interval::from(0.0) {
        return Err(NotProven::DeadTime);
    }
    let lengths = lengths(&enclosed.command, enclosed.disturbance.as_ref());
    let plant = CertifiedPlant {
        parameters,
        variables,
        coefficients: expression.first(lengths.iter().sum()),
        lengths,
    };
    let [feedback, prefilter, sensor] =
        [compensation.feedback(), compensation.prefilter(), compensation.sensor()].map(quotient);
    Ok(Stated { certificate: Certificate { plant, feedback, prefilter, sensor, claims: vec![] }, larger })
}

fn quotient(function: &TransferFunction) -> Quotient {
    let [numerator, denominator] = [function.numerator(), function.denominator()];
    Quotient {
        numerator: numerator.coefficients().to_vec(),
        denominator: denominator.coefficients().to_vec(),
    }
}

/// A limit; `None` of one that is given as a table.
pub(super) fn limit(limit: &Limit) -> Option<Quotient> {
    match limit {
        Limit::Constant(value) => Some(Quotient::constant(*value)),
        Limit::Rational(function) => Some(quotient(function)),
        Limit::Table(_) => None,
    }
}

fn parameters(family: &UncertainFamily) -> Result<(Vec<CertifiedParameter>, usize, bool), NotProven> {
    let own = family.plant().parameters();
    let fixed = |values: &[f64]| -> Vec<CertifiedParameter> {
        let fixed = |(one, value): (&UncertainParameter, &f64)| CertifiedParameter {
            name: one.name.clone(),
            low: *value,
            high: *value,
            variable: None,
        };
        own.iter().zip(values).map(fixed).collect()
    };
    let mut parameters = fixed(&family.plant().nominal());
    match (family.extent(), family.members()) {
        (Extent::Members, [only]) => return Ok((fixed(only), 0, false)),
        (Extent::Members, _) => return Err(NotProven::Members),
        (Extent::Box, _) => {}
    }
    let (mut variables, mut larger) = (0, false);
    for coordinate in family.coordinates() {
        let together = moves_straight(coordinate);
        larger |= !together;
        let first = variables;
        for (position, &index) in coordinate.parameters.iter().enumerate() {
            let ends = &own[index];
            let is_opposed = coordinate.opposed.contains(&index);
            let [low, high] =
                if is_opposed { [ends.maximum, ends.minimum] } else { [ends.minimum, ends.maximum] };
            let variable = if together { first } else { first + position };
            let moved = ends.minimum < ends.maximum;
            let name = ends.name.clone();
            parameters[index] = CertifiedParameter { name, low, high, variable: moved.then_some(variable) };
        }
        variables += if together { 1 } else { coordinate.parameters.len() };
    }
    match variables <= VARIABLES_MAXIMUM {
        true => Ok((parameters, variables, larger)),
        false => Err(NotProven::TooManyVariables),
    }
}

/// Whether the parameters of a coordinate move along a straight line, as one alone always does.
fn moves_straight(coordinate: &Coordinate) -> bool {
    coordinate.parameters.len() == 1 || coordinate.spacing.iter().all(|spacing| *spacing == Spacing::Linear)
}

/// The variables at which the parameters have these values, each within 0 to 1.
pub(super) fn variables_of(plant: &CertifiedPlant, values: &[f64]) -> Vec<f64> {
    let mut variables = vec![0.0; plant.variables];
    for (one, value) in plant.parameters.iter().zip(values) {
        let slot = one.variable.and_then(|variable| variables.get_mut(variable));
        if let Some(slot) = slot {
            *slot = ((value - one.low) / (one.high - one.low)).clamp(0.0, 1.0);
        }
    }
    variables
}

/// The values of the parameters at these variables.
pub(super) fn values_at(plant: &CertifiedPlant, variables: &[f64]) -> Vec<f64> {
    let value = |one: &CertifiedParameter| {
        let share = one.variable.and_then(|variable| variables.get(variable)).copied();
        match share {
            None | Some(0.0) => one.low,
            Some(1.0) => one.high,
            Some(share) => one.low + (one.high - one.low) * share,
        }
    };
    plant.parameters.iter().map(value).collect()
}
