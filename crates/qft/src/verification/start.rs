//! Starting points of the searches inside the box.

use super::PlantPoint;
use super::evaluator::Evaluator;
use super::finding::{EnvelopePoint, FoundMargin, SpecificationCriteria, envelope, local_minima};
use super::scan::{Scan, ScannedPlant};
use super::search::SearchTask;
use crate::family::UncertainFamily;

/// Number of local minima of a family's margin, and of plants, from which searches start.
pub(super) const STARTS: usize = 4;
/// Factor by which frequencies must differ to count as different.
const FREQUENCY_RATIO: f64 = 1.1;

/// The range of finite frequencies in which a search may move.
pub(super) fn interior_range(
    part: SpecificationCriteria,
    evaluator: &Evaluator<'_>,
    scan: &Scan,
) -> Option<[f64; 2]> {
    let demanded = |frequency: &f64| {
        let mut bands = evaluator.criteria.iter().skip(part.first).take(part.count);
        *frequency > 0.0 && *frequency < f64::INFINITY && bands.all(|criterion| criterion.demands(*frequency))
    };
    let mut frequencies = scan.envelope().map(|(frequency, _)| frequency).filter(demanded);
    let first = frequencies.next()?;
    let last = frequencies.last()?;
    Some([first, last])
}

/// Frequencies next to violated ones, where the box may contain another plant that violates the
/// limit.
fn near_violations(envelope: &[EnvelopePoint]) -> Vec<f64> {
    let cache = envelope.windows(2).filter_map(|pair| match pair {
        [left, right] if left.margin_db < 0.0 && right.margin_db >= 0.0 => Some(right.frequency),
        [left, right] if left.margin_db >= 0.0 && right.margin_db < 0.0 => Some(left.frequency),
        _ => None,
    });
    cache.take(2 * STARTS).collect()
}

/// Searches for one specification: at each design frequency and each end of the band, including
/// resonances; next to violated frequencies; from its worst local minima, from the middle of the
/// box, and from the plants with the worst peaks.
pub(super) fn tasks(
    part: SpecificationCriteria,
    family: &UncertainFamily,
    (scan, plants): (&Scan, &[ScannedPlant]),
    cases: &[FoundMargin],
    design_frequencies: &[f64],
    range: Option<[f64; 2]>,
) -> Vec<SearchTask> {
    let envelope = envelope(part, scan);
    let fractions = |index: &usize| fractions(family, plants.get(*index).map(|plant| &plant.point));
    let from = |point: &EnvelopePoint, range: Option<[f64; 2]>| SearchTask {
        criteria: point.criteria.clone(),
        fractions: point.plants.iter().map(fractions).collect(),
        frequency: point.frequency,
        range,
        resonances: false,
    };
    let middle = |point: &EnvelopePoint| vec![vec![0.5; family.coordinates().len()]; point.plants.len()];
    let ends = [envelope.first(), envelope.last()].into_iter().flatten().map(|point| point.frequency);
    let given: Vec<f64> = ends.chain(design_frequencies.iter().copied()).collect();
    let beside = near_violations(&envelope);
    let mut tasks = Vec::new();
    for point in &envelope {
        if given.contains(&point.frequency) {
            let task = SearchTask { resonances: true, ..from(point, None) };
            tasks.extend([task.clone(), SearchTask { fractions: middle(point), ..task }]);
        } else if beside.contains(&point.frequency) {
            tasks.push(from(point, None));
        }
    }
    let Some(range) = range else { return tasks };
    let minima: Vec<f64> = local_minima(&envelope).iter().take(STARTS).map(|bracket| bracket[1]).collect();
    for point in envelope.iter().filter(|point| minima.contains(&point.frequency)) {
        tasks.push(from(point, Some(range)));
        tasks.push(SearchTask { fractions: middle(point), ..from(point, Some(range)) });
    }
    let of_part =
        |case: &&FoundMargin| case.criteria.iter().all(|criterion| part.criteria().contains(criterion));
    tasks.extend(diverse(cases.iter().filter(of_part)).into_iter().map(|case| SearchTask {
        criteria: case.criteria.clone(),
        fractions: case.margin.plants().map(|point| self::fractions(family, Some(point))).collect(),
        frequency: case.margin.frequency_rad_per_s,
        range: Some(range),
        resonances: false,
    }));
    tasks.dedup();
    tasks
}

/// Fractions of a plant in the box; the middle for one outside.
fn fractions(family: &UncertainFamily, point: Option<&PlantPoint>) -> Vec<f64> {
    match point {
        Some(PlantPoint::Parameters(values)) => family.fractions(values),
        Some(PlantPoint::Measured(_) | PlantPoint::Additional(_)) | None => {
            vec![0.5; family.coordinates().len()]
        }
    }
}

/// The worst cases, each with a different plant, and after the first few each with a different
/// frequency.
fn diverse<'a>(cases: impl Iterator<Item = &'a FoundMargin>) -> Vec<&'a FoundMargin> {
    let apart = |case: &FoundMargin, other: &&FoundMargin| {
        let ratio = case.margin.frequency_rad_per_s / other.margin.frequency_rad_per_s;
        !(1.0 / FREQUENCY_RATIO..=FREQUENCY_RATIO).contains(&ratio)
    };
    let mut chosen: Vec<&FoundMargin> = Vec::new();
    for case in cases {
        let new_plant = chosen.iter().all(|other| other.margin.plants().ne(case.margin.plants()));
        let wanted = chosen.len() < STARTS || chosen.iter().all(|other| apart(case, other));
        if new_plant && wanted && chosen.len() < 2 * STARTS {
            chosen.push(case);
        }
    }
    chosen
}
