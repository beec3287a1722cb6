//! The loop of an audit as stated in a certificate, and the variables of each plant.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::scalar::Interval;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter};

use super::NotProven;
use super::certificate::{
    Certificate, CertificateMember, CertifiedPlant, ControlLaw, LimitOf, ParameterSegment, Quotient,
    RollOffBound, Sampling, Sections,
};
use super::modelling::with_model;
use super::polynomial::VARIABLES_MAXIMUM;
use crate::closed_loop::Compensation;
use crate::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
use crate::specification::Limit;

/// Number of terms of the series that replaces dead time: over a panel its phase changes by one
/// radian to either side, so that the remainder is 2e-9.
const DEAD_TIME_TERMS: usize = 12;

/// The certificate of a loop, without claims.
pub(super) fn stated(family: &Family, compensation: &Compensation) -> Result<Certificate, NotProven> {
    let Family::Uncertain(family) = family else { return Err(NotProven::Measured) };
    if compensation.rate_feed_forward() != 0.0 {
        return Err(NotProven::RateFedForward);
    }
    if compensation.inner_feedback().is_some() {
        return Err(NotProven::InnerFeedback);
    }
    let parts = [compensation.feedback(), compensation.prefilter(), compensation.sensor()];
    let expression = family.plant().followed_expression().ok_or(NotProven::Waves)?;
    let (boxes, variables) = boxes(family)?;
    let ends = family.plant().parameters().iter();
    let all: Vec<Interval> = ends.map(|one| Interval::new(one.minimum, one.maximum)).collect();
    let enclosed = family.plant().enclosures(&all).ok_or(NotProven::Waves)?;
    let has_dead_time = enclosed.dead_time_s != Interval::from(0.0);
    let lengths = lengths(&enclosed);
    let count = lengths.iter().sum::<usize>() + usize::from(has_dead_time);
    let plant = CertifiedPlant {
        parameters: family.plant().parameters().iter().map(|one| one.name.clone()).collect(),
        variables,
        boxes,
        coefficients: expression.first(count),
        lengths,
        has_dead_time,
        // the dead time of the prefilter changes no magnitude
        delay_s: compensation.delay_s() + parts[0].dead_time_s() + parts[2].dead_time_s(),
        dead_time_terms: DEAD_TIME_TERMS,
        model_degree: 0,
    };
    let [feedback, prefilter] = [parts[0], parts[1]].map(law);
    let sensor = quotient(parts[2]);
    let sampling = compensation.sample_time_s().map(|sample_time_s| {
        let bound = RollOffBound { order: 1, ratio: 1.0, panels: vec![] };
        let of_box = vec![bound; if sensor.is_one() { 1 } else { 2 }];
        let bounds = vec![of_box; plant.boxes.len()];
        Sampling { sample_time_s, sensor_delay_s: parts[2].dead_time_s(), images: 1, bounds }
    });
    let mut certificate = Certificate { plant, feedback, prefilter, sensor, sampling, claims: vec![] };
    with_model(&mut certificate)?;
    Ok(certificate)
}

/// A compensator in s or in z.
fn law(function: &TransferFunction) -> ControlLaw {
    match function.domain() {
        TimeDomain::Continuous => ControlLaw::Continuous(quotient(function)),
        TimeDomain::Discrete { .. } => ControlLaw::Sampled(Sections {
            gain: function.gain(),
            numerator: sections(function.zeros()),
            denominator: sections(function.poles()),
        }),
    }
}

/// Polynomials in z - 1 with these roots, which form conjugate pairs.
///
/// ```text
/// z - p = (z - 1) + (1 - p),    (z - p)(z - conj p) = (z - 1)^2 + 2 Re(1 - p) (z - 1) + |1 - p|^2
/// ```
fn sections(roots: &[Complex64]) -> Vec<Vec<f64>> {
    let of_root = |root: &Complex64| {
        let [re, im] = [1.0 - root.re, root.im];
        match im {
            0.0 => Some(vec![1.0, re]),
            im if im > 0.0 => Some(vec![1.0, 2.0 * re, re * re + im * im]),
            _ => None,
        }
    };
    roots.iter().filter_map(of_root).collect()
}

fn lengths<S>(plant: &PlantCoefficients<S>) -> Vec<usize> {
    let of = |one: &RationalCoefficients<S>| [one.numerator.len(), one.denominator.len()];
    of(&plant.command).into_iter().chain(plant.disturbance.as_ref().map(of).into_iter().flatten()).collect()
}

fn quotient(function: &TransferFunction) -> Quotient {
    let [numerator, denominator] = [function.numerator(), function.denominator()];
    Quotient {
        numerator: numerator.coefficients().to_vec(),
        denominator: denominator.coefficients().to_vec(),
    }
}

/// Statement of a limit.
pub(super) fn limit(limit: &Limit) -> LimitOf {
    match limit {
        Limit::Constant(value) => LimitOf::Quotient(Quotient::constant(*value)),
        Limit::Rational(function) => LimitOf::Quotient(quotient(function)),
        Limit::Table(table) => LimitOf::Table(table.points().to_vec()),
    }
}

/// The boxes of a family, and the number of variables.
fn boxes(family: &UncertainFamily) -> Result<(Vec<Vec<ParameterSegment>>, usize), NotProven> {
    let fixed = |values: &[f64]| -> Vec<ParameterSegment> {
        values.iter().copied().map(ParameterSegment::fixed).collect()
    };
    if family.extent() == Extent::Members {
        return Ok((family.members().iter().map(|values| fixed(values)).collect(), 0));
    }
    let own = family.plant().parameters();
    let variables = family.coordinates().len();
    if variables > VARIABLES_MAXIMUM {
        return Err(NotProven::TooManyVariables);
    }
    let mut boxes = vec![fixed(&family.plant().nominal())];
    for (variable, coordinate) in family.coordinates().iter().enumerate() {
        let ends = |&index: &usize| {
            let UncertainParameter { minimum, maximum, .. } = own[index];
            if coordinate.opposed.contains(&index) { [maximum, minimum] } else { [minimum, maximum] }
        };
        let moved: Vec<(usize, [f64; 2], bool)> = coordinate
            .parameters
            .iter()
            .zip(&coordinate.spacing)
            .map(|(index, spacing)| {
                (*index, ends(index), *spacing == Spacing::Logarithmic && !moves_straight(coordinate))
            })
            .filter(|(_, [low, high], _)| low != high)
            .collect();
        boxes = boxes.into_iter().flat_map(|one| parts(&one, &moved, variable)).collect();
        if boxes.len() > BOXES_MAXIMUM {
            return Err(NotProven::TooManyVariables);
        }
    }
    let beside =
        family.members().iter().filter(|values| !boxes.iter().any(|one| is_within(one, variables, values)));
    let beside: Vec<Vec<ParameterSegment>> = beside.map(|values| fixed(values)).collect();
    boxes.extend(beside);
    Ok((boxes, variables))
}

/// Largest number of boxes into which a family is divided.
const BOXES_MAXIMUM: usize = 256;
/// Largest factor by which a logarithmic parameter changes within one box.
const FACTOR_MAXIMUM: f64 = 1.6;

/// Boxes in which a variable moves these parameters: more than one if the factor of change is too
/// large for a single box.
fn parts(
    whole: &[ParameterSegment],
    moved: &[(usize, [f64; 2], bool)],
    variable: usize,
) -> Vec<Vec<ParameterSegment>> {
    let factor = |[low, high]: [f64; 2]| portable::ln(high / low).abs() / portable::ln(FACTOR_MAXIMUM);
    let greatest = moved.iter().filter(|one| one.2).map(|one| factor(one.1)).fold(1.0, f64::max);
    let count = greatest.ceil();
    let value = |[low, high]: [f64; 2], by_factors: bool, fraction: f64| match fraction {
        0.0 => low,
        1.0 => high,
        fraction if by_factors => low * portable::exp(fraction * portable::ln(high / low)),
        fraction => low + (high - low) * fraction,
    };
    let part = |index: f64| {
        let mut own = whole.to_vec();
        for &(parameter, ends, by_factors) in moved {
            let [low, high] =
                [index / count, (index + 1.0) / count].map(|fraction| value(ends, by_factors, fraction));
            own[parameter] = ParameterSegment { low, high, variable: Some(variable), by_factors };
        }
        own
    };
    (0..count as usize).map(|index| part(index as f64)).collect()
}

/// Distance by which rounding may place a plant outside the box, as a fraction of the range of a
/// parameter.
const BESIDE: f64 = 1e-9;

/// The variables of a plant that belongs to a box; `None` if it does not, as may happen for a
/// declared plant with correlated parameters.
fn variables_within(segments: &[ParameterSegment], variables: usize, values: &[f64]) -> Option<Vec<f64>> {
    let mut fractions: Vec<Option<f64>> = vec![None; variables];
    let fits = segments.iter().zip(values).all(|(one, value)| {
        match one.variable.and_then(|own| fractions.get_mut(own)) {
            None => one.low == *value,
            Some(slot) => {
                let own = one.fraction(*value);
                let known = *slot.get_or_insert(own);
                (own - known).abs() <= BESIDE && (-BESIDE..=1.0 + BESIDE).contains(&own)
            }
        }
    });
    fits.then(|| fractions.into_iter().map(|fraction| fraction.unwrap_or(0.0).clamp(0.0, 1.0)).collect())
}

fn is_within(segments: &[ParameterSegment], variables: usize, values: &[f64]) -> bool {
    variables_within(segments, variables, values).is_some()
}

impl ParameterSegment {
    /// The variable at which a parameter has this value.
    fn fraction(&self, value: f64) -> f64 {
        match self.by_factors {
            true => portable::ln(value / self.low) / portable::ln(self.high / self.low),
            false => (value - self.low) / (self.high - self.low),
        }
    }

    /// The value of a parameter at this value of its variable.
    pub fn value(&self, fraction: f64) -> f64 {
        match fraction {
            0.0 => self.low,
            1.0 => self.high,
            fraction if self.by_factors => {
                self.low * portable::exp(fraction * portable::ln(self.high / self.low))
            }
            fraction => self.low + (self.high - self.low) * fraction,
        }
    }
}

/// True if the parameters of a coordinate move along a straight line, which a single one always
/// does.
fn moves_straight(coordinate: &Coordinate) -> bool {
    coordinate.parameters.len() == 1 || coordinate.spacing.iter().all(|spacing| *spacing == Spacing::Linear)
}

/// The plant of a family with these values: the listed plant that has them, otherwise the one of a
/// box that contains them, otherwise the nearest one of the first box.
pub(super) fn member_of(plant: &CertifiedPlant, values: &[f64]) -> Option<CertificateMember> {
    let within = plant.boxes.iter().enumerate().find_map(|(of_box, segments)| {
        let variables = variables_within(segments, plant.variables, values)?;
        Some(CertificateMember { of_box, variables })
    });
    if within.is_some() || plant.variables == 0 {
        return within;
    }
    let mut variables = vec![0.0; plant.variables];
    for (one, value) in plant.boxes.first()?.iter().zip(values) {
        if let Some(slot) = one.variable.and_then(|variable| variables.get_mut(variable)) {
            *slot = one.fraction(*value).clamp(0.0, 1.0);
        }
    }
    Some(CertificateMember { of_box: 0, variables })
}

/// The values of the parameters of a plant.
pub(super) fn values_of(plant: &CertifiedPlant, member: &CertificateMember) -> Vec<f64> {
    let value = |one: &ParameterSegment| {
        let fraction = one.variable.and_then(|variable| member.variables.get(variable)).copied();
        fraction.map_or(one.low, |fraction| one.value(fraction))
    };
    plant.boxes.get(member.of_box).into_iter().flatten().map(value).collect()
}
