//! The loop of an audit as a certificate states it, and which plants stand at which variables.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::scalar::Interval;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter};

use super::NotProven;
use super::certificate::{
    Bound, Certificate, CertifiedPlant, Law, LimitOf, Member, Quotient, Sampling, Sections, Segment,
};
use super::polynomial::VARIABLES_MAXIMUM;
use crate::closed_loop::Compensation;
use crate::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
use crate::specification::Limit;

/// Terms of the series that stands for dead time: over a panel it turns by one radian to either side, so that 2e-9 remains.
const DEAD_TIME_TERMS: usize = 12;

/// The loop, and whether its boxes are those of the family or larger ones.
pub(super) struct Stated {
    /// Without a claim.
    pub(super) certificate: Certificate,
    /// Parameters that move together by equal factors are let move each by itself: what is wrong there may be right in the family.
    pub(super) larger: bool,
}

/// The certificate of a loop, without a claim.
pub(super) fn stated(family: &Family, compensation: &Compensation) -> Result<Stated, NotProven> {
    let Family::Uncertain(family) = family else { return Err(NotProven::Measured) };
    if compensation.rate_feed_forward() != 0.0 {
        return Err(NotProven::RateFedForward);
    }
    let parts = [compensation.feedback(), compensation.prefilter(), compensation.sensor()];
    let expression = family.plant().expression().ok_or(NotProven::Waves)?;
    let (boxes, variables, larger) = boxes(family)?;
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
        // that of the prefilter changes no magnitude
        delay_s: compensation.delay_s() + parts[0].dead_time_s() + parts[2].dead_time_s(),
        dead_time_terms: DEAD_TIME_TERMS,
    };
    let [feedback, prefilter] = [parts[0], parts[1]].map(law);
    let sensor = quotient(parts[2]);
    let sampling = compensation.sample_time_s().map(|sample_time_s| {
        let bound = Bound { ratio: 1.0, panels: vec![] };
        let of_box = vec![bound; if sensor.is_one() { 1 } else { 2 }];
        Sampling { sample_time_s, images: 1, bounds: vec![of_box; plant.boxes.len()] }
    });
    Ok(Stated {
        certificate: Certificate { plant, feedback, prefilter, sensor, sampling, claims: vec![] },
        larger,
    })
}

/// A law in s or in z.
fn law(function: &TransferFunction) -> Law {
    match function.domain() {
        TimeDomain::Continuous => Law::Continuous(quotient(function)),
        TimeDomain::Discrete { .. } => Law::Sampled(Sections {
            gain: function.gain(),
            numerator: sections(function.zeros()),
            denominator: sections(function.poles()),
        }),
    }
}

/// Polynomials in z - 1 with these roots, which come in conjugate pairs: z - p = (z - 1) + (1 - p).
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

/// A limit.
pub(super) fn limit(limit: &Limit) -> LimitOf {
    match limit {
        Limit::Constant(value) => LimitOf::Quotient(Quotient::constant(*value)),
        Limit::Rational(function) => LimitOf::Quotient(quotient(function)),
        Limit::Table(table) => LimitOf::Table(table.points().to_vec()),
    }
}

/// The boxes of a family, the number of variables, and whether they are larger than the family.
fn boxes(family: &UncertainFamily) -> Result<(Vec<Vec<Segment>>, usize, bool), NotProven> {
    let fixed = |values: &[f64]| -> Vec<Segment> { values.iter().copied().map(Segment::fixed).collect() };
    if family.extent() == Extent::Members {
        return Ok((family.members().iter().map(|values| fixed(values)).collect(), 0, false));
    }
    let own = family.plant().parameters();
    let mut segments = fixed(&family.plant().nominal());
    let (mut variables, mut larger) = (0, false);
    for coordinate in family.coordinates() {
        let together = moves_straight(coordinate);
        larger |= !together;
        for (position, &index) in coordinate.parameters.iter().enumerate() {
            let UncertainParameter { minimum, maximum, .. } = own[index];
            let [low, high] = match coordinate.opposed.contains(&index) {
                true => [maximum, minimum],
                false => [minimum, maximum],
            };
            let variable = if together { variables } else { variables + position };
            segments[index] = Segment { low, high, variable: (minimum < maximum).then_some(variable) };
        }
        variables += if together { 1 } else { coordinate.parameters.len() };
    }
    match variables <= VARIABLES_MAXIMUM {
        true => {
            let beside = family.members().iter().filter(|values| !is_within(&segments, variables, values));
            let beside: Vec<Vec<Segment>> = beside.map(|values| fixed(values)).collect();
            Ok((std::iter::once(segments).chain(beside).collect(), variables, larger))
        }
        false => Err(NotProven::TooManyVariables),
    }
}

/// By how much a plant may stand beside the box through rounding, in parts of the range of a parameter.
const BESIDE: f64 = 1e-9;

/// Whether a plant of a family belongs to the box, which one that is named need not do where parameters move together.
fn is_within(segments: &[Segment], variables: usize, values: &[f64]) -> bool {
    let mut shares = vec![None; variables];
    segments.iter().zip(values).all(|(one, value)| match one.variable.and_then(|own| shares.get_mut(own)) {
        None => one.low == *value,
        Some(slot) => {
            let own = (value - one.low) / (one.high - one.low);
            let known: f64 = *slot.get_or_insert(own);
            (own - known).abs() <= BESIDE && (-BESIDE..=1.0 + BESIDE).contains(&own)
        }
    })
}

/// Whether the parameters of a coordinate move along a straight line, as one alone always does.
fn moves_straight(coordinate: &Coordinate) -> bool {
    coordinate.parameters.len() == 1 || coordinate.spacing.iter().all(|spacing| *spacing == Spacing::Linear)
}

/// The plant of a family with these values: of plants that are listed the one that has them, else that of the first box nearest to them.
pub(super) fn member_of(plant: &CertifiedPlant, values: &[f64]) -> Option<Member> {
    let is_listed = |one: &Vec<Segment>| {
        one.iter().zip(values).all(|(segment, value)| segment.variable.is_none() && segment.low == *value)
    };
    let of_box = match plant.boxes.iter().position(is_listed) {
        Some(listed) => listed,
        None if plant.variables > 0 => 0,
        None => return None,
    };
    let mut variables = vec![0.0; plant.variables];
    for (one, value) in plant.boxes.get(of_box)?.iter().zip(values) {
        if let Some(slot) = one.variable.and_then(|variable| variables.get_mut(variable)) {
            *slot = ((value - one.low) / (one.high - one.low)).clamp(0.0, 1.0);
        }
    }
    Some(Member { of_box, variables })
}

/// The values of the parameters of a plant.
pub(super) fn values_of(plant: &CertifiedPlant, member: &Member) -> Vec<f64> {
    let value = |one: &Segment| {
        let share = one.variable.and_then(|variable| member.variables.get(variable)).copied();
        match share {
            None | Some(0.0) => one.low,
            Some(1.0) => one.high,
            Some(share) => one.low + (one.high - one.low) * share,
        }
    };
    plant.boxes.get(member.of_box).into_iter().flatten().map(value).collect()
}
